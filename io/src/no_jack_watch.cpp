// SPDX-License-Identifier: MIT
// In place of jack_watch.cpp where JACK is not built in: without it nobody would see that the
// server has gone, so RtMidi's JACK is left alone.
#include "jack_watch.h"
#include "midi_backend.h"

namespace knotwave::io {

namespace {

constexpr const char* kNotBuiltIn =
    "not built in; install libjack-jackd2-dev and build again with KNOTWAVE_WITH_JACK=ON";

}  // namespace

Result<std::unique_ptr<JackWatch>> JackWatch::open(const std::string& /*client_name*/) {
  return fail(ErrorCode::unsupported, kNotBuiltIn);
}

Result<std::unique_ptr<MidiOutput>> open_jack_midi_output(const MidiOutputConfig& /*config*/) {
  return fail(ErrorCode::unsupported, kNotBuiltIn);
}

}  // namespace knotwave::io

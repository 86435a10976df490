// SPDX-License-Identifier: MIT
// In place of RtMidi where it is not built in.
#include "knotwave/io/midi_input.h"
#include "knotwave/io/midi_output.h"

namespace knotwave::io {
namespace {

constexpr const char* kNotBuiltIn =
    "MIDI is not built in; install librtmidi-dev and build again with KNOTWAVE_WITH_RTMIDI=ON";

}  // namespace

MidiPortList list_midi_ports() {
  MidiPortList list;
  list.notes.emplace_back(kNotBuiltIn);
  return list;
}

Result<std::unique_ptr<MidiInputs>> MidiInputs::open(const MidiInputConfig& /*config*/,
                                                     MidiListener& /*listener*/) {
  return fail(ErrorCode::unsupported, kNotBuiltIn);
}

Result<std::unique_ptr<MidiOutput>> MidiOutput::open(const MidiOutputConfig& /*config*/) {
  return fail(ErrorCode::unsupported, kNotBuiltIn);
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// In place of JACK where it is not built in.
#include "audio_backend.h"

namespace knotwave::io {

JackServer find_jack_devices(FoundDevices& found) {
  found.notes.emplace_back(
      "jack: not built in; install libjack-jackd2-dev and build again with KNOTWAVE_WITH_JACK=ON");
  return JackServer::none;
}

OpenedStream open_jack_stream(const AudioConfig& /*config*/, const FoundDevice& /*device*/,
                              AudioClient& /*client*/) {
  return fail(ErrorCode::unsupported, "JACK is not built in");
}

}  // namespace knotwave::io

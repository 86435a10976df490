// SPDX-License-Identifier: MIT
// In place of PortAudio where it is not built in.
#include "audio_backend.h"

namespace knotwave::io {

void find_portaudio_devices(bool /*with_jack*/, FoundDevices& found) {
  found.notes.emplace_back(
      "portaudio: not built in; install portaudio19-dev and build again with "
      "KNOTWAVE_WITH_PORTAUDIO=ON");
}

OpenedStream open_portaudio_stream(const AudioConfig& /*config*/, const FoundDevice& /*device*/,
                                   AudioClient& /*client*/) {
  return fail(ErrorCode::unsupported, "PortAudio is not built in");
}

}  // namespace knotwave::io

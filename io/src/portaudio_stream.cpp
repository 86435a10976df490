// SPDX-License-Identifier: MIT
#include "audio_backend.h"

namespace knotwave::io {

OpenedStream open_portaudio_stream(const AudioConfig& /*config*/, const FoundDevice& /*device*/,
                                   AudioClient& /*client*/) {
  return fail(ErrorCode::unsupported, "streams of PortAudio are not there yet");
}

}  // namespace knotwave::io

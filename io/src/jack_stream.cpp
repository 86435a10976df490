// SPDX-License-Identifier: MIT
#include "audio_backend.h"

namespace knotwave::io {

OpenedStream open_jack_stream(const AudioConfig& /*config*/, const FoundDevice& /*device*/,
                              AudioClient& /*client*/) {
  return fail(ErrorCode::unsupported, "streams of JACK are not there yet");
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// Private to io: what libsndfile does not tell about a WAV file.
#pragma once
#include <string>
#include <vector>

namespace knotwave::io {

struct RiffFacts {
  std::string clm;  ///< text of the `clm ` chunk; empty without
  std::vector<std::string> warnings;
};

/// Walks the chunks of a RIFF, RIFX or RF64 file; any other file gives no facts. Reads at most 4096
/// chunk headers and 64 bytes of a `clm ` chunk.
RiffFacts scan_riff(int descriptor);

}  // namespace knotwave::io

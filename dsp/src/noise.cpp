// SPDX-License-Identifier: MIT
#include "knotwave/dsp/noise.h"

#include <array>

namespace knotwave::dsp {
namespace {

// The top 24 bits as a signed fraction: exact in float, so -1 <= y < 1.
float bipolar(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word) >> 8) * 0x1p-23f;
}

}  // namespace

void render_noise(base::RandomStream stream, std::int64_t first, std::span<float> out) KNOTWAVE_RT {
  const std::array<std::uint32_t, 2> key{static_cast<std::uint32_t>(stream.seed),
                                         static_cast<std::uint32_t>(stream.seed >> 32)};
  std::size_t i = 0;
  while (i < out.size()) {
    const std::uint64_t index = static_cast<std::uint64_t>(first) + i;
    const std::uint64_t block = index / 4;
    const auto words =
        base::philox4x32({static_cast<std::uint32_t>(block),
                          static_cast<std::uint32_t>(block >> 32), stream.voice, stream.purpose},
                         key);
    for (std::size_t lane = index % 4; lane < 4 && i < out.size(); ++lane, ++i) {
      out[i] = bipolar(words[lane]);
    }
  }
}

}  // namespace knotwave::dsp

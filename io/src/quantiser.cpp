// SPDX-License-Identifier: MIT
#include "quantiser.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/random.h"

namespace knotwave::io {
namespace {

/// Sum of two uniform numbers, in [-1, 1).
double triangular(std::uint64_t bits) {
  const auto high = static_cast<double>(bits >> 32);
  const auto low = static_cast<double>(bits & 0xFFFFFFFFu);
  return (high + low) * 0x1p-32 - 1;
}

}  // namespace

void Quantiser::quantise(std::span<const float> interleaved, std::span<std::int32_t> out) {
  const double scale = static_cast<double>(std::int64_t{1} << (bits_ - 1));
  base::RandomStream stream{.seed = seed_, .voice = channel_, .purpose = base::kRandomDither};
  for (std::size_t i = 0; i < interleaved.size(); ++i) {
    const double x = static_cast<double>(interleaved[i]);
    if (std::abs(x) > 1) ++clipped_;
    const double dithered = x * scale + triangular(stream.bits(frame_));
    const double held = std::clamp(dithered + 0.5, -scale, scale - 1);
    auto rounded = static_cast<std::int32_t>(held);  // towards 0
    if (held < rounded) --rounded;
    out[i] = rounded * (1 << (32 - bits_));
    if (++stream.voice == channels_) {
      stream.voice = 0;
      ++frame_;
    }
  }
  channel_ = stream.voice;
}

}  // namespace knotwave::io

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
  const auto channels = static_cast<std::uint64_t>(channels_);
  for (std::size_t i = 0; i < interleaved.size(); ++i, ++next_sample_) {
    const double x = static_cast<double>(interleaved[i]);
    if (std::abs(x) > 1) ++clipped_;
    const base::RandomStream stream{.seed = seed_,
                                    .voice = static_cast<std::uint32_t>(next_sample_ % channels),
                                    .purpose = base::kRandomDither};
    const double dithered = x * scale + triangular(stream.bits(next_sample_ / channels));
    const double rounded = std::clamp(std::floor(dithered + 0.5), -scale, scale - 1);
    out[i] = static_cast<std::int32_t>(rounded) * (1 << (32 - bits_));
  }
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/noise.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/block_sweep.h"

namespace {

using knotwave::base::RandomStream;
using knotwave::dsp::render_noise;

constexpr RandomStream kStream{42, 3, knotwave::base::kRandomNoise};

std::vector<float> noise(RandomStream stream, std::int64_t first, std::size_t count) {
  std::vector<float> out(count);
  render_noise(stream, first, out);
  return out;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = 0; i + lag < a.size(); ++i) {
    sum += static_cast<double>(a[i + lag]) * static_cast<double>(b[i]);
  }
  return sum / static_cast<double>(a.size() - lag) * 3;  // variance 1/3
}

TEST(Noise, IsUniformWithZeroMeanAndVarianceOneThird) {
  const std::size_t n = 1 << 20;
  const auto y = noise(kStream, 0, n);
  double sum = 0, square = 0;
  std::vector<int> bins(64);
  for (const float v : y) {
    ASSERT_GE(v, -1.0f);
    ASSERT_LT(v, 1.0f);
    sum += static_cast<double>(v);
    square += static_cast<double>(v) * static_cast<double>(v);
    ++bins[static_cast<std::size_t>((v + 1) * 32)];
  }
  // Five standard deviations: of the mean sqrt(1/3/n), of the mean square sqrt(4/45/n).
  EXPECT_NEAR(sum / static_cast<double>(n), 0, 5 * std::sqrt(1.0 / 3 / static_cast<double>(n)));
  EXPECT_NEAR(square / static_cast<double>(n), 1.0 / 3,
              5 * std::sqrt(4.0 / 45 / static_cast<double>(n)));
  double chi_square = 0;
  for (const int count : bins) chi_square += std::pow(count - n / 64.0, 2) / (n / 64.0);
  EXPECT_LT(chi_square, 63 + 5 * std::sqrt(2 * 63.0));
}

TEST(Noise, HasNoCorrelationWithItselfOrWithOtherStreams) {
  const std::size_t n = 1 << 18;
  const double five_sigma = 5 / std::sqrt(static_cast<double>(n) - 64);
  const auto y = noise(kStream, 0, n);
  for (const std::size_t lag : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 16u, 31u, 64u}) {
    EXPECT_LT(std::abs(correlation(y, y, lag)), five_sigma) << "lag " << lag;
  }
  for (const RandomStream& other :
       {RandomStream{43, 3, 1}, RandomStream{42, 4, 1}, RandomStream{42, 3, 2}}) {
    EXPECT_LT(std::abs(correlation(y, noise(other, 0, n), 0)), five_sigma);
  }
}

TEST(Noise, SampleIsAFunctionOfItsIndex) {
  const auto from_zero = noise(kStream, 0, 300);
  for (const std::int64_t first : {1, 2, 3, 5, 130}) {
    const auto later = noise(kStream, first, 100);
    for (std::size_t i = 0; i < later.size(); ++i) {
      EXPECT_EQ(later[i], from_zero[static_cast<std::size_t>(first) + i]);
    }
  }
  knotwave::support::expect_block_size_does_not_matter<float>(400, [] {
    return [](std::size_t first, std::span<float> out) {
      render_noise(kStream, (std::int64_t{1} << 33) + static_cast<std::int64_t>(first), out);
    };
  });
}

TEST(Noise, TakesTheFourWordsOfACounterInTurn) {
  const auto words = knotwave::base::philox4x32({5, 0, 3, 1}, {42, 0});
  const auto y = noise(kStream, 20, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const double fraction = static_cast<double>(static_cast<std::int32_t>(words[i])) * 0x1p-31;
    EXPECT_EQ(y[i], std::floor(fraction * 0x1p23) * 0x1p-23);
  }
}

TEST(Noise, DoesNotAllocate) {
  std::vector<float> out(1000);
  EXPECT_EQ(knotwave::support::allocations_in([&] { render_noise(kStream, 7, out); }), 0);
}

}  // namespace

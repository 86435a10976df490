// SPDX-License-Identifier: MIT
#include "knotwave/base/time.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;

TEST(SampleTime, FirstSampleIsTheNextWholeOne) {
  EXPECT_EQ(first_sample({7, 0}), 7);
  EXPECT_EQ(first_sample({7, 1}), 8);
  EXPECT_EQ(first_sample({-1, 1}), 0);
}

TEST(SampleTime, OrdersBySampleThenFraction) {
  EXPECT_LT((SampleTime{7, 5}), (SampleTime{8, 0}));
  EXPECT_LT((SampleTime{7, 4}), (SampleTime{7, 5}));
  EXPECT_LT((SampleTime{-1, 5}), (SampleTime{0, 0}));
}

TEST(SampleTime, SamplesSinceIsExactForMoreThanAnHour) {
  EXPECT_EQ(samples_since({10, 1u << 31}, 12), 1.5);
  EXPECT_EQ(samples_since({0, 1}, 1 << 20), 0x1p20 - 0x1p-32);
  const std::int64_t late = std::int64_t{1} << 40;
  EXPECT_EQ(samples_since({late, 1u << 30}, late + 3), 2.75);
}

TEST(Phase, OfCyclesDropsTheWholePart) {
  EXPECT_EQ(phase_from_cycles(0.5).value, kHalf);
  EXPECT_EQ(phase_from_cycles(1000.5).value, kHalf);
  EXPECT_EQ(phase_from_cycles(-0.25).value, 3 * (kHalf / 2));
  EXPECT_EQ(phase_from_cycles(-1000.25).value, 3 * (kHalf / 2));
  EXPECT_EQ(phase_from_cycles(3).value, 0u);
}

TEST(Phase, OfCyclesIsFlooredToTwoToMinus64) {
  EXPECT_EQ(phase_from_cycles(0x1p-64).value, 1u);
  EXPECT_EQ(phase_from_cycles(0x1.8p-64).value, 1u);
  EXPECT_EQ(phase_from_cycles(0x1p-70).value, 0u);
  EXPECT_EQ(phase_from_cycles(-0x1p-70).value, ~std::uint64_t{0});
  EXPECT_EQ(phase_from_cycles(-0x1p-64).value, ~std::uint64_t{0});
  EXPECT_EQ(phase_from_cycles(-0x1.8p-64).value, ~std::uint64_t{0} - 1);
  EXPECT_EQ(phase_from_cycles(std::nextafter(1.0, 0.0)).value, ~std::uint64_t{0} - 2047);
}

TEST(Phase, OfWhatIsNoNumberIsZero) {
  for (const double cycles : {kNan, kInf, -kInf, 0x1p52, -0x1p60, 1e300}) {
    EXPECT_EQ(phase_from_cycles(cycles).value, 0u) << cycles;
  }
}

TEST(Phase, CyclesNeverReadOne) {
  EXPECT_LT(Phase{~std::uint64_t{0}}.cycles(), 1.0);
  for (const double cycles : {0.0, 0.25, 0.1, 0.999}) {
    EXPECT_EQ(phase_from_cycles(cycles).cycles(), std::floor(cycles * 0x1p53) * 0x1p-53);
  }
}

TEST(Phase, IncrementIsClampedToHalfACycle) {
  EXPECT_EQ(phase_increment(12000, 48000).value, kHalf / 2);
  EXPECT_EQ(phase_increment(24000, 48000).value, kHalf);
  EXPECT_EQ(phase_increment(kInf, 48000).value, kHalf);
  EXPECT_EQ(phase_increment(-1, 48000).value, 0u);
  EXPECT_EQ(phase_increment(kNan, 48000).value, 0u);
  EXPECT_EQ(phase_increment(440, kNan).value, 0u);
  EXPECT_EQ(phase_increment(440, 0).value, 0u);
}

TEST(Phase, IncrementIsWithinTwoToMinus53OfTheRatio) {
  for (double hz = 1e-6; hz < 24000; hz *= 1.37) {
    const long double ratio = static_cast<long double>(hz) / 48000;
    const auto got = static_cast<long double>(phase_increment(hz, 48000).value) * 0x1p-64L;
    EXPECT_LE(std::abs(got - ratio), 0x1p-64L + ratio * 0x1p-52L) << hz;
  }
}

}  // namespace
}  // namespace knotwave::base

// SPDX-License-Identifier: MIT
#include "lane_curve.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

using Function = std::function<long double(long double)>;

constexpr double kRate = 48000;

std::vector<double> sampled(const Function& f, std::int64_t n) {
  std::vector<double> values;
  for (std::int64_t i = 0; i < n; ++i) values.push_back(static_cast<double>(f(i / 48000.0L)));
  return values;
}

/// The root of f = level between two times, by bisection of long doubles.
long double root(const Function& f, long double level, long double low, long double high) {
  const bool is_rising = f(high) > f(low);
  for (int i = 0; i < 70; ++i) {
    const long double middle = (low + high) / 2;
    ((f(middle) < level) == is_rising ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The worst error in seconds over every half step that a monotone f crosses in 0..end_s.
long double worst_error_s(const Function& f, long double end_s, double top) {
  const auto n = static_cast<std::int64_t>(std::ceil(end_s * 48000)) + 4;
  const std::vector<double> values = sampled(f, n);
  LaneCurve curve;
  curve.values = values;
  curve.before[0] = curve.before[1] = values[0];
  curve.top = top;
  long double worst = 0;
  Ticks from = 0;
  for (int step = 0; step + 0.5 < static_cast<double>(f(end_s)); ++step) {
    const Ticks found = curve.leaves(-1, step + 0.5, from, sample_ticks(n));
    EXPECT_NE(found, kNever);
    const long double exact = root(f, step + 0.5L, 0, end_s);
    worst = std::max(worst, std::abs(found * 0x1p-20L / 48000 - exact));
    from = found;
  }
  return worst;
}

TEST(LaneCurve, FindsTheCrossingsOfAnAttackOf1MsWithin20Nanoseconds) {
  for (const long double length : {0.001L, 0.002L, 0.01L, 0.1L}) {
    for (const double top : {127.0, 16383.0}) {
      const Function attack = [&](long double t) {
        return t >= length ? top : top * (1 - std::exp(-4 * t / length)) / (1 - std::exp(-4.0L));
      };
      const long double worst = worst_error_s(attack, length, top);
      EXPECT_LT(worst, 20e-9L) << "attack of " << static_cast<double>(length) << " s, top " << top;
      RecordProperty("worst_ns_" + std::to_string(static_cast<int>(length * 1000)) + "ms_" +
                         std::to_string(static_cast<int>(top)),
                     std::to_string(static_cast<double>(worst * 1e9L)));
    }
  }
}

TEST(LaneCurve, FindsTheCrossingsOfOtherCurvesOf1MsWithin200Nanoseconds) {
  constexpr long double kPi = 3.14159265358979323846264338328L;
  const Function cosine = [](long double t) {
    return 63.5L * (1 - std::cos(kPi * std::min(t / 0.001L, 1.0L)));
  };
  EXPECT_LT(worst_error_s(cosine, 0.001L, 127), 200e-9L);
  const Function quintic = [](long double t) {
    const long double x = std::min(t / 0.001L, 1.0L);
    return 127 * x * x * x * (10 + x * (6 * x - 15));
  };
  EXPECT_LT(worst_error_s(quintic, 0.001L, 127), 200e-9L);
}

TEST(LaneCurve, KeepsACornerThatStandsOnASample) {
  LaneCurve curve;
  const std::vector<double> values = {0, 0, 0, 1, 2, 3, 4, 4, 4};
  curve.values = values;
  EXPECT_EQ(curve.leaves(-1, 0.25, 0, sample_ticks(8)), sample_ticks(2) + kTicksPerSample / 4);
  EXPECT_EQ(curve.at(sample_ticks(5) + kTicksPerSample / 2), 3.5);
  EXPECT_EQ(curve.at(sample_ticks(6) + kTicksPerSample / 2), 4);
}

TEST(LaneCurve, AJumpComesAtItsSecondSample) {
  LaneCurve curve;
  const std::vector<double> values = {3, 3, 3, 90, 90, 90};
  curve.values = values;
  EXPECT_EQ(curve.leaves(2, 3.5, 0, sample_ticks(5)), sample_ticks(3));
  EXPECT_EQ(curve.at(sample_ticks(3) - 1), 3);
  EXPECT_EQ(curve.summary(sample_ticks(1), sample_ticks(5)).mean, 0.5 * (3 + 90));
}

TEST(LaneCurve, ReadsNaNAsZeroAndClampsTheRest) {
  LaneCurve curve;
  const std::vector<double> values = {std::nan(""), -5, 1e300, 3};
  curve.values = values;
  EXPECT_EQ(curve.sample(0), 0);
  EXPECT_EQ(curve.sample(1), 0);
  EXPECT_EQ(curve.sample(2), 127);
  EXPECT_EQ(curve.sample(9), 3);
}

TEST(LaneCurve, TicksRoundUpAndComeBackExactly) {
  EXPECT_EQ(ticks_at_or_after({3, 1}), sample_ticks(3) + 1);
  EXPECT_EQ(ticks_at_or_after({3, 1u << 12}), sample_ticks(3) + 1);
  EXPECT_EQ(time_of(ticks_at_or_after({-7, 0x80000000u})), (base::SampleTime{-7, 0x80000000u}));
}

}  // namespace
}  // namespace knotwave::engine

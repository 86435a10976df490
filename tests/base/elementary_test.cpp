// SPDX-License-Identifier: MIT
// The bounds stated in elementary.h, against 32-digit values (elementary_table.inc) and, where the
// platform's long double is longer than double, against its library over many random arguments.
#include "knotwave/base/elementary.h"

#include <array>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/fp_state.h"
#include "knotwave/base/random.h"

#include "support/seed.h"

namespace knotwave::base {
namespace {

struct Reference {
  double x;
  double high;
  double low;
};
#include "elementary_table.inc"

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
constexpr double kMax = std::numeric_limits<double>::max();

/// Spacing of doubles at x.
double ulp(double x) {
  const double magnitude = std::abs(x);
  return std::nextafter(magnitude, kInf) - magnitude;
}

template <class Function, std::size_t count>
double worst_error(const Reference (&table)[count], Function function, double unit = 0) {
  double worst = 0;
  for (const Reference& r : table) {
    const double error = std::abs((function(r.x) - r.high) - r.low);
    worst = std::max(worst, error / (unit > 0 ? unit : ulp(r.high)));
  }
  std::printf("worst error %.3f\n", worst);
  return worst;
}

TEST(Elementary, Exp2IsWithinOneUlp) {
  EXPECT_LE(worst_error(kExp2, [](double x) { return exp2(x); }), 1.0);
}
TEST(Elementary, Log2IsWithinOneUlp) {
  EXPECT_LE(worst_error(kLog2, [](double x) { return log2(x); }), 1.0);
}
TEST(Elementary, SinAndCosAreWithinOneAndAHalfTimesTwoToMinus53) {
  EXPECT_LE(worst_error(
                kSin, [](double x) { return sin_cos_cycles(x).sin; }, 0x1p-53),
            1.5);
  EXPECT_LE(worst_error(
                kCos, [](double x) { return sin_cos_cycles(x).cos; }, 0x1p-53),
            1.5);
}
TEST(Elementary, TanhIsWithinThreeUlp) {
  EXPECT_LE(worst_error(kTanh, [](double x) { return tanh(x); }), 3.0);
}
TEST(Elementary, NoteToHzIsWithinTwoUlp) {
  EXPECT_LE(worst_error(kNote, [](double x) { return note_to_hz(x); }), 2.0);
}
TEST(Elementary, DbToGainIsWithinOneUlp) {
  EXPECT_LE(worst_error(kGain, [](double x) { return db_to_gain(x); }), 1.0);
}
TEST(Elementary, GainToDbIsWithinTwoUlp) {
  EXPECT_LE(worst_error(kLevel, [](double x) { return gain_to_db(x); }), 2.0);
}

#if LDBL_MANT_DIG >= 64
/// Worst error in ulp over random arguments in low..high, against a long double function.
template <class Function, class Truth>
double worst_random(double low, double high, Function function, Truth truth) {
  const RandomStream random{support::test_seed(), 0, 1000};
  const int count = support::test_count(200000);
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double x = low + (high - low) * random.unit(static_cast<std::uint64_t>(i));
    const long double y = truth(static_cast<long double>(x));
    const long double error = std::abs(static_cast<long double>(function(x)) - y);
    worst = std::max(worst, static_cast<double>(error) / ulp(static_cast<double>(y)));
  }
  std::printf("worst error %.3f ulp\n", worst);
  return worst;
}

TEST(Elementary, BoundsHoldOverRandomArguments) {
  const auto exp2_truth = [](long double x) { return std::exp2(x); };
  const auto log2_truth = [](long double x) { return std::log2(x); };
  const auto tanh_truth = [](long double x) { return std::tanh(x); };
  EXPECT_LE(worst_random(
                -1, 1, [](double x) { return exp2(x); }, exp2_truth),
            1.0);
  EXPECT_LE(worst_random(
                -1000, 1000, [](double x) { return exp2(x); }, exp2_truth),
            1.0);
  EXPECT_LE(worst_random(
                0.5, 2, [](double x) { return log2(x); }, log2_truth),
            1.0);
  EXPECT_LE(worst_random(
                1e-300, 1e300, [](double x) { return log2(x); }, log2_truth),
            1.0);
  EXPECT_LE(worst_random(
                -4, 4, [](double x) { return tanh(x); }, tanh_truth),
            3.0);
}
#endif

TEST(Elementary, ExactWhereTheTrueValueIsADouble) {
  for (int n = -1022; n <= 1023; ++n) {
    const double power = std::ldexp(1.0, n);
    ASSERT_EQ(exp2(n), power);
    ASSERT_EQ(log2(power), n);
  }
  for (int n = -5; n <= 5; ++n) ASSERT_EQ(note_to_hz(69 + 12 * n), std::ldexp(440.0, n));
  for (int quarter = -4000; quarter <= 4000; ++quarter) {
    const SinCos value = sin_cos_cycles(0.25 * quarter);
    const int phase = quarter & 3;
    ASSERT_EQ(value.sin, phase == 1 ? 1 : phase == 3 ? -1 : 0);
    ASSERT_EQ(value.cos, phase == 0 ? 1 : phase == 2 ? -1 : 0);
  }
  EXPECT_EQ(sin_cos_cycles(0x1p51 - 0.25).sin, -1);
  EXPECT_EQ(db_to_gain(0), 1);
  EXPECT_EQ(gain_to_db(1), 0);
}

TEST(Elementary, Exp2IsDefinedForEveryDouble) {
  EXPECT_EQ(exp2(kNan), 1);
  EXPECT_EQ(exp2(-kInf), 0);
  EXPECT_EQ(exp2(std::nextafter(-1022.0, -kInf)), 0);
  EXPECT_EQ(exp2(-1022), DBL_MIN);
  EXPECT_GT(exp2(std::nextafter(1024.0, 0.0)), 0x1.ffffffffp1023);
  EXPECT_LT(exp2(std::nextafter(1024.0, 0.0)), kInf);
  EXPECT_EQ(exp2(1024), kMax);
  EXPECT_EQ(exp2(kInf), kMax);
  EXPECT_EQ(exp2(kTiny), 1);
  EXPECT_EQ(exp2(-0.0), 1);
}

TEST(Elementary, Log2IsDefinedForEveryDouble) {
  for (const double x : {kNan, 0.0, -0.0, -1.0, -kInf, kTiny, std::nextafter(DBL_MIN, 0.0)}) {
    EXPECT_EQ(log2(x), -1074) << x;
    EXPECT_EQ(gain_to_db(x), -1074 * detail::kOctaveDb) << x;
  }
  EXPECT_EQ(log2(DBL_MIN), -1022);
  EXPECT_EQ(log2(kMax), 1024);
  EXPECT_EQ(log2(kInf), 1024);
  EXPECT_NEAR(gain_to_db(0), -6466.1, 0.05);
}

TEST(Elementary, SinCosOutsideTheRangeIsPhaseZero) {
  for (const double x : {kNan, kInf, -kInf, 0x1p51, -0x1p51, kMax}) {
    EXPECT_EQ(sin_cos_cycles(x).sin, 0) << x;
    EXPECT_EQ(sin_cos_cycles(x).cos, 1) << x;
  }
}

TEST(Elementary, TanhIsOddBoundedAndDefinedForEveryDouble) {
  EXPECT_EQ(tanh(kNan), 0);
  EXPECT_EQ(tanh(kInf), 1);
  EXPECT_EQ(tanh(-kMax), -1);
  EXPECT_EQ(tanh(kTiny), kTiny);
  EXPECT_TRUE(std::signbit(tanh(-0.0)));
  double before = 0;
  for (double x = 0x1p-40; x < 30; x *= 1.0009) {
    EXPECT_EQ(tanh(-x), -tanh(x));
    EXPECT_LE(tanh(x), 1);
    EXPECT_GE(tanh(x), before * (1 - 0x1p-50)) << x;
    before = tanh(x);
  }
}

TEST(Elementary, PitchAndLevelAreDefinedForEveryDouble) {
  EXPECT_EQ(note_to_hz(kNan), 440);
  EXPECT_EQ(note_to_hz(kInf), note_to_hz(12000));
  EXPECT_EQ(note_to_hz(-kMax), note_to_hz(-12000));
  EXPECT_TRUE(std::isnormal(note_to_hz(-12000)) && std::isnormal(note_to_hz(12000)));
  EXPECT_EQ(db_to_gain(kNan), 1);
  EXPECT_EQ(db_to_gain(-kInf), 0);
  EXPECT_EQ(db_to_gain(-6153.5), 0);
  EXPECT_EQ(db_to_gain(kInf), kMax);
  EXPECT_TRUE(std::isnormal(db_to_gain(-6153)));
}

TEST(Elementary, RunsAtCompileTimeWithTheSameBits) {
  constexpr double kPower = exp2(0.3);
  constexpr double kLog = log2(3.7);
  constexpr SinCos kTurn = sin_cos_cycles(0.1);
  constexpr double kBent = tanh(0.7);
  volatile double x = 0.3;
  EXPECT_EQ(exp2(x), kPower);
  x = 3.7;
  EXPECT_EQ(log2(x), kLog);
  x = 0.1;
  EXPECT_EQ(sin_cos_cycles(x).sin, kTurn.sin);
  EXPECT_EQ(sin_cos_cycles(x).cos, kTurn.cos);
  x = 0.7;
  EXPECT_EQ(tanh(x), kBent);
}

TEST(Elementary, SpansHaveTheBitsOfSingleCalls) {
  std::vector<double> in, out(1003);
  for (int i = 0; i < 1003; ++i) in.push_back(0.037 * i - 15);
  exp2(in, out);
  for (std::size_t i = 0; i < in.size(); ++i) ASSERT_EQ(out[i], exp2(in[i]));
  exp2(in, in);
  EXPECT_EQ(in, out);
}

TEST(Elementary, FlushingDenormalsChangesNothing) {
  const auto evaluate = [](FpStateGuard::Denormals denormals) {
    const FpStateGuard guard(denormals);
    std::vector<double> values;
    for (double x = -1100; x < 1100; x += 0.7311) {
      values.insert(values.end(), {exp2(x), sin_cos_cycles(x).sin, tanh(x), note_to_hz(x),
                                   db_to_gain(x), log2(exp2(x)), gain_to_db(exp2(x))});
    }
    return values;
  };
  EXPECT_EQ(evaluate(FpStateGuard::Denormals::kept), evaluate(FpStateGuard::Denormals::flushed));
}

}  // namespace
}  // namespace knotwave::base

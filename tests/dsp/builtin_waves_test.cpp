// SPDX-License-Identifier: MIT
#include "knotwave/dsp/builtin_waves.h"

#include <cmath>

#include <gtest/gtest.h>

namespace {

using namespace knotwave::dsp;

constexpr double kPi = 3.14159265358979323846;

double value(const knotwave::curves::NurbsCurve& curve, double u) {
  double out = 0;
  curve.evaluate(u, std::span(&out, 1));
  return out;
}

TEST(BuiltinWaves, SineCurveIsWithinOneBillionthOfASine) {
  const auto curve = builtin_curve("sine");
  ASSERT_TRUE(curve) << curve.error().message;
  double worst = 0;
  for (int k = 0; k < 4096; ++k) {
    worst = std::max(worst, std::abs(value(*curve, k / 4096.0) - std::sin(2 * kPi * k / 4096)));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_NEAR(value(*curve, 0), 0, 1e-15);
}

TEST(BuiltinWaves, CornersAndJumpsAreWhereTheHeaderSays) {
  const auto saw = builtin_curve("saw"), square = builtin_curve("square"),
             triangle = builtin_curve("triangle");
  ASSERT_TRUE(saw && square && triangle);
  EXPECT_EQ(value(*saw, 0), -1);
  EXPECT_EQ(value(*saw, 0.75), 0.5);
  EXPECT_EQ(value(*saw, 1), 1);
  EXPECT_EQ(value(*square, 0.25), 1);
  EXPECT_EQ(value(*square, 0.5), -1);
  EXPECT_EQ(value(*triangle, 0), 0);
  EXPECT_EQ(value(*triangle, 0.25), 1);
  EXPECT_EQ(value(*triangle, 0.75), -1);
  EXPECT_EQ(value(*triangle, 1), 0);
}

TEST(BuiltinWaves, HarmonicsAreThoseOfTheTextbook) {
  const auto sine = builtin_wave("sine"), saw = builtin_wave("saw"),
             square = builtin_wave("square"), triangle = builtin_wave("triangle");
  ASSERT_TRUE(sine && saw && square && triangle);
  EXPECT_EQ(sine->level_count(), 1);
  EXPECT_EQ(sine->coefficients(0, 0)[1], std::complex<double>(0, -0.5));
  for (int n = 1; n < 100; ++n) {
    const auto k = static_cast<std::size_t>(n);
    const bool odd = n % 2 == 1;
    EXPECT_NEAR(2 * std::abs(saw->coefficients(0, 0)[k]), 2 / (kPi * n), 1e-14);
    EXPECT_NEAR(2 * std::abs(square->coefficients(0, 0)[k]), odd ? 4 / (kPi * n) : 0, 1e-14);
    EXPECT_NEAR(2 * std::abs(triangle->coefficients(0, 0)[k]), odd ? 8 / (kPi * kPi * n * n) : 0,
                1e-14);
  }
}

TEST(BuiltinWaves, AWrongWordIsToldTheRightOnes) {
  EXPECT_TRUE(is_builtin_wave("square"));
  EXPECT_FALSE(is_builtin_wave("Square"));
  EXPECT_EQ(builtin_wave_names().size(), 4U);
  const auto wave = builtin_wave("sawe");
  ASSERT_FALSE(wave);
  EXPECT_EQ(wave.error().code, knotwave::ErrorCode::unknown_name);
  EXPECT_EQ(wave.error().message,
            "there is no built-in wave 'sawe': sine, saw, square or triangle; did you mean 'saw'?");
}

}  // namespace

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/crossfade.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace {

using knotwave::dsp::equal_gain;
using knotwave::dsp::equal_power;
using knotwave::dsp::GainPair;

struct ArcError {
  double power = 0;  // largest |a^2 + b^2 - 1|
  double degrees = 0;
};

// Positions i * stride / 2^24: with stride 1 all of the 24-bit ones.
ArcError worst_arc_error(int stride) {
  ArcError worst;
  for (int i = 0; i <= 1 << 24; i += stride) {
    const double position = static_cast<double>(i) * 0x1p-24;
    const GainPair gains = equal_power(position);
    const double a = gains.a, b = gains.b;
    worst.power = std::max(worst.power, std::abs(a * a + b * b - 1));
    const double degrees = std::atan2(b, a) * 180 / std::numbers::pi;
    worst.degrees = std::max(worst.degrees, std::abs(degrees - 90 * position));
  }
  return worst;
}

void expect_contract(const ArcError& worst) {
  EXPECT_LE(worst.power, 2e-7);
  EXPECT_LE(10 * std::log10(1 + worst.power), 1e-6);
  EXPECT_LE(worst.degrees, 0.0002);
  ::testing::Test::RecordProperty("power_ripple_db",
                                  std::to_string(10 * std::log10(1 + worst.power)));
  std::printf("power ripple %.3g dB, angle error %.3g degrees\n", 10 * std::log10(1 + worst.power),
              worst.degrees);
}

TEST(EqualPower, HasNoPowerRippleAndALinearAngle) { expect_contract(worst_arc_error(61)); }

TEST(EqualPowerStress, HoldsAtEveryOneOf2To24Positions) { expect_contract(worst_arc_error(1)); }

TEST(EqualPower, IsExactAtTheEndsAndEvenInTheMiddle) {
  EXPECT_EQ(equal_power(0).a, 1.0f);
  EXPECT_EQ(equal_power(0).b, 0.0f);
  EXPECT_EQ(equal_power(1).a, 0.0f);
  EXPECT_EQ(equal_power(1).b, 1.0f);
  EXPECT_EQ(equal_power(0.5).a, equal_power(0.5).b);
  EXPECT_EQ(equal_power(0.5).a, std::sqrt(0.5f));
}

TEST(EqualPower, MirrorsItself) {
  for (int i = 0; i <= 4096; ++i) {
    const double position = i / 4096.0;
    EXPECT_EQ(equal_power(position).a, equal_power(1 - position).b) << position;
  }
}

TEST(EqualPower, NeverGoesBack) {
  float last = -1;
  for (int i = 0; i <= 1 << 16; ++i) {
    const float b = equal_power(i * 0x1p-16).b;
    EXPECT_GE(b, last);
    last = b;
  }
}

TEST(EqualPower, ClampsAndReadsNanAsZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double low : {-1.0, -infinity, nan}) {
    EXPECT_EQ(equal_power(low).a, 1.0f);
    EXPECT_EQ(equal_power(low).b, 0.0f);
    EXPECT_EQ(equal_gain(low).a, 1.0f);
    EXPECT_EQ(equal_gain(low).b, 0.0f);
  }
  for (const double high : {2.0, infinity}) {
    EXPECT_EQ(equal_power(high).b, 1.0f);
    EXPECT_EQ(equal_gain(high).b, 1.0f);
  }
}

TEST(EqualGain, AddsUpToOne) {
  for (int i = 0; i <= 1000; ++i) {
    const GainPair gains = equal_gain(i / 1000.0);
    EXPECT_NEAR(gains.a + gains.b, 1, 1e-7);
  }
}

TEST(EqualPower, BlocksOfAnySizeGiveTheBitsOfOneAtATime) {
  const std::size_t n = 1000;
  std::vector<double> position(n);
  std::vector<float> a(n);
  for (std::size_t i = 0; i < n; ++i) position[i] = static_cast<double>(i) * 1.003e-3;
  knotwave::support::expect_block_size_does_not_matter<float>(n, [&] {
    return [&](std::size_t first, std::span<float> out) {
      equal_power(std::span(position).subspan(first, out.size()),
                  std::span(a).subspan(first, out.size()), out);
    };
  });
  std::vector<float> b(n);
  EXPECT_EQ(knotwave::support::allocations_in([&] { equal_power(position, a, b); }), 0);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(a[i], equal_power(position[i]).a);
    EXPECT_EQ(b[i], equal_power(position[i]).b);
  }
}

using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::CrossfadeLaw;

NurbsCurve curve_of(int dim, int degree, std::vector<double> points, std::vector<double> knots,
                    std::vector<double> weights = {}) {
  CurveSpec spec;
  spec.dim = dim;
  spec.degree = degree;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.weights = std::move(weights);
  return NurbsCurve::create(std::move(spec)).value();
}

TEST(CrossfadeLaw, OneCoordinateIsTheGainOfBAndMirroredThatOfA) {
  const auto law = CrossfadeLaw::create(curve_of(1, 2, {0, 0.2, 1}, {4, 4, 4, 8, 8, 8})).value();
  const auto gain = [](double p) { return 0.4 * p * (1 - p) + p * p; };
  for (const double p : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(law.at(p).b, gain(p), 1e-7);
    EXPECT_NEAR(law.at(p).a, gain(1 - p), 1e-7);
  }
  EXPECT_EQ(law.at(-3).b, 0);
  EXPECT_EQ(law.at(3).b, 1);
  EXPECT_EQ(law.at(std::numeric_limits<double>::quiet_NaN()).b, 0);
}

TEST(CrossfadeLaw, TwoCoordinatesAreTheGains) {
  const double w = std::sqrt(0.5);
  const auto law =
      CrossfadeLaw::create(curve_of(2, 2, {1, 0, 1, 1, 0, 1}, {0, 0, 0, 1, 1, 1}, {1, w, 1}))
          .value();
  for (int i = 0; i <= 100; ++i) {
    const GainPair gains = law.at(i / 100.0);
    EXPECT_NEAR(gains.a * gains.a + gains.b * gains.b, 1, 2e-7);
  }
  EXPECT_EQ(law.at(0).a, 1);
  EXPECT_EQ(law.at(1).b, 1);
}

TEST(CrossfadeLaw, BlocksGiveTheBitsOfOneAtATime) {
  std::vector<double> position;
  for (int i = -10; i <= 110; ++i) position.push_back(i / 100.0);
  std::vector<float> a(position.size()), b(position.size());
  for (const CrossfadeLaw& law :
       {CrossfadeLaw(), CrossfadeLaw::linear(),
        CrossfadeLaw::create(curve_of(1, 2, {0, 0.2, 1}, {0, 0, 0, 1, 1, 1})).value()}) {
    EXPECT_EQ(knotwave::support::allocations_in([&] { law.render(position, a, b); }), 0);
    for (std::size_t i = 0; i < position.size(); ++i) {
      EXPECT_EQ(a[i], law.at(position[i]).a);
      EXPECT_EQ(b[i], law.at(position[i]).b);
    }
  }
}

TEST(CrossfadeLaw, RefusesThreeCoordinates) {
  const auto law = CrossfadeLaw::create(curve_of(3, 1, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}));
  ASSERT_FALSE(law.has_value());
  EXPECT_EQ(
      law.error().message,
      "a crossfade law has 1 coordinate (the gain of b) or 2 (the gains of a and b), this curve "
      "has 3");
}

}  // namespace

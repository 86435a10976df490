// SPDX-License-Identifier: MIT
#include "knotwave/curves/extrapolate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "example_curve.h"
#include "random_curve.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::Extrapolation;
using curves::NurbsCurve;
using curves::Side;
using Wide = __float128;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Extrapolation kModes[] = {Extrapolation::hold, Extrapolation::linear,
                                    Extrapolation::periodic, Extrapolation::mirror};

double at(const NurbsCurve& curve, double u, Extrapolation before, Extrapolation after) {
  double out = 0;
  evaluate_extrapolated(curve, u, before, after, {&out, 1});
  return out;
}
double at(const NurbsCurve& curve, double u, Extrapolation mode) {
  return at(curve, u, mode, mode);
}

TEST(Extrapolate, InsideTheDomainIsEvaluateToTheBit) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(2000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    double plain[curves::kMaxDim] = {}, extrapolated[curves::kMaxDim] = {};
    curve.evaluate(u, plain);
    evaluate_extrapolated(curve, u, kModes[dice.below(4)], kModes[dice.below(4)], extrapolated);
    for (int c = 0; c < curve.dim(); ++c) EXPECT_EQ(plain[c], extrapolated[c]) << u;
  }
}

// 1 + u + u^2 over 0..2: slopes 1 and 5.
TEST(Extrapolate, EachSideHasItsOwnMode) {
  const NurbsCurve parabola = scalar(2, {1, 2, 7}, {0, 0, 0, 2, 2, 2});
  using enum Extrapolation;
  EXPECT_EQ(at(parabola, -3, hold, linear), 1);
  EXPECT_EQ(at(parabola, 6, hold, linear), 7 + 5 * 4);
  EXPECT_EQ(at(parabola, -3, linear, hold), 1 - 3);
  EXPECT_EQ(at(parabola, 6, linear, hold), 7);
  EXPECT_EQ(at(parabola, -0.5, periodic, mirror), 1 + 1.5 + 2.25);
  EXPECT_EQ(at(parabola, 2.5, periodic, mirror), 1 + 1.5 + 2.25);
  EXPECT_EQ(at(parabola, -0.5, mirror, periodic), 1 + 0.5 + 0.25);
  EXPECT_EQ(at(parabola, 2.5, mirror, periodic), 1 + 0.5 + 0.25);
  EXPECT_EQ(at(parabola, 4.5, mirror), 1 + 0.5 + 0.25) << "forwards again";
}

// https://www.w3.org/TR/css-easing-1/: outside 0..1 along the end tangents. ease is
// cubic-bezier(0.25, 0.1, 0.25, 1): slope 0.4 before, 0 after.
TEST(Extrapolate, HandlesGoOnAsCssEasingDoes) {
  CurveSpec spec;
  spec.dim = 2;
  spec.points = {0, 0, 0.25, 0.1, 0.25, 1, 1, 1};
  const NurbsCurve ease = made(spec);
  double xy[2];
  for (const double u : {-4.0, -0.5, -0.01}) {
    evaluate_extrapolated(ease, u, Extrapolation::linear, Extrapolation::linear, xy);
    EXPECT_NEAR(xy[1], 0.4 * xy[0], 1e-15);
    EXPECT_LT(xy[0], 0);
  }
  evaluate_extrapolated(ease, 3, Extrapolation::linear, Extrapolation::linear, xy);
  EXPECT_EQ(xy[1], 1);
  EXPECT_GT(xy[0], 1);
}

TEST(Extrapolate, WholePeriodsAreTheStartAndJumpsKeepTheirSides) {
  // 0 to 1, then a jump at 0.5 to 3, then to 4.
  const NurbsCurve steps = scalar(1, {0, 1, 3, 4}, {0, 0, 0.5, 0.5, 1, 1}, {0.5});
  using enum Extrapolation;
  EXPECT_EQ(at(steps, 1, periodic), 4) << "the end itself is inside";
  for (const double k : {-1e9, -7.0, -1.0, 2.0, 3.0, 12345678.0}) {
    EXPECT_EQ(at(steps, k, periodic), 0) << k;
    EXPECT_EQ(at(steps, k + 0.5, periodic), 3) << k;
    EXPECT_EQ(at(steps, std::nextafter(k + 0.5, -kInfinity), periodic) < 1.1, true) << k;
  }
  for (const double k : {-2.0, 2.0, 40.0, -66.0}) {
    EXPECT_EQ(at(steps, k, mirror), 0) << k;
    EXPECT_EQ(at(steps, k + 1, mirror), 4) << k;
    EXPECT_EQ(at(steps, k + 0.5, mirror), 3) << "forwards, from the right: after the jump";
    EXPECT_EQ(at(steps, k + 1.5, mirror), 1) << "backwards, from the right: before the jump";
  }
}

TEST(Extrapolate, WhatIsNoNumberAndWhatIsTooFarIsDefined) {
  const NurbsCurve rising = scalar(1, {1, 3});
  const NurbsCurve flat_end = scalar(2, {1, 3, 3});
  using enum Extrapolation;
  for (const Extrapolation mode : kModes) {
    EXPECT_EQ(at(rising, std::numeric_limits<double>::quiet_NaN(), mode), 1);
    if (mode == linear) continue;
    EXPECT_EQ(at(rising, kInfinity, mode), 3);
    EXPECT_EQ(at(rising, -kInfinity, mode), 1);
    EXPECT_EQ(at(rising, 1e308, mode), 3);
    EXPECT_EQ(at(rising, -1e308, mode), 1);
  }
  EXPECT_EQ(at(rising, kInfinity, linear), 1e300);
  EXPECT_EQ(at(rising, -kInfinity, linear), -1e300);
  EXPECT_EQ(at(rising, 1e308, linear), 1e300);
  EXPECT_EQ(at(rising, 1e300, linear), 1e300) << "twice that, limited";
  EXPECT_EQ(at(flat_end, kInfinity, linear), 3);
  EXPECT_EQ(at(flat_end, 1e308, linear), 3);
}

/// Where u is in the period, exact to 2^-113 of u.
double wide_place(const NurbsCurve& curve, double u, bool mirrored, bool& backwards) {
  const Wide low = curve.u_min(), period = Wide(curve.u_max()) - low;
  Wide rest = Wide(u) - low, whole = 0;
  for (int k = 53; k >= 0; --k) {
    const Wide step = static_cast<Wide>(std::ldexp(1.0, k));
    const Wide sized = rest < 0 ? -rest : rest;
    if (sized >= step * period) {
      whole += rest < 0 ? -step : step;
      rest -= rest < 0 ? -step * period : step * period;
    }
  }
  if (rest < 0) {
    rest += period;
    whole -= 1;
  }
  const double half = static_cast<double>(whole) / 2;
  backwards = mirrored && half != std::floor(half);
  return static_cast<double>(backwards ? Wide(curve.u_max()) - rest : low + rest);
}

TEST(Extrapolate, NoPeriodIsTooFarForTheRightPhase) {
  Dice dice(support::test_seed());
  int far = 0;
  for (int round = 0; round < support::test_count(10000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double length = curve.u_max() - curve.u_min();
    const double u = curve.u_min() + length * std::ldexp(dice.between(-1, 1), dice.below(51));
    if (u >= curve.u_min() && u <= curve.u_max()) continue;
    const bool mirrored = dice.one_in(2);
    bool backwards = false;
    const double place = wide_place(curve, u, mirrored, backwards);
    double out[curves::kMaxDim] = {}, expected[curves::kMaxDim] = {}, beside[curves::kMaxDim] = {};
    const Extrapolation mode = mirrored ? Extrapolation::mirror : Extrapolation::periodic;
    evaluate_extrapolated(curve, u, mode, mode, out);
    // The place is a double; the two may round it to neighbours, 2^-53 periods apart at most.
    const double ulp = std::max(0x1p-52 * length,
                                ulp_of(std::max(std::abs(curve.u_min()), std::abs(curve.u_max()))));
    bool found = false;
    for (const double nudge : {0.0, -ulp, ulp}) {
      const double there = std::clamp(place + nudge, curve.u_min(), curve.u_max());
      curve.evaluate(there, backwards || there == curve.u_max() ? Side::left : Side::right,
                     expected);
      found = found || std::equal(out, out + curve.dim(), expected);
      if (nudge < 0) std::copy_n(expected, curve.dim(), beside);
    }
    if (!found) {  // between neighbours
      bool between = true;
      for (int c = 0; c < curve.dim(); ++c) {
        between = between && (out[c] - beside[c]) * (out[c] - expected[c]) <= 0;
      }
      EXPECT_TRUE(between) << "round " << round << " u " << u << " place " << place;
    }
    ++far;
  }
  EXPECT_GT(far, support::test_count(5000));
}

TEST(Extrapolate, AllocatesNothing) {
  Dice dice(support::test_seed());
  const NurbsCurve curve = random_curve(dice, 15);
  double out[curves::kMaxDim];
  for (const Extrapolation mode : kModes) {
    EXPECT_EQ(support::allocations_in([&] { evaluate_extrapolated(curve, -7, mode, mode, out); }),
              0);
  }
}

TEST(Extrapolate, StaysInTheHullExceptAlongTangents) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(2000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = dice.between(-1, 1) * std::ldexp(1.0, dice.below(80));
    const double most = largest_coordinate(curve);
    double out[curves::kMaxDim] = {};
    for (const Extrapolation mode : kModes) {
      evaluate_extrapolated(curve, u, mode, mode, out);
      for (int c = 0; c < curve.dim(); ++c) {
        ASSERT_TRUE(std::isfinite(out[c]));
        if (mode != Extrapolation::linear) {
          EXPECT_LE(std::abs(out[c]), most);
        }
      }
    }
  }
}

}  // namespace
}  // namespace knotwave::test

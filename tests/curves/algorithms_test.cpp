// SPDX-License-Identifier: MIT
#include "knotwave/curves/algorithms.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

using base::index_of;

TEST(Greville, PointsAtTheirAbscissaeMakeTheIdentity) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 500; ++round) {
    CurveSpec spec = random_spec(dice);
    spec.periodic = false;
    spec.knots.clear();
    spec.dim = 1;
    spec.weights.clear();
    const NurbsCurve shape = *NurbsCurve::create(spec);
    CurveSpec line = shape.spec();
    line.points = greville_abscissae(shape);
    const NurbsCurve identity = *NurbsCurve::create(line);
    const double u = dice.unit();
    EXPECT_NEAR(at(identity, u), u, 4 * 0x1p-53);
  }
}

// docs/curves.md, Periodic curves.
TEST(Greville, OfAPeriodicCurveAreNotWrapped) {
  CurveSpec wave = spec_of(3, {0, 1, 0, -1});
  wave.periodic = true;
  EXPECT_THAT(greville_abscissae(made(wave)),
              testing::ElementsAre(-0.25, 0, 0.25, 0.5, 0.75, 1, 1.25));
}

TEST(HullRange, IsTheRangeOfTheControlPoints) {
  const curves::HullRange range = hull_range(made(spec_of(2, {0, 3, -2, 1})));
  EXPECT_EQ(range.low, -2);
  EXPECT_EQ(range.high, 3);
}

// A cubic from 0 to 1 with tangents a and b long never goes back iff both are at most 1 or
// a^2 + b^2 + ab - 2a - 2b + 1 <= 0: (1 - a - b)^2 <= ab from the discriminant of x'.
TEST(IsNonDecreasing, DecidesCubicHandlesAsTheEllipseDoes) {
  for (double a = 0; a <= 1.5; a += 0.015625) {
    for (double b = 0; b <= 1.5; b += 0.015625) {
      const double ellipse = a * a + b * b + a * b - 2 * a - 2 * b + 1;
      if (std::abs(ellipse) < 1e-9) continue;  // on the border the slope only touches 0
      const bool expected = (a <= 1 && b <= 1) || ellipse < 0;
      EXPECT_EQ(is_non_decreasing(made(spec_of(3, {0, a, 1 - b, 1}))), expected) << a << " " << b;
    }
  }
}

TEST(IsNonDecreasing, AcceptsVerticalTangentsFlatsAndJumpsUp) {
  EXPECT_TRUE(is_non_decreasing(made(spec_of(3, {0, 1, 0, 1}))));  // slope 0 in the middle
  EXPECT_TRUE(is_non_decreasing(made(spec_of(5, {0.1, 0.1, 0.1, 0.1, 0.1, 0.1}))));
  EXPECT_TRUE(is_non_decreasing(made(spec_of(5, {1, 1, 1, 1, 1, 1}, {}, {1, 9, 0.1, 7, 2, 1}))));
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {0, 1, 2, 3};
  spec.knots = {0, 0, 0.5, 0.5, 1, 1};
  spec.jumps = {0.5};
  EXPECT_TRUE(is_non_decreasing(*NurbsCurve::create(spec)));
  spec.points = {0, 1, 0.9, 3};
  EXPECT_FALSE(is_non_decreasing(*NurbsCurve::create(spec)));
}

TEST(IsNonDecreasing, AgreesWithDenseSamplesOfRandomCurves) {
  Dice dice(support::test_seed());
  int rising = 0, falling = 0, refused = 0;
  for (int round = 0; round < 2000; ++round) {
    CurveSpec spec = random_spec(dice, 1 + round % 6);
    spec.dim = 1;
    spec.periodic = false;
    spec.knots.clear();
    spec.points.resize(index_of(spec.degree + 1 + dice.below(3)));
    spec.weights.resize(spec.weights.empty() ? 0 : spec.points.size());
    for (double& w : spec.weights) w = dice.between(0.3, 3);  // no spike between two samples
    double x = 0;
    for (double& point : spec.points) point = x += dice.between(-0.3, 1);
    const NurbsCurve curve = *NurbsCurve::create(spec);
    double fall = 0, before = at(curve, 0);
    for (int i = 1; i <= 500; ++i) {
      const double value = at(curve, i / 500.0);
      fall = std::max(fall, before - value);
      before = value;
    }
    const bool verdict = is_non_decreasing(curve);
    rising += verdict;
    EXPECT_TRUE(!verdict || fall < 1e-12) << round << ": falls by " << fall;
    falling += fall > 1e-12;
    refused += !verdict;
  }
  EXPECT_GT(rising, 200);
  EXPECT_LT(rising, 1800);
  // Samples see every fall but the smallest ones, so a verdict of "falls" is rarely theirs alone.
  EXPECT_LE(refused - falling, 20);
}

}  // namespace
}  // namespace knotwave::test

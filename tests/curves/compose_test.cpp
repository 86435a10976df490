// SPDX-License-Identifier: MIT
// compose() of combine.h; its values against exact rationals: edit_references_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/combine.h"
#include "knotwave/curves/reparametrize.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsEmpty;

// s^2 of (t + t^2) / 2 is t^2 / 4 + t^3 / 2 + t^4 / 4.
TEST(Compose, OfTwoParabolasByHand) {
  const auto both = compose(made(spec_of(2, {0, 0, 1})), made(spec_of(2, {0, 0.25, 1})));
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->degree(), 4);
  for (double t = 0; t <= 1; t += 0.125) {
    const double inner = (t + t * t) / 2;
    EXPECT_EQ(at(*both, t), inner * inner);
  }
}

double steepest(const NurbsCurve& curve) {
  double most = 0;
  for (int i = 0; i <= 256; ++i) {
    const double u = curve.u_min() + (curve.u_max() - curve.u_min()) * i / 256;
    for (const Side side : {Side::left, Side::right}) {
      double out[2];
      curve.derivatives(u, 1, side, out);
      most = std::max(most, std::abs(out[1]));
    }
  }
  return most;
}

TEST(Compose, IsPointwise) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(1000); ++round) {
    CurveSpec map = random_spec(dice, 1 + dice.below(4)), shape = spec_of(1 + dice.below(3), {});
    map.knots.clear();
    map.dim = 1;
    map.periodic = false;
    for (double& w : map.weights) w = dice.between(0.25, 4);
    for (double& x : map.points) x = dice.between(-1, 1);
    const int n = shape.degree + 1 + dice.below(4);
    for (int i = 0; i < n; ++i) shape.points.push_back(dice.unit());
    if (dice.one_in(2)) {
      for (int i = 0; i < n; ++i) shape.weights.push_back(dice.between(0.25, 4));
    }
    map.weights.resize(map.weights.empty() ? 0 : map.points.size(), 1.0);
    const NurbsCurve outer = made(map), inner = made(shape);
    const auto both = compose(outer, inner);
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_THAT(both->jumps(), IsEmpty());
    // v is rounded, and so are crossings: what that does to the outer curve is not composition's.
    const double steep = steepest(outer);
    const double allowed =
        4 * ulp_of(largest_coordinate(*both)) + steep * (1 + steepest(inner)) * 0x1p-53;
    for (int i = 0; i < 20; ++i) {
      const double u = dice.unit();
      const double v = at(inner, u);
      worst = std::max(worst, std::abs(at(*both, u) - at(outer, v)) / allowed);
    }
  }
  std::printf("worst %.3f of what is allowed\n", worst);
  EXPECT_LE(worst, 1);
}

// Steep by weights 1000 to 1, so that a crossing rounded to a double is worth more than 4 ulp.
TEST(Compose, IsOffByTheRoundingOfCrossingsWhereTheOuterCurveIsSteep) {
  CurveSpec map = spec_of(2, {2, 0, -2, -3, 3}), shape = spec_of(1, {.7, 0, 1, 0});
  map.weights = {.1, .01, 10, .1, 100};
  const NurbsCurve outer = made(map), inner = made(shape);
  const auto both = compose(outer, inner);
  ASSERT_TRUE(both) << both.error().message;
  const double ulp = ulp_of(largest_coordinate(*both));
  const double moved = steepest(outer) * (1 + steepest(inner)) * 0x1p-53;
  double worst = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double u = i == 0 ? 0.5659763227068301 : i / 100000.0;
    worst = std::max(worst, std::abs(at(*both, u) - at(outer, at(inner, u))));
  }
  std::printf("worst %.1f ulp, allowed %.1f\n", worst / ulp, 4 + moved / ulp);
  EXPECT_GT(worst, 4 * ulp);
  EXPECT_LE(worst, 4 * ulp + moved);
}

TEST(Compose, CrossesCornersAtKnots) {
  // A hard limiter at +-1/2 over a line from -1 to 1, whose knots are at -1/2 and 1/2.
  const NurbsCurve limiter = made(spec_of(1, {-0.5, -0.5, 0.5, 0.5}, {-1, -1, -0.5, 0.5, 1, 1}));
  const auto limited = compose(limiter, made(spec_of(1, {-1, 1})));
  ASSERT_TRUE(limited) << limited.error().message;
  EXPECT_THAT(limited->knots(), ElementsAre(0, 0, 0.25, 0.75, 1, 1));
  EXPECT_THAT(limited->points(), ElementsAre(-0.5, -0.5, 0.5, 0.5));
}

TEST(Compose, AJumpOfTheOuterCurveIsOneWhereTheInnerCrossesIt) {
  const auto both = compose(made(saw()), made(spec_of(2, {0, 0, 1})));
  ASSERT_TRUE(both) << both.error().message;  // u^2 = 1/4 at 1/2
  EXPECT_THAT(both->jumps(), ElementsAre(0.5));
  EXPECT_EQ(at(*both, 0.5, Side::left), 1);
  EXPECT_EQ(at(*both, 0.5, Side::right), -1);
  // Downwards the sides change places.
  const auto down = compose(made(saw()), made(spec_of(1, {1, 0})));
  EXPECT_EQ(at(*down, 0.75, Side::left), -1);
  EXPECT_EQ(at(*down, 0.75, Side::right), 1);
}

TEST(Compose, ATouchIsNoCrossingAndAStretchAtAJumpTakesTheRightSide) {
  // (1 - 2 u)^2 / 2 + 1/4 touches 1/4 from above at 1/2.
  const auto touched = compose(made(saw()), made(spec_of(2, {0.75, -0.25, 0.75})));
  ASSERT_TRUE(touched) << touched.error().message;
  EXPECT_THAT(touched->jumps(), IsEmpty());
  EXPECT_EQ(at(*touched, 0.5), -1);
  const auto resting = compose(made(saw()), made(spec_of(3, {0.25, 0.25, 0.25, 0.25, 0.25, 0.25})));
  ASSERT_TRUE(resting) << resting.error().message;
  EXPECT_THAT(resting->points(), testing::Each(-1));
}

TEST(Compose, JumpsOfTheInnerCurveStay) {
  const auto both = compose(made(spec_of(2, {0, 0, 1}, {-1, -1, -1, 1, 1, 1})), made(saw()));
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_THAT(both->jumps(), ElementsAre(0.25));
  EXPECT_EQ(at(*both, 0.25, Side::left), 1);
  EXPECT_EQ(at(*both, 0.25, Side::right), 0);
}

TEST(Compose, APeriodicWaveThroughAShaperGivesOneClampedPeriod) {
  CurveSpec wave = spec_of(2, {0, 0.9, 0, -0.9});
  wave.periodic = true;
  const NurbsCurve inner = made(wave);
  const NurbsCurve shaper = made(spec_of(3, {-1, -0.2, 0.2, 1}, {-1, -1, -1, -1, 1, 1, 1, 1}));
  const auto shaped = compose(shaper, inner);
  ASSERT_TRUE(shaped) << shaped.error().message;
  EXPECT_TRUE(shaped->is_clamped());
  EXPECT_EQ(at(*shaped, 0), at(*shaped, 1));
  for (double u = 0; u < 1; u += 0.0625) {
    EXPECT_NEAR(at(*shaped, u), at(shaper, at(inner, u)), 4e-16);
  }
}

// A bend is itself a composition, with a rational line.
TEST(Compose, WithAMoebiusLineIsABend) {
  const NurbsCurve curve = made(spec_of(3, {0, 1, -1, 2}));
  const auto composed = compose(curve, made(spec_of(1, {0, 1}, {}, {4, 1})));
  ASSERT_TRUE(composed) << composed.error().message;
  const auto bent = bend(curve, 4);
  EXPECT_THAT(composed->points(), ElementsAreArray(bent->points()));
  EXPECT_THAT(composed->weights(), ElementsAreArray(bent->weights()));
}

TEST(Compose, HalvesSpansWhoseHandlesReachFarOutOfARationalSegment) {
  const NurbsCurve outer = made(spec_of(2, {0, 1, 0}, {}, {1, 1e-3, 1}));
  // Values in 0..1, handles at 2 and -1.
  const NurbsCurve inner = made(spec_of(3, {0.5, 1.55, -0.55, 0.5}));
  const auto both = compose(outer, inner);
  ASSERT_TRUE(both) << both.error().message;
  for (double u = 0; u <= 1; u += 1.0 / 64) {
    EXPECT_NEAR(at(*both, u), at(outer, at(inner, u)), 1e-14) << u;
  }
}

TEST(Compose, ReportsWhatDoesNotFit) {
  const NurbsCurve unit = made(spec_of(1, {0, 1}));
  const auto error = compose(unit, made(spec_of(2, {0, 3, 0})));
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::parameter_out_of_range);
  EXPECT_EQ(error.error().message,
            "curve 'example' of curve 'example': the inner one is 1.5 at u = 0.5, outside of the "
            "outer one's domain 0..1");
  CurveSpec plane = spec_of(1, {0, 0, 1, 1});
  plane.dim = 2;
  EXPECT_EQ(compose(unit, made(plane)).error().code, ErrorCode::not_scalar);
  const NurbsCurve quartic = made(spec_of(4, {0, 0, 0, 1, 1}));
  EXPECT_EQ(compose(quartic, quartic).error().code, ErrorCode::degree_out_of_range);
  EXPECT_TRUE(compose(unit, made(spec_of(2, {0, 2, 0}))));  // its top is 1, exactly
}

}  // namespace
}  // namespace knotwave::test

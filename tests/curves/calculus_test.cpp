// SPDX-License-Identifier: MIT
#include "knotwave/curves/calculus.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;

NurbsCurve plain_curve(Dice& dice, int most_degree) {
  CurveSpec spec = random_spec(dice, 1 + dice.below(most_degree));
  spec.weights.clear();
  return made(std::move(spec));
}

TEST(Hodograph, OfASegmentIsTheDifferencesOfItsPoints) {
  const auto slope = hodograph(scalar(3, {0, 1, 3, 2}));
  ASSERT_TRUE(slope);
  EXPECT_EQ(slope->degree(), 2);
  EXPECT_THAT(slope->points(), ElementsAre(3, 6, -3));
}

TEST(Hodograph, ACornerBecomesAJumpBetweenItsSlopes) {
  // 0 to 1 in half a unit, with slopes 2 and then -4.
  const auto slope = hodograph(scalar(1, {0, 1, -1}, {0, 0, 0.5, 1, 1}));
  ASSERT_TRUE(slope) << slope.error().message;
  EXPECT_EQ(slope->degree(), 1);
  EXPECT_THAT(slope->jumps(), ElementsAre(0.5));
  EXPECT_EQ(at(*slope, 0.5, Side::left), 2);
  EXPECT_EQ(at(*slope, 0.5, Side::right), -4);
  EXPECT_EQ(at(*slope, 0.2), 2);
  const auto smooth = hodograph(scalar(2, {0, 1, 2, 1, 0}, {0, 0, 0, 1, 1, 2, 2, 2}));
  ASSERT_TRUE(smooth);
  EXPECT_THAT(smooth->jumps(), ElementsAre(1));
  EXPECT_EQ(at(*smooth, 1, Side::left), 2);
  EXPECT_EQ(at(*smooth, 1, Side::right), -2);
}

TEST(Hodograph, OfAPeriodicCurveIsPeriodicUnlessItHasCorners) {
  CurveSpec spec;
  spec.degree = 2;
  spec.points = {0, 1, 0, -1};
  spec.periodic = true;
  const auto slope = hodograph(made(spec));
  ASSERT_TRUE(slope);
  EXPECT_TRUE(slope->is_periodic());
  EXPECT_EQ(at(*slope, 0.25), 4 * (0 - 1)) << "the third knot: between the points 1 and 0";
  spec.degree = 1;
  const auto steps = hodograph(made(spec));
  ASSERT_TRUE(steps) << steps.error().message;
  EXPECT_FALSE(steps->is_periodic());
  EXPECT_EQ(at(*steps, 0.1), 4);
}

/// A curve that is cut open has its points rounded before their differences are taken: one ulp of
/// the largest point over the narrowest p spans that two points share.
double rounding_of_cut(const NurbsCurve& curve) {
  const auto open = *curves::sub_curve(curve, curve.u_min(), curve.u_max());
  const auto p = static_cast<std::size_t>(curve.degree());
  double width = curve.u_max() - curve.u_min();
  for (std::size_t i = 1; i + p + 1 < open.knots().size(); ++i) {
    const double shared = open.knots()[i + p] - open.knots()[i];
    if (shared > 0) width = std::min(width, shared);
  }
  return ulp_of(largest_coordinate(curve)) * curve.degree() / width;
}

TEST(Hodograph, IsTheDerivativeFromEitherSide) {
  Dice dice(support::test_seed());
  int done = 0;
  double worst = 0;
  for (int round = 0; round < support::test_count(10000); ++round) {
    const NurbsCurve curve = plain_curve(dice, curves::kMaxDegree);
    const auto slope = hodograph(curve);
    if (!slope) {
      ASSERT_EQ(slope.error().code, ErrorCode::coordinate_out_of_range) << slope.error().message;
      continue;
    }
    ++done;
    const bool cut = curve.is_periodic() && !slope->is_periodic();  // has no other side there
    const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    const Side side = dice.one_in(2) ? Side::left : Side::right;
    if (cut && (u == curve.u_min() || u == curve.u_max())) continue;
    double exact[2 * curves::kMaxDim], found[curves::kMaxDim];
    curve.derivatives(u, 1, side, exact);
    slope->evaluate(u, side, found);
    for (int c = 0; c < curve.dim(); ++c) {
      const double unit = ulp_of(largest_coordinate(*slope)) + (cut ? rounding_of_cut(curve) : 0);
      const double error = std::abs(found[c] - exact[curve.dim() + c]) / unit;
      worst = std::max(worst, error);
      ASSERT_LE(error, 4) << "round " << round << " degree " << curve.degree() << " at " << u;
    }
  }
  std::printf("%d hodographs, worst %.2f ulp\n", done, worst);
  EXPECT_GT(done, support::test_count(2500));
}

TEST(Hodograph, SaysWhatHasNoSlope) {
  const auto jump = hodograph(scalar(1, {0, 1, 3, 4}, {0, 0, 0.5, 0.5, 1, 1}, {0.5}));
  ASSERT_FALSE(jump);
  EXPECT_EQ(jump.error().code, ErrorCode::unsupported);
  EXPECT_EQ(jump.error().message, "curve 'example' jumps at 0.5 and has no slope there: split it");
  CurveSpec spec;
  spec.degree = 2;
  spec.points = {0, 1, 0};
  spec.weights = {1, 2, 1};
  EXPECT_EQ(hodograph(made(spec)).error().code, ErrorCode::unsupported);
  EXPECT_EQ(antiderivative(made(spec)).error().code, ErrorCode::unsupported);
  EXPECT_EQ(integral(made(spec), 0, 1).error().code, ErrorCode::unsupported);
  const auto steep = hodograph(scalar(1, {0, 1e6}, {0, 0, 0.5, 0.5}));
  EXPECT_EQ(steep.error().code, ErrorCode::coordinate_out_of_range);
}

TEST(Antiderivative, OfAFrequencyIsItsPhase) {
  // 100 to 300 Hz in 2 seconds: 400 cycles.
  const auto phase = antiderivative(scalar(1, {100, 300}, {0, 0, 2, 2}), 0.25);
  ASSERT_TRUE(phase);
  EXPECT_EQ(phase->degree(), 2);
  EXPECT_EQ(at(*phase, 0), 0.25);
  EXPECT_EQ(at(*phase, 1), 0.25 + 150);
  EXPECT_EQ(at(*phase, 2), 0.25 + 400);
}

TEST(Antiderivative, AJumpBecomesACorner) {
  const auto area = antiderivative(scalar(1, {0, 1, 3, 4}, {0, 0, 0.5, 0.5, 1, 1}, {0.5}));
  ASSERT_TRUE(area);
  EXPECT_TRUE(area->jumps().empty());
  EXPECT_EQ(at(*area, 0.5), 0.25);
  EXPECT_EQ(at(*area, 1), 0.25 + 1.75);
  double at[2];
  area->derivatives(0.5, 1, Side::left, at);
  EXPECT_EQ(at[1], 1);
  area->derivatives(0.5, 1, Side::right, at);
  EXPECT_EQ(at[1], 3);
}

TEST(Antiderivative, IsTheIntegralAndItsSlopeIsTheCurve) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(5000); ++round) {
    const NurbsCurve curve = plain_curve(dice, curves::kMaxDegree - 1);
    const double start = dice.between(-1, 1);
    const auto area = antiderivative(curve, start);
    if (!area) {
      ASSERT_EQ(area.error().code, ErrorCode::coordinate_out_of_range) << area.error().message;
      continue;
    }
    const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    const auto part = integral(curve, curve.u_min(), u);
    ASSERT_TRUE(part) << part.error().message;
    const double ulp = ulp_of(largest_coordinate(*area));
    EXPECT_NEAR(at(*area, u, Side::left), start + *part, 4 * ulp) << "round " << round;
    EXPECT_EQ(at(*area, curve.u_min()), start);
    EXPECT_EQ(*integral(curve, u, curve.u_min()), -*part);
  }
}

TEST(Antiderivative, SaysWhatPassesTheLimits) {
  EXPECT_EQ(antiderivative(scalar(15, std::vector<double>(16, 1.0))).error().code,
            ErrorCode::degree_out_of_range);
  EXPECT_EQ(antiderivative(scalar(1, {1e6, 1e6}, {0, 0, 2, 2})).error().code,
            ErrorCode::coordinate_out_of_range);
  EXPECT_EQ(antiderivative(scalar(1, {1, 1}), std::nan("")).error().code, ErrorCode::not_finite);
}

TEST(Integral, AddsUpOverItsParts) {
  const NurbsCurve steps = scalar(1, {0, 1, 3, 4}, {0, 0, 0.5, 0.5, 1, 1}, {0.5});
  EXPECT_EQ(*integral(steps, 0, 1), 2);
  EXPECT_EQ(*integral(steps, 0.25, 0.75), 0.1875 + 0.8125);
  EXPECT_EQ(*integral(steps, 0.3, 0.3), 0);
  EXPECT_EQ(integral(steps, 0, 1.5).error().code, ErrorCode::parameter_out_of_range);
  EXPECT_EQ(integral(steps, std::nan(""), 1).error().code, ErrorCode::parameter_out_of_range);
}

TEST(Curvature, OfCirclesAndGraphs) {
  CurveSpec spec;
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {4, 0, 4, 4, 0, 4};
  spec.weights = {1, std::sqrt(0.5), 1};
  const NurbsCurve arc = made(spec);
  for (int i = 0; i <= 64; ++i) EXPECT_NEAR(curvature(arc, i / 64.0), 0.25, 2e-15);
  spec.points = {0, 4, 4, 4, 4, 0};
  EXPECT_NEAR(curvature(made(spec), 0.3), -0.25, 2e-15) << "to the right";
  spec.dim = 3;
  spec.points = {0, 4, 1, 4, 4, 1, 4, 0, 1};
  EXPECT_NEAR(curvature(made(spec), 0.3), 0.25, 2e-15) << "no sign in space";
  // u^2 over -1..1: 2 at the bottom, 2 / 5^1.5 at the ends.
  const NurbsCurve parabola = scalar(2, {1, -1, 1}, {-1, -1, -1, 1, 1, 1});
  EXPECT_EQ(curvature(parabola, 0), 2);
  EXPECT_NEAR(curvature(parabola, 1), 2 / (5 * std::sqrt(5.0)), 1e-15);
}

TEST(Curvature, HasASideAndIsNothingWhereAPathStandsStill) {
  CurveSpec spec;
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {1, 1, 1, 1, 1, 1};
  EXPECT_EQ(curvature(made(spec), 0.5), 0);
  const NurbsCurve corner = scalar(2, {0, 0, 0, 1, 4}, {0, 0, 0, 1, 1, 2, 2, 2});
  EXPECT_EQ(curvature(corner, 1, Side::left), 0);
  EXPECT_NE(curvature(corner, 1, Side::right), 0);
  EXPECT_EQ(support::allocations_in([&] { curvature(corner, 1); }), 0);
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// hodograph() of calculus.h.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/shapes.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;
using testing::IsEmpty;

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

// The first points of such a curve have no part in it, and a leg there no width.
TEST(Hodograph, OfACurveWhoseEndKnotComesOneTimeMore) {
  for (const auto& weights : {std::vector<double>(), std::vector<double>{1, 2, 1, 3, 1, 2}}) {
    const NurbsCurve one =
        made(spec_of(2, {9, 0, 1, -1, 2, 1}, {-1, 0, 0, 0, 0.25, 0.5, 1, 1, 1}, weights));
    const NurbsCurve two =
        made(spec_of(3, {9, 7, 0, 1, -1, 2}, {-2, -1, 0, 0, 0, 0, 1, 1, 1, 1}, weights));
    for (const NurbsCurve& curve : {one, two}) {
      const auto slope = hodograph(curve);
      ASSERT_TRUE(slope) << slope.error().message;
      for (double u = 0; u <= 1; u += 0.0625) {
        double exact[2];
        curve.derivatives(u, 1, u < 1 ? Side::right : Side::left, exact);
        EXPECT_NEAR(at(*slope, u), exact[1], 4e-14) << u;
      }
    }
  }
}

// The domain is cut out, and a span of 2e-7 follows its start: points rounded before they are
// subtracted would leave 3e-9 of the slope wrong.
TEST(Hodograph, OfAShortSpanBesideAnIdleEndKeepsItsDigits) {
  const double short_end = 1 + 0x1p-22;
  for (const auto& weights : {std::vector<double>(), std::vector<double>{1, 2, 1, 2, 1, 2, 1, 2}}) {
    const NurbsCurve curve =
        made(spec_of(3, {0.3, 0.7, -99, 0.9, 0.9, 0.9, 0.9, 0.9},
                     {-3, -2, -1, 1, 1, short_end, 2, 2, 2, 2, 3, 4}, weights));
    const auto slope = hodograph(curve);
    ASSERT_TRUE(slope) << slope.error().message;
    double exact[2];
    curve.derivatives(1, 1, Side::right, exact);
    if (weights.empty()) {
      EXPECT_NEAR(exact[1], 3 * (-99 - 0.7) / (short_end + 1), 0x1p-45);
    }
    EXPECT_NEAR(at(*slope, 1), exact[1], 0x1p-50 * std::abs(exact[1]));
  }
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
  const auto steep = hodograph(scalar(1, {0, 1e6}, {0, 0, 0.5, 0.5}));
  EXPECT_EQ(steep.error().code, ErrorCode::coordinate_out_of_range);
}

// (1 + u) / (1 + u^2) and friends: C'(0) and C'(1) of The NURBS Book's quarter circle, example 4.2:
// (0, 2) and (-1, 0).
TEST(Hodograph, OfAQuarterCircleIsThatOfTheBook) {
  CurveSpec spec = spec_of(2, {1, 0, 1, 1, 0, 1}, {}, {1, 1, 2});
  spec.dim = 2;
  const auto slope = hodograph(made(spec));
  ASSERT_TRUE(slope) << slope.error().message;
  EXPECT_EQ(slope->degree(), 4);
  EXPECT_EQ(at(*slope, 0, Side::right, 0), 0);
  EXPECT_EQ(at(*slope, 0, Side::right, 1), 2);
  EXPECT_EQ(at(*slope, 1, Side::left, 0), -1);
  EXPECT_EQ(at(*slope, 1, Side::left, 1), 0);
  for (double u = 0; u <= 1; u += 0.125) {
    const double below = (1 + u * u) * (1 + u * u);
    EXPECT_NEAR(at(*slope, u, Side::right, 0), -4 * u / below, 1e-15);
    EXPECT_NEAR(at(*slope, u, Side::right, 1), 2 * (1 - u * u) / below, 1e-15);
  }
}

TEST(Hodograph, OfAWeightedCurveJumpsWhereEqualKnotsLeaveACorner) {
  // Degree 2, simple, double and triple knots are smooth, a corner, and a jump that has no slope.
  const std::vector<double> weights = {1, 2, 0.5, 1, 3, 1};
  const auto slope =
      hodograph(made(spec_of(2, {0, 1, 2, 0, 1, 1}, {0, 0, 0, 0.25, 0.5, 0.5, 1, 1, 1}, weights)));
  ASSERT_TRUE(slope) << slope.error().message;
  EXPECT_THAT(slope->jumps(), ElementsAre(0.5));
  EXPECT_EQ(std::count(slope->knots().begin(), slope->knots().end(), 0.25), 4);
  CurveSpec spec = spec_of(2, {0, 1, 2, 0, 1, 1}, {0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1}, weights);
  spec.jumps = {0.5};
  EXPECT_EQ(hodograph(made(spec)).error().code, ErrorCode::unsupported);
}

TEST(Hodograph, OfWeightedCurvesIsTheDerivativeFromEitherSide) {
  Dice dice(support::test_seed());
  double worst = 0;
  int done = 0;
  for (int round = 0; round < support::test_count(3000); ++round) {
    CurveSpec spec = random_spec(dice, 1 + dice.below(7));
    spec.weights.clear();
    const std::size_t n = spec.points.size() / std::size_t(spec.dim);
    const double decades = dice.one_in(4) ? 5 : 1;
    for (std::size_t i = 0; i < n; ++i) {
      spec.weights.push_back(std::pow(10, decades * dice.between(-0.5, 0.5)));
    }
    const NurbsCurve curve = made(std::move(spec));
    const auto slope = hodograph(curve);
    if (!slope) {
      ASSERT_EQ(slope.error().code, ErrorCode::coordinate_out_of_range) << slope.error().message;
      continue;
    }
    ++done;
    EXPECT_FALSE(slope->is_periodic());
    EXPECT_EQ(slope->degree(), 2 * curve.degree());
    for (int k = 0; k < 4; ++k) {
      const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
      // The seam of a periodic curve is an end now, and has but one side.
      const Side side = u == curve.u_min()   ? Side::right
                        : u == curve.u_max() ? Side::left
                        : dice.one_in(2)     ? Side::left
                                             : Side::right;
      double exact[2 * curves::kMaxDim], found[curves::kMaxDim];
      curve.derivatives(u, 1, side, exact);
      slope->evaluate(u, side, found);
      for (int c = 0; c < curve.dim(); ++c) {
        const double error =
            std::abs(found[c] - exact[curve.dim() + c]) / ulp_of(largest_coordinate(*slope));
        worst = std::max(worst, error);
        ASSERT_LE(error, 4) << "round " << round << " degree " << curve.degree() << " at " << u;
      }
    }
  }
  std::printf("%d hodographs, worst %.2f ulp\n", done, worst);
  EXPECT_GT(done, support::test_count(1000));
}

TEST(Hodograph, OfAWeightedCurveOfDegree8WouldHaveDegree16) {
  const auto slope =
      hodograph(made(spec_of(8, std::vector<double>(9, 1.0), {}, {1, 2, 1, 1, 1, 1, 1, 1, 1})));
  ASSERT_FALSE(slope);
  EXPECT_EQ(slope.error().code, ErrorCode::degree_out_of_range);
  EXPECT_EQ(slope.error().message,
            "the hodograph of curve 'example', rational of degree 8, would have degree 16, the "
            "limit is 15");
  EXPECT_EQ(hodograph(made(spec_of(1, {0, 1}, {}, {1e-6, 1e6}))).error().code,
            ErrorCode::weight_out_of_range);
}

}  // namespace
}  // namespace knotwave::test

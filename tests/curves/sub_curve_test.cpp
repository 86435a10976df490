// SPDX-License-Identifier: MIT
// sub_curve(), split(), to_bezier() and de_casteljau() of algorithms.h.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"
#include "wide_value.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

using base::index_of;

double worst_of_parts(int count) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < count; ++round) {
    const NurbsCurve curve = random_curve(dice);
    double a = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    double b = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    const auto part = sub_curve(curve, a, b);
    if (!part) ADD_FAILURE() << part.error().message;
    EXPECT_TRUE(part->is_clamped());
    EXPECT_EQ(part->u_min(), a);
    EXPECT_EQ(part->u_max(), b);
    worst = std::max(worst, distance_ulp(dice, curve, *part, a, b));
  }
  std::printf("worst of %d curves: %.2f ulp of max|P|\n", count, worst);
  return worst;
}

TEST(SubCurve, IsThePartWithin4UlpOfTheLargestPoint) {
  EXPECT_LE(worst_of_parts(support::test_count(10'000)), 4);
}

TEST(SubCurveStress, IsThePartWithin4UlpOfTheLargestPoint) {
  EXPECT_LE(worst_of_parts(support::test_count(100'000)), 4);
}

TEST(SubCurve, EndsAtAJumpWithTheSideInside) {
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {0, 1, -1, 0};
  spec.knots = {0, 0, 0.5, 0.5, 1, 1};
  spec.jumps = {0.5};
  const NurbsCurve saw = *NurbsCurve::create(spec);
  EXPECT_THAT(sub_curve(saw, 0, 0.5)->points(), testing::ElementsAre(0, 1));
  EXPECT_THAT(sub_curve(saw, 0.5, 1)->points(), testing::ElementsAre(-1, 0));
  EXPECT_THAT(sub_curve(saw, 0.25, 1)->jumps(), testing::ElementsAre(0.5));
  EXPECT_THAT(sub_curve(saw, 0.5, 1)->jumps(), testing::IsEmpty());
}

TEST(SubCurve, NothingIsAnError) {
  const NurbsCurve curve = made(spec_of(2, {0, 1, -1, 2}));
  EXPECT_EQ(sub_curve(curve, 0.5, 0.5).error().code, ErrorCode::empty_domain);
  EXPECT_EQ(sub_curve(curve, 0.5, 1.5).error().code, ErrorCode::parameter_out_of_range);
  EXPECT_EQ(sub_curve(curve, -1, 0.5).error().message, "curve 'example': u = -1 is outside 0..1");
}

TEST(Split, PartsMeetInTheSamePoint) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 500; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = dice.between(curve.u_min(), curve.u_max());
    if (!(u > curve.u_min())) continue;
    const auto parts = split(curve, u);
    ASSERT_TRUE(parts) << parts.error().message;
    const auto size = std::size_t(curve.dim());
    EXPECT_THAT(parts->left.points().last(size),
                testing::ElementsAreArray(parts->right.points().first(size)));
    EXPECT_LE(distance_ulp(dice, curve, parts->left, curve.u_min(), u), 4);
    EXPECT_LE(distance_ulp(dice, curve, parts->right, u, curve.u_max()), 4);
  }
  EXPECT_FALSE(split(made(spec_of(1, {0, 1})), 0.0));
  EXPECT_FALSE(split(made(spec_of(1, {0, 1})), 1.0));
}

TEST(ToBezier, SegmentsCoverTheDomainAndMeet) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 2000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const auto segments = to_bezier(curve);
    ASSERT_FALSE(segments.empty());
    EXPECT_EQ(segments.front().u0, curve.u_min());
    EXPECT_EQ(segments.back().u1, curve.u_max());
    for (std::size_t i = 1; i < segments.size(); ++i) {
      EXPECT_EQ(segments[i - 1].u1, segments[i].u0);
      for (int c = 0; c < curve.dim(); ++c) {
        EXPECT_NEAR(segments[i - 1].points[index_of(curve.degree() * curve.dim() + c)],
                    segments[i].points[std::size_t(c)], ulp_of(largest_coordinate(curve)));
      }
    }
  }
}

// De Casteljau and de Boor against quadruple precision: curve_exactness_test.cpp.
TEST(DeCasteljau, ClampsAndReadsNanAsTheStart) {
  const curves::BezierSegment segment{1, 2, 2, 1, {3, 5, 4}, {1, 1, 1}};
  double out;
  de_casteljau(segment, 0.0, std::span(&out, 1));
  EXPECT_EQ(out, 3);
  de_casteljau(segment, 9.0, std::span(&out, 1));
  EXPECT_EQ(out, 4);
  de_casteljau(segment, std::nan(""), std::span(&out, 1));
  EXPECT_EQ(out, 3);
  de_casteljau(segment, 1.5, std::span(&out, 1));
  EXPECT_EQ(out, 4.25);
}

}  // namespace
}  // namespace knotwave::test

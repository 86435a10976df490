// SPDX-License-Identifier: MIT
// elevate_degree() of algorithms.h.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

double worst_of_elevations(int count) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < count; ++round) {
    const NurbsCurve curve = random_curve(dice, 1 + round % (curves::kMaxDegree - 1));
    const auto raised = elevate_degree(curve);
    if (!raised) ADD_FAILURE() << raised.error().message;
    EXPECT_EQ(raised->degree(), curve.degree() + 1);
    EXPECT_EQ(raised->is_periodic(), curve.is_periodic());
    worst = std::max(worst, distance_ulp(dice, curve, *raised, curve.u_min(), curve.u_max()));
  }
  std::printf("worst of %d curves: %.2f ulp of max|P|\n", count, worst);
  return worst;
}

TEST(ElevateDegree, KeepsAnyCurveWithin4UlpOfTheLargestPoint) {
  EXPECT_LE(worst_of_elevations(support::test_count(2000)), 4);
}

TEST(ElevateDegreeStress, KeepsAnyCurveWithin4UlpOfTheLargestPoint) {
  EXPECT_LE(worst_of_elevations(support::test_count(100'000)), 4);
}

TEST(ElevateDegree, ByMoreThanOneIsRoundedOnce) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(500); ++round) {
    const NurbsCurve curve = random_curve(dice, 1 + dice.below(curves::kMaxDegree));
    const int times = dice.below(curves::kMaxDegree - curve.degree() + 1);
    const auto raised = elevate_degree(curve, times);
    ASSERT_TRUE(raised) << raised.error().message;
    EXPECT_EQ(raised->degree(), curve.degree() + times);
    EXPECT_EQ(raised->is_periodic(), curve.is_periodic());
    worst = std::max(worst, distance_ulp(dice, curve, *raised, curve.u_min(), curve.u_max()));
  }
  std::printf("worst %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 4);
}

TEST(ElevateDegree, ReportsTimesThatAreNone) {
  const NurbsCurve line = made(spec_of(1, {0, 1}));
  EXPECT_EQ(*elevate_degree(line, 0), line);
  EXPECT_EQ(elevate_degree(line, -1).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(elevate_degree(line, 15).error().message,
            "curve 'example': degree 16 is outside 1..15");
  EXPECT_EQ(elevate_degree(line, 99).error().message,
            "curve 'example': degree 100 is outside 1..15");
  EXPECT_EQ(elevate_degree(line, 2147483647).error().message,
            "curve 'example': degree 2147483648 is outside 1..15");
}

TEST(ElevateDegree, KeepsJumpsAndCorners) {
  CurveSpec spec;
  spec.degree = 2;
  spec.points = {0, 2, 1, -1, 3, 0, 1, 2};
  spec.knots = {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.5, 1, 1, 1};
  spec.jumps = {0.5};
  const NurbsCurve curve = *NurbsCurve::create(spec);
  const auto raised = elevate_degree(curve);
  ASSERT_TRUE(raised) << raised.error().message;
  EXPECT_THAT(raised->jumps(), testing::ElementsAre(0.5));
  for (double u = 0; u <= 1; u += 0.0625) {
    EXPECT_NEAR(at(*raised, u), at(curve, u), 2e-15);
    EXPECT_NEAR(at(*raised, u, Side::left), at(curve, u, Side::left), 2e-15);
  }
}

TEST(ElevateDegree, ABezierLineGetsItsMiddleAndDegree15IsTheLast) {
  NurbsCurve line = made(spec_of(1, {0, 1}));
  for (int degree = 2; degree <= 15; ++degree) {
    line = *elevate_degree(line);
    for (int i = 0; i <= degree; ++i) {
      EXPECT_NEAR(line.points()[std::size_t(i)], double(i) / degree, 2e-16);
    }
  }
  const auto error = elevate_degree(line);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "curve 'example': degree 16 is outside 1..15");
}

}  // namespace
}  // namespace knotwave::test

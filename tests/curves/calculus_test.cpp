// SPDX-License-Identifier: MIT
#include "knotwave/curves/calculus.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

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
  EXPECT_EQ(antiderivative(made(spec_of(2, {0, 1, 0}, {}, {1, 2, 1}))).error().code,
            ErrorCode::unsupported);
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

// 1 / (1 + u): ln 2. The half circle over its diameter: x' y = 2 pi / 4.
TEST(Integral, OfWeightedCurvesIsThatOfTheirClosedForms) {
  EXPECT_NEAR(*integral(made(spec_of(1, {1, 0.5}, {}, {1, 2})), 0, 1), std::numbers::ln2, 1e-15);
  EXPECT_NEAR(*integral(made(spec_of(1, {1, 0.5}, {}, {1, 2})), 1, 0), -std::numbers::ln2, 1e-15);
  // (1 - u^2) / (1 + u^2), the x of a quarter circle: pi / 2 - 1.
  const NurbsCurve quarter = made(spec_of(2, {1, 1, 0}, {}, {1, 1, 2}));
  EXPECT_NEAR(*integral(quarter, 0, 1), std::numbers::pi / 2 - 1, 1e-15);
  // A jump belongs to neither side.
  CurveSpec spec = spec_of(1, {1, 0.5, 1, 0.5}, {0, 0, 1, 1, 2, 2}, {1, 2, 1, 2});
  spec.jumps = {1};
  EXPECT_NEAR(*integral(made(spec), 0, 2), 2 * std::numbers::ln2, 1e-15);
  EXPECT_EQ(integral(quarter, 0, 2).error().code, ErrorCode::parameter_out_of_range);
}

TEST(Integral, OfRandomWeightedCurvesAddsUpAndIsThatOfTheirElevation) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(600); ++round) {
    const NurbsCurve curve = random_curve(dice, 1 + dice.below(14));
    if (!curve.is_rational()) continue;
    const double unit = 0x1p-50 * largest_coordinate(curve) * (curve.u_max() - curve.u_min());
    const double u = dice.between(curve.u_min(), curve.u_max());
    const int c = dice.below(curve.dim());
    const double whole = *integral(curve, curve.u_min(), curve.u_max(), c);
    const double parts =
        *integral(curve, curve.u_min(), u, c) + *integral(curve, u, curve.u_max(), c);
    worst = std::max(worst, std::abs(parts - whole) / unit);
    ASSERT_LE(std::abs(parts - whole), unit) << round;
    const auto raised = elevate_degree(curve);
    ASSERT_TRUE(raised) << raised.error().message;
    ASSERT_NEAR(*integral(*raised, curve.u_min(), curve.u_max(), c), whole, 4 * unit) << round;
  }
  std::printf("worst %.3f of 2^-50 max|P|\n", worst);
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

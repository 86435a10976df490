// SPDX-License-Identifier: MIT
// insert_knot() and refine() of algorithms.h.
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

// How many knots insert_knot() may add at u.
int room_at(const NurbsCurve& curve, double u) {
  const std::vector<double> knots = curve.spec().knots;
  const bool at_end = u == curve.u_min() || u == curve.u_max();
  auto have = std::count(knots.begin(), knots.end(), u);
  if (curve.is_periodic() && at_end) {
    have = std::count(knots.begin(), knots.end(), curve.u_min()) +
           std::count(knots.begin(), knots.end(), curve.u_max()) - 1;
  }
  return std::max(0, curve.degree() - static_cast<int>(have));
}

double worst_of_insertions(int count) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < count; ++round) {
    const NurbsCurve curve = random_curve(dice);
    NurbsCurve edited = curve;
    for (int i = 0; i < 3; ++i) {
      const double u = std::clamp(random_parameter(dice, edited), curve.u_min(), curve.u_max());
      const int room = room_at(edited, u);
      if (room == 0) continue;
      const auto finer = insert_knot(edited, u, 1 + dice.below(room));
      if (!finer) ADD_FAILURE() << finer.error().message;
      edited = *finer;
    }
    EXPECT_EQ(edited.is_periodic(), curve.is_periodic());
    EXPECT_EQ(edited.u_min(), curve.u_min());
    EXPECT_EQ(edited.u_max(), curve.u_max());
    worst = std::max(worst, distance_ulp(dice, curve, edited, curve.u_min(), curve.u_max()));
  }
  std::printf("worst of %d curves: %.2f ulp of max|P|\n", count, worst);
  return worst;
}

// The NURBS Book, 2nd ed., example 5.1: u = 2 inserted. Q3 = 2/3 P3 + 1/3 P2, Q4 = 1/3 P4 + 2/3 P3,
// Q5 = P4; the others as they were.
TEST(InsertKnot, BookExample51) {
  const NurbsCurve curve =
      made(spec_of(3, {0, 3, 1, 6, 12, 24, 9, 5}, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}));
  const auto finer = insert_knot(curve, 2.0);
  ASSERT_TRUE(finer);
  EXPECT_THAT(finer->points(), testing::ElementsAre(0, 3, 1, 13.0 / 3, 8, 12, 24, 9, 5));
  EXPECT_THAT(finer->knots(), testing::ElementsAre(0, 0, 0, 0, 1, 2, 2, 3, 4, 5, 5, 5, 5));
}

TEST(InsertKnot, KeepsAnyCurveWithin4UlpOfTheLargestPoint) {
  EXPECT_LE(worst_of_insertions(support::test_count(10'000)), 4);
}

TEST(InsertKnotStress, KeepsAnyCurveWithin4UlpOfTheLargestPoint) {
  EXPECT_LE(worst_of_insertions(support::test_count(100'000)), 4);
}

TEST(InsertKnot, RaisesExistingKnotsUpToTheDegree) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 500; ++round) {
    const NurbsCurve curve = random_curve(dice);
    for (const double knot : std::vector<double>(curve.knots().begin(), curve.knots().end())) {
      if (!(knot > curve.u_min() && knot < curve.u_max())) continue;
      const auto have = std::count(curve.knots().begin(), curve.knots().end(), knot);
      const int room = curve.degree() - static_cast<int>(have);
      const auto full = insert_knot(curve, knot, room);
      ASSERT_TRUE(full) << full.error().message;
      EXPECT_LE(distance_ulp(dice, curve, *full, curve.u_min(), curve.u_max()), 4);
      const auto more = insert_knot(curve, knot, room + 1);
      ASSERT_FALSE(more);
      EXPECT_EQ(more.error().code, ErrorCode::knot_multiplicity);
    }
  }
}

TEST(InsertKnot, SeamOfAPeriodicCurveIsAKnotLikeAnother) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 300; ++round) {
    CurveSpec spec = random_spec(dice);
    const int count = static_cast<int>(spec.points.size()) / spec.dim;
    spec.periodic = true;
    spec.knots.clear();
    for (int i = 0; i <= count; ++i) spec.knots.push_back(0.1 + 0.35 * i);
    const NurbsCurve curve = *NurbsCurve::create(spec);
    for (const double u : {curve.u_min(), curve.u_max()}) {
      const auto more = insert_knot(curve, u, curve.degree() - 1);
      ASSERT_TRUE(more) << more.error().message;
      EXPECT_LE(distance_ulp(dice, curve, *more, curve.u_min(), curve.u_max()), 4);
      EXPECT_FALSE(insert_knot(curve, u, curve.degree()));
    }
  }
}

TEST(InsertKnot, UnclampedEndsTakeKnotsClampedOnesDoNot) {
  const NurbsCurve open = made(spec_of(2, {0, 1, -1, 2}, {0, 1, 2, 3, 4, 5, 6}));
  for (const double u : {2.0, 4.0}) {
    const auto more = insert_knot(open, u);
    ASSERT_TRUE(more) << more.error().message;
    for (double v = 2; v <= 4; v += 0.125) EXPECT_NEAR(at(*more, v), at(open, v), 4e-16);
  }
  const auto error = insert_knot(made(spec_of(2, {0, 1, -1, 2})), 1.0);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::parameter_out_of_range);
}

TEST(InsertKnot, OutsideIsAnErrorWithBothNumbers) {
  const auto error = insert_knot(made(spec_of(2, {0, 1, -1, 2})), 1.5);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "curve 'example': u = 1.5 is outside 0..1");
  EXPECT_FALSE(insert_knot(made(spec_of(2, {0, 1, -1, 2})), std::nan("")));
}

TEST(InsertKnot, OneTooNearAnotherOrOnePointTooManyIsRefused) {
  const NurbsCurve curve = made(spec_of(2, {0, 1, -1, 2}));
  const auto near = insert_knot(curve, 5e-324);
  ASSERT_FALSE(near);
  EXPECT_EQ(near.error().code, ErrorCode::value_out_of_range);
  EXPECT_THAT(near.error().message, testing::HasSubstr("(0) by less than 1e-280"));
  EXPECT_EQ(refine(curve, std::vector{0.25, 5e-324}).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(refine(curve, std::vector{1e-290, 0.25}).error().code, ErrorCode::value_out_of_range);
  EXPECT_TRUE(insert_knot(curve, 1e-280));
  const NurbsCurve full = made(spec_of(1, std::vector<double>(curves::kMaxPoints, 0.5)));
  EXPECT_EQ(insert_knot(full, 0.5).error().code, ErrorCode::too_many_points);
  EXPECT_EQ(refine(full, std::vector{0.5}).error().code, ErrorCode::too_many_points);
}

TEST(Refine, KeepsAnyCurveWithin4UlpOfTheLargestPointHoweverManyKnots) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(1000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    std::vector<double> knots;
    for (int i = dice.below(12); i >= 0; --i) {
      const double u = dice.between(curve.u_min(), curve.u_max());
      const int times = std::min(1 + dice.below(3), room_at(curve, u));
      if (u > curve.u_min()) knots.insert(knots.end(), std::size_t(times), u);
    }
    const auto finer = refine(curve, knots);
    ASSERT_TRUE(finer) << finer.error().message;
    std::vector<double> expected = curve.spec().knots;
    expected.insert(expected.end(), knots.begin(), knots.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(finer->spec().knots, expected);
    EXPECT_EQ(finer->is_periodic(), curve.is_periodic());
    worst = std::max(worst, distance_ulp(dice, curve, *finer, curve.u_min(), curve.u_max()));
    std::reverse(knots.begin(), knots.end());
    EXPECT_EQ(*refine(curve, knots), *finer);
  }
  std::printf("worst %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 4);
}

TEST(Refine, KeepsJumpsAndInsertsAllOrNothing) {
  CurveSpec spec;
  spec.name = "saw";
  spec.degree = 1;
  spec.points = {0, 1, -1, 0};
  spec.knots = {0, 0, 0.5, 0.5, 1, 1};
  spec.jumps = {0.5};
  const NurbsCurve saw = *NurbsCurve::create(spec);
  EXPECT_THAT(refine(saw, std::vector{0.75, 0.25})->points(),
              testing::ElementsAre(0, 0.5, 1, -1, -0.5, 0));
  EXPECT_EQ(*refine(saw, {}), saw);
  EXPECT_EQ(refine(saw, std::vector{0.75, 0.5}).error().message,
            "curve 'saw': 1 more knots at u = 0.5 beside 2, degree 1 allows 1");
  EXPECT_EQ(refine(saw, std::vector{0.75, 0.75}).error().code, ErrorCode::knot_multiplicity);
  EXPECT_EQ(refine(saw, std::vector{1.0}).error().code, ErrorCode::parameter_out_of_range);
  EXPECT_EQ(refine(saw, std::vector{std::nan("")}).error().code, ErrorCode::parameter_out_of_range);
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
#include "knotwave/curves/algorithms.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "random_curve.h"
#include "support/seed.h"
#include "wide_value.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

NurbsCurve curve_of(int degree, std::vector<double> points, std::vector<double> knots = {},
                    std::vector<double> weights = {}) {
  CurveSpec spec;
  spec.name = "example";
  spec.degree = degree;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.weights = std::move(weights);
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

double at(const NurbsCurve& curve, double u, Side side = Side::right) {
  double out[curves::kMaxDim];
  curve.evaluate(u, side, out);
  return out[0];
}

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

// The NURBS Book, 2nd ed., example 5.1: u = 2 inserted. Q3 = 2/3 P3 + 1/3 P2, Q4 = 1/3 P4 + 2/3 P3,
// Q5 = P4; the others as they were.
TEST(InsertKnot, BookExample51) {
  const NurbsCurve curve =
      curve_of(3, {0, 3, 1, 6, 12, 24, 9, 5}, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5});
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
  const NurbsCurve open = curve_of(2, {0, 1, -1, 2}, {0, 1, 2, 3, 4, 5, 6});
  for (const double u : {2.0, 4.0}) {
    const auto more = insert_knot(open, u);
    ASSERT_TRUE(more) << more.error().message;
    for (double v = 2; v <= 4; v += 0.125) EXPECT_NEAR(at(*more, v), at(open, v), 4e-16);
  }
  const auto error = insert_knot(curve_of(2, {0, 1, -1, 2}), 1.0);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::parameter_out_of_range);
}

TEST(InsertKnot, OutsideIsAnErrorWithBothNumbers) {
  const auto error = insert_knot(curve_of(2, {0, 1, -1, 2}), 1.5);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "curve 'example': u = 1.5 is outside 0..1");
  EXPECT_FALSE(insert_knot(curve_of(2, {0, 1, -1, 2}), std::nan("")));
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
  const NurbsCurve curve = curve_of(2, {0, 1, -1, 2});
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
  EXPECT_FALSE(split(curve_of(1, {0, 1}), 0.0));
  EXPECT_FALSE(split(curve_of(1, {0, 1}), 1.0));
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
  const NurbsCurve line = curve_of(1, {0, 1});
  EXPECT_EQ(*elevate_degree(line, 0), line);
  EXPECT_EQ(elevate_degree(line, -1).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(elevate_degree(line, 15).error().message,
            "curve 'example': degree 16 is outside 1..15");
  EXPECT_EQ(elevate_degree(line, 2147483647).error().code, ErrorCode::degree_out_of_range);
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
  NurbsCurve line = curve_of(1, {0, 1});
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

TEST(HullRange, IsTheRangeOfTheControlPoints) {
  const curves::HullRange range = hull_range(curve_of(2, {0, 3, -2, 1}));
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
      EXPECT_EQ(is_non_decreasing(curve_of(3, {0, a, 1 - b, 1})), expected) << a << " " << b;
    }
  }
}

TEST(IsNonDecreasing, AcceptsVerticalTangentsFlatsAndJumpsUp) {
  EXPECT_TRUE(is_non_decreasing(curve_of(3, {0, 1, 0, 1})));  // slope 0 in the middle
  EXPECT_TRUE(is_non_decreasing(curve_of(5, {0.1, 0.1, 0.1, 0.1, 0.1, 0.1})));
  EXPECT_TRUE(is_non_decreasing(curve_of(5, {1, 1, 1, 1, 1, 1}, {}, {1, 9, 0.1, 7, 2, 1})));
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

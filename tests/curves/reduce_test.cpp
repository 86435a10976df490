// SPDX-License-Identifier: MIT
#include "knotwave/curves/reduce.h"

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
using curves::ReducedCurve;
using curves::Side;
using testing::ElementsAre;
using testing::ElementsAreArray;

// Distance of two curves, in output units: the largest found at `count` places.
double found_distance(Dice& dice, const NurbsCurve& a, const NurbsCurve& b, int count) {
  double most = 0;
  for (int i = 0; i < count; ++i) {
    const double u = std::clamp(random_parameter(dice, a), a.u_min(), a.u_max());
    for (const Side side : {Side::left, Side::right}) {
      double x[curves::kMaxDim], y[curves::kMaxDim], square = 0;
      a.evaluate(u, side, x);
      b.evaluate(u, side, y);
      for (int c = 0; c < a.dim(); ++c) square += (x[c] - y[c]) * (x[c] - y[c]);
      most = std::max(most, std::sqrt(square));
    }
  }
  return most;
}

double few_ulp(const NurbsCurve& curve) { return 16 * ulp_of(largest_coordinate(curve)); }

int times_at(const NurbsCurve& curve, double u) {
  const std::vector<double> knots = curve.spec().knots;
  return static_cast<int>(std::count(knots.begin(), knots.end(), u));
}

// Weights, and spans, within a factor of 16 of each other; some knots more than once.
NurbsCurve tame_curve(Dice& dice, int degree = 0) {
  CurveSpec spec = random_spec(dice, degree);
  for (double& w : spec.weights) w = dice.between(0.25, 4);
  const int p = spec.degree, n = static_cast<int>(spec.points.size()) / spec.dim;
  const bool clamped = !spec.periodic && !dice.one_in(3);
  const int count = spec.periodic ? n + 1 : n + p + 1;
  spec.knots.clear();
  double u = 0;
  for (int i = 0; i < count; ++i) {
    const bool at_end = clamped && (i <= p || i > n);
    const bool twice = i >= 2 && i != n && p >= 2 && dice.one_in(5) &&
                       spec.knots[std::size_t(i - 1)] != spec.knots[std::size_t(i - 2)];
    if ((!at_end && !twice) || (clamped && i == n)) u += dice.between(0.25, 4);
    spec.knots.push_back(u);
  }
  if (spec.periodic) spec.knots.back() = u + 1;
  return made(spec);
}

// The largest distance at 65 places of each span of `a`.
double distance_at_64ths(const NurbsCurve& a, const NurbsCurve& b) {
  double most = 0;
  const auto knots = a.knots();
  for (std::size_t i = std::size_t(a.degree()); i < std::size_t(a.point_count()); ++i) {
    for (int k = 0; k <= 64; ++k) {
      const double u = k == 64 ? knots[i + 1] : knots[i] + (knots[i + 1] - knots[i]) * k / 64;
      const Side side = k == 64 ? Side::left : Side::right;
      double x[curves::kMaxDim], y[curves::kMaxDim], square = 0;
      a.evaluate(u, side, x);
      b.evaluate(u, side, y);
      for (int c = 0; c < a.dim(); ++c) square += (x[c] - y[c]) * (x[c] - y[c]);
      if (knots[i] < knots[i + 1]) most = std::max(most, std::sqrt(square));
    }
  }
  return most;
}

struct RoundTrips {
  double worst_ulp = 0;
  int done = 0, refused = 0;
};

RoundTrips insert_and_remove(int count) {
  Dice dice(support::test_seed());
  RoundTrips all;
  for (int round = 0; round < count; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = dice.between(curve.u_min(), curve.u_max());
    if (!(u > curve.u_min() && u < curve.u_max()) || times_at(curve, u) > 0) continue;
    const int times = 1 + dice.below(curve.degree());
    const auto finer = insert_knot(curve, u, times);
    if (!finer) ADD_FAILURE() << finer.error().message;
    const auto back = remove_knot(*finer, u, times, few_ulp(curve));
    if (!back) ADD_FAILURE() << back.error().message;
    ++all.done;
    if (back->removed < times) {
      ++all.refused;
      continue;
    }
    EXPECT_THAT(back->curve.knots(), ElementsAreArray(curve.knots()));
    EXPECT_EQ(back->curve.is_periodic(), curve.is_periodic());
    const double ulp = distance_ulp(dice, curve, back->curve, curve.u_min(), curve.u_max());
    all.worst_ulp = std::max(all.worst_ulp, ulp);
  }
  std::printf("%d of %d not removed; worst of the others %.2f ulp of max|P|\n", all.refused,
              all.done, all.worst_ulp);
  return all;
}

TEST(RemoveKnot, OfInsertKnotGivesTheCurveBack) {
  const RoundTrips all = insert_and_remove(support::test_count(1000));
  EXPECT_LE(all.worst_ulp, 4);
  EXPECT_EQ(all.refused, 0);
}

TEST(RemoveKnotStress, OfInsertKnotGivesTheCurveBack) {
  const RoundTrips all = insert_and_remove(support::test_count(50'000));
  EXPECT_LE(all.worst_ulp, 4);
  EXPECT_EQ(all.refused, 0);
}

// The NURBS Book, 2nd ed., example 5.1 backwards.
TEST(RemoveKnot, BookExample51Backwards) {
  const NurbsCurve curve =
      made(spec_of(3, {0, 3, 1, 6, 12, 24, 9, 5}, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}));
  const auto back = remove_knot(*insert_knot(curve, 2), 2, 1, 1e-14);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->removed, 1);
  EXPECT_LE(back->max_error, 1e-14);
  EXPECT_THAT(back->curve.knots(), ElementsAreArray(curve.knots()));
  EXPECT_THAT(back->curve.points(), testing::Pointwise(testing::DoubleNear(1e-14), curve.points()));
}

// gbs issue 59, geomdl issue 176: removing a knot more than once left points of the step before in
// the array. So every way down from three times there is compared with the curve at that height.
TEST(RemoveKnot, NoPointOfAnEarlierStepIsLeftBehind) {
  const NurbsCurve curve =
      made(spec_of(3, {0, 3, 1, 6, 12, 24, 9, 5}, {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5}));
  for (const double u : {0.5, 1.5, 2.25, 4.75}) {
    for (int from = 1; from <= 3; ++from) {
      for (int times = 1; times <= from; ++times) {
        const auto less = remove_knot(*insert_knot(curve, u, from), u, times, 1e-13);
        ASSERT_TRUE(less) << less.error().message;
        EXPECT_EQ(less->removed, times);
        const NurbsCurve want = *insert_knot(curve, u, from - times);
        EXPECT_THAT(less->curve.knots(), ElementsAreArray(want.knots()));
        EXPECT_THAT(less->curve.points(),
                    testing::Pointwise(testing::DoubleNear(1e-13), want.points()));
      }
    }
  }
}

TEST(RemoveKnot, BoundIsNeverExceeded) {
  Dice dice(support::test_seed());
  int removed = 0;
  for (int round = 0; round < support::test_count(1000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const std::vector<double> knots = curve.spec().knots;
    const double u = knots[std::size_t(dice.below(static_cast<int>(knots.size())))];
    const double size = largest_coordinate(curve);
    const auto less = remove_knot(curve, u, 1 + dice.below(3), size * dice.between(0, 4));
    if (!less) continue;  // an end
    if (less->removed == 0) {
      EXPECT_EQ(less->curve, curve);
      EXPECT_EQ(less->max_error, 0);
      continue;
    }
    ++removed;
    EXPECT_EQ(less->curve.is_periodic(), curve.is_periodic());
    EXPECT_LE(found_distance(dice, curve, less->curve, 200), less->max_error + 2 * ulp_of(size));
  }
  EXPECT_GT(removed, support::test_count(100));
}

TEST(RemoveKnot, BoundIsAtMostATenthAboveTheErrorOfTameCurves) {
  Dice dice(support::test_seed());
  int removed = 0;
  double loosest = 0;
  for (int round = 0; round < support::test_count(1000); ++round) {
    const NurbsCurve curve = tame_curve(dice);
    const std::vector<double> knots = curve.spec().knots;
    const double u = knots[std::size_t(dice.below(static_cast<int>(knots.size())))];
    const double size = largest_coordinate(curve);
    const auto less = remove_knot(curve, u, 1 + dice.below(3), size * 4);
    if (!less || less->max_error < 1e-9 * size) continue;
    ++removed;
    const double found = distance_at_64ths(curve, less->curve);
    EXPECT_LE(found, less->max_error + 2 * ulp_of(size));
    loosest = std::max(loosest, less->max_error / found);
  }
  std::printf("%d removals, bound at most %.4f times the error\n", removed, loosest);
  EXPECT_LE(loosest, 1.1);
  EXPECT_GT(removed, support::test_count(200));
}

// (0, 1, 0, 1, 0) of degree 1: the peak at 1/2 is a line at 0 between its neighbours, 1 away.
TEST(RemoveKnot, KeepsToTheTolerance) {
  const NurbsCurve zigzag = made(spec_of(1, {0, 0, 1, 0, 0}));
  EXPECT_EQ(remove_knot(zigzag, 0.5, 1, 0.999)->removed, 0);
  const auto less = remove_knot(zigzag, 0.5, 1, 1);
  EXPECT_EQ(less->removed, 1);
  EXPECT_EQ(less->max_error, 1);
  EXPECT_THAT(less->curve.points(), ElementsAre(0, 0, 0, 0));
}

TEST(RemoveKnot, OfAJumpJoinsBothSidesHalfway) {
  CurveSpec spec = spec_of(1, {0, 1, -1, 0.5}, {0, 0, 0.25, 0.25, 1, 1});
  spec.jumps = {0.25};
  const NurbsCurve saw = made(spec);
  EXPECT_EQ(remove_knot(saw, 0.25, 1, 0.99)->removed, 0);
  const auto joined = remove_knot(saw, 0.25, 1, 1);
  ASSERT_EQ(joined->removed, 1);
  EXPECT_EQ(joined->max_error, 1);
  EXPECT_THAT(joined->curve.points(), ElementsAre(0, 0, 0.5));
  EXPECT_THAT(joined->curve.jumps(), testing::IsEmpty());
  const auto line = remove_knot(saw, 0.25, 2, 5);
  EXPECT_EQ(line->removed, 2);
  EXPECT_THAT(line->curve.points(), ElementsAre(0, 0.5));
}

TEST(RemoveKnot, SeamOfAPeriodicCurveKeepsOneKnot) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 200; ++round) {
    CurveSpec spec = spec_of(2 + round % 4, {});
    spec.periodic = true;
    for (int i = 0; i < 9; ++i) spec.points.push_back(dice.between(-1, 1));
    for (int i = 0; i <= 9; ++i) spec.knots.push_back(i);
    const NurbsCurve curve = made(spec);
    EXPECT_FALSE(remove_knot(curve, 0, 1, 1));
    const int more = 1 + dice.below(spec.degree - 1);
    const NurbsCurve finer = *insert_knot(curve, 0, more);
    for (const double u : {0.0, 9.0}) {
      const auto back = remove_knot(finer, u, 99, 1e-13);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->removed, more);
      EXPECT_LE(distance_ulp(dice, curve, back->curve, 0, 9), 8);
      EXPECT_EQ(back->curve.spec().knots, curve.spec().knots);
    }
  }
}

TEST(RemoveKnot, ReportsWhatIsNoInnerKnot) {
  const NurbsCurve curve = made(spec_of(1, {0, 1, 2}));
  for (const double u : {0.0, 1.0, 0.25, 7.0, std::nan("")}) {
    EXPECT_EQ(remove_knot(curve, u, 1, 1).error().code, ErrorCode::parameter_out_of_range);
  }
  EXPECT_EQ(remove_knot(curve, 0.25, 1, 1).error().message,
            "curve 'example': u = 0.25 is no knot between 0 and 1");
  EXPECT_EQ(remove_knot(curve, 0.5, -1, 1).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(remove_knot(curve, 0.5, 1, -1).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(remove_knot(curve, 0.5, 1, INFINITY).error().code, ErrorCode::value_out_of_range);
}

TEST(RemoveKnots, FindsTheKnotsACurveDoesNotNeed) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(150); ++round) {
    const NurbsCurve curve = tame_curve(dice);
    NurbsCurve finer = curve;
    int added = 0;
    for (int i = 0; i < 6; ++i) {
      const double u = dice.between(curve.u_min(), curve.u_max());
      const auto more = insert_knot(finer, u, 1);
      if (!more) continue;
      finer = *more;
      ++added;
    }
    // Every insertion has rounded; random curves need each of their own knots.
    const auto back = remove_knots(finer, 4 * few_ulp(curve));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_GE(back->removed, added);
    EXPECT_LE(back->max_error, 4 * few_ulp(curve));
    EXPECT_LE(found_distance(dice, curve, back->curve, 50), 5 * few_ulp(curve));
  }
}

TEST(RemoveKnots, BoundHoldsForTheWholeCurveWhateverTheTolerance) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(150); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double size = largest_coordinate(curve);
    const double tolerance = size * std::ldexp(1.0, -dice.below(12));
    const auto less = remove_knots(curve, tolerance);
    ASSERT_TRUE(less) << less.error().message;
    EXPECT_LE(less->max_error, tolerance);
    EXPECT_EQ(less->curve.point_count(), curve.point_count() - less->removed);
    EXPECT_LE(found_distance(dice, curve, less->curve, 100), less->max_error + 2 * ulp_of(size));
  }
}

// A drawn decay of 513 straight pieces: what a recorded controller looks like.
TEST(RemoveKnots, ThinsARecordedCurve) {
  CurveSpec spec = spec_of(1, {});
  for (int i = 0; i <= 512; ++i) spec.points.push_back(1 / (1 + i / 32.0));
  const NurbsCurve curve = made(spec);
  const auto less = remove_knots(curve, 1e-3);
  ASSERT_TRUE(less) << less.error().message;
  std::printf("%d points, bound %.6f\n", less->curve.point_count(), less->max_error);
  EXPECT_LE(less->max_error, 1e-3);
  // Chords of y = 1 / (1 + x) within 1e-3 (the ends on the curve) need about
  // integral sqrt(y'' / 8e-3) dx = 28 pieces.
  EXPECT_LE(less->curve.point_count(), 40);
}

// Squares of distances this small are 0.
TEST(RemoveKnots, BoundHoldsForPointsOfAnySize) {
  for (const double size : {1e-260, 1e-200, 1e-167, 1.0, 1e6}) {
    const NurbsCurve curve = made(spec_of(1, {0, 0.5 * size, 0.9 * size, size}));
    const auto line = remove_knots(curve, size);
    ASSERT_TRUE(line) << line.error().message;
    EXPECT_EQ(line->removed, 2);
    for (double u = 0; u <= 1; u += 0.125) {
      EXPECT_LE(std::abs(at(line->curve, u) - at(curve, u)), line->max_error) << size;
    }
    EXPECT_LE(line->max_error, 0.25 * size);
  }
}

TEST(RemoveKnots, KeepsAJumpThatIsLargerThanTheTolerance) {
  CurveSpec spec = spec_of(1, {0, 0.5, 1, -1, -0.5, 0}, {0, 0, 0.25, 0.5, 0.5, 0.75, 1, 1});
  spec.jumps = {0.5};
  const auto less = remove_knots(made(spec), 1e-3);
  ASSERT_TRUE(less) << less.error().message;
  EXPECT_THAT(less->curve.knots(), ElementsAre(0, 0, 0.5, 0.5, 1, 1));
  EXPECT_THAT(less->curve.jumps(), ElementsAre(0.5));
  EXPECT_THAT(less->curve.points(), ElementsAre(0, 1, -1, 0));
}

// geomdl issue 136: a curve whose degree was raised did not come back.
TEST(ReduceDegree, OfElevateDegreeGivesTheCurveBack) {
  Dice dice(support::test_seed());
  double worst = 0;
  int refused = 0, done = 0;
  for (int round = 0; round < support::test_count(400); ++round) {
    const NurbsCurve curve = random_curve(dice, 1 + round % (curves::kMaxDegree - 1));
    const NurbsCurve raised = *elevate_degree(curve);
    const auto back = reduce_degree(raised, 4 * few_ulp(curve));
    ++done;
    if (!back) {
      std::printf("degree %d: %s\n", curve.degree(), back.error().message.c_str());
      ++refused;
      continue;
    }
    EXPECT_EQ(back->curve.degree(), curve.degree());
    EXPECT_EQ(back->curve.is_periodic(), curve.is_periodic());
    if (curve.is_clamped() || curve.is_periodic()) {
      EXPECT_THAT(back->curve.spec().knots, ElementsAreArray(curve.spec().knots));
    }
    worst = std::max(worst, distance_ulp(dice, curve, back->curve, curve.u_min(), curve.u_max()));
  }
  std::printf("%d of %d refused, worst of the others %.2f ulp of max|P|\n", refused, done, worst);
  EXPECT_LE(worst, 4);
  EXPECT_EQ(refused, 0);
}

TEST(ReduceDegree, OfARaisedCubicGivesItsPoints) {
  const NurbsCurve cubic = made(spec_of(3, {0, 2, -1, 4, 3}, {0, 0, 0, 0, 0.5, 1, 1, 1, 1}));
  const auto back = reduce_degree(*elevate_degree(cubic), 1e-14);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->removed, 1);
  EXPECT_THAT(back->curve.points(), testing::Pointwise(testing::DoubleNear(1e-14), cubic.points()));
}

// t^p has 0 in all Bézier points but the last. With its ends kept no curve of degree p - 1 is
// nearer than 2^(1-p) / (2 c)^p, c = cos(pi / 2p): the Chebyshev polynomial stretched until its
// outer zeros are the ends. The least squares of Bézier points come within 4 times of that.
TEST(ReduceDegree, OfOneSegmentIsWithin4TimesOfTheLeastError) {
  for (int p = 2; p <= 15; ++p) {
    std::vector<double> points(std::size_t(p + 1), 0.0);
    points.back() = 1;
    const auto less = reduce_degree(made(spec_of(p, points)), 1);
    ASSERT_TRUE(less) << less.error().message;
    const double least = std::pow(2, 1 - p) / std::pow(2 * std::cos(std::acos(-1.0) / (2 * p)), p);
    EXPECT_GE(less->max_error, least * 0.9999);
    EXPECT_LE(less->max_error, least * 4);
    EXPECT_EQ(less->curve.points().front(), 0);
    EXPECT_EQ(less->curve.points().back(), 1);
  }
}

TEST(ReduceDegree, BoundIsNeverExceeded) {
  Dice dice(support::test_seed());
  int reduced = 0;
  for (int round = 0; round < support::test_count(400); ++round) {
    const NurbsCurve curve = random_curve(dice, 2 + round % (curves::kMaxDegree - 1));
    const double size = largest_coordinate(curve);
    const auto less = reduce_degree(curve, 1e6 * size);
    if (!less) {
      EXPECT_EQ(less.error().code, ErrorCode::error_bound_missed);
      continue;
    }
    ++reduced;
    EXPECT_LE(found_distance(dice, curve, less->curve, 100), less->max_error + 2 * ulp_of(size));
  }
  EXPECT_GT(reduced, 200);
}

TEST(ReduceDegree, KeepsJumpsAndCorners) {
  CurveSpec spec =
      spec_of(2, {0, 2, 1, -1, 3, 0, 1, 2}, {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.5, 1, 1, 1});
  spec.jumps = {0.5};
  const NurbsCurve curve = made(spec);
  const auto less = reduce_degree(curve, 2);
  ASSERT_TRUE(less) << less.error().message;
  EXPECT_THAT(less->curve.knots(), ElementsAre(0, 0, 0.25, 0.5, 0.5, 1, 1));
  EXPECT_THAT(less->curve.jumps(), ElementsAre(0.5));
  // x at the corner: (x/2 - 2)^2 + 2 (x - 1)^2 + ((x + 3)/2 + 1)^2 is least at 7/10.
  EXPECT_THAT(less->curve.points(), ElementsAre(0, testing::DoubleEq(0.7), 3, 0, 2));
}

TEST(ReduceDegree, APeriodNeedsEnoughKnotsOfTheLowerDegree) {
  CurveSpec spec = spec_of(6, {0, 1, 2, 3, 2, 1, 0}, {0, 0, 1, 1, 2, 2, 2, 3});
  spec.periodic = true;
  const auto error = reduce_degree(made(spec), 10);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message,
            "curve 'example': at degree 5 a period would have 4 points and needs 6, the tolerance "
            "is 10");
}

TEST(ReduceDegree, ReportsTheErrorItWouldMake) {
  const auto error = reduce_degree(made(spec_of(2, {0, 1, 0})), 0.25);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::error_bound_missed);
  EXPECT_EQ(error.error().message,
            "curve 'example': at degree 1 it is up to 0.5 away, the tolerance is 0.25");
  EXPECT_EQ(reduce_degree(made(spec_of(1, {0, 1})), 1).error().code,
            ErrorCode::degree_out_of_range);
  EXPECT_EQ(reduce_degree(made(spec_of(2, {0, 1, 0})), -1).error().code,
            ErrorCode::value_out_of_range);
}

}  // namespace
}  // namespace knotwave::test

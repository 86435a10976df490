// SPDX-License-Identifier: MIT
#include "knotwave/curves/analysis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::Break;
using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Random, one in four with a jump at one of its inner knots.
NurbsCurve any_curve(Dice& dice) {
  NurbsCurve curve = random_curve(dice);
  if (!curve.is_clamped() || curve.is_periodic() || !dice.one_in(2)) return curve;
  auto parts = to_bezier(curve);
  const auto at = std::size_t(dice.below(int(parts.size()) + 1));
  if (at == 0 || at == parts.size()) return curve;
  CurveSpec spec = curve.spec();
  const double u = parts[at].u0;
  const int have = int(std::count(spec.knots.begin(), spec.knots.end(), u));
  const auto finer = have < curve.degree() ? insert_knot(curve, u, curve.degree() - have) : curve;
  if (!finer) return curve;
  spec = finer->spec();
  const auto knot = std::find(spec.knots.begin(), spec.knots.end(), u);
  const auto point = knot - spec.knots.begin();  // the right side's first
  spec.knots.insert(knot, u);
  std::vector<double> twice(spec.points.begin() + (point - 1) * spec.dim,
                            spec.points.begin() + point * spec.dim);
  for (double& x : twice) x = -x;
  spec.points.insert(spec.points.begin() + point * spec.dim, twice.begin(), twice.end());
  if (!spec.weights.empty())
    spec.weights.insert(spec.weights.begin() + point, dice.between(0.5, 2));
  spec.jumps = {u};
  return made(std::move(spec));
}

double ulp_of_points(const NurbsCurve& curve) { return ulp_of(largest_coordinate(curve)); }

double ulp_of_knots(const NurbsCurve& curve) {
  return ulp_of(std::max(std::abs(curve.u_min()), std::abs(curve.u_max())));
}

TEST(ValueRange, TurnsEndsAndJumpsCount) {
  const auto hump = value_range(scalar(2, {0, 2, 0}));
  EXPECT_EQ(hump.high.value, 1);
  EXPECT_EQ(hump.high.u, 0.5);
  EXPECT_EQ(hump.low.value, 0);
  EXPECT_EQ(hump.low.u, 0) << "the first of both ends";
  const auto steps = value_range(scalar(1, {0, 5, -3, 1}, {0, 0, 0.5, 0.5, 1, 1}, {0.5}));
  EXPECT_EQ(steps.high.value, 5);
  EXPECT_EQ(steps.low.value, -3);
  EXPECT_EQ(steps.high.u, 0.5);
  EXPECT_EQ(steps.low.u, 0.5);
  const auto flat = value_range(scalar(3, {0.1, 0.1, 0.1, 0.1}));
  EXPECT_EQ(flat.low.value, 0.1);
  EXPECT_EQ(flat.high.value, 0.1);
}

// Doubles are 1.2e-10 apart at u = 1e6, spans here 1e-6 wide: 2^-48 of one is no double.
TEST(ValueRange, WhereDoublesAreCoarseUIsTheNextOneAndTheCurveThereMayMiss) {
  std::vector<double> knots(4, 1e6);
  for (int i = 1; i <= 3; ++i) knots.push_back(1e6 + 1e-6 * i);
  knots.insert(knots.end(), 4, 1e6 + 4e-6);
  const NurbsCurve curve = scalar(3, {0, 1e6, -1e6, 1e6, 0, -1e6, 0}, knots);
  const auto high = value_range(curve).high;
  double best_u = 0, best = -kInfinity;
  for (double u = curve.u_min(); u <= curve.u_max(); u = std::nextafter(u, kInfinity)) {
    if (at(curve, u) > best) best_u = u, best = at(curve, u);
  }
  EXPECT_GE(high.value, best);
  EXPECT_LE(std::abs(high.u - best_u), ulp_of(1e6));
  EXPECT_GT(high.value - at(curve, high.u), 1e-4) << "far more than half an ulp of 1e6";
}

// Chromium, ui/gfx/geometry/cubic_bezier_unittest.cc, Range.
TEST(ValueRange, IsThatOfChromiumsEasings) {
  const auto y = [](double y1, double y2) { return value_range(scalar(3, {0, y1, y2, 1})); };
  EXPECT_NEAR(y(-0.75, 0.5).low.value, -0.225, 1e-2);
  EXPECT_NEAR(y(0.5, 1.5).high.value - y(0.5, 1.5).low.value, 1.0, 0.3);
  EXPECT_EQ(y(0.25, 0.75).low.value, 0);
  EXPECT_EQ(y(0.25, 0.75).high.value, 1);
}

TEST(ValueRange, NoPlaceOfARandomCurveIsOutside) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(3000); ++round) {
    const NurbsCurve curve = any_curve(dice);
    const int c = dice.below(curve.dim());
    const auto range = value_range(curve, c);
    const auto hull = hull_range(curve, c);
    const double slack = ulp_of_points(curve);
    EXPECT_GE(range.low.value, hull.low);
    EXPECT_LE(range.high.value, hull.high);
    for (int i = 0; i < 20; ++i) {
      const double x =
          at(curve, random_parameter(dice, curve), dice.one_in(2) ? Side::left : Side::right, c);
      ASSERT_GE(x, range.low.value - slack);
      ASSERT_LE(x, range.high.value + slack);
    }
    // And it is taken where it is said to be, from one side or the other.
    for (const auto& end : {range.low, range.high}) {
      const double off = std::min(std::abs(at(curve, end.u, Side::left, c) - end.value),
                                  std::abs(at(curve, end.u, Side::right, c) - end.value));
      double slopes[2 * curves::kMaxDim];
      curve.derivatives(end.u, 1, Side::right, slopes);
      const double moved = std::abs(slopes[curve.dim() + c]) * ulp_of_knots(curve);
      EXPECT_LE(off, 2 * slack + 4 * moved) << "round " << round;
    }
  }
}

TEST(ParametersAt, CrossingsTouchesStretchesAndJumps) {
  const NurbsCurve hump = scalar(2, {0, 2, 0});
  EXPECT_THAT(parameters_at(hump, 0.75), ElementsAre(0.25, 0.75));
  EXPECT_THAT(parameters_at(hump, 1), ElementsAre(0.5)) << "a touch, once";
  EXPECT_THAT(parameters_at(hump, 0), ElementsAre(0, 1));
  EXPECT_THAT(parameters_at(hump, 1.01), IsEmpty());
  EXPECT_THAT(parameters_at(hump, std::nan("")), IsEmpty());
  EXPECT_THAT(parameters_at(hump, kInfinity), IsEmpty());
  const NurbsCurve steps = scalar(1, {0, 1, 3, 4}, {0, 0, 0.5, 0.5, 1, 1}, {0.5});
  EXPECT_THAT(parameters_at(steps, 2), ElementsAre(0.5)) << "at the jump";
  EXPECT_THAT(parameters_at(steps, 1), ElementsAre(0.5)) << "its left side";
  EXPECT_THAT(parameters_at(steps, 3), ElementsAre(0.5)) << "its right side";
  const NurbsCurve table = scalar(1, {0, 1, 1, 1, 0}, {0, 0, 1, 2, 3, 4, 4});
  EXPECT_THAT(parameters_at(table, 1), ElementsAre(1, 3)) << "the ends of a stretch";
  EXPECT_THAT(parameters_at(table, 0.5), ElementsAre(0.5, 3.5));
  EXPECT_THAT(parameters_at(scalar(2, {7, 7, 7}), 7), ElementsAre(0, 1));
}

TEST(ParametersAt, APeriodicCurveHasItsSeamOnce) {
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {0, 1, 0, -1};
  spec.periodic = true;
  const NurbsCurve triangle = made(spec);
  EXPECT_THAT(parameters_at(triangle, 0), ElementsAre(0, 0.5));
  EXPECT_THAT(parameters_at(triangle, 1), ElementsAre(0.25));
  EXPECT_THAT(parameters_at(triangle, -0.5), ElementsAre(0.625, 0.875));
}

TEST(ParametersAt, EveryPlaceOfARandomCurveIsFoundAgain) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(3000); ++round) {
    const NurbsCurve curve = any_curve(dice);
    const int c = dice.below(curve.dim());
    const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    const double value = at(curve, u, Side::right, c);
    const std::vector<double> found = parameters_at(curve, value, c);
    ASSERT_FALSE(found.empty()) << "round " << round;
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    // Each has the value, but for what 4 ulp of u make of it; or the value is jumped across.
    const double beside = 4 * ulp_of_knots(curve);
    for (const double x : found) {
      const double left = at(curve, x, Side::left, c) - value;
      const double right = at(curve, x, Side::right, c) - value;
      const double below = at(curve, std::max(x - beside, curve.u_min()), Side::left, c);
      const double above = at(curve, std::min(x + beside, curve.u_max()), Side::left, c);
      const double slack = 2 * ulp_of_points(curve) + std::abs(below - above);
      EXPECT_TRUE(left * right <= 0 || (below - value) * (above - value) <= 0 ||
                  std::min(std::abs(left), std::abs(right)) <= slack)
          << "round " << round << ": " << left << " and " << right << " at " << x;
    }
  }
}

TEST(TotalVariation, IsWhatARiseAFallAndAJumpAddUpTo) {
  EXPECT_EQ(total_variation(scalar(2, {0, 2, 0})), 2);
  EXPECT_EQ(total_variation(scalar(1, {0, 5, -3, 1}, {0, 0, 0.5, 0.5, 1, 1}, {0.5})), 5 + 8 + 4);
  EXPECT_EQ(total_variation(scalar(3, {0.1, 0.1, 0.1, 0.1, 0.1})), 0);
}

// Variation diminution (The NURBS Book, 3.2): a curve moves no more than its polygon.
TEST(TotalVariation, IsAtMostThatOfTheControlPolygon) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(3000); ++round) {
    const NurbsCurve curve = any_curve(dice);
    const int c = dice.below(curve.dim());
    double polygon = 0;
    for (int i = 1; i < curve.point_count(); ++i) {
      polygon += std::abs(curve.points()[std::size_t(i * curve.dim() + c)] -
                          curve.points()[std::size_t((i - 1) * curve.dim() + c)]);
    }
    const auto range = value_range(curve, c);
    const double moved = total_variation(curve, c);
    EXPECT_LE(moved, polygon * (1 + 1e-15) + ulp_of_points(curve));
    EXPECT_GE(moved, range.high.value - range.low.value - 4 * ulp_of_points(curve));
  }
}

TEST(SpanHulls, HoldTheirSpans) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(3000); ++round) {
    const NurbsCurve curve = any_curve(dice);
    const int c = dice.below(curve.dim());
    const auto hulls = span_hulls(curve, c);
    EXPECT_EQ(hulls.back().u1, curve.u_max());
    for (std::size_t i = 0; i < hulls.size(); ++i) {
      EXPECT_EQ(hulls[i].u0, i > 0 ? hulls[i - 1].u1 : curve.u_min());
      for (const double share : {0.0, dice.unit(), 1.0}) {
        const double u = std::min(hulls[i].u0 + share * (hulls[i].u1 - hulls[i].u0), hulls[i].u1);
        const double x = at(curve, u, u == hulls[i].u0 ? Side::right : Side::left, c);
        EXPECT_GE(x, hulls[i].low - ulp_of_points(curve));
        EXPECT_LE(x, hulls[i].high + ulp_of_points(curve));
      }
    }
  }
}

TEST(ClosestPoint, OfAQuarterCircle) {
  CurveSpec spec;
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {1, 0, 1, 1, 0, 1};
  spec.weights = {1, std::sqrt(0.5), 1};
  const NurbsCurve arc = made(spec);
  const auto diagonal = closest_point(arc, std::vector<double>{2, 2});
  ASSERT_TRUE(diagonal);
  EXPECT_NEAR(diagonal->u, 0.5, 1e-15);
  EXPECT_NEAR(diagonal->distance, std::sqrt(8.0) - 1, 1e-15);
  EXPECT_EQ(closest_point(arc, std::vector<double>{3, -1})->u, 0) << "an end";
  const auto centre = closest_point(arc, std::vector<double>{0, 0});
  EXPECT_NEAR(centre->distance, 1, 1e-15) << "every place is as near";
  EXPECT_EQ(closest_point(arc, std::vector<double>{1}).error().code, ErrorCode::dimension_mismatch);
  EXPECT_EQ(closest_point(arc, std::vector<double>{1, kInfinity}).error().code,
            ErrorCode::not_finite);
  EXPECT_EQ(closest_point(arc, std::vector<double>{1, 2e6}).error().code,
            ErrorCode::coordinate_out_of_range);
}

TEST(ClosestPoint, NoOtherPlaceOfARandomCurveIsNearer) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(1000); ++round) {
    const NurbsCurve curve = any_curve(dice);
    const double most = largest_coordinate(curve);
    std::vector<double> point(std::size_t(curve.dim()));
    for (double& x : point) x = std::clamp(1.5 * most * dice.between(-1, 1), -1e6, 1e6);
    const auto best = closest_point(curve, point);
    ASSERT_TRUE(best);
    const auto distance = [&](double u, Side side) {
      double out[curves::kMaxDim], square = 0;
      curve.evaluate(u, side, out);
      for (std::size_t c = 0; c < point.size(); ++c) {
        square += (out[c] - point[c]) * (out[c] - point[c]);
      }
      return std::sqrt(square);
    };
    for (int i = 0; i < 30; ++i) {
      const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
      const Side side = dice.one_in(2) ? Side::left : Side::right;
      ASSERT_GE(distance(u, side), best->distance - 4 * ulp_of(2.5 * most)) << "round " << round;
    }
  }
}

TEST(ClosestPoint, IsFoundWhereWeightsMakeAllElseSmall) {
  // Expected: golden sections with mpmath at 60 digits.
  CurveSpec spec;
  spec.name = "heavy end";
  spec.dim = 2;
  spec.degree = 4;
  spec.points = {9, -4, -1, 2, -4, -8, 0, -6, -2, 0};
  spec.weights = {1e-6, 1e-3, 100, 1e4, 1e6};
  const auto steep = closest_point(made(spec), std::vector<double>{5, -6});
  ASSERT_TRUE(steep);
  EXPECT_NEAR(steep->u, 2.6797807989315990628e-5, 1e-19);
  EXPECT_NEAR(steep->distance, 1.3410453071215261800, 1e-15);
  spec.degree = 3;
  spec.points = {-2, -3, 8, -2, -4, 7, -8, -1};
  spec.weights = {1e-6, 1e-6, 1e3, 1e6};
  const auto slight = closest_point(made(spec), std::vector<double>{5, -3});
  ASSERT_TRUE(slight);
  EXPECT_NEAR(slight->u, 2.4999902073991038224e-9, 1e-22);
  EXPECT_NEAR(slight->distance, 6.9999999625000974499, 2e-15);
}

TEST(ClosestPoint, NoPlaceIsNearerWhateverTheWeights) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(500); ++round) {
    CurveSpec spec;
    spec.name = "weighted";
    spec.dim = 2;
    spec.degree = dice.below(6) + 2;
    for (int i = 0; i <= spec.degree; ++i) {
      spec.points.push_back(dice.below(21) - 10);
      spec.points.push_back(dice.below(21) - 10);
      spec.weights.push_back(std::pow(10, dice.below(13) - 6));
    }
    const NurbsCurve curve = made(spec);
    const std::vector<double> point = {double(dice.below(21) - 10), double(dice.below(21) - 10)};
    const auto best = closest_point(curve, point);
    ASSERT_TRUE(best);
    // As dense towards the ends as in the middle, by ratios of 1.1.
    for (double step = 0.5; step > 1e-16; step /= 1.1) {
      for (const double u : {step, 1 - step}) {
        double out[2];
        curve.evaluate(u, Side::right, out);
        ASSERT_GE(std::hypot(out[0] - point[0], out[1] - point[1]), best->distance - 1e-9)
            << "round " << round << ", u = " << u << ", found " << best->u;
      }
    }
  }
}

TEST(ClosestPoint, SaysTheDistanceAtTheNearestOfCoarseParameters) {
  // Doubles are 2^-33 apart at 1e6, 32 of them to the span.
  const double low = 1e6, step = 0x1p-33, high = low + 32 * step;
  CurveSpec spec;
  spec.name = "late";
  spec.dim = 2;
  spec.degree = 2;
  spec.points = {0, 0, 1, 2, 2, 0};
  spec.knots = {low, low, low, high, high, high};
  const NurbsCurve curve = made(spec);
  for (const double x : {0.01, 0.3, 0.52, 0.77, 1.0, 1.49, 1.98}) {
    const auto found = closest_point(curve, std::vector<double>{x, 1});
    ASSERT_TRUE(found);
    const auto distance = [&](double u) {
      double out[2];
      curve.evaluate(u, Side::right, out);
      return std::hypot(out[0] - x, out[1] - 1);
    };
    double least = kInfinity;
    for (int i = 0; i <= 32; ++i) least = std::min(least, distance(low + i * step));
    EXPECT_NEAR(found->distance, distance(found->u), 1e-15) << x;
    EXPECT_NEAR(found->distance, least, 1e-15) << x;
  }
}

TEST(BreaksOf, AreLookedForUpToAThousandthDerivative) {
  const NurbsCurve plain = scalar(2, {0, 1, 0, 1}, {0, 0, 0, 0.5, 1, 1, 1});
  EXPECT_EQ(breaks_of(plain, std::numeric_limits<int>::max()).size(), breaks_of(plain, 2).size());
  CurveSpec spec = plain.spec();
  spec.weights = {1, 2, 1, 3};
  const NurbsCurve rational = made(spec);
  const auto most = breaks_of(rational, std::numeric_limits<int>::max());
  const auto known = breaks_of(rational, curves::kMaxBreakOrder);
  ASSERT_EQ(most.size(), known.size());
  ASSERT_EQ(most.size(), 1u);
  EXPECT_EQ(most[0].order, known[0].order);
  EXPECT_EQ(most[0].size, known[0].size);
}

TEST(BreaksOf, HaveFiniteSizes) {
  for (const auto& found : breaks_of(scalar(1, {0, 1, -1}, {0, 0, 1e-280, 1, 1}), 3)) {
    EXPECT_TRUE(std::isfinite(found.size)) << found.u << ", order " << found.order;
  }
}

TEST(BreaksOf, SayWhatJumpsFirst) {
  // A value's jump at 0.25, a corner at 0.5, a jump of curvature at 0.75.
  const NurbsCurve steps = scalar(1, {0, 1, 3, 4, 0}, {0, 0, 0.5, 0.5, 0.75, 1, 1}, {0.5});
  const auto found = breaks_of(steps, 3);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].u, 0.5);
  EXPECT_EQ(found[0].order, 0);
  EXPECT_EQ(found[0].size, 2);
  EXPECT_EQ(found[1].u, 0.75);
  EXPECT_EQ(found[1].order, 1);
  EXPECT_EQ(found[1].size, -16 - 4);
  EXPECT_EQ(breaks_of(steps, 0).size(), 1u);
  EXPECT_THAT(breaks_of(steps, -1), IsEmpty());
  const auto cubic = breaks_of(scalar(3, {0, 1, 0, 1, 0}, {0, 0, 0, 0, 1, 2, 2, 2, 2}), 3);
  ASSERT_EQ(cubic.size(), 1u);
  EXPECT_EQ(cubic[0].order, 3);
}

TEST(BreaksOf, TheSeamIsAKnot) {
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {0, 1, 0, -1};
  spec.periodic = true;
  const auto corners = breaks_of(made(spec), 2);
  ASSERT_EQ(corners.size(), 2u) << "0 and 0.5 lie on a line";
  EXPECT_EQ(corners[0].u, 0.25);
  EXPECT_EQ(corners[0].size, -8);
  EXPECT_EQ(corners[1].u, 0.75);
  spec.points = {1, 0, -1, 0};
  const auto at_seam = breaks_of(made(spec), 2);
  ASSERT_EQ(at_seam.size(), 2u);
  EXPECT_EQ(at_seam[0].u, 0);
  EXPECT_EQ(at_seam[0].size, -8);
}

TEST(BreaksOf, AnInsertedKnotIsNone) {
  Dice dice(support::test_seed());
  int inserted = 0;
  for (int round = 0; round < support::test_count(2000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = dice.between(curve.u_min(), curve.u_max());
    const auto knots = curve.knots();
    if (std::count(knots.begin(), knots.end(), u) > 0) continue;
    const auto finer = insert_knot(curve, u, 1 + dice.below(curve.degree()));
    if (!finer) continue;
    ++inserted;
    for (const Break& found : breaks_of(*finer, curve.degree())) {
      EXPECT_NE(found.u, u) << "round " << round << " order " << found.order << " " << found.size;
    }
  }
  EXPECT_GT(inserted, support::test_count(1000));
}

}  // namespace
}  // namespace knotwave::test

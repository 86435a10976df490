// SPDX-License-Identifier: MIT
// Both sides of every knot, simple, double, full and a jump, through every operation on curves.
#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/combine.h"
#include "knotwave/curves/extrapolate.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "example_curve.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;

constexpr double kKnots[] = {0.125, 0.25, 0.5, 0.75};
constexpr double kJump = 0.75;  // from 2 to -1

/// Degree 3: a simple knot, a double one, a corner and a jump.
NurbsCurve knotty(std::vector<double> weights = {}) {
  CurveSpec spec =
      spec_of(3, {0, 1, 0.5, -1, 2, 1, 0, 1, 3, 2, -1, 0, 1, 0.5},
              {0, 0, 0, 0, 0.125, 0.25, 0.25, 0.5, 0.5, 0.5, 0.75, 0.75, 0.75, 0.75, 1, 1, 1, 1},
              std::move(weights));
  spec.jumps = {kJump};
  return made(std::move(spec));
}
NurbsCurve weighted_knotty() { return knotty({1, 2, 1, 3, 1, 0.5, 1, 2, 1, 1, 1, 4, 1, 2}); }

/// `edited` at place(u) is `curve` at u, from both sides of each knot and between.
void expect_same(
    const NurbsCurve& curve, const Result<NurbsCurve>& edited,
    const std::function<double(double)>& place = [](double u) { return u; },
    bool backwards = false) {
  ASSERT_TRUE(edited) << edited.error().message;
  EXPECT_THAT(edited->jumps(), ElementsAre(place(kJump)));
  for (const double u : kKnots) {
    for (const Side side : {Side::left, Side::right}) {
      const Side there = !backwards ? side : side == Side::left ? Side::right : Side::left;
      EXPECT_NEAR(at(*edited, place(u), there), at(curve, u, side), 4e-15) << u;
    }
  }
  for (const double u : {0.0, 0.1, 0.3, 0.6, 0.9, 1.0}) {
    EXPECT_NEAR(at(*edited, place(u)), at(curve, u), 4e-15) << u;
  }
}

TEST(OneSided, EditsKeepBothSides) {
  for (const NurbsCurve& curve : {knotty(), weighted_knotty()}) {
    EXPECT_EQ(at(curve, kJump, Side::left), 2);
    EXPECT_EQ(at(curve, kJump, Side::right), -1);
    expect_same(curve, insert_knot(curve, 0.125, 2));
    expect_same(curve, insert_knot(curve, 0.25));
    expect_same(curve, refine(curve, std::vector{0.125, 0.6, 0.25, 0.6, 0.8}));
    expect_same(curve, elevate_degree(curve, 2));
    expect_same(curve, from_bezier(to_bezier(curve)));
    const auto finer = insert_knot(curve, 0.125, 2);
    ASSERT_TRUE(finer);
    expect_same(curve, remove_knot(*finer, 0.125, 2, 1e-13)->curve);
    expect_same(curve, reduce_degree(*elevate_degree(curve), 1e-12)->curve);
    expect_same(
        curve, reverse(curve), [](double u) { return 1 - u; }, true);
    expect_same(curve, reparametrize(curve, 2, 6), [](double u) { return 2 + 4 * u; });
    expect_same(curve, bend(curve, 3), [](double u) { return 3 * u / (1 + 2 * u); });
  }
}

TEST(OneSided, PartsTakeTheSideInside) {
  const NurbsCurve curve = weighted_knotty();
  const auto parts = split(curve, kJump);
  ASSERT_TRUE(parts);
  EXPECT_EQ(at(parts->left, kJump), 2);
  EXPECT_EQ(at(parts->right, kJump), -1);
  expect_same(curve, join(parts->left, parts->right));
  EXPECT_EQ(at(*sub_curve(curve, 0.5, kJump), kJump), 2);
  EXPECT_EQ(at(*sub_curve(curve, kJump, 1), kJump), -1);
  const auto powers = curves::to_power_basis(curve);
  ASSERT_EQ(powers.size(), 5u);
  const auto last = from_power_basis(powers[3]), next = from_power_basis(powers[4]);
  ASSERT_TRUE(last && next);
  EXPECT_NEAR(last->points.back(), 2, 1e-14);
  EXPECT_NEAR(next->points.front(), -1, 1e-14);
  double left[2], right[2];
  const std::vector<double> three(3, kJump);
  blossom(curve, find_span(curve.knots(), 3, kJump, Side::left), three, left);
  blossom(curve, find_span(curve.knots(), 3, kJump, Side::right), three, right);
  EXPECT_NEAR(left[0] / left[1], 2, 1e-14);
  EXPECT_NEAR(right[0] / right[1], -1, 1e-14);
}

TEST(OneSided, TwoCurvesKeepTheSidesOfBoth) {
  for (const NurbsCurve& curve : {knotty(), weighted_knotty()}) {
    const NurbsCurve one = scalar(1, {1, 1}), zero = scalar(1, {0, 0}), line = scalar(1, {0, 1});
    expect_same(curve, product(curve, one));
    expect_same(curve, sum(curve, zero));
    expect_same(curve, compose(curve, line));
    expect_same(curve, morph(curve, one, 0));
    const auto both = make_compatible(curve, line);
    ASSERT_TRUE(both);
    expect_same(curve, both->first);
    EXPECT_EQ(at(both->second, kJump, Side::left), at(both->second, kJump, Side::right));
  }
}

TEST(OneSided, SlopesAndAreasHaveTheSidesOfTheCurve) {
  const NurbsCurve curve = knotty();
  const auto area = antiderivative(curve);
  ASSERT_TRUE(area);
  expect_same(curve, hodograph(*area));
  const auto smooth = sub_curve(weighted_knotty(), 0, kJump);
  ASSERT_TRUE(smooth);
  const auto slope = hodograph(*smooth);
  ASSERT_TRUE(slope) << slope.error().message;
  EXPECT_THAT(slope->jumps(), ElementsAre(0.5)) << "the corner";
  for (const double u : {0.125, 0.25, 0.5}) {
    for (const Side side : {Side::left, Side::right}) {
      double exact[2];
      smooth->derivatives(u, 1, side, exact);
      EXPECT_NEAR(at(*slope, u, side), exact[1], 1e-12) << u;
    }
  }
  EXPECT_NE(curvature(curve, 0.5, Side::left), curvature(curve, 0.5, Side::right));
  EXPECT_EQ(*integral(curve, kJump, kJump), 0);
  EXPECT_EQ(*arc_length(curve, kJump, kJump), 0);
}

TEST(OneSided, BothSidesOfAJumpCountForWhatACurveDoes) {
  const NurbsCurve steps = scalar(1, {0, 2, -1, 1}, {0, 0, 0.75, 0.75, 1, 1}, {kJump});
  const auto range = value_range(steps);
  EXPECT_EQ(range.high.value, 2);
  EXPECT_EQ(range.high.u, kJump);
  EXPECT_EQ(range.low.value, -1);
  EXPECT_EQ(range.low.u, kJump);
  EXPECT_EQ(total_variation(steps), 2 + 3 + 2);
  EXPECT_THAT(parameters_at(steps, 1.5), ElementsAre(0.5625, kJump));
  EXPECT_THAT(parameters_at(steps, 2), ElementsAre(kJump));
  EXPECT_THAT(parameters_at(steps, -1), ElementsAre(kJump));
  for (const double nearest : {2.5, -1.5}) {
    const auto foot = closest_point(steps, std::vector{nearest});
    ASSERT_TRUE(foot);
    EXPECT_EQ(foot->u, kJump);
    EXPECT_EQ(foot->distance, 0.5);
  }
  const auto hulls = span_hulls(steps);
  ASSERT_EQ(hulls.size(), 2u);
  EXPECT_EQ(hulls[0].high, 2);
  EXPECT_EQ(hulls[1].low, -1);
  const auto breaks = breaks_of(steps, 0);
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0].size, -3);
  EXPECT_FALSE(is_non_decreasing(steps));
  double value = 0;
  using enum curves::Extrapolation;
  evaluate_extrapolated(steps, 1 + kJump, periodic, periodic, {&value, 1});
  EXPECT_EQ(value, -1);
  evaluate_extrapolated(steps, 2 - kJump, mirror, mirror, {&value, 1});
  EXPECT_EQ(value, 2);
}

}  // namespace
}  // namespace knotwave::test

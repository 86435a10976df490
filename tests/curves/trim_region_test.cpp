// SPDX-License-Identifier: MIT
#include "knotwave/curves/trim_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/reparametrize.h"
#include "knotwave/curves/shapes.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::Interval;
using curves::NurbsCurve;
using curves::TrimLoop;
using curves::TrimRegion;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

NurbsCurve curve_of(int degree, std::vector<double> points, std::vector<double> weights = {}) {
  CurveSpec spec;
  spec.name = "edge";
  spec.degree = degree;
  spec.dim = 2;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

TrimLoop backwards(const TrimLoop& loop) {
  TrimLoop turned;
  for (auto curve = loop.rbegin(); curve != loop.rend(); ++curve) {
    turned.push_back(*reverse(*curve));
  }
  return turned;
}

TrimLoop box(double low, double high) { return *curves::rectangle_loop(low, high, low, high); }

TrimLoop circle(double u, double v, double radius) {
  CurveSpec spec = curves::arc(radius, 0, 1)->spec();
  for (std::size_t i = 0; i < spec.points.size(); i += 2) {
    spec.points[i] += u;
    spec.points[i + 1] += v;
  }
  return {*NurbsCurve::create(spec)};
}

TrimRegion region_of(std::vector<TrimLoop> loops) {
  auto region = TrimRegion::create(loops);
  EXPECT_TRUE(region) << (region ? "" : region.error().message);
  return std::move(*region);
}

Error fault_of(std::vector<TrimLoop> loops) {
  const auto region = TrimRegion::create(loops);
  EXPECT_FALSE(region);
  return region ? Error{} : region.error();
}

TEST(TrimRegion, ARectangleKeepsItsInsideAndItsBorders) {
  const TrimRegion zone = region_of({*curves::rectangle_loop(48, 60, 1, 64)});
  EXPECT_TRUE(zone.contains(50, 30));
  EXPECT_FALSE(zone.contains(47.999, 30));
  EXPECT_FALSE(zone.contains(50, 64.001));
  for (const double u : {48.0, 53.3, 60.0}) {
    for (const double v : {1.0, 17.7, 64.0}) EXPECT_TRUE(zone.contains(u, v)) << u << " " << v;
  }
  EXPECT_THAT(zone.intervals_at_v(30), ElementsAre(Interval{48, 60}));
  EXPECT_THAT(zone.intervals_at_v(1), ElementsAre(Interval{48, 60}));
  EXPECT_THAT(zone.intervals_at_v(64), ElementsAre(Interval{48, 60}));
  EXPECT_THAT(zone.intervals_at_u(48), ElementsAre(Interval{1, 64}));
  EXPECT_THAT(zone.intervals_at_v(64.5), IsEmpty());
  EXPECT_FALSE(zone.is_unbounded());
}

TEST(TrimRegion, NoLoopKeepsEverything) {
  const TrimRegion all = region_of({});
  EXPECT_TRUE(all.contains(1e300, -7));
  EXPECT_THAT(all.intervals_at_v(0), ElementsAre(Interval{-kInfinity, kInfinity}));
  EXPECT_TRUE(all.is_unbounded());
}

TEST(TrimRegion, WhatLiesToTheLeftIsKept) {
  const TrimRegion hole = region_of({backwards(box(0, 1))});
  EXPECT_FALSE(hole.contains(0.5, 0.5));
  EXPECT_TRUE(hole.contains(1, 0.5));
  EXPECT_TRUE(hole.contains(3, 0.5));
  EXPECT_TRUE(hole.contains(0.5, -9));
  EXPECT_THAT(hole.intervals_at_v(0.5),
              ElementsAre(Interval{-kInfinity, 0}, Interval{1, kInfinity}));
  EXPECT_THAT(hole.intervals_at_v(1), ElementsAre(Interval{-kInfinity, kInfinity}));
}

// GLU's picture: a square with a hole, and an island in the hole.
TEST(TrimRegion, NestedLoopsAlternate) {
  const TrimRegion region = region_of({box(0, 10), backwards(box(2, 8)), box(4, 6)});
  EXPECT_TRUE(region.contains(1, 5));
  EXPECT_FALSE(region.contains(3, 5));
  EXPECT_TRUE(region.contains(5, 5));
  EXPECT_THAT(region.intervals_at_v(5),
              ElementsAre(Interval{0, 2}, Interval{4, 6}, Interval{8, 10}));
  EXPECT_THAT(region.intervals_at_u(5),
              ElementsAre(Interval{0, 2}, Interval{4, 6}, Interval{8, 10}));
  EXPECT_THAT(region.intervals_at_v(8), ElementsAre(Interval{0, 10}));
  const Error wrong = fault_of({box(0, 10), box(2, 8)});
  EXPECT_EQ(wrong.code, ErrorCode::malformed);
  EXPECT_EQ(wrong.message,
            "loop 1 runs counter-clockwise inside 1 others; beside loop 0 it must run clockwise: "
            "nested loops alternate");
}

TEST(TrimRegion, LoopsSideBySideRunTheSameWay) {
  const TrimRegion two = region_of({box(0, 1), box(2, 3)});
  EXPECT_TRUE(two.contains(0.5, 0.5));
  EXPECT_FALSE(two.contains(1.5, 0.5));
  EXPECT_TRUE(two.contains(2.5, 2.5));
  EXPECT_EQ(fault_of({box(0, 1), backwards(box(2, 3))}).code, ErrorCode::malformed);
}

TEST(TrimRegion, ADiscHasTheChordsOfItsCircle) {
  const TrimRegion disc = region_of({circle(0.5, 0.5, 0.25)});
  for (int i = -99; i <= 99; ++i) {
    const double v = 0.5 + 0.0025 * i;
    const double half = std::sqrt(0.0625 - (v - 0.5) * (v - 0.5));
    const auto kept = disc.intervals_at_v(v);
    ASSERT_EQ(kept.size(), 1u) << v;
    EXPECT_NEAR(kept[0].low, 0.5 - half, 1e-14);
    EXPECT_NEAR(kept[0].high, 0.5 + half, 1e-14);
  }
  EXPECT_THAT(disc.intervals_at_v(0.75), ElementsAre(Interval{0.5, 0.5}));
  EXPECT_THAT(disc.intervals_at_v(0.75001), IsEmpty());
  EXPECT_TRUE(disc.contains(0.5, 0.75));
  EXPECT_TRUE(disc.contains(0.75, 0.5));
  EXPECT_FALSE(disc.contains(0.7, 0.7));
  EXPECT_TRUE(disc.contains(0.65, 0.65));
}

// Corners to the left, right, up, down and inwards at levels that are hit exactly.
TEST(TrimRegion, CornersCountOnce) {
  const NurbsCurve star = curve_of(1, {0, 0, 2, 1, 4, 0, 3, 2, 4, 4, 2, 3, 0, 4, 1, 2, 0, 0});
  const TrimRegion region = region_of({{star}});
  EXPECT_THAT(region.intervals_at_v(2), ElementsAre(Interval{1, 3}));
  EXPECT_THAT(region.intervals_at_v(0), ElementsAre(Interval{0, 0}, Interval{4, 4}));
  EXPECT_THAT(region.intervals_at_v(1), ElementsAre(Interval{0.5, 3.5}));
  EXPECT_THAT(region.intervals_at_v(0.5), ElementsAre(Interval{0.25, 1}, Interval{3, 3.75}));
  EXPECT_TRUE(region.contains(2, 1));
  EXPECT_FALSE(region.contains(2, 0.999));
  EXPECT_FALSE(region.contains(0.9, 2));
}

TEST(TrimRegion, EndsWithinTheToleranceAreJoined) {
  const NurbsCurve side = curve_of(2, {0, 0, 1, -1, 2, 0});
  const NurbsCurve back = curve_of(2, {2, 1e-10, 1, 1, 1e-10, 0});
  const TrimRegion region = region_of({{side, back}});
  const auto& loop = region.loops().at(0);
  EXPECT_EQ(loop[1].points()[1], 0);
  EXPECT_EQ(loop[1].points()[4], 0);
  EXPECT_TRUE(region.contains(1, 0));
  const Error gap = fault_of({{side, curve_of(2, {2, 0.25, 1, 1, 0, 0})}});
  EXPECT_EQ(gap.code, ErrorCode::not_closed);
  EXPECT_EQ(
      gap.message,
      "loop 0: curve 'edge' ends at (2, 0), curve 'edge' begins at (2, 0.25), 0.25 apart; the "
      "tolerance is 1e-09");
  EXPECT_EQ(fault_of({{}}).code, ErrorCode::not_closed);
}

TEST(TrimRegion, APeriodicCurveIsALoop) {
  CurveSpec spec;
  spec.dim = 2;
  spec.periodic = true;
  spec.points = {1, 0, 0, 1, -1, 0, 0, -1};
  const TrimRegion round = region_of({{*NurbsCurve::create(spec)}});
  EXPECT_TRUE(round.contains(0, 0));
  EXPECT_FALSE(round.contains(0.9, 0));
}

TEST(TrimRegion, LoopsThatCrossOrTouchAreRefused) {
  EXPECT_EQ(fault_of({box(0, 2), box(1, 3)}).code, ErrorCode::malformed);
  EXPECT_THAT(fault_of({box(0, 2), box(1, 3)}).message, HasSubstr("loops 0 and 1 cross or touch"));
  EXPECT_EQ(fault_of({box(0, 2), box(2, 3)}).code, ErrorCode::malformed);             // a corner
  EXPECT_EQ(fault_of({box(0, 2), backwards(box(0, 1))}).code, ErrorCode::malformed);  // a side
  EXPECT_EQ(fault_of({box(0, 1), box(0, 1)}).code, ErrorCode::malformed);
  EXPECT_EQ(fault_of({box(-2, 2), backwards(circle(0, 0, 2))}).code, ErrorCode::malformed);
  const Error eight = fault_of({{curve_of(1, {0, 0, 2, 2, 2, 0, 0, 2, 0, 0})}});
  EXPECT_EQ(eight.code, ErrorCode::malformed);
  EXPECT_THAT(eight.message, HasSubstr("loop 0 crosses or touches itself near (0.99999"));
  // A cubic that loops, closed by a line.
  EXPECT_EQ(fault_of({{curve_of(3, {0, 0, 4, 3, -3, 3, 1, 0}), curve_of(1, {1, 0, 0, 0})}}).code,
            ErrorCode::malformed);
}

TEST(TrimRegion, LoopsThatOnlyComeNearAreNot) {
  const double gap = 1e-7;
  region_of({box(0, 1), *curves::rectangle_loop(1 + gap, 2, 0, 1)});
  region_of({circle(0, 0, 1), backwards(circle(0, 0, 1 - gap))});
  // A sharp corner, and a cusp.
  region_of({{curve_of(1, {0, 0, 1, 1e-6, 1, 2e-6, 0, 0})}});
  region_of({{curve_of(2, {0, 0, 1, 0, 2, 1}), curve_of(2, {2, 1, 1, 0.5, 0, 0})}});
  region_of({{curve_of(2, {0, 0, 1, 0, 2, 1}), curve_of(1, {2, 1, 2, 3}),
              curve_of(2, {2, 3, 1, 0, 0, 0})}});
}

// Without an end to the pairs looked at, this took minutes.
TEST(TrimRegion, LoopsTooNearToTellApartSoonAreRefused) {
  const Error error = fault_of({circle(0, 0, 1), backwards(circle(0, 0, 1 - 2e-12))});
  EXPECT_EQ(error.code, ErrorCode::malformed);
  EXPECT_THAT(error.message, testing::HasSubstr("loops 0 and 1 cross or touch"));
}

TEST(TrimRegion, OtherFaultsNameTheLoop) {
  EXPECT_EQ(fault_of({{curve_of(1, {0, 0, 1, 1}), curve_of(1, {1, 1, 0, 0})}}).code,
            ErrorCode::malformed);
  EXPECT_EQ(fault_of({box(0, 1), {curve_of(2, {5, 5, 6, 5, 5, 5})}}).message,
            "loop 1 encloses nothing");
  CurveSpec flat;
  flat.name = "flat";
  flat.points = {0, 1, 2, 0};
  EXPECT_EQ(fault_of({{*NurbsCurve::create(flat)}}).message,
            "loop 0, curve 'flat': a loop needs 2 coordinates, found 1");
  EXPECT_EQ(TrimRegion::create({}, -1).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::rectangle_loop(1, 1, 0, 2).error().code, ErrorCode::empty_domain);
  EXPECT_EQ(curves::rectangle_loop(0, kNan, 0, 2).error().code, ErrorCode::not_finite);
}

TEST(TrimRegion, NanIsOutsideAndInfinityIsBeyondAllLoops) {
  const TrimRegion inside = region_of({box(0, 1)}), outside = region_of({backwards(box(0, 1))});
  EXPECT_FALSE(inside.contains(kNan, 0.5));
  EXPECT_FALSE(outside.contains(0.5, kNan));
  EXPECT_FALSE(inside.contains(kInfinity, 0.5));
  EXPECT_TRUE(outside.contains(-kInfinity, 0.5));
  EXPECT_THAT(outside.intervals_at_v(kNan), IsEmpty());
  EXPECT_THAT(outside.intervals_at_v(kInfinity), ElementsAre(Interval{-kInfinity, kInfinity}));
}

// A blob around the origin whose radius is a positive wave of the angle: a point is inside if it is
// nearer than the border in its direction, found by following the border.
NurbsCurve blob(Dice& dice) {
  CurveSpec spec;
  spec.name = "blob";
  spec.degree = 1 + dice.below(4);
  spec.dim = 2;
  spec.periodic = true;
  const int n = std::max(spec.degree + 1, 5) + dice.below(8);
  for (int i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * i / n, radius = dice.between(0.4, 1);
    spec.points.push_back(radius * std::cos(angle));
    spec.points.push_back(radius * std::sin(angle));
  }
  if (dice.one_in(2)) {
    for (int i = 0; i < n; ++i) spec.weights.push_back(dice.between(0.3, 3));
  }
  return *NurbsCurve::create(spec);
}

// Turns of a fine polygon on the curve about the point; nothing when the point is beside it.
std::optional<bool> winds_around(const NurbsCurve& curve, double u, double v) {
  const int steps = 2000;
  double turns = 0, before[2], next[2];
  curve.evaluate(0, before);
  for (int i = 1; i <= steps; ++i) {
    curve.evaluate(static_cast<double>(i) / steps, next);
    const double ax = before[0] - u, ay = before[1] - v, bx = next[0] - u, by = next[1] - v;
    if (bx * bx + by * by < 1e-4) return std::nullopt;
    turns += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    std::copy_n(next, 2, before);
  }
  return turns > 3;
}

TEST(TrimRegion, InsideIsWhatTheBorderWindsAround) {
  Dice dice(support::test_seed());
  int looked = 0;
  for (int round = 0; round < support::test_count(60); ++round) {
    const NurbsCurve border = blob(dice);
    const auto region = TrimRegion::create(std::vector<TrimLoop>{{border}});
    if (!region) {
      EXPECT_EQ(region.error().code, ErrorCode::malformed);  // weights can make it cross itself
      continue;
    }
    for (int i = 0; i < 8; ++i) {
      const double u = dice.between(-1, 1), v = dice.between(-1, 1);
      const auto expected = winds_around(border, u, v);
      if (!expected) continue;
      ++looked;
      EXPECT_EQ(region->contains(u, v), *expected) << u << " " << v;
      const auto is_in = [](const std::vector<Interval>& kept, double x) {
        return std::any_of(kept.begin(), kept.end(),
                           [x](const Interval& part) { return x >= part.low && x <= part.high; });
      };
      EXPECT_EQ(is_in(region->intervals_at_v(v), u), *expected);
      EXPECT_EQ(is_in(region->intervals_at_u(u), v), *expected);
    }
  }
  EXPECT_GT(looked, 200);
}

TEST(TrimRegion, EveryPointOfTheBorderIsKept) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(40); ++round) {
    const NurbsCurve border = blob(dice);
    const auto region = TrimRegion::create(std::vector<TrimLoop>{{border}});
    if (!region) continue;
    const auto& loop = region->loops().at(0).at(0);
    for (int i = 0; i < 20; ++i) {
      double place[2];
      loop.evaluate(random_parameter(dice, loop), place);
      EXPECT_TRUE(region->contains(place[0], place[1])) << place[0] << " " << place[1];
    }
  }
}

}  // namespace
}  // namespace knotwave::test

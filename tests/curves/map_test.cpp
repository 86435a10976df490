// SPDX-License-Identifier: MIT
// Rows of docs/from-opengl.md: each names the test here that holds it.
#include "knotwave/curves/map.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"

#include "map_examples.h"
#include "random_curve.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::Map1;
using curves::Map2;
using curves::MapGrid;
using curves::MapKey;
using curves::MapSet;
using curves::MapValues;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::SurfaceSpec;
using curves::Target;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using base::index_of;

template <class Outcome>
ErrorCode code_of(const Outcome& outcome) {
  EXPECT_FALSE(outcome);
  return outcome ? ErrorCode::unsupported : outcome.error().code;
}

TEST(MapSet, ANumberThatIsNoTargetIsRefused) {
  for (const int number : {-1, curves::kTargetCount, 99}) {
    const auto target = static_cast<Target>(number);
    MapSet maps;
    const auto defined = maps.define(Map1{target, 0, 1, bezier({0, 1})});
    ASSERT_FALSE(defined);
    EXPECT_EQ(defined.error().code, ErrorCode::value_out_of_range);
    EXPECT_EQ(defined.error().message,
              "map: target " + std::to_string(number) + " is outside 0..18");
    const auto surface = maps.define(Map2{target, 0, 1, 0, 1, bilinear({0, 1, 2, 3})});
    EXPECT_EQ(surface.error().code, ErrorCode::value_out_of_range);
    const double points[] = {0, 1, 2, 3};
    EXPECT_EQ(curves::bezier_map({target, 1, 1, false}, 0, 1, 1, 2, points).error().code,
              ErrorCode::value_out_of_range);
    EXPECT_EQ(
        curves::bezier_map({target, 2, 1, false}, 0, 1, 1, 2, 0, 1, 2, 2, points).error().code,
        ErrorCode::value_out_of_range);
    EXPECT_STREQ(to_string(target), "unknown");
    EXPECT_EQ(widest(target), 0);
    maps.set_current(target, points);
    EXPECT_TRUE(maps.current(target).empty());
    EXPECT_FALSE(maps.enable({target, 1, 1, false}));
    MapValues values;
    maps.evaluate(0.5, values);
    EXPECT_TRUE(values.of(target).empty());
    EXPECT_FALSE(values.is_evaluated(target));
    double out[] = {7, 7};
    const MapSet::Channel channels[] = {{target, 0, out}};
    maps.evaluate_grid({}, 0, channels);
    EXPECT_THAT(out, ElementsAre(0, 0));
    out[0] = 7;
    maps.evaluate_mesh({}, 0, 2, {}, 0, channels);
    EXPECT_THAT(out, ElementsAre(0, 0));
  }
}

TEST(Map, BezierMapReadsPointsThatLieBetweenOtherNumbers) {
  std::vector<double> records = {1, 2, 70, 80, 3, 5, 70, 80, 5, 4};  // x, y and two others
  auto map = curves::bezier_map({Target::position, 1, 2, false}, 2, 6, 4, 3, records);
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_THAT(map->curve.points(), ElementsAre(1, 2, 3, 5, 5, 4));
  records.assign(records.size(), 0);  // it keeps a copy

  MapSet maps;
  enable(maps, std::move(*map));
  MapValues out;
  maps.evaluate(2, out);
  EXPECT_THAT(out.of(Target::position), ElementsAre(1, 2));
  maps.evaluate(4, out);
  EXPECT_THAT(out.of(Target::position), ElementsAre(3, 4));  // (1, 2, 1) / 4
  maps.evaluate(6, out);
  EXPECT_THAT(out.of(Target::position), ElementsAre(5, 4));
}

TEST(Map, ARationalPointIsGivenTimesItsWeight) {
  const std::vector<double> quarter = {1, 0, 1, 1, 1, 1, 0, 2, 2};  // (w x, w y, w)
  auto map = curves::bezier_map({Target::position, 1, 2, true}, 0, 1, 3, 3, quarter);
  ASSERT_TRUE(map) << map.error().message;
  MapSet maps;
  const MapKey key = enable(maps, std::move(*map));
  EXPECT_TRUE(key.rational);
  MapValues out;
  maps.evaluate(0.5, out);
  EXPECT_NEAR(out.of(Target::position)[0], 0.6, 1e-15);
  EXPECT_NEAR(out.of(Target::position)[1], 0.8, 1e-15);
}

TEST(Map, ErrorsAreThoseOfGlMap1) {
  const std::vector<double> points(40, 0.5);
  const auto map = [&](int stride, int order, int width = 1) {
    return curves::bezier_map({Target::free_1, 1, width, false}, 0, 1, stride, order, points);
  };
  EXPECT_EQ(code_of(map(0, 4)), ErrorCode::dimension_mismatch);     // stride below a point
  EXPECT_EQ(code_of(map(2, 4, 3)), ErrorCode::dimension_mismatch);  // 3 coordinates
  EXPECT_EQ(code_of(map(20, 4)), ErrorCode::dimension_mismatch);    // ends too soon
  EXPECT_EQ(code_of(map(1, 1)), ErrorCode::degree_out_of_range);
  EXPECT_EQ(code_of(map(1, 17)), ErrorCode::degree_out_of_range);
  EXPECT_TRUE(map(1, 16)) << "OpenGL asks for 8 at least";
  EXPECT_EQ(code_of(map(1, 4, 5)), ErrorCode::dimension_mismatch);
  EXPECT_THAT(map(20, 4).error().message, HasSubstr("end after 40 numbers, 61 are needed"));
  const std::vector<double> weightless = {1, 1, 1, 0};
  EXPECT_EQ(code_of(curves::bezier_map({Target::amp, 1, 1, true}, 0, 1, 2, 2, weightless)),
            ErrorCode::weight_not_positive);

  MapSet maps;
  const auto over = [&](double u1, double u2) {
    return maps.define(Map1{Target::amp, u1, u2, bezier({0, 1})});
  };
  EXPECT_EQ(code_of(over(0.5, 0.5)), ErrorCode::empty_domain);
  EXPECT_EQ(code_of(over(0, kNan)), ErrorCode::not_finite);
  EXPECT_EQ(code_of(over(0, kInfinity)), ErrorCode::not_finite);
  EXPECT_EQ(code_of(over(0, 2e9)), ErrorCode::value_out_of_range);
  EXPECT_EQ(over(0.5, 0.5).error().message, "map of amp: u1 and u2 are both 0.5");
}

TEST(Map, ARangeShorterThanKnotsMayBeIsRefused) {
  MapSet maps;
  for (const double tiny : {5e-324, 1e-310, 1e-281}) {
    const auto curve = maps.define(Map1{Target::amp, 0, tiny, bezier({0, 1})});
    EXPECT_EQ(code_of(curve), ErrorCode::value_out_of_range);
    EXPECT_EQ(code_of(maps.define(Map1{Target::amp, tiny, 0, bezier({0, 1})})),
              ErrorCode::value_out_of_range);
    const auto surface = bilinear({0, 1, 2, 3});
    EXPECT_EQ(code_of(maps.define(Map2{Target::amp, 0, tiny, 0, 1, surface})),
              ErrorCode::value_out_of_range);
    EXPECT_EQ(code_of(maps.define(Map2{Target::amp, 0, 1, 0, tiny, surface})),
              ErrorCode::value_out_of_range);
  }
  EXPECT_EQ(maps.define(Map1{Target::amp, 0, 1e-310, bezier({0, 1})}).error().message,
            "map of amp: u1 (0) and u2 (1e-310) differ by less than 1e-280");
}

TEST(Map, TheShortestRangeHasItsValuesAndSlopesThatAreNumbers) {
  constexpr double kShortest = curves::kMinKnotStep;
  constexpr double kLargest = std::numeric_limits<double>::max();
  MapSet maps;
  enable(maps, Map1{Target::amp, 0, kShortest, bezier({0, 1})});
  enable(maps, Map1{Target::pan, kShortest, 0, bezier({0, 0, 1, 0, 0}, 1, {1, 1, 4, 1, 1})});
  CurveSpec steep;  // its slope is 1e286 by its own parameter, and 1e566 by the common one
  steep.degree = 1;
  steep.points = {-1e6, 0, 1e6, 0};
  steep.knots = {0, 0, kShortest, 2 * kShortest, 1, 1};
  enable(maps, Map1{Target::pitch, 0, kShortest, *NurbsCurve::create(steep)});
  MapValues out;
  maps.evaluate(0.5 * kShortest, out);
  EXPECT_EQ(out.of(Target::amp)[0], 0.5);
  EXPECT_NEAR(out.of(Target::pan)[0], 12 / 17.0, 1e-15);
  maps.evaluate_slopes(0, out);
  EXPECT_NEAR(out.of(Target::amp)[0] * kShortest, 1, 1e-15);
  EXPECT_EQ(out.of(Target::pitch)[0], kLargest);
  maps.evaluate_slopes(0.5 * kShortest, out);
  EXPECT_NEAR(out.of(Target::pan)[0] * kShortest, 0, 1e-12);
  EXPECT_NEAR(out.of(Target::pitch)[0] * kShortest, -1e6, 1e-6);

  enable(maps, Map2{Target::cutoff, 0, kShortest, kShortest, 0, bilinear({0, 1, 2, 3})});
  MapValues by_u, by_v;
  maps.evaluate_slopes(0, kShortest, by_u, by_v);
  EXPECT_NEAR(by_u.of(Target::cutoff)[0] * kShortest, 1, 1e-15);
  EXPECT_NEAR(by_v.of(Target::cutoff)[0] * kShortest, -2, 1e-15);
}

TEST(Map, BezierSurfaceMapHasTheStridesOfGlMap2) {
  // Column by column: u steps by 2, v by 1.
  const std::vector<double> points = {0, 10, 1, 11, 2, 12};
  auto map =
      curves::bezier_map({Target::wave_position, 2, 1, false}, 0, 2, 2, 3, 0, 1, 1, 2, points);
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->surface.degree_u(), 2);
  EXPECT_EQ(map->surface.degree_v(), 1);
  MapSet maps;
  enable(maps, std::move(*map));
  MapValues out;
  maps.evaluate(1, 0.5, out);
  EXPECT_EQ(out.of(Target::wave_position)[0], 6);  // u + 10 v
  EXPECT_EQ(code_of(curves::bezier_map({Target::amp, 2, 1, false}, 0, 2, 2, 3, 0, 1, 1, 3, points)),
            ErrorCode::dimension_mismatch);
  EXPECT_EQ(code_of(curves::bezier_map({Target::amp, 2, 1, false}, 0, 2, 2, 3, 0, 1, 1, 1, points)),
            ErrorCode::degree_out_of_range);
  EXPECT_EQ(code_of(maps.define(Map2{Target::amp, 0, 1, 3, 3, bilinear({0, 0, 0, 0})})),
            ErrorCode::empty_domain);
}

TEST(Map, EveryTargetTakesItsWidths) {
  for (int t = 0; t < curves::kTargetCount; ++t) {
    const auto target = static_cast<Target>(t);
    for (int width = 1; width <= 4; ++width) {
      MapSet maps;
      std::vector<double> points;
      for (int i = 0; i < 2 * width; ++i) points.push_back(i);
      const auto key = maps.define(Map1{target, 0, 1, bezier(points, width)});
      EXPECT_EQ(bool(key), width <= widest(target)) << to_string(target) << " " << width;
      if (key) continue;
      EXPECT_EQ(key.error().code, ErrorCode::dimension_mismatch);
    }
  }
  EXPECT_STREQ(to_string(Target::amp), "amp");
  EXPECT_STREQ(to_string(Target::position), "position");
  EXPECT_STREQ(to_string(Target::free_4), "free_4");
}

TEST(Map, ARationalMapOverridesAPlainOneOfTheSameWidth) {
  MapSet maps;
  const MapKey plain = enable(maps, Map1{Target::amp, 0, 1, bezier({1, 1})});
  const MapKey rational = define(maps, Map1{Target::amp, 0, 1, bezier({2, 2}, 1, {1, 3})});
  EXPECT_FALSE(plain == rational);
  EXPECT_EQ(number(maps, Target::amp, 0.5), 1);
  maps.enable(rational);
  EXPECT_EQ(number(maps, Target::amp, 0.5), 2);
  maps.disable(rational);
  EXPECT_EQ(number(maps, Target::amp, 0.5), 1);
}

TEST(Map, EqualWeightsMakeAPlainMap) {
  MapSet maps;
  EXPECT_FALSE(define(maps, Map1{Target::amp, 0, 1, bezier({2, 4}, 1, {3, 3})}).rational);
  EXPECT_FALSE(
      define(maps, Map2{Target::amp, 0, 1, 0, 1, bilinear({1, 2, 3, 4}, {3, 3, 3, 3})}).rational);
  maps.enable({Target::amp, 2, 1, false});
  MapValues out;
  maps.evaluate(0.5, 0.5, out);
  EXPECT_EQ(out.of(Target::amp)[0], 2.5);
}

TEST(Map, OnlyTheWidestOfAFamilyIsEvaluated) {
  MapSet maps;
  const MapKey one = enable(maps, Map1{Target::modulation, 0, 1, bezier({1, 1}, 1, {1, 2})});
  const MapKey three = enable(maps, Map1{Target::modulation, 0, 1, bezier({3, 3, 3, 3, 3, 3}, 3)});
  MapValues out;
  maps.evaluate(0.5, out);
  EXPECT_THAT(out.of(Target::modulation), ElementsAre(3, 3, 3));
  maps.disable(three);
  maps.evaluate(0.5, out);
  EXPECT_THAT(out.of(Target::modulation), ElementsAre(1));
  maps.disable(one);
  maps.evaluate(0.5, out);
  EXPECT_THAT(out.of(Target::modulation), ElementsAre(0, 0, 0, 0));
}

TEST(Map, ADisabledMapIsNotEvaluated) {
  MapSet maps;
  const MapKey key = define(maps, Map1{Target::pan, 0, 1, bezier({-1, 1})});
  maps.set_current(Target::pan, std::array{0.25});
  EXPECT_FALSE(maps.is_enabled(key));
  EXPECT_EQ(number(maps, Target::pan, 1), 0.25);
  EXPECT_TRUE(maps.enable(key));
  EXPECT_TRUE(maps.is_enabled(key));
  EXPECT_EQ(number(maps, Target::pan, 1), 1);
  EXPECT_TRUE(maps.disable(key));
  EXPECT_EQ(number(maps, Target::pan, 1), 0.25);
  EXPECT_FALSE(maps.enable({Target::pitch, 1, 1, false})) << "never defined";
  EXPECT_FALSE(maps.enable({Target::pan, 2, 1, false})) << "no surface";
  maps.enable(key);
  define(maps, Map1{Target::pan, 0, 1, bezier({5, 5})});
  EXPECT_FALSE(maps.is_enabled(key)) << "defined anew";
}

TEST(Map, EvaluationFillsAllEnabledTargetsAndChangesNoCurrentValue) {
  MapSet maps;
  enable(maps, Map1{Target::amp, 0, 1, bezier({0, 1})});
  enable(maps, Map1{Target::pitch, 0, 2, bezier({60, 72})});
  enable(maps, Map1{Target::position, -1, 1, bezier({0, 0, 2, 4}, 2)});
  maps.set_current(Target::amp, std::array{0.125});
  maps.set_current(Target::cutoff, std::array{440.0});
  MapValues out;
  maps.evaluate(0.5, out);
  EXPECT_EQ(out.of(Target::amp)[0], 0.5);
  EXPECT_EQ(out.of(Target::pitch)[0], 63);
  EXPECT_THAT(out.of(Target::position), ElementsAre(1.5, 3));
  EXPECT_EQ(out.of(Target::cutoff)[0], 440);
  EXPECT_TRUE(out.is_evaluated(Target::amp) && out.is_evaluated(Target::position));
  EXPECT_FALSE(out.is_evaluated(Target::cutoff) || out.is_evaluated(Target::pan));
  EXPECT_THAT(maps.current(Target::amp), ElementsAre(0.125));
  maps.evaluate(0.5, 0.5, out);  // no surface is enabled
  EXPECT_EQ(out.of(Target::amp)[0], 0.125);
  EXPECT_FALSE(out.is_evaluated(Target::amp));
}

TEST(Map, NoTargetIsNeededForTheOthers) {
  MapSet maps;  // OpenGL would ignore an evaluation without a vertex map
  enable(maps, Map1{Target::free_2, 0, 1, bezier({0, 1})});
  EXPECT_EQ(number(maps, Target::free_2, 0.75), 0.75);
}

TEST(Map, WithoutAMapTheCurrentValueIsTaken) {
  MapSet maps;
  maps.set_current(Target::position, std::array{1.0, 2.0});
  maps.set_current(Target::position, std::array{3.0, kNan, 5.0, 7.0});
  EXPECT_THAT(maps.current(Target::position), ElementsAre(3, 2, 5));
  MapValues out;
  maps.evaluate(0.5, out);
  EXPECT_THAT(out.of(Target::position), ElementsAre(3, 2, 5));
  EXPECT_THAT(out.of(Target::amp), ElementsAre(0));
  std::array<double, 3> grid{9, 9, 9}, none{9, 9, 9};
  const MapSet::Channel channels[] = {{Target::position, 2, grid}, {Target::position, 3, none}};
  maps.evaluate_grid({0, 1, 2}, 0, channels);
  EXPECT_THAT(grid, ElementsAre(5, 5, 5));
  EXPECT_THAT(none, ElementsAre(0, 0, 0));
}

TEST(Map, TheCurveMayRunBackwards) {
  MapSet maps;
  enable(maps, Map1{Target::amp, 3, -1, bezier({10, 20})});
  EXPECT_EQ(number(maps, Target::amp, 3), 10);
  EXPECT_EQ(number(maps, Target::amp, 0), 17.5);
  EXPECT_EQ(number(maps, Target::amp, -1), 20);
  EXPECT_EQ(number(maps, Target::amp, -2), 20);
  EXPECT_EQ(number(maps, Target::amp, 9), 10);
}

TEST(Map, NoCoordinateIsWithoutAValue) {
  MapSet maps;
  enable(maps, Map1{Target::amp, 0, 1, bezier({0.25, 1})});
  enable(maps, Map2{Target::pan, 0, 1, 0, 1, bilinear({1, 2, 3, 4})});
  EXPECT_EQ(number(maps, Target::amp, kNan), 0.25);
  EXPECT_EQ(number(maps, Target::amp, -kInfinity), 0.25);
  EXPECT_EQ(number(maps, Target::amp, kInfinity), 1);
  MapValues out;
  maps.evaluate(kNan, kInfinity, out);
  EXPECT_EQ(out.of(Target::pan)[0], 3);
  std::array<double, 2> grid{};
  const MapSet::Channel channel{Target::amp, 0, grid};
  maps.evaluate_grid({0, 1, 0}, 0, {&channel, 1});
  EXPECT_THAT(grid, ElementsAre(1, 1)) << "node 0 of a grid of 0 steps is its end";
  const MapSet::Channel nowhere{Target::amp, -1, grid};
  maps.evaluate_grid({0, 1, 1}, 0, {&nowhere, 1});
  EXPECT_THAT(grid, ElementsAre(0, 0));
}

TEST(Map, SlopesAreDerivativesByTheCommonCoordinate) {
  MapSet maps;
  enable(maps, Map1{Target::amp, 0, 4, bezier({0, 1, 4})});  // 2 x + 2 x^2, x = u / 4
  enable(maps, Map2{Target::amp, 0, 2, 0, -5, bilinear({0, 1, 10, 11})});
  maps.set_current(Target::pan, std::array{1.0});
  MapValues by_u, by_v;
  maps.evaluate_slopes(2, by_u);
  EXPECT_EQ(by_u.of(Target::amp)[0], 1);
  EXPECT_EQ(by_u.of(Target::pan)[0], 0) << "a current value stands still";
  maps.evaluate_slopes(5, by_u);
  EXPECT_EQ(by_u.of(Target::amp)[0], 0) << "beyond the end it is held";
  maps.evaluate_slopes(1, -1, by_u, by_v);
  EXPECT_DOUBLE_EQ(by_u.of(Target::amp)[0], 0.5);
  EXPECT_DOUBLE_EQ(by_v.of(Target::amp)[0], -2);
  maps.evaluate_slopes(1, 1, by_u, by_v);
  EXPECT_DOUBLE_EQ(by_u.of(Target::amp)[0], 0.5) << "held along v only";
  EXPECT_EQ(by_v.of(Target::amp)[0], 0);
}

TEST(Map, WhatWasDefinedIsGivenBack) {
  MapSet maps;
  const NurbsCurve curve = bezier({1, 2, 3, 4, 5, 6}, 2, {1, 2, 3});
  const MapKey key = define(maps, Map1{Target::position, 2, -3, curve, 1e-5});
  const Map1* map = maps.map1(key);
  ASSERT_NE(map, nullptr);
  EXPECT_TRUE(map->curve == curve);
  EXPECT_EQ(map->u1, 2);
  EXPECT_EQ(map->u2, -3);
  EXPECT_EQ(map->curve.degree() + 1, 3) << "GL_ORDER";
  EXPECT_EQ(maps.map2(key), nullptr);
  EXPECT_EQ(maps.map1({Target::position, 1, 3, true}), nullptr);

  const NurbsSurface surface = bilinear({1, 2, 3, 4});
  const MapKey surface_key = define(maps, Map2{Target::amp, 0, 1, 4, 5, surface});
  ASSERT_NE(maps.map2(surface_key), nullptr);
  EXPECT_TRUE(maps.map2(surface_key)->surface == surface);
  EXPECT_EQ(maps.map2(surface_key)->v2, 5);
}

TEST(Map, ARefusedDefinitionLeavesTheSetAsItWas) {
  MapSet maps;
  const MapKey key = enable(maps, Map1{Target::amp, 0, 1, bezier({1, 2})});
  EXPECT_FALSE(maps.define(Map1{Target::amp, 1, 1, bezier({7, 8})}));
  EXPECT_TRUE(maps.is_enabled(key));
  EXPECT_EQ(number(maps, Target::amp, 1), 2);
}

TEST(Map, ValuesStayInTheHullAndNearTheCurve) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(200); ++round) {
    const NurbsCurve curve = random_curve(dice, 1 + dice.below(7));
    MapSet maps;
    const double u1 = curve.u_min(), u2 = curve.u_max();
    const auto key = maps.define(Map1{Target::free_1, u1, u2, curve});
    if (!key) continue;  // 1e-7 is less than rounding where points are large
    maps.enable(*key);
    for (int k = 0; k < 10; ++k) {
      const double u = random_parameter(dice, curve);
      double exact[curves::kMaxDim];
      curve.evaluate(u, exact);
      MapValues values;
      maps.evaluate(u, values);
      for (int c = 0; c < curve.dim(); ++c) {
        EXPECT_NEAR(values.of(Target::free_1)[index_of(c)], exact[c], 2e-7) << u;
      }
    }
  }
}

TEST(Map, EvaluationAllocatesNothing) {
  MapSet maps;
  const MapKey key = enable(maps, Map1{Target::amp, 0, 1, bezier({0, 1, 0}, 1, {1, 2, 1})});
  enable(maps, Map2{Target::pan, 0, 1, 0, 1, bilinear({1, 2, 3, 4})});
  MapValues out, slopes;
  std::array<double, 1000> block{};
  const MapSet::Channel channels[] = {{Target::amp, 0, block}, {Target::pan, 0, block}};
  EXPECT_EQ(support::allocations_in([&] {
              maps.evaluate(0.5, out);
              maps.evaluate(0.5, 0.5, out);
              maps.evaluate_slopes(0.5, slopes);
              maps.evaluate_slopes(0.5, 0.5, out, slopes);
              maps.evaluate_grid({0, 1, 999}, 0, channels);
              maps.evaluate_mesh({0, 1, 99}, 0, 100, {0, 1, 9}, 0, channels);
              maps.disable(key);
              maps.enable(key);
              maps.set_current(Target::amp, std::array{1.0});
            }),
            0);
}

}  // namespace
}  // namespace knotwave::test

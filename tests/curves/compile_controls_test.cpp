// SPDX-License-Identifier: MIT
// Numbers of a curve that a controller may move, in compile.h.
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"

#include "curves/program_error.h"
#include "curves/random_curves.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {

using Kind = ControlRange::Kind;
using testing::Draws;
using testing::line;
using testing::made;
using testing::random_curve;
using testing::worst_error;

TEST(CompileControls, AControlledWeightIsTheCurveWithThatWeight) {
  const NurbsCurve curve = line({0, 0.9, 0.2, 0.6, -0.3, 0}, 3);
  CompileOptions options;
  options.controls = {{Kind::weight, 2, 0, 0.05, 20}};
  const auto program = compile_function(curve, options);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_TRUE(program->is_rational());
  EXPECT_EQ(program->control_count(), 1);
  EXPECT_EQ(program->control_rest(0), 1.0);
  EXPECT_EQ(program->control_low(0), 0.05);
  EXPECT_EQ(program->control_high(0), 20.0);
  EXPECT_LT(worst_error(*program, curve, 500), 1e-14);
  for (const double w : {0.05, 0.3, 1.0, 7.0, 20.0}) {
    CurveSpec spec = curve.spec();
    spec.weights.assign(6, 1.0);
    spec.weights[2] = w;
    const double controls[] = {w};
    EXPECT_LT(worst_error(*program, made(spec), 500, controls), 1e-13) << w;
  }
}

TEST(CompileControls, ControlsOnRandomCurvesAreTheCurvesWithThoseNumbers) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(100); ++i) {
    Draws draw(seed + 1, i);
    testing::RandomCurveOptions random;
    random.dim = draw.whole(1, 2);
    const NurbsCurve curve = random_curve(draw, random);
    CurveSpec spec = curve.spec();
    if (spec.weights.empty()) spec.weights.assign(spec.points.size() / std::size_t(spec.dim), 1.0);
    CompileOptions options;
    std::vector<double> values;
    const int points = static_cast<int>(spec.weights.size());
    for (int point = 0; point < points && options.controls.size() < 4; ++point) {
      if (draw.chance(0.5)) continue;
      if (draw.chance(0.5)) {
        options.controls.push_back({Kind::weight, point, 0, 0.1, 10});
        values.push_back(draw.between(0.1, 10));
        spec.weights[std::size_t(point)] = values.back();
      } else {
        const int c = draw.whole(0, spec.dim - 1);
        options.controls.push_back({Kind::coordinate, point, c, -2, 2});
        values.push_back(draw.between(-2, 2));
        spec.points[std::size_t(point) * std::size_t(spec.dim) + std::size_t(c)] = values.back();
      }
    }
    const auto program = compile_parametric(curve, options);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_LT(program->max_error(), 1e-11);
    EXPECT_LT(worst_error(*program, made(spec), 100, values), 1e-11) << "curve " << i;
    EXPECT_LT(worst_error(*program, curve, 100), 1e-12) << "curve " << i;
  }
}

TEST(CompileControls, TheHullCoversTheRangesOfControls) {
  CompileOptions options;
  options.controls = {{Kind::coordinate, 1, 0, -0.5, 3}};
  const auto program = compile_function(line({0, 1, 0.5}, 2), options);
  ASSERT_TRUE(program);
  EXPECT_EQ(program->low(), -0.5);
  EXPECT_EQ(program->high(), 3.0);
  const double beyond[] = {100};
  const double most[] = {3};
  EXPECT_EQ(program->at_u(0.5, 0, beyond), program->at_u(0.5, 0, most));
}

TEST(CompileControls, AControlledEndPointIsMetExactly) {
  CompileOptions options;
  options.controls = {{Kind::coordinate, 0, 0, 0, 1}, {Kind::weight, 2, 0, 0.5, 2}};
  const auto program = compile_function(line({0, 1, 0.5}, 2), options);
  ASSERT_TRUE(program);
  const double controls[] = {0.625, 1.7};
  EXPECT_EQ(program->at_u(0, 0, controls), 0.625);
  EXPECT_EQ(program->at_u(1, 0, controls), 0.5);
}

void expect_refused(const NurbsCurve& curve, std::vector<ControlRange> controls, ErrorCode code,
                    const std::string& words) {
  CompileOptions options;
  options.controls = std::move(controls);
  const auto program = compile_function(curve, options);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, code) << program.error().message;
  EXPECT_NE(program.error().message.find(words), std::string::npos) << program.error().message;
}

TEST(CompileControls, ControlsThatCannotBeAreRefusedWithTheirNumbers) {
  const NurbsCurve curve = line({0, 1, 0.5}, 2);
  const auto conflict = ErrorCode::control_conflict;
  const auto range = ErrorCode::value_out_of_range;
  expect_refused(curve, {{Kind::weight, 1, 0, 0.5, 2}, {Kind::weight, 1, 0, 0.1, 9}}, conflict,
                 "control 1 (weight of point 1) and control 0");
  expect_refused(curve, {{Kind::weight, 1, 0, 0.5, 2}, {Kind::coordinate, 1, 0, 0, 1}}, conflict,
                 "coordinate 0 of point 1");
  expect_refused(curve, {{Kind::weight, 3, 0, 0.5, 2}}, range, "points 0..2");
  expect_refused(curve, {{Kind::coordinate, 1, 1, 0, 1}}, range, "coordinates 0..0");
  expect_refused(curve, {{Kind::weight, 1, 0, 0, 2}}, range, "range 0..2");
  expect_refused(curve, {{Kind::coordinate, 1, 0, 0, 2e6}}, range, "1e+06");
  expect_refused(curve, {{Kind::coordinate, 1, 0, 0, 0.5}}, range, "has 1 there");
  expect_refused(curve, {{Kind::coordinate, 1, 0, 2, NAN}}, range, "range");
  expect_refused(curve, std::vector<ControlRange>(9, {Kind::weight, 1, 0, 0.5, 2}), range,
                 "9 controls");
}

}  // namespace
}  // namespace knotwave::curves

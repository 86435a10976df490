// SPDX-License-Identifier: MIT
// Knots that a controller moves, in compile.h.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

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

/// Simple inner knots with room on both sides, as the file counts them.
std::vector<int> movable_knots(const CurveSpec& spec) {
  const int outer = spec.periodic ? 0 : spec.degree;
  std::vector<int> found;
  for (int k = outer + 1; k + outer + 1 < static_cast<int>(spec.knots.size()); ++k) {
    const double* knot = &spec.knots[static_cast<std::size_t>(k)];
    if (knot[0] - knot[-1] > 0.01 && knot[1] - knot[0] > 0.01) found.push_back(k);
  }
  return found;
}

/// Up to three knots, every other one, from near one neighbour to near the other; and a point.
std::vector<ControlRange> controls_of(const CurveSpec& spec) {
  std::vector<ControlRange> controls;
  for (const int k : movable_knots(spec)) {
    if (controls.size() == 3 || (!controls.empty() && k - controls.back().point < 2)) continue;
    const double* knot = &spec.knots[static_cast<std::size_t>(k)];
    controls.push_back(
        {Kind::knot, k, 0, 0.9 * knot[-1] + 0.1 * knot[0], 0.2 * knot[0] + 0.8 * knot[1]});
  }
  if (!controls.empty()) controls.push_back({Kind::coordinate, 1, 0, -2, 2});
  return controls;
}

TEST(MovedKnots, AreTheCurveWithThoseKnots) {
  const std::uint64_t seed = support::test_seed();
  int moved = 0;
  for (int i = 0; i < support::test_count(200); ++i) {
    Draws draw(seed + 21, i);
    testing::RandomCurveOptions random;
    random.dim = draw.whole(1, 2);
    const NurbsCurve curve = random_curve(draw, random);
    CompileOptions options;
    options.controls = controls_of(curve.spec());
    if (options.controls.empty()) continue;
    const auto program = compile_parametric(curve, options);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_TRUE(program->moves_knots());
    EXPECT_LT(program->max_error(), 1e-11);
    EXPECT_LT(worst_error(*program, curve, 100), 1e-12) << "at rest, curve " << i;
    for (int place = 0; place < 4; ++place) {
      std::vector<double> values;
      for (const ControlRange& control : options.controls) {
        values.push_back(draw.between(control.low, control.high));
      }
      const auto wanted = curve_with(curve, options.controls, values);
      ASSERT_TRUE(wanted) << wanted.error().message;
      EXPECT_LT(worst_error(*program, *wanted, 150, values), 1e-11) << "curve " << i;
      for (double x = 0.013; x < 1; x += 0.11) {
        const double u = curve.u_min() + x * (curve.u_max() - curve.u_min());
        double exact[2 * kMaxDim];
        wanted->derivatives(u, 1, Side::right, exact);
        const double slope = exact[curve.dim()];
        EXPECT_NEAR(program->slope_at_u(u, 0, values), slope, 1e-9 * (1 + std::abs(slope)));
      }
    }
    ++moved;
  }
  EXPECT_GT(moved, support::test_count(200) / 2);
}

TEST(MovedKnots, AKnotMayRunAcrossTheParameterThatIsRead) {
  const NurbsCurve curve = line({0, 1, 0, 1, 0.2}, 2);  // knots 0 0 0 1/3 2/3 1 1 1
  CompileOptions options;
  options.controls = {{Kind::knot, 3, 0, 0.1, 0.5}, {Kind::knot, 4, 0, 0.55, 0.9}};
  const auto program = compile_function(curve, options);
  ASSERT_TRUE(program) << program.error().message;
  for (double first = 0.1; first <= 0.5; first += 0.025) {
    for (double second = 0.55; second <= 0.9; second += 0.05) {
      const double values[] = {first, second};
      const auto wanted = curve_with(curve, options.controls, {first, second});
      ASSERT_TRUE(wanted);
      EXPECT_LT(worst_error(*program, *wanted, 60, values), 1e-14);
      for (const double u : {first, second}) {
        double exact = 0;
        wanted->evaluate(u, {&exact, 1});
        EXPECT_NEAR(program->at_u(u, 0, values), exact, 1e-14);
      }
    }
  }
}

TEST(MovedKnots, BlocksAreTheSingleSamplesToTheBit) {
  CurveSpec spec;
  spec.degree = 3;
  spec.periodic = true;
  spec.points = {0, 1, 0.3, -1, 0.4, -0.2};
  spec.weights = {1, 2, 1, 0.5, 1, 3};
  const NurbsCurve curve = made(spec);
  CompileOptions options;
  options.controls = {{Kind::knot, 1, 0, 0.02, 0.3}, {Kind::weight, 3, 0, 0.1, 4}};
  const auto program = compile_function(curve, options);
  ASSERT_TRUE(program) << program.error().message;
  constexpr std::size_t kCount = 500;
  std::vector<double> u(kCount), knot(kCount), weight(kCount), out(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double x = static_cast<double>(i);
    u[i] = -1 + 0.0077 * x;
    knot[i] = 0.16 + 0.2 * std::sin(0.1 * x);  // beyond its range too
    weight[i] = 1 + 0.8 * std::cos(0.03 * x);
  }
  u[17] = NAN;
  knot[40] = NAN;
  for (const std::size_t block : {1u, 3u, 64u, 500u}) {
    CurveCursor cursor;
    for (std::size_t done = 0; done < kCount; done += block) {
      const std::size_t n = std::min(block, kCount - done);
      const double* const controls[] = {&knot[done], &weight[done]};
      program->render(std::span(u).subspan(done, n), controls, std::span(out).subspan(done, n),
                      cursor);
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      const double controls[] = {knot[i], weight[i]};
      ASSERT_EQ(out[i], program->at_u(u[i], 0, controls)) << i;
      ASSERT_GE(out[i], -1);
      ASSERT_LE(out[i], 1);
    }
  }
}

TEST(MovedKnots, TheEndsOfAClampedCurveStayItsEndPoints) {
  CompileOptions options;
  options.controls = {{Kind::knot, 4, 0, 0.05, 0.95}};
  const auto program = compile_function(line({0.3, 1, 0, 1, 0.7}, 3), options);
  ASSERT_TRUE(program) << program.error().message;
  for (const double knot : {0.05, 0.4, 0.95}) {
    EXPECT_EQ(program->at_u(-1, 0, {&knot, 1}), 0.3);
    EXPECT_EQ(program->at_u(0, 0, {&knot, 1}), 0.3);
    EXPECT_EQ(program->at_u(1, 0, {&knot, 1}), 0.7);
    EXPECT_EQ(program->at_u(2, 0, {&knot, 1}), 0.7);
  }
}

void expect_refused(const NurbsCurve& curve, std::vector<ControlRange> controls, ErrorCode code,
                    const std::string& words) {
  CompileOptions options;
  options.controls = std::move(controls);
  const auto program = compile_function(curve, options);
  ASSERT_FALSE(program) << words;
  EXPECT_EQ(program.error().code, code) << program.error().message;
  EXPECT_NE(program.error().message.find(words), std::string::npos) << program.error().message;
}

TEST(MovedKnots, AGapBelowABillionthOfTheDomainIsToldToTheLastDigit) {
  const auto range = ErrorCode::value_out_of_range;
  const NurbsCurve curve = line({0, 1, 0, 1, 0}, 2);  // knots 3 and 4 at 1/3 and 2/3
  expect_refused(curve, {{Kind::knot, 3, 0, 0x1p-31, 0.5}}, range,
                 "its range 4.656612873077393e-10..0.5 comes within 4.656612873077393e-10 of its "
                 "neighbour at 0; the least is 1e-09, 1e-09 of the domain");
  expect_refused(
      curve, {{Kind::knot, 4, 0, 0.5, 1 - 0x1p-31}}, range,
      "0.5..0.9999999995343387 comes within 4.656612873077393e-10 of its neighbour at 1;");
  CurveSpec near = curve.spec();
  near.knots[3] = 0.5;
  near.knots[4] = 0.5 + 0x1p-31;
  expect_refused(made(near), {{Kind::knot, 3, 0, 0.4, 0.5}}, range,
                 "the curve has it at 0.5, and knot 4 is at 0.5000000004656613, "
                 "4.656612873077393e-10 away; the least is 1e-09");
  expect_refused(made(near), {{Kind::knot, 4, 0, 0.5, 0.6}}, range,
                 "the curve has it at 0.5000000004656613, and knot 3 is at 0.5, "
                 "4.656612873077393e-10 away");
}

TEST(MovedKnots, RangesThatReachANeighbourAreRefusedWithTheNumbers) {
  const NurbsCurve curve = line({0, 1, 0, 1, 0}, 2);
  const auto range = ErrorCode::value_out_of_range;
  expect_refused(curve, {{Kind::knot, 3, 0, 0.1, 0.7}}, range,
                 "control 0 (knot 3): its range 0.1..0.7 does not stay between its neighbours");
  expect_refused(curve, {{Kind::knot, 3, 0, 0, 0.5}}, range, "as near as 0 and 0.6666");
  expect_refused(curve, {{Kind::knot, 3, 0, 0.1, 0.5}, {Kind::knot, 4, 0, 0.45, 0.9}}, range,
                 "knot 3): its range 0.1..0.5");
  expect_refused(curve, {{Kind::knot, 3, 0, 0.1, 0.2}}, range, "has 0.3333333333333333 there");
  expect_refused(curve, {{Kind::knot, 2, 0, 0, 0.1}}, range, "inner knots of the curve are 3..4");
  expect_refused(line({0, 1, 0}, 2), {{Kind::knot, 3, 0, 0, 0.1}}, range, "no inner knots");
  expect_refused(curve, {{Kind::knot, 3, 0, 0.2, 0.5}, {Kind::knot, 3, 0, 0.2, 0.4}},
                 ErrorCode::control_conflict, "control 1 (knot 3) and control 0");
  CurveSpec twice = curve.spec();
  twice.knots[3] = twice.knots[4] = 0.5;
  expect_refused(
      made(twice), {{Kind::knot, 3, 0, 0.4, 0.6}}, range,
      "(knot 3): the curve has it at 0.5, and knot 4 is at 0.5 too: a repeated knot cannot move");
  CompileOptions options;
  options.controls = {{Kind::knot, 3, 0, 0.1, 0.5}};
  const auto polynomial = compile_polynomial(curve, options);
  ASSERT_FALSE(polynomial);
  EXPECT_EQ(polynomial.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace knotwave::curves

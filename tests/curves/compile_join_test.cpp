// SPDX-License-Identifier: MIT
// Joins of compile.h: a curve that begins with the value and slope of what was playing.
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"

#include "curves/random_curves.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {

using Kind = ControlRange::Kind;
using testing::Draws;
using testing::line;
using testing::made;
using testing::random_curve;
using testing::rational;

/// Value of the joined curve.
double joined(const CurveProgram& program, const JoinProgram& join,
              const JoinProgram::Deltas& deltas, double u) {
  return program.at_u(u) + deltas.dp0 * join.basis.at_u(u, 0) + deltas.dp1 * join.basis.at_u(u, 1);
}

/// The joined curve is `moved`, a function on 0..1.
void expect_is(const CurveProgram& program, const JoinProgram& join,
               const JoinProgram::Deltas& deltas, const NurbsCurve& moved, double tolerance) {
  for (int i = 0; i <= 100; ++i) {
    double y;
    moved.evaluate(i / 100.0, {&y, 1});
    EXPECT_NEAR(joined(program, join, deltas, i / 100.0), y, tolerance) << i;
  }
}

TEST(CompileJoin, BeginsWithTheValueAndSlopeAskedAndLeavesTheTailAlone) {
  const std::uint64_t seed = support::test_seed();
  int limited = 0, free = 0;
  for (int i = 0; i < support::test_count(200); ++i) {
    Draws draw(seed + 2, i);
    testing::RandomCurveOptions random;
    random.periodic = false;
    const NurbsCurve curve = random_curve(draw, random);
    const double length = curve.u_max() - curve.u_min();
    const double u = curve.u_min() + (i % 4 == 0 ? 0.0 : draw.between(0, 0.8)) * length;
    const auto program = compile_function(curve);
    const auto join = compile_join(curve, u);
    ASSERT_TRUE(program);
    ASSERT_TRUE(join) << join.error().message;
    const double value0 = draw.between(program->low(), program->high());
    const double slope0 = draw.between(-3, 3);
    const auto deltas = join->join(value0, slope0);
    EXPECT_NEAR(joined(*program, *join, deltas, u), value0, 1e-12);
    const double slope = program->slope_at_u(u) + deltas.dp0 * join->basis.slope_at_u(u, 0) +
                         deltas.dp1 * join->basis.slope_at_u(u, 1);
    if (!deltas.limited) {
      ++free;
      EXPECT_NEAR(slope, slope0, 1e-11 * (1 + join->slope_factor));
    } else {
      ++limited;
      const double p1 = join->p1 + deltas.dp1;
      EXPECT_TRUE(curve.degree() <= 2 || std::abs(p1 - join->low) < 1e-15 ||
                  std::abs(p1 - join->high) < 1e-15);
    }
    for (double tail = join->u_basis_end; tail <= curve.u_max(); tail += length / 50) {
      EXPECT_EQ(joined(*program, *join, deltas, tail), program->at_u(tail));
    }
    const auto c0 = join->join_c0(value0);
    EXPECT_EQ(c0.dp1, 0.0);
    EXPECT_NEAR(joined(*program, *join, c0, u), value0, 1e-12);
  }
  EXPECT_GT(limited, 10);
  EXPECT_GT(free, 10);
}

TEST(CompileJoin, HighDegreesJoinValueAndSlopeToo) {
  const std::uint64_t seed = support::test_seed();
  int free = 0;
  for (int i = 0; i < support::test_count(60); ++i) {
    Draws draw(seed + 3, i);
    testing::RandomCurveOptions random;
    random.min_degree = 8;
    random.max_degree = 15;
    random.periodic = false;
    const NurbsCurve curve = random_curve(draw, random);
    const double length = curve.u_max() - curve.u_min();
    const double u = curve.u_min() + (i % 4 == 0 ? 0.0 : draw.between(0, 0.8)) * length;
    const auto program = compile_function(curve);
    const auto join = compile_join(curve, u);
    ASSERT_TRUE(program);
    ASSERT_TRUE(join) << join.error().message;
    EXPECT_LE(join->basis.max_error(), 1e-7);
    const double value0 = draw.between(program->low(), program->high());
    const double slope0 = draw.between(-3, 3);
    // As an envelope asks: from what the program itself does there.
    const auto deltas = join->join_from(program->at_u(u), program->slope_at_u(u), value0, slope0);
    EXPECT_NEAR(joined(*program, *join, deltas, u), value0, 1e-12);
    const double slope = program->slope_at_u(u) + deltas.dp0 * join->basis.slope_at_u(u, 0) +
                         deltas.dp1 * join->basis.slope_at_u(u, 1);
    if (!deltas.limited) {
      ++free;
      EXPECT_NEAR(slope, slope0, 1e-10 * (1 + join->slope_factor));
    }
    for (double tail = join->u_basis_end; tail <= curve.u_max(); tail += length / 50) {
      EXPECT_EQ(joined(*program, *join, deltas, tail), program->at_u(tail));
    }
  }
  EXPECT_GT(free, 10);
}

TEST(CompileJoin, IsTheCurveWithItsFirstTwoPointsMoved) {
  const NurbsCurve curve = rational({0, 0.9, 0.2, 0.6, -0.3, 0}, {1, 2, 0.5, 1, 3, 1}, 3);
  const auto program = compile_function(curve);
  const auto join = compile_join(curve, 0);
  ASSERT_TRUE(program && join);
  const auto deltas = join->join(0.4, 0.7);
  ASSERT_FALSE(deltas.limited);
  CurveSpec spec = curve.spec();
  spec.points[0] += deltas.dp0;
  spec.points[1] += deltas.dp1;
  const NurbsCurve moved = made(std::move(spec));
  expect_is(*program, *join, deltas, moved, 1e-14);
}

TEST(CompileJoin, LaterPointsFollowTheFirstByTheirShareAndStayInTheHull) {
  // Level with P0: all of its step; half way to an edge of the hull 0..1: half; at an edge: none.
  const NurbsCurve drawn = line({0.4, 0.3, 0.4, 0.7, 0.2, 1, 0, 0.6}, 7);
  const double shares[] = {1, 0, 1, 0.5, 0.5, 0, 0, 0};
  const auto program = compile_function(drawn);
  const auto join = compile_join(drawn, 0);
  ASSERT_TRUE(program && join);
  for (const double value : {0.0, 0.1, 0.4, 0.8, 1.0}) {
    const auto deltas = join->join(value, 0);
    CurveSpec spec = drawn.spec();
    for (std::size_t i = 0; i < spec.points.size(); ++i) {
      spec.points[i] += deltas.dp0 * shares[i] + (i == 1 ? deltas.dp1 : 0.0);
      EXPECT_GE(spec.points[i], -1e-15);
      EXPECT_LE(spec.points[i], 1 + 1e-15);
    }
    const NurbsCurve moved = made(std::move(spec));
    expect_is(*program, *join, deltas, moved, 1e-13);
  }
}

TEST(CompileJoin, ASecondPointOfAQuadraticFollowsTheFirst) {
  const NurbsCurve drawn = line({0, 0.25, 1}, 2);
  const auto program = compile_function(drawn);
  const auto join = compile_join(drawn, 0);
  ASSERT_TRUE(program && join);
  EXPECT_FALSE(join->moves_p1);
  EXPECT_FALSE(join->is_vertical);
  const NurbsCurve moved = line({0.6, 0.7, 1}, 2);
  expect_is(*program, *join, join->join_c0(0.6), moved, 1e-15);
}

TEST(CompileJoin, NoPointFollowsWhereControllersMoveSome) {
  CompileOptions options;
  options.controls = {{Kind::coordinate, 2, 0, 0, 1}};
  for (const int degree : {2, 5}) {
    const auto join = compile_join(line({0, 0, 0.1, 1, 1, 1}, degree), 0, options);
    ASSERT_TRUE(join);
    EXPECT_TRUE(join->moves_p1);
    const double u = 0.5 * join->u_basis_end;
    const auto plain = compile_join(line({0, 0, 0.1, 1, 1, 1}, degree), 0);
    EXPECT_LT(join->basis.at_u(u, 0), plain->basis.at_u(u, 0));
  }
}

TEST(CompileJoin, KeepsTheCornersOfAPolyline) {
  const auto join = compile_join(line({0, 1, 0.5}, 1), 0.25);
  ASSERT_TRUE(join);
  const auto deltas = join->join(0.3, -2);
  EXPECT_EQ(deltas.dp0, 0.3 - join->p0);
  EXPECT_EQ(deltas.dp1, 0.0);
  EXPECT_TRUE(deltas.limited);
}

TEST(CompileJoin, StaysInTheHullWhateverTheSlope) {
  const NurbsCurve curve = line({0, 1, 0.5, 0.7, 0}, 3);
  const auto program = compile_function(curve);
  const auto join = compile_join(curve, 0);
  ASSERT_TRUE(program && join);
  for (const double slope : {-1e9, -10.0, 0.0, 10.0, 1e9}) {
    const auto deltas = join->join(0.6, slope);
    for (int i = 0; i <= 200; ++i) {
      const double y = joined(*program, *join, deltas, i / 200.0);
      EXPECT_GE(y, -1e-15);
      EXPECT_LE(y, 1 + 1e-15);
    }
    EXPECT_EQ(deltas.limited, std::abs(slope) > 5);
  }
}

TEST(CompileJoin, NotANumberLeavesTheCurveAsItIs) {
  const auto join = compile_join(line({0, 1, 0.5, 0.7, 0}, 3), 0.25);
  ASSERT_TRUE(join);
  const auto value = join->join_c0(NAN);
  EXPECT_EQ(value.dp0, 0.0);
  EXPECT_EQ(value.dp1, 0.0);
  const auto slope = join->join(0.5, NAN);
  EXPECT_EQ(slope.dp0, 0.5 - join->p0);
  EXPECT_EQ(slope.dp1, 0.0);
  EXPECT_TRUE(slope.limited);
}

TEST(CompileJoin, JoinsAProgramWhoseControlsHaveMoved) {
  CompileOptions options;
  options.controls = {{Kind::weight, 1, 0, 0.1, 10}, {Kind::coordinate, 0, 0, -1, 1}};
  const NurbsCurve curve = line({0, 1, 0.5, 0.7, 0}, 3);
  const auto program = compile_function(curve, options);
  const auto join = compile_join(curve, 0.1, options);
  ASSERT_TRUE(program && join);
  const double controls[] = {4.5, 0.3};
  const double value = program->at_u(0.1, 0, controls);
  const double slope = program->slope_at_u(0.1, 0, controls);
  const auto deltas = join->join_from(value, slope, 0.45, 0.8);
  ASSERT_FALSE(deltas.limited);
  EXPECT_NEAR(value + deltas.dp0 * join->basis.at_u(0.1, 0), 0.45, 1e-15);
  EXPECT_NEAR(slope + deltas.dp0 * join->basis.slope_at_u(0.1, 0) +
                  deltas.dp1 * join->basis.slope_at_u(0.1, 1),
              0.8, 1e-12);
}

TEST(CompileJoin, APlaceOutsideTheDomainIsRefused) {
  const NurbsCurve curve = line({0, 1, 0.5, 0.7, 0}, 3);
  for (const double u : {-0.1, 1.1, std::nan("")}) {
    const auto join = compile_join(curve, u);
    ASSERT_FALSE(join);
    EXPECT_EQ(join.error().code, ErrorCode::parameter_out_of_range);
  }
}

}  // namespace
}  // namespace knotwave::curves

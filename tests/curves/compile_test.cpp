// SPDX-License-Identifier: MIT
#include "knotwave/curves/compile.h"

#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "curves/random_curve.h"
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

/// What Horner of degree 7 may round away with points in -1..1.
constexpr double kRounding = 1e-13;

/// Largest |program - curve| at places the compiler did not look at.
double worst_error(const CurveProgram& program, const NurbsCurve& curve, int places,
                   std::span<const double> controls = {}) {
  double worst = 0;
  for (int i = 0; i <= places; ++i) {
    const double u = curve.u_min() + (curve.u_max() - curve.u_min()) * i / places;
    double exact[kMaxDim];
    curve.evaluate(u, exact);
    for (int c = 0; c < program.dim(); ++c) {
      worst = std::max(worst, std::abs(program.at_u(u, c, controls) - exact[c]));
    }
  }
  return worst;
}

TEST(Compile, CurvesUpToDegree7StayExact) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(400); ++i) {
    Draws draw(seed, i);
    testing::RandomCurveOptions options;
    options.dim = draw.whole(1, 4);
    const NurbsCurve curve = random_curve(draw, options);
    const auto program = compile_parametric(curve);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_EQ(program->piece_degree(), curve.degree());
    EXPECT_LT(program->max_error(), 1e-12);
    EXPECT_LT(worst_error(*program, curve, 300), 1e-12) << "curve " << i;
  }
}

TEST(Compile, HigherDegreesAreFittedWithinTheirBound) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(120); ++i) {
    Draws draw(seed + 5, i);
    testing::RandomCurveOptions random;
    random.min_degree = 8;
    random.max_degree = 15;
    random.dim = draw.whole(1, 2);
    const NurbsCurve curve = random_curve(draw, random);
    CompileOptions options;
    options.max_error = i % 3 == 0 ? 1e-5 : 1e-9;
    const auto program = compile_parametric(curve, options);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_LE(program->piece_degree(), 7);
    EXPECT_LE(program->max_error(), options.max_error);
    EXPECT_LE(worst_error(*program, curve, 2000), program->max_error() + kRounding) << i;
  }
}

TEST(Compile, RationalSpansBecomePolynomialWithinTheirBound) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(150); ++i) {
    Draws draw(seed + 6, i);
    testing::RandomCurveOptions random;
    random.max_degree = 15;
    random.dim = draw.whole(1, 2);
    const NurbsCurve curve = random_curve(draw, random);
    CompileOptions options;
    options.max_error = 1e-9;
    const auto program = compile_polynomial(curve, options);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_FALSE(program->is_rational());
    EXPECT_LE(program->max_error(), options.max_error);
    EXPECT_LE(worst_error(*program, curve, 2000), program->max_error() + kRounding) << i;
  }
}

// Weights from 1e-6 to 1e6, points from 1e-6 to 1e6, knots of every kind.
TEST(Compile, NastyCurvesAreWithinTheReportedErrorOrRefused) {
  const std::uint64_t seed = support::test_seed();
  int compiled = 0, refused = 0;
  for (int i = 0; i < support::test_count(300); ++i) {
    test::Dice dice(seed * 1000 + std::uint64_t(i));
    const NurbsCurve curve = test::random_curve(dice);
    const double largest = test::largest_coordinate(curve);
    CompileOptions options;
    options.max_error = 1e-7 * largest;
    const auto program =
        i % 2 == 0 ? compile_parametric(curve, options) : compile_polynomial(curve, options);
    if (!program) {
      EXPECT_EQ(program.error().code, ErrorCode::error_bound_missed) << program.error().message;
      ++refused;
      continue;
    }
    ++compiled;
    for (int k = 0; k < 200; ++k) {
      const double u = test::random_parameter(dice, curve);
      double exact[kMaxDim];
      curve.evaluate(u, exact);
      for (int c = 0; c < curve.dim(); ++c) {
        EXPECT_NEAR(program->at_u(u, c), exact[c], program->max_error() + 1e-11 * largest)
            << "curve " << i << ", u = " << u;
      }
    }
  }
  RecordProperty("compiled", compiled);
  RecordProperty("refused", refused);
  std::printf("%d compiled, %d refused\n", compiled, refused);
  EXPECT_GT(compiled, 250);
}

TEST(Compile, ThePolynomialFormOfACurveWithoutWeightsIsExact) {
  const auto program = compile_polynomial(line({0, 1, 0.5, 0.7, 0}, 3));
  ASSERT_TRUE(program);
  EXPECT_EQ(program->piece_degree(), 3);
  EXPECT_EQ(program->piece_count(), 2);
  EXPECT_LT(program->max_error(), 1e-15);
}

TEST(Compile, WeightsAMillionToOneStayWithinTheBoundOrAreRefused) {
  const auto program = compile_function(rational({0, 1, 0.5, 1}, {1e-6, 1e6, 1e-6, 1}, 3));
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_LE(program->max_error(), 1e-7);
  CompileOptions options;
  options.max_error = 1e-12;
  options.controls = {{Kind::weight, 1, 0, 1e-6, 1e6}};
  const auto controlled = compile_function(rational({0, 1, 0.5, 1}, {1, 1e6, 1, 1}, 3), options);
  ASSERT_FALSE(controlled) << "moved by 1e6 a weight is left with 10 digits";
  EXPECT_EQ(controlled.error().code, ErrorCode::error_bound_missed);
}

// Design 6: the 60 dB decays, in decibels of 10^(-3 u).
double worst_decibels(const NurbsCurve& curve) {
  const auto program = compile_function(curve);
  if (!program) ADD_FAILURE() << program.error().message;
  double worst = 0;
  for (int i = 0; i <= 10000; ++i) {
    const double u = i / 10000.0;
    worst = std::max(worst, std::abs(20 * std::log10(program->at_u(u)) + 60 * u));
  }
  return worst;
}

TEST(Compile, FivePointsFollowA60DecibelDecayWithin2Millibels) {
  EXPECT_LT(worst_decibels(rational({1, 0.15962, 0.030761, 0.0058833, 0.001},
                                    {0.033544, 0.068924, 0.15018, 0.35327, 1}, 4)),
            0.002);
}

TEST(Compile, FourPointsFollowA60DecibelDecayWithin10Millibels) {
  EXPECT_LT(worst_decibels(rational({1.0009, 0.084285, 0.011813, 0.00099899},
                                    {0.031672, 0.080777, 0.21598, 1}, 3)),
            0.01);
}

TEST(Compile, AControlledWeightIsTheCurveWithThatWeight) {
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

TEST(Compile, ControlsOnRandomCurvesAreTheCurvesWithThoseNumbers) {
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

TEST(Compile, TheHullCoversTheRangesOfControls) {
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

TEST(Compile, AControlledEndPointIsMetExactly) {
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

TEST(Compile, ControlsThatCannotBeAreRefusedWithTheirNumbers) {
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

TEST(Compile, DeclaredJumpsAreKept) {
  CurveSpec spec;
  spec.name = "jump";
  spec.degree = 1;
  spec.points = {0, 1, -1, 0.5};
  spec.knots = {0, 0, 0.5, 0.5, 1, 1};
  spec.jumps = {0.5};
  const NurbsCurve curve = made(std::move(spec));
  const auto program = compile_function(curve);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(program->at_u(0.5), -1.0);
  EXPECT_NEAR(program->at_u(std::nextafter(0.5, 0.0)), 1.0, 1e-15);
}

TEST(Compile, MoreThan2CoordinatesAreNoFunction) {
  CurveSpec spec;
  spec.name = "space";
  spec.degree = 1;
  spec.dim = 3;
  spec.points = {0, 0, 0, 1, 1, 1};
  const auto program = compile_function(made(std::move(spec)));
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::not_scalar);
}

/// Value of the joined curve.
double joined(const CurveProgram& program, const JoinProgram& join,
              const JoinProgram::Deltas& deltas, double u) {
  return program.at_u(u) + deltas.dp0 * join.basis.at_u(u, 0) + deltas.dp1 * join.basis.at_u(u, 1);
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
  for (int i = 0; i <= 100; ++i) {
    double y;
    moved.evaluate(i / 100.0, {&y, 1});
    EXPECT_NEAR(joined(*program, *join, deltas, i / 100.0), y, 1e-14);
  }
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
    for (int i = 0; i <= 100; ++i) {
      double y;
      moved.evaluate(i / 100.0, {&y, 1});
      EXPECT_NEAR(joined(*program, *join, deltas, i / 100.0), y, 1e-13);
    }
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
  for (int i = 0; i <= 100; ++i) {
    double y;
    moved.evaluate(i / 100.0, {&y, 1});
    EXPECT_NEAR(joined(*program, *join, join->join_c0(0.6), i / 100.0), y, 1e-15);
  }
}

TEST(CompileJoin, NoPointFollowsWhereControllersMoveSome) {
  CompileOptions options;
  options.controls = {{ControlRange::Kind::coordinate, 2, 0, 0, 1}};
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

// SPDX-License-Identifier: MIT
// Curves whose first coordinate is time.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/monotone.h"

#include "curves/random_curves.h"
#include "curves/time_oracle.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {
using testing::Draws;
using testing::made;

NurbsCurve timed(int degree, std::vector<double> points, std::vector<double> weights = {},
                 std::vector<double> knots = {}) {
  CurveSpec spec;
  spec.name = "timed";
  spec.degree = degree;
  spec.dim = 2;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  spec.knots = std::move(knots);
  return made(std::move(spec));
}

NurbsCurve easing(double x1, double y1, double x2, double y2) {
  return timed(3, {0, 0, x1, y1, x2, y2, 1, 1});
}

CurveProgram compiled(const NurbsCurve& curve, const CompileOptions& options = {}) {
  auto program = compile_function(curve, options);
  if (!program) ADD_FAILURE() << program.error().message;
  return program ? std::move(*program) : CurveProgram();
}

struct GoldenCurve {
  const char* name;
  int degree;
  std::vector<double> points, weights, knots;
  std::vector<std::array<double, 2>> samples;
};

const std::vector<GoldenCurve>& golden_curves() {
  static const std::vector<GoldenCurve> curves = {
#include "golden/curves/inversion.inc"
  };
  return curves;
}

TEST(CompileTime, MeetsItsBoundOnGoldenCurvesVerticalTangentsIncluded) {
  for (const GoldenCurve& golden : golden_curves()) {
    SCOPED_TRACE(golden.name);
    const NurbsCurve curve = timed(golden.degree, golden.points, golden.weights, golden.knots);
    for (const double asked : {1e-4, 1e-7, 1e-9}) {
      CompileOptions options;
      options.max_error = asked;
      const CurveProgram program = compiled(curve, options);
      EXPECT_LE(program.max_error(), asked);
      for (const auto& [x, y] : golden.samples) {
        EXPECT_NEAR(program.at_u(x), y, program.max_error() + 1e-15) << "x = " << x;
      }
    }
  }
}

// Values of research by 40-digit arithmetic; Chromium's, WebKit's and Maya's agree with them.
TEST(CompileTime, MeetsTheKnownValuesOfEasings) {
  const CurveProgram ease = compiled(easing(.25, .1, .25, 1));
  EXPECT_NEAR(ease.at_u(.25), .40851059135539587, 1e-7);
  EXPECT_NEAR(ease.at_u(.5), .80240338758485699, 1e-7);
  EXPECT_NEAR(ease.at_u(.75), .96045897834897408, 1e-7);
  EXPECT_NEAR(compiled(easing(.42, 0, 1, 1)).at_u(.5), .3153568125725393, 1e-7);
  EXPECT_NEAR(compiled(easing(0, 0, .58, 1)).at_u(.5), .6846431874274607, 1e-7);
  EXPECT_NEAR(compiled(easing(.42, 0, .58, 1)).at_u(.25), .12916193104731981, 1e-7);
  EXPECT_NEAR(compiled(easing(0, 1, 0, 1)).at_u(.001), .271, 1e-7);
  EXPECT_NEAR(compiled(easing(1, 0, 0, 1)).at_u(.5), .5, 1e-7);
  EXPECT_NEAR(compiled(easing(1, 0, 0, 1)).at_u(.25), .029724605511925197, 1e-7);
  EXPECT_NEAR(compiled(easing(0, 0, 1. / 3, 1)).at_u(.25), .5, 1e-7);
}

// ui/gfx/geometry/cubic_bezier_unittest.cc prints five digits; they hold to 1e-5.
TEST(CompileTime, MeetsChromiumsTables) {
  const CurveProgram slow = compiled(easing(.25, 0, .75, 1));
  const double rising[] = {.01136, .03978, .07978, .12803, .18235, .24115, .30323,
                           .36761, .43345, .5,     .56655, .63238, .69676, .75884,
                           .81764, .87196, .92021, .96021, .98863};
  for (int i = 0; i < 19; ++i) EXPECT_NEAR(slow.at_u(.05 * (i + 1)), rising[i], 1e-5);
  const CurveProgram over = compiled(easing(.5, -1, .5, 2));
  const double falling[] = {-.08954, -.15613, -.19641, -.20651, -.18232,
                            -.11992, -.01672, .1266,   .30349,  .5};
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(over.at_u(.05 * (i + 1)), falling[i], 1e-5);
  EXPECT_NEAR(compiled(easing(.5, 1, .5, 1)).at_u(.5), .875, 1e-7);
  EXPECT_NEAR(compiled(easing(.5, 2, .5, 2)).at_u(.5), 1.625, 1e-7);
  EXPECT_NEAR(compiled(easing(.5, -1, .5, -1)).at_u(.5), -.625, 1e-7);
}

// OpenUSD, pxr/base/ts, test_Baseline_TsTestBaseline.txt, made by Autodesk Maya: seven digits.
TEST(CompileTime, MeetsMayasTable) {
  const CurveProgram program = compiled(timed(3, {1, 1, 1.5, 1.5, 4.5, 2, 5, 2}));
  EXPECT_NEAR(program.at_u(1.0199005), 1.0187387, 2e-7);
  EXPECT_NEAR(program.at_u(1.4975124), 1.2723983, 2e-7);
  EXPECT_NEAR(program.at_u(3.0099502), 1.6896295, 2e-7);
  EXPECT_NEAR(program.at_u(4.5024876), 1.9524990, 2e-7);
  EXPECT_NEAR(program.at_u(4.9402985), 1.9982742, 2e-7);
}

/// Largest error over what was asked for, 2^-24, and over what was reported.
struct Worst {
  double of_bound = 0;
  double of_reported = 0;
  int most_pieces = 0;
};

Worst worst_of_cubics(int count) {
  const std::uint64_t seed = support::test_seed();
  CompileOptions options;
  options.max_error = 0x1p-24;
  Worst worst;
  for (int i = 0; i < count; ++i) {
    Draws draw(seed, i);
    // Now and then handles as long as they may be: vertical or nearly so inside.
    const double reach = i % 32 == 0 ? 4. / 3 : 1;
    HandleLengths handles{reach * draw.unit(), reach * draw.unit()};
    handles = regularize_handles(handles, Regularization::keep_ratio);
    const NurbsCurve curve =
        easing(handles.a, draw.between(-1, 2), 1 - handles.b, draw.between(-1, 2));
    const CurveProgram program = compiled(curve, options);
    EXPECT_LE(program.max_error(), options.max_error) << i;
    worst.most_pieces = std::max(worst.most_pieces, program.piece_count());
    for (int k = 0; k < 6; ++k) {
      const double x = k < 4 ? draw.unit() : std::ldexp(draw.unit(), -10 * (k - 3));
      const double error = std::abs(program.at_u(x) - test::segment_value(curve.points(), x));
      EXPECT_LE(error, options.max_error) << "curve " << i << ", x = " << x;
      worst.of_bound = std::max(worst.of_bound, error / options.max_error);
      worst.of_reported = std::max(worst.of_reported, error / program.max_error());
    }
  }
  std::printf("worst %.3f of 2^-24, %.3f of what was reported, at most %d pieces\n", worst.of_bound,
              worst.of_reported, worst.most_pieces);
  return worst;
}

TEST(CompileTime, RandomMonotoneCubicsAreWithin2ToTheMinus24) {
  const Worst worst = worst_of_cubics(support::test_count(10'000));
  EXPECT_LE(worst.of_bound, 1);
  EXPECT_LE(worst.of_reported, 1 + 1e-8);
  EXPECT_GT(worst.of_reported, 0.8) << "the reported error is much larger than any error there is";
  EXPECT_LE(worst.most_pieces, 130);
}

TEST(CompileTimeStress, RandomMonotoneCubicsAreWithin2ToTheMinus24) {
  EXPECT_LE(worst_of_cubics(support::test_count(100'000)).of_bound, 1);
}

TEST(CompileTime, TheFourHandlesAreWithin2ToTheMinus24AtEveryDouble) {
  const double handles[][4] = {
      {0, 1, 0, 1}, {1, 0, 0, 1}, {0, 0, 1. / 3, 1}, {1. / 3, 1. / 3, 2. / 3, 2. / 3}};
  Draws draw(support::test_seed(), 0);
  CompileOptions options;
  options.max_error = 0x1p-24;
  double worst = 0;
  for (const auto& [x1, y1, x2, y2] : handles) {
    const NurbsCurve curve = easing(x1, y1, x2, y2);
    const CurveProgram program = compiled(curve, options);
    for (int k = 0; k < 300; ++k) {
      const double near = std::ldexp(draw.unit(), -draw.whole(0, 60));
      const double x = k % 3 == 0 ? near : k % 3 == 1 ? 1 - near : std::min(1.0, 0.5 + near);
      const double error = std::abs(program.at_u(x) - test::segment_value(curve.points(), x));
      worst = std::max(worst, error / options.max_error);
      ASSERT_LE(error, options.max_error) << x1 << " " << x2 << " at " << x;
    }
  }
  std::printf("worst %.3f of 2^-24\n", worst);
}

// OpenUSD, regression.md: with handles of length a and b time never goes back if and only if both
// are at most 1 or a^2 + b^2 + a b - 2 a - 2 b + 1 <= 0.
TEST(CompileTime, AcceptsExactlyTheHandlesOfTheEllipseCondition) {
  int accepted = 0, refused = 0;
  for (int i = 0; i <= 30; ++i) {
    for (int j = 0; j <= 30; ++j) {
      const double a = i * 0.05, b = j * 0.05;
      const double ellipse = a * a + b * b + a * b - 2 * a - 2 * b + 1;
      if (std::abs(ellipse) < 1e-9) continue;
      const bool forward = (a <= 1 && b <= 1) || ellipse <= 0;
      const auto program = compile_function(easing(a, 0.3, 1 - b, 0.6));
      ASSERT_EQ(program.has_value(), forward) << "handles " << a << " and " << b;
      (forward ? accepted : refused) += 1;
    }
  }
  EXPECT_GT(accepted, 300);
  EXPECT_GT(refused, 100);
}

TEST(CompileTime, TakesThePiecesThatCompileMdPrints) {
  EXPECT_EQ(compiled(easing(.42, 0, .58, 1)).piece_count(), 4);
  EXPECT_EQ(compiled(easing(.25, .1, .25, 1)).piece_count(), 6);
  EXPECT_EQ(compiled(easing(0, 0, 1. / 3, 1)).piece_count(), 10);
  EXPECT_EQ(compiled(easing(.9, 0, .1, 1)).piece_count(), 14);
  EXPECT_EQ(compiled(easing(0, 1, 0, 1)).piece_count(), 67);
  EXPECT_EQ(compiled(easing(4. / 3, 0, 2. / 3, 1)).piece_count(), 101);
  EXPECT_EQ(compiled(easing(1, 0, 0, 1)).piece_count(), 106);
}

TEST(CompileTime, NamesTheIntervalWhereTimeGoesBack) {
  const auto program = compile_function(easing(2, 0.3, -1, 0.6));
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::not_a_function);
  // x' = 0 where 10 t^2 - 10 t + 2 = 0: t = (1 -+ sqrt(1/5)) / 2.
  const std::string& message = program.error().message;
  EXPECT_NE(message.find("u = 0.27639"), std::string::npos) << message;
  EXPECT_NE(message.find("and 0.7236"), std::string::npos) << message;
}

TEST(CompileTime, AVerticalSegmentBecomesAJump) {
  const CurveProgram program = compiled(timed(1, {0, 0, 1, 0.5, 1, -0.25, 2, 1}));
  EXPECT_EQ(program.piece_count(), 2);
  EXPECT_EQ(program.piece_degree(), 1);
  EXPECT_EQ(program.at_u(1), -0.25);
  EXPECT_NEAR(program.at_u(1 - 1e-12), 0.5, 1e-11);
  EXPECT_EQ(program.at_u(0), 0.0);
  EXPECT_EQ(program.at_u(2), 1.0);
}

TEST(CompileTime, VerticalSegmentsAtTheEndsJumpThere) {
  const CurveProgram program = compiled(timed(1, {0, 0, 0, 1, 2, 0.5, 2, 0}));
  EXPECT_EQ(program.at_u(0), 1.0) << "the value to the right";
  EXPECT_EQ(program.at_u(1), 0.75);
  EXPECT_NEAR(program.at_u(2 - 1e-12), 0.5, 1e-11);
  EXPECT_EQ(program.at_u(2), 0.0) << "what is held from here on";
  EXPECT_EQ(program.at_u(3), 0.0);
}

TEST(CompileTime, DeclaredJumpsKeepTheirTime) {
  CurveSpec spec;
  spec.name = "jump";
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {0, 0, 0.1, 1, 1, 0.8, 1, -1, 1.5, -0.5, 2, 0};
  spec.knots = {0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1};
  spec.jumps = {0.5};
  const CurveProgram program = compiled(made(spec));
  EXPECT_EQ(program.at_u(1), -1.0);
  EXPECT_NEAR(program.at_u(std::nextafter(1, 0)), 0.8, 1e-7);
  spec.points[6] = 1.25;
  const auto gap = compile_function(made(spec));
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().code, ErrorCode::not_a_function);
  EXPECT_NE(gap.error().message.find("leaps from x = 1 to 1.25"), std::string::npos)
      << gap.error().message;
}

TEST(CompileTime, ATimeThatNeverMovesIsRefused) {
  const auto program = compile_function(timed(2, {1, 0, 1, 1, 1, 0}));
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::empty_domain);
}

TEST(CompileTime, TooFewPiecesAreRefusedWithBothErrors) {
  CompileOptions options;
  options.max_pieces = 3;
  const auto program = compile_function(easing(0, 1, 0, 1), options);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::error_bound_missed);
  EXPECT_NE(program.error().message.find(
                "3 pieces are not enough to follow its 4 points of degree 3 within 1e-07"),
            std::string::npos)
      << program.error().message;
}

// Unclamped: the first and the last time are thirds, and y is vertical there.
TEST(CompileTime, VerticalEndsThatAreNoDoublesAreWithinWhatIsAsked) {
  for (const double side : {1.0, -1.0}) {
    CurveSpec spec;
    spec.name = "thirds";
    spec.degree = 3;
    spec.dim = 2;
    spec.points = {5 * side, 0, 0, 1, 5 * side, 3, 15 * side, -1};
    if (side < 0) {
      for (std::size_t i = 0; i < 2; ++i) {
        std::swap(spec.points[2 * i], spec.points[6 - 2 * i]);
        std::swap(spec.points[2 * i + 1], spec.points[7 - 2 * i]);
      }
    }
    spec.knots = {-3, -2, -1, 0, 1, 2, 3, 4};
    const NurbsCurve curve = made(spec);
    const CurveProgram program = compiled(curve, {1e-9, 4096, {}});
    // x = 5/3 + 5 u^2 - ..., and the double beside 5/3 is 2^-52 / 3 above.
    double end[2];
    curve.evaluate(side > 0 ? 0 : 1, end);
    const double value = end[1], by_u = 1.5, u = std::sqrt(0x1p-52 / 15);
    EXPECT_NEAR(program.at_u(side * (5.0 / 3)), value + by_u * u, 1e-9);
    EXPECT_GT(std::abs(program.at_u(side * (5.0 / 3)) - value), 5e-9);
    EXPECT_EQ(program.at_u(side > 0 ? program.u_min() : program.u_max()), value);
  }
}

TEST(CompileTime, PolylinesFinerThanDoublesAreRefusedWithThePlace) {
  CompileOptions options;
  options.max_error = 1e-18;
  const auto program = compile_function(timed(1, {0, 0, 0.1, 0.3, 1, 1}), options);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::error_bound_missed);
  EXPECT_NE(program.error().message.find("1e-18 was asked: at x = 0.1, u = "), std::string::npos)
      << program.error().message;
}

TEST(CompileTime, ControlsAreRefused) {
  CompileOptions options;
  options.controls = {{ControlRange::Kind::weight, 1, 0, 0.5, 2}};
  const auto program = compile_function(easing(.2, .3, .4, .5), options);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::unsupported);
}

TEST(CompileTime, PolylinesInTimeStayExactLines) {
  const CurveProgram program = compiled(timed(1, {0, 0, 0.125, 1, 1, 0.5, 4, 0}));
  EXPECT_EQ(program.piece_degree(), 1);
  EXPECT_EQ(program.piece_count(), 3);
  EXPECT_LT(program.max_error(), 1e-14);  // proved, so more than is ever seen
  EXPECT_EQ(program.at_u(0.0625), 0.5);
  EXPECT_EQ(program.at_u(2.5), 0.25);
}

TEST(CompileTime, EndsAreTheControlPointsToTheBitAndBreaksAreContinuous) {
  for (const GoldenCurve& golden : golden_curves()) {
    SCOPED_TRACE(golden.name);
    const CurveProgram program =
        compiled(timed(golden.degree, golden.points, golden.weights, golden.knots));
    EXPECT_EQ(program.u_min(), golden.points[0]);
    EXPECT_EQ(program.u_max(), golden.points[golden.points.size() - 2]);
    EXPECT_EQ(program.at_u(program.u_min()), golden.points[1]);
    EXPECT_EQ(program.at_u(program.u_max()), golden.points.back());
    for (int i = 0; i + 1 < program.piece_count(); ++i) {
      double end = 0;
      for (const double c : program.coefficients(i)) end += c;
      EXPECT_NEAR(end, program.coefficients(i + 1)[0], 1e-14);
    }
  }
}

TEST(CompileTime, AJoinInTimeStartsAtItsValueAndSlopeAndLeavesTheTailAlone) {
  const NurbsCurve curve =
      timed(3, {0, 0, 0.1, 1.2, 0.5, 0.9, 1, 0.6, 1.5, 0.7, 2, 0.3, 3, 0}, {1, 1, 2, 1, 0.5, 1, 1});
  const CurveProgram program = compiled(curve);
  for (const double x : {0.0, 0.01, 0.4, 0.9, 2.0}) {
    const auto join = compile_join(curve, x);
    ASSERT_TRUE(join) << join.error().message;
    EXPECT_EQ(join->basis.u_min(), x);
    EXPECT_NEAR(join->p0, program.at_u(x), 2e-7);
    EXPECT_NEAR(join->slope_factor * (join->p1 - join->p0), program.slope_at_u(x), 2e-4);
    const auto deltas = join->join(0.45, 0.2);
    ASSERT_FALSE(deltas.limited);
    const auto joined = [&](double at) {
      return program.at_u(at) + deltas.dp0 * join->basis.at_u(at, 0) +
             deltas.dp1 * join->basis.at_u(at, 1);
    };
    EXPECT_NEAR(joined(x), 0.45, 2e-7);
    EXPECT_NEAR((joined(x + 1e-5) - joined(x)) / 1e-5, 0.2, 0.02);
    EXPECT_LE(join->u_basis_end, 3.0);
    for (double tail = join->u_basis_end; tail <= 3; tail += 0.05) {
      EXPECT_EQ(joined(tail), program.at_u(tail));
    }
  }
  const auto late = compile_join(curve, 3.0);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::parameter_out_of_range);
}

TEST(CompileTime, AJoinInTimeIsTheCurveWithItsFirstTwoValuesMoved) {
  const NurbsCurve curve = timed(3, {0, 0, 0.1, 1, 0.5, 0.9, 1, 0.6, 1.5, 0.7}, {1, 1, 2, 1, 0.5});
  const CurveProgram program = compiled(curve);
  const auto join = compile_join(curve, 0);
  ASSERT_TRUE(join);
  const auto deltas = join->join(0.3, 1);
  CurveSpec spec = curve.spec();
  spec.points[1] += deltas.dp0;
  spec.points[3] += deltas.dp1;
  const CurveProgram moved = compiled(made(std::move(spec)));
  for (int i = 0; i <= 150; ++i) {
    const double x = 0.01 * i;
    EXPECT_NEAR(
        program.at_u(x) + deltas.dp0 * join->basis.at_u(x, 0) + deltas.dp1 * join->basis.at_u(x, 1),
        moved.at_u(x), 4e-7);
  }
}

TEST(CompileTime, AVerticalStartJoinsByValueOnly) {
  const auto join = compile_join(easing(0, 1, 0.5, 1), 0);
  ASSERT_TRUE(join);
  EXPECT_FALSE(join->moves_p1);
  const auto deltas = join->join(0.25, 3);
  EXPECT_EQ(deltas.dp0, 0.25);
  EXPECT_EQ(deltas.dp1, 0.0);
  EXPECT_TRUE(deltas.limited);
}

}  // namespace
}  // namespace knotwave::curves

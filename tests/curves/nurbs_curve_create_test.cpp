// SPDX-License-Identifier: MIT
// Every way a curve can be wrong, and what the user is told.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/nurbs_curve.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;

CurveSpec cubic() {
  CurveSpec spec;
  spec.name = "bell";
  spec.degree = 3;
  spec.points = {0, 1, 2, 3, 4, 5};
  spec.weights = {1, 1, 2, 1, 1, 1};
  spec.knots = {0, 0, 0, 0, 0.4, 0.5, 1, 1, 1, 1};
  return spec;
}

struct Fault {
  const char* what;
  void (*break_it)(CurveSpec&);
  ErrorCode code;
  const char* message;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr Fault kFaults[] = {
    {"degree 0", [](CurveSpec& s) { s.degree = 0; }, ErrorCode::degree_out_of_range,
     "curve 'bell': degree 0 is outside 1..15"},
    {"degree 16", [](CurveSpec& s) { s.degree = 16; }, ErrorCode::degree_out_of_range,
     "curve 'bell': degree 16 is outside 1..15"},
    {"three points", [](CurveSpec& s) { s.points.resize(3); }, ErrorCode::too_few_points,
     "curve 'bell': 3 points, degree 3 needs at least 4"},
    {"one point", [](CurveSpec& s) { s.points.resize(1); }, ErrorCode::too_few_points,
     "curve 'bell': 1 point, degree 3 needs at least 4"},
    {"4097 points", [](CurveSpec& s) { s.points.resize(4097); }, ErrorCode::too_many_points,
     "curve 'bell': 4097 points, at most 4096 are possible"},
    {"dimension 0", [](CurveSpec& s) { s.dim = 0; }, ErrorCode::dimension_mismatch,
     "curve 'bell': 0 coordinates per point, 1..4 are possible"},
    {"dimension 5", [](CurveSpec& s) { s.dim = 5; }, ErrorCode::dimension_mismatch,
     "curve 'bell': 5 coordinates per point, 1..4 are possible"},
    {"half a point", [](CurveSpec& s) { s.dim = 4; }, ErrorCode::dimension_mismatch,
     "curve 'bell': 6 numbers do not make whole points of 4 coordinates"},
    {"a knot short", [](CurveSpec& s) { s.knots.pop_back(); }, ErrorCode::knot_count_mismatch,
     "curve 'bell': 9 knots, expected 10 (points + degree + 1)"},
    {"too many periodic knots", [](CurveSpec& s) { s.periodic = true; },
     ErrorCode::knot_count_mismatch, "curve 'bell': 10 knots, expected 7 (points + 1, periodic)"},
    {"knots that decrease", [](CurveSpec& s) { s.knots[4] = 0.6; }, ErrorCode::knots_decrease,
     "curve 'bell': knot 5 (0.5) is below knot 4 (0.6)"},
    {"a knot that is no number", [](CurveSpec& s) { s.knots[4] = kNan; }, ErrorCode::not_finite,
     "curve 'bell': knot 4 (nan) is not finite"},
    {"a knot far out", [](CurveSpec& s) { s.knots[9] = 2e9; }, ErrorCode::value_out_of_range,
     "curve 'bell': knot 9 (2e+09) is outside -1e+09..1e+09"},
    {"knots that differ by next to nothing",
     [](CurveSpec& s) { s.knots = {0, 0, 0, 0, 1e-300, 0.5, 1, 1, 1, 1}; },
     ErrorCode::value_out_of_range,
     "curve 'bell': knot 4 (1e-300) is above knot 3 (0) by less than 1e-280"},
    {"an undeclared jump",
     [](CurveSpec& s) {
       s.points.resize(8);
       s.weights.clear();
       s.knots = {0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5, 1, 1, 1, 1};
     },
     ErrorCode::knot_multiplicity,
     "curve 'bell': knot 4 (0.5) comes 4 times, degree 3 allows 3 inside; a jump is declared by "
     "jumps = [0.5]"},
    {"a knot five times",
     [](CurveSpec& s) {
       s.points.resize(9);
       s.weights.clear();
       s.knots = {0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5, 0.5, 1, 1, 1, 1};
       s.jumps = {0.5};
     },
     ErrorCode::knot_multiplicity, "curve 'bell': knot 4 (0.5) comes 5 times, degree 3 allows 4"},
    {"an end knot five times", [](CurveSpec& s) { s.knots[4] = 0; }, ErrorCode::knot_multiplicity,
     "curve 'bell': knot 0 (0) comes 5 times, degree 3 allows 4"},
    {"no length", [](CurveSpec& s) { s.knots.assign(10, 0.25); }, ErrorCode::empty_domain,
     "curve 'bell': the curve has no length: knot 3 and knot 6 are both 0.25"},
    {"a seam too strong",
     [](CurveSpec& s) {
       s.periodic = true;
       s.knots = {0, 0, 0, 0.5, 1, 1, 1};
     },
     ErrorCode::knot_multiplicity,
     "curve 'bell': knot 0 (0) comes 5 times around the seam of the period, degree 3 allows 3"},
    {"a jump in a periodic curve",
     [](CurveSpec& s) {
       s.periodic = true;
       s.knots.clear();
       s.jumps = {0.5};
     },
     ErrorCode::knot_multiplicity,
     "curve 'bell': jump 0 (0.5) is in a periodic curve, which has none"},
    {"a jump that is no knot", [](CurveSpec& s) { s.jumps = {0.3}; },
     ErrorCode::parameter_out_of_range,
     "curve 'bell': jump 0 (0.3) is not a knot between the ends of the curve"},
    {"a weight short", [](CurveSpec& s) { s.weights.pop_back(); }, ErrorCode::weight_count_mismatch,
     "curve 'bell': 5 weights for 6 points"},
    {"a zero weight", [](CurveSpec& s) { s.weights[2] = 0; }, ErrorCode::weight_not_positive,
     "curve 'bell': weight 2 (0) must be above 0, at least 1e-06"},
    {"a negative weight", [](CurveSpec& s) { s.weights[2] = -1; }, ErrorCode::weight_not_positive,
     "curve 'bell': weight 2 (-1) must be above 0, at least 1e-06"},
    {"a tiny weight", [](CurveSpec& s) { s.weights[2] = 1e-7; }, ErrorCode::weight_out_of_range,
     "curve 'bell': weight 2 (1e-07) is outside 1e-06..1e+06"},
    {"a huge weight", [](CurveSpec& s) { s.weights[2] = 1e7; }, ErrorCode::weight_out_of_range,
     "curve 'bell': weight 2 (1e+07) is outside 1e-06..1e+06"},
    {"an infinite weight", [](CurveSpec& s) { s.weights[2] = kInfinity; }, ErrorCode::not_finite,
     "curve 'bell': weight 2 (inf) is not finite"},
    {"a coordinate far out", [](CurveSpec& s) { s.points[5] = -2e6; },
     ErrorCode::coordinate_out_of_range, "curve 'bell': point 5 (-2e+06) is outside -1e+06..1e+06"},
    {"a coordinate that is no number",
     [](CurveSpec& s) {
       s.dim = 2;
       s.points.resize(12, 0.0);
       s.points[7] = kNan;
     },
     ErrorCode::not_finite, "curve 'bell': point 3, coordinate 1 (nan) is not finite"},
};

TEST(NurbsCurveCreate, EveryFaultIsNamedWithItsNumbers) {
  ASSERT_TRUE(NurbsCurve::create(cubic()));
  for (const Fault& fault : kFaults) {
    CurveSpec spec = cubic();
    fault.break_it(spec);
    const auto curve = NurbsCurve::create(spec);
    ASSERT_FALSE(curve) << fault.what;
    EXPECT_EQ(curve.error().code, fault.code) << fault.what;
    EXPECT_EQ(curve.error().message, fault.message) << fault.what;
  }
}

TEST(NurbsCurveCreate, KnotsLeftOutAreClampedAndUniform) {
  CurveSpec spec = cubic();
  spec.knots.clear();
  const auto curve = NurbsCurve::create(spec);
  ASSERT_TRUE(curve);
  EXPECT_THAT(curve->knots(), testing::ElementsAre(0, 0, 0, 0, 1.0 / 3, 2.0 / 3, 1, 1, 1, 1));
  EXPECT_TRUE(curve->is_clamped());
}

TEST(NurbsCurveCreate, PeriodicCurveRepeatsItsFirstPointsAndShiftsItsKnots) {
  CurveSpec spec = cubic();
  spec.periodic = true;
  spec.knots = {0, 0.25, 0.25, 0.5, 0.75, 0.875, 1};
  const auto curve = NurbsCurve::create(spec);
  ASSERT_TRUE(curve);
  EXPECT_THAT(curve->points(), testing::ElementsAre(0, 1, 2, 3, 4, 5, 0, 1, 2));
  EXPECT_THAT(curve->weights(), testing::ElementsAre(1, 1, 2, 1, 1, 1, 1, 1, 2));
  EXPECT_THAT(curve->knots(), testing::ElementsAre(-0.5, -0.25, -0.125, 0, 0.25, 0.25, 0.5, 0.75,
                                                   0.875, 1, 1.25, 1.25, 1.5));
  EXPECT_FALSE(curve->is_clamped());
}

TEST(NurbsCurveCreate, SpecOfACurveMakesAnEqualCurve) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 2000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const auto again = NurbsCurve::create(curve.spec());
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_TRUE(*again == curve);
  }
}

TEST(NurbsCurveCreate, EqualWeightsAreNotRational) {
  CurveSpec spec = cubic();
  spec.weights.assign(6, 3.0);
  EXPECT_FALSE(NurbsCurve::create(spec)->is_rational());
  spec.weights[1] = 2.0;
  EXPECT_TRUE(NurbsCurve::create(spec)->is_rational());
}

}  // namespace
}  // namespace knotwave::test

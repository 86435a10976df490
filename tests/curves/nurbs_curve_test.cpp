// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"
#include "knotwave/curves/calculus.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;

using base::index_of;

CurveSpec spec_of(int degree, int dim, std::vector<double> points, std::vector<double> knots,
                  std::vector<double> weights = {}) {
  CurveSpec spec;
  spec.name = "example";
  spec.degree = degree;
  spec.dim = dim;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  spec.knots = std::move(knots);
  return spec;
}

std::vector<double> at(const NurbsCurve& curve, double u, Side side = Side::right) {
  std::vector<double> out(std::size_t(curve.dim()));
  curve.evaluate(u, side, out);
  return out;
}

std::vector<double> derivatives_at(const NurbsCurve& curve, double u, int order,
                                   Side side = Side::right) {
  std::vector<double> out(index_of((order + 1) * curve.dim()));
  curve.derivatives(u, order, side, out);
  return out;
}

TEST(NurbsCurveDerivatives, BeyondAllDoublesAreTheLargestOne) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const auto bell = NurbsCurve::create(spec_of(4, 1, {0, 0, 1, 0, 0}, {}, {1, 1, 4, 1, 1}));
  ASSERT_TRUE(bell);
  const auto many = derivatives_at(*bell, 0.4, 1000);
  for (const double x : many) ASSERT_TRUE(std::isfinite(x));
  EXPECT_EQ(std::abs(many[1000]), kMost);
  EXPECT_LT(std::abs(many[100]), kMost) << "about 1e158 * 0.5^-100";
  for (const double x : derivatives_at(*bell, 0.5, 200)) ASSERT_TRUE(std::isfinite(x));

  const std::vector<double> short_knots = {0, 0, 0, 0, 1e-200, 1e-200, 1e-200, 1e-200};
  const auto steep = NurbsCurve::create(spec_of(3, 1, {1, -1, 1, 0}, short_knots));
  ASSERT_TRUE(steep);
  const auto few = derivatives_at(*steep, 0, 5);
  EXPECT_EQ(few[0], 1);
  EXPECT_NEAR(few[1] / 1e200, -6, 1e-14);
  EXPECT_EQ(few[2], kMost) << "24e400";
  EXPECT_EQ(few[3], -kMost) << "-42e600";
  EXPECT_EQ(few[4], 0);
  EXPECT_EQ(few[5], 0);
  EXPECT_TRUE(std::isfinite(curves::curvature(*steep, 0)));
}

// 1 / (1 + u) has the derivatives (-1)^k k! / (1 + u)^(k + 1).
TEST(NurbsCurveDerivatives, AreRightUpToTheLargestDouble) {
  const auto falling = NurbsCurve::create(spec_of(1, 1, {1, 0.5}, {}, {1, 2}));
  ASSERT_TRUE(falling);
  const auto rows = derivatives_at(*falling, 0, 180);
  double factorial = 1;
  for (int k = 1; k <= 170; ++k) {
    factorial *= k;
    EXPECT_NEAR(rows[index_of(k)] / factorial, k % 2 == 0 ? 1 : -1, 1e-13) << k;
  }
  EXPECT_EQ(rows[171], -std::numeric_limits<double>::max()) << "171! is above all doubles";
}

// ---- published examples ----------------------------------------------------------------------

// The NURBS Book, 2nd ed., example 2.3: p = 2, u = 5/2.
TEST(NurbsCurvePublished, BookExample23SpansAndBasis) {
  const std::vector<double> knots = {0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5};
  EXPECT_EQ(curves::find_span(knots, 2, 2.5, Side::right), 4);
  EXPECT_EQ(curves::find_span(knots, 2, 1.0, Side::right), 3);
  EXPECT_EQ(curves::find_span(knots, 2, 4.9, Side::right), 7);
  EXPECT_EQ(curves::find_span(knots, 2, 5.0, Side::right), 7);
  double basis[3];
  curves::basis_functions(knots, 2, 4, 2.5, basis);
  EXPECT_THAT(basis, ElementsAre(1.0 / 8, 6.0 / 8, 1.0 / 8));
  // The derivatives of N_{i,2} are those of the curve whose only non-zero point is i.
  const double first[] = {-0.5, 0, 0.5}, second[] = {1, -2, 1};
  for (int i = 2; i <= 4; ++i) {
    std::vector<double> points(8, 0.0);
    points[std::size_t(i)] = 1;
    const auto d = derivatives_at(made(spec_of(2, 1, points, knots)), 2.5, 2);
    EXPECT_EQ(d[1], first[i - 2]);
    EXPECT_EQ(d[2], second[i - 2]);
  }
}

// The NURBS Book, 2nd ed., example 4.1.
TEST(NurbsCurvePublished, BookExample41Point) {
  const NurbsCurve curve = made(
      spec_of(2, 2, {0, 0, 1, 1, 3, 2, 4, 1, 5, -1}, {0, 0, 0, 1, 2, 3, 3, 3}, {1, 4, 1, 1, 1}));
  EXPECT_THAT(at(curve, 1.0), ElementsAre(7.0 / 5, 6.0 / 5));
}

// The NURBS Book, 2nd ed., example 4.2: a quarter of the unit circle.
TEST(NurbsCurvePublished, BookExample42RationalDerivatives) {
  const NurbsCurve arc = made(spec_of(2, 2, {1, 0, 1, 1, 0, 1}, {}, {1, 1, 2}));
  EXPECT_THAT(derivatives_at(arc, 0.0, 2), ElementsAre(1, 0, 0, 2, -4, 0));
  EXPECT_THAT(at(arc, 0.5), ElementsAre(3.0 / 5, 4.0 / 5));
}

// geomdl, tests/test_curve.py; to 17 digits by exact rationals.
TEST(NurbsCurvePublished, GeomdlCurves) {
  const std::vector<double> points = {5, 5, 10, 10, 20, 15, 35, 15, 45, 10, 50, 5};
  const std::vector<double> knots = {0, 0, 0, 0, 0.33, 0.66, 1, 1, 1, 1};
  const auto plain = at(made(spec_of(3, 2, points, knots)), 0.3);
  EXPECT_NEAR(plain[0], 18.617580766341096, 4 * ulp_of(50));
  EXPECT_NEAR(plain[1], 13.377160030052591, 4 * ulp_of(50));
  const auto rational = at(made(spec_of(3, 2, points, knots, {.5, 1, .75, 1, .25, 1})), 0.2);
  EXPECT_NEAR(rational[0], 13.818197581852862, 4 * ulp_of(50));
  EXPECT_NEAR(rational[1], 11.510396141053329, 4 * ulp_of(50));
}

// tinyspline, test/c/eval.c; the values are -803/600, 173/600, -353/750, 232/375, -31/48, 31/48.
TEST(NurbsCurvePublished, TinysplineCurve) {
  const NurbsCurve curve =
      made(spec_of(3, 2, {-1.75, -1, -1.5, -.5, -1.5, 0, -1.25, .5, -.75, .75, 0, .5, .5, 0}, {}));
  const double ulp = ulp_of(1.75);
  EXPECT_NEAR(at(curve, .4)[0], -803.0 / 600, 4 * ulp);
  EXPECT_NEAR(at(curve, .4)[1], 173.0 / 600, 4 * ulp);
  EXPECT_NEAR(at(curve, .8)[0], -353.0 / 750, 4 * ulp);
  EXPECT_NEAR(at(curve, .8)[1], 232.0 / 375, 4 * ulp);
  EXPECT_THAT(at(curve, .75), ElementsAre(-31.0 / 48, 31.0 / 48));
}

// Octave's nurbs package, basisfun.m: degree 2, knots 0 0 0 1/2 1 1 1, ten parameters.
TEST(NurbsCurvePublished, OctaveBasisTable) {
  const std::vector<double> knots = {0, 0, 0, 0.5, 1, 1, 1};
  const double table[10][4] = {{1.00000, 0.00000, 0.00000, 0}, {0.60494, 0.37037, 0.02469, 0},
                               {0.30864, 0.59259, 0.09877, 0}, {0.11111, 0.66667, 0.22222, 0},
                               {0.01235, 0.59259, 0.39506, 0}, {0, 0.39506, 0.59259, 0.01235},
                               {0, 0.22222, 0.66667, 0.11111}, {0, 0.09877, 0.59259, 0.30864},
                               {0, 0.02469, 0.37037, 0.60494}, {0, 0.00000, 0.00000, 1.00000}};
  for (int i = 0; i < 10; ++i) {
    const double u = i / 9.0;
    const int span = curves::find_span(knots, 2, u, Side::right);
    double basis[3];
    curves::basis_functions(knots, 2, span, u, basis);
    for (int r = 0; r <= 2; ++r) EXPECT_NEAR(basis[r], table[i][span - 2 + r], 6e-6) << u;
  }
}

// ---- faults that other libraries had ---------------------------------------------------------

TEST(NurbsCurveRegression, SpansAtMultipleAndLastKnotsHaveALength) {
  const std::vector<double> knots = {0, 0, 0, 1, 1, 2, 3, 3, 3};
  EXPECT_EQ(curves::find_span(knots, 2, 1.0, Side::right), 4);
  EXPECT_EQ(curves::find_span(knots, 2, 1.0, Side::left), 2);
  EXPECT_EQ(curves::find_span(knots, 2, 3.0, Side::right), 5);
  EXPECT_EQ(curves::find_span(knots, 2, 3.0, Side::left), 5);
  EXPECT_EQ(curves::find_span(knots, 2, 0.0, Side::left), 2);
  Dice dice(support::test_seed());
  for (int round = 0; round < 20000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const auto k = curve.knots();
    const double u = random_parameter(dice, curve);
    for (const Side side : {Side::left, Side::right}) {
      const int i = curves::find_span(k, curve.degree(), u, side);
      ASSERT_GE(i, curve.degree());
      ASSERT_LT(i, curve.point_count());
      ASSERT_LT(k[std::size_t(i)], k[std::size_t(i) + 1]);
      const double inside = std::clamp(u, curve.u_min(), curve.u_max());
      ASSERT_LE(k[std::size_t(i)], inside);
      ASSERT_GE(k[std::size_t(i) + 1], inside);
    }
  }
}

TEST(NurbsCurveRegression, KnotsNearerThanAnAbsoluteEpsilonStayApart) {
  // A step 1e-9 wide is a step, not a jump: halfway it is halfway.
  const double a = 0.5, b = 0.5 + 1e-9;
  const NurbsCurve step = made(spec_of(1, 1, {0, 0, 1, 1}, {0, 0, a, b, 1, 1}));
  EXPECT_EQ(at(step, a)[0], 0.0);
  EXPECT_EQ(at(step, b)[0], 1.0);
  EXPECT_NEAR(at(step, 0.5 * (a + b))[0], 0.5, 1e-6);
  const auto slope = derivatives_at(step, a, 1);
  EXPECT_NEAR(slope[1] * (b - a), 1.0, 1e-15);
}

TEST(NurbsCurveRegression, RationalDerivativesAreNotThoseOfTheControlPoints) {
  // x^2 + y^2 = 1 along the arc: x x' + y y' = 0 and x x'' + y y'' + x'^2 + y'^2 = 0.
  const NurbsCurve arc = made(spec_of(2, 2, {1, 0, 1, 1, 0, 1}, {}, {1, 1, 2}));
  for (double u = 0; u <= 1; u += 1.0 / 64) {
    const auto d = derivatives_at(arc, u, 2);
    EXPECT_NEAR(d[0] * d[0] + d[1] * d[1], 1, 4e-16);
    EXPECT_NEAR(d[0] * d[2] + d[1] * d[3], 0, 1e-15);
    EXPECT_NEAR(d[0] * d[4] + d[1] * d[5] + d[2] * d[2] + d[3] * d[3], 0, 1e-14);
  }
}

TEST(NurbsCurveRegression, TwoThreadsEvaluateOneCurve) {
  Dice dice(support::test_seed());
  const NurbsCurve curve = random_curve(dice, 15);
  const auto sweep = [&curve] {
    std::vector<double> values;
    for (int i = 0; i <= 2000; ++i) {
      const auto d = derivatives_at(curve, curve.u_min() + i * 5e-4, 3);
      values.insert(values.end(), d.begin(), d.end());
    }
    return values;
  };
  const std::vector<double> alone = sweep();
  std::vector<double> together[2];
  std::thread other([&] { together[0] = sweep(); });
  together[1] = sweep();
  other.join();
  EXPECT_EQ(together[0], alone);
  EXPECT_EQ(together[1], alone);
}

TEST(NurbsCurveRegression, ClampedCurveEndsExactlyAtItsEndPoints) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 3000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    if (!curve.is_clamped()) continue;
    const auto first = curve.points().first(std::size_t(curve.dim()));
    const auto last = curve.points().last(std::size_t(curve.dim()));
    EXPECT_THAT(at(curve, curve.u_min()), testing::ElementsAreArray(first));
    EXPECT_THAT(at(curve, curve.u_max()), testing::ElementsAreArray(last));
  }
}

// ---- definitions -----------------------------------------------------------------------------

TEST(NurbsCurve, ParametersOutsideAreClampedAndNanIsTheStart) {
  const NurbsCurve curve = made(spec_of(2, 1, {3, 5, 4, 7}, {}));
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(at(curve, -1)[0], 3);
  EXPECT_EQ(at(curve, 2)[0], 7);
  EXPECT_EQ(at(curve, -infinity)[0], 3);
  EXPECT_EQ(at(curve, infinity)[0], 7);
  EXPECT_EQ(at(curve, std::nan(""))[0], 3);
}

TEST(NurbsCurve, PeriodicCurveWraps) {
  CurveSpec spec = spec_of(3, 1, {0, 1, 4, 2, -3}, {});
  spec.periodic = true;
  const NurbsCurve wave = made(spec);
  EXPECT_EQ(at(wave, 1.0), at(wave, 0.0));
  EXPECT_EQ(at(wave, 3.25), at(wave, 0.25));
  EXPECT_EQ(at(wave, -0.75), at(wave, 0.25));
  EXPECT_EQ(at(wave, -1e-300), at(wave, 0.0));
  EXPECT_EQ(at(wave, 1e300).size(), 1u);
  EXPECT_EQ(at(wave, std::numeric_limits<double>::infinity()), at(wave, 0.0));
  // C2 across the seam: from the left of 0 is from the left of 1.
  const auto before = derivatives_at(wave, 0.0, 3, Side::left);
  const auto after = derivatives_at(wave, 1.0, 3, Side::right);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(before[k], after[k], 1e-13 * std::pow(25, k));
  EXPECT_GT(std::abs(before[3] - after[3]), 1);
  EXPECT_EQ(before, derivatives_at(wave, 1.0, 3, Side::left));
}

TEST(NurbsCurve, JumpHasALeftAndARightValue) {
  CurveSpec spec = spec_of(1, 1, {0, 1, -1, 0}, {0, 0, 0.5, 0.5, 1, 1});
  spec.jumps = {0.5};
  const NurbsCurve saw = made(spec);
  EXPECT_EQ(at(saw, 0.5, Side::left)[0], 1);
  EXPECT_EQ(at(saw, 0.5, Side::right)[0], -1);
  EXPECT_EQ(derivatives_at(saw, 0.5, 1, Side::left)[1], 2);
  EXPECT_EQ(derivatives_at(saw, 0.5, 1, Side::right)[1], 2);
  EXPECT_EQ(at(saw, 1.0, Side::right)[0], 0);
}

TEST(NurbsCurve, KnotOfMultiplicityPIsACornerThroughItsPoint) {
  const NurbsCurve corner =
      made(spec_of(3, 1, {0, 1, 2, 5, 2, 1, 0}, {0, 0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1, 1}));
  EXPECT_EQ(at(corner, 0.5, Side::left)[0], 5);
  EXPECT_EQ(at(corner, 0.5, Side::right)[0], 5);
  EXPECT_EQ(derivatives_at(corner, 0.5, 1, Side::left)[1], 18);
  EXPECT_EQ(derivatives_at(corner, 0.5, 1, Side::right)[1], -18);
}

TEST(NurbsCurve, PlainCurveHasNoDerivativesAboveItsDegreeARationalOneHas) {
  EXPECT_THAT(derivatives_at(made(spec_of(1, 1, {1, 3}, {})), 0.25, 4),
              ElementsAre(1.5, 2, 0, 0, 0));
  // u / (2 - u): k-th derivative 2 k! / (2 - u)^(k+1). As a degree-1 rational: weights 1 and 1/2.
  const auto bend = derivatives_at(made(spec_of(1, 1, {0, 1}, {}, {1, 0.5})), 0.5, 20);
  double expected = 2 / 1.5;
  for (int k = 1; k <= 20; ++k) {
    expected *= k / 1.5;
    EXPECT_NEAR(bend[std::size_t(k)] / expected, 1, 1e-14) << k;
  }
}

TEST(NurbsCurve, BasisFunctionsSumToOneAndAreNotNegative) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 5000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    const int span = curves::find_span(curve.knots(), curve.degree(), u, Side::right);
    double basis[curves::kMaxDegree + 1], sum = 0;
    curves::basis_functions(curve.knots(), curve.degree(), span, u, basis);
    for (int r = 0; r <= curve.degree(); ++r) {
      EXPECT_GE(basis[r], 0);
      sum += basis[r];
    }
    EXPECT_NEAR(sum, 1, 16 * 0x1p-53);
  }
}

TEST(NurbsCurve, StaysInTheHullOfThePointsOfItsSpan) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 5000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = random_parameter(dice, curve);
    const auto value = at(curve, u);
    for (int c = 0; c < curve.dim(); ++c) {
      double low = 1e9, high = -1e9;
      for (int i = 0; i < curve.point_count(); ++i) {
        const double x = curve.points()[index_of(i * curve.dim() + c)];
        low = std::min(low, x);
        high = std::max(high, x);
      }
      EXPECT_GE(value[std::size_t(c)], low);
      EXPECT_LE(value[std::size_t(c)], high);
    }
  }
}

// Products of numbers this small have no lower halves any more.
TEST(NurbsCurve, StaysInTheHullOfTheSmallestNumbersThereAre) {
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  CurveSpec spec = spec_of(1, 2, {1, -7 * kLeast, 1, -7 * kLeast, 1, -7 * kLeast}, {});
  for (const auto& weights : {std::vector<double>(), std::vector<double>{1, 3, 0.7}}) {
    spec.weights = weights;
    const NurbsCurve curve = made(spec);
    for (double u = 0; u <= 1; u += 0.015625) EXPECT_EQ(at(curve, u)[1], -7 * kLeast);
  }
}

TEST(NurbsCurve, MovingAndScalingThePointsMovesAndScalesTheCurve) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 2000; ++round) {
    CurveSpec spec = random_spec(dice);
    for (double& x : spec.points) x = dice.between(-1, 1);
    CurveSpec moved = spec;
    for (double& x : moved.points) x = 3 * x + 7;
    const NurbsCurve a = made(spec), b = made(moved);
    const double u = random_parameter(dice, a);
    for (int c = 0; c < a.dim(); ++c) {
      EXPECT_NEAR(3 * at(a, u)[std::size_t(c)] + 7, at(b, u)[std::size_t(c)], 4 * ulp_of(10));
    }
  }
}

TEST(NurbsCurve, DerivativeIsTheSlope) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 500; ++round) {
    CurveSpec spec = random_spec(dice, 2 + round % 6);
    spec.knots.clear();
    for (double& x : spec.points) x = dice.between(-1, 1);
    for (double& w : spec.weights) w = dice.between(0.5, 2);
    const NurbsCurve curve = made(spec);
    const double u = dice.between(0.01, 0.99), h = 1e-5;
    const auto d = derivatives_at(curve, u, 1);
    for (std::size_t c = 0; c < std::size_t(curve.dim()); ++c) {
      const double slope = (at(curve, u + h)[c] - at(curve, u - h)[c]) / (2 * h);
      // A knot in between costs the central difference an order: |C''| h, |C''| below 2e5.
      EXPECT_NEAR(d[std::size_t(curve.dim()) + c], slope, spec.degree == 2 ? 0.05 : 1e-3);
    }
  }
}

TEST(NurbsCurve, ValueOfDerivativesIsEvaluateToTheBit) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 1000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = random_parameter(dice, curve);
    const auto d = derivatives_at(curve, u, 2);
    EXPECT_EQ(at(curve, u), std::vector<double>(d.begin(), d.begin() + curve.dim()));
  }
}

TEST(NurbsCurve, EvaluationDoesNotAllocate) {
  Dice dice(support::test_seed());
  const NurbsCurve curve = random_curve(dice, 15);
  double out[11 * curves::kMaxDim];
  EXPECT_EQ(support::allocations_in([&] {
              curve.evaluate(0.3, out);
              curve.derivatives(0.3, 10, Side::left, out);
            }),
            0);
}

}  // namespace
}  // namespace knotwave::test

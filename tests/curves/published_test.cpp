// SPDX-License-Identifier: MIT
// Tables others published, and facts of the subject. Curves of the NURBS Book, geomdl, tinyspline
// and Octave: nurbs_curve_test.cpp; easings, Maya's among them: compile_time_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/moving_curve.h"
#include "knotwave/curves/nurbs_surface.h"

#include "curves/time_oracle.h"
#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"
#include "wide_value.h"

namespace knotwave::test {
namespace {

using base::index_of;
using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

NurbsCurve path(int degree, std::vector<double> points) {
  CurveSpec spec = spec_of(degree, std::move(points));
  spec.dim = 2;
  return made(std::move(spec));
}

// AOMedia, iamf-tools, iamf/obu/tests/parameter_block_test.cc: gains in Q7.8 along a quadratic
// Bézier curve in time, its control point at relative times 192/256 and 128/256, after 50 of 100
// ticks. 293 is 293.35 cut off.
TEST(Published, IamfBezierAnimation) {
  struct Animation {
    double start, control, end, relative_time, value;
  };
  for (const auto& [start, control, end, relative_time, value] :
       {Animation{0, 384, 768, 192. / 256, 293}, Animation{200, 484, 768, 128. / 256, 484}}) {
    const NurbsCurve curve = path(2, {0, start, 100 * relative_time, control, 100, end});
    const auto program = compile_function(curve);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_EQ(std::floor(program->at_u(50) + 1e-6), value);
    EXPECT_NEAR(program->at_u(50), segment_value(curve.points(), 50), 1e-7);
    const auto moving = curves::MovingCurve::create(curve);
    ASSERT_TRUE(moving);
    EXPECT_NEAR(moving->at(50, curve.points()), program->at_u(50), 1e-7 + 0x1p-24 * 768);
  }
}

std::int64_t binomial(int n, int k) {
  std::int64_t ways = 1;
  for (int i = 0; i < k; ++i) ways = ways * (n - i) / (i + 1);
  return ways;
}

// OEIS A276321: M(n, i, j), row i of the power n - 1 - i, for (n - 1)! times the curve.
std::int64_t uniform_matrix(int n, int i, int j) {
  std::int64_t sum = 0;
  for (int m = j; m < n; ++m) {
    std::int64_t power = 1;
    for (int k = 0; k < i; ++k) power *= n - (m + 1);
    sum += power * ((m - j) % 2 == 0 ? 1 : -1) * binomial(n, m - j);
  }
  return binomial(n - 1, i) * sum;
}

TEST(Published, TheListOfUniformMatricesBeginsSo) {
  const std::int64_t list[] = {1,  -1,  1,   1,  0,   1,  -2, 1,   -2, 2, 0,   1,  1,   0,  -1,
                               3,  -3,  1,   3,  -6,  3,  0,  -3,  0,  3, 0,   1,  4,   1,  0,
                               1,  -4,  6,   -4, 1,   -4, 12, -12, 4,  0, 6,   -6, -6,  6,  0,
                               -4, -12, 12,  4,  0,   1,  11, 11,  1,  0, -1,  5,  -10, 10, -5,
                               1,  5,   -20, 30, -20, 5,  0,  -10, 20, 0, -20, 10, 0,   10};
  std::size_t at = 0;
  for (int n = 1; at < std::size(list); ++n) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n && at < std::size(list); ++j) {
        EXPECT_EQ(uniform_matrix(n, i, j), list[at++]) << n << " " << i << " " << j;
      }
    }
  }
}

// Orders 2 to 10, and on to 16: factorials and matrices are exact in doubles to order 16.
TEST(Published, UniformSplinesHaveTheMatricesOfTheList) {
  for (int n = 2; n <= 16; ++n) {
    double factorial = 1;
    for (int i = 2; i < n; ++i) factorial *= i;
    std::vector<double> knots;
    for (int i = 0; i < 2 * n; ++i) knots.push_back(i);
    for (int j = 0; j < n; ++j) {
      std::vector<double> points(index_of(n), 0.0);
      points[index_of(j)] = 1;
      const auto powers = to_power_basis(made(spec_of(n - 1, points, knots)));
      ASSERT_EQ(powers.size(), 1u);
      for (int i = 0; i < n; ++i) {
        const double exact = static_cast<double>(uniform_matrix(n, i, j)) / factorial;
        // Rounded once; a sum that cancels to nothing does so to the last of its 106 bits.
        EXPECT_NEAR(powers[0].numerator[index_of(n - 1 - i)], exact,
                    0x1p-53 * std::abs(exact) + 0x1p-88)
            << n << " " << i << " " << j;
      }
    }
  }
}

// geomdl, tests/test_surface.py: three digits, the first derivatives four.
TEST(Published, GeomdlSurface) {
  const double heights[6][6] = {{-10, -5, 0, 0, -5, -10}, {-8, -4, -4, -4, -4, -8},
                                {-5, -3, -8, -8, -3, -5}, {-3, -2, -8, -8, -2, -3},
                                {-8, -4, -4, -4, -4, -8}, {-10, -5, 2, 2, -5, -10}};
  curves::SurfaceSpec spec;
  spec.name = "geomdl";
  spec.dim = 3;
  spec.count_u = spec.count_v = 6;
  spec.knots_u = spec.knots_v = {0, 0, 0, 0, 0.33, 0.66, 1, 1, 1, 1};
  for (int v = 0; v < 6; ++v) {
    for (int u = 0; u < 6; ++u) {
      spec.points.insert(spec.points.end(), {-25. + 10 * u, -25. + 10 * v, heights[u][v]});
    }
  }
  const auto surface = curves::NurbsSurface::create(spec);
  ASSERT_TRUE(surface) << surface.error().message;
  const double table[][5] = {{0, 0, -25, -25, -10},
                             {0, 0.2, -25, -11.403, -3.385},
                             {0, 1, -25, 25, -10},
                             {0.3, 0, -7.006, -25, -5.725},
                             {0.3, 0.4, -7.006, -3.308, -6.265},
                             {0.3, 1, -7.006, 25, -5.725},
                             {0.6, 0, 3.533, -25, -4.224},
                             {0.6, 0.6, 3.533, 3.533, -6.801},
                             {0.6, 1, 3.533, 25, -4.224},
                             {1, 0, 25, -25, -10},
                             {1, 0.8, 25, 11.636, -2.751},
                             {1, 1, 25, 25, -10}};
  for (const auto& row : table) {
    double out[3];
    surface->evaluate(row[0], row[1], out);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(out[c], row[2 + c], 1e-3) << row[0] << row[1];
  }
  double partials[12];
  surface->derivatives(0, 0.25, 1, partials);
  const double published[12] = {-25,     -9.0771, -2.3972,  0, 43.6910, 17.5411,
                                90.9090, 0,       -15.0882, 0, 0,       0};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(partials[i], published[i], 1e-3) << i;
}

// ---- faults that other libraries had ---------------------------------------------------------

// A quadratic in time whose control point is all but half way: solvers that divide by what is left
// of the square term lose every digit there.
TEST(PublishedRegression, AQuadraticInTimeWithItsPointHalfWay) {
  for (const double off : {0.0, 1e-300, 1e-17, 1e-15, -1e-12, 1e-9, -1e-6, 1e-3}) {
    const NurbsCurve curve = path(2, {0, 0, 0.5 + off, 1, 1, 0});
    const auto program = compile_function(curve);
    ASSERT_TRUE(program) << program.error().message;
    const auto moving = curves::MovingCurve::create(curve);
    ASSERT_TRUE(moving);
    for (double x = 0; x <= 1; x += 0.0625) {
      const double exact = segment_value(curve.points(), x);
      EXPECT_NEAR(program->at_u(x), exact, program->max_error() + 1e-15) << off << " at " << x;
      EXPECT_NEAR(moving->at(x, curve.points()), exact, 0x1p-23) << off << " at " << x;
    }
  }
}

// A cubic in time whose cube term all but vanishes: closed forms divide by it.
TEST(PublishedRegression, ACubicInTimeWithNextToNoCube) {
  for (const double off : {0.0, 1e-17, -1e-16, 1e-14, 1e-11, -1e-8, 1e-5}) {
    const NurbsCurve curve = path(3, {0, 0, 1. / 3, 0.2 + off, 2. / 3 + off, 1, 1, 1});
    const auto program = compile_function(curve);
    ASSERT_TRUE(program) << program.error().message;
    for (double x = 0; x <= 1; x += 0.0625) {
      const double exact = segment_value(curve.points(), x);
      EXPECT_NEAR(program->at_u(x), exact, program->max_error() + 1e-15) << off;
    }
  }
}

// Newton's method from a flat start jumps about: time (1, 0, 0, 1) is flat half way.
TEST(PublishedRegression, EasingsThatRiseNeverFall) {
  for (const auto& [a, b] : {std::array{1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {0.999999, 1e-6}}) {
    const NurbsCurve curve = path(3, {0, 0, a, 0, b, 1, 1, 1});
    const auto program = compile_function(curve);
    ASSERT_TRUE(program) << program.error().message;
    double before = 0;
    for (int i = 0; i <= 20'000; ++i) {
      const double y = program->at_u(i / 20'000.0);
      EXPECT_GE(y, before - 2 * program->max_error()) << a << " " << b << " at " << i;
      before = std::max(before, y);
    }
  }
}

// ---- facts of the subject --------------------------------------------------------------------

TEST(Facts, KnotsAreAsManyAsPointsAndOrder) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 500; ++round) {
    const NurbsCurve curve = random_curve(dice);
    EXPECT_EQ(static_cast<int>(curve.knots().size()), curve.point_count() + curve.degree() + 1);
    CurveSpec spec = curve.spec();
    if (spec.periodic) continue;
    spec.knots.push_back(spec.knots.back() + 1);
    EXPECT_EQ(NurbsCurve::create(spec).error().code, ErrorCode::knot_count_mismatch);
  }
}

TEST(Facts, AsManyEqualEndKnotsAsTheOrderMakeItPassThroughItsEnds) {
  Dice dice(support::test_seed());
  int clamped = 0, open = 0;
  for (int round = 0; round < 1000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    if (curve.is_periodic()) continue;
    const double first = curve.points()[0];
    const double last = curve.points()[curve.points().size() - index_of(curve.dim())];
    const bool meets = at(curve, curve.u_min()) == first && at(curve, curve.u_max()) == last;
    if (curve.is_clamped()) {
      EXPECT_TRUE(meets);
      ++clamped;
    } else if (!meets) {
      ++open;
    }
  }
  EXPECT_GT(clamped, 300);
  EXPECT_GT(open, 50);
}

// sum of C(p, i) u^i (1 - u)^(p - i) P_i, in quadruple precision.
TEST(Facts, ABezierCurveIsTheSplineWithoutInnerKnots) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 1500; ++round) {
    const int p = 1 + round % curves::kMaxDegree;
    std::vector<double> points;
    for (int i = 0; i <= p; ++i) points.push_back(dice.between(-1, 1));
    const NurbsCurve curve = made(spec_of(p, points));
    EXPECT_EQ(to_bezier(curve).front().points, points);
    const double u = dice.unit();
    Wide sum = 0;
    for (int i = 0; i <= p; ++i) {
      Wide share = static_cast<double>(binomial(p, i));
      for (int k = 0; k < p; ++k) share *= k < i ? Wide(u) : 1 - Wide(u);
      sum += share * points[index_of(i)];
    }
    EXPECT_NEAR(at(curve, u), static_cast<double>(sum), ulp_of(1));
  }
}

TEST(Facts, AControlPointMovesOnlyItsSpans) {
  Dice dice(support::test_seed());
  int moved_places = 0;
  for (int round = 0; round < 2000; ++round) {
    const NurbsCurve curve = random_curve(dice);
    if (curve.is_periodic()) continue;
    const int i = dice.below(curve.point_count());
    CurveSpec spec = curve.spec();
    for (int c = 0; c < spec.dim; ++c) spec.points[index_of(i * spec.dim + c)] += 1;
    const NurbsCurve other = made(spec);
    const double from = curve.knots()[index_of(i)];
    const double to = curve.knots()[index_of(i + curve.degree() + 1)];
    for (int k = 0; k < 8; ++k) {
      const double u = dice.between(curve.u_min(), curve.u_max());
      if (u < from || u >= to) {
        EXPECT_EQ(at(curve, u), at(other, u));
      } else {
        moved_places += at(curve, u) != at(other, u) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(moved_places, 1000);
}

using Matrix = std::array<std::array<double, 3>, 3>;

// (x, y, w) times a matrix that keeps weights positive.
NurbsCurve mapped(const NurbsCurve& curve, const Matrix& by) {
  CurveSpec spec = curve.spec();
  const std::size_t count = spec.points.size() / 2;
  spec.weights.resize(count, 1.0);
  for (std::size_t i = 0; i < count; ++i) {
    const double w = spec.weights[i];
    const double from[3] = {w * spec.points[2 * i], w * spec.points[2 * i + 1], w};
    double to[3] = {};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) to[r] += by[r][c] * from[c];
    }
    spec.weights[i] = to[2];
    spec.points[2 * i] = to[0] / to[2];
    spec.points[2 * i + 1] = to[1] / to[2];
  }
  return made(spec);
}

// The mapped curve is the curve mapped, to the rounding of the mapped points: 8 ulp of max|P|.
void expect_to_commute(Dice& dice, bool projective) {
  for (int round = 0; round < 2000; ++round) {
    CurveSpec spec = random_spec(dice);
    const std::size_t count = spec.points.size() / index_of(spec.dim);
    spec.dim = 2;
    spec.points.resize(2 * count);
    for (double& x : spec.points) x = dice.between(-1, 1);
    for (double& w : spec.weights) w = dice.between(0.25, 4);
    const NurbsCurve curve = made(spec);
    Matrix by{};
    for (auto& row : by) {
      for (double& entry : row) entry = dice.between(-1, 1);
    }
    by[2] = {0, 0, 1};
    if (projective) by[2] = {dice.between(-0.4, 0.4), dice.between(-0.4, 0.4), 1};
    const NurbsCurve image = mapped(curve, by);
    const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
    const double x = at(curve, u), y = at(curve, u, Side::right, 1);
    const double w = by[2][0] * x + by[2][1] * y + by[2][2];
    for (std::size_t c = 0; c < 2; ++c) {
      const double want = (by[c][0] * x + by[c][1] * y + by[c][2]) / w;
      EXPECT_NEAR(at(image, u, Side::right, static_cast<int>(c)), want, 8 * ulp_of(15)) << round;
    }
  }
}

TEST(Facts, AffineMapsOfThePointsAreThoseOfTheCurve) {
  Dice dice(support::test_seed());
  expect_to_commute(dice, false);
}

TEST(Facts, ProjectiveMapsOfTheHomogeneousPointsAreThoseOfTheCurve) {
  Dice dice(support::test_seed());
  expect_to_commute(dice, true);
}

}  // namespace
}  // namespace knotwave::test

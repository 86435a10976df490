// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"

#include "random_surface.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::Side;
using curves::SurfaceSpec;

using base::index_of;

NurbsSurface made(SurfaceSpec spec) {
  auto surface = NurbsSurface::create(std::move(spec));
  EXPECT_TRUE(surface) << (surface ? "" : surface.error().message);
  return std::move(*surface);
}

std::vector<double> at(const NurbsSurface& surface, double u, double v) {
  std::vector<double> out(std::size_t(surface.dim()));
  surface.evaluate(u, v, out);
  return out;
}

SurfaceSpec patch() {
  SurfaceSpec spec;
  spec.name = "pad";
  spec.degree_u = 2;
  spec.degree_v = 1;
  spec.count_u = 3;
  spec.count_v = 2;
  spec.points = {0, 1, 2, 3, 4, 8};
  return spec;
}

TEST(NurbsSurface, BilinearCornersAndMiddleAreExact) {
  SurfaceSpec spec = patch();
  spec.degree_u = 1;
  spec.count_u = 2;
  spec.points = {0, 1, 2, 7};
  const NurbsSurface surface = made(spec);
  EXPECT_EQ(at(surface, 0, 0)[0], 0);
  EXPECT_EQ(at(surface, 1, 0)[0], 1);
  EXPECT_EQ(at(surface, 0, 1)[0], 2);
  EXPECT_EQ(at(surface, 1, 1)[0], 7);
  EXPECT_EQ(at(surface, 0.5, 0.5)[0], 2.5);
}

// A quarter circle swept along z: x^2 + y^2 = 1 everywhere, z linear.
TEST(NurbsSurface, SweptArcKeepsItsRadius) {
  SurfaceSpec spec = patch();
  spec.dim = 3;
  spec.points = {1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 2, 1, 1, 2, 0, 1, 2};
  spec.weights = {1, 1, 2, 1, 1, 2};
  const NurbsSurface surface = made(spec);
  for (double u = 0; u <= 1; u += 0.0625) {
    for (double v = 0; v <= 1; v += 0.125) {
      const auto p = at(surface, u, v);
      EXPECT_NEAR(p[0] * p[0] + p[1] * p[1], 1, 4e-16);
      EXPECT_NEAR(p[2], 2 * v, 4e-16);
    }
  }
}

// The NURBS Book, 2nd ed., example 4.3: S(5/2, 1) = (2, 98/27, 68/27). Its nine weighted points.
TEST(NurbsSurface, BookExample43) {
  constexpr double kWeighted[3][3][4] = {{{0, 2, 4, 1}, {0, 6, 4, 2}, {0, 2, 0, 1}},
                                         {{4, 6, 8, 2}, {12, 24, 12, 6}, {4, 6, 0, 2}},
                                         {{4, 2, 4, 1}, {8, 6, 4, 2}, {4, 2, 0, 1}}};
  SurfaceSpec spec;
  spec.degree_u = spec.degree_v = 2;
  spec.dim = 3;
  spec.count_u = 8;
  spec.count_v = 5;
  spec.knots_u = {0, 0, 0, 1, 2, 3, 4, 4, 5, 5, 5};
  spec.knots_v = {0, 0, 0, 1, 2, 3, 3, 3};
  spec.points.resize(8 * 5 * 3, 7.0);
  spec.weights.resize(8 * 5, 1.0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t place = (j + 1) * 8 + i + 2;
      const double weight = kWeighted[i][j][3];
      spec.weights[place] = weight;
      for (std::size_t c = 0; c < 3; ++c) spec.points[place * 3 + c] = kWeighted[i][j][c] / weight;
    }
  }
  EXPECT_THAT(at(made(spec), 2.5, 1), testing::ElementsAre(2, 98.0 / 27, 68.0 / 27));
}

TEST(NurbsSurface, IsoCurvesAreTheSurfaceWithin4Ulp) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 500; ++round) {
    const NurbsSurface surface = made(random_surface_spec(dice));
    const double u = dice.between(surface.u_min(), surface.u_max());
    const double v = dice.between(surface.v_min(), surface.v_max());
    const NurbsCurve row = surface.iso_curve_at_v(v), column = surface.iso_curve_at_u(u);
    EXPECT_EQ(row.is_periodic(), surface.is_periodic_u());
    double a[3], b[3];
    row.evaluate(u, a);
    column.evaluate(v, b);
    const auto value = at(surface, u, v);
    for (std::size_t c = 0; c < value.size(); ++c) {
      EXPECT_NEAR(a[c], value[c], 4 * ulp_of(1));
      EXPECT_NEAR(b[c], value[c], 4 * ulp_of(1));
    }
  }
}

// The partial derivatives along u alone and v alone are those of the iso curves, which are judged
// by exact rationals; the mixed ones are derivatives of those, by differences.
TEST(NurbsSurface, PartialsAreThoseOfTheIsoCurves) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 300; ++round) {
    const NurbsSurface surface = made(random_surface_spec(dice));
    const double u = dice.between(surface.u_min(), surface.u_max());
    const double v = dice.between(0.1, 0.9);
    const int order = 3, dim = surface.dim();
    std::vector<double> all(index_of(16 * dim)), along(index_of(4 * dim));
    surface.derivatives(u, v, order, all);
    const auto of = [&](int k, int l, int c) { return all[index_of((k * 4 + l) * dim + c)]; };
    const auto near = [](double a, double b, double scale) {
      EXPECT_NEAR(a, b, 1e-12 * std::max(std::abs(b), scale));
    };
    surface.iso_curve_at_v(v).derivatives(u, order, Side::right, along);
    for (int k = 0; k <= order; ++k) {
      for (int c = 0; c < dim; ++c) {
        near(of(k, 0, c), along[index_of(k * dim + c)], std::pow(100, k));
      }
    }
    surface.iso_curve_at_u(u).derivatives(v, order, Side::right, along);
    for (int l = 0; l <= order; ++l) {
      for (int c = 0; c < dim; ++c) {
        near(of(0, l, c), along[index_of(l * dim + c)], std::pow(100, l));
      }
    }
    EXPECT_EQ(of(2, 2, 0), 0);  // beyond k + l <= order
  }
}

// At u = 0.5 the surface has an edge, along v at 0.25 too.
TEST(NurbsSurface, PartialsAreThoseOfTheSideAskedForInEachDirection) {
  SurfaceSpec spec = patch();
  spec.degree_u = spec.degree_v = 1;
  spec.count_u = spec.count_v = 3;
  spec.points = {0, 1, 0, 2, 7, 2, 0, 1, 0};
  spec.knots_v = {0, 0, 0.25, 1, 1};
  const NurbsSurface surface = made(spec);
  double all[4];
  const auto slopes = [&](Side side_u, Side side_v) {
    surface.derivatives(0.5, side_u, 0.25, side_v, 1, all);
    EXPECT_EQ(all[0], 7);
    return std::pair(all[2], all[1]);
  };
  EXPECT_EQ(slopes(Side::left, Side::left), std::pair(10.0, 24.0));
  EXPECT_EQ(slopes(Side::right, Side::left), std::pair(-10.0, 24.0));
  EXPECT_EQ(slopes(Side::left, Side::right), std::pair(10.0, -8.0));
  EXPECT_EQ(slopes(Side::right, Side::right), std::pair(-10.0, -8.0));
}

// The seam of a period has a corner: seen from the left it is the end, from the right the start.
TEST(NurbsSurface, PartialsHaveSidesAtTheSeamOfAPeriod) {
  SurfaceSpec spec = patch();
  spec.degree_u = 1;
  spec.periodic_u = true;
  const NurbsSurface surface = made(spec);
  double left[4], right[4], at_end[4];
  surface.derivatives(0, Side::left, 0.5, Side::right, 1, left);
  surface.derivatives(0, Side::right, 0.5, Side::right, 1, right);
  surface.derivatives(1, Side::right, 0.5, Side::right, 1, at_end);
  EXPECT_EQ(left[0], right[0]);
  EXPECT_NE(left[2], right[2]);
  EXPECT_EQ(right[2], at_end[2]);
}

TEST(NurbsSurface, PartialsBeyondAllDoublesAreTheLargestOne) {
  constexpr double kMost = std::numeric_limits<double>::max();
  SurfaceSpec spec;
  spec.degree_u = 3;
  spec.degree_v = 1;
  spec.count_u = 4;
  spec.count_v = 2;
  spec.points = {1, -1, 1, 0, 2, -2, 2, 0};  // (1 + v) times the cubic below
  spec.knots_u = {0, 0, 0, 0, 1e-200, 1e-200, 1e-200, 1e-200};
  for (const bool is_rational : {false, true}) {
    if (is_rational) spec.weights = {1, 1, 1, 1e6, 1, 1, 1, 1e6};
    const NurbsSurface surface = made(spec);
    for (const int order : {5, curves::kMaxDegree}) {
      std::vector<double> rows(index_of((order + 1) * (order + 1)));
      surface.derivatives(0, 0.5, order, rows);
      for (const double x : rows) ASSERT_TRUE(std::isfinite(x));
      const auto partial = [&](int k, int l) { return rows[index_of(k * (order + 1) + l)]; };
      EXPECT_EQ(partial(0, 0), 1.5);
      EXPECT_EQ(partial(0, 1), 1);
      EXPECT_NEAR(partial(1, 0) / 1e200, -9, 1e-14);
      EXPECT_NEAR(partial(1, 1) / 1e200, -6, 1e-14);
      EXPECT_EQ(partial(2, 0), kMost);
      EXPECT_EQ(partial(2, 1), kMost);
    }
  }
}

TEST(NurbsSurface, MixedPartialIsTheSlopeOfTheSlope) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 300; ++round) {
    SurfaceSpec spec = random_surface_spec(dice);
    spec.knots_u.clear();
    spec.knots_v.clear();
    spec.degree_v = std::max(spec.degree_v, 2);
    spec.count_v = spec.degree_v + 1;  // one span along v: differences meet no knot
    spec.points.resize(index_of(spec.count_u * spec.count_v * spec.dim), 0.5);
    if (!spec.weights.empty()) {
      spec.weights.resize(index_of(spec.count_u * spec.count_v), 1.0);
    }
    const NurbsSurface surface = made(spec);
    const double u = dice.between(0.01, 0.99), v = dice.between(0.1, 0.9), h = 1e-5;
    std::vector<double> here(index_of(9 * spec.dim)), up(here), down(here);
    surface.derivatives(u, v, 2, here);
    surface.derivatives(u, v + h, 2, up);
    surface.derivatives(u, v - h, 2, down);
    for (int c = 0; c < spec.dim; ++c) {
      const auto u_slope = index_of(3 * spec.dim + c), mixed = index_of(4 * spec.dim + c);
      EXPECT_NEAR(here[mixed], (up[u_slope] - down[u_slope]) / (2 * h), 1e-4);
    }
  }
}

TEST(NurbsSurface, ParametersAreClampedWrappedOrTheMinimum) {
  SurfaceSpec spec = patch();
  spec.periodic_u = true;
  const NurbsSurface surface = made(spec);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(at(surface, 1.25, 0.5), at(surface, 0.25, 0.5));
  EXPECT_EQ(at(surface, 0.25, 7), at(surface, 0.25, 1));
  EXPECT_EQ(at(surface, nan, nan), at(surface, 0, 0));
  EXPECT_EQ(at(made(patch()), 9, 9)[0], 8);
}

TEST(NurbsSurface, SpecOfASurfaceMakesAnEqualSurface) {
  Dice dice(support::test_seed());
  for (int round = 0; round < 300; ++round) {
    const NurbsSurface surface = made(random_surface_spec(dice));
    EXPECT_TRUE(made(surface.spec()) == surface);
  }
}

TEST(NurbsSurface, FaultsSayTheDirection) {
  const auto message = [](auto&& break_it) {
    SurfaceSpec spec = patch();
    break_it(spec);
    const auto surface = NurbsSurface::create(spec);
    return surface ? std::string("none") : surface.error().message;
  };
  EXPECT_EQ(message([](SurfaceSpec& s) { s.degree_v = 16; }),
            "surface 'pad' along v: degree 16 is outside 1..15");
  EXPECT_EQ(message([](SurfaceSpec& s) { s.degree_u = 3; }),
            "surface 'pad' along u: 3 points, degree 3 needs at least 4");
  EXPECT_EQ(message([](SurfaceSpec& s) {
              s.knots_v = {0, 0, 1};
            }),
            "surface 'pad' along v: 3 knots, expected 4 (points + degree + 1)");
  EXPECT_EQ(message([](SurfaceSpec& s) { s.points.pop_back(); }),
            "surface 'pad': 5 numbers, 2 rows of 3 points with 1 coordinate are 6");
  EXPECT_EQ(message([](SurfaceSpec& s) {
              s.weights = {1, 1};
            }),
            "surface 'pad': 2 weights for 6 points");
  EXPECT_EQ(message([](SurfaceSpec& s) { s.points[4] = 1e7; }),
            "surface 'pad': point 4 (1e+07) is outside -1e+06..1e+06");
}

}  // namespace
}  // namespace knotwave::test

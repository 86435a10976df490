// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_curve.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

namespace knotwave::curves {
namespace {

NurbsCurve made(CurveSpec spec) {
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

CurveSpec plane_curve(int degree, std::vector<double> points, std::vector<double> weights,
                      std::vector<double> knots) {
  CurveSpec spec;
  spec.name = "example";
  spec.degree = degree;
  spec.dim = 2;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  spec.knots = std::move(knots);
  return spec;
}

// The NURBS Book, 2nd ed., example 4.1.
TEST(NurbsCurve, BookExample41IsExact) {
  const NurbsCurve curve = made(
      plane_curve(2, {0, 0, 1, 1, 3, 2, 4, 1, 5, -1}, {1, 4, 1, 1, 1}, {0, 0, 0, 1, 2, 3, 3, 3}));
  double xy[2];
  curve.evaluate(1.0, xy);
  EXPECT_EQ(xy[0], 7.0 / 5.0);
  EXPECT_EQ(xy[1], 6.0 / 5.0);
}

// The NURBS Book, 2nd ed., example 4.2: a quarter of the unit circle.
TEST(NurbsCurve, BookExample42HasExactDerivatives) {
  const NurbsCurve arc = made(plane_curve(2, {1, 0, 1, 1, 0, 1}, {1, 1, 2}, {}));
  double d[6];
  arc.derivatives(0.0, 2, Side::right, d);
  EXPECT_EQ(d[2], 0.0);
  EXPECT_EQ(d[3], 2.0);
  EXPECT_EQ(d[4], -4.0);
  EXPECT_EQ(d[5], 0.0);
  double xy[2];
  arc.evaluate(0.5, xy);
  EXPECT_EQ(xy[0], 3.0 / 5.0);
  EXPECT_EQ(xy[1], 4.0 / 5.0);
}

}  // namespace
}  // namespace knotwave::curves

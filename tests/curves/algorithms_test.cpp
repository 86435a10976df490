// SPDX-License-Identifier: MIT
#include "knotwave/curves/algorithms.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace knotwave::curves {
namespace {

// The NURBS Book, 2nd ed., example 5.1: inserting u = 2 blends P3..P5.
TEST(Algorithms, BookExample51IsExact) {
  CurveSpec spec;
  spec.degree = 3;
  spec.points = {0, 3, 1, 6, 12, 24, 9, 5};
  spec.knots = {0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5};
  const NurbsCurve curve = *NurbsCurve::create(spec);
  const auto finer = insert_knot(curve, 2.0);
  ASSERT_TRUE(finer);
  const std::vector<double> expected = {
      0, 3, 1, 2.0 / 3 * 6 + 1.0 / 3 * 1, 1.0 / 3 * 12 + 2.0 / 3 * 6, 12, 24, 9, 5};
  EXPECT_EQ(std::vector<double>(finer->points().begin(), finer->points().end()), expected);
}

TEST(Algorithms, EditsKeepTheCurve) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 200; ++round) {
    CurveSpec spec;
    spec.degree = 1 + round % 15;
    spec.dim = 1 + round % 4;
    spec.periodic = round % 3 == 0;
    const int n = spec.degree + 1 + round % 7;
    for (int i = 0; i < n * spec.dim; ++i) spec.points.push_back(2 * unit(random) - 1);
    if (round % 2 == 0) {
      for (int i = 0; i < n; ++i) spec.weights.push_back(0.01 + unit(random));
    }
    const NurbsCurve curve = *NurbsCurve::create(spec);
    const auto inserted = insert_knot(curve, 0.37);
    ASSERT_TRUE(inserted) << inserted.error().message;
    const auto part = sub_curve(curve, 0.2, 0.9);
    ASSERT_TRUE(part) << part.error().message;
    const auto segments = to_bezier(curve);
    const auto raised = spec.degree < kMaxDegree ? elevate_degree(curve) : curve;
    ASSERT_TRUE(raised) << raised.error().message;
    for (double u = 0.2; u < 0.9; u += 0.01) {
      double a[4], b[4], c[4], d[4], e[4];
      curve.evaluate(u, a);
      inserted->evaluate(u, b);
      part->evaluate(u, c);
      de_boor(curve, u, d);
      double f[4];
      raised->evaluate(u, f);
      for (const BezierSegment& s : segments) {
        if (u >= s.u0 && u <= s.u1) de_casteljau(s, u, e);
      }
      for (int i = 0; i < spec.dim; ++i) {
        EXPECT_NEAR(a[i], b[i], 4e-16) << round;
        EXPECT_NEAR(a[i], c[i], 4e-16) << round;
        EXPECT_EQ(a[i], d[i]) << round;
        EXPECT_NEAR(a[i], f[i], 4e-16) << round;
        EXPECT_NEAR(a[i], e[i], 4e-16) << round;
      }
    }
  }
}

}  // namespace
}  // namespace knotwave::curves

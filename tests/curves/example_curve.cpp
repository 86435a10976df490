// SPDX-License-Identifier: MIT
#include "example_curve.h"

#include <gtest/gtest.h>

namespace knotwave::test {

using curves::CurveSpec;
using curves::NurbsCurve;

NurbsCurve made(CurveSpec spec) {
  if (spec.name.empty()) spec.name = "example";
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

CurveSpec spec_of(int degree, std::vector<double> points, std::vector<double> knots,
                  std::vector<double> weights) {
  CurveSpec spec;
  spec.degree = degree;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.weights = std::move(weights);
  return spec;
}

NurbsCurve scalar(int degree, std::vector<double> points, std::vector<double> knots,
                  std::vector<double> jumps) {
  CurveSpec spec = spec_of(degree, std::move(points), std::move(knots));
  spec.jumps = std::move(jumps);
  return made(std::move(spec));
}

CurveSpec saw() {
  CurveSpec spec = spec_of(1, {0, 1, -1, 0.5}, {0, 0, 0.25, 0.25, 1, 1});
  spec.jumps = {0.25};
  return spec;
}

double at(const NurbsCurve& curve, double u, curves::Side side, int coordinate) {
  double out[curves::kMaxDim];
  curve.evaluate(u, side, out);
  return out[coordinate];
}

}  // namespace knotwave::test

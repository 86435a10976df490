// SPDX-License-Identifier: MIT
// Random curves for property tests: a pure function of (seed, index).
#pragma once
#include <algorithm>
#include <vector>

#include "knotwave/base/random.h"
#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_curve.h"

#include "curves/example_curve.h"

namespace knotwave::curves::testing {

/// Draws in order from one stream.
struct Draws {
  base::RandomStream stream;
  std::uint64_t next = 0;

  Draws(std::uint64_t seed, int index) { stream.seed = seed * 1000003 + std::uint64_t(index); }
  double unit() { return stream.unit(next++); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int whole(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }
  bool chance(double p) { return unit() < p; }
};

using test::made;

inline NurbsCurve line(std::vector<double> points, int degree) {
  CurveSpec spec;
  spec.name = "example";
  spec.degree = degree;
  spec.points = std::move(points);
  return made(std::move(spec));
}

inline NurbsCurve rational(std::vector<double> points, std::vector<double> weights, int degree) {
  CurveSpec spec;
  spec.name = "example";
  spec.degree = degree;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  return made(std::move(spec));
}

struct RandomCurveOptions {
  int min_degree = 1;
  int max_degree = kMaxPieceDegree;
  int dim = 1;
  bool periodic = true;  ///< allowed
  bool rational = true;  ///< allowed
};

/// Knots clamped, unclamped or periodic, with multiplicities; points in -1..1.
inline NurbsCurve random_curve(Draws& draw, const RandomCurveOptions& options = {}) {
  CurveSpec spec;
  spec.name = "random";
  spec.degree = draw.whole(options.min_degree, options.max_degree);
  spec.dim = options.dim;
  spec.periodic = options.periodic && draw.chance(0.25);
  const int n = spec.degree + 1 + draw.whole(0, 9);
  for (int i = 0; i < n * spec.dim; ++i) spec.points.push_back(draw.between(-1, 1));
  if (options.rational && draw.chance(0.5)) {
    for (int i = 0; i < n; ++i) spec.weights.push_back(draw.between(0.2, 4));
  }
  double u = draw.between(-2, 2);
  if (spec.periodic) {
    for (int i = 0; i <= n; ++i, u += draw.between(0.1, 1)) spec.knots.push_back(u);
    return made(std::move(spec));
  }
  const bool clamped = draw.chance(0.8);
  const int inner = n - spec.degree - 1;
  if (!clamped) {
    for (int i = 0; i <= n + spec.degree; ++i, u += draw.between(0.1, 1)) spec.knots.push_back(u);
    return made(std::move(spec));
  }
  spec.knots.assign(static_cast<std::size_t>(spec.degree) + 1, u);
  for (int i = 0; i < inner; ++i) {
    // Now and then the same knot again, never more than `degree` times.
    const auto same = std::count(spec.knots.begin() + spec.degree + 1, spec.knots.end(), u);
    if (i == 0 || !draw.chance(0.2) || same >= spec.degree) u += draw.between(0.05, 1);
    spec.knots.push_back(u);
  }
  u += draw.between(0.05, 1);
  spec.knots.insert(spec.knots.end(), static_cast<std::size_t>(spec.degree) + 1, u);
  return made(std::move(spec));
}

}  // namespace knotwave::curves::testing

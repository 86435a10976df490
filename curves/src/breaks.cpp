// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/analysis.h"

#include "span_basis.h"

namespace knotwave::curves {
namespace {

using base::index_of;

/// What derivative k of a curve with control points up to 1 can be at most at u, for k up to
/// `max_order`: with s_k the sum of the basis functions' |k-th derivatives|, each with its share of
/// the weight, the quotient rule gives b_k <= s_k + sum over i of binomial(k, i) s_i b_{k-i}.
std::vector<double> largest_derivatives(const NurbsCurve& curve, double u, Side side,
                                        int max_order) {
  const int p = curve.degree();
  const int span = find_span(curve.knots(), p, u, side);
  const SpanBasis basis(KnotSequence{curve.knots(), p, curve.is_periodic()}, span, u);
  std::vector<double> shares(index_of(max_order + 1)), bounds(index_of(max_order + 1));
  double weight = 0;
  for (int k = 0; k <= std::min(max_order, p); ++k) {
    DoubleDouble values[kMaxDegree + 1];
    basis.derivative(k, values);
    for (int r = 0; r <= p; ++r) {
      shares[index_of(k)] += std::abs(values[r].hi) * curve.weights()[index_of(span - p + r)];
    }
    if (k == 0) weight = shares[0];
    shares[index_of(k)] /= weight;
  }
  for (int k = 0; k <= max_order; ++k) {
    bounds[index_of(k)] = shares[index_of(k)];
    double binomial = 1;
    for (int i = 1; i <= std::min(k, p) && curve.is_rational(); ++i) {  // higher shares are 0
      binomial = binomial * (k - i + 1) / i;
      bounds[index_of(k)] += binomial * shares[index_of(i)] * bounds[index_of(k - i)];
    }
  }
  return bounds;
}

std::vector<double> inner_knots(const NurbsCurve& curve) {
  std::vector<double> knots;
  if (curve.is_periodic()) knots.push_back(curve.u_min());
  for (const double knot : curve.knots()) {
    const bool inside = knot > curve.u_min() && knot < curve.u_max();
    if (inside && (knots.empty() || knots.back() != knot)) knots.push_back(knot);
  }
  return knots;
}

}  // namespace

std::vector<Break> breaks_of(const NurbsCurve& curve, int max_order, int coordinate) {
  std::vector<Break> breaks;
  if (max_order < 0) return breaks;
  // All derivatives above the degree are 0 without weights.
  max_order = std::min(max_order, curve.is_rational() ? kMaxBreakOrder : curve.degree());
  const HullRange hull = hull_range(curve, coordinate);
  const double noise = 0x1p-50 * std::max(std::abs(hull.low), std::abs(hull.high));
  const int dim = curve.dim();
  std::vector<double> left(index_of((max_order + 1) * dim)), right = left;
  for (const double u : inner_knots(curve)) {
    const double from_left = curve.is_periodic() && u == curve.u_min() ? curve.u_max() : u;
    curve.derivatives(u, max_order, Side::left, left);
    curve.derivatives(u, max_order, Side::right, right);
    const auto below = largest_derivatives(curve, from_left, Side::left, max_order);
    const auto above = largest_derivatives(curve, u, Side::right, max_order);
    for (int k = 0; k <= max_order; ++k) {
      const auto at = index_of(k * dim + coordinate);
      constexpr double kMost = std::numeric_limits<double>::max();
      const double size = std::clamp(right[at] - left[at], -kMost, kMost);
      // Not so either where the bounds are no numbers any more.
      if (!(std::abs(size) > noise * (below[index_of(k)] + above[index_of(k)]))) continue;
      breaks.push_back({u, k, size});
      break;
    }
  }
  return breaks;
}

}  // namespace knotwave::curves

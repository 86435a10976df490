// SPDX-License-Identifier: MIT
// A curve as algorithms work on it: weighted points (w x, w y, ..., w) in double-double, so that a
// chain of convex blends is rounded only once, when it becomes a curve again.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "knotwave/curves/algorithms.h"

#include "double_double.h"
#include "knot_domain.h"

namespace knotwave::curves {

/// (w x0, ..., w x3, w); coordinates a curve does not have stay 0.
struct HomogeneousPoint {
  std::array<DoubleDouble, kMaxDim> x;
  DoubleDouble w = 1.0;

  HomogeneousPoint() = default;
  HomogeneousPoint(std::span<const double> point, double weight) noexcept;
  /// The point itself, rounded, to out[dim].
  void project(std::span<double> out) const noexcept;
};

/// From a to b by `from_left` of from_left + to_right, neither negative.
HomogeneousPoint blend(const HomogeneousPoint& a, const HomogeneousPoint& b, DoubleDouble from_left,
                       DoubleDouble to_right) noexcept;

struct HomogeneousCurve {
  int degree = 0;
  int dim = 0;
  KnotDomain domain;                     ///< of the curve it was made from: measures its knots
  std::vector<Knot> knots;               ///< [n+p+1]
  std::vector<HomogeneousPoint> points;  ///< [n]

  HomogeneousCurve() = default;
  explicit HomogeneousCurve(const NurbsCurve& curve);  ///< expanded if periodic

  /// The part that points [first..last] make alone.
  HomogeneousCurve points_between(int first, int last) const;
  int span_at(Knot u, Side side) const { return span_of<Knot>(knots, degree, u, side); }
  int multiplicity(Knot u) const;
  /// Boehm, u in the domain. (A5.1 once.) What a periodic curve has twice is stale then.
  void insert(Knot u);
  /// The same, and what a periodic curve has twice is written again.
  void insert_and_repeat(Knot u);
  /// The points and knots that a periodic curve has twice, written again: right are the n points
  /// from `first_true` on, and the knots of the domain.
  void repeat_period(int first_true);
  /// The part over [low, high], clamped, its knots in no period. At a jump the inner side.
  HomogeneousCurve clamped_part(double low, double high) const;
  /// Into the numbers of a spec.
  void round_to(CurveSpec& spec) const;
  /// The same as create() reads it: a periodic curve's points and knots once.
  void write_to(CurveSpec& spec) const;
};

/// Points that make span `span` a Bézier segment, to out[degree+1]. O(p^2), only convex blends: the
/// left end of the span is inserted up to p times, then the right end.
void bezier_points(const HomogeneousCurve& curve, int span,
                   std::span<HomogeneousPoint> out) noexcept;
/// The same for the part [left, right] of the span.
void bezier_points(const HomogeneousCurve& curve, int span, Knot left, Knot right,
                   std::span<HomogeneousPoint> out) noexcept;

}  // namespace knotwave::curves

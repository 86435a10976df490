// SPDX-License-Identifier: MIT
// A span of a curve with time, cut where time stands still: Bernstein coefficients that are 0 are 0
// then, and all others are right to the last bit of a double-double. Private to curves. [control]
#pragma once
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

#include "big_float.h"
#include "span_polynomial.h"

namespace knotwave::curves {

/// The span of `curve`, which is not periodic, that begins at knot u0, in 4,096 bits. Sums of
/// products only: the knot differences that de Boor's algorithm divides by are left in all
/// coordinates and the weight alike, where they cancel.
class ExactSpan {
 public:
  ExactSpan(const NurbsCurve& curve, double u0);

  /// Whether time is before x, or after x, at t of the span (0 to 1).
  bool is_before(double x, const BigFloat& t) const { return time_sign(x, t) < 0; }
  bool is_after(double x, const BigFloat& t) const { return time_sign(x, t) > 0; }
  /// Where in [low, high] of t time is x, to 2^-kPlaceBits: before x there,
  /// after x within that. Time must not be after x at low, nor before it at high.
  BigFloat place_of(double x, BigFloat low, BigFloat high) const;
  static constexpr int kPlaceBits = 112;

  /// The span from place t to its end, or to its start, over [0, 1]. Row 0 is time - origin, or
  /// origin - time towards the start, so that it never falls.
  SpanPolynomial after(const BigFloat& t, double origin) const;
  SpanPolynomial before(const BigFloat& t, double origin) const;

 private:
  using Row = std::vector<BigFloat>;  ///< by control point, [degree + 1]

  /// Row `c` of the weighted control points, time less `origin` (row dim: the weights).
  Row row(int c, double origin) const;
  int time_sign(double x, const BigFloat& t) const;
  BigFloat knot_of(const BigFloat& t) const;
  /// The blossom of a row by `count` arguments b, the others a; both are values of u.
  BigFloat blossom(Row points, const BigFloat& a, const BigFloat& b, int count) const;
  SpanPolynomial part(const BigFloat& from, const BigFloat& to, double origin, bool negated) const;

  const NurbsCurve* curve_;
  int span_ = 0;
  std::vector<BigFloat> knots_;               ///< the 2 degree knots around
  std::vector<std::vector<BigFloat>> share_;  ///< by level: what each blend is multiplied by
};

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Between curves, Bézier segments and powers, and the blossom. Segments come from to_bezier() in
// algorithms.h.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 6.6 (power basis); Ramshaw, Blossoms are polar
// forms, CAGD 6 (1989).
#pragma once
#include "knotwave/curves/algorithms.h"

namespace knotwave::curves {

/// One curve from segments that follow each other (u1 of one = u0 of the next, same degree and
/// dim). [control] Every inner knot has multiplicity p, or p + 1 (a declared jump) where the ends
/// differ by more than `join_tolerance` in any coordinate; nearer ends are joined at the point of
/// the left one. Ends within 4 ulp of max|P| of the two are always joined, as segments are rounded:
/// from_bezier(to_bezier(c)) is c, within 4 ulp of max|P|. Rational neighbours are scaled so that
/// the common weight agrees. Errors: too_few_points (no segment), dimension_mismatch,
/// degree_out_of_range (degrees differ), empty_domain, knots_decrease (a gap or overlap),
/// weight_not_positive, weight_out_of_range, not_finite, coordinate_out_of_range, too_many_points,
/// value_out_of_range (join_tolerance < 0 or not a number; a knot beyond kMaxKnot). The message
/// names the segment.
Result<NurbsCurve> from_bezier(std::span<const BezierSegment> segments, double join_tolerance = 0);

/// Polynomial or rational piece in powers of t = (u - u0) / (u1 - u0): numerators, and the
/// denominator where weights are used.
struct PowerSegment {
  double u0 = 0;
  double u1 = 1;
  int degree = 0;
  int dim = 0;
  std::vector<double> numerator;    ///< [(degree+1)*dim]: power 0 first, coordinates together
  std::vector<double> denominator;  ///< [degree+1]; empty = 1
};

/// Powers of each span of positive length (A6.1, in double-double), each rounded once: that alone
/// moves a curve without weights by up to 3^p ulp of max|P|, with weights by up to 4 * 3^p r ulp, r
/// = largest / smallest; where 3^p r > 2^52 the denominator may come out 0 or below. [control]
std::vector<PowerSegment> to_power_basis(const NurbsCurve& curve);

/// Bézier form of one piece in powers (A6.2, in double-double). [control] Errors:
/// dimension_mismatch, degree_out_of_range, weight_not_positive (the denominator in Bézier form
/// must be positive: subdividing may help), empty_domain, not_finite.
Result<BezierSegment> from_power_basis(const PowerSegment& piece);

/// The polar form of one span: f(a_1, ..., a_p), symmetric, affine in each argument, and
/// f(u, ..., u) = C(u) (of the span's polynomial, also outside the span). [any] Homogeneous: out
/// [dim+1] is (w x, ..., w). `span` as from find_span(); arguments [degree]. The p knots after knot
/// i give control point i of the span. Arguments beyond the span extrapolate, there right to 2^-70
/// of the largest weighted point. O(p^2) in double-double, no allocation.
void blossom(const NurbsCurve& curve, int span, std::span<const double> arguments,
             std::span<double> out) noexcept;

}  // namespace knotwave::curves

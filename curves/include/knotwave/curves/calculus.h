// SPDX-License-Identifier: MIT
// Slopes, areas and lengths. [control] where not said otherwise.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 3.3 (derivative curve), 4.3 (quotient rule); de
// Boor, A Practical Guide to Splines, X (antiderivative of a B-spline series); Trefethen,
// Approximation Theory and Approximation Practice, 19 (the error of Gauss quadrature). What has no
// closed form is integrated by 16-node Gauss-Legendre over parts of spans that are halved until the
// error is proved, src/quadrature.h.
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// The derivative by u as a curve, each point rounded once. Without weights: degree p - 1, over the
/// same domain, one degree less smooth at each knot: a corner becomes a declared jump between its
/// two slopes. Degree 1 gives steps, written at degree 1 with a jump at every inner knot. A
/// periodic curve without corners stays periodic; one with corners, or of degree 1, is cut open
/// first: clamped over one period, its points rounded before the slopes. With weights: (N' w - N
/// w') / w^2, degree 2p, clamped over one period, every inner knot 2p times or, where p or more
/// equal knots leave a corner, a declared jump. Errors: unsupported (a jump, where there is no
/// slope: split() there), coordinate_out_of_range (steeper than kMaxCoordinate),
/// degree_out_of_range (with weights, 2p above kMaxDegree), weight_out_of_range (squares farther
/// apart than the limits are), too_many_points.
Result<NurbsCurve> hodograph(const NurbsCurve& curve);

/// A(u) = start + integral of C from u_min to u, in every coordinate: the phase of a frequency
/// curve. Clamped, degree p + 1, one degree smoother at each knot, so a jump becomes a corner; each
/// point rounded once. A periodic curve is cut open at u_min. Errors: unsupported (weights: the
/// area of a rational curve is no rational function, compile_polynomial() first),
/// degree_out_of_range, not_finite, coordinate_out_of_range (the integral passes kMaxCoordinate).
Result<NurbsCurve> antiderivative(const NurbsCurve& curve, double start = 0);

/// Integral of a coordinate from u_a to u_b in the domain, its negative for u_b < u_a. Without
/// weights exact in the reals and rounded once; with weights right to 2^-50 max|P| |u_b - u_a|.
/// Errors: parameter_out_of_range.
Result<double> integral(const NurbsCurve& curve, double u_a, double u_b, int coordinate = 0);

/// Length of the path between u_a and u_b in either order, that of the graph (u, C(u)) for one
/// coordinate: right to 2^-50 of the length of the control polygon and 2^-90 max|P|. Jumps add no
/// length; cusps and places where the path rests are no harder than others. Errors:
/// parameter_out_of_range.
Result<double> arc_length(const NurbsCurve& curve, double u_a, double u_b);

/// The least u at which the path from u_min is `length` long: arc_length() to it is right to 2^-49
/// of the control polygon, or as near as the doubles beside u allow. Both sides of a jump are at
/// its u. Errors: parameter_out_of_range (below 0 or longer than the curve; the message has both
/// lengths).
Result<double> parameter_at_length(const NurbsCurve& curve, double length);

/// Signed curvature of a 2-D curve (left turns positive), or that of the graph (u, C(u)) of a
/// scalar one; unsigned for more coordinates. [any] The side matters at a knot. 0 where a path
/// stands still. Where derivatives are beyond all doubles it is of the right sign or 0, no more;
/// never infinite or NaN. No allocation.
double curvature(const NurbsCurve& curve, double u, Side side = Side::right) noexcept;

}  // namespace knotwave::curves

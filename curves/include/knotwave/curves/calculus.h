// SPDX-License-Identifier: MIT
// Slopes and areas. [control] Weighted curves have derivatives() and curvature(); their areas are
// no rational functions: compile_polynomial first.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 3.3 (derivative curve); de Boor, A Practical
// Guide to Splines, X (antiderivative of a B-spline series).
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// The derivative by u as a curve, each point rounded once. Degree p - 1, over the same domain, one
/// degree less smooth at each knot: a corner becomes a declared jump between its two slopes. Degree
/// 1 gives steps, written at degree 1 with a jump at every inner knot. A periodic curve without
/// corners stays periodic; one with corners, or of degree 1, is cut open first: clamped over one
/// period, its points rounded before the slopes. Errors: unsupported (weights; a jump, where there
/// is no slope: split() there), coordinate_out_of_range (steeper than kMaxCoordinate).
Result<NurbsCurve> hodograph(const NurbsCurve& curve);

/// A(u) = start + integral of C from u_min to u, in every coordinate: the phase of a frequency
/// curve. Clamped, degree p + 1, one degree smoother at each knot, so a jump becomes a corner; each
/// point rounded once. A periodic curve is cut open at u_min. Errors: unsupported (weights),
/// degree_out_of_range, not_finite, coordinate_out_of_range (the integral passes kMaxCoordinate).
Result<NurbsCurve> antiderivative(const NurbsCurve& curve, double start = 0);

/// Integral of a coordinate from u_a to u_b in the domain, its negative for u_b < u_a: exact in the
/// reals, rounded once. Errors: unsupported (weights), parameter_out_of_range.
Result<double> integral(const NurbsCurve& curve, double u_a, double u_b, int coordinate = 0);

/// Signed curvature of a 2-D curve (left turns positive), or that of the graph (u, C(u)) of a
/// scalar one; unsigned for more coordinates. [any] The side matters at a knot. 0 where a path
/// stands still. No allocation.
double curvature(const NurbsCurve& curve, double u, Side side = Side::right) noexcept;

}  // namespace knotwave::curves

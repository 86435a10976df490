// SPDX-License-Identifier: MIT
// Curves that have a name. [control]
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 7.3 to 7.5 (arcs, conics); W3C, CSS Easing
// Functions Level 1; Khronos, glTF 2.0, 3.11 (cubic spline sampler); Catmull & Rom, A class of
// local interpolating splines (1974); Yuksel, Schaefer & Keyser, CAD 43 (2011) (alpha).
#pragma once
#include <span>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Bézier curve of the points [n*dim] over [0, 1], degree n - 1: what repeated linear cross-fading
/// of n values at the same position gives. Errors: those of NurbsCurve::create.
Result<NurbsCurve> bezier(std::span<const double> points, int dim = 1);

/// Arc of a circle about (0, 0) from angle `start_cycles`, `length_cycles` long (1 = the whole
/// circle; negative: clockwise), over [0, 1], as rational quadratics of a quarter at most, equally
/// long. Radii of the curve are within 2 ulp of `radius`, quarter points exact, and a whole circle
/// ends where it begins. The angle is even at the ends of pieces, and up to 1.1 degrees ahead or
/// behind between them. Errors: value_out_of_range (radius <= 0, length 0 or above 1 in magnitude),
/// not_finite, coordinate_out_of_range.
Result<NurbsCurve> arc(double radius, double start_cycles, double length_cycles);

/// A closed ellipse about (0, 0) over [0, 1], starting at (radius_x, 0), counter-clockwise; a
/// circle where the radii are equal. Errors: as arc().
Result<NurbsCurve> ellipse(double radius_x, double radius_y);

/// Conic from p0 to p2 whose tangents meet in p1, over [0, 1], with shape factor w (w < 1 an
/// ellipse, 1 a parabola, > 1 a hyperbola). Points [2]. Errors: dimension_mismatch,
/// weight_not_positive, weight_out_of_range, not_finite, coordinate_out_of_range.
Result<NurbsCurve> conic(std::span<const double> p0, std::span<const double> p1,
                         std::span<const double> p2, double w);

/// From 1 (0 dB) to -range_db over [0, 1], straight in decibels, as one rational Bézier segment of
/// degree 4; and how far in dB it is from the straight line anywhere, rounding included (4096
/// places, and 1/1000 for what lies between).
struct FittedDecay {
  NurbsCurve curve;
  double max_error_db = 0;
};
/// The best such curve that meets both ends, by even ripples (within 1 %): 6e-9 dB off at 20 dB,
/// 0.00011 at 60, 0.0041 at 90, 0.052 at 120. All 5 points fall, weights are positive.
/// range_db 1..120. Errors: value_out_of_range.
Result<FittedDecay> exponential_decay(double range_db);

/// CSS cubic-bezier(x1, y1, x2, y2): a 2-D cubic from (0, 0) to (1, 1), x the time. Errors:
/// not_a_function (x1 or x2 outside 0..1), not_finite, coordinate_out_of_range.
Result<NurbsCurve> css_cubic_bezier(double x1, double y1, double x2, double y2);

/// Piecewise cubic through values with given slopes (Hermite; glTF CUBICSPLINE): times [n]
/// increasing, values [n*dim], slopes_in and slopes_out [n*dim] (by time; the first slope in and
/// the last slope out are not used). Over [times.front(), times.back()]. A time is a double knot
/// where both slopes are the same (C1), else a triple one (a corner). Errors: too_few_points (n <
/// 2), knots_decrease, dimension_mismatch, not_finite, and those of NurbsCurve::create.
Result<NurbsCurve> hermite(std::span<const double> times, std::span<const double> values,
                           std::span<const double> slopes_in, std::span<const double> slopes_out,
                           int dim = 1);

/// Catmull-Rom through the points [n*dim] over [0, 1], C1: the time from one point to the next is
/// its distance to the power `alpha` (0 uniform, 0.5 centripetal, 1 chordal; one scale for all),
/// the slope in a point that of the parabola through it and its neighbours. The ends of an open
/// curve take the parabola of the three points there; a closed one comes back to its first point,
/// C1. Errors: too_few_points (n < 2, closed n < 3), value_out_of_range (alpha outside 0..1),
/// knots_decrease (neighbours at the same place, alpha above 0), and as hermite().
Result<NurbsCurve> catmull_rom(std::span<const double> points, int dim, double alpha = 0.5,
                               bool closed = false);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Surfaces made from curves. [control] Curves without jumps. Points are computed in double-double
// and rounded once. Named after the first curve.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: 8.4 (ruled), 8.5 (revolved), 10.3 (skinned),
// 10.5 (Coons).
#pragma once
#include <span>

#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::curves {

/// Straight lines between the points of two curves at the same u, v from 0 (the first) to 1.
/// Curves with different weights go through homogeneous points, as morph() does: straight too, at
/// another pace. Errors: those of make_compatible(), unsupported (a jump).
Result<NurbsSurface> ruled(const NurbsCurve& first, const NurbsCurve& second);

/// Through every row, within 4 ulp of max|P| of the surface: row k is the iso curve at
/// positions[k], strictly increasing [n]. Without positions those are 0 to 1 by the square root of
/// the distance from row to row (centripetal), the mean over the columns of control points. Knots
/// by averaging, 1 <= degree_v <= n - 1. Between rows the surface may leave their range, as any
/// interpolation of degree 2 and more does; degree 1 never does. Rational rows go through
/// homogeneous points. Errors: those of make_compatible(), too_few_points, degree_out_of_range,
/// dimension_mismatch (not one position a row), not_finite, knots_decrease (positions; two rows
/// next to each other are the same and there are no positions), weight_not_positive (interpolated
/// weights fall below 0: the rows' weights differ too much), coordinate_out_of_range, unsupported
/// (a jump).
Result<NurbsSurface> lofted(std::span<const NurbsCurve> rows, int degree_v,
                            std::span<const double> positions = {});

/// A profile (x = distance from the axis, y = height) turned about the axis of height,
/// `length_cycles` far, from x to y (negative: clockwise as seen from above): dim 3, (x cos, x sin,
/// y), u around over [0, 1] at the pace of arc(), v along the profile. Distances from the axis are
/// those of the profile within 4 ulp; a whole turn ends where it begins. A periodic profile is cut
/// open. Errors: dimension_mismatch (the profile is not 2-D), value_out_of_range (length 0 or above
/// 1 in magnitude), not_finite, unsupported (a jump), weight_out_of_range.
Result<NurbsSurface> revolved(const NurbsCurve& profile, double length_cycles = 1);

/// From four corners [4*dim] in the order (0,0), (1,0), (0,1), (1,1), over [0, 1] x [0, 1]. Errors:
/// dimension_mismatch and those of NurbsSurface::create().
Result<NurbsSurface> bilinear(std::span<const double> corners, int dim = 1);

/// Coons patch (bilinearly blended) inside four border curves: bottom and top run along u, left and
/// right along v; the domains are those of bottom and left. Ends that meet within `tolerance` in
/// every coordinate are joined at those of bottom and top; the four curves are then iso curves of
/// the border, within 4 ulp of max|P|. Rational curves need equal weights at both their ends, and
/// are blended in homogeneous points. Errors: not_closed (the message has the corner and the gap),
/// unsupported (weights at the ends differ; a jump), weight_not_positive (blended weights),
/// value_out_of_range (tolerance < 0), and those of make_compatible().
Result<NurbsSurface> coons(const NurbsCurve& bottom, const NurbsCurve& top, const NurbsCurve& left,
                           const NurbsCurve& right, double tolerance = 1e-9);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Curves from and to the path data of SVG: what is drawn in Inkscape plays. [control]
// Source: W3C, SVG 2, 9.3 (path data), 9.5 (implementation notes), B.2 (elliptical arcs).
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// In SVG y grows downwards. `up`: y changes its sign on the way, so that high on the page is a
/// large value; `down`: numbers are kept.
enum class SvgY { up, down };

/// The subpaths of the attribute `d`, in order, as 2-D curves "path_1", "path_2" and so on. M L H V
/// C S Q T A Z, absolute and relative; transforms are not looked at. Segment i of a subpath is u in
/// [i, i + 1]; a Z that has a way to go back is a line. The degree is that of the highest segment
/// (line 1, quadratic 2, cubic 3); lower ones are elevated. An arc is exact: 1, 2 or 4 rational
/// quadratics of a quarter at most, each a segment; radii too small are enlarged, a radius of 0
/// (below 1e-9) is a line, an arc to where it is, nothing (B.2.5). Subpaths without a segment are
/// left out. Errors: syntax (with the byte offset), too_few_points (no segment at all),
/// coordinate_out_of_range, too_many_points.
Result<std::vector<NurbsCurve>> curves_from_svg_path(std::string_view d, SvgY y = SvgY::up);

/// Moved and stretched so that each coordinate runs from 0 (its least value) to 1 (its greatest):
/// a drawing as an envelope, an easing, a crossfade law. A coordinate that stays the same becomes
/// 0. Within 4 ulp of max|P| over the range. Errors: coordinate_out_of_range (a range so small that
/// control points outside it would pass kMaxCoordinate).
Result<NurbsCurve> in_unit_square(const NurbsCurve& curve);

/// Path data, and a bound of how far it is from the curve.
struct SvgPath {
  std::string d;
  double max_error = 0;  ///< Euclidean, at the same u; proved, rounding included
};

/// A curve as lines and cubics (M L C Z), one for each span, and more where it is rational or of
/// degree above 3, so that no point is farther than max_error from the curve's at the same u. A 2-D
/// curve is its own path; a 1-D one is drawn as value over u. Jumps begin a new subpath; a curve
/// that ends where it begins is closed by Z. Numbers are written so that they read back to the bit.
/// A circle takes 8 cubics at 1/100 of its radius and twice as many for each factor 16 below.
/// Errors: dimension_mismatch (3 or 4 coordinates), value_out_of_range (max_error not above 0),
/// error_bound_missed (4096 pieces, or halving a span 16 times, are not enough).
Result<SvgPath> svg_path_from_curve(const NurbsCurve& curve, double max_error, SvgY y = SvgY::up);

}  // namespace knotwave::curves

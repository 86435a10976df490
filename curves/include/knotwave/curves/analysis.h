// SPDX-License-Identifier: MIT
// What a curve does: its range, where it takes a value, how much it moves. [control] Both limits at
// a jump count. max|P| is the largest control point in the coordinate asked for, 0..dim-1.
// Source: convex hull and variation diminution (Piegl & Tiller, The NURBS Book, 2nd ed., 3.2, 4.2);
// each span is cut where it turns, by the sign changes of its derivative in Bernstein form.
#pragma once
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

struct Extremum {
  double u = 0;
  double value = 0;
};
struct ValueRange {
  Extremum low;
  Extremum high;
};
/// Least and greatest value of a coordinate, within half an ulp of max|P|, never outside
/// hull_range(), and where: the first of several. At a smooth turn u is right to 2^-48 of its span,
/// or to the next double (so C(u) may miss), if it bends; flatter ones are as hard to place.
ValueRange value_range(const NurbsCurve& curve, int coordinate = 0);

/// Every u, in order, where the coordinate is `value`, within 4 ulp of the largest |u| of a place
/// where a curve 1 ulp of max|P| away takes it: a touch counts once, a jump across it counts at the
/// jump. Where a whole stretch equals it, its two ends. A periodic curve that has it at the seam
/// has it at u_min. NaN: none.
std::vector<double> parameters_at(const NurbsCurve& curve, double value, int coordinate = 0);

/// Sum of all rises and falls of a coordinate over the domain, jumps included; rounded once.
double total_variation(const NurbsCurve& curve, int coordinate = 0);

/// Bounds of one span of positive length from its Bézier points: the curve leaves them by rounding
/// at most, 1 ulp of max|P|.
struct SpanHull {
  double u0 = 0, u1 = 0;
  double low = 0, high = 0;
};
std::vector<SpanHull> span_hulls(const NurbsCurve& curve, int coordinate = 0);

/// Where the curve is nearest to `point` [dim], one place where several are; all feet of
/// every span that its hull doesn't rule out are looked at, so no other span is nearer. `distance`
/// is that at `u` itself (of the nearer limit at a jump), and the doubles next to each foot are
/// tried: where they are coarse, as at u = 1e6, u is the best of them. Where the distance bends
/// upwards u is right to 2^-48 of its span or to the next double. Errors: dimension_mismatch,
/// not_finite, coordinate_out_of_range (beyond kMaxCoordinate).
struct ClosestPoint {
  double u = 0;
  double distance = 0;
};
Result<ClosestPoint> closest_point(const NurbsCurve& curve, std::span<const double> point);

inline constexpr int kMaxBreakOrder = 1000;

/// What happens at a knot: the lowest derivative that jumps, and by how much.
struct Break {
  double u = 0;
  int order = 0;    ///< 0 = the value jumps, 1 = a corner, ...
  double size = 0;  ///< right limit minus left limit of that derivative
};
/// Every inner knot, and the seam of a periodic curve (at u_min), at which a derivative up to
/// `max_order` jumps by more than moving the control points by 4 ulp of max|P| could make it: what
/// band-limited steps and ramps need. In order. A max_order above kMaxBreakOrder counts as that.
/// O(max_order p) a knot. A size beyond all doubles is the largest one with its sign.
std::vector<Break> breaks_of(const NurbsCurve& curve, int max_order, int coordinate = 0);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Time must not go back: repairing 2-D curves whose x does. [control] is_non_decreasing() in
// algorithms.h decides for every curve; cubic segments are decided exactly here.
// Source: Pixar, OpenUSD, "Regressive Splines in USD" (the ellipse a^2 + b^2 + ab - 2a - 2b + 1 = 0
// of handle lengths a, b of a segment one unit long, and what the modes do).
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Whether x of the cubic Bézier (0, a, 1 - b, 1) never goes back: exact for all doubles. That is
/// 0 <= a, b <= 1, or 0 <= a, b on or inside the ellipse, which reaches to 4/3. NaN: false.
bool is_monotone_cubic(double a, double b) noexcept;

/// What is done to handles so long that time would go back. Only contain also cuts handles that do
/// no harm.
enum class Regularization {
  none,            ///< left as they are
  contain,         ///< handles stay inside the segment: a, b <= 1
  keep_start,      ///< a is kept, b takes the nearest length that does; a above 4/3: (4/3, 1/3)
  keep_ratio,      ///< both shortened by the same factor
  limit_active,    ///< the handle being edited is shortened; where that can't help, the other is
  limit_opposite,  ///< the other one is shortened, never lengthened; then the edited one
};

/// Handle lengths as parts of the segment's time.
struct HandleLengths {
  double a = 0;  ///< of the start
  double b = 0;  ///< of the end
};
/// Handle lengths after repair: of any mode but none they satisfy is_monotone_cubic(), at most 16
/// ulp inside. `active_is_start`: which handle is being edited. Negative lengths and NaN count as
/// 0. Lengths that do already are kept to the bit. Repair is done once: f(f(x)) = f(x).
HandleLengths regularize_handles(HandleLengths lengths, Regularization mode,
                                 bool active_is_start = true) noexcept;

/// Every cubic Bézier segment of a 2-D polynomial cubic repaired along its own handles (y follows
/// x, so directions stay; a handle that points back becomes 0), start handles counted as edited.
/// A curve with nothing to repair is returned as it is; else the segments that are left alone keep
/// the Bézier points of to_bezier(), inner knots have multiplicity 3 (4 at a jump, whose sides are
/// kept), and an unclamped curve becomes clamped. The Bézier points of the result never let x go
/// back, nor leave the segment after contain, not by rounding either. Errors: unsupported (degree
/// other than 3, rational), dimension_mismatch (not 2 coordinates), not_a_function (a segment that
/// ends before it begins, a jump back, or mode none on a curve that goes back), too_many_points.
Result<NurbsCurve> regularize(const NurbsCurve& curve, Regularization mode);

}  // namespace knotwave::curves

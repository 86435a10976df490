// SPDX-License-Identifier: MIT
// A curve beyond its ends.
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

enum class Extrapolation {
  hold,      ///< the end values
  linear,    ///< along the end tangents (as CSS Easing Functions Level 1 does)
  periodic,  ///< from the start again
  mirror,    ///< forwards, backwards, forwards, ...
};

/// C(u) for any u, to out[dim]: inside the domain and at its ends evaluate(), below it as `before`
/// says, above it as `after` says, also for a periodic curve. [any] NaN counts as u_min.
/// linear: C + C' (u - end) from the inner side of the end, kept within +-1e300; slope 0 holds.
/// periodic, mirror: evaluate() of the u of the first period, which is right to half an ulp of the
/// domain's ends and 2^-53 periods, however many periods away: nothing accumulates. Beyond 2^52
/// periods (infinity too), where doubles have no phase left, it holds. What repeats is continuous
/// from the right: whole periods give C(u_min), a jump its right-hand value, and its left-hand
/// value where the mirror runs backwards. As costly as evaluate(), no allocation.
void evaluate_extrapolated(const NurbsCurve& curve, double u, Extrapolation before,
                           Extrapolation after, std::span<double> out) noexcept;

}  // namespace knotwave::curves

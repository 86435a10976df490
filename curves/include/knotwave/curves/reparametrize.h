// SPDX-License-Identifier: MIT
// The same path at another pace: reversed, over another domain, or bent. [control] Control points
// are kept to the bit; knots move, each by one rounding, and what was a knot's left side stays the
// same piece of the path.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 6.4 (reparametrisation), 6.5 (reversal).
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// D(u) = C(u_min + u_max - u): the curve backwards over the same domain. Left and right limits at
/// a jump change places. reverse(reverse(c)) has the same points and weights, and knots within 1
/// ulp of the largest of both curves. Errors: knot_multiplicity (knots that differed are equal
/// after rounding and together come too often), value_out_of_range (a knot before or after the
/// domain would pass kMaxKnot).
Result<NurbsCurve> reverse(const NurbsCurve& curve);

/// D over [u_a, u_b], D(u) = C at the same fraction of the domain. Points and weights are kept to
/// the bit, the ends are exact. Errors: empty_domain (u_a >= u_b), not_finite,
/// value_out_of_range (a knot beyond kMaxKnot), knot_multiplicity as in reverse().
Result<NurbsCurve> reparametrize(const NurbsCurve& curve, double u_a, double u_b);

/// The Möbius ("bend") pace: D(u) = C(g(u)), where g maps the domain onto itself, x the fraction
/// of the domain: g(x) = x / (x + b (1 - x)). b = 1 changes nothing, b > 1 starts slower, b < 1
/// faster; slope 1/b at the start and b at the end. Exact in the reals for every degree: knots move
/// by the inverse of g, weights change by powers of b, points are kept to the bit. bend(bend(c, a),
/// b) = bend(c, a b); bend(c, 1/b) undoes it. The result is rational, also if the curve was not;
/// all its weights are scaled by one power of 2 where the limits need that. An unclamped curve
/// becomes clamped. Errors: value_out_of_range (b <= 0 or not finite), weight_out_of_range (the
/// weights would be farther apart than the limits are: less bend, or a lower degree),
/// knot_multiplicity as in reverse(), unsupported (a periodic curve: sub_curve() cuts it open
/// first).
Result<NurbsCurve> bend(const NurbsCurve& curve, double b);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Two curves to one. [control] Exact in the reals, within 4 ulp of max|P| in double, where not
// said otherwise. The result has the name of the first (of compose: the outer one).
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 10.3 (compatible curves); Mørken, Some
// identities for products and degree raising of splines, Constr. Approx. 7 (1991); DeRose,
// Composing Bézier simplexes, ACM TOG 7 (1988).
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// `second` after `first`: its domain is shifted to begin where the first ends, each knot by one
/// rounding; degrees are made equal, unclamped curves clamped. Ends farther apart than
/// `join_tolerance` in any coordinate (and than 4 ulp of max|P|) make a declared jump, others a
/// knot of multiplicity p at the point of the first. join(split(c)) is c with that knot. Errors:
/// dimension_mismatch, unsupported (a periodic curve: sub_curve() cuts it open), knot_multiplicity
/// (knots fell together in the shift), weight_out_of_range, too_many_points, value_out_of_range (a
/// tolerance below 0, a knot beyond kMaxKnot).
Result<NurbsCurve> join(const NurbsCurve& first, const NurbsCurve& second,
                        double join_tolerance = 0);

struct CompatibleCurves {
  NurbsCurve first;
  NurbsCurve second;
};
/// Both with the same degree, knots, jumps, periodicity and point count, over the domain of the
/// first (the second is reparametrised affinely onto it): ready for morph, lofting and surfaces.
/// Knots that differ by no more than that reparametrisation rounds (4 ulp of max|u|) become one.
/// Periodic with periodic stays so, else both are clamped. Where one has a jump, so has the other,
/// with both sides equal. Curves that are compatible already are returned as they are. Errors:
/// dimension_mismatch, too_many_points, knot_multiplicity (knots fell together).
Result<CompatibleCurves> make_compatible(const NurbsCurve& first, const NurbsCurve& second);
/// The same for any number of curves; more of them round none more often.
Result<std::vector<NurbsCurve>> make_compatible(std::span<const NurbsCurve> curves);

/// (1 - amount) first + amount second, in homogeneous points of the compatible curves; amount 0 and
/// 1 give the compatible curves to the bit. Polynomial curves: the pointwise mix. Rational ones:
/// weights mix too (as a lofted surface does). Errors: those of make_compatible,
/// value_out_of_range (amount outside 0..1).
Result<NurbsCurve> morph(const NurbsCurve& first, const NurbsCurve& second, double amount);

/// first + second and first * second, pointwise over equal domains. A sum of polynomial curves has
/// the higher of their degrees, and 4 ulp there are those of the larger max|P| of the two; one with
/// a rational curve in it is put over the common denominator, degree p1 + p2. Product: degree p1 +
/// p2, coordinate by coordinate; a curve of dim 1 times one of dim n scales it. At a knot the
/// result is as smooth as the less smooth of both. Jumps of either are jumps of the result, each
/// side from the same sides, unless that happens to meet. Periodic if both are, else clamped.
/// Errors: parameter_out_of_range (domains differ), dimension_mismatch, degree_out_of_range (the
/// degree would pass kMaxDegree), coordinate_out_of_range, weight_out_of_range, too_many_points.
Result<NurbsCurve> sum(const NurbsCurve& first, const NurbsCurve& second);
Result<NurbsCurve> product(const NurbsCurve& first, const NurbsCurve& second);

/// outer(inner(u)): a velocity map of an envelope, a shaper of a wave. Degree p_outer * p_inner, in
/// spans with knots of that multiplicity where the inner curve has knots and where it crosses one
/// of the outer's: exact in the reals there too, but the crossing is rounded to a double, which
/// moves a corner by as much. So values are within 4 ulp of max|P| and, with the largest magnitudes
/// of u and of the inner's values and slopes, 2^-53 (value + u slope) times the outer's steepest
/// slope: 13 ulp where weights of 1000 to 1 make a cliff. A jump of the outer curve becomes one
/// where the inner crosses it; where the inner only touches it, or rests on it, the value is that
/// of the right side, as for evaluate(). Jumps of the inner stay. The result is clamped, also for
/// periodic curves (a periodic outer counts over one period). The inner is a scalar whose range
/// lies in the domain of the outer, to 4 ulp of its max|P|. Rational outer curves may need an inner
/// span halved to keep weights positive: that adds knots. Errors: not_scalar,
/// parameter_out_of_range (the message has the value, its u, and the domain), degree_out_of_range,
/// weight_out_of_range, too_many_points, coordinate_out_of_range.
Result<NurbsCurve> compose(const NurbsCurve& outer, const NurbsCurve& inner);

}  // namespace knotwave::curves

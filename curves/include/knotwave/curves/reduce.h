// SPDX-License-Identifier: MIT
// Edits that make a curve smaller, and say by how much it changes. [control]
// Source: Piegl & Tiller, The NURBS Book, 2nd ed., 5.4 (knot removal); Lyche & Mørken, CAGD 4
// (1987) (least squares). The bounds are our own: both curves as Bézier segments,
// src/curve_distance.h.
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// A smaller curve, how often the edit could be done, and a proved bound: no point of it is farther
/// than max_error (Euclidean, output units) from the point of the old curve at the same u, limits
/// from either side at a knot included. The rounding of its points counts; the bound itself is
/// computed to 2^-90 max|P|. It is at most a tenth above the error there is where
/// spans and weights are within a factor of 16; for wilder curves it may be looser, still a bound.
struct ReducedCurve {
  NurbsCurve curve;
  int removed = 0;       ///< knots, or degrees
  double max_error = 0;  ///< 0 if nothing was removed
};

/// Takes the inner knot u out up to `times` times, as long as the bound stays within `tolerance`;
/// removes fewer where it doesn't (or a weight would not stay positive, or a point would pass the
/// limits). A jump is removed like any other knot when the tolerance allows: its ends become their
/// mean. remove(insert(u)) gives the curve back: the same knots, and values within 4 ulp of max|P|;
/// as rounding counts, that takes a tolerance of a few ulp, not 0. A periodic curve stays periodic;
/// its seam keeps one knot, and may have the rest written at its other end. Errors:
/// parameter_out_of_range (u is no inner knot, nor a seam with knots to spare), value_out_of_range
/// (times < 0; tolerance < 0 or not finite).
Result<ReducedCurve> remove_knot(const NurbsCurve& curve, double u, int times, double tolerance);

/// Removes inner knots as long as `tolerance` allows, cheapest first; what each one costs is
/// measured against the curve given, not against the step before, so errors don't add up unseen. A
/// knot that once was too dear stays. The bound is for the whole curve. Errors: value_out_of_range.
Result<ReducedCurve> remove_knots(const NurbsCurve& curve, double tolerance);

/// Degree p - 1, by least squares over the Bézier points: for one segment of a polynomial within 4
/// times of the least error that keeps the ends. A knot of multiplicity m keeps its
/// continuity, and has m - 1 then; a simple one stays, with one derivative less. Jumps stay, with
/// both their values, and so do the ends. A curve that was elevated comes back: the same knots,
/// values within 4 ulp of max|P|, at a tolerance of a few ulp. A periodic curve stays periodic, an
/// unclamped one becomes clamped. Errors: degree_out_of_range (p = 1), error_bound_missed (the
/// message has the error that reduction would make and the tolerance), value_out_of_range.
Result<ReducedCurve> reduce_degree(const NurbsCurve& curve, double tolerance);

}  // namespace knotwave::curves

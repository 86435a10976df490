// SPDX-License-Identifier: MIT
// Products of curves in the B-spline basis. Private to curves. [control]
// Source: Mørken, Some identities for products and degree raising of splines, Constr. Approx. 7
// (1991); Ramshaw, Blossoming: A Connect-the-Dots Approach to Splines (1987).
#pragma once
#include <string>

#include "homogeneous.h"

namespace knotwave::curves {

/// A point of the product from one of each factor: coordinates and weight are sums of products of
/// theirs, each with one number of f and one of g.
using Mix = HomogeneousPoint (*)(const HomogeneousPoint& f, const HomogeneousPoint& g);

/// f * g as `mix` says, over the domain both have, of degree p + q. A point of the product is the
/// mean, over all ways to deal its p + q knots to f (p of them) and g, of mix(f's blossom, g's): a
/// blossom of p knots is the control point of f once those knots are inserted, so all blends are
/// convex, and wide and narrow spans side by side cost no digits. A knot keeps the continuity that
/// the less smooth factor has there; jumps stay jumps unless the product meets. Periodic if both
/// are, else clamped. Errors: degree_out_of_range, too_many_points, weight_out_of_range.
Result<NurbsCurve> multiply(const NurbsCurve& f, const NurbsCurve& g, int dim, Mix mix);

/// The same for g = 1, of degree q: f with degree p + q.
Result<NurbsCurve> multiply_by_one(const NurbsCurve& f, int q);

}  // namespace knotwave::curves

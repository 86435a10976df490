// SPDX-License-Identifier: MIT
// How far two curves are apart at the same u, proved. Private to curves. [control]
#pragma once
#include <span>
#include <vector>

#include "homogeneous.h"

namespace knotwave::curves {

/// One span of a curve as a Bézier segment.
struct BezierPiece {
  Knot left;
  Knot right;
  std::vector<HomogeneousPoint> points;  ///< [p+1]
};
std::vector<BezierPiece> bezier_pieces(const HomogeneousCurve& curve);

/// The piece that `curve` has from `left` to `right`, which lie in one span.
BezierPiece piece_between(const HomogeneousCurve& curve, Knot left, Knot right);

/// Bézier points of one degree more, the same piece.
void raise_degree(std::vector<HomogeneousPoint>& points);

/// de Casteljau at 1/2: `points` becomes its left half, the right one is returned.
std::vector<HomogeneousPoint> halve(std::vector<HomogeneousPoint>& points);

/// An upper bound of |a(u) - b(u)| (Euclidean) over a piece, both over the same u; b may have a
/// lower degree. With numerators A, B and weights v, w of the two in Bernstein form and any o,
///   a - b = (sum B_j [(A_j - o v_j) - (B_j - o w_j) - (v_j - w_j) (b(u) - o)]) / sum B_j v_j,
/// so the largest bracket over v_j bounds it; b(u) - o is bounded by b's own hull. The piece is
/// halved until that is within 1/16 of what is found at ends of parts, at most 10 times. Infinity
/// as soon as the distance is known to pass `limit`. Right to 2^-90 max|P|.
double distance_bound(const BezierPiece& a, const BezierPiece& b, int dim, double limit);

/// The same for families of pieces, as many of a as of b: any mix of the numerators and weights of
/// a, with shares not below 0, is as near to the same mix of b. So it bounds surfaces whose rows
/// they are.
double distance_bound(std::span<const BezierPiece> a, std::span<const BezierPiece> b, int dim,
                      double limit);
/// The same over the whole domain, for families that have one knot vector each; `after` may have
/// fewer knots and a lower degree.
double distance_bound(std::span<const NurbsCurve> before, std::span<const NurbsCurve> after,
                      double limit);

}  // namespace knotwave::curves

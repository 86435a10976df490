// SPDX-License-Identifier: MIT
// One coordinate of a curve as quotients of polynomials, and where it rises and falls. Private to
// curves. [control]
#pragma once
#include <optional>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

#include "bernstein.h"

namespace knotwave::curves {

/// A coordinate over one span of positive length: numerator / weight at t = (u - u0) / (u1 - u0).
struct CoordinatePiece {
  double u0 = 0;
  double u1 = 1;
  Bernstein numerator;
  Bernstein weight;

  DoubleDouble at(DoubleDouble t) const noexcept { return quotient_at(numerator, weight, t); }
  /// The ends are the knots themselves.
  double parameter(double t) const noexcept;
  /// The other way, of u in [u0, u1].
  DoubleDouble place_of(double u) const noexcept {
    return DoubleDouble::difference(u, u0) / DoubleDouble::difference(u1, u0);
  }
  /// The largest magnitude of its Bézier points: |numerator| <= largest() * weight.
  double largest() const noexcept;
};
std::vector<CoordinatePiece> coordinate_pieces(const NurbsCurve& curve, int coordinate);
/// The part of a piece that lies in [low, high]; none where that is too short for a double.
std::optional<CoordinatePiece> clipped(const CoordinatePiece& piece, double low, double high);

/// A part of a piece from t0 to t1 on which the coordinate doesn't turn.
struct MonotonePart {
  std::size_t piece = 0;
  double t0 = 0;
  double t1 = 1;
  DoubleDouble value0;
  DoubleDouble value1;
};
/// In order, all of the domain. `rational`: whether the weights differ.
std::vector<MonotonePart> monotone_parts(const std::vector<CoordinatePiece>& pieces, bool rational);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "coordinate_pieces.h"

#include <algorithm>
#include <cmath>

#include "curve_distance.h"

namespace knotwave::curves {

double CoordinatePiece::parameter(double t) const noexcept {
  if (t <= 0) return u0;
  if (t >= 1) return u1;
  return (DoubleDouble(u0) + DoubleDouble(t) * DoubleDouble::difference(u1, u0)).hi;
}

double CoordinatePiece::largest() const noexcept {
  double most = 0;
  for (std::size_t j = 0; j < weight.size(); ++j) {
    most = std::max(most, std::abs((numerator[j] / weight[j]).hi));
  }
  return most;
}

std::vector<CoordinatePiece> coordinate_pieces(const NurbsCurve& curve, int coordinate) {
  const HomogeneousCurve all(curve);
  std::vector<CoordinatePiece> pieces;
  for (const BezierPiece& bezier : bezier_pieces(all)) {
    CoordinatePiece piece{
        all.domain.rounded(bezier.left), all.domain.rounded(bezier.right), {}, {}};
    for (const HomogeneousPoint& point : bezier.points) {
      piece.numerator.push_back(point.x[static_cast<std::size_t>(coordinate)]);
      piece.weight.push_back(point.w);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::optional<CoordinatePiece> clipped(const CoordinatePiece& piece, double low, double high) {
  low = std::max(low, piece.u0);
  high = std::min(high, piece.u1);
  if (!(low < high)) return std::nullopt;
  if (low == piece.u0 && high == piece.u1) return piece;
  const DoubleDouble width = DoubleDouble::difference(piece.u1, piece.u0);
  const DoubleDouble t0 = DoubleDouble::difference(low, piece.u0) / width;
  const DoubleDouble t1 = DoubleDouble::difference(high, piece.u0) / width;
  if (!(t1.hi > 0)) return std::nullopt;
  return CoordinatePiece{low, high, part_of(piece.numerator, t0, t1),
                         part_of(piece.weight, t0, t1)};
}

std::vector<MonotonePart> monotone_parts(const std::vector<CoordinatePiece>& pieces,
                                         bool rational) {
  std::vector<MonotonePart> parts;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const CoordinatePiece& piece = pieces[i];
    // Seen from the start, so that an offset costs no digits.
    const DoubleDouble origin = piece.at(0);
    Bernstein from_start = piece.numerator;
    for (std::size_t j = 0; j < from_start.size(); ++j) {
      from_start[j] = from_start[j] - origin * piece.weight[j];
    }
    const Bernstein slope = derivative(from_start);
    const Bernstein scale = {DoubleDouble(2 * (piece.largest() + std::abs(origin.hi)))};
    const Bernstein terms = scale * derivative_terms(piece.weight);
    std::vector<double> turns =
        rational ? sign_changes(slope * piece.weight - from_start * derivative(piece.weight),
                                terms * piece.weight)
                 : sign_changes(slope, terms);
    turns.push_back(1);
    double from = 0;
    for (const double to : turns) {
      if (!(from < to)) continue;
      parts.push_back({i, from, to, piece.at(from), piece.at(to)});
      from = to;
    }
  }
  return parts;
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "curve_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/index.h"

#include "length.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using Points = std::vector<HomogeneousPoint>;

// Both curves, or both families of them, over one part.
struct Pair {
  std::vector<Points> a, b;
  int halvings = 0;
};

double distance_at(const HomogeneousPoint& a, const HomogeneousPoint& b, int dim) {
  double apart[kMaxDim];
  for (std::size_t c = 0; c < index_of(dim); ++c) apart[c] = (a.x[c] / a.w - b.x[c] / b.w).hi;
  return length_of({apart, index_of(dim)});
}

// How far any of b's points is from `middle`.
double hull_radius(const std::vector<Points>& b, const HomogeneousPoint& middle, int dim) {
  double radius = 0;
  for (const Points& points : b) {
    for (const HomogeneousPoint& point : points) {
      radius = std::max(radius, distance_at(point, middle, dim));
    }
  }
  return radius;
}

double hull_bound(const Pair& pair, int dim) {
  // o: where b is about the middle of its piece, so that the hull of b is small around it.
  const Points& of_b = pair.b[pair.b.size() / 2];
  const HomogeneousPoint& middle = of_b[of_b.size() / 2];
  const double radius = hull_radius(pair.b, middle, dim);
  double bound = 0;
  for (std::size_t r = 0; r < pair.a.size(); ++r) {
    for (std::size_t j = 0; j < pair.a[r].size(); ++j) {
      const HomogeneousPoint &a = pair.a[r][j], &b = pair.b[r][j];
      const DoubleDouble more_weight = a.w - b.w;
      double bracket[kMaxDim];
      for (std::size_t c = 0; c < index_of(dim); ++c) {
        const DoubleDouble o = middle.x[c] / middle.w;
        bracket[c] = (a.x[c] - b.x[c] - more_weight * o).hi;
      }
      bound = std::max(
          bound,
          (length_of({bracket, index_of(dim)}) + std::abs(more_weight.hi) * radius) / a.w.hi);
    }
  }
  return bound;
}

double distance_at_ends(const Pair& pair, int dim) {
  double found = 0;
  for (std::size_t r = 0; r < pair.a.size(); ++r) {
    found = std::max({found, distance_at(pair.a[r].front(), pair.b[r].front(), dim),
                      distance_at(pair.a[r].back(), pair.b[r].back(), dim)});
  }
  return found;
}

// `pair` becomes its left half.
Pair halved(Pair& pair) {
  Pair right{{}, {}, ++pair.halvings};
  for (Points& points : pair.a) right.a.push_back(halve(points));
  for (Points& points : pair.b) right.b.push_back(halve(points));
  return right;
}

}  // namespace

std::vector<BezierPiece> bezier_pieces(const HomogeneousCurve& curve) {
  std::vector<BezierPiece> pieces;
  for (int span = curve.degree; span < static_cast<int>(curve.points.size()); ++span) {
    const Knot left = curve.knots[index_of(span)], right = curve.knots[index_of(span + 1)];
    if (!(left < right)) continue;
    pieces.push_back({left, right, Points(index_of(curve.degree + 1))});
    bezier_points(curve, span, pieces.back().points);
  }
  return pieces;
}

BezierPiece piece_between(const HomogeneousCurve& curve, Knot left, Knot right) {
  BezierPiece piece{left, right, Points(index_of(curve.degree + 1))};
  bezier_points(curve, curve.span_at(left, Side::right), left, right, piece.points);
  return piece;
}

void raise_degree(std::vector<HomogeneousPoint>& points) {
  const auto degree = points.size();  // the new one
  Points raised{points.front()};
  for (std::size_t j = 1; j < degree; ++j) {
    raised.push_back(
        blend(points[j], points[j - 1], static_cast<double>(j), static_cast<double>(degree - j)));
  }
  raised.push_back(points.back());
  points = std::move(raised);
}

std::vector<HomogeneousPoint> halve(std::vector<HomogeneousPoint>& points) {
  Points right = points;
  for (std::size_t level = 1; level < points.size(); ++level) {
    for (std::size_t r = 0; r + level < points.size(); ++r) {
      right[r] = blend(right[r], right[r + 1], 1.0, 1.0);
    }
    points[level] = right[0];
  }
  return right;
}

double distance_bound(const BezierPiece& a, const BezierPiece& b, int dim, double limit) {
  return distance_bound(std::span(&a, 1), std::span(&b, 1), dim, limit);
}

double distance_bound(std::span<const BezierPiece> a, std::span<const BezierPiece> b, int dim,
                      double limit) {
  // Rows of a family stay as far apart as they are, however short the part.
  const int most_halvings = a.size() == 1 ? 10 : 3;
  std::vector<Pair> open(1);
  for (const BezierPiece& piece : a) open.front().a.push_back(piece.points);
  for (const BezierPiece& piece : b) {
    open.front().b.push_back(piece.points);
    Points& points = open.front().b.back();
    while (points.size() < a.front().points.size()) raise_degree(points);
  }
  double found = 0, bound = 0;
  while (!open.empty()) {
    Pair pair = std::move(open.back());
    open.pop_back();
    found = std::max(found, distance_at_ends(pair, dim));
    if (found > limit) return std::numeric_limits<double>::infinity();
    const double upper = hull_bound(pair, dim);
    if (upper <= bound) continue;
    if (upper <= found * 1.0625 || pair.halvings == most_halvings) {
      bound = upper;
      continue;
    }
    Pair right = halved(pair);
    open.push_back(std::move(right));
    open.push_back(std::move(pair));
  }
  return bound;
}

double distance_bound(std::span<const NurbsCurve> before, std::span<const NurbsCurve> after,
                      double limit) {
  std::vector<std::vector<BezierPiece>> pieces;  // [row][piece]
  std::vector<HomogeneousCurve> smaller;
  for (const NurbsCurve& curve : before) pieces.push_back(bezier_pieces(HomogeneousCurve(curve)));
  for (const NurbsCurve& curve : after) smaller.emplace_back(curve);
  double bound = 0;
  for (std::size_t i = 0; i < pieces.front().size(); ++i) {
    std::vector<BezierPiece> a, b;
    for (std::size_t r = 0; r < pieces.size(); ++r) {
      a.push_back(pieces[r][i]);
      b.push_back(piece_between(smaller[r], a.back().left, a.back().right));
    }
    bound = std::max(bound, distance_bound(a, b, before.front().dim(), limit));
  }
  return bound;
}

}  // namespace knotwave::curves

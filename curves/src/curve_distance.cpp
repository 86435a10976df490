// SPDX-License-Identifier: MIT
#include "curve_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using Points = std::vector<HomogeneousPoint>;

// de Casteljau at 1/2: `points` becomes its left half, the right one is returned.
Points halve(Points& points) {
  Points right = points;
  for (std::size_t level = 1; level < points.size(); ++level) {
    for (std::size_t r = 0; r + level < points.size(); ++r) {
      right[r] = blend(right[r], right[r + 1], 1.0, 1.0);
    }
    points[level] = right[0];
  }
  return right;
}

struct Pair {
  Points a, b;
  int halvings = 0;
};

double length_of(const double* x, int dim) {
  double square = 0;
  for (int c = 0; c < dim; ++c) square += x[c] * x[c];
  return std::sqrt(square);
}

double distance_at(const HomogeneousPoint& a, const HomogeneousPoint& b, int dim) {
  double apart[kMaxDim];
  for (std::size_t c = 0; c < index_of(dim); ++c) apart[c] = (a.x[c] / a.w - b.x[c] / b.w).hi;
  return length_of(apart, dim);
}

double hull_bound(const Pair& pair, int dim) {
  // o: where b is about the middle of its piece, so that the hull of b is small around it.
  const HomogeneousPoint& middle = pair.b[pair.b.size() / 2];
  double radius = 0;
  for (const HomogeneousPoint& point : pair.b) {
    radius = std::max(radius, distance_at(point, middle, dim));
  }
  double bound = 0;
  for (std::size_t j = 0; j < pair.a.size(); ++j) {
    const DoubleDouble more_weight = pair.a[j].w - pair.b[j].w;
    double bracket[kMaxDim];
    for (std::size_t c = 0; c < index_of(dim); ++c) {
      const DoubleDouble o = middle.x[c] / middle.w;
      bracket[c] = (pair.a[j].x[c] - pair.b[j].x[c] - more_weight * o).hi;
    }
    bound = std::max(
        bound, (length_of(bracket, dim) + std::abs(more_weight.hi) * radius) / pair.a[j].w.hi);
  }
  return bound;
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

double distance_bound(const BezierPiece& a, const BezierPiece& b, int dim, double limit) {
  constexpr int kMostHalvings = 10;
  std::vector<Pair> open{{a.points, b.points, 0}};
  while (open.front().b.size() < open.front().a.size()) raise_degree(open.front().b);
  double found = 0, bound = 0;
  while (!open.empty()) {
    Pair pair = std::move(open.back());
    open.pop_back();
    found = std::max({found, distance_at(pair.a.front(), pair.b.front(), dim),
                      distance_at(pair.a.back(), pair.b.back(), dim)});
    if (found > limit) return std::numeric_limits<double>::infinity();
    const double upper = hull_bound(pair, dim);
    if (upper <= bound) continue;
    if (upper <= found * 1.0625 || pair.halvings == kMostHalvings) {
      bound = upper;
      continue;
    }
    Pair right{halve(pair.a), halve(pair.b), ++pair.halvings};
    open.push_back(std::move(right));
    open.push_back(std::move(pair));
  }
  return bound;
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "knotwave/curves/analysis.h"

#include <algorithm>
#include <cmath>

#include "knotwave/curves/algorithms.h"

#include "coordinate_pieces.h"

namespace knotwave::curves {
namespace {

struct Coordinate {
  std::vector<CoordinatePiece> pieces;
  std::vector<MonotonePart> parts;

  Coordinate(const NurbsCurve& curve, int coordinate)
      : pieces(coordinate_pieces(curve, coordinate)),
        parts(monotone_parts(pieces, curve.is_rational())) {}
  double start_of(const MonotonePart& part) const { return pieces[part.piece].parameter(part.t0); }
  double end_of(const MonotonePart& part) const { return pieces[part.piece].parameter(part.t1); }
};

/// Where a value is taken: a place, or a stretch.
struct Stretch {
  double from = 0;
  double to = 0;
};

double crossing(const CoordinatePiece& piece, const MonotonePart& part, double value) {
  Bernstein above = piece.numerator;
  for (std::size_t j = 0; j < above.size(); ++j) {
    above[j] = above[j] - piece.weight[j] * DoubleDouble(value);
  }
  const bool rises = part.value0.hi < part.value1.hi;
  double low = part.t0, high = part.t1;
  constexpr int kSteps = 54;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (low + high);
    const double there = scaled_value(above, middle).hi;
    ((rises ? there < 0 : there > 0) ? low : high) = middle;
  }
  return piece.parameter(high);
}

std::vector<Stretch> places_of(const Coordinate& all, double value, double tolerance) {
  std::vector<Stretch> places;
  const auto add = [&places](double from, double to) {
    if (!places.empty() && from <= places.back().to) {
      places.back().to = std::max(places.back().to, to);
    } else {
      places.push_back({from, to});
    }
  };
  DoubleDouble before = all.parts.front().value0;
  for (const MonotonePart& part : all.parts) {
    const double u0 = all.start_of(part), u1 = all.end_of(part);
    const double last = (before - DoubleDouble(value)).hi;
    const double first = (part.value0 - DoubleDouble(value)).hi;
    const double end = (part.value1 - DoubleDouble(value)).hi;
    const auto near = [tolerance](double off) { return std::abs(off) <= tolerance; };
    before = part.value1;
    if (near(first) && near(end)) {
      add(u0, u1);
      continue;
    }
    if (near(first) || (last < 0) != (first < 0)) add(u0, u0);
    if (near(end)) {
      add(u1, u1);
    } else if (!near(first) && (first < 0) != (end < 0)) {
      const double u = crossing(all.pieces[part.piece], part, value);
      add(u, u);
    }
  }
  return places;
}

}  // namespace

ValueRange value_range(const NurbsCurve& curve, int coordinate) {
  const Coordinate all(curve, coordinate);
  const MonotonePart& first = all.parts.front();
  Extremum low{all.start_of(first), first.value0.hi}, high = low;
  const auto look = [&](double u, double value) {
    if (value < low.value) low = {u, value};
    if (value > high.value) high = {u, value};
  };
  for (const MonotonePart& part : all.parts) {
    look(all.start_of(part), part.value0.hi);
    look(all.end_of(part), part.value1.hi);
  }
  const HullRange hull = hull_range(curve, coordinate);
  low.value = std::max(low.value, hull.low);
  high.value = std::min(high.value, hull.high);
  return {low, high};
}

std::vector<double> parameters_at(const NurbsCurve& curve, double value, int coordinate) {
  const HullRange hull = hull_range(curve, coordinate);
  const double tolerance = 0x1p-52 * std::max(std::abs(hull.low), std::abs(hull.high));
  if (!(value >= hull.low - tolerance && value <= hull.high + tolerance)) return {};
  std::vector<Stretch> places = places_of(Coordinate(curve, coordinate), value, tolerance);
  if (curve.is_periodic() && places.size() > 1 && places.front().from == curve.u_min() &&
      places.back().from == curve.u_max()) {
    places.pop_back();
  }
  std::vector<double> found;
  for (const Stretch& place : places) {
    found.push_back(place.from);
    if (place.from < place.to) found.push_back(place.to);
  }
  return found;
}

double total_variation(const NurbsCurve& curve, int coordinate) {
  const Coordinate all(curve, coordinate);
  DoubleDouble sum = 0.0, before = all.parts.front().value0;
  const auto move = [&](DoubleDouble to) {
    const DoubleDouble by = to - before;
    sum += by.hi < 0 ? -by : by;
    before = to;
  };
  for (const MonotonePart& part : all.parts) {
    move(part.value0);
    move(part.value1);
  }
  return sum.hi;
}

std::vector<SpanHull> span_hulls(const NurbsCurve& curve, int coordinate) {
  std::vector<SpanHull> hulls;
  for (const CoordinatePiece& piece : coordinate_pieces(curve, coordinate)) {
    const double first = piece.at(0).hi;
    SpanHull hull{piece.u0, piece.u1, first, first};
    for (std::size_t j = 1; j < piece.weight.size(); ++j) {
      const double x = (piece.numerator[j] / piece.weight[j]).hi;
      hull.low = std::min(hull.low, x);
      hull.high = std::max(hull.high, x);
    }
    hulls.push_back(hull);
  }
  return hulls;
}

}  // namespace knotwave::curves

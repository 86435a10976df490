// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/curves/analysis.h"

#include "coordinate_pieces.h"
#include "length.h"

namespace knotwave::curves {
namespace {

using base::number_text;

/// A span seen from the point: its coordinates are offsets from there.
using Offsets = std::vector<CoordinatePiece>;  // [dim]

double distance_at(const Offsets& span, DoubleDouble t) {
  std::array<double, kMaxDim> offset{};
  for (std::size_t c = 0; c < span.size(); ++c) offset[c] = span[c].at(t).hi;
  return length_of(offset);
}

/// To the box around the span's points: no place of the span is nearer.
double least_distance(const Offsets& span) {
  std::array<double, kMaxDim> least{};
  for (std::size_t c = 0; c < span.size(); ++c) {
    double low = span[c].at(0).hi, high = low;
    for (std::size_t j = 1; j < span[c].weight.size(); ++j) {
      const double x = (span[c].numerator[j] / span[c].weight[j]).hi;
      low = std::min(low, x);
      high = std::max(high, x);
    }
    least[c] = std::max({0.0, low, -high});
  }
  return length_of(least);
}

/// Where the square of the distance turns: sum over c of d_c d_c', times w^3 > 0.
std::vector<double> feet(const Offsets& span, std::span<const double> point, bool rational) {
  Bernstein slope;
  double scale = 0;  // of its terms, by those of the weights
  for (std::size_t c = 0; c < span.size(); ++c) {
    const CoordinatePiece& d = span[c];
    const double most = d.largest();
    scale += 4 * most * (most + 2 * std::abs(point[c]));
    const Bernstein along = derivative(d.numerator);
    const Bernstein share =
        d.numerator * (rational ? along * d.weight - d.numerator * derivative(d.weight) : along);
    slope = slope.empty() ? share : slope + share;
  }
  const Bernstein& weight = span.front().weight;
  const Bernstein terms = Bernstein{DoubleDouble(scale)} * weight * derivative_terms(weight);
  return sign_changes(slope, rational ? terms * weight : terms);
}

/// `best` or, if it is nearer, one of the doubles around the place t of the span.
ClosestPoint nearer(const ClosestPoint& best, const Offsets& span, double t) {
  const CoordinatePiece& piece = span.front();
  const double u = piece.parameter(t);
  ClosestPoint nearest = best;
  for (const double at : {u, std::nextafter(u, piece.u0), std::nextafter(u, piece.u1)}) {
    const double distance = distance_at(span, piece.place_of(at));
    if (distance < nearest.distance) nearest = {at, distance};
  }
  return nearest;
}

std::vector<Offsets> offsets_from(const NurbsCurve& curve, std::span<const double> point) {
  std::vector<Offsets> spans;
  for (int c = 0; c < curve.dim(); ++c) {
    const double origin = point[static_cast<std::size_t>(c)];
    std::vector<CoordinatePiece> pieces = coordinate_pieces(curve, c);
    spans.resize(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = 0; j < pieces[i].weight.size(); ++j) {
        pieces[i].numerator[j] =
            pieces[i].numerator[j] - pieces[i].weight[j] * DoubleDouble(origin);
      }
      spans[i].push_back(std::move(pieces[i]));
    }
  }
  return spans;
}

Result<void> check(const NurbsCurve& curve, std::span<const double> point) {
  if (point.size() != static_cast<std::size_t>(curve.dim())) {
    return fail(ErrorCode::dimension_mismatch, "a point with " + std::to_string(point.size()) +
                                                   " coordinates, curve '" + curve.name() +
                                                   "' has " + std::to_string(curve.dim()));
  }
  for (const double x : point) {
    if (!std::isfinite(x)) return fail(ErrorCode::not_finite, "the point is not finite");
    if (std::abs(x) > kMaxCoordinate) {
      return fail(ErrorCode::coordinate_out_of_range,
                  "coordinate " + number_text(x) + " of the point is outside -" +
                      number_text(kMaxCoordinate) + ".." + number_text(kMaxCoordinate));
    }
  }
  return {};
}

}  // namespace

Result<ClosestPoint> closest_point(const NurbsCurve& curve, std::span<const double> point) {
  if (auto fits = check(curve, point); !fits) return fits.error();
  const std::vector<Offsets> spans = offsets_from(curve, point);
  // The ends first: a near one rules out most spans.
  double near = distance_at(spans.front(), 0);
  for (const Offsets& span : spans) near = std::min(near, distance_at(span, 1));
  ClosestPoint best{curve.u_min(), distance_at(spans.front(), 0)};
  for (const Offsets& span : spans) {
    constexpr double kRounding = 1 - 0x1p-50;
    if (least_distance(span) * kRounding > std::min(near, best.distance)) continue;
    std::vector<double> places = feet(span, point, curve.is_rational());
    places.insert(places.begin(), 0);
    places.push_back(1);
    for (const double t : places) best = nearer(best, span, t);
  }
  return best;
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// arc_length() and parameter_at_length() of calculus.h.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/calculus.h"

#include "chords.h"
#include "coordinate_pieces.h"
#include "quadrature.h"
#include "spec_checks.h"

namespace knotwave::curves {
namespace {

using base::number_text;

/// Parts shorter than this of the control polygon are not looked into.
constexpr double kNegligible = 0x1p-60;

double polygon_length(const NurbsCurve& curve) {
  const std::vector<double> legs = chords(curve.points(), curve.dim());
  return std::accumulate(legs.begin(), legs.end(),
                         curve.dim() == 1 ? curve.u_max() - curve.u_min() : 0.0);
}

/// A span with the speed of the path on it.
struct PathSpan {
  double u0 = 0;
  double u1 = 1;
  std::vector<QuadraturePart> parts;
};

/// The numerator of C'. Offsets are taken off, so that they cost no digits.
Bernstein slope_top(const CoordinatePiece& piece, bool rational) {
  const DoubleDouble origin = piece.at(0);
  Bernstein top = piece.numerator;
  for (std::size_t i = 0; i < top.size(); ++i) top[i] = top[i] - origin * piece.weight[i];
  const Bernstein slope = derivative(top);
  return rational ? slope * piece.weight - top * derivative(piece.weight)
                  : slope * Bernstein{piece.weight.front()};
}

std::vector<PathSpan> path_spans(const NurbsCurve& curve, double low, double high) {
  const double negligible = kNegligible * polygon_length(curve);
  std::vector<std::vector<CoordinatePiece>> coordinates;
  coordinates.reserve(base::index_of(curve.dim()));
  for (int c = 0; c < curve.dim(); ++c) coordinates.push_back(coordinate_pieces(curve, c));
  std::vector<PathSpan> spans;
  for (std::size_t i = 0; i < coordinates[0].size(); ++i) {
    Integrand speed;
    std::optional<CoordinatePiece> piece;
    for (const auto& pieces : coordinates) {
      piece = clipped(pieces[i], low, high);
      if (piece) speed.tops.push_back(slope_top(*piece, curve.is_rational()));
    }
    if (!piece) continue;
    speed.bottom = curve.is_rational() ? piece->weight : Bernstein{piece->weight.front()};
    if (curve.dim() == 1) {  // the graph: u goes on as well
      Bernstein& time = speed.tops.emplace_back(speed.bottom * speed.bottom);
      for (DoubleDouble& x : time) x = x * DoubleDouble::difference(piece->u1, piece->u0);
    }
    spans.push_back({piece->u0, piece->u1, quadrature_parts(speed, negligible)});
  }
  return spans;
}

/// The share of `part` after which its path is `length` long, 0 < length <= whole.
double share_at(const QuadraturePart& part, double length, double whole) {
  // The speed changes by a factor of 14 at most, so Newton is soon there; a bracket keeps it in.
  constexpr int kMostSteps = 64;
  double low = 0, high = 1, share = length / whole;
  for (int step = 0; step < kMostSteps; ++step) {
    const double beyond = (part.integral(share) - DoubleDouble(length)).hi;
    (beyond > 0 ? high : low) = share;
    double next = share - beyond / (part.value(share) * part.width);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - share) <= 0x1p-53) return next;
    share = next;
  }
  return share;
}

}  // namespace

Result<double> arc_length(const NurbsCurve& curve, double u_a, double u_b) {
  for (const double u : {u_a, u_b}) {
    if (auto good = check_parameter(curve, u); !good) return good.error();
  }
  DoubleDouble sum = 0.0;
  for (const PathSpan& span : path_spans(curve, std::min(u_a, u_b), std::max(u_a, u_b))) {
    for (const QuadraturePart& part : span.parts) sum += part.integral();
  }
  return sum.hi;
}

Result<double> parameter_at_length(const NurbsCurve& curve, double length) {
  DoubleDouble sum = 0.0;
  for (const PathSpan& span : path_spans(curve, curve.u_min(), curve.u_max())) {
    for (const QuadraturePart& part : span.parts) {
      const DoubleDouble here = part.integral(), rest = DoubleDouble(length) - sum;
      sum += here;
      if (!(rest.hi <= here.hi)) continue;
      if (!(rest.hi >= 0)) break;
      const double share = rest.hi > 0 ? share_at(part, rest.hi, here.hi) : 0;
      const DoubleDouble t = DoubleDouble(part.start) + DoubleDouble::product(share, part.width);
      return std::min((DoubleDouble(span.u0) + t * DoubleDouble::difference(span.u1, span.u0)).hi,
                      span.u1);
    }
  }
  if (length >= sum.hi && length <= sum.hi + 0x1p-48 * polygon_length(curve)) return curve.u_max();
  return fail(ErrorCode::parameter_out_of_range, "curve '" + curve.name() + "': length " +
                                                     number_text(length) + " is outside 0.." +
                                                     number_text(sum.hi));
}

}  // namespace knotwave::curves

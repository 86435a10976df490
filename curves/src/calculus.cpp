// SPDX-License-Identifier: MIT
#include "knotwave/curves/calculus.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "coordinate_pieces.h"
#include "knot_domain.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

Error weighted(const NurbsCurve& curve, const std::string& what) {
  return fail(ErrorCode::unsupported,
              "curve '" + curve.name() + "' has weights, " + what + " is for curves without");
}

bool has_corner(const NurbsCurve& curve) {
  const auto knots = curve.knots();
  const auto p = index_of(curve.degree());
  for (std::size_t i = 0; i + p <= knots.size(); ++i) {
    const double knot = knots[i];
    const bool inside = knot > curve.u_min() || (curve.is_periodic() && knot == curve.u_min());
    if (inside && knot < curve.u_max() && knot == knots[i + p - 1]) return true;
  }
  return false;
}

/// Slope of leg i of the control polygon, over the knots its two points share.
DoubleDouble leg_slope(const NurbsCurve& curve, const KnotSequence& knots, int i, int c) {
  const int p = curve.degree(), dim = curve.dim();
  const DoubleDouble rise = DoubleDouble::difference(curve.points()[index_of((i + 1) * dim + c)],
                                                     curve.points()[index_of(i * dim + c)]);
  const DoubleDouble width = knots.domain().distance(knots[i + 1], knots[i + p + 1]);
  return rise * DoubleDouble(p) / width;
}

// Degree 1: what each span rises by, twice. Equal neighbours need no jump.
Result<NurbsCurve> steps_of(const NurbsCurve& curve) {
  const KnotSequence knots{curve.knots(), 1, false};
  CurveSpec spec = curve.spec();
  const auto inner = curve.knots();
  spec.points.clear();
  spec.weights.clear();
  spec.knots = {curve.u_min()};
  for (int i = 0; i + 1 < curve.point_count(); ++i) {
    if (!(inner[index_of(i + 1)] < inner[index_of(i + 2)])) continue;
    for (int end = 0; end < 2; ++end) {
      for (int c = 0; c < curve.dim(); ++c) {
        spec.points.push_back(leg_slope(curve, knots, i, c).hi);
      }
    }
    spec.knots.insert(spec.knots.end(), {inner[index_of(i + 1)], inner[index_of(i + 2)]});
    if (inner[index_of(i + 2)] < curve.u_max()) spec.jumps.push_back(inner[index_of(i + 2)]);
  }
  spec.knots.push_back(curve.u_max());
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> hodograph(const NurbsCurve& curve) {
  if (curve.is_rational()) return weighted(curve, "a hodograph");
  if (!curve.jumps().empty()) {
    return fail(ErrorCode::unsupported, "curve '" + curve.name() + "' jumps at " +
                                            number_text(curve.jumps()[0]) +
                                            " and has no slope there: split it");
  }
  const int p = curve.degree();
  if ((curve.is_periodic() && (p == 1 || has_corner(curve))) || (p == 1 && !curve.is_clamped())) {
    auto open = sub_curve(curve, curve.u_min(), curve.u_max());
    return open ? hodograph(*open) : open;
  }
  if (p == 1) return steps_of(curve);
  const KnotSequence knots{curve.knots(), p, curve.is_periodic()};
  CurveSpec spec = curve.spec();
  spec.degree = p - 1;
  spec.points.clear();
  spec.weights.clear();
  const int count = curve.point_count() - (curve.is_periodic() ? p : 1);
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < curve.dim(); ++c) {
      spec.points.push_back(leg_slope(curve, knots, i, c).hi);
    }
  }
  if (!curve.is_periodic()) {
    spec.knots.erase(spec.knots.begin());
    spec.knots.pop_back();
    // p times in degree p - 1: a jump.
    for (std::size_t i = index_of(p); i + index_of(2 * p) <= spec.knots.size(); ++i) {
      const double knot = spec.knots[i];
      if (knot == spec.knots[i + index_of(p - 1)]) spec.jumps.push_back(knot);
    }
  }
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsCurve> antiderivative(const NurbsCurve& curve, double start) {
  const int p = curve.degree(), dim = curve.dim();
  if (curve.is_rational()) return weighted(curve, "an antiderivative");
  if (!std::isfinite(start)) return fail(ErrorCode::not_finite, "the start is not finite");
  if (p == kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, "the antiderivative of curve '" + curve.name() +
                                                    "' would have degree " + std::to_string(p + 1) +
                                                    ", the limit is " + std::to_string(kMaxDegree));
  }
  if (!curve.is_clamped() || curve.is_periodic()) {
    auto open = sub_curve(curve, curve.u_min(), curve.u_max());
    return open ? antiderivative(*open, start) : open;
  }
  CurveSpec spec = curve.spec();
  spec.degree = p + 1;
  spec.jumps.clear();
  spec.points.assign(index_of(dim), start);
  spec.weights.clear();
  std::array<DoubleDouble, kMaxDim> sum;
  sum.fill(start);
  const auto knots = curve.knots();
  for (int i = 0; i < curve.point_count(); ++i) {
    const DoubleDouble width =
        DoubleDouble::difference(knots[index_of(i + p + 1)], knots[index_of(i)]) /
        DoubleDouble(p + 1);
    for (int c = 0; c < dim; ++c) {
      sum[index_of(c)] += width * DoubleDouble(curve.points()[index_of(i * dim + c)]);
      spec.points.push_back(sum[index_of(c)].hi);
    }
  }
  spec.knots.insert(spec.knots.begin(), curve.u_min());
  spec.knots.push_back(curve.u_max());
  return NurbsCurve::create(std::move(spec));
}

Result<double> integral(const NurbsCurve& curve, double u_a, double u_b, int coordinate) {
  if (curve.is_rational()) return weighted(curve, "an integral");
  for (const double u : {u_a, u_b}) {
    if (u >= curve.u_min() && u <= curve.u_max()) continue;
    return fail(ErrorCode::parameter_out_of_range, "u = " + number_text(u) + " is outside " +
                                                       number_text(curve.u_min()) + ".." +
                                                       number_text(curve.u_max()));
  }
  const double low = std::min(u_a, u_b), high = std::max(u_a, u_b);
  DoubleDouble sum = 0.0;
  for (const CoordinatePiece& piece : coordinate_pieces(curve, coordinate)) {
    const double from = std::max(low, piece.u0), to = std::min(high, piece.u1);
    if (!(from < to)) continue;
    // A polynomial's mean is that of its Bernstein coefficients.
    const DoubleDouble width = DoubleDouble::difference(piece.u1, piece.u0);
    const DoubleDouble t0 = DoubleDouble::difference(from, piece.u0) / width;
    const DoubleDouble t1 = DoubleDouble::difference(to, piece.u0) / width;
    if (!(t1.hi > 0)) continue;  // too short for a double
    const Bernstein part = part_of(piece.numerator, t0, t1);
    DoubleDouble total = 0.0;
    for (const DoubleDouble& x : part) total += x;
    sum += total / (piece.weight.front() * DoubleDouble(static_cast<double>(part.size()))) *
           DoubleDouble::difference(to, from);
  }
  return u_a <= u_b ? sum.hi : -sum.hi;
}

double curvature(const NurbsCurve& curve, double u, Side side) noexcept {
  std::array<double, 3 * kMaxDim> at{};
  curve.derivatives(u, 2, side, at);
  const auto dim = index_of(curve.dim());
  const double* first = at.data() + dim;
  const double* second = first + dim;
  if (dim == 1) {
    const double speed = std::sqrt(1 + first[0] * first[0]);
    return second[0] / speed / speed / speed;
  }
  double square = 0, turn = 0;
  for (std::size_t c = 0; c < dim; ++c) square += first[c] * first[c];
  const double speed = std::sqrt(square);
  if (speed == 0) return 0;
  // |C' x C''| from its parts in each plane.
  for (std::size_t c = 0; c < dim; ++c) {
    for (std::size_t d = c + 1; d < dim; ++d) {
      const double area = first[c] / speed * second[d] - first[d] / speed * second[c];
      turn = dim == 2 ? area : turn + area * area;
    }
  }
  return (dim == 2 ? turn : std::sqrt(turn)) / speed / speed;
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "knotwave/curves/calculus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "coordinate_pieces.h"
#include "length.h"
#include "quadrature.h"
#include "spec_checks.h"

namespace knotwave::curves {
namespace {

using base::index_of;

Error weighted(const NurbsCurve& curve, const std::string& what) {
  return fail(ErrorCode::unsupported,
              "curve '" + curve.name() + "' has weights, " + what + " is for curves without");
}

// A polynomial's mean is that of its Bernstein coefficients.
DoubleDouble mean_of_polynomial(const CoordinatePiece& piece) {
  DoubleDouble total = 0.0;
  for (const DoubleDouble& x : piece.numerator) total += x;
  return total / (piece.weight.front() * DoubleDouble(static_cast<double>(piece.weight.size())));
}

DoubleDouble mean_of_quotient(const CoordinatePiece& piece, double scale) {
  DoubleDouble mean = 0.0;
  for (const QuadraturePart& part : quadrature_parts(
           {Integrand::Kind::ratio, {piece.numerator}, piece.weight}, 0x1p-60 * scale)) {
    mean += part.integral();
  }
  return mean;
}

}  // namespace

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
  for (const double u : {u_a, u_b}) {
    if (auto good = check_parameter(curve, u); !good) return good.error();
  }
  const double low = std::min(u_a, u_b), high = std::max(u_a, u_b);
  const HullRange hull = hull_range(curve, coordinate);
  const double scale = std::max(std::abs(hull.low), std::abs(hull.high)) * (high - low);
  DoubleDouble sum = 0.0;
  for (const CoordinatePiece& whole : coordinate_pieces(curve, coordinate)) {
    const std::optional<CoordinatePiece> piece = clipped(whole, low, high);
    if (!piece) continue;
    const DoubleDouble width = DoubleDouble::difference(piece->u1, piece->u0);
    sum += width * (curve.is_rational() ? mean_of_quotient(*piece, scale / width.hi)
                                        : mean_of_polynomial(*piece));
  }
  return u_a <= u_b ? sum.hi : -sum.hi;
}

double curvature(const NurbsCurve& curve, double u, Side side) noexcept {
  std::array<double, index_of(3 * kMaxDim)> at{};
  curve.derivatives(u, 2, side, at);
  const auto dim = index_of(curve.dim());
  const double* first = at.data() + dim;
  const double* second = first + dim;
  constexpr double kMost = std::numeric_limits<double>::max();
  if (dim == 1) {
    const double speed = std::min(length_of(std::array{1.0, first[0]}), kMost);
    return std::clamp(second[0] / speed / speed / speed, -kMost, kMost);
  }
  const double speed = std::min(length_of(std::span(first, dim)), kMost);
  if (speed == 0) return 0;
  std::array<double, kMaxDim*(kMaxDim - 1) / 2> areas{};  // halves, which are no larger than C''
  std::size_t planes = 0;
  // |C' x C''| from its parts in each plane.
  for (std::size_t c = 0; c < dim; ++c) {
    for (std::size_t d = c + 1; d < dim; ++d) {
      areas[planes++] = first[c] / speed * (second[d] / 2) - first[d] / speed * (second[c] / 2);
    }
  }
  const double turn = dim == 2 ? areas[0] : length_of(areas);
  return std::clamp(2 * (turn / speed / speed), -kMost, kMost);
}

}  // namespace knotwave::curves

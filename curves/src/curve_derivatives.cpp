// SPDX-License-Identifier: MIT
// Derivatives of rational curves, of any order and size.
#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/index.h"
#include "knotwave/curves/nurbs_curve.h"

#include "scaled_double.h"
#include "span_basis.h"

namespace knotwave::curves {
namespace {

using base::index_of;

/// Derivatives of numerator and denominator by u * 2^-unit_exponent; 0 above the degree.
struct Sums {
  DoubleDouble of[kMaxDegree + 1][kMaxDim + 1];
  int unit_exponent = 0;
};

/// The numerator is seen from `origin` = C(u), so an offset of the curve costs no digits.
Sums sums_at(const NurbsCurve& curve, const SpanBasis& basis, int span,
             std::span<const double> origin, int order, int unit_exponent) noexcept {
  const int p = curve.degree(), dim = curve.dim();
  const double unit = power_of_two(-unit_exponent);
  Sums sums;
  sums.unit_exponent = unit_exponent;
  for (int k = 0; k <= std::min(order, p); ++k) {
    DoubleDouble share[kMaxDegree + 1];
    basis.derivative(k, share, unit);
    for (int r = 0; r <= p; ++r) {
      const int i = span - p + r;
      if (curve.is_rational()) share[r] = share[r] * curve.weights()[index_of(i)];
      for (int c = 0; c < dim; ++c) {
        const double point = curve.points()[index_of(i * dim + c)];
        sums.of[k][c] += share[r] * DoubleDouble::difference(point, origin[index_of(c)]);
      }
      sums.of[k][dim] += share[r];
    }
  }
  return sums;
}

/// A4.2: C_k = (A_k - sum binomial(k, i) w_i C_{k-i}) / w_0, i <= p as higher w_i are 0. Each to
/// take(k, C_k), NaN where terms are beyond all doubles.
template <class Take>
void divide_by_weight(const NurbsCurve& curve, const Sums& sums, int c, int order, Take take) {
  const int p = curve.degree(), dim = curve.dim();
  constexpr int kShift = 300;
  constexpr double kLarge = 0x1p300, kSmall = 0x1p-300;
  DoubleDouble past[kMaxDegree + 1];  // C_j / 2^exponent at index j mod (p + 1); C_0 is about 0
  double scale = 1;                   // 2^-exponent; 0 soon, when A_k is nothing beside the others
  int exponent = 0;
  past[0] = sums.of[0][c] / sums.of[0][dim];
  for (int k = 1; k <= order; ++k) {
    DoubleDouble value = 0.0;
    if (k <= p) value = {sums.of[k][c].hi * scale, sums.of[k][c].lo * scale};
    double binomial = 1.0;
    for (int i = 1; curve.is_rational() && i <= std::min(k, p); ++i) {
      binomial = binomial * static_cast<double>(k - i + 1) / static_cast<double>(i);
      value = value - past[(k - i) % (p + 1)] * (sums.of[i][dim] * binomial);
    }
    value = value / sums.of[0][dim];
    past[k % (p + 1)] = value;
    take(k, std::isfinite(value.hi) ? saturated(value.hi, exponent - k * sums.unit_exponent)
                                    : std::numeric_limits<double>::quiet_NaN());
    if (!(std::abs(value.hi) > kLarge)) continue;
    for (DoubleDouble& one : past) one = {one.hi * kSmall, one.lo * kSmall};
    scale *= kSmall;
    exponent += kShift;
  }
}

}  // namespace

void NurbsCurve::derivatives(double u, int order, Side side, std::span<double> out) const noexcept {
  u = KnotDomain{u_min(), u_max(), periodic_}.place(u, side);
  const int span = find_span(knots_, degree_, u, side);
  const SpanBasis basis(KnotSequence{knots_, degree_, periodic_}, span, u);
  std::fill_n(out.begin(), index_of((order + 1) * dim_), 0.0);
  const std::span<double> value = out.first(index_of(dim_));
  evaluate(u, side, value);
  const Sums by_u = sums_at(*this, basis, span, value, order, 0);
  bool is_done = true;
  for (int c = 0; c < dim_; ++c) {
    divide_by_weight(*this, by_u, c, order, [&](int k, double derivative) {
      out[index_of(k * dim_ + c)] = derivative;
      is_done = is_done && !std::isnan(derivative);
    });
  }
  if (is_done) return;
  // Spans so short that sums pass all doubles: by the span's length none does.
  const Sums by_span = sums_at(*this, basis, span, value, order, exponent_of(basis.length()));
  for (int c = 0; c < dim_; ++c) {
    divide_by_weight(*this, by_span, c, order, [&](int k, double derivative) {
      double& kept = out[index_of(k * dim_ + c)];
      if (std::isnan(kept)) kept = derivative;
    });
  }
}

}  // namespace knotwave::curves

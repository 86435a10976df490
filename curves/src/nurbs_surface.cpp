// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_surface.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"

#include "span_basis.h"
#include "spec_checks.h"
#include "spec_layout.h"

namespace knotwave::curves {
namespace {
using base::index_of;

KnotSequence sequence_u(const NurbsSurface& surface) {
  return {surface.knots_u(), surface.degree_u(), surface.is_periodic_u()};
}
KnotSequence sequence_v(const NurbsSurface& surface) {
  return {surface.knots_v(), surface.degree_v(), false};
}

// Partial derivatives of the weighted surface, seen from `origin`, and of its weight.
class Partials {
 public:
  Partials(const NurbsSurface& surface, double u, double v, std::span<const double> origin,
           int order) noexcept
      : surface_(surface),
        origin_(origin),
        span_u_(find_span(surface.knots_u(), surface.degree_u(), u, Side::right)),
        span_v_(find_span(surface.knots_v(), surface.degree_v(), v, Side::right)) {
    const SpanBasis along_u(sequence_u(surface), span_u_, u);
    const SpanBasis along_v(sequence_v(surface), span_v_, v);
    for (int k = 0; k <= std::min(order, surface.degree_u()); ++k) along_u.derivative(k, u_[k]);
    for (int l = 0; l <= std::min(order, surface.degree_v()); ++l) along_v.derivative(l, v_[l]);
  }

  /// d^(k+l) / du^k dv^l of coordinate c, or of the weight when c is dim.
  DoubleDouble of(int k, int l, int c) const noexcept {
    const int p = surface_.degree_u(), q = surface_.degree_v(), dim = surface_.dim();
    DoubleDouble sum = 0.0;
    if (k > p || l > q) return sum;
    for (int b = 0; b <= q; ++b) {
      for (int a = 0; a <= p; ++a) {
        const int i = (span_v_ - q + b) * surface_.count_u() + span_u_ - p + a;
        DoubleDouble share = u_[k][a] * v_[l][b] * surface_.weights()[index_of(i)];
        if (c < dim) {
          share = share * DoubleDouble::difference(surface_.points()[index_of(i * dim + c)],
                                                   origin_[index_of(c)]);
        }
        sum += share;
      }
    }
    return sum;
  }

 private:
  const NurbsSurface& surface_;
  std::span<const double> origin_;
  int span_u_, span_v_;
  DoubleDouble u_[kMaxDegree + 1][kMaxDegree + 1];
  DoubleDouble v_[kMaxDegree + 1][kMaxDegree + 1];
};
}  // namespace

Result<NurbsSurface> NurbsSurface::create(SurfaceSpec spec) {
  if (auto found = find_fault(spec)) return std::move(found->error);
  NurbsSurface surface;
  surface.name_ = std::move(spec.name);
  surface.degree_u_ = spec.degree_u;
  surface.degree_v_ = spec.degree_v;
  surface.dim_ = spec.dim;
  const int n = spec.count_u, extra = spec.periodic_u ? spec.degree_u : 0;
  surface.count_u_ = n + extra;
  surface.count_v_ = spec.count_v;
  surface.periodic_u_ = spec.periodic_u;
  surface.knots_u_ = expanded_knots(spec.knots_u, spec.degree_u, n, spec.periodic_u);
  surface.knots_v_ = expanded_knots(spec.knots_v, spec.degree_v, spec.count_v, false);
  surface.points_ = closed_rows(std::move(spec.points), n * spec.dim, extra * spec.dim);
  surface.weights_ = expanded_weights(std::move(spec.weights), n * spec.count_v, n, extra);
  surface.rational_ = makes_rational(surface.weights_);
  return surface;
}

SurfaceSpec NurbsSurface::spec() const {
  SurfaceSpec spec;
  spec.name = name_;
  spec.degree_u = degree_u_;
  spec.degree_v = degree_v_;
  spec.dim = dim_;
  const int extra = periodic_u_ ? degree_u_ : 0;
  spec.count_u = count_u_ - extra;
  spec.count_v = count_v_;
  spec.periodic_u = periodic_u_;
  spec.points = open_rows(points_, spec.count_u * dim_, extra * dim_);
  spec.weights = written_weights(weights_, spec.count_u, extra);
  spec.knots_u = written_knots(knots_u_, degree_u_, periodic_u_);
  spec.knots_v = knots_v_;
  return spec;
}

void NurbsSurface::evaluate(double u, double v, std::span<double> out) const noexcept {
  u = sequence_u(*this).domain().place(u, Side::right);
  v = sequence_v(*this).domain().place(v, Side::right);
  const int span_u = find_span(knots_u_, degree_u_, u, Side::right);
  const int span_v = find_span(knots_v_, degree_v_, v, Side::right);
  const SpanBasis along_u(sequence_u(*this), span_u, u);
  const SpanBasis along_v(sequence_v(*this), span_v, v);
  DoubleDouble sums[kMaxDim], total = 0.0;
  for (int b = 0; b <= degree_v_; ++b) {
    for (int a = 0; a <= degree_u_; ++a) {
      const int i = (span_v - degree_v_ + b) * count_u_ + span_u - degree_u_ + a;
      DoubleDouble share = along_u.rows[degree_u_][a] * along_v.rows[degree_v_][b];
      if (rational_) share = share * weights_[index_of(i)];
      total += share;
      for (int c = 0; c < dim_; ++c) sums[c] += share * points_[index_of(i * dim_ + c)];
    }
  }
  for (int c = 0; c < dim_; ++c) {
    out[index_of(c)] = rational_ ? (sums[c] / total).hi : sums[c].hi;
  }
}

void NurbsSurface::derivatives(double u, double v, int order,
                               std::span<double> out) const noexcept {
  u = sequence_u(*this).domain().place(u, Side::right);
  v = sequence_v(*this).domain().place(v, Side::right);
  const auto at = [&](int k, int l, int c) { return index_of((k * (order + 1) + l) * dim_ + c); };
  std::fill_n(out.begin(), index_of((order + 1) * (order + 1) * dim_), 0.0);
  double origin[kMaxDim];
  evaluate(u, v, origin);
  const Partials partials(*this, u, v, origin, order);
  for (int k = 0; k <= order; ++k) {
    for (int l = 0; k + l <= order; ++l) {
      // A4.4: what the product rule says the denominator's derivatives add is taken off.
      DoubleDouble value[kMaxDim];
      for (int c = 0; c < dim_; ++c) value[c] = partials.of(k, l, c);
      double binomial_k = 1;
      for (int i = 0; rational_ && i <= k; ++i) {
        double binomial_l = 1;
        for (int j = 0; j <= l; ++j) {
          if (i + j > 0) {
            const DoubleDouble factor = partials.of(i, j, dim_) * (binomial_k * binomial_l);
            for (int c = 0; c < dim_; ++c) value[c] = value[c] - factor * out[at(k - i, l - j, c)];
          }
          binomial_l = binomial_l * (l - j) / (j + 1);
        }
        binomial_k = binomial_k * (k - i) / (i + 1);
      }
      for (int c = 0; c < dim_; ++c) {
        out[at(k, l, c)] = k + l == 0 ? 0.0 : (value[c] / partials.of(0, 0, dim_)).hi;
      }
    }
  }
  for (int c = 0; c < dim_; ++c) out[index_of(c)] = origin[c];
}

NurbsCurve NurbsSurface::iso_curve_at_v(double v0) const {
  const double v = sequence_v(*this).domain().place(v0, Side::right);
  const int span = find_span(knots_v_, degree_v_, v, Side::right);
  const SpanBasis basis(sequence_v(*this), span, v);
  const int count = count_u_ - (periodic_u_ ? degree_u_ : 0);
  CurveSpec spec{name_, degree_u_, dim_, {}, {}, {}, periodic_u_, {}};
  spec.knots = written_knots(knots_u_, degree_u_, periodic_u_);
  for (int i = 0; i < count; ++i) {
    append_blend(spec, basis, degree_v_, (span - degree_v_) * count_u_ + i, count_u_);
  }
  return std::move(*NurbsCurve::create(std::move(spec)));
}

NurbsCurve NurbsSurface::iso_curve_at_u(double u0) const {
  const double u = sequence_u(*this).domain().place(u0, Side::right);
  const int span = find_span(knots_u_, degree_u_, u, Side::right);
  const SpanBasis basis(sequence_u(*this), span, u);
  CurveSpec spec{name_, degree_v_, dim_, {}, {}, knots_v_, false, {}};
  for (int j = 0; j < count_v_; ++j) {
    append_blend(spec, basis, degree_u_, j * count_u_ + span - degree_u_, 1);
  }
  return std::move(*NurbsCurve::create(std::move(spec)));
}

void NurbsSurface::append_blend(CurveSpec& spec, const SpanBasis& basis, int degree, int first,
                                int stride) const {
  DoubleDouble sums[kMaxDim], total = 0.0;
  for (int r = 0; r <= degree; ++r) {
    const int i = first + r * stride;
    const DoubleDouble share = basis.rows[degree][r] * weights_[index_of(i)];
    total += share;
    for (int c = 0; c < dim_; ++c) sums[c] += share * points_[index_of(i * dim_ + c)];
  }
  for (int c = 0; c < dim_; ++c) spec.points.push_back((sums[c] / total).hi);
  spec.weights.push_back(total.hi);
}
}  // namespace knotwave::curves

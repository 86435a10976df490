// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/index.h"
#include "knotwave/base/rt.h"

#include "scaled_double.h"
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

// A parameter in the domain, and the span on the side asked for.
struct Place {
  double at = 0;
  int span = 0;

  Place(const KnotSequence& knots, double u, Side side) noexcept
      : at(knots.domain().place(u, side)),
        span(find_span(knots.expanded, knots.degree, at, side)) {}
};

constexpr int kOrders = kMaxDegree + 1;

/// Lengths to differentiate by, as exponents of 2: derivatives by u * 2^-u.
struct Units {
  int u = 0, v = 0;
};

// Partial derivatives of the weighted surface, seen from `origin`, and of its weight.
struct WeightedPartials {
  DoubleDouble of[kOrders][kOrders][kMaxDim + 1];  // [k][l][c], the weight at c = dim

  WeightedPartials(const NurbsSurface& surface, const Place& u, const Place& v,
                   std::span<const double> origin, int order, const Units& units) noexcept {
    const SpanBasis basis_u(sequence_u(surface), u.span, u.at);
    const SpanBasis basis_v(sequence_v(surface), v.span, v.at);
    const double unit_u = power_of_two(-units.u), unit_v = power_of_two(-units.v);
    const int p = surface.degree_u(), q = surface.degree_v();
    for (int k = 0; k <= std::min(order, p); ++k) {
      DoubleDouble along_u[kOrders];
      basis_u.derivative(k, along_u, unit_u);
      for (int l = 0; l <= std::min(order - k, q); ++l) {
        DoubleDouble along_v[kOrders];
        basis_v.derivative(l, along_v, unit_v);
        const int first = (v.span - q) * surface.count_u() + u.span - p;
        for (int b = 0; b <= q; ++b) {
          for (int a = 0; a <= p; ++a) {
            add(surface, first + b * surface.count_u() + a, along_u[a] * along_v[b], origin,
                of[k][l]);
          }
        }
      }
    }
  }

 private:
  static void add(const NurbsSurface& surface, int i, DoubleDouble share,
                  std::span<const double> origin, std::span<DoubleDouble> sums) noexcept {
    const int dim = surface.dim();
    if (surface.is_rational()) share = share * surface.weights()[index_of(i)];
    for (int c = 0; c < dim; ++c) {
      sums[index_of(c)] += share * DoubleDouble::difference(surface.points()[index_of(i * dim + c)],
                                                            origin[index_of(c)]);
    }
    sums[index_of(dim)] += share;
  }
};

// A4.4: what the product rule says the denominator's derivatives add is taken off.
DoubleDouble without_weight(const WeightedPartials& weighted, const DoubleDouble* known, int order,
                            int k, int l, int c, int dim) noexcept {
  DoubleDouble value = weighted.of[k][l][c];
  double ways_k = 1;
  for (int i = 0; i <= k; ++i) {
    double ways_l = 1;
    for (int j = 0; j <= l; ++j) {
      if (i + j > 0) {
        const DoubleDouble factor = weighted.of[i][j][dim] * (ways_k * ways_l);
        value = value - factor * known[(k - i) * (order + 1) + l - j];
      }
      ways_l = ways_l * (l - j) / (j + 1);
    }
    ways_k = ways_k * (k - i) / (i + 1);
  }
  return value;
}

/// Every partial derivative of coordinate c but the value itself, to take(where it goes, value).
template <class Take>
void divide_by_weight(const NurbsSurface& surface, const WeightedPartials& weighted, int c,
                      int order, const Units& units, Take take) noexcept {
  const int dim = surface.dim();
  DoubleDouble known[kOrders * kOrders];
  for (int k = 0; k <= order; ++k) {
    for (int l = 0; k + l <= order; ++l) {
      DoubleDouble value = weighted.of[k][l][c];
      if (surface.is_rational()) value = without_weight(weighted, known, order, k, l, c, dim);
      value = value / weighted.of[0][0][dim];
      known[k * (order + 1) + l] = value;
      if (k + l == 0) continue;
      const double derivative = std::isfinite(value.hi)
                                    ? saturated(value.hi, -(k * units.u + l * units.v))
                                    : std::numeric_limits<double>::quiet_NaN();
      take(index_of((k * (order + 1) + l) * dim + c), derivative);
    }
  }
}
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
  const Place at_u(sequence_u(*this), u, Side::right), at_v(sequence_v(*this), v, Side::right);
  const SpanBasis along_u(sequence_u(*this), at_u.span, at_u.at);
  const SpanBasis along_v(sequence_v(*this), at_v.span, at_v.at);
  DoubleDouble sums[kMaxDim], total = 0.0;
  for (int b = 0; b <= degree_v_; ++b) {
    for (int a = 0; a <= degree_u_; ++a) {
      const int i = (at_v.span - degree_v_ + b) * count_u_ + at_u.span - degree_u_ + a;
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
  derivatives(u, Side::right, v, Side::right, order, out);
}

void NurbsSurface::derivatives(double u, Side side_u, double v, Side side_v, int order,
                               std::span<double> out) const noexcept {
  KNOTWAVE_ASSERT(order >= 0 && order <= kMaxDegree);
  std::fill_n(out.begin(), index_of((order + 1) * (order + 1) * dim_), 0.0);
  evaluate(u, v, out.first(index_of(dim_)));
  const Place at_u(sequence_u(*this), u, side_u), at_v(sequence_v(*this), v, side_v);
  const auto partials = [&](const Units& units, auto take) {
    const WeightedPartials weighted(*this, at_u, at_v, out, order, units);
    for (int c = 0; c < dim_; ++c) divide_by_weight(*this, weighted, c, order, units, take);
  };
  bool is_done = true;
  partials({}, [&](std::size_t at, double derivative) {
    out[at] = derivative;
    is_done = is_done && std::isfinite(derivative);
  });
  if (is_done) return;
  // Spans so short that sums pass all doubles: by the spans' lengths none does.
  const Units spans{exponent_of(SpanBasis(sequence_u(*this), at_u.span, at_u.at).length()),
                    exponent_of(SpanBasis(sequence_v(*this), at_v.span, at_v.at).length())};
  partials(spans, [&](std::size_t at, double derivative) {
    if (!std::isfinite(out[at])) out[at] = derivative;
  });
}

NurbsCurve NurbsSurface::iso_curve_at_v(double v0) const {
  const Place at(sequence_v(*this), v0, Side::right);
  const SpanBasis basis(sequence_v(*this), at.span, at.at);
  const int count = count_u_ - (periodic_u_ ? degree_u_ : 0);
  CurveSpec spec{name_, degree_u_, dim_, {}, {}, {}, periodic_u_, {}};
  spec.knots = written_knots(knots_u_, degree_u_, periodic_u_);
  for (int i = 0; i < count; ++i) {
    append_blend(spec, basis, degree_v_, (at.span - degree_v_) * count_u_ + i, count_u_);
  }
  return std::move(*NurbsCurve::create(std::move(spec)));
}

NurbsCurve NurbsSurface::iso_curve_at_u(double u0) const {
  const Place at(sequence_u(*this), u0, Side::right);
  const SpanBasis basis(sequence_u(*this), at.span, at.at);
  CurveSpec spec{name_, degree_v_, dim_, {}, {}, knots_v_, false, {}};
  for (int j = 0; j < count_v_; ++j) {
    append_blend(spec, basis, degree_u_, j * count_u_ + at.span - degree_u_, 1);
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

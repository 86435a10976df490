// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_curve.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"

#include "span_basis.h"
#include "spec_checks.h"
#include "spec_layout.h"

namespace knotwave::curves {
namespace {

using base::index_of;

// Where the lower halves of double-doubles have no bits left, sums may pass their greatest term.
constexpr double kTiny = 1e-280;

// `value` no further out than the coordinate of `points` [n*dim] that begins them.
double within(double value, std::span<const double> points, int dim) {
  double low = points.front(), high = low;
  for (std::size_t i = 0; i < points.size(); i += index_of(dim)) {
    low = std::min(low, points[i]);
    high = std::max(high, points[i]);
  }
  return std::clamp(value, low, high);
}

}  // namespace

Result<NurbsCurve> NurbsCurve::create(CurveSpec spec) {
  if (auto found = find_fault(spec)) return std::move(found->error);
  NurbsCurve curve;
  curve.name_ = std::move(spec.name);
  curve.degree_ = spec.degree;
  curve.dim_ = spec.dim;
  curve.periodic_ = spec.periodic;
  const int written = static_cast<int>(spec.points.size()) / spec.dim;
  curve.knots_ = expanded_knots(spec.knots, spec.degree, written, spec.periodic);
  const int extra = spec.periodic ? spec.degree : 0;
  curve.points_ = closed_rows(std::move(spec.points), written * spec.dim, extra * spec.dim);
  curve.weights_ = expanded_weights(std::move(spec.weights), written, written, extra);
  curve.jumps_ = std::move(spec.jumps);
  curve.rational_ = makes_rational(curve.weights_);
  return curve;
}

CurveSpec NurbsCurve::spec() const {
  CurveSpec spec;
  spec.name = name_;
  spec.degree = degree_;
  spec.dim = dim_;
  spec.periodic = periodic_;
  spec.jumps = jumps_;
  spec.knots = written_knots(knots_, degree_, periodic_);
  const int extra = periodic_ ? degree_ : 0, written = point_count() - extra;
  spec.points = open_rows(points_, written * dim_, extra * dim_);
  spec.weights = written_weights(weights_, written, extra);
  return spec;
}

bool NurbsCurve::is_clamped() const noexcept {
  return knots_.front() == u_min() && knots_.back() == u_max();
}

void NurbsCurve::evaluate(double u, std::span<double> out) const noexcept {
  evaluate(u, Side::right, out);
}

void NurbsCurve::evaluate(double u, Side side, std::span<double> out) const noexcept {
  u = KnotDomain{u_min(), u_max(), periodic_}.place(u, side);
  const int span = find_span(knots_, degree_, u, side);
  const SpanBasis basis(KnotSequence{knots_, degree_, periodic_}, span, u);
  DoubleDouble share[kMaxDegree + 1];
  DoubleDouble total = 0.0;
  for (int r = 0; r <= degree_; ++r) {
    share[r] = basis.rows[degree_][r];
    if (rational_) share[r] = share[r] * weights_[index_of(span - degree_ + r)];
    total += share[r];
  }
  const std::size_t first = index_of((span - degree_) * dim_), all = index_of((degree_ + 1) * dim_);
  for (int c = 0; c < dim_; ++c) {
    DoubleDouble sum = 0.0;
    for (int r = 0; r <= degree_; ++r) {
      sum += share[r] * points_[index_of((span - degree_ + r) * dim_ + c)];
    }
    double value = rational_ ? (sum / total).hi : sum.hi;
    if (std::abs(value) < kTiny) {
      value = within(value, points().subspan(first + index_of(c), all - index_of(c)), dim_);
    }
    out[index_of(c)] = value;
  }
}

int find_span(std::span<const double> knots, int degree, double u, Side side) noexcept {
  return span_of(knots, degree, u, side);
}

void basis_functions(std::span<const double> knots, int degree, int span, double u,
                     std::span<double> out) noexcept {
  const SpanBasis basis(KnotSequence{knots, degree, false}, span, u);
  for (int r = 0; r <= degree; ++r) out[index_of(r)] = basis.rows[degree][r].hi;
}

}  // namespace knotwave::curves

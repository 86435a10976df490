// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_surface.h"

#include <algorithm>
#include <cmath>

#include "span_basis.h"
#include "spec_checks.h"

namespace knotwave::curves {
namespace {
std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

// Each row of `row` numbers gets its first `extra` numbers again at its end.
std::vector<double> closed_rows(const std::vector<double>& flat, int row, int extra) {
  std::vector<double> closed;
  for (auto start = flat.begin(); start != flat.end(); start += row) {
    closed.insert(closed.end(), start, start + row);
    closed.insert(closed.end(), start, start + extra);
  }
  return closed;
}
// And without them again.
std::vector<double> open_rows(const std::vector<double>& flat, int row, int extra) {
  std::vector<double> open;
  for (auto start = flat.begin(); start != flat.end(); start += row) {
    open.insert(open.end(), start, start + row - extra);
  }
  return open;
}
}  // namespace

Result<NurbsSurface> NurbsSurface::create(SurfaceSpec spec) {
  if (auto found = find_fault(spec)) return std::move(found->error);
  NurbsSurface surface;
  surface.name_ = std::move(spec.name);
  surface.degree_u_ = spec.degree_u;
  surface.degree_v_ = spec.degree_v;
  surface.dim_ = spec.dim;
  surface.count_u_ = spec.count_u;
  surface.count_v_ = spec.count_v;
  surface.periodic_u_ = spec.periodic_u;
  surface.knots_u_ = expanded_knots(spec.knots_u, spec.degree_u, spec.count_u, spec.periodic_u);
  surface.knots_v_ = expanded_knots(spec.knots_v, spec.degree_v, spec.count_v, false);
  surface.points_ = std::move(spec.points);
  surface.weights_ = std::move(spec.weights);
  surface.weights_.resize(index_of(spec.count_u * spec.count_v), 1.0);
  if (spec.periodic_u) {
    const int p = spec.degree_u, n = spec.count_u;
    surface.points_ = closed_rows(surface.points_, n * spec.dim, p * spec.dim);
    surface.weights_ = closed_rows(surface.weights_, n, p);
    surface.count_u_ = n + p;
  }
  const double first = surface.weights_.front();
  surface.rational_ = std::any_of(surface.weights_.begin(), surface.weights_.end(),
                                  [first](double w) { return w != first; });
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
  spec.points = open_rows(points_, count_u_ * dim_, extra * dim_);
  if (std::any_of(weights_.begin(), weights_.end(), [](double w) { return w != 1.0; })) {
    spec.weights = open_rows(weights_, count_u_, extra);
  }
  spec.knots_u = written_knots(knots_u_, degree_u_, periodic_u_);
  spec.knots_v = knots_v_;
  return spec;
}

void NurbsSurface::evaluate(double u, double v, std::span<double> out) const noexcept {
  u = KnotDomain{u_min(), u_max(), periodic_u_}.place(u, Side::right);
  v = KnotDomain{v_min(), v_max(), false}.place(v, Side::right);
  const int span_u = find_span(knots_u_, degree_u_, u, Side::right);
  const int span_v = find_span(knots_v_, degree_v_, v, Side::right);
  const SpanBasis along_u(knots_u_, degree_u_, span_u, u);
  const SpanBasis along_v(knots_v_, degree_v_, span_v, v);
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

}  // namespace knotwave::curves

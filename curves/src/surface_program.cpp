// SPDX-License-Identifier: MIT
#include "knotwave/curves/surface_program.h"

#include <algorithm>

#include "knotwave/base/index.h"

#include "grid_kernel.h"
#include "knot_domain.h"

namespace knotwave::curves {
namespace {

using base::index_of;

/// Of the cells of `breaks`, the one x is in; `near` is looked at first.
int cell_of(std::span<const double> breaks, double x, int near) KNOTWAVE_RT {
  const std::size_t last = breaks.size() - 2, i = index_of(near);
  if ((i == 0 || breaks[i] <= x) && (i == last || x < breaks[i + 1])) return near;
  const auto inner = breaks.subspan(1, breaks.size() - 2);
  return static_cast<int>(std::upper_bound(inner.begin(), inner.end(), x) - inner.begin());
}

double slope_of(const double* c, int degree, double t) KNOTWAVE_RT {
  double sum = 0;
  for (int k = degree; k > 0; --k) sum = sum * t + c[k] * k;
  return sum;
}

}  // namespace

struct SurfaceProgram::Place {
  int cell = 0;
  double local = 0;  ///< 0..1
};

struct SurfaceProgram::Row {
  double numerator[kMaxPieceDegree + 1];
  double denominator[kMaxPieceDegree + 1];
};

SurfaceProgram::SurfaceProgram()
    : breaks_u_{0, 1},
      breaks_v_{0, 1},
      inverse_widths_u_{1},
      inverse_widths_v_{1},
      coefficients_{0},
      low_{0},
      high_{0} {}

SurfaceProgram::Place SurfaceProgram::place_u(double u, int near) const KNOTWAVE_RT {
  u = KnotDomain{u_min(), u_max(), periodic_u_}.place(u, Side::right);
  const int cell = cell_of(breaks_u_, u, near);
  return {cell, (u - breaks_u_[index_of(cell)]) * inverse_widths_u_[index_of(cell)]};
}

SurfaceProgram::Place SurfaceProgram::place_v(double v, int near) const KNOTWAVE_RT {
  v = KnotDomain{v_min(), v_max(), false}.place(v, Side::right);
  const int cell = cell_of(breaks_v_, v, near);
  return {cell, (v - breaks_v_[index_of(cell)]) * inverse_widths_v_[index_of(cell)]};
}

const double* SurfaceProgram::coefficients(int cell_u, int cell_v, int row) const KNOTWAVE_RT {
  const std::size_t rows = index_of(dim_) + (rational_ ? 1U : 0U);
  const std::size_t powers = index_of(degree_u_ + 1) * index_of(degree_v_ + 1);
  const std::size_t cell = index_of(cell_v) * inverse_widths_u_.size() + index_of(cell_u);
  return coefficients_.data() + (cell * rows + index_of(row)) * powers;
}

SurfaceProgram::Row SurfaceProgram::row_at(int cell_u, const Place& v,
                                           int coordinate) const KNOTWAVE_RT {
  Row row;  // only powers up to degree_u_ are read
  const double* numerator = coefficients(cell_u, v.cell, coordinate);
  const double* denominator = rational_ ? coefficients(cell_u, v.cell, dim_) : nullptr;
  for (int k = 0; k <= degree_u_; ++k) {
    const std::size_t first = index_of(k) * index_of(degree_v_ + 1);
    row.numerator[k] = horner(numerator + first, degree_v_, v.local);
    if (rational_) row.denominator[k] = horner(denominator + first, degree_v_, v.local);
  }
  return row;
}

double SurfaceProgram::clamped(double value, int coordinate) const KNOTWAVE_RT {
  return clamp_to_hull(value, low_[index_of(coordinate)], high_[index_of(coordinate)]);
}

double SurfaceProgram::at(double u, double v, int coordinate) const KNOTWAVE_RT {
  double value = 0;
  render_row({&u, 1}, v, {&value, 1}, coordinate);
  return value;
}

void SurfaceProgram::render_row(std::span<const double> u, double v, std::span<double> out,
                                int coordinate) const KNOTWAVE_RT {
  const Place along_v = place_v(v);
  const std::size_t count = std::min(u.size(), out.size());
  Place along_u;
  Row row;
  for (std::size_t i = 0; i < count; ++i) {
    const int cell = along_u.cell;
    along_u = place_u(u[i], cell);
    if (i == 0 || along_u.cell != cell) row = row_at(along_u.cell, along_v, coordinate);
    double value = horner(row.numerator, degree_u_, along_u.local);
    if (rational_) value = value / horner(row.denominator, degree_u_, along_u.local);
    out[i] = clamped(value, coordinate);
  }
}

void SurfaceProgram::render_path(std::span<const double> u, std::span<const double> v,
                                 std::span<double> out, int coordinate) const KNOTWAVE_RT {
  const std::size_t count = std::min({u.size(), v.size(), out.size()});
  Place along_u, along_v;
  for (std::size_t i = 0; i < count; ++i) {
    along_u = place_u(u[i], along_u.cell);
    along_v = place_v(v[i], along_v.cell);
    const Row row = row_at(along_u.cell, along_v, coordinate);
    double value = horner(row.numerator, degree_u_, along_u.local);
    if (rational_) value = value / horner(row.denominator, degree_u_, along_u.local);
    out[i] = clamped(value, coordinate);
  }
}

SurfaceProgram::Slopes SurfaceProgram::slopes_at(double u, double v,
                                                 int coordinate) const KNOTWAVE_RT {
  const Place along_u = place_u(u), along_v = place_v(v);
  struct Jet {
    double value = 0, by_u = 0, by_v = 0;
  };
  const auto jet = [&](int row) {
    const double* c = coefficients(along_u.cell, along_v.cell, row);
    double values[kMaxPieceDegree + 1] = {}, slopes[kMaxPieceDegree + 1] = {};
    for (int k = 0; k <= degree_u_; ++k) {
      const std::size_t first = index_of(k) * index_of(degree_v_ + 1);
      values[k] = horner(c + first, degree_v_, along_v.local);
      slopes[k] = slope_of(c + first, degree_v_, along_v.local);
    }
    return Jet{horner(values, degree_u_, along_u.local), slope_of(values, degree_u_, along_u.local),
               horner(slopes, degree_u_, along_u.local)};
  };
  Jet n = jet(coordinate);
  if (rational_) {
    const Jet d = jet(dim_);
    const double value = n.value / d.value;
    n.by_u = (n.by_u - value * d.by_u) / d.value;
    n.by_v = (n.by_v - value * d.by_v) / d.value;
  }
  return {n.by_u * inverse_widths_u_[index_of(along_u.cell)],
          n.by_v * inverse_widths_v_[index_of(along_v.cell)]};
}

}  // namespace knotwave::curves

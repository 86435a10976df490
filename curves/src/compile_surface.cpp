// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "knotwave/curves/surface_program.h"

#include "span_polynomial.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

HomogeneousCurve direction(int degree, const KnotSequence& sequence) {
  HomogeneousCurve curve;
  curve.degree = degree;
  curve.dim = kMaxDim;
  curve.domain = sequence.domain();
  curve.knots = sequence.all();
  return curve;
}

}  // namespace

/// Rows to powers of s first, then what they hold, as points along v, to powers of t.
class SurfaceCompiler {
 public:
  explicit SurfaceCompiler(const NurbsSurface& surface) : surface_(surface) {
    program_.dim_ = surface.dim();
    program_.degree_u_ = surface.degree_u();
    program_.degree_v_ = surface.degree_v();
    program_.rational_ = surface.is_rational();
    program_.periodic_u_ = surface.is_periodic_u();
  }

  Result<SurfaceProgram> compiled() {
    if (auto ok = check_degree("u", surface_.degree_u()); !ok) return ok.error();
    if (auto ok = check_degree("v", surface_.degree_v()); !ok) return ok.error();
    const auto rows = row_spans();
    const auto along_v = direction(surface_.degree_v(), {surface_.knots_v(), surface_.degree_v()});
    take_breaks(rows.front(), program_.breaks_u_, program_.inverse_widths_u_);
    take_hull();
    // cells[i][k]: power k of s in cell i, as pieces along v.
    std::vector<std::vector<std::vector<SpanPolynomial>>> cells(rows.front().size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (int k = 0; k <= surface_.degree_u(); ++k) {
        HomogeneousCurve column = along_v;
        for (const auto& row : rows) column.points.push_back(power_of(row[i], k));
        cells[i].push_back(span_polynomials(column));
      }
    }
    take_breaks(cells.front().front(), program_.breaks_v_, program_.inverse_widths_v_);
    write_cells(cells);
    bound_error();
    return std::move(program_);
  }

 private:
  Result<void> check_degree(const char* name, int degree) const {
    if (degree <= kMaxPieceDegree) return {};
    return fail(ErrorCode::degree_out_of_range, "surface '" + surface_.name() + "': degree " +
                                                    std::to_string(degree) + " along " + name +
                                                    " is above " + std::to_string(kMaxPieceDegree) +
                                                    ", the most that can be played");
  }

  std::vector<std::vector<SpanPolynomial>> row_spans() const {
    const auto along_u = direction(
        surface_.degree_u(), {surface_.knots_u(), surface_.degree_u(), surface_.is_periodic_u()});
    const std::size_t dim = at(surface_.dim()), row = at(surface_.count_u());
    std::vector<std::vector<SpanPolynomial>> spans;
    for (std::size_t b = 0; b < at(surface_.count_v()); ++b) {
      HomogeneousCurve curve = along_u;
      for (std::size_t i = b * row; i < (b + 1) * row; ++i) {
        curve.points.emplace_back(surface_.points().subspan(i * dim, dim),
                                  surface_.is_rational() ? surface_.weights()[i] : 1.0);
      }
      spans.push_back(span_polynomials(curve));
    }
    return spans;
  }

  static HomogeneousPoint power_of(const SpanPolynomial& span, int k) {
    HomogeneousPoint point;
    for (int c = 0; c < kMaxDim; ++c) point.x[at(c)] = span.row(c)[at(k)];
    point.w = span.row(kMaxDim)[at(k)];
    return point;
  }

  static void take_breaks(const std::vector<SpanPolynomial>& spans, std::vector<double>& breaks,
                          std::vector<double>& inverse_widths) {
    breaks = {spans.front().u0};
    inverse_widths.clear();
    for (const SpanPolynomial& span : spans) {
      breaks.push_back(span.u1);
      inverse_widths.push_back(1 / (span.u1 - span.u0));
    }
  }

  void take_hull() {
    const std::size_t dim = at(surface_.dim());
    const auto points = surface_.points();
    program_.low_.assign(points.begin(), points.begin() + surface_.dim());
    program_.high_ = program_.low_;
    for (std::size_t i = 0; i < points.size(); ++i) {
      program_.low_[i % dim] = std::min(program_.low_[i % dim], points[i]);
      program_.high_[i % dim] = std::max(program_.high_[i % dim], points[i]);
    }
  }

  void write_cells(const std::vector<std::vector<std::vector<SpanPolynomial>>>& cells) {
    program_.coefficients_.clear();
    for (std::size_t j = 0; j < program_.inverse_widths_v_.size(); ++j) {
      for (const auto& powers : cells) {
        for (int row = 0; row <= program_.dim_; ++row) {
          if (row == program_.dim_ && !program_.rational_) break;
          for (const auto& pieces : powers) {
            for (const DoubleDouble c : pieces[j].row(row == program_.dim_ ? kMaxDim : row)) {
              program_.coefficients_.push_back(c.hi);
            }
          }
        }
      }
    }
  }

  // Horner in t, then in s: 2 roundings a power, 3 in each local parameter, 1 of the coefficient;
  // all of them to first order on the sum of magnitudes, and 1 % for the higher orders. A quotient
  // passes on both errors over the least denominator, no less than the least weight.
  void bound_error() {
    const int p = program_.degree_u_, q = program_.degree_v_;
    const double unit = (5.0 * (p + q) + 4) * 0x1p-53 * 1.01;
    const std::size_t powers = at(p + 1) * at(q + 1);
    const std::size_t rows = at(program_.dim_) + (program_.rational_ ? 1U : 0U);
    const auto weights = surface_.weights();
    const double least_weight =
        program_.rational_ ? *std::min_element(weights.begin(), weights.end()) : 1.0;
    double largest = 0;
    for (const double x : surface_.points()) largest = std::max(largest, std::abs(x));
    for (std::size_t cell = 0; cell < program_.coefficients_.size(); cell += powers * rows) {
      double of_row[kMaxDim + 1] = {};
      for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t k = 0; k < powers; ++k) {
          of_row[r] += std::abs(program_.coefficients_[cell + r * powers + k]);
        }
      }
      for (std::size_t c = 0; c < at(program_.dim_); ++c) {
        double error = of_row[c] * unit;
        if (program_.rational_) {
          error = (error + of_row[program_.dim_] * unit * largest) / least_weight;
        }
        program_.max_error_ = std::max(program_.max_error_, error + largest * 0x1p-52);
      }
    }
  }

  const NurbsSurface& surface_;
  SurfaceProgram program_;
};

Result<SurfaceProgram> compile_surface(const NurbsSurface& surface) {
  return SurfaceCompiler(surface).compiled();
}

}  // namespace knotwave::curves

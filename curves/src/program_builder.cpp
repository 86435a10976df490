// SPDX-License-Identifier: MIT
#include "program_builder.h"

#include <algorithm>
#include <cmath>

#include "piece_bounds.h"

namespace knotwave::curves {
namespace {

double size_of(const double* row, int degree) {
  double sum = 0;
  for (int k = 0; k <= degree; ++k) sum += std::abs(row[k]);
  return sum;
}

/// Whether rounding included, the piece never comes near low or high, so clamping changes nothing.
/// Horner of degree <= 7 errs by less than 16 * 2^-53 of the sum of |c| (Higham, Accuracy and
/// Stability of Numerical Algorithms, 2nd ed., 5.1); 1e-12 leaves room for the bound's own
/// rounding.
bool stays_inside(const double* n, const double* d, int degree, double low, double high) {
  const auto powers = static_cast<std::size_t>(degree) + 1;
  const PieceRow top = bernstein_row({n, powers});
  PieceRow bottom;
  bottom.fill(1.0);
  double margin = 1e-12 * size_of(n, degree);
  if (d != nullptr) {
    bottom = bernstein_row({d, powers});
    const double least = *std::min_element(bottom.begin(), bottom.begin() + degree + 1);
    const double weight = 1e-12 * size_of(d, degree);
    if (!(least > 2 * weight)) return false;
    margin = (margin + weight * std::max(std::abs(low), std::abs(high))) / (least - weight);
  }
  for (std::size_t j = 0; j < powers; ++j) {
    const double y = top[j] / bottom[j];
    if (!(y - margin > low && y + margin < high)) return false;
  }
  return true;
}

}  // namespace

CurveProgram ProgramBuilder::build(ProgramParts parts) {
  CurveProgram program;
  const std::size_t dim = static_cast<std::size_t>(parts.dim);
  program.inverse_widths_.clear();
  program.inside_hull_.assign(parts.pieces() * dim, 0);
  for (std::size_t i = 0; i < parts.pieces(); ++i) {
    program.inverse_widths_.push_back(1.0 / (parts.breaks[i + 1] - parts.breaks[i]));
    const double* piece = parts.coefficients.data() + i * parts.piece_size();
    for (std::size_t c = 0; c < dim && parts.control_rest.empty(); ++c) {
      const double* d = parts.rational ? piece + dim * parts.powers() : nullptr;
      program.inside_hull_[i * dim + c] =
          stays_inside(piece + c * parts.powers(), d, parts.degree, parts.low[c], parts.high[c]);
    }
  }
  program.dim_ = parts.dim;
  program.degree_ = parts.degree;
  program.rational_ = parts.rational;
  program.periodic_ = parts.periodic;
  program.piece_size_ = parts.piece_size();
  program.max_error_ = parts.max_error;
  program.inverse_period_ = 1.0 / (parts.breaks.back() - parts.breaks.front());
  program.breaks_ = std::move(parts.breaks);
  program.coefficients_ = std::move(parts.coefficients);
  program.start_values_ = std::move(parts.start_values);
  program.end_values_ = std::move(parts.end_values);
  program.low_ = std::move(parts.low);
  program.high_ = std::move(parts.high);
  program.control_rest_ = std::move(parts.control_rest);
  program.control_low_ = std::move(parts.control_low);
  program.control_high_ = std::move(parts.control_high);
  program.live_ = std::move(parts.live);
  return program;
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// What holds the values of a piece, and what they may be off by. Private to curves. [control]
#pragma once
#include <array>
#include <cmath>
#include <span>

#include "knotwave/curves/curve_program.h"

namespace knotwave::curves {

/// Numbers of one row, the first degree + 1 in use.
using PieceRow = std::array<double, kMaxPieceDegree + 1>;

/// Powers of t to Bernstein coefficients, which hold the row's values on 0 <= t <= 1.
inline PieceRow bernstein_row(std::span<const double> powers) {
  // b_j = sum of C(j, k) / C(p, k) c_k: divide, then add up p times.
  PieceRow b{};
  const std::size_t count = powers.size();
  double choose = 1;
  for (std::size_t k = 0; k < count; ++k) {
    b[k] = powers[k] / choose;
    choose = choose * static_cast<double>(count - 1 - k) / static_cast<double>(k + 1);
  }
  for (std::size_t from = 1; from < count; ++from) {
    for (std::size_t j = count - 1; j >= from; --j) b[j] += b[j - 1];
  }
  return b;
}

/// What a row's value is off by, in units of 2^-53. Of the power k: 1 rounding of the coefficient,
/// 2 k + 1 of Horner's products and sums, and 4 k of t, which is a difference times an inverse of a
/// width (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 5.1). Clamping to the
/// hull only brings a value nearer.
inline double rounding_units(std::span<const double> row) {
  double units = 0;
  for (std::size_t k = 0; k < row.size(); ++k) {
    units += static_cast<double>(6 * k + 2) * std::abs(row[k]);
  }
  return units;
}

}  // namespace knotwave::curves

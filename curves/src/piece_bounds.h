// SPDX-License-Identifier: MIT
// What holds the values of a piece. Private to curves. [control]
#pragma once
#include <array>
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

}  // namespace knotwave::curves

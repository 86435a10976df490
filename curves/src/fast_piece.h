// SPDX-License-Identifier: MIT
// Pieces of a program in float32, and a bound on what that rounds away. Private to curves.
// [control]
#pragma once
#include <span>

#include "piece_bounds.h"

namespace knotwave::curves {

/// A row of a piece in float32, or the quotient of two: what it is worth and where it lies.
struct FastRow {
  double error = 0;  ///< no value by fast_horner() is further from the row's own
  double low = 0;    ///< the row's values are between these, for 0 <= t <= 1
  double high = 0;
  PieceRow bernstein{};  ///< its Bernstein coefficients, up to `rounding`
  double rounding = 0;
};

/// The powers of t `row` as powers of s = t - 1/2, rounded to `out`.
FastRow make_fast_row(std::span<const double> row, std::span<float> out);

/// The quotient of two rows of a degree, |quotient| <= largest. Its error is infinite where the
/// divisor's error leaves it no sign.
FastRow quotient_of(const FastRow& numerator, const FastRow& denominator, int degree,
                    double largest);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "fast_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "piece_bounds.h"

namespace knotwave::curves {
namespace {

constexpr double kUnit = 0x1p-24;  // half of what a float's last bit is worth
/// |s|, a little more than 1/2 because it is rounded.
constexpr double kReach = 0.5 + 0x1p-20;
/// What s = base + k * step is off by: 2^-26 for base and for the sum, both at most 1/2; 2^-24 for
/// `step` and 2^-25 for the product, both at most 1 from end to end; 2^-26 for the nodes, at most
/// 2^24 widths from 0, in double. A little is added for |s| and |k * step| just above those limits.
constexpr double kLocalError = 1.3 * 0x1p-23;
/// For squares of kUnit and for the rounding of the bound itself.
constexpr double kRoom = 1 + 0x1p-12;

/// Powers of t to powers of t - 1/2, in place (synthetic division).
void centre(std::span<double> c) {
  for (std::size_t i = 0; i + 1 < c.size(); ++i) {
    for (std::size_t k = c.size() - 1; k-- > i;) c[k] += 0.5 * c[k + 1];
  }
}

}  // namespace

FastRow make_fast_row(std::span<const double> row, std::span<float> out) {
  PieceRow centred{};
  std::copy(row.begin(), row.end(), centred.begin());
  centre(std::span(centred).first(row.size()));
  double size = 0;
  for (const double c : row) size += std::abs(c);
  FastRow fast;
  fast.rounding = 0x1p-47 * size;  // sums in double: the centring, the bounds, the program's own t
  fast.bernstein = bernstein_row(row);
  const double* const b = fast.bernstein.data();
  const auto [low, high] = std::minmax_element(b, b + row.size());
  fast.low = *low - fast.rounding;
  fast.high = *high + fast.rounding;
  double slope = 0;
  for (std::size_t j = 1; j < row.size(); ++j) slope = std::max(slope, std::abs(b[j] - b[j - 1]));
  slope *= static_cast<double>(row.size() - 1);

  // Horner from the top: `value` bounds what is in the register, `error` what is wrong with it.
  double value = 0, error = 0;
  for (std::size_t k = row.size(); k-- > 0;) {
    out[k] = static_cast<float>(centred[k]);
    const double product = kReach * (value + error);
    value = std::abs(centred[k]) + kReach * value;
    if (k == 0) value = std::min(value, std::max(std::abs(fast.low), std::abs(fast.high)));
    const double coefficient = std::abs(centred[k] - double(out[k]));
    const double sum = k + 1 == row.size() ? 0 : kUnit * (product + value + error);
    error = kReach * error + coefficient + sum;
  }
  fast.error = kRoom * (error + kLocalError * slope) + fast.rounding + 1e-40;
  return fast;
}

FastRow quotient_of(const FastRow& numerator, const FastRow& denominator, int degree,
                    double largest) {
  FastRow quotient;
  quotient.error = std::numeric_limits<double>::infinity();
  const double least = denominator.low - denominator.error;
  if (!(least > 0)) return quotient;
  const double error = (numerator.error + largest * denominator.error) / least;
  quotient.error = kRoom * (error + kUnit * (largest + error));
  // Quotients of Bernstein coefficients are control points: they hold the curve.
  quotient.low = std::numeric_limits<double>::infinity();
  quotient.high = -quotient.low;
  for (int j = 0; j <= degree; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double point = numerator.bernstein[k] / denominator.bernstein[k];
    quotient.low = std::min(quotient.low, point);
    quotient.high = std::max(quotient.high, point);
  }
  quotient.rounding = 2 * (numerator.rounding + largest * denominator.rounding) / least;
  quotient.low -= quotient.rounding;
  quotient.high += quotient.rounding;
  return quotient;
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "span_basis.h"

#include <algorithm>
#include <cmath>

namespace knotwave::curves {

SpanBasis::SpanBasis(std::span<const double> knots, int degree, int span, double u) noexcept {
  rows[0][0] = 1.0;
  for (int k = 1; k <= degree; ++k) {
    DoubleDouble from_left = 0.0;
    for (int r = 0; r < k; ++r) {
      // Both knots differ: the support of N_{i,k-1} holds the span, which has a length.
      const double left = knots[static_cast<std::size_t>(span - k + 1 + r)];
      const double right = knots[static_cast<std::size_t>(span + 1 + r)];
      const DoubleDouble part = rows[k - 1][r] / DoubleDouble::difference(right, left);
      rows[k][r] = from_left + DoubleDouble::difference(right, u) * part;
      from_left = DoubleDouble::difference(u, left) * part;
    }
    rows[k][k] = from_left;
  }
}

double KnotDomain::place(double u, Side side) const noexcept {
  if (std::isnan(u)) return low;
  if (!periodic) return std::clamp(u, low, high);
  if (!std::isfinite(u)) return low;
  if (u < low || u >= high) {
    const double period = high - low;
    u -= std::floor((u - low) / period) * period;
    if (!(u >= low && u < high)) u = low;  // one rounding below a whole number of periods
  }
  return side == Side::left && u == low ? high : u;
}

}  // namespace knotwave::curves

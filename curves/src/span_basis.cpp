// SPDX-License-Identifier: MIT
#include "span_basis.h"

#include <algorithm>
#include <cmath>

namespace knotwave::curves {

SpanBasis::SpanBasis(std::span<const double> knots, int degree, int span, double u) noexcept
    : knots_(knots), degree_(degree), span_(span) {
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

void SpanBasis::derivative(int k, std::span<DoubleDouble> out) const noexcept {
  // A curve's derivative has the points q (P_{i+1} - P_i) / (its knots' distance), q the degree
  // before: so each step hands a basis function of degree q - 1 to its two neighbours of degree q.
  for (int r = 0; r <= degree_ - k; ++r) out[static_cast<std::size_t>(r)] = rows[degree_ - k][r];
  for (int q = degree_ - k + 1; q <= degree_; ++q) {
    DoubleDouble from_left = 0.0;
    for (int r = 0; r < q; ++r) {
      const double left = knots_[static_cast<std::size_t>(span_ - q + 1 + r)];
      const double right = knots_[static_cast<std::size_t>(span_ + 1 + r)];
      const DoubleDouble part = out[static_cast<std::size_t>(r)] * static_cast<double>(q) /
                                DoubleDouble::difference(right, left);
      out[static_cast<std::size_t>(r)] = from_left - part;
      from_left = part;
    }
    out[static_cast<std::size_t>(q)] = from_left;
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

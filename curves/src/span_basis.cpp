// SPDX-License-Identifier: MIT
#include "span_basis.h"

namespace knotwave::curves {

SpanBasis::SpanBasis(const KnotSequence& knots, int span, double u) noexcept
    : degree_(knots.degree) {
  const KnotDomain domain = knots.domain();
  const Knot here = domain.knot(u);
  for (int j = 0; j < degree_; ++j) {
    below_[j] = domain.distance(knots[span - j], here);
    above_[j] = domain.distance(here, knots[span + 1 + j]);
  }
  rows[0][0] = 1.0;
  for (int k = 1; k <= degree_; ++k) {
    DoubleDouble from_left = 0.0;
    for (int r = 0; r < k; ++r) {
      // Not 0: the support of N_{i,k-1} holds the span, which has a length.
      const DoubleDouble part = rows[k - 1][r] / support(k, r);
      rows[k][r] = from_left + above_[r] * part;
      from_left = below_[k - 1 - r] * part;
    }
    rows[k][k] = from_left;
  }
}

void SpanBasis::derivative(int k, std::span<DoubleDouble> out, double unit) const noexcept {
  // A curve's derivative has the points q (P_{i+1} - P_i) / (its knots' distance), q the degree
  // before: so each step hands a basis function of degree q - 1 to its two neighbours of degree q.
  for (int r = 0; r <= degree_ - k; ++r) out[static_cast<std::size_t>(r)] = rows[degree_ - k][r];
  for (int q = degree_ - k + 1; q <= degree_; ++q) {
    DoubleDouble from_left = 0.0;
    for (int r = 0; r < q; ++r) {
      const DoubleDouble length = support(q, r);
      const DoubleDouble part = out[static_cast<std::size_t>(r)] * static_cast<double>(q) /
                                DoubleDouble(unit * length.hi, unit * length.lo);
      out[static_cast<std::size_t>(r)] = from_left - part;
      from_left = part;
    }
    out[static_cast<std::size_t>(q)] = from_left;
  }
}

}  // namespace knotwave::curves

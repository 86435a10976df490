// SPDX-License-Identifier: MIT
// The spans of a curve as polynomials of a local t in [0, 1], in double-double. Private to curves.
// [control]
#pragma once
#include <span>
#include <vector>

#include "double_double.h"
#include "homogeneous.h"

namespace knotwave::curves {

/// Weighted coordinates and weight of one span as powers of t = (u - u0) / (u1 - u0).
struct SpanPolynomial {
  double u0 = 0;
  double u1 = 1;
  int degree = 0;
  int dim = 0;
  bool has_weights = true;           ///< false where the weight is 1 all along
  bool is_whole = false;             ///< a Bézier curve's only span: `bezier` is exact then
  std::vector<DoubleDouble> rows;    ///< [(dim + 1) * (degree + 1)], row dim is the weight
  std::vector<DoubleDouble> bezier;  ///< the same as Bernstein coefficients, which cancel nothing

  std::span<const DoubleDouble> row(int index) const { return row_of(rows, index); }
  std::span<const DoubleDouble> bezier_row(int index) const { return row_of(bezier, index); }

 private:
  std::span<const DoubleDouble> row_of(std::span<const DoubleDouble> all, int index) const {
    const std::size_t powers = static_cast<std::size_t>(degree) + 1;
    return all.subspan(static_cast<std::size_t>(index) * powers, powers);
  }
};

/// Bernstein coefficients to powers of t, to out[b.size()]: C(degree, k) times the k-th forward
/// difference, for each k. The differences cancel up to 2^k of the coefficients' size, hence
/// double-double.
void bernstein_to_powers(std::vector<DoubleDouble>& b, std::span<DoubleDouble> out);

/// One for each span of positive length, in order.
std::vector<SpanPolynomial> span_polynomials(const HomogeneousCurve& curve);

/// c[0] + c[1] t + ... by Horner.
DoubleDouble polynomial_at(std::span<const DoubleDouble> c, DoubleDouble t) noexcept;
/// Its derivative by t.
DoubleDouble polynomial_slope_at(std::span<const DoubleDouble> c, DoubleDouble t) noexcept;

/// Coordinate `coordinate` at t.
DoubleDouble coordinate_at(const SpanPolynomial& span, int coordinate, DoubleDouble t) noexcept;

/// Its derivative by t, of any span without or with weights.
DoubleDouble coordinate_slope_at(const SpanPolynomial& span, int coordinate,
                                 DoubleDouble t) noexcept;

}  // namespace knotwave::curves

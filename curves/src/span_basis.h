// SPDX-License-Identifier: MIT
// The basis functions that live on one span, of every degree up to p.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: A2.2, all levels kept as A2.3 needs them.
#pragma once
#include <span>

#include "knot_domain.h"

namespace knotwave::curves {

/// rows[k][r] is N_{span-k+r, k}(u), u in span `span`. Only k <= degree, r <= k are set. Every term
/// is a product of numbers that are not negative, so each value is right to its own last bits.
struct SpanBasis {
  DoubleDouble rows[kMaxDegree + 1][kMaxDegree + 1];

  SpanBasis(const KnotSequence& knots, int span, double u) noexcept;

  /// The k-th derivatives of the degree + 1 basis functions, k <= degree, to out[degree+1] (A2.3),
  /// by u * unit, `unit` a power of two.
  void derivative(int k, std::span<DoubleDouble> out, double unit = 1) const noexcept;
  /// Of the span.
  double length() const noexcept { return support(1, 0).hi; }

 private:
  /// Length of the support of rows[k-1][r], which divides it on the way to degree k.
  DoubleDouble support(int k, int r) const noexcept { return below_[k - 1 - r] + above_[r]; }

  int degree_;
  DoubleDouble below_[kMaxDegree];  ///< u - knots[span - j]
  DoubleDouble above_[kMaxDegree];  ///< knots[span + 1 + j] - u
};

}  // namespace knotwave::curves

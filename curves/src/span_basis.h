// SPDX-License-Identifier: MIT
// The basis functions that live on one span, of every degree up to p.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: A2.2, all levels kept as A2.3 needs them.
#pragma once
#include <span>

#include "knotwave/curves/nurbs_curve.h"

#include "double_double.h"

namespace knotwave::curves {

/// rows[k][r] is N_{span-k+r, k}(u). Only k <= degree, r <= k are set. Every term is a product of
/// numbers that are not negative, so each value is right to its own last bits.
struct SpanBasis {
  DoubleDouble rows[kMaxDegree + 1][kMaxDegree + 1];

  SpanBasis(std::span<const double> knots, int degree, int span, double u) noexcept;

  /// The k-th derivatives of the degree + 1 basis functions, k <= degree, to out[degree+1] (A2.3).
  void derivative(int k, std::span<DoubleDouble> out) const noexcept;

 private:
  std::span<const double> knots_;
  int degree_;
  int span_;
};

/// Where a curve is defined, and what a parameter outside of it means.
struct KnotDomain {
  double low = 0;
  double high = 1;
  bool periodic = false;

  /// u inside [low, high]: clamped, or wrapped (high becomes low, except for Side::left, where low
  /// becomes high). NaN and infinite phases count as low.
  double place(double u, Side side) const noexcept;
};

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// A span whose first coordinate is time: where it is x. Private to curves. [control]
#pragma once
#include <vector>

#include "bernstein.h"
#include "span_polynomial.h"

namespace knotwave::curves {

/// Where a span's time is x: the root of N(t) - x D(t), which never falls on [0, 1]. Newton inside
/// a bracket; at a vertical tangent the root is multiple and halving the bracket takes over.
/// Doubles come near, double-double steps do the rest.
class SpanClock {
 public:
  explicit SpanClock(const SpanPolynomial& span)
      : span_(&span), c_(span.row(0).size()), near_(c_.size()) {}

  /// t in [0, 1]; times outside the span give its ends. Remembers t as the next first guess.
  DoubleDouble parameter_at(DoubleDouble x);

  /// An interval of t that time x is in for certain, rounding included: a point at the ends, narrow
  /// where time moves, as wide as 1e-10 at a vertical tangent inside.
  struct Around {
    DoubleDouble low, high;
  };
  Around around(double x);

 private:
  template <class Real>
  Real root(std::span<const Real> c, Real t) const;
  double slope(double t) const;

  const SpanPolynomial* span_;
  std::vector<DoubleDouble> c_;  // N - x D
  std::vector<double> near_;     // rounded
  DoubleDouble t_ = 0.5;
};

}  // namespace knotwave::curves

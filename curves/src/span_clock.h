// SPDX-License-Identifier: MIT
// A span whose first coordinate is time: where it is x. Private to curves. [control]
#pragma once
#include <vector>

#include "bernstein.h"
#include "span_polynomial.h"

namespace knotwave::curves {

/// A span by its local time: time, or what has gone by since `origin` (what is still to go to it,
/// where t runs against time). It never falls on [0, 1].
struct TimedSpan {
  SpanPolynomial of;  ///< row 0: local time
  double origin = 0;
  bool is_backward = false;
  bool is_exact = false;  ///< each Bernstein coefficient right to 2^-104 of itself, or to 2^-950

  DoubleDouble local(DoubleDouble x) const {
    const DoubleDouble since = x - DoubleDouble(origin);
    return is_backward ? -since : since;
  }
  DoubleDouble time_at(DoubleDouble t) const {
    const DoubleDouble local = coordinate_at(of, 0, t);
    return DoubleDouble(origin) + (is_backward ? -local : local);
  }
  /// The ends of [0, 1] that come first and last in time.
  double first() const { return is_backward ? 1 : 0; }
  double last() const { return is_backward ? 0 : 1; }
};

/// Where a span's time is x: the root of N(t) - x D(t), local time both. Newton inside a bracket;
/// at a vertical tangent the root is multiple and halving the bracket takes over. Doubles come
/// near, double-double steps do the rest.
class SpanClock {
 public:
  explicit SpanClock(const TimedSpan& span)
      : span_(&span), c_(span.of.row(0).size()), near_(c_.size()) {}

  /// t in [0, 1]; times outside the span give its ends. Remembers t as the next first guess.
  DoubleDouble parameter_at(DoubleDouble x);

  /// An interval of t with a place in it where time is x, for certain, rounding included: a point
  /// at the ends, narrow where time moves, as wide as 1e-10 at a vertical tangent inside, and wider
  /// where time stands still to a higher order and the span is not cut there (flat_times.h).
  struct Around {
    DoubleDouble low, high;
  };
  Around around(double x);

 private:
  template <class Real>
  Real root(std::span<const Real> c, Real t) const;
  double slope(double t) const;
  DoubleDouble root_at(DoubleDouble local);

  const TimedSpan* span_;
  std::vector<DoubleDouble> c_;  // N - x D
  std::vector<double> near_;     // rounded
  DoubleDouble t_ = 0.5;
};

}  // namespace knotwave::curves

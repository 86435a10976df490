// SPDX-License-Identifier: MIT
// Directions and arcs of the unit circle in double-double, so that a circle's points are rounded
// once. Private to curves. [control]
#pragma once
#include <string>
#include <vector>

#include "knotwave/base/result.h"

#include "double_double.h"

namespace knotwave::curves {

/// (cos, sin) of an angle; x^2 + y^2 = 1 to 2^-100.
struct UnitVector {
  DoubleDouble x;
  DoubleDouble y;
};

/// Square root of a > 0, right to 2^-100 of itself.
DoubleDouble square_root(DoubleDouble a) noexcept;

/// The direction of (x, y), not both 0.
UnitVector direction_of(DoubleDouble x, DoubleDouble y) noexcept;
/// At an angle in cycles, |cycles| < 2^51; the angle is right to 2^-52 cycles, multiples of 1/4 are
/// exact.
UnitVector direction_at(double cycles) noexcept;

/// Half way from a to b, which differ, counter-clockwise or clockwise; any arc short of a turn.
UnitVector half_way(UnitVector a, UnitVector b, bool counter_clockwise) noexcept;

/// The arc from a to b, less than half a turn, as a rational quadratic: a, `middle` with this
/// weight, b with weight 1.
struct ArcMiddle {
  DoubleDouble x;
  DoubleDouble y;
  DoubleDouble weight;
};
ArcMiddle arc_middle(UnitVector a, UnitVector b) noexcept;

/// An arc of the unit circle over [0, 1], as rational quadratics of a quarter at most.
struct UnitArc {
  struct Point {
    DoubleDouble x;
    DoubleDouble y;
    DoubleDouble weight;
  };
  std::vector<Point> points;  ///< the first and the last of a whole circle are the same
  std::vector<double> knots;
};
/// From `start` on, in cycles; lengths below 0 are clockwise. Errors: not_finite,
/// value_out_of_range (length 0 or above 1 in magnitude); `what` begins the message.
Result<UnitArc> unit_arc(const std::string& what, double start_cycles, double length_cycles);

}  // namespace knotwave::curves

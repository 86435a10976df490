// SPDX-License-Identifier: MIT
// Directions and arcs of the unit circle in double-double, so that a circle's points are rounded
// once. Private to curves. [control]
#pragma once
#include "double_double.h"

namespace knotwave::curves {

/// (cos, sin) of an angle; x^2 + y^2 = 1 to 2^-100.
struct Direction {
  DoubleDouble x;
  DoubleDouble y;
};

/// Square root of a > 0, right to 2^-100 of itself.
DoubleDouble square_root(DoubleDouble a) noexcept;

/// The direction of (x, y), not both 0.
Direction direction_of(DoubleDouble x, DoubleDouble y) noexcept;
/// At an angle in cycles, |cycles| < 2^51; the angle is right to 2^-52 cycles, multiples of 1/4 are
/// exact.
Direction direction_at(double cycles) noexcept;

/// Half way from a to b, which differ, counter-clockwise or clockwise; any arc short of a turn.
Direction half_way(Direction a, Direction b, bool counter_clockwise) noexcept;

/// The arc from a to b, less than half a turn, as a rational quadratic: a, `middle` with this
/// weight, b with weight 1.
struct ArcMiddle {
  DoubleDouble x;
  DoubleDouble y;
  DoubleDouble weight;
};
ArcMiddle arc_middle(Direction a, Direction b) noexcept;

}  // namespace knotwave::curves

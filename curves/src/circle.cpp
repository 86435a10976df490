// SPDX-License-Identifier: MIT
#include "circle.h"

#include <cmath>

#include "knotwave/base/elementary.h"

namespace knotwave::curves {

DoubleDouble square_root(DoubleDouble a) noexcept {
  const double root = std::sqrt(a.hi);
  const DoubleDouble rest = a - DoubleDouble::product(root, root);
  return DoubleDouble(root) + rest / DoubleDouble(2 * root);
}

Direction direction_of(DoubleDouble x, DoubleDouble y) noexcept {
  const DoubleDouble length = square_root(x * x + y * y);
  return {x / length, y / length};
}

Direction direction_at(double cycles) noexcept {
  const base::SinCos at = base::sin_cos_cycles(cycles);
  return direction_of(at.cos, at.sin);
}

Direction half_way(Direction a, Direction b, bool counter_clockwise) noexcept {
  // Seen along the chord a counter-clockwise arc bulges to the right.
  const DoubleDouble along_x = b.x - a.x, along_y = b.y - a.y;
  return counter_clockwise ? direction_of(along_y, -along_x) : direction_of(-along_y, along_x);
}

ArcMiddle arc_middle(Direction a, Direction b) noexcept {
  const DoubleDouble bottom = DoubleDouble(1.0) + a.x * b.x + a.y * b.y;
  return {(a.x + b.x) / bottom, (a.y + b.y) / bottom, square_root(bottom / DoubleDouble(2.0))};
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "circle.h"

#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"

namespace knotwave::curves {

DoubleDouble square_root(DoubleDouble a) noexcept {
  const double root = std::sqrt(a.hi);
  const DoubleDouble rest = a - DoubleDouble::product(root, root);
  return DoubleDouble(root) + rest / DoubleDouble(2 * root);
}

UnitVector direction_of(DoubleDouble x, DoubleDouble y) noexcept {
  const DoubleDouble length = square_root(x * x + y * y);
  return {x / length, y / length};
}

UnitVector direction_at(double cycles) noexcept {
  const base::SinCos at = base::sin_cos_cycles(cycles);
  return direction_of(at.cos, at.sin);
}

UnitVector half_way(UnitVector a, UnitVector b, bool counter_clockwise) noexcept {
  // Seen along the chord a counter-clockwise arc bulges to the right.
  const DoubleDouble along_x = b.x - a.x, along_y = b.y - a.y;
  return counter_clockwise ? direction_of(along_y, -along_x) : direction_of(-along_y, along_x);
}

ArcMiddle arc_middle(UnitVector a, UnitVector b) noexcept {
  const DoubleDouble bottom = DoubleDouble(1.0) + a.x * b.x + a.y * b.y;
  return {(a.x + b.x) / bottom, (a.y + b.y) / bottom, square_root(bottom / DoubleDouble(2.0))};
}

Result<UnitArc> unit_arc(const std::string& what, double start_cycles, double length_cycles) {
  using base::number_text;
  if (!std::isfinite(start_cycles) || !std::isfinite(length_cycles)) {
    return fail(ErrorCode::not_finite, what + " from " + number_text(start_cycles) + " cycles, " +
                                           number_text(length_cycles) + " long, is not finite");
  }
  if (length_cycles == 0 || std::abs(length_cycles) > 1) {
    return fail(ErrorCode::value_out_of_range,
                what + " " + number_text(length_cycles) +
                    " cycles long: the length must be within -1..1 and not 0");
  }
  const double start = start_cycles - std::floor(start_cycles);
  const int pieces = static_cast<int>(std::ceil(4 * std::abs(length_cycles)));
  const UnitVector first = direction_at(start);
  UnitVector from = first;
  UnitArc arc{{{first.x, first.y, 1.0}}, {0, 0, 0}};
  for (int i = 1; i <= pieces; ++i) {
    const bool closes = i == pieces && std::abs(length_cycles) == 1;
    const UnitVector to = closes ? first : direction_at(start + length_cycles * i / pieces);
    const ArcMiddle middle = arc_middle(from, to);
    arc.points.push_back({middle.x, middle.y, middle.weight});
    arc.points.push_back({to.x, to.y, 1.0});
    arc.knots.insert(arc.knots.end(), i == pieces ? 3 : 2, static_cast<double>(i) / pieces);
    from = to;
  }
  return arc;
}

}  // namespace knotwave::curves

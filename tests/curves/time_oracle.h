// SPDX-License-Identifier: MIT
// y at a time of one polynomial Bézier segment (x0, y0, x1, y1, ...) by halving in quadruple
// precision: nothing in common with pieces, and right to 2^-37 even where x is like t^3.
#pragma once
#include <array>
#include <span>

namespace knotwave::test {

using Wide = __float128;

/// Coordinate c at t.
inline Wide segment_at(std::span<const double> points, std::size_t c, Wide t) {
  std::array<Wide, 16> row{};
  const std::size_t count = points.size() / 2;
  for (std::size_t i = 0; i < count; ++i) row[i] = points[2 * i + c];
  for (std::size_t level = count - 1; level > 0; --level) {
    for (std::size_t i = 0; i < level; ++i) row[i] += t * (row[i + 1] - row[i]);
  }
  return row[0];
}

inline Wide segment_parameter(std::span<const double> points, Wide x) {
  Wide low = 0, high = 1;
  for (int step = 0; step < 80; ++step) {
    const Wide middle = (low + high) / 2;
    (segment_at(points, 0, middle) < x ? low : high) = middle;
  }
  return (low + high) / 2;
}

inline double segment_value(std::span<const double> points, double x) {
  return static_cast<double>(segment_at(points, 1, segment_parameter(points, x)));
}

}  // namespace knotwave::test

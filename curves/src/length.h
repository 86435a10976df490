// SPDX-License-Identifier: MIT
// Euclidean length, also where the squares of its coordinates would be no numbers any more.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>

namespace knotwave::curves {

inline double length_of(std::span<const double> coordinates) noexcept {
  double largest = 0;
  for (const double x : coordinates) largest = std::max(largest, std::abs(x));
  const double scale = largest < 0x1p-450 ? 0x1p600 : largest > 0x1p450 ? 0x1p-600 : 1.0;
  double square = 0;
  for (const double x : coordinates) square += (x * scale) * (x * scale);
  return std::sqrt(square) / scale;
}

}  // namespace knotwave::curves

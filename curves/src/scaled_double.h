// SPDX-License-Identifier: MIT
// Numbers that may pass the range of doubles on their way: a double and a power of two beside it.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwave::curves {

/// 2^exponent, exponent -1022..1023.
inline double power_of_two(int exponent) noexcept {
  double power = 1;
  for (; exponent > 0; --exponent) power *= 2;
  for (; exponent < 0; ++exponent) power *= 0.5;
  return power;
}

/// value * 2^exponent, the largest double with its sign where that is beyond all doubles.
inline double saturated(double value, int exponent) noexcept {
  constexpr double kMost = std::numeric_limits<double>::max();
  for (; exponent > 0 && value != 0 && std::abs(value) < kMost; --exponent) value *= 2;
  for (; exponent < 0 && value != 0; ++exponent) value *= 0.5;
  return std::clamp(value, -kMost, kMost);
}

/// 2^result <= x < 2^(result + 1), for a double x > 0 that is not subnormal.
inline int exponent_of(double x) noexcept {
  int exponent = 0;
  for (; x >= 2; x *= 0.5) ++exponent;
  for (; x < 1; x *= 2) --exponent;
  return exponent;
}

}  // namespace knotwave::curves

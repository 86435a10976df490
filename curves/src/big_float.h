// SPDX-License-Identifier: MIT
// Floating point of 4,096 bits and any exponent, for the few numbers that must be known much better
// than double-double knows them. Slow. Private to curves. [control]
#pragma once
#include <cstdint>
#include <vector>

#include "double_double.h"

namespace knotwave::curves {

/// Sums, differences and products are exact up to kMostLimbs limbs, cut off to that beyond.
class BigFloat {
 public:
  static constexpr std::size_t kMostLimbs = 128;

  BigFloat() = default;
  BigFloat(double value);        // NOLINT: a double is one, exactly
  BigFloat(DoubleDouble value);  // NOLINT: and so is a pair
  static BigFloat power_of_two(int exponent);

  /// -1, 0 or 1.
  int sign() const { return limbs_.empty() ? 0 : is_negative_ ? -1 : 1; }
  /// |x| < 2^32e, and at least 2^(32e - 32); 0 has the least int.
  int magnitude() const;
  /// x * 2^-32e, right to 2^-104 of itself, but 0 where that is below 2^-1000.
  DoubleDouble rounded(int e = 0) const;

  BigFloat operator-() const;
  friend BigFloat operator+(const BigFloat& a, const BigFloat& b);
  friend BigFloat operator-(const BigFloat& a, const BigFloat& b) { return a + -b; }
  friend BigFloat operator*(const BigFloat& a, const BigFloat& b);

 private:
  using Limbs = std::vector<std::uint32_t>;  // the least first

  BigFloat(Limbs limbs, int exponent, bool is_negative);
  /// |a| < |b|.
  static bool is_smaller(const BigFloat& a, const BigFloat& b);
  /// Limb of 2^32e.
  std::uint32_t limb(int e) const;

  Limbs limbs_;       // neither the first nor the last is 0
  int exponent_ = 0;  // of the first limb, in limbs
  bool is_negative_ = false;
};

}  // namespace knotwave::curves

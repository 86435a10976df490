// SPDX-License-Identifier: MIT
// About 106 bits from pairs of doubles. Control points are blended in it and rounded once, so the
// promise "within 4 ulp of max|P|" holds for every knot vector and weight, not only for the usual
// ones. No fused multiply-add: products are split, so every machine gives the same bits.
// Source: Dekker, Numerische Mathematik 18 (1971); Knuth, The Art of Computer Programming 2, 4.2.2.
#pragma once

namespace knotwave::curves {

/// hi + lo with |lo| <= ulp(hi) / 2, so `hi` is the value rounded. Operations are right to a few
/// 2^-104 of the larger operand. Magnitudes must stay below 1e290 (the splitting overflows).
struct DoubleDouble {
  double hi = 0;
  double lo = 0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) noexcept : hi(value) {}  // NOLINT: a double is one, exactly
  constexpr DoubleDouble(double high, double low) noexcept : hi(high), lo(low) {}

  /// a + b, a - b and a * b without rounding.
  static constexpr DoubleDouble sum(double a, double b) noexcept {
    const double s = a + b;
    const double from_b = s - a;
    return {s, (a - (s - from_b)) + (b - from_b)};
  }
  static constexpr DoubleDouble difference(double a, double b) noexcept { return sum(a, -b); }
  static constexpr DoubleDouble product(double a, double b) noexcept {
    const double p = a * b;
    const DoubleDouble x = halves(a), y = halves(b);
    return {p, ((x.hi * y.hi - p) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo};
  }

  friend constexpr DoubleDouble operator-(DoubleDouble a) noexcept { return {-a.hi, -a.lo}; }
  friend constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) noexcept {
    const DoubleDouble s = sum(a.hi, b.hi);
    return normalized(s.hi, s.lo + (a.lo + b.lo));
  }
  friend constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) noexcept {
    return a + (-b);
  }
  friend constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) noexcept {
    const DoubleDouble p = product(a.hi, b.hi);
    return normalized(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }
  friend constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) noexcept {
    const double first = a.hi / b.hi;
    const DoubleDouble rest = a - b * DoubleDouble(first);
    return normalized(first, rest.hi / b.hi);
  }
  constexpr DoubleDouble& operator+=(DoubleDouble b) noexcept { return *this = *this + b; }

 private:
  static constexpr DoubleDouble normalized(double large, double small) noexcept {
    const double s = large + small;
    return {s, small - (s - large)};
  }
  /// Upper and lower 26 bits (Veltkamp).
  static constexpr DoubleDouble halves(double a) noexcept {
    const double t = 134217729.0 * a;  // 2^27 + 1
    const double upper = t - (t - a);
    return {upper, a - upper};
  }
};

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Elementary functions that give the same bits everywhere: only + - * / and integer work, no libm,
// no fused multiply-add. Each bound is a contract that tests/base/elementary_test.cpp asserts
// against a table of 40-digit values. The bodies have no data-dependent branch, so a loop over them
// vectorises and stays equal to one call at a time; they may also run at compile time. Denormals
// flushed or kept give the same bits. "ulp" is the spacing of doubles at the true value.
#pragma once
#include <bit>
#include <cstdint>
#include <span>

#include "knotwave/base/elementary_coefficients.h"
#include "knotwave/base/rt.h"

namespace knotwave::base {

namespace detail {

/// Adding and taking away 3 * 2^51 rounds |x| <= 2^51 to the nearest integer (ties to even), and
/// the low bits of the sum hold that integer in two's complement.
inline constexpr double kRoundToInteger = 0x1.8p52;

/// A polynomial by Horner's rule, lowest coefficient first.
template <int count>
constexpr double polynomial(const double (&c)[count], double x) KNOTWAVE_RT {
  double sum = c[count - 1];
  for (int i = count - 2; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}

/// r rounded to a multiple of 2^-26 (|r| < 1), so that its product with 26-bit numbers is exact.
constexpr double high_half(double r) KNOTWAVE_RT { return (r + 0x1.8p26) - 0x1.8p26; }

/// 2^r - 1 as an unevaluated sum for |r| <= 0.51: high is exact, low small.
struct Sum {
  double high;
  double low;
};
constexpr Sum exp2_minus_1(double r) KNOTWAVE_RT {
  const double high = high_half(r);
  return {high * kLn2High,
          (r - high) * kLn2High + (r * kLn2Low + r * r * polynomial(kExp2Rest, r))};
}

/// 2^(n + r) with n the integer in the low bits of `n_bits` (a sum with kRoundToInteger).
constexpr double exp2_scaled(double r, double n_bits) KNOTWAVE_RT {
  const Sum part = exp2_minus_1(r);
  const double head = 1.0 + part.high;
  const double tail = ((1.0 - head) + part.high) + part.low;
  const double power = head + tail;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(power) +
                               (std::bit_cast<std::uint64_t>(n_bits) << 52));
}

constexpr double clamp_or(double x, double low, double high, double if_nan) KNOTWAVE_RT {
  const double at_least = x < low ? low : x;
  const double inside = at_least > high ? high : at_least;
  return x == x ? inside : if_nan;
}

}  // namespace detail

/// 2^x. [any] Range: all doubles; below -1022 returns 0 (no denormals), from 1024 on the largest
/// finite double, NaN gives 1. Error <= 1 ulp; exact at integers.
constexpr double exp2(double x) KNOTWAVE_RT {
  const double inside = detail::clamp_or(x, -1022.0, 0x1.fffffffffffffp9, 0.0);
  const double rounded = inside + detail::kRoundToInteger;
  const double power = detail::exp2_scaled(inside - (rounded - detail::kRoundToInteger), rounded);
  const double not_small = x < -1022.0 ? 0.0 : power;
  return x >= 1024.0 ? 0x1.fffffffffffffp1023 : not_small;
}

/// log2(x). [any] Range: normal positive doubles, infinity gives 1024; x <= 0, denormal or NaN
/// gives -1074. Error <= 1 ulp; exact at powers of 2.
constexpr double log2(double x) KNOTWAVE_RT {
  constexpr double kSmallestNormal = 0x1p-1022;
  const double inside = x >= kSmallestNormal ? x : 1.0;
  // x = m 2^n with sqrt(1/2) <= m < sqrt(2): the offset makes the exponent field carry at sqrt(2).
  constexpr std::uint64_t kSqrtHalf = std::bit_cast<std::uint64_t>(0x1.6a09e667f3bcdp-1);
  const std::uint64_t from_sqrt_half = std::bit_cast<std::uint64_t>(inside) - kSqrtHalf;
  const std::uint64_t n_field = from_sqrt_half & 0xfff0000000000000u;
  const double m = std::bit_cast<double>((from_sqrt_half & 0x000fffffffffffffu) + kSqrtHalf);
  // n as a double: the field, shifted below the leading bit of 2^52, less its bias.
  const double n =
      std::bit_cast<double>(((n_field ^ 0x8000000000000000u) >> 52) | 0x4330000000000000u) -
      (0x1p52 + 2048.0);
  // log(1 + f) = f - f^2/2 + s (f^2/2 + R), s = f / (2 + f); its head has 26 bits.
  const double f = m - 1.0;
  const double half_square = 0.5 * f * f;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double rest = s * (half_square + z * detail::polynomial(detail::kLogRest, z));
  const double head =
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(f - half_square) & 0xfffffffff8000000u);
  const double tail = ((f - head) - half_square) + rest;
  const double head_log2 = head * detail::kLog2EHigh;
  const double tail_log2 = (tail + head) * detail::kLog2ELow + tail * detail::kLog2EHigh;
  const double sum = n + head_log2;
  const double value = sum + (((n - sum) + head_log2) + tail_log2);
  const double finite = x > 0x1.fffffffffffffp1023 ? 1024.0 : value;
  return x >= kSmallestNormal ? finite : -1074.0;
}

struct SinCos {
  double sin;
  double cos;
};
/// sin and cos of 2 pi x, x in cycles. [any] Range |x| < 2^51 (reduced exactly); outside and for
/// NaN {0, 1}. Error <= 1.5 * 2^-53 absolute. Exact at multiples of 1/4.
constexpr SinCos sin_cos_cycles(double x) KNOTWAVE_RT {
  const bool in_range = x < 0x1p51 && x > -0x1p51;
  const double inside = in_range ? x : 0.0;
  const double cycle = inside - ((inside + detail::kRoundToInteger) - detail::kRoundToInteger);
  const double rounded = 4.0 * cycle + detail::kRoundToInteger;
  const double r = cycle - 0.25 * (rounded - detail::kRoundToInteger);
  const double z = r * r;
  const double sin_r = r * (detail::kTwoPi + z * detail::polynomial(detail::kSinRest, z));
  const double cos_r = 1.0 + z * detail::polynomial(detail::kCosRest, z);
  // A quarter turn swaps the two; the half turns change signs.
  const std::uint64_t quarter = std::bit_cast<std::uint64_t>(rounded);
  const std::uint64_t swap = 0u - (quarter & 1u);
  const auto sin_bits = std::bit_cast<std::uint64_t>(sin_r);
  const auto cos_bits = std::bit_cast<std::uint64_t>(cos_r);
  const std::uint64_t difference = (sin_bits ^ cos_bits) & swap;
  const std::uint64_t sin_sign = (quarter & 2u) << 62;
  const std::uint64_t cos_sign = ((quarter + 1u) & 2u) << 62;
  return {std::bit_cast<double>(sin_bits ^ difference ^ sin_sign),
          std::bit_cast<double>(cos_bits ^ difference ^ cos_sign)};
}

/// tanh(x). [any] All doubles; NaN gives 0. Error <= 3 ulp; odd to the bit, never above 1.
constexpr double tanh(double x) KNOTWAVE_RT {
  const std::uint64_t sign = std::bit_cast<std::uint64_t>(x) & 0x8000000000000000u;
  const double magnitude = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ sign);
  const double inside = detail::clamp_or(magnitude, 0.0, 22.0, 0.0);
  // e = exp(2 |x|) - 1 = 2^n (2^r - 1) + (2^n - 1), then tanh = e / (e + 2).
  const double octaves = inside * (2.0 * 0x1.71547652b82fep+0);
  const double rounded = octaves + detail::kRoundToInteger;
  const detail::Sum part = detail::exp2_minus_1(octaves - (rounded - detail::kRoundToInteger));
  const double scale = std::bit_cast<double>((std::bit_cast<std::uint64_t>(rounded) << 52) +
                                             std::bit_cast<std::uint64_t>(1.0));
  const double e = (part.high + part.low) * scale + (scale - 1.0);
  const double large = e / (e + 2.0);
  const double value = inside < 0x1p-28 ? inside : large;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) |
                               (x == x ? sign : std::uint64_t{0}));
}

/// Frequency of a MIDI note, 440 * 2^((note - 69) / 12). [any] Any double, clamped to +-12000; NaN
/// gives 440. Error <= 2 ulp for notes -256..256; exact at A of every octave.
constexpr double note_to_hz(double note) KNOTWAVE_RT {
  const double from_a4 = detail::clamp_or(note, -12000.0, 12000.0, 69.0) - 69.0;
  const double rounded = from_a4 * (1.0 / 12.0) + detail::kRoundToInteger;
  const double left = from_a4 - 12.0 * (rounded - detail::kRoundToInteger);
  return 440.0 * detail::exp2_scaled(left / 12.0, rounded);
}

/// Gain of a level: 10^(db / 20). [any] Any double: below -6153 dB gives 0, from 6165 dB on the
/// largest finite double, NaN gives 1. Error <= 1 ulp.
constexpr double db_to_gain(double db) KNOTWAVE_RT {
  const double inside = detail::clamp_or(db, -6153.0, 6165.0, 0.0);
  const double rounded = inside * detail::kOctavesPerDb + detail::kRoundToInteger;
  const double octaves = rounded - detail::kRoundToInteger;
  const double left = (inside - octaves * detail::kOctaveDbHigh) - octaves * detail::kOctaveDbLow;
  const double gain = detail::exp2_scaled(left * detail::kOctavesPerDb, rounded);
  const double not_small = db < -6153.0 ? 0.0 : gain;
  return db >= 6165.0 ? 0x1.fffffffffffffp1023 : not_small;
}

/// Level of a gain: 20 log10(gain). [any] Zero, negative, denormal or NaN gain gives the level of
/// 2^-1074, which is -6466.1 dB. Error <= 2 ulp.
constexpr double gain_to_db(double gain) KNOTWAVE_RT { return log2(gain) * detail::kOctaveDb; }

/// out[i] = exp2(in[i]), same bits as one at a time; in and out may be the same. [audio]
void exp2(std::span<const double> in, std::span<double> out) KNOTWAVE_RT;

}  // namespace knotwave::base

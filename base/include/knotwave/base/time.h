// SPDX-License-Identifier: MIT
// Integer time and integer phase. Float accumulation of either is banned: a sum of floats depends
// on where it was started, an integer does not.
#pragma once
#include <compare>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// A point in time: whole samples since engine time 0, and a fraction of a sample in units of
/// 2^-32. [any]
struct SampleTime {
  std::int64_t sample = 0;
  std::uint32_t fraction = 0;

  friend constexpr auto operator<=>(const SampleTime&, const SampleTime&) = default;
};

/// First whole sample at or after t: where an event at t begins to be heard. [any]
constexpr std::int64_t first_sample(SampleTime t) KNOTWAVE_RT {
  return t.sample + (t.fraction != 0 ? 1 : 0);
}

/// Samples from `start` to whole sample `n`, as a double; exact while it is below 2^20, otherwise
/// rounded once. [any]
constexpr double samples_since(SampleTime start, std::int64_t n) KNOTWAVE_RT {
  return static_cast<double>(n - start.sample) - static_cast<double>(start.fraction) * 0x1p-32;
}

/// Phase as a 64-bit fraction of a cycle: wraps by itself. [any]
struct Phase {
  std::uint64_t value = 0;

  /// In [0, 1), rounded down to 53 bits so that it never reads 1. [any]
  constexpr double cycles() const KNOTWAVE_RT { return static_cast<double>(value >> 11) * 0x1p-53; }
  friend constexpr Phase operator+(Phase a, Phase b) KNOTWAVE_RT { return {a.value + b.value}; }
  friend constexpr bool operator==(Phase, Phase) = default;
};

/// Phase of a number of cycles, any sign; the whole part is dropped. NaN and infinities give
/// phase 0. Exact for |cycles| < 2^11 multiples of 2^-53, else floored. [any]
Phase phase_from_cycles(double cycles) KNOTWAVE_RT;

/// Phase step per sample for frequency_hz at rate_hz, floored to 2^-64 cycle; frequency is clamped
/// to [0, rate_hz / 2], NaN gives 0. [any]
Phase phase_increment(double frequency_hz, double rate_hz) KNOTWAVE_RT;

}  // namespace knotwave::base

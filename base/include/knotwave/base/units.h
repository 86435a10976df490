// SPDX-License-Identifier: MIT
// Strong units for configurations and interfaces. Inside loops we use raw numbers whose names end
// in _hz _s _samples _frames _db _lin _cents _semitones _cycles _u. See docs/units.md.
#pragma once

namespace knotwave::base {

/// Frequency in hertz.
struct Hertz {
  double value = 0;
};
/// Duration in seconds.
struct Seconds {
  double value = 0;
};
/// Level in decibels; 0 dB is gain 1.
struct Decibels {
  double value = 0;
};
/// Interval in semitones of 100 cents; 12 make an octave.
struct Semitones {
  double value = 0;
};

inline namespace literals {
constexpr Hertz operator""_Hz(long double v) { return {static_cast<double>(v)}; }
constexpr Hertz operator""_Hz(unsigned long long v) { return {static_cast<double>(v)}; }
constexpr Seconds operator""_s(long double v) { return {static_cast<double>(v)}; }
constexpr Seconds operator""_s(unsigned long long v) { return {static_cast<double>(v)}; }
constexpr Seconds operator""_ms(long double v) { return {static_cast<double>(v) / 1000}; }
constexpr Seconds operator""_ms(unsigned long long v) { return {static_cast<double>(v) / 1000}; }
constexpr Decibels operator""_dB(long double v) { return {static_cast<double>(v)}; }
constexpr Decibels operator""_dB(unsigned long long v) { return {static_cast<double>(v)}; }
}  // namespace literals

}  // namespace knotwave::base

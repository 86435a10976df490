// SPDX-License-Identifier: MIT
// Cycles and frequencies to 64-bit phase.
#include "knotwave/base/time.h"

#include <cmath>

namespace knotwave::base {

Phase phase_from_cycles(double cycles) KNOTWAVE_RT {
  const double magnitude = std::abs(cycles);
  if (!(magnitude < 0x1p52)) return {};  // whole, infinite or NaN
  const double scaled = (magnitude - std::floor(magnitude)) * 0x1p64;
  const auto value = static_cast<std::uint64_t>(scaled);
  if (cycles >= 0) return {value};
  const std::uint64_t was_cut = static_cast<double>(value) != scaled ? 1 : 0;
  return {0 - value - was_cut};
}

Phase phase_increment(double frequency_hz, double rate_hz) KNOTWAVE_RT {
  if (!(frequency_hz > 0) || !(rate_hz > 0)) return {};
  const double nyquist_hz = 0.5 * rate_hz;
  if (frequency_hz >= nyquist_hz) return {std::uint64_t{1} << 63};
  return {static_cast<std::uint64_t>(frequency_hz / rate_hz * 0x1p64)};
}

}  // namespace knotwave::base

// SPDX-License-Identifier: MIT
// A state-variable filter, topology-preserving (trapezoidal) with one multiply-free feedback solve:
// stable under audio-rate modulation. Source: Zavalishin, The Art of VA Filter Design, rev. 2.1.0,
// chapter 4; Simper, "Linear trapezoidal state variable filter", Cytomic 2013.
#pragma once
#include <span>

#include "knotwave/base/rt.h"

namespace knotwave::dsp {

enum class FilterKind { low, band, high, notch };

/// One channel. States snap to zero below 1e-20.
class StateVariableFilter {
 public:
  void reset() KNOTWAVE_RT { ic1_ = ic2_ = 0; }
  /// cutoff_hz [n], clamped to 5 Hz .. 0.49 rate; resonance [n] 0..1 (0: Q = 0.5, 1: Q = 50, along
  /// Q = 0.5 * 100^r). NaN counts as the low limit. Band has unit gain at its peak. [audio]
  void render(FilterKind kind, double rate_hz, std::span<const float> cutoff_hz,
              std::span<const float> resonance, std::span<const float> in,
              std::span<float> out) KNOTWAVE_RT;

 private:
  double ic1_ = 0, ic2_ = 0;
};

}  // namespace knotwave::dsp

// SPDX-License-Identifier: MIT
// A state-variable filter, topology-preserving (trapezoidal), its feedback loop solved without
// delay: stable under audio-rate modulation, because without input ic1^2 + ic2^2 changes by
// -4 g k band^2 <= 0 a sample whatever g and k do. Source: Zavalishin, The Art of VA Filter Design,
// rev. 2.1.0, chapter 4; Simper, "Linear trapezoidal state variable filter", Cytomic 2013.
#pragma once
#include <span>

#include "knotwave/base/rt.h"

namespace knotwave::dsp {

enum class FilterKind { low, band, high, notch };

/// One channel. States snap to zero below 1e-20.
class StateVariableFilter {
 public:
  void reset() KNOTWAVE_RT { *this = {}; }
  /// cutoff_hz [n], clamped to 5 Hz .. 0.49 rate; resonance [n] 0..1 (0: Q = 0.5, 1: Q = 50, along
  /// Q = 0.5 * 100^r). NaN counts as the low limit. Band has unit gain at its peak. in [n]: NaN
  /// counts as 0, beyond +-1e6 it is clamped; in and out may be the same. The response is that of
  /// the analogue filter with s = (z - 1) / ((z + 1) tan(pi cutoff / rate)). [audio] Coefficients
  /// are worked out where cutoff or resonance move, for every sample; while both stand still they
  /// are kept, which does not change a bit.
  void render(FilterKind kind, double rate_hz, std::span<const float> cutoff_hz,
              std::span<const float> resonance, std::span<const float> in,
              std::span<float> out) KNOTWAVE_RT;

 private:
  /// A function of cutoff, resonance and rate alone.
  struct Coefficients {
    double k = 2, a1 = 1, a2 = 0, a3 = 0;
  };
  struct State {
    double ic1 = 0, ic2 = 0;
  };
  template <FilterKind kind>
  static float tick(const Coefficients& c, State& state, float in) KNOTWAVE_RT;
  template <FilterKind kind>
  void run(double rate_hz, std::span<const float> cutoff_hz, std::span<const float> resonance,
           std::span<const float> in, std::span<float> out) KNOTWAVE_RT;

  State state_;
  double rate_hz_ = 0;  ///< what coefficients_ were worked out for; 0 = nothing yet
  float cutoff_hz_ = 0, resonance_ = 0;
  Coefficients coefficients_;
};

}  // namespace knotwave::dsp

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/filter.h"

#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"

namespace knotwave::dsp {
namespace {

constexpr double kLowestHz = 5;
constexpr double kHighestCycles = 0.49;  // of the sample rate
constexpr double kLargestInput = 1e6;
constexpr double kLog2Of100 = 6.643856189774724;

// Comparisons with NaN are false, so it takes the low limit.
constexpr double limit(double x, double low, double high) {
  return x > low ? (x < high ? x : high) : low;
}

constexpr double audio_input(float x) {
  const double value = x;
  if (value != value) return 0;
  return limit(value, -kLargestInput, kLargestInput);
}

}  // namespace

StateVariableFilter::Coefficients StateVariableFilter::coefficients(double cutoff_hz,
                                                                    double resonance,
                                                                    double rate_hz) KNOTWAVE_RT {
  const double cutoff = limit(cutoff_hz, kLowestHz, kHighestCycles * rate_hz);
  const base::SinCos half_turn = base::sin_cos_cycles(0.5 * cutoff / rate_hz);
  const double g = half_turn.sin / half_turn.cos;
  Coefficients c;
  c.k = 2 * base::exp2(-kLog2Of100 * limit(resonance, 0, 1));
  c.a1 = 1 / (1 + g * (g + c.k));
  c.a2 = g * c.a1;
  c.a3 = g * c.a2;
  return c;
}

template <FilterKind kind>
void StateVariableFilter::run(double rate_hz, std::span<const float> cutoff_hz,
                              std::span<const float> resonance, std::span<const float> in,
                              std::span<float> out) KNOTWAVE_RT {
  double ic1 = ic1_;
  double ic2 = ic2_;
  Coefficients c = coefficients_;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (cutoff_hz[i] != cutoff_hz_ || resonance[i] != resonance_ || rate_hz != rate_hz_) {
      cutoff_hz_ = cutoff_hz[i];
      resonance_ = resonance[i];
      rate_hz_ = rate_hz;
      c = coefficients(cutoff_hz_, resonance_, rate_hz);
    }
    const double x = audio_input(in[i]);
    const double v3 = x - ic2;
    const double band = c.a1 * ic1 + c.a2 * v3;
    const double low = ic2 + c.a2 * ic1 + c.a3 * v3;
    ic1 = base::snap_to_zero(2 * band - ic1);
    ic2 = base::snap_to_zero(2 * low - ic2);
    double y = 0;
    if constexpr (kind == FilterKind::low) y = low;
    if constexpr (kind == FilterKind::band) y = c.k * band;
    if constexpr (kind == FilterKind::high) y = x - c.k * band - low;
    if constexpr (kind == FilterKind::notch) y = x - c.k * band;
    out[i] = static_cast<float>(y);
  }
  ic1_ = ic1;
  ic2_ = ic2;
  coefficients_ = c;
}

void StateVariableFilter::render(FilterKind kind, double rate_hz, std::span<const float> cutoff_hz,
                                 std::span<const float> resonance, std::span<const float> in,
                                 std::span<float> out) KNOTWAVE_RT {
  switch (kind) {
    case FilterKind::low:
      return run<FilterKind::low>(rate_hz, cutoff_hz, resonance, in, out);
    case FilterKind::band:
      return run<FilterKind::band>(rate_hz, cutoff_hz, resonance, in, out);
    case FilterKind::high:
      return run<FilterKind::high>(rate_hz, cutoff_hz, resonance, in, out);
    case FilterKind::notch:
      return run<FilterKind::notch>(rate_hz, cutoff_hz, resonance, in, out);
  }
}

}  // namespace knotwave::dsp

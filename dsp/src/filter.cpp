// SPDX-License-Identifier: MIT
#include "knotwave/dsp/filter.h"

#include <algorithm>
#include <array>

#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"

namespace knotwave::dsp {
namespace {

constexpr std::size_t kChunk = 64;
constexpr double kLowestHz = 5;
constexpr double kHighestCycles = 0.49;  // of the sample rate
constexpr double kLargestInput = 1e6;
constexpr double kLog2Of100 = 6.643856189774724;

// Comparisons with NaN are false, so it takes the low limit.
constexpr double limit(double x, double low, double high) {
  const double at_least = x > low ? x : low;
  return at_least < high ? at_least : high;
}

constexpr double audio_input(float x) {
  const double value = x;
  return value == value ? limit(value, -kLargestInput, kLargestInput) : 0;
}

/// The four numbers a sample is worked out with, for a chunk of samples.
struct Moving {
  std::array<double, kChunk> k, a1, a2, a3;
};

// With g = tan(pi cutoff / rate) = s / c: a1 = 1 / (1 + g (g + k)), a2 = g a1, a3 = g a2.
void work_out(const float* cutoff_hz, const float* resonance, double rate_hz, std::size_t n,
              Moving& m) {
  const double highest = kHighestCycles * rate_hz;
  const double half_cycles_per_hz = 0.5 / rate_hz;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && resonance[i] == resonance[i - 1]) {
      m.k[i] = m.k[i - 1];  // the same input, the same bits
    } else {
      m.k[i] = 2 * base::exp2(-kLog2Of100 * limit(static_cast<double>(resonance[i]), 0, 1));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double cutoff = limit(static_cast<double>(cutoff_hz[i]), kLowestHz, highest);
    const base::SinCos half_turn = base::sin_cos_cycles(cutoff * half_cycles_per_hz);
    const double s = half_turn.sin, c = half_turn.cos;
    const double scale = 1 / (c * c + s * (s + m.k[i] * c));
    m.a1[i] = c * c * scale;
    m.a2[i] = s * c * scale;
    m.a3[i] = s * s * scale;
  }
}

}  // namespace

template <FilterKind kind>
float StateVariableFilter::tick(const Coefficients& c, float in) KNOTWAVE_RT {
  const double x = audio_input(in);
  const double v3 = x - ic2_;
  const double band = c.a1 * ic1_ + c.a2 * v3;
  const double low = ic2_ + c.a2 * ic1_ + c.a3 * v3;
  ic1_ = base::snap_to_zero(2 * band - ic1_);
  ic2_ = base::snap_to_zero(2 * low - ic2_);
  if constexpr (kind == FilterKind::low) return static_cast<float>(low);
  if constexpr (kind == FilterKind::band) return static_cast<float>(c.k * band);
  if constexpr (kind == FilterKind::high) return static_cast<float>(x - c.k * band - low);
  return static_cast<float>(x - c.k * band);
}

template <FilterKind kind>
void StateVariableFilter::run(double rate_hz, std::span<const float> cutoff_hz,
                              std::span<const float> resonance, std::span<const float> in,
                              std::span<float> out) KNOTWAVE_RT {
  Moving moving;
  for (std::size_t done = 0; done < out.size(); done += kChunk) {
    const std::size_t n = std::min(kChunk, out.size() - done);
    const float* cutoff = cutoff_hz.data() + done;
    const float* q = resonance.data() + done;
    bool still = rate_hz == rate_hz_;
    for (std::size_t i = 0; i < n; ++i) still &= cutoff[i] == cutoff_hz_ && q[i] == resonance_;
    StateVariableFilter state = *this;  // in registers
    if (still) {
      for (std::size_t i = 0; i < n; ++i) {
        out[done + i] = state.template tick<kind>(coefficients_, in[done + i]);
      }
    } else {
      work_out(cutoff, q, rate_hz, n, moving);
      for (std::size_t i = 0; i < n; ++i) {
        coefficients_ = {moving.k[i], moving.a1[i], moving.a2[i], moving.a3[i]};
        out[done + i] = state.template tick<kind>(coefficients_, in[done + i]);
      }
      rate_hz_ = rate_hz;
      cutoff_hz_ = cutoff[n - 1];
      resonance_ = q[n - 1];
    }
    ic1_ = state.ic1_;
    ic2_ = state.ic2_;
  }
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

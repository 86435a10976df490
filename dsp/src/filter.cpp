// SPDX-License-Identifier: MIT
#include "knotwave/dsp/filter.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"

#include "elementary_kernel.h"

namespace knotwave::dsp {
namespace {

constexpr std::size_t kChunk = kFilterChunk;
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

bool is_tiny(double x) { return std::abs(x) < 1e-20; }

double damping(float resonance) KNOTWAVE_RT {
  return 2 * base::exp2(-kLog2Of100 * limit(static_cast<double>(resonance), 0, 1));
}

// One value a sample of the chunk; where nothing moves, one for all of them.
void work_out_damping(const float* resonance, std::size_t n, double* k) KNOTWAVE_RT {
  if (std::all_of(resonance, resonance + n, [&](float r) { return r == resonance[0]; })) {
    std::fill_n(k, n, damping(resonance[0]));
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    k[i] = -kLog2Of100 * limit(static_cast<double>(resonance[i]), 0, 1);
  }
  elementary_kernels_in_use().exp2(k, k, n);
  for (std::size_t i = 0; i < n; ++i) k[i] = 2 * k[i];
}

void work_out(const float* cutoff_hz, const float* resonance, double rate_hz, std::size_t n,
              FilterCoefficients& c) KNOTWAVE_RT {
  work_out_damping(resonance, n, c.k.data());
  const CutoffRange range{kLowestHz, kHighestCycles * rate_hz, 0.5 / rate_hz};
  elementary_kernels_in_use().filter(cutoff_hz, range, c, n);
}

}  // namespace

template <FilterKind kind>
float StateVariableFilter::tick(const Coefficients& c, State& state, float in) KNOTWAVE_RT {
  const double x = audio_input(in);
  const double v3 = x - state.ic2;
  const double band = c.a1 * state.ic1 + c.a2 * v3;
  const double low = state.ic2 + c.a2 * state.ic1 + c.a3 * v3;
  state.ic1 = 2 * band - state.ic1;
  state.ic2 = 2 * low - state.ic2;
  // A branch, which is foretold, and not a select, which every sample would wait for.
  if (is_tiny(state.ic1) || is_tiny(state.ic2)) [[unlikely]] {
    state.ic1 = base::snap_to_zero(state.ic1);
    state.ic2 = base::snap_to_zero(state.ic2);
  }
  if constexpr (kind == FilterKind::low) return static_cast<float>(low);
  if constexpr (kind == FilterKind::band) return static_cast<float>(c.k * band);
  if constexpr (kind == FilterKind::high) return static_cast<float>(x - c.k * band - low);
  return static_cast<float>(x - c.k * band);
}

template <FilterKind kind>
void StateVariableFilter::run(double rate_hz, std::span<const float> cutoff_hz,
                              std::span<const float> resonance, std::span<const float> in,
                              std::span<float> out) KNOTWAVE_RT {
  FilterCoefficients moving;
  for (std::size_t done = 0; done < out.size(); done += kChunk) {
    const std::size_t n = std::min(kChunk, out.size() - done);
    const float* cutoff = cutoff_hz.data() + done;
    const float* q = resonance.data() + done;
    bool still = rate_hz == rate_hz_;
    for (std::size_t i = 0; i < n; ++i) still &= cutoff[i] == cutoff_hz_ && q[i] == resonance_;
    State state = state_;  // in registers
    Coefficients c = coefficients_;
    if (still) {
      for (std::size_t i = 0; i < n; ++i) out[done + i] = tick<kind>(c, state, in[done + i]);
    } else {
      work_out(cutoff, q, rate_hz, n, moving);
      for (std::size_t i = 0; i < n; ++i) {
        c = {moving.k[i], moving.a1[i], moving.a2[i], moving.a3[i]};
        out[done + i] = tick<kind>(c, state, in[done + i]);
      }
      coefficients_ = c;
      rate_hz_ = rate_hz;
      cutoff_hz_ = cutoff[n - 1];
      resonance_ = q[n - 1];
    }
    state_ = state;
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

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/filter.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace {

using knotwave::dsp::FilterKind;
using knotwave::dsp::StateVariableFilter;

constexpr FilterKind kKinds[] = {FilterKind::low, FilterKind::band, FilterKind::high,
                                 FilterKind::notch};

std::vector<float> filtered(FilterKind kind, double rate_hz, float cutoff_hz, float resonance,
                            const std::vector<float>& in) {
  const std::vector<float> cutoff(in.size(), cutoff_hz), q(in.size(), resonance);
  std::vector<float> out(in.size());
  StateVariableFilter filter;
  filter.render(kind, rate_hz, cutoff, q, in, out);
  return out;
}

// The analogue prototype at the frequency the bilinear transform maps frequency_hz from.
double analytic_gain(FilterKind kind, double rate_hz, double cutoff_hz, double resonance,
                     double frequency_hz) {
  const double k = 2 * std::pow(100.0, -resonance);
  const std::complex<double> s{0, std::tan(std::numbers::pi * frequency_hz / rate_hz) /
                                      std::tan(std::numbers::pi * cutoff_hz / rate_hz)};
  const std::complex<double> den = s * s + k * s + 1.0;
  switch (kind) {
    case FilterKind::low:
      return std::abs(1.0 / den);
    case FilterKind::band:
      return std::abs(k * s / den);
    case FilterKind::high:
      return std::abs(s * s / den);
    default:
      return std::abs((s * s + 1.0) / den);
  }
}

double measured_gain(const std::vector<float>& impulse_response, double rate_hz,
                     double frequency_hz) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < impulse_response.size(); ++i) {
    const double cycles = std::fmod(static_cast<double>(i) * frequency_hz / rate_hz, 1.0);
    sum += std::polar(static_cast<double>(impulse_response[i]), -2 * std::numbers::pi * cycles);
  }
  return std::abs(sum);
}

TEST(StateVariableFilter, HasTheBilinearResponseOfItsAnalogueModel) {
  const double rate_hz = 48000;
  std::vector<float> impulse(1 << 16);
  impulse[0] = 1;
  for (const auto& [cutoff_hz, resonance] :
       {std::pair(200.0f, 0.0f), std::pair(1000.0f, 0.3f), std::pair(5000.0f, 0.6f),
        std::pair(15000.0f, 0.15f)}) {
    for (const FilterKind kind : kKinds) {
      const auto response = filtered(kind, rate_hz, cutoff_hz, resonance, impulse);
      for (int i = 0; i < 20; ++i) {
        const double frequency_hz = 25 * std::pow(2.0, i * 0.5);  // 25 Hz .. 18.1 kHz
        const double expected = analytic_gain(kind, rate_hz, cutoff_hz, resonance, frequency_hz);
        const double measured = measured_gain(response, rate_hz, frequency_hz);
        // 0.01 dB, and what rounding the impulse response to float leaves: -140 dB.
        EXPECT_NEAR(measured, expected, expected * 0.00115 + 1e-7)
            << "kind " << static_cast<int>(kind) << " cutoff " << cutoff_hz << " at "
            << frequency_hz;
      }
    }
  }
}

TEST(StateVariableFilter, BandHasUnitGainAtItsPeakForAnyResonance) {
  std::vector<float> impulse(1 << 17);
  impulse[0] = 1;
  for (const float resonance : {0.0f, 0.5f, 1.0f}) {
    const auto response = filtered(FilterKind::band, 48000, 1000, resonance, impulse);
    EXPECT_NEAR(measured_gain(response, 48000, 1000), 1, 1e-4) << resonance;
  }
}

struct Modulation {
  std::vector<float> cutoff_hz, resonance, noise;
};

// Cutoff and resonance anywhere in their range, anew at every sample.
Modulation wild(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  Modulation m{std::vector<float>(n), std::vector<float>(n), std::vector<float>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    m.cutoff_hz[i] = 5.0f * std::pow(4704.0f, unit(random));
    m.resonance[i] = unit(random);
    m.noise[i] = 2 * unit(random) - 1;
  }
  return m;
}

TEST(StateVariableFilter, StaysBoundedUnderRandomAudioRateModulation) {
  const auto n = static_cast<std::size_t>(knotwave::support::test_count(480000));
  const Modulation m = wild(n, knotwave::support::test_seed());
  for (const FilterKind kind : kKinds) {
    StateVariableFilter filter;
    std::vector<float> out(n);
    filter.render(kind, 48000, m.cutoff_hz, m.resonance, m.noise, out);
    float largest = 0;
    for (const float y : out) {
      ASSERT_TRUE(std::isfinite(y));
      largest = std::max(largest, std::abs(y));
    }
    EXPECT_LT(largest, 30.0f) << "kind " << static_cast<int>(kind);
    std::printf("kind %d: largest output %.2f\n", static_cast<int>(kind), largest);
  }
}

TEST(StateVariableFilter, LosesEnergyWithoutInputHoweverItIsModulated) {
  const std::size_t n = 48000;
  Modulation m = wild(n, knotwave::support::test_seed() + 1);
  std::fill(m.noise.begin(), m.noise.end(), 0.0f);
  m.noise[0] = 1;
  // low is the mean of the second state before and after, so it cannot exceed what sqrt of the
  // energy was at the start: after one sample of input 1 both states are below 2.
  StateVariableFilter filter;
  std::vector<float> out(n);
  filter.render(FilterKind::low, 48000, m.cutoff_hz, m.resonance, m.noise, out);
  float late = 0;
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_LE(std::abs(out[i]), 2.9f) << i;
    if (i >= n / 2) late = std::max(late, std::abs(out[i]));
  }
  EXPECT_LT(late, 1e-6f);
}

TEST(StateVariableFilter, HeldParametersGiveTheBitsOfParametersWorkedOutEverySample) {
  const std::size_t n = 4096;
  const Modulation m = wild(n, 7);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const FilterKind kind : kKinds) {
    // NaN is never equal to the sample before, so it is worked out anew at each, as the low limit.
    EXPECT_EQ(filtered(kind, 48000, nan, nan, m.noise), filtered(kind, 48000, 5, 0, m.noise));
    // So are values that move about above the high limit.
    std::vector<float> cutoff(n), resonance(n), out(n);
    for (std::size_t i = 0; i < n; ++i) {
      cutoff[i] = i % 2 == 0 ? 1e5f : 2e5f;
      resonance[i] = i % 2 == 0 ? 3.0f : 2.0f;
    }
    StateVariableFilter filter;
    filter.render(kind, 48000, cutoff, resonance, m.noise, out);
    EXPECT_EQ(out, filtered(kind, 48000, 1e5f, 3, m.noise));
  }
}

TEST(StateVariableFilter, BlockSizeDoesNotMatter) {
  const std::size_t n = 700;
  Modulation m = wild(n, 3);
  // Stretches of constant and of moving parameters.
  for (std::size_t i = 200; i < 400; ++i) m.cutoff_hz[i] = 700, m.resonance[i] = 0.2f;
  for (const FilterKind kind : kKinds) {
    knotwave::support::expect_block_size_does_not_matter<float>(n, [&] {
      return [&, filter = StateVariableFilter()](std::size_t first, std::span<float> out) mutable {
        const std::size_t size = out.size();
        filter.render(kind, 48000, std::span(m.cutoff_hz).subspan(first, size),
                      std::span(m.resonance).subspan(first, size),
                      std::span(m.noise).subspan(first, size), out);
      };
    });
  }
}

TEST(StateVariableFilter, NanAndInfinityHaveADefinedOutputAndLeaveNoTrace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const FilterKind kind : kKinds) {
    for (const float bad : {nan, infinity, -infinity, 3e38f}) {
      StateVariableFilter filter;
      std::vector<float> cutoff(96000, 1000), resonance(96000, 0.1f), in(96000, 0), out(96000);
      cutoff[10] = resonance[20] = in[30] = bad;
      filter.render(kind, 48000, cutoff, resonance, in, out);
      for (const float y : out) ASSERT_TRUE(std::isfinite(y));
      EXPECT_EQ(out.back(), 0.0f);  // states snapped to zero
    }
  }
  const std::vector<float> in{1, 0.5f, -0.25f};
  EXPECT_EQ(filtered(FilterKind::low, 48000, nan, nan, in),
            filtered(FilterKind::low, 48000, 5, 0, in));
  EXPECT_EQ(filtered(FilterKind::low, 48000, 1000, 0, {1, nan, 0.5f}),
            filtered(FilterKind::low, 48000, 1000, 0, {1, 0, 0.5f}));
}

TEST(StateVariableFilter, WorksInPlaceAndDoesNotAllocate) {
  const Modulation m = wild(256, 5);
  StateVariableFilter one, two;
  std::vector<float> out(256), in_place = m.noise;
  one.render(FilterKind::band, 44100, m.cutoff_hz, m.resonance, m.noise, out);
  const auto count = knotwave::support::allocations_in(
      [&] { two.render(FilterKind::band, 44100, m.cutoff_hz, m.resonance, in_place, in_place); });
  EXPECT_EQ(count, 0);
  EXPECT_EQ(out, in_place);
}

}  // namespace

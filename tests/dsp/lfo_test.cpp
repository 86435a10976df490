// SPDX-License-Identifier: MIT
#include "knotwave/dsp/lfo.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"

#include "support/allocation_count.h"
#include "support/block_sweep.h"

namespace {

using knotwave::base::RandomStream;
using knotwave::base::SampleTime;
using knotwave::curves::CurveProgram;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::Lfo;
using knotwave::dsp::LfoSpec;
using Mode = LfoSpec::Mode;

constexpr double kRate = 48000;
constexpr RandomStream kStream{5, 2, knotwave::base::kRandomLfo};

// Value = 3 + phase: shows the phase itself. The domain is 1..3.
CurveProgram ramp() {
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {3, 4};
  spec.knots = {1, 1, 3, 3};
  return compile_function(NurbsCurve::create(spec).value()).value();
}

CurveProgram unit_s() {
  CurveSpec spec;
  spec.points = {0, 0, 1, 1};
  return compile_function(NurbsCurve::create(spec).value()).value();
}

double phase_of(double cycles) { return cycles - std::floor(cycles); }

std::vector<double> played(const LfoSpec& spec, SampleTime start, double rate_hz,
                           std::int64_t first, std::size_t count,
                           const std::vector<double>& factor = {},
                           const std::vector<double>& beats = {},
                           const CurveProgram& curve = ramp()) {
  Lfo lfo;
  lfo.start(spec, start, rate_hz, kStream);
  std::vector<double> out(count);
  lfo.render(spec, curve, first, factor, beats, out);
  return out;
}

TEST(Lfo, KeySyncedStartsWithTheNoteAtItsSubSample) {
  const auto y = played({.rate_hz = 7, .phase_cycles = 0.25}, {1000, 1u << 31}, kRate, 1001, 48000);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double cycles = 0.25 + 7 * (static_cast<double>(i) + 0.5) / kRate;
    ASSERT_NEAR(y[i], 3 + phase_of(cycles), 1e-9) << i;
  }
}

TEST(Lfo, FreeOnesAgreeWhereverTheyStart) {
  const LfoSpec spec{.mode = Mode::free, .rate_hz = 3.3, .phase_cycles = 0.1};
  const std::int64_t late = std::int64_t{1} << 40;  // nine months
  const auto a = played(spec, {0, 0}, kRate, late, 100);
  const auto b = played(spec, {late - 5, 99}, kRate, late, 100);
  EXPECT_EQ(a, b);
  const auto y = played(spec, {123, 0}, kRate, 480000, 100);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double cycles = 0.1 + 3.3 * (480000 + static_cast<double>(i)) / kRate;
    EXPECT_NEAR(y[i], 3 + phase_of(cycles), 1e-9);
  }
}

TEST(Lfo, OneShotPlaysOneCycleAndHoldsTheEnd) {
  const auto y = played({.mode = Mode::one_shot, .rate_hz = 100, .phase_cycles = 0.5}, {0, 0},
                        kRate, 0, 48000);
  EXPECT_NEAR(y[0], 3.5, 1e-12);
  EXPECT_NEAR(y[239], 3.5 + 239.0 / 480, 1e-9);
  for (std::size_t i = 241; i < y.size(); ++i) ASSERT_EQ(y[i], 4);
}

TEST(Lfo, WaitsForItsDelayAtTheValueOfItsStart) {
  for (const Mode mode : {Mode::key, Mode::one_shot}) {
    const auto y = played({.mode = mode, .rate_hz = 2, .phase_cycles = 0.25, .delay_s = 0.01},
                          {10, 1u << 31}, kRate, 11, 10000);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double running = std::max(0.0, static_cast<double>(i) + 0.5 - 480) / kRate;
      ASSERT_NEAR(y[i], 3.25 + 2 * running, 1e-9) << i;
    }
  }
}

TEST(Lfo, FadesInAfterTheDelay) {
  for (const Mode mode : {Mode::key, Mode::free}) {
    LfoSpec plain{.mode = mode, .rate_hz = 2, .delay_s = 0.01};
    LfoSpec faded = plain;
    faded.fade_s = 0.02;
    const auto y = played(faded, {0, 0}, kRate, 0, 4800);
    const auto whole = played(plain, {0, 0}, kRate, 0, 4800);
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double t = std::clamp((static_cast<double>(i) - 480) / 960, 0.0, 1.0);
      ASSERT_NEAR(y[i], whole[i] * t * t * (3 - 2 * t), 1e-12) << i;
    }
  }
}

TEST(Lfo, FollowsTheSong) {
  std::vector<double> beats(20000);
  for (std::size_t i = 0; i < beats.size(); ++i) {
    const double seconds = static_cast<double>(i) / kRate;
    beats[i] = 12 + seconds * 2 + seconds * seconds;  // an accelerando
  }
  const auto key = played({.beats = 0.5, .phase_cycles = 0.2}, {500, 0}, kRate, 500, 19000, {},
                          {beats.begin() + 500, beats.end()});
  const auto free = played({.mode = Mode::free, .beats = 0.5}, {500, 0}, kRate, 500, 19000, {},
                           {beats.begin() + 500, beats.end()});
  for (std::size_t i = 0; i < key.size(); ++i) {
    ASSERT_NEAR(key[i], 3 + phase_of(0.2 + (beats[500 + i] - beats[500]) / 0.5), 1e-9);
    ASSERT_NEAR(free[i], 3 + phase_of(beats[500 + i] / 0.5), 1e-9);
  }
}

TEST(Lfo, RateFactorBendsTimeAndSong) {
  std::vector<double> factor(9600), beats(9600);
  double sum = 0, song = 0;
  const auto free = LfoSpec{.mode = Mode::free, .rate_hz = 4};
  for (std::size_t i = 0; i < factor.size(); ++i) {
    factor[i] = 1 + 0.9 * std::sin(0.001 * static_cast<double>(i));
    beats[i] = 3 + static_cast<double>(i) * 2 / kRate;
  }
  const auto y = played(free, {0, 0}, kRate, 0, factor.size(), factor);
  const auto z =
      played({.mode = Mode::key, .beats = 0.5}, {0, 0}, kRate, 0, factor.size(), factor, beats);
  for (std::size_t i = 0; i < y.size(); ++i) {
    ASSERT_NEAR(y[i], 3 + phase_of(sum), 1e-8) << i;
    sum += 4 / kRate * factor[i];
    if (i > 0) song += 2 / kRate * factor[i] / 0.5;
    ASSERT_NEAR(z[i], 3 + phase_of(song), 1e-8) << i;
  }
}

TEST(Lfo, RandomGlidesFromLevelToLevelAlongTheCurve) {
  const LfoSpec spec{.mode = Mode::free, .rate_hz = 100, .random = true};
  const auto y = played(spec, {0, 0}, kRate, 0, 4800, {}, {}, unit_s());
  for (std::size_t i = 0; i < y.size(); ++i) {
    const auto cycle = i / 480;
    const double t = static_cast<double>(i % 480) / 480;
    const double from = kStream.bipolar(cycle), to = kStream.bipolar(cycle + 1);
    // 100 Hz is floored to 2^-64 cycle, so a cycle's first sample may count as its end.
    ASSERT_NEAR(y[i], from + (to - from) * t * t * (3 - 2 * t), 1e-9) << i;
  }
  const auto late = played(spec, {2000, 5}, kRate, 2001, 100, {}, {}, unit_s());
  for (std::size_t i = 0; i < late.size(); ++i) EXPECT_EQ(late[i], y[2001 + i]);
}

TEST(Lfo, BlockSizeDoesNotMatter) {
  const CurveProgram s = unit_s();
  const LfoSpec specs[] = {
      {.mode = Mode::free, .rate_hz = 1234.5},
      {.rate_hz = 99, .phase_cycles = 0.3, .delay_s = 0.003, .fade_s = 0.004, .random = true},
      {.mode = Mode::one_shot, .rate_hz = 150, .delay_s = 0.001},
      {.beats = 0.01, .delay_s = 0.002},
      {.mode = Mode::free, .beats = 0.02, .random = true}};
  std::vector<double> factor(1000), beats(1000);
  for (std::size_t i = 0; i < 1000; ++i) {
    factor[i] = 1 + 0.5 * std::sin(0.1 * static_cast<double>(i));
    beats[i] = 100 + static_cast<double>(i) * 4e-5;
  }
  factor[500] = beats[600] = std::numeric_limits<double>::quiet_NaN();
  for (const LfoSpec& spec : specs) {
    for (const bool bent : {false, true}) {
      knotwave::support::expect_block_size_does_not_matter<double>(1000, [&] {
        Lfo lfo;
        lfo.start(spec, {0, 5}, kRate, kStream);
        return [&, lfo, bent](std::size_t first, std::span<double> out) mutable {
          const auto part = [&](const std::vector<double>& all) {
            return std::span<const double>(all).subspan(first, out.size());
          };
          lfo.render(spec, s, static_cast<std::int64_t>(first),
                     bent ? part(factor) : std::span<const double>(),
                     spec.beats > 0 ? part(beats) : std::span<const double>(), out);
          for (const double y : out) ASSERT_TRUE(std::isfinite(y));
        };
      });
    }
  }
}

TEST(Lfo, AgreesAtEqualSecondsForAnyRate) {
  const CurveProgram s = unit_s();
  for (const LfoSpec& spec :
       {LfoSpec{.rate_hz = 5.7, .delay_s = 0.0333, .fade_s = 0.1},
        LfoSpec{.mode = Mode::free, .rate_hz = 5.7}, LfoSpec{.rate_hz = 2, .random = true}}) {
    const auto at_rate = [&](double rate_hz) {
      const double start = 0.0123 * rate_hz;
      const SampleTime time{static_cast<std::int64_t>(start),
                            static_cast<std::uint32_t>((start - std::floor(start)) * 0x1p32)};
      std::vector<double> y;
      for (int i = 2; i < 150; ++i) {
        const auto sample = static_cast<std::int64_t>(i * 0.01 * rate_hz + 0.5);
        y.push_back(played(spec, time, rate_hz, sample, 1, {}, {}, s)[0]);
      }
      return y;
    };
    const auto reference = at_rate(48000);
    for (const double rate_hz : {44100.0, 96000.0, 384000.0}) {
      const auto y = at_rate(rate_hz);
      for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(y[i], reference[i], 1e-6);
    }
  }
}

TEST(Lfo, DoesNotAllocate) {
  const CurveProgram s = unit_s();
  const LfoSpec spec{.rate_hz = 99, .fade_s = 0.1, .random = true};
  std::vector<double> out(1000);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              Lfo lfo;
              lfo.start(spec, {0, 0}, kRate, kStream);
              lfo.render(spec, s, 0, {}, {}, out);
            }),
            0);
}

}  // namespace

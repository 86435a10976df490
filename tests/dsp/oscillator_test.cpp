// SPDX-License-Identifier: MIT
#include "knotwave/dsp/oscillator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/sha256.h"
#include "knotwave/dsp/builtin_waves.h"

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/simd_guard.h"
#include "support/spectrum.h"
#include "waveforms.h"

namespace {

using knotwave::base::Phase;
using knotwave::base::phase_from_cycles;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::TableOscillator;
using knotwave::dsp::WaveTables;
namespace support = knotwave::support;

constexpr double kRate = 48000;
constexpr double kPi = 3.14159265358979323846;

WaveTables tables_of(const knotwave::curves::CurveSpec& spec) {
  const auto curve = NurbsCurve::create(spec);
  EXPECT_TRUE(curve) << curve.error().message;
  auto tables = WaveTables::create(*curve);
  EXPECT_TRUE(tables) << tables.error().message;
  return *tables;
}

/// Increment of coherent bin k: exactly k / 2^16 of a cycle.
Phase coherent_increment(int bin) { return {static_cast<std::uint64_t>(bin) << 48}; }

std::vector<float> play(const WaveTables& tables, const std::vector<Phase>& increments,
                        std::span<const float> positions = {},
                        std::span<const float> offsets = {}) {
  TableOscillator oscillator;
  oscillator.start({}, 0);
  std::vector<float> out(increments.size());
  oscillator.render(tables, increments, positions, offsets, out, {});
  return out;
}

TEST(TableOscillatorAlias, StaysBelowMinus110DbAndKeepsThePassband) {
  std::printf("%-14s %5s %9s %10s %9s %9s %10s %6s\n", "wave", "note", "f0 Hz", "harmonics",
              "worst", "<18 kHz", "passband", "lines");
  for (const auto& spec : {knotwave::test::saw_spec(), knotwave::test::corners_spec(),
                           knotwave::test::smooth_spec()}) {
    const WaveTables tables = tables_of(spec);
    for (const int note : {33, 60, 84, 96, 108}) {
      const double hz = 440 * std::exp2((note - 69) / 12.0);
      const int bin = support::coherent_bin(hz, kRate);
      const auto samples =
          play(tables, std::vector<Phase>(support::kCoherentSize, coherent_increment(bin)));
      const auto report = support::measure_coherent(samples, bin, kRate, tables.coefficients(0, 0));
      std::printf("%-14s %5d %9.2f %10d %9.1f %9.1f %10.5f %6d\n", spec.name.c_str(), note,
                  bin * kRate / support::kCoherentSize,
                  tables.level_harmonics(tables.level_for(coherent_increment(bin))),
                  report.worst_db, report.worst_18k_db, report.passband_db,
                  report.passband_harmonics);
      EXPECT_LT(report.worst_db, -110) << spec.name << " at note " << note;
      EXPECT_LT(report.passband_db, 0.01) << spec.name << " at note " << note;
      EXPECT_GE(report.passband_harmonics, 3);
    }
  }
}

WaveTables builtin(const char* name) {
  auto tables = knotwave::dsp::builtin_wave(name);
  EXPECT_TRUE(tables) << tables.error().message;
  return *tables;
}

/// Four rows of a degree-3 surface, two channels.
WaveTables stereo_surface() {
  knotwave::curves::SurfaceSpec spec;
  spec.name = "stereo";
  spec.dim = 2;
  spec.count_u = 8;
  spec.count_v = 5;
  spec.periodic_u = true;
  for (int k = 0; k < 2 * 8 * 5; ++k) spec.points.push_back(((k * 37) % 19 - 9) / 9.0);
  const auto surface = knotwave::curves::NurbsSurface::create(spec);
  EXPECT_TRUE(surface) << surface.error().message;
  auto tables = WaveTables::create(*surface);
  EXPECT_TRUE(tables) << tables.error().message;
  return *tables;
}

/// A glide from hz0 to hz1 in equal ratios, and its phases.
std::vector<Phase> glide(double hz0, double hz1, std::size_t samples) {
  std::vector<Phase> increments(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(samples);
    const double hz = hz0 * std::exp2(std::log2(hz1 / hz0) * part);
    increments[i] = knotwave::base::phase_increment(hz, kRate);
  }
  return increments;
}

TEST(TableOscillatorAlias, BackwardsIsAsCleanAsForwards) {
  const WaveTables tables = builtin("saw");
  const int bin = support::coherent_bin(440, kRate);
  const Phase backwards = {std::uint64_t(0) - coherent_increment(bin).value};
  const auto samples = play(tables, std::vector<Phase>(support::kCoherentSize, backwards));
  const auto report = support::measure_coherent(samples, bin, kRate, tables.coefficients(0, 0));
  EXPECT_LT(report.worst_db, -110);
  EXPECT_LT(report.passband_db, 0.01);
}

TEST(TableOscillatorAlias, ASineIsOneLine) {
  const WaveTables tables = builtin("sine");
  for (const double hz : {27.5, 440.0, 4186.0, 15000.0}) {
    const int bin = support::coherent_bin(hz, kRate);
    const auto samples =
        play(tables, std::vector<Phase>(support::kCoherentSize, coherent_increment(bin)));
    auto lines = support::line_spectrum(samples);
    EXPECT_NEAR(std::abs(lines[static_cast<std::size_t>(bin)]), 1, 1e-6);
    lines[static_cast<std::size_t>(bin)] = 0;
    double worst = 0;
    for (const auto& line : lines) worst = std::max(worst, std::abs(line));
    EXPECT_LT(support::decibels(worst), -135) << hz << " Hz";
  }
}

// What a glide over a level boundary leaves: the output less the harmonics that both levels have,
// whose phases are exact, is the fade of the highest ones alone. Seen through a window (sin^8)
// whose side lobes are below it, it must stay above 16 kHz.
TEST(TableOscillatorAlias, AGlideOverALevelLeavesNothingBelow16kHz) {
  const WaveTables tables = builtin("saw");
  constexpr std::size_t kSize = 16384;
  double worst_db = -400;
  for (const double hz : {110.0, 440.0, 1760.0}) {
    for (const bool up : {true, false}) {
      const auto increments = up ? glide(hz, hz * 1.2, kSize) : glide(hz * 1.2, hz, kSize);
      const int common = std::min(tables.level_harmonics(tables.level_for(increments.front())),
                                  tables.level_harmonics(tables.level_for(increments.back())));
      ASSERT_NE(tables.level_for(increments.front()), tables.level_for(increments.back()));
      const auto samples = play(tables, increments);
      std::vector<double> rest(kSize);
      Phase phase;
      for (std::size_t i = 0; i < kSize; ++i) {
        const double angle = 2 * kPi * phase.cycles();
        const std::complex<double> turn(std::cos(angle), std::sin(angle));
        std::complex<double> power = 1;
        double shared = 0;
        for (int n = 1; n <= common; ++n) {
          power *= turn;
          shared -= 2 / (kPi * n) * power.imag();
        }
        const double window = std::sin(kPi * (static_cast<double>(i) + 0.5) / kSize);
        const double w2 = window * window, w8 = w2 * w2 * w2 * w2;
        rest[i] = (static_cast<double>(samples[i]) - shared) * w8 / 0.2734375;  // mean of sin^8
        phase = phase + increments[i];
      }
      const auto lines = support::line_spectrum(std::span<const double>(rest));
      double strongest = 0;
      for (std::size_t b = 0; static_cast<double>(b) * kRate / kSize < 16000; ++b) {
        strongest = std::max(strongest, std::abs(lines[b]));
      }
      std::printf("glide %5.0f Hz %s: worst line below 16 kHz %.1f dBFS\n", hz,
                  up ? "up  " : "down", support::decibels(strongest));
      worst_db = std::max(worst_db, support::decibels(strongest));
    }
  }
  EXPECT_LT(worst_db, -130);
}

TEST(TableOscillator, AnySplitIntoBlocksGivesTheSameBits) {
  const WaveTables tables = stereo_surface();
  constexpr std::size_t kSize = 3000;
  const auto increments = glide(200, 9000, kSize);
  std::vector<float> positions(kSize), offsets(kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    positions[i] = i % 1000 < 400 ? 0.25F : static_cast<float>(i) / kSize;
    offsets[i] = 0.3F * std::sin(static_cast<float>(i) * 0.01F);
  }
  for (const bool right : {false, true}) {
    support::expect_block_size_does_not_matter<float>(kSize, [&] {
      TableOscillator oscillator;
      oscillator.start({}, 0.37);
      return [&, oscillator, right](std::size_t first, std::span<float> out) mutable {
        std::vector<float> other(out.size());
        oscillator.render(tables, std::span(increments).subspan(first, out.size()),
                          std::span(positions).subspan(first, out.size()),
                          std::span(offsets).subspan(first, out.size()),
                          right ? std::span(other) : out, right ? out : std::span(other));
      };
    });
  }
}

class EverySimdLevel : public testing::TestWithParam<knotwave::curves::SimdLevel> {
 private:
  const knotwave::support::SimdGuard level_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(TableOscillator, EverySimdLevel,
                         testing::ValuesIn(knotwave::curves::simd_levels()),
                         [](const auto& level) { return to_string(level.param); });

TEST_P(EverySimdLevel, GivesTheBitsOfReadSampleBySample) {
  const WaveTables tables = stereo_surface();
  constexpr std::size_t kSize = 500;
  const std::vector<Phase> increments(kSize, knotwave::base::phase_increment(777.7, kRate));
  std::vector<float> positions(kSize), offsets(kSize), left(kSize), right(kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    positions[i] = static_cast<float>(i) / kSize;
    offsets[i] = static_cast<float>(i) * -0.013F;
  }
  TableOscillator oscillator;
  oscillator.start(phase_from_cycles(0.125), 0);
  oscillator.render(tables, increments, positions, offsets, left, right);
  const int level = tables.level_for(increments[0]);
  Phase phase = phase_from_cycles(0.125);
  for (std::size_t i = 0; i < kSize; ++i) {
    const auto blend = tables.blend_at(double(positions[i]));
    const Phase at = phase + phase_from_cycles(double(offsets[i]));
    ASSERT_EQ(left[i], tables.read(level, blend, 0, at)) << "sample " << i;
    ASSERT_EQ(right[i], tables.read(level, blend, 1, at)) << "sample " << i;
    phase = phase + increments[i];
  }
}

TEST_P(EverySimdLevel, GivesTheBitsOfReadForOneRow) {
  const WaveTables tables = builtin("saw");
  const auto increments = glide(50, 52, 999);
  const auto out = play(tables, increments);
  Phase phase;
  for (std::size_t i = 0; i < out.size(); ++i) {
    ASSERT_EQ(out[i], tables.read(tables.level_for(increments[i]), {}, 0, phase)) << "sample " << i;
    phase = phase + increments[i];
  }
}

TEST(TableOscillator, LeadBeginsTheCycleBetweenSamples) {
  const WaveTables tables = builtin("saw");
  const std::vector<Phase> increments(100, knotwave::base::phase_increment(1000, kRate));
  for (const double lead : {0.0, 0.25, 0.999}) {
    TableOscillator oscillator;
    oscillator.start({}, lead);
    std::vector<float> out(increments.size());
    oscillator.render(tables, increments, {}, {}, out, {});
    const double cycles = lead * increments[0].cycles();
    EXPECT_NEAR(oscillator.phase().cycles(), cycles + 100 * increments[0].cycles() - 2, 1e-9);
    EXPECT_NEAR(out[0],
                tables.read(tables.level_for(increments[0]), {}, 0, phase_from_cycles(cycles)),
                1e-6);
  }
}

TEST(TableOscillator, AJumpUpDropsTheOldLevelAtOnceAndAJumpDownFades) {
  const WaveTables tables = builtin("saw");
  const Phase low = knotwave::base::phase_increment(200, kRate);
  const Phase high = knotwave::base::phase_increment(3000, kRate);
  std::vector<Phase> increments(600, low);
  std::fill(increments.begin() + 200, increments.begin() + 400, high);
  const auto out = play(tables, increments);
  Phase phase;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float expected = tables.read(tables.level_for(increments[i]), {}, 0, phase);
    if (i < 400 || i >= 400 + TableOscillator::kLevelFadeSamples) {
      ASSERT_EQ(out[i], expected) << "sample " << i;
    } else if (i == 400) {  // the fade begins with the few harmonics of the high note
      EXPECT_NEAR(out[i], tables.read(tables.level_for(high), {}, 0, phase), 1e-4);
    }
    phase = phase + increments[i];
  }
}

TEST(TableOscillator, TablesMayBeExchangedWhileItPlays) {
  const WaveTables saw = builtin("saw"), sine = builtin("sine");
  const std::vector<Phase> increments(300, knotwave::base::phase_increment(100, kRate));
  TableOscillator oscillator;
  std::vector<float> out(increments.size());
  for (const WaveTables* tables : {&saw, &sine, &saw}) {
    oscillator.render(*tables, increments, {}, {}, out, {});
    for (const float sample : out) ASSERT_LT(std::abs(sample), 1.3F);
  }
}

TEST(TableOscillator, NumbersThatAreNoneAreTakenAsZero) {
  const WaveTables tables = stereo_surface();
  const std::vector<Phase> increments(130, knotwave::base::phase_increment(300, kRate));
  const std::vector<float> nothing(increments.size(), 0.0F);
  const std::vector<float> broken(increments.size(), std::nanf(""));
  EXPECT_EQ(play(tables, increments, broken, broken), play(tables, increments, nothing, nothing));
  const std::vector<float> endless(increments.size(), HUGE_VALF);
  EXPECT_EQ(play(tables, increments, {}, endless), play(tables, increments, {}, nothing));
}

TEST(TableOscillator, MonoTablesGiveBothChannelsTheSameAndSilenceIsSilent) {
  const std::vector<Phase> increments(200, knotwave::base::phase_increment(300, kRate));
  std::vector<float> left(200), right(200);
  TableOscillator oscillator;
  oscillator.render(builtin("saw"), increments, {}, {}, left, right);
  EXPECT_EQ(left, right);
  oscillator.start({}, 0);
  oscillator.render(WaveTables(), increments, {}, {}, left, right);
  EXPECT_EQ(left, std::vector<float>(200, 0.0F));
}

TEST(TableOscillator, RenderingDoesNotAllocate) {
  const WaveTables tables = stereo_surface();
  const auto increments = glide(100, 10000, 4000);
  std::vector<float> positions(4000, 0.3F), left(4000), right(4000);
  TableOscillator oscillator;
  EXPECT_EQ(support::allocations_in([&] {
              oscillator.start({}, 0.5);
              oscillator.render(tables, increments, positions, positions, left, right);
            }),
            0);
}

// FFTs of two kinds, prefilter, blends, level fades and kernel in one hash. It was made by gcc 12
// at -O1 for AVX2; every compiler, optimisation and vector unit must give it.
TEST_P(EverySimdLevel, GivesTheHashOfEveryOtherMachine) {
  constexpr int kFrame = 600, kRows = 3;
  std::vector<float> cycles(kFrame * kRows);
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    cycles[k] = static_cast<float>(static_cast<int>(k * 7919 % 2003) - 1001) / 1001.0F;
  }
  auto tables = WaveTables::create_from_cycles(cycles, kFrame, kRows);
  ASSERT_TRUE(tables) << tables.error().message;
  constexpr std::size_t kSize = 20000;
  std::vector<Phase> increments(kSize);
  std::vector<float> positions(kSize), offsets(kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    increments[i].value = (std::uint64_t(1) << 55) + (std::uint64_t(i) << 44);
    positions[i] = static_cast<float>(i % 4096) / 4096.0F;
    offsets[i] = static_cast<float>(i % 1000) / 777.0F;
  }
  const auto out = play(*tables, increments, positions, offsets);
  knotwave::base::Sha256 hash;
  hash.update(out);
  EXPECT_EQ(hash.finish_hex(), "8792f430594e1e8788ac37e0d56b41f5813f83f77387de56de3383891a762a18");
}

}  // namespace

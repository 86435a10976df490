// SPDX-License-Identifier: MIT
// What moving phases and positions do to an alias-free wave: the limits docs/alias-free.md states.
// The reference is the same harmonics summed exactly at 16 times the rate; its lines below half the
// rate are the true ones, the rest of what we play is alias.
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/builtin_waves.h"
#include "knotwave/dsp/oscillator.h"

#include "support/spectrum.h"
#include "table_cases.h"

namespace {

using namespace knotwave::test;  // table_cases.h
using knotwave::base::Phase;
using knotwave::dsp::TableOscillator;
namespace support = knotwave::support;

constexpr double kRate = 48000;
constexpr double kPi = 3.14159265358979323846;
constexpr int kSize = 1 << 13;
constexpr int kOver = 16;

using Harmonics = std::vector<std::complex<double>>;
/// Complex amplitude of each harmonic, and the phase in cycles, at time t = 0..1 of the whole.
struct Reference {
  std::function<double(double)> phase;
  std::function<Harmonics(double)> harmonics;
};

/// Strongest line below 18 kHz of `samples` less the reference, dBFS.
double alias_below_18k(const std::vector<float>& samples, const Reference& reference) {
  std::vector<double> exact(std::size_t(kSize) * kOver);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(exact.size());
    const double phase = reference.phase(t);
    const std::complex<double> turn(std::cos(2 * kPi * phase), std::sin(2 * kPi * phase));
    std::complex<double> power = 1;
    const Harmonics harmonics = reference.harmonics(t);
    for (std::size_t n = 1; n < harmonics.size(); ++n) {
      power *= turn;
      exact[i] += 2 * (harmonics[n] * power).real();
    }
  }
  const auto truth = support::line_spectrum(std::span<const double>(exact));
  const auto lines = support::line_spectrum(samples);
  double worst = 0;
  for (std::size_t b = 0; static_cast<double>(b) * kRate / kSize < 18000; ++b) {
    worst = std::max(worst, std::abs(lines[b] - truth[b]));
  }
  return support::decibels(worst);
}

/// f0 on a bin such that the highest harmonic of its level is as near to Nyquist as can be.
int hardest_bin(const WaveTables& tables, int near) {
  int best = near;
  double highest = 0;
  for (int bin = near; bin < near * 5 / 4; ++bin) {
    const Phase step = {std::uint64_t(bin) << 51};
    const double top = static_cast<double>(bin) * tables.level_harmonics(tables.level_for(step));
    if (top > highest) highest = top, best = bin;
  }
  return best;
}

struct Played {
  double alias_db;
  double hz;
};

/// A saw whose phase is moved by depth * sin: the worst alias below 18 kHz.
Played phase_modulated(int near_bin, double deviation, int modulator_bin) {
  const WaveTables tables = *knotwave::dsp::builtin_wave("saw");
  const int bin = hardest_bin(tables, near_bin);
  const Phase step = {std::uint64_t(bin) << 51};
  // Phase d sin(2 pi fm t) moves the pitch by 2 pi d fm: d from the deviation of the pitch.
  const double depth = deviation * bin / (2 * kPi * modulator_bin);
  const auto shift = [=](double t) { return depth * std::sin(2 * kPi * modulator_bin * t); };
  std::vector<float> offsets(kSize), out(kSize);
  for (int i = 0; i < kSize; ++i) offsets[std::size_t(i)] = float(shift(double(i) / kSize));
  const std::vector<Phase> increments(kSize, step);
  TableOscillator oscillator;
  oscillator.start({}, 0);
  oscillator.render(tables, increments, {}, offsets, out, {});
  const auto kept = tables.coefficients(0, 0).first(
      static_cast<std::size_t>(tables.level_harmonics(tables.level_for(step))) + 1);
  const Harmonics harmonics(kept.begin(), kept.end());
  return {alias_below_18k(out, {[=](double t) { return bin * t + shift(t); },
                                [=](double) { return harmonics; }}),
          bin * kRate / kSize};
}

TEST(TableOscillatorLimits, PhaseModulationIsCleanWhileItMovesThePitchByAFifth) {
  constexpr int kNearBin = 170;
  const double deviations[] = {0.01, 0.03, 0.1, 0.2, 0.3, 0.5};
  std::printf("saw near %.0f Hz, phase modulated: worst alias below 18 kHz by deviation\n%9s",
              kNearBin * kRate / kSize, "fm Hz");
  for (const double deviation : deviations) std::printf(" %6.0f%%", 100 * deviation);
  for (const int modulator_bin : {1, 17, 171}) {
    std::printf("\n%9.1f", modulator_bin * kRate / kSize);
    for (const double deviation : deviations) {
      const Played played = phase_modulated(kNearBin, deviation, modulator_bin);
      std::printf(" %7.1f", played.alias_db);
      const bool fast = modulator_bin == 171;  // 1 kHz: its sidebands reach further than the pitch
      if (deviation <= (fast ? 0.03 : 0.2)) {
        EXPECT_LT(played.alias_db, -110);
      }
    }
  }
  std::printf("\n");
}

TEST(TableOscillatorLimits, AMovingPositionStaysCleanUpTo1kHz) {
  const NurbsSurface surface = morph(false);
  const WaveTables tables = made(WaveTables::create(surface));
  std::printf("surface, position 0.5 + 0.45 sin: worst alias below 18 kHz\n");
  for (const int modulator_bin : {1, 17, 85, 171, 341, 683}) {
    const int bin = hardest_bin(tables, 170);
    const Phase step = {std::uint64_t(bin) << 51};
    const auto position = [=](double t) {
      return 0.5 + 0.45 * std::sin(2 * kPi * modulator_bin * t);
    };
    std::vector<float> positions(kSize), out(kSize);
    for (int i = 0; i < kSize; ++i) positions[std::size_t(i)] = float(position(double(i) / kSize));
    const std::vector<Phase> increments(kSize, step);
    TableOscillator oscillator;
    oscillator.start({}, 0);
    oscillator.render(tables, increments, positions, {}, out, {});
    const auto kept = static_cast<std::size_t>(tables.level_harmonics(tables.level_for(step))) + 1;
    const double db = alias_below_18k(out, {[=](double t) { return bin * t; },
                                            [&](double t) {
                                              Harmonics sum(kept);
                                              const auto blend = tables.blend_at(position(t));
                                              for (int r = 0; r < blend.count; ++r) {
                                                const auto row =
                                                    tables.coefficients(blend.first + r, 0);
                                                for (std::size_t n = 1; n < kept; ++n)
                                                  sum[n] += double(blend.weight[r]) * row[n];
                                              }
                                              return sum;
                                            }});
    std::printf("f0 %.0f Hz, fm %7.1f Hz: %.1f dBFS\n", bin * kRate / kSize,
                modulator_bin * kRate / kSize, db);
    if (modulator_bin <= 171) {
      EXPECT_LT(db, -100);
    }
  }
}

}  // namespace

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/oscillator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/builtin_waves.h"
#include "support/spectrum.h"
#include "waveforms.h"

namespace {

using knotwave::base::Phase;
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

}  // namespace

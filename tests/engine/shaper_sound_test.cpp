// SPDX-License-Identifier: MIT
// What a shaper costs: treble, and what it folds. The numbers of docs/alias-free.md.
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/dsp/fft.h"
#include "knotwave/dsp/shaper.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

constexpr std::size_t kSize = 1 << 16;

dsp::ShaperProgram shaper_of(std::vector<double> points, std::vector<double> knots,
                             std::vector<double> jumps = {}) {
  curves::CurveSpec spec;
  spec.name = "c";
  spec.degree = 1;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.jumps = std::move(jumps);
  const auto curve = curves::NurbsCurve::create(spec);
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().to_string());
  auto program = dsp::ShaperProgram::create(*curve);
  EXPECT_TRUE(program) << (program ? "" : program.error().to_string());
  return *std::move(program);
}

/// Levels of the lines 0..kSize/2 of a sine of k cycles in kSize samples, shaped; in dB of a sine
/// of amplitude 1. Coherent, so no window.
std::vector<double> lines_of(const dsp::ShaperProgram& program, std::size_t k, double drive_db) {
  std::vector<float> in(2 * kSize), out(2 * kSize);
  for (std::size_t i = 0; i < in.size(); ++i) {
    const auto place = static_cast<double>(i * k % kSize) / kSize;
    in[i] = static_cast<float>(std::sin(2 * std::numbers::pi * place));
  }
  const std::vector<float> drive(in.size(), static_cast<float>(std::pow(10, drive_db / 20)));
  dsp::Shaper shaper;
  shaper.render(program, drive, 1, in, out);
  std::vector<std::complex<double>> spectrum(kSize);
  for (std::size_t i = 0; i < kSize; ++i) spectrum[i] = static_cast<double>(out[kSize + i]);
  dsp::fft(spectrum, false);
  std::vector<double> lines;
  for (std::size_t i = 0; i <= kSize / 2; ++i)
    lines.push_back(dbfs(2 * std::abs(spectrum[i]) / kSize));
  return lines;
}

/// The strongest line that is no harmonic of k, below `limit`.
double worst_alias(const std::vector<double>& lines, std::size_t k, std::size_t limit) {
  double worst = -400;
  for (std::size_t i = 1; i < limit; ++i) {
    if (i % k != 0) worst = std::max(worst, lines[i]);
  }
  return worst;
}

TEST(ShaperSound, AStraightShaperLosesTreble) {
  const auto straight = shaper_of({-1, 1}, {-1, -1, 1, 1});
  struct Row {
    double rate_hz, at_5k, at_10k, at_15k, at_20k;
  };
  // 20 log10 cos(pi f / fs)
  for (const Row& row :
       {Row{44100, -0.57, -2.42, -6.36, -16.74}, Row{48000, -0.48, -2.01, -5.11, -11.74},
        Row{96000, -0.12, -0.48, -1.10, -2.01}, Row{192000, -0.03, -0.12, -0.26, -0.48}}) {
    const double levels[] = {row.at_5k, row.at_10k, row.at_15k, row.at_20k};
    for (int i = 0; i < 4; ++i) {
      const double hz = 5000 * (i + 1);
      const auto k = static_cast<std::size_t>(hz * kSize / row.rate_hz) | 1;
      EXPECT_NEAR(lines_of(straight, k, 0)[k], levels[i], 0.02) << hz << " of " << row.rate_hz;
    }
  }
}

TEST(ShaperSound, WithoutAnyOfItThePatchSoundsAsIfItWereNotThere) {
  const std::string shaper = "[curves.c]\ndegree = 1\npoints = [1, -1]\n[shaper]\ncurve = 'c'\n";
  const auto render = [&](const std::string& more) {
    const auto bank = bank_from(std::string(kPlain) + more);
    return play(*engine_for(*bank), {on(0, 0, 120)}, 2000);
  };
  EXPECT_EQ(render(shaper + "mix = 0\n"), render(""));
  EXPECT_NE(render(shaper + "mix = 0.01\n"), render(""));
}

TEST(ShaperSound, WhatCornersFoldsAndJumpsAliasIsAsDocumented) {
  const auto clip = shaper_of({-1, 1}, {-1, -1, 1, 1});
  const auto fold = shaper_of({-1, 1, -1, 1}, {-4, -4, -1.333333, 1.333333, 4, 4});
  const auto jump = shaper_of({-1, -1, 1, 1}, {-1, -1, 0, 0, 1, 1}, {0});
  struct Row {
    const dsp::ShaperProgram* program;
    double drive_db, rate_hz, hz, worst, worst_below_18k;
  };
  for (const Row& row : {
           Row{&clip, 12, 48000, 110, -85.0, -91.1},
           Row{&clip, 12, 44100, 440, -60.7, -67.2},
           Row{&clip, 12, 48000, 440, -59.9, -66.8},
           Row{&clip, 12, 96000, 440, -73.6, -90.1},
           Row{&clip, 12, 192000, 440, -85.0, -112.4},
           Row{&clip, 12, 48000, 1760, -42.2, -46.1},
           Row{&fold, 12, 48000, 110, -81.3, -88.1},
           Row{&fold, 12, 44100, 440, -55.4, -61.2},
           Row{&fold, 12, 48000, 440, -58.7, -63.2},
           Row{&fold, 12, 96000, 440, -69.8, -86.8},
           Row{&fold, 12, 192000, 440, -81.3, -108.8},
           Row{&fold, 12, 48000, 1760, -35.6, -49.1},
           Row{&jump, 0, 48000, 110, -48.7, -53.3},
           Row{&jump, 0, 44100, 440, -36.1, -39.7},
           Row{&jump, 0, 48000, 440, -36.7, -41.4},
           Row{&jump, 0, 96000, 440, -42.6, -56.1},
           Row{&jump, 0, 192000, 440, -48.7, -70.1},
           Row{&jump, 0, 48000, 1760, -26.3, -32.1},
       }) {
    const auto k = static_cast<std::size_t>(row.hz * kSize / row.rate_hz) | 1;
    const auto lines = lines_of(*row.program, k, row.drive_db);
    const auto limit = static_cast<std::size_t>(18000 * kSize / row.rate_hz);
    EXPECT_NEAR(worst_alias(lines, k, kSize / 2), row.worst, 0.1) << row.hz << " " << row.rate_hz;
    EXPECT_NEAR(worst_alias(lines, k, limit), row.worst_below_18k, 0.1) << row.hz;
  }
}

}  // namespace
}  // namespace knotwave::engine

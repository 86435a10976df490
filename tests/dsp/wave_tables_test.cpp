// SPDX-License-Identifier: MIT
#include "knotwave/dsp/wave_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/curves/nurbs_curve.h"

#include "support/seed.h"
#include "support/spectrum.h"
#include "table_cases.h"
#include "waveforms.h"

namespace {

using Complex = std::complex<double>;
using knotwave::ErrorCode;
using knotwave::base::Phase;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::curves::NurbsSurface;
using knotwave::dsp::WaveTableOptions;
using knotwave::dsp::WaveTables;
using namespace knotwave::test;  // table_cases.h, waveforms.h

struct Reference {
  std::string name;
  int degree;
  bool periodic;
  std::vector<double> points, knots;
  struct Harmonic {
    int n;
    double re, im;
  };
  std::vector<Harmonic> harmonics;
};
const Reference kReferences[] = {
#include "fourier_reference.inc"
};

NurbsCurve curve_of(const Reference& reference) {
  CurveSpec spec;
  spec.name = reference.name;
  spec.degree = reference.degree;
  spec.periodic = reference.periodic;
  spec.points = reference.points;
  spec.knots = reference.knots;
  if (reference.name.find("jump") != std::string::npos) spec.jumps = {0.5};
  auto curve = NurbsCurve::create(spec);
  EXPECT_TRUE(curve) << curve.error().message;
  return *curve;
}

TEST(FourierCoefficients, AgreeWithSixtyDigitIntegralsWithin200dBOfThePeak) {
  double worst = 0;
  for (const Reference& reference : kReferences) {
    const auto program = knotwave::curves::compile_polynomial(curve_of(reference));
    ASSERT_TRUE(program) << program.error().message;
    const auto found = knotwave::dsp::fourier_coefficients(*program, 0, 2048);
    double error = 0;
    for (const Reference::Harmonic& harmonic : reference.harmonics) {
      const Complex truth(harmonic.re, harmonic.im);
      error = std::max(error, std::abs(found[static_cast<std::size_t>(harmonic.n)] - truth));
    }
    std::printf("%-42s error %.0f dB\n", reference.name.c_str(),
                knotwave::support::decibels(error));
    worst = std::max(worst, error);
  }
  EXPECT_LT(knotwave::support::decibels(worst), -200);
}

TEST(WaveTables, ReadReturnsTheCurveLessItsMean) {
  const auto spec = smooth_spec();
  const auto curve = NurbsCurve::create(spec);
  ASSERT_TRUE(curve);
  WaveTableOptions options;
  options.remove_dc = false;
  const WaveTables whole = of_curve(spec, options), centred = of_curve(spec);
  const double mean = whole.coefficients(0, 0)[0].real();
  for (int k = 0; k < 1000; ++k) {
    double exact = 0;
    curve->evaluate(k / 1000.0, std::span(&exact, 1));
    EXPECT_NEAR(whole.read(whole.level_count() - 1, {}, 0, turn(k / 1000.0)), exact, 5e-7);
    EXPECT_NEAR(centred.read(centred.level_count() - 1, {}, 0, turn(k / 1000.0)), exact - mean,
                5e-7);
  }
}

TEST(WaveTables, EveryLevelStaysBelowNyquistAndReachesFourFifthsOfIt) {
  const WaveTables tables = of_curve(saw_spec());
  std::mt19937_64 generator(knotwave::support::test_seed());
  const double third = std::exp2(-1.0 / 3);
  for (int k = 0; k < 200000; ++k) {
    const int shift = static_cast<int>(generator() % 56);
    const Phase step = {(generator() >> 1) >> shift};
    if (step.value == 0) continue;
    const int level = tables.level_for(step);
    const double top = tables.level_harmonics(level) * static_cast<double>(step.value) * 0x1p-63;
    ASSERT_LT(top, 1) << "increment " << step.value;
    ASSERT_EQ(level, tables.level_for({std::uint64_t(0) - step.value}));
    if (level + 1 == tables.level_count()) continue;
    // The first harmonic left out would have been within a third of an octave of Nyquist.
    const double left_out =
        (tables.level_harmonics(level) + 1) * static_cast<double>(step.value) * 0x1p-63;
    ASSERT_GT(left_out, third) << "increment " << step.value;
    const double next =
        tables.level_harmonics(level + 1) * static_cast<double>(step.value) * 0x1p-63;
    ASSERT_GE(next, 1 - 1e-12) << "a richer level would have fitted " << step.value;
  }
  EXPECT_EQ(tables.level_for({0}), tables.level_count() - 1);
  EXPECT_EQ(tables.level_for({std::uint64_t(1) << 63}), 0);
}

TEST(WaveTables, SmoothWavesNeedFewHarmonicsAndASineNeedsOne) {
  const WaveTables smooth = of_curve(smooth_spec());
  EXPECT_LT(smooth.level_harmonics(smooth.level_count() - 1), 1500);  // n^-4
  const WaveTables sine =
      made(WaveTables::create_from_harmonics(std::vector<Complex>{0, {0, -0.5}}));
  EXPECT_EQ(sine.level_count(), 1);
  EXPECT_EQ(sine.level_for({std::uint64_t(1) << 62}), 0);
  EXPECT_NEAR(sine.read(0, {}, 0, turn(0.25)), 1, 1e-7);
}

TEST(WaveTables, ARowOfASurfaceIsTheCurveThere) {
  const NurbsSurface surface = morph(false);
  const WaveTables tables = made(WaveTables::create(surface));
  EXPECT_EQ(tables.rows(), 6);
  EXPECT_LT(tables.fit_error(), 1e-14);
  for (const double position : {0.0, 0.1, 1 / 3.0, 0.5, 0.77, 1.0}) {
    const WaveTables truth = made(WaveTables::create(surface.iso_curve_at_v(position)));
    EXPECT_LT(difference(tables, position, truth), 1e-6) << "position " << position;
  }
}

TEST(WaveTables, PositionsMoveWithoutSteps) {
  const WaveTables tables = made(WaveTables::create(morph(false)));
  const Phase phase = turn(0.3);
  float before = tables.read(tables.level_count() - 1, tables.blend_at(0), 0, phase);
  double steepest = 0;
  constexpr int kSteps = 100000;
  for (int k = 1; k <= kSteps; ++k) {
    const float now =
        tables.read(tables.level_count() - 1, tables.blend_at(double(k) / kSteps), 0, phase);
    steepest = std::max(steepest, double(std::abs(now - before)));
    before = now;
  }
  EXPECT_LT(steepest, 40.0 / kSteps);  // 6 rows within -1..1: a slope below 3 * 6 * 2
}

TEST(WaveTables, BlendsClampThePositionAndSumToOne) {
  const WaveTables tables = made(WaveTables::create(morph(false)));
  const auto same = [](const WaveTables::RowBlend& a, const WaveTables::RowBlend& b) {
    return a.first == b.first && a.count == b.count && std::equal(a.weight, a.weight + 8, b.weight);
  };
  EXPECT_TRUE(same(tables.blend_at(-1), tables.blend_at(0)));
  EXPECT_TRUE(same(tables.blend_at(7), tables.blend_at(1)));
  EXPECT_TRUE(same(tables.blend_at(std::nan("")), tables.blend_at(0)));
  for (int k = 0; k <= 100; ++k) {
    const auto blend = tables.blend_at(k / 100.0);
    float sum = 0;
    for (int r = 0; r < blend.count; ++r) sum += blend.weight[r];
    EXPECT_NEAR(sum, 1, 3e-7);
    EXPECT_LE(blend.first + blend.count, tables.rows());
  }
}

TEST(WaveTables, SampledCyclesOfAnyLengthComeBackAtTheirSamples) {
  for (const int frame : {2, 3, 37, 600, 2048}) {
    constexpr int kRows = 3;
    std::vector<float> samples;
    for (int row = 0; row < kRows; ++row) {
      for (int k = 0; k < frame; ++k) {
        const double t = double(k) / frame;
        samples.push_back(
            static_cast<float>(std::sin(2 * M_PI * t) * (frame > 2) +
                               0.3 * std::cos(2 * M_PI * (1 + row) * t) * (frame > 8)));
      }
    }
    WaveTableOptions options;
    options.remove_dc = false;
    const WaveTables tables = made(WaveTables::create_from_cycles(samples, frame, kRows, options));
    ASSERT_EQ(tables.rows(), kRows);
    for (int row = 0; row < kRows; ++row) {
      const auto blend = tables.blend_at(row / double(kRows - 1));
      for (int k = 0; k < frame; ++k) {
        EXPECT_NEAR(tables.read(tables.level_count() - 1, blend, 0, turn(double(k) / frame)),
                    samples[static_cast<std::size_t>(row * frame + k)], 1e-6)
            << "row " << row << " sample " << k << " of " << frame;
      }
    }
  }
}

TEST(WaveTables, FaultsAreNamed) {
  CurveSpec spec = saw_spec();
  spec.dim = 3;
  spec.points = {0, 0, 0, 1, 1, 1};
  const auto curve = NurbsCurve::create(spec);
  ASSERT_TRUE(curve);
  const auto in_space = WaveTables::create(*curve);
  ASSERT_FALSE(in_space);
  EXPECT_EQ(in_space.error().code, ErrorCode::not_scalar);
  EXPECT_EQ(in_space.error().message,
            "'saw' has 3 coordinates; a waveform has 1, or 2 for left and right");
  const std::vector<float> samples(100);
  EXPECT_EQ(WaveTables::create_from_cycles(samples, 1, 100).error().code,
            ErrorCode::too_few_points);
  EXPECT_EQ(WaveTables::create_from_cycles(samples, 33, 3).error().message,
            "3 cycles of 33 are not 100 samples");
  std::vector<float> broken = samples;
  broken[7] = std::nanf("");
  EXPECT_EQ(WaveTables::create_from_cycles(broken, 50, 2).error().message,
            "sample 7 is not a finite number");
  WaveTableOptions options;
  options.max_harmonic = 0;
  EXPECT_EQ(WaveTables::create_from_cycles(samples, 50, 2, options).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(WaveTables::create_from_harmonics({}).error().code, ErrorCode::too_few_points);
}

TEST(WaveTables, TooManyTablesAreRefusedBeforeTheyAreMade) {
  std::vector<float> pulses(std::size_t(4096) * 1200, 0.0F);
  for (std::size_t k = 0; k < pulses.size(); k += 4096) pulses[k] = 1;
  EXPECT_TRUE(WaveTables::create_from_cycles(std::span(pulses).first(4096 * 4), 4096, 4));
  const auto too_many = WaveTables::create_from_cycles(pulses, 4096, 1200);
  ASSERT_FALSE(too_many);
  EXPECT_EQ(too_many.error().code, ErrorCode::value_out_of_range);
  EXPECT_NE(too_many.error().message.find("MiB"), std::string::npos) << too_many.error().message;
}

}  // namespace

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
#include "waveforms.h"

namespace {

using Complex = std::complex<double>;
using knotwave::ErrorCode;
using knotwave::base::Phase;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::curves::NurbsSurface;
using knotwave::curves::SurfaceSpec;
using knotwave::dsp::WaveTableOptions;
using knotwave::dsp::WaveTables;

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

WaveTables made(knotwave::Result<WaveTables> tables) {
  EXPECT_TRUE(tables) << tables.error().message;
  return tables ? *tables : WaveTables();
}

WaveTables of_curve(const CurveSpec& spec, const WaveTableOptions& options = {}) {
  const auto curve = NurbsCurve::create(spec);
  EXPECT_TRUE(curve) << curve.error().message;
  return made(WaveTables::create(*curve, options));
}

Phase turn(double cycles) { return knotwave::base::phase_from_cycles(cycles); }

/// A morph of four different closed shapes; with weights it is rational.
NurbsSurface morph(bool rational, int degree_v = 3) {
  SurfaceSpec spec;
  spec.name = "morph";
  spec.count_u = 12;
  spec.count_v = degree_v + 3;
  spec.degree_v = degree_v;
  spec.periodic_u = true;
  for (int k = 0; k < spec.count_u * spec.count_v; ++k) {
    spec.points.push_back(((k * 53) % 29 - 14) / 14.0);
    if (rational) spec.weights.push_back(k % 5 == 0 ? 4.0 : 1.0);
  }
  auto surface = NurbsSurface::create(spec);
  EXPECT_TRUE(surface) << surface.error().message;
  return *surface;
}

/// Largest difference of the tables at a position from those of the curve there, all harmonics.
double difference(const WaveTables& tables, double position, const WaveTables& truth) {
  double worst = 0;
  const auto blend = tables.blend_at(position);
  for (int k = 0; k < 257; ++k) {
    const Phase phase = turn(k / 257.0);
    worst = std::max(worst, double(std::abs(tables.read(tables.level_count() - 1, blend, 0, phase) -
                                            truth.read(truth.level_count() - 1, {}, 0, phase))));
  }
  return worst;
}

TEST(WaveTables, ReadReturnsTheCurveLessItsMean) {
  const auto spec = knotwave::test::smooth_spec();
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
    EXPECT_NEAR(centred.read(centred.level_count() - 1, {}, 0, turn(k / 1000.0)), exact - mean, 5e-7);
  }
}

TEST(WaveTables, EveryLevelStaysBelowNyquistAndReachesFourFifthsOfIt) {
  const WaveTables tables = of_curve(knotwave::test::saw_spec());
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
    const double left_out = (tables.level_harmonics(level) + 1) * static_cast<double>(step.value) * 0x1p-63;
    ASSERT_GT(left_out, third) << "increment " << step.value;
    const double next = tables.level_harmonics(level + 1) * static_cast<double>(step.value) * 0x1p-63;
    ASSERT_GE(next, 1 - 1e-12) << "a richer level would have fitted " << step.value;
  }
  EXPECT_EQ(tables.level_for({0}), tables.level_count() - 1);
  EXPECT_EQ(tables.level_for({std::uint64_t(1) << 63}), 0);
}

TEST(WaveTables, SmoothWavesNeedFewHarmonicsAndASineNeedsOne) {
  const WaveTables smooth = of_curve(knotwave::test::smooth_spec());
  EXPECT_LT(smooth.level_harmonics(smooth.level_count() - 1), 1000);
  const WaveTables sine = made(WaveTables::create_from_harmonics(std::vector<Complex>{0, {0, -0.5}}));
  EXPECT_EQ(sine.level_count(), 1);
  EXPECT_EQ(sine.level_for({std::uint64_t(1) << 62}), 0);
  EXPECT_NEAR(sine.read(0, {}, 0, turn(0.25)), 1, 1e-7);
}

TEST(WaveTables, ARowOfASurfaceIsTheCurveThere) {
  const NurbsSurface surface = morph(false);
  const WaveTables tables = made(WaveTables::create(surface));
  EXPECT_EQ(tables.rows(), 6);
  EXPECT_EQ(tables.fit_error(), 0);
  for (const double position : {0.0, 0.1, 1 / 3.0, 0.5, 0.77, 1.0}) {
    const WaveTables truth = made(WaveTables::create(surface.iso_curve_at_v(position)));
    EXPECT_LT(difference(tables, position, truth), 1e-6) << "position " << position;
  }
}

TEST(WaveTables, ARationalSurfaceIsFittedWithinTheErrorItStates) {
  const NurbsSurface surface = morph(true);
  const WaveTables tables = made(WaveTables::create(surface));
  EXPECT_GT(tables.fit_error(), 0);
  EXPECT_LE(tables.fit_error(), 1e-6);
  std::printf("rational surface: %d rows, fit error %.2g\n", tables.rows(), tables.fit_error());
  for (const double position : {0.0, 0.05, 1 / 3.0, 0.41, 0.5, 0.93, 1.0}) {
    const WaveTables truth = made(WaveTables::create(surface.iso_curve_at_v(position)));
    EXPECT_LT(difference(tables, position, truth), 5e-6) << "position " << position;
  }
}

TEST(WaveTables, ADegreeAboveSevenAlongVIsFitted) {
  const NurbsSurface surface = morph(false, 9);
  const WaveTables tables = made(WaveTables::create(surface));
  for (const double position : {0.0, 0.21, 0.6, 1.0}) {
    const WaveTables truth = made(WaveTables::create(surface.iso_curve_at_v(position)));
    EXPECT_LT(difference(tables, position, truth), 5e-6) << "position " << position;
  }
}

TEST(WaveTables, AControlBecomesAPosition) {
  using knotwave::curves::ControlRange;
  auto spec = knotwave::test::smooth_spec();
  const auto curve = NurbsCurve::create(spec);
  ASSERT_TRUE(curve);
  ControlRange point;
  point.kind = ControlRange::Kind::coordinate;
  point.point = 5;
  point.low = -1;
  point.high = 3;
  const WaveTables moved = made(WaveTables::create(*curve, point));
  EXPECT_EQ(moved.rows(), 2);
  ControlRange weight;
  weight.point = 5;
  weight.low = 0.1;
  weight.high = 10;
  const WaveTables weighted = made(WaveTables::create(*curve, weight));
  std::printf("weight 0.1 to 10: %d rows, fit error %.2g\n", weighted.rows(), weighted.fit_error());
  for (const double position : {0.0, 0.02, 0.5, 0.9, 1.0}) {
    auto at = spec;
    at.points[5] = -1 + 4 * position;
    EXPECT_LT(difference(moved, position, of_curve(at)), 2e-6) << "point at " << position;
    at = spec;
    at.weights.assign(at.points.size(), 1.0);
    at.weights[5] = 0.1 + 9.9 * position;
    EXPECT_LT(difference(weighted, position, of_curve(at)), 5e-6) << "weight at " << position;
  }
  point.point = 16;
  const auto wrong = WaveTables::create(*curve, point);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, "'C2 16 points' has points 0..15, not 16");
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
        samples.push_back(static_cast<float>(std::sin(2 * M_PI * t) * (frame > 2) +
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
  CurveSpec spec = knotwave::test::saw_spec();
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
  EXPECT_EQ(WaveTables::create_from_cycles(samples, 1, 100).error().code, ErrorCode::too_few_points);
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
  std::vector<float> samples(64 * 4096);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = k % 64 == 0 ? 1.0F : 0.0F;
  EXPECT_TRUE(WaveTables::create_from_cycles(samples, 64, 64));
  const std::vector<float> long_cycles(std::size_t(4096) * 1200, 0.0F);
  std::vector<float> pulses = long_cycles;
  for (std::size_t k = 0; k < pulses.size(); k += 4096) pulses[k] = 1;
  const auto too_many = WaveTables::create_from_cycles(pulses, 4096, 1200);
  ASSERT_FALSE(too_many);
  EXPECT_EQ(too_many.error().code, ErrorCode::value_out_of_range);
  EXPECT_NE(too_many.error().message.find("MiB"), std::string::npos) << too_many.error().message;
}

}  // namespace

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/shaper.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/seed.h"
#include "support/spectrum.h"

namespace {

using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::Shaper;
using knotwave::dsp::ShaperProgram;

struct Mean {
  double x0, x1, mean;
};
constexpr Mean kReference[] = {
#include "shaper_reference.inc"
};

constexpr double kMinus130Db = 3.16e-7;

NurbsCurve curve_of(std::vector<double> points, int degree, std::vector<double> knots,
                    std::vector<double> weights = {}) {
  CurveSpec spec;
  spec.degree = degree;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  spec.knots = std::move(knots);
  return NurbsCurve::create(std::move(spec)).value();
}

// The curve of tools/make_shaper_reference.py.
NurbsCurve reference_curve() {
  return curve_of({-0.9, -1.0, -0.2, 0.35, -0.5, 0.8, 0.95, 0.6}, 3,
                  {-1, -1, -1, -1, -0.4, 0, 0.3, 0.3, 1, 1, 1, 1});
}

// 1.5 x - 0.5 x^3: a soft clip, flat at the ends.
NurbsCurve soft_clip() { return curve_of({-1, -1, 1, 1}, 3, {-1, -1, -1, -1, 1, 1, 1, 1}); }

// Up and down five times: a folder.
NurbsCurve fold() {
  return curve_of({-1, 1, -1, 1, -1, 1}, 2, {-1, -1, -1, -0.5, 0, 0.5, 1, 1, 1});
}

double value_of(const NurbsCurve& curve, double x) {
  double y = 0;
  curve.evaluate(x, {&y, 1});
  return y;
}

TEST(ShaperProgram, MeanIsTheExactIntegralForAnyGap) {
  const auto program = ShaperProgram::create(reference_curve()).value();
  double worst = 0;
  for (const Mean& row : kReference) {
    const double mean = program.mean(row.x0, row.x1);
    worst = std::max(worst, std::abs(mean - row.mean));
    EXPECT_NEAR(mean, row.mean, 1e-14) << row.x0 << " .. " << row.x1;
    EXPECT_EQ(mean, program.mean(row.x1, row.x0));
  }
  EXPECT_LT(worst, kMinus130Db);
  std::printf("worst error %.1f dB\n", 20 * std::log10(worst + 1e-30));
}

TEST(ShaperProgram, ACurveDrawnAsXAndYIsReadByItsX) {
  // An S with handles: x(t) and y(t) are cubics, y over x is none of both.
  CurveSpec spec;
  spec.degree = 3;
  spec.dim = 2;
  spec.points = {-1, -0.9, -0.2, -0.9, -0.3, 0.1, 0, 0.2, 0.4, 0.3, 0.1, 1, 1, 0.8};
  spec.knots = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2};
  const NurbsCurve drawn = NurbsCurve::create(spec).value();
  const auto program = ShaperProgram::create(drawn);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_LT(program->max_error(), kMinus130Db);
  double area = 0, last_x = -1, last_y = -0.9;  // the integral of y dx along the drawn curve
  constexpr int kSteps = 200000;
  for (int i = 1; i <= kSteps; ++i) {
    double xy[2];
    drawn.evaluate(2.0 * i / kSteps, xy);
    if (i % 1000 == 0) {
      EXPECT_NEAR(program->at(xy[0]), xy[1], kMinus130Db) << xy[0];
    }
    area += (xy[0] - last_x) * (xy[1] + last_y) / 2;
    last_x = xy[0];
    last_y = xy[1];
  }
  EXPECT_NEAR(program->mean(-1, 1), area / 2, kMinus130Db);
  EXPECT_NEAR(program->at(-3), -0.9, 1e-15);
  EXPECT_NEAR(program->at(3), 0.8, 1e-15);
}

TEST(ShaperProgram, ACurveWhoseXGoesBackIsRefused) {
  CurveSpec spec;
  spec.name = "back";
  spec.dim = 2;
  spec.points = {-1, -1, 1.5, 0, -1.5, 0, 1, 1};
  const auto program = ShaperProgram::create(NurbsCurve::create(spec).value());
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, knotwave::ErrorCode::not_a_function);
}

TEST(ShaperProgram, MeanOfARationalCurveIsItsIntegralWithinMinus130Db) {
  const NurbsCurve curve =
      curve_of({-1, -0.9, 0, 0.9, 1}, 3, {-1, -1, -1, -1, 0.1, 1, 1, 1, 1}, {1, 5, 0.3, 4, 1});
  const auto program = ShaperProgram::create(curve).value();
  EXPECT_LT(program.max_error(), kMinus130Db);
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 100; ++i) {
    const double x0 = unit(random);
    const double x1 = i % 2 == 0 ? unit(random) : x0 + 1e-3 * unit(random);
    // Simpson's rule on 2^12 steps: error below 1e-11 here.
    const int steps = 1 << 12;
    double sum = 0;
    for (int k = 0; k <= steps; ++k) {
      const double weight = k == 0 || k == steps ? 1 : (k % 2 == 1 ? 4 : 2);
      sum += weight * value_of(curve, x0 + (x1 - x0) * k / steps);
    }
    EXPECT_NEAR(program.mean(x0, x1), sum / (3 * steps), kMinus130Db);
  }
}

TEST(ShaperProgram, HoldsItsEndValuesOutside) {
  const auto program = ShaperProgram::create(soft_clip()).value();
  EXPECT_NEAR(program.at(5), 1, 1e-15);
  EXPECT_NEAR(program.at(-5), -1, 1e-15);
  EXPECT_NEAR(program.mean(2, 7), 1, 1e-15);
  EXPECT_NEAR(program.mean(-9, 9), 0, 1e-15);
  EXPECT_NEAR(program.mean(-1e38, 1e38), 0, 1e-15);
  EXPECT_NEAR(program.mean(-std::numeric_limits<double>::infinity(), 0), -1, 1e-6);
  EXPECT_EQ(program.at(std::numeric_limits<double>::quiet_NaN()), program.at(0));
}

TEST(ShaperProgram, ValueIsThatOfTheCurve) {
  const NurbsCurve curve = reference_curve();
  const auto program = ShaperProgram::create(curve).value();
  for (int i = -100; i <= 100; ++i) {
    EXPECT_NEAR(program.at(i / 100.0), value_of(curve, i / 100.0), 1e-14);
  }
}

TEST(ShaperProgram, AStepInTheCurveIsAveragedToo) {
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {-1, -1, 1, 1};
  spec.knots = {-1, -1, 0, 0, 1, 1};
  spec.jumps = {0};
  const auto program = ShaperProgram::create(NurbsCurve::create(spec).value()).value();
  EXPECT_NEAR(program.mean(-0.25, 0.75), 0.5, 1e-15);
  EXPECT_NEAR(program.mean(-1e-9, 1e-9), 0, 1e-15);
  EXPECT_NEAR(program.mean(-1e-9, 3e-9), 0.5, 1e-15);
}

std::vector<float> shaped(const ShaperProgram& program, const std::vector<float>& in, float drive,
                          float mix) {
  std::vector<float> out(in.size());
  const std::vector<float> drives(in.size(), drive);
  Shaper shaper;
  shaper.render(program, drives, mix, in, out);
  return out;
}

TEST(Shaper, DryAndWetAreBothHalfASampleLate) {
  const auto line = ShaperProgram::create(curve_of({-1, 1}, 1, {-1, -1, 1, 1})).value();
  const std::vector<float> in{0.5f, -0.25f, 0.75f, 0};
  const std::vector<float> expected{0.25f, 0.125f, 0.25f, 0.375f};
  EXPECT_EQ(shaped(line, in, 1, 0), expected);
  const auto wet = shaped(line, in, 1, 1);
  const auto half = shaped(line, in, 1, 0.5f);
  for (std::size_t i = 0; i < in.size(); ++i) {
    EXPECT_NEAR(wet[i], expected[i], 1e-7);
    EXPECT_NEAR(half[i], expected[i], 1e-7);
  }
}

// Strongest line below 6 kHz and sum of all lines below 18 kHz that are no harmonics, in dBFS, of a
// sine driven through the curve.
struct Aliases {
  double audible_db, sum_db;
};

Aliases aliases_of(std::span<const float> samples, int bin) {
  const auto lines = knotwave::support::line_spectrum(samples);
  double worst = 0, power = 0;
  for (std::size_t b = 1; b * 48000 < 18000 * samples.size(); ++b) {
    if (b % static_cast<std::size_t>(bin) == 0) continue;
    power += std::norm(lines[b]);
    if (b * 48000 < 6000 * samples.size()) worst = std::max(worst, std::abs(lines[b]));
  }
  return {knotwave::support::decibels(worst), 10 * std::log10(power)};
}

void expect_fewer_aliases(const char* name, const NurbsCurve& curve, float drive,
                          double frequency_hz, const Aliases& gain_db) {
  constexpr std::size_t kSize = 1 << 14;
  const auto program = ShaperProgram::create(curve).value();
  const int bin = knotwave::support::coherent_bin(frequency_hz, 48000, kSize);
  std::vector<float> in(2 * kSize), plain(kSize);
  for (std::size_t i = 0; i < in.size(); ++i) {
    const double cycles = static_cast<double>(i) * bin / kSize;
    in[i] = static_cast<float>(std::sin(2 * std::numbers::pi * std::fmod(cycles, 1.0)));
  }
  for (std::size_t i = 0; i < kSize; ++i) {
    plain[i] = static_cast<float>(program.at(static_cast<double>(drive * in[i])));
  }
  const auto smooth = shaped(program, in, drive, 1);
  const Aliases before = aliases_of(plain, bin);
  const Aliases after = aliases_of(std::span(smooth).last(kSize), bin);
  std::printf("%s at %.0f Hz: worst below 6 kHz %.1f -> %.1f dBFS, sum below 18 kHz %.1f -> %.1f\n",
              name, frequency_hz, before.audible_db, after.audible_db, before.sum_db, after.sum_db);
  EXPECT_LT(after.audible_db, before.audible_db - gain_db.audible_db) << name;
  EXPECT_LT(after.sum_db, before.sum_db - gain_db.sum_db) << name;
}

TEST(Shaper, LowersTheAliasesOfAClipAndOfAFold) {
  for (const double frequency_hz : {440.0, 1244.0, 2637.0}) {
    expect_fewer_aliases("soft clip, drive 4", soft_clip(), 4, frequency_hz, {17, 8});
    expect_fewer_aliases("fold, drive 0.95", fold(), 0.95f, frequency_hz, {17, 9});
  }
}

TEST(Shaper, BlockSizeDoesNotMatter) {
  const auto program = ShaperProgram::create(reference_curve()).value();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> unit(-1.2f, 1.2f);
  std::vector<float> in(700), drive(700);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = unit(random), drive[i] = 1 + unit(random);
  in[300] = drive[400] = std::numeric_limits<float>::quiet_NaN();
  in[301] = std::numeric_limits<float>::infinity();
  knotwave::support::expect_block_size_does_not_matter<float>(700, [&] {
    return [&, shaper = Shaper()](std::size_t first, std::span<float> out) mutable {
      shaper.render(program, std::span(drive).subspan(first, out.size()), 0.8f,
                    std::span(in).subspan(first, out.size()), out);
      for (const float y : out) ASSERT_TRUE(std::isfinite(y));
    };
  });
}

TEST(Shaper, ABlendOfOneCurveIsThatCurveToTheBit) {
  const auto program = ShaperProgram::create(reference_curve()).value();
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<float> unit(-1.2f, 1.2f);
  std::vector<float> in(300), drive(300), plain(300), blended(300);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = unit(random), drive[i] = 1 + unit(random);
  in[100] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<double> nothing(300, 0), all(300, 1), mix(300, 0.75);
  Shaper one, two;
  one.render(program, drive, 0.75f, in, plain);
  const auto fold_program = ShaperProgram::create(fold()).value();
  const knotwave::dsp::ShaperLayer layers[] = {{&fold_program, nothing}, {&program, all}};
  two.render(layers, {drive, nothing, nothing, mix}, in, blended);
  EXPECT_EQ(plain, blended);
}

TEST(Shaper, ABlendTakesAwayWhatItIsWithoutInput) {
  const auto program = ShaperProgram::create(reference_curve()).value();
  const std::vector<double> none(50, 0), all(50, 1), half(50, 0.5), bias(50, 0.25);
  const std::vector<float> silence(50), drive(50, 1);
  std::vector<float> out(50);
  const knotwave::dsp::ShaperLayer layers[] = {{&program, half}, {&program, half}};
  Shaper shaper;
  shaper.reset(0.25);
  shaper.render(layers, {drive, bias, all, all}, silence, out);
  EXPECT_EQ(out, std::vector<float>(50, 0));
  shaper.render(layers, {drive, bias, none, all}, silence, out);
  for (const float y : out) EXPECT_EQ(y, static_cast<float>(program.at(0.25)));
}

TEST(Shaper, WorksInPlaceAndDoesNotAllocate) {
  const auto program = ShaperProgram::create(fold()).value();
  std::vector<float> in(200);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = std::sin(0.1f * static_cast<float>(i));
  const auto expected = shaped(program, in, 1.5f, 0.5f);
  const std::vector<float> drive(in.size(), 1.5f);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              Shaper shaper;
              shaper.render(program, drive, 0.5f, in, in);
            }),
            0);
  EXPECT_EQ(in, expected);
}

TEST(ShaperProgram, RefusesACurveOfThreeCoordinates) {
  CurveSpec spec;
  spec.degree = 1;
  spec.dim = 3;
  spec.points = {0, 0, 0, 1, 1, 1};
  const auto program = ShaperProgram::create(NurbsCurve::create(spec).value());
  ASSERT_FALSE(program.has_value());
  EXPECT_EQ(program.error().code, knotwave::ErrorCode::not_scalar);
}

}  // namespace

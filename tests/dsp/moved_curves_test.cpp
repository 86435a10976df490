// SPDX-License-Identifier: MIT
// LFOs, glides, crossfade laws and shapers whose curve has numbers that move.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/crossfade.h"
#include "knotwave/dsp/glide.h"
#include "knotwave/dsp/lfo.h"
#include "knotwave/dsp/shaper.h"

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace {

using knotwave::ErrorCode;
using knotwave::curves::CompileOptions;
using knotwave::curves::ControlRange;
using knotwave::curves::CurveProgram;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::CrossfadeLaw;
using knotwave::dsp::Glide;
using knotwave::dsp::Lfo;
using knotwave::dsp::LfoSpec;
using knotwave::dsp::Shaper;
using knotwave::dsp::ShaperProgram;

constexpr double kMinus130Db = 3.16e-7;
constexpr std::size_t kCount = 700;
// Weight of point 1 and the place of point 2.
const std::vector<ControlRange> ranges = {{ControlRange::Kind::weight, 1, 0, 0.25, 8},
                                          {ControlRange::Kind::coordinate, 2, 0, -1, 2}};

NurbsCurve curve_with(double weight, double point) {
  CurveSpec spec;
  spec.degree = 3;
  spec.points = {0, 0.3, point, 0.8, 1};
  spec.weights = {1, weight, 2, 1, 1};
  spec.knots = {-1, -1, -1, -1, 0.2, 1, 1, 1, 1};
  return NurbsCurve::create(std::move(spec)).value();
}
NurbsCurve rest_curve() { return curve_with(1, 0.5); }

CompileOptions moving() {
  CompileOptions options;
  options.controls = ranges;
  return options;
}
double value_of(const NurbsCurve& curve, double u) {
  double y = 0;
  curve.evaluate(u, {&y, 1});
  return y;
}

/// Two controls that go through their ranges at different speeds.
struct Movement {
  std::vector<double> weight = std::vector<double>(kCount), point = std::vector<double>(kCount);
  Movement() {
    for (std::size_t i = 0; i < kCount; ++i) {
      const double t = static_cast<double>(i) / (kCount - 1);
      weight[i] = 0.25 + 7.75 * t * t;
      point[i] = 2 - 3 * t;
    }
  }
  std::vector<const double*> from(std::size_t first) const {
    return {weight.data() + first, point.data() + first};
  }
};

TEST(MovedCurves, AnLfoReadsTheCurveOfEverySample) {
  const CurveProgram cycle = compile_function(rest_curve(), moving()).value();
  const Movement move;
  Lfo lfo;
  const LfoSpec spec{.rate_hz = 187.5};
  lfo.start(spec, {0, 0}, 48000, {});
  std::vector<double> y(kCount);
  lfo.render(spec, cycle, 0, {}, {}, move.from(0), y);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double phase = static_cast<double>(i) / 256, u = -1 + 2 * (phase - std::floor(phase));
    EXPECT_NEAR(y[i], value_of(curve_with(move.weight[i], move.point[i]), u), 1e-7) << i;
  }
}

TEST(MovedCurves, AGlideReadsTheCurveOfEverySampleAndLeavesFromWhereItHadIt) {
  const CurveProgram curve = compile_function(rest_curve(), moving()).value();
  const Movement move;
  Glide glide;
  glide.reset(60);
  glide.start(&curve, 72, {0, 0}, 1000, 1);
  std::vector<double> y(kCount);
  glide.render(&curve, 0, move.from(0), y);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double u = -1 + 2 * (static_cast<double>(i) / 1000);
    EXPECT_NEAR(y[i], 60 + 12 * value_of(curve_with(move.weight[i], move.point[i]), u), 1e-6);
  }
  glide.start(&curve, 48, {kCount - 1, 0}, 1000, 1);
  double at_start = 0;
  const auto last = move.from(kCount - 1);
  glide.render(&curve, kCount - 1, last, {&at_start, 1});
  EXPECT_NEAR(at_start, y.back(), 1e-12);
}

TEST(MovedCurves, ACrossfadeLawReadsTheCurveOfEverySample) {
  const auto law = CrossfadeLaw::create(rest_curve(), moving()).value();
  const Movement move;
  std::vector<double> position(kCount);
  for (std::size_t i = 0; i < kCount; ++i) position[i] = 0.5 + 0.6 * std::sin(0.02 * double(i));
  std::vector<float> a(kCount), b(kCount);
  law.render(position, move.from(0), a, b);
  for (std::size_t i = 0; i < kCount; ++i) {
    const NurbsCurve curve = curve_with(move.weight[i], move.point[i]);
    const double p = std::clamp(position[i], 0.0, 1.0);
    EXPECT_NEAR(b[i], value_of(curve, -1 + 2 * p), 2e-7) << i;
    EXPECT_NEAR(a[i], value_of(curve, 1 - 2 * p), 2e-7) << i;
    const double now[] = {move.weight[i], move.point[i]};
    EXPECT_EQ(b[i], law.at(position[i], now).b);
  }
}

TEST(MovedCurves, ALawOfTwoCoordinatesMovesToo) {
  CurveSpec spec;
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {1, 0, 1, 1, 0, 1};
  const CompileOptions options{.controls = {{ControlRange::Kind::weight, 1, 0, 0.1, 10}}};
  const auto law = CrossfadeLaw::create(NurbsCurve::create(spec).value(), options).value();
  const double arc[] = {std::sqrt(0.5)};
  for (int i = 0; i <= 100; ++i) {
    const auto gains = law.at(i / 100.0, arc);
    EXPECT_NEAR(gains.a * gains.a + gains.b * gains.b, 1, 3e-7);
  }
}

TEST(MovedCurves, AShapersMeanIsTheIntegralOfTheMovedCurve) {
  const auto program = ShaperProgram::create(rest_curve(), ranges).value();
  EXPECT_LT(program.max_error(), kMinus130Db);
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const double weight = 0.25 * std::exp2(5 * unit(random)), point = 3 * unit(random) - 1;
    const auto still = ShaperProgram::create(curve_with(weight, point)).value();
    const float x0 = static_cast<float>(2.4 * unit(random) - 1.2);
    const float x1 = i % 2 == 0 ? static_cast<float>(2.4 * unit(random) - 1.2) : x0 + 1e-3F;
    const double* controls[] = {&weight, &point};
    Shaper shaper;
    float first = 0, second = 0;
    const float drive = 1;
    shaper.render(program, {&drive, 1}, controls, 1, {&x0, 1}, {&first, 1});
    shaper.render(program, {&drive, 1}, controls, 1, {&x1, 1}, {&second, 1});
    const double expected = still.mean(static_cast<double>(x0), static_cast<double>(x1));
    worst = std::max(worst, std::abs(static_cast<double>(second) - expected));
  }
  EXPECT_LT(worst, 4e-7);  // both within -130 dB, and a float's rounding
  std::printf("worst error %.1f dB\n", 20 * std::log10(worst));
}

TEST(MovedCurves, AShaperAtRestIsTheShaperOfTheCurveAsItIsDrawn) {
  const auto moves = ShaperProgram::create(rest_curve(), ranges).value();
  const auto still = ShaperProgram::create(rest_curve()).value();
  EXPECT_EQ(moves.control_count(), 2);
  EXPECT_EQ(still.control_count(), 0);
  for (double x0 = -1.5; x0 < 1.5; x0 += 0.07) {
    EXPECT_NEAR(moves.at(x0), still.at(x0), kMinus130Db);
    for (double x1 = -1.5; x1 < 1.5; x1 += 0.11) {
      EXPECT_NEAR(moves.mean(x0, x1), still.mean(x0, x1), kMinus130Db);
      EXPECT_EQ(moves.mean(x0, x1), moves.mean(x1, x0));
    }
  }
}

TEST(MovedCurves, MovedPointsOfAPlainShaperAreExact) {
  CurveSpec spec;
  spec.degree = 7;
  spec.points = {-1, 0.5, -0.7, 0.2, 0.9, -0.4, 0.1, 1};
  spec.knots = {-1, -1, -1, -1, -1, -1, -1, -1, 1, 1, 1, 1, 1, 1, 1, 1};
  const NurbsCurve curve = NurbsCurve::create(spec).value();
  const auto moves =
      ShaperProgram::create(
          curve, std::vector<ControlRange>{{ControlRange::Kind::coordinate, 3, 0, -1, 1}})
          .value();
  const auto still = ShaperProgram::create(curve).value();
  for (double x0 = -1; x0 < 1; x0 += 0.07) {
    for (double x1 = -1; x1 < 1; x1 += 0.11) {
      EXPECT_NEAR(moves.mean(x0, x1), still.mean(x0, x1), 1e-13);
    }
  }
}

TEST(MovedCurves, AShaperWhoseWeightsMoveTooFarIsRefusedWithWhatToDo) {
  CurveSpec spec;
  spec.degree = 3;
  for (int i = 0; i < 60; ++i) spec.points.push_back(i % 2 == 0 ? -1 : 1);
  const auto program = ShaperProgram::create(
      NurbsCurve::create(spec).value(),
      std::vector<ControlRange>{{ControlRange::Kind::weight, 30, 0, 1e-6, 1e6}});
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::error_bound_missed);
  EXPECT_NE(program.error().message.find("weights that move less far"), std::string::npos);
}

TEST(MovedCurves, BlockSizeDoesNotMatter) {
  const CurveProgram curve = compile_function(rest_curve(), moving()).value();
  const auto shaper_program = ShaperProgram::create(rest_curve(), ranges).value();
  Movement move;
  move.weight[333] = std::numeric_limits<double>::quiet_NaN();
  const LfoSpec spec{.rate_hz = 333};
  knotwave::support::expect_block_size_does_not_matter<double>(kCount, [&] {
    Lfo fresh;
    fresh.start(spec, {0, 77}, 48000, {});
    return [&, lfo = fresh](std::size_t first, std::span<double> out) mutable {
      lfo.render(spec, curve, static_cast<std::int64_t>(first), {}, {}, move.from(first), out);
    };
  });
  knotwave::support::expect_block_size_does_not_matter<double>(kCount, [&] {
    Glide fresh;
    fresh.reset(3);
    fresh.start(&curve, 7, {0, 77}, 500, 1);
    return [&, glide = fresh](std::size_t first, std::span<double> out) mutable {
      glide.render(&curve, static_cast<std::int64_t>(first), move.from(first), out);
    };
  });
  std::vector<float> in(kCount), drive(kCount, 1.5F);
  for (std::size_t i = 0; i < kCount; ++i) in[i] = std::sin(0.3F * static_cast<float>(i));
  knotwave::support::expect_block_size_does_not_matter<float>(kCount, [&] {
    return [&, shaper = Shaper()](std::size_t first, std::span<float> out) mutable {
      shaper.render(shaper_program, std::span(drive).subspan(first, out.size()), move.from(first),
                    0.8F, std::span(in).subspan(first, out.size()), out);
      for (const float y : out) ASSERT_TRUE(std::isfinite(y));
    };
  });
}

TEST(MovedCurves, NothingAllocates) {
  const CurveProgram curve = compile_function(rest_curve(), moving()).value();
  const auto law = CrossfadeLaw::create(rest_curve(), moving()).value();
  const auto shaper_program = ShaperProgram::create(rest_curve(), ranges).value();
  const Movement move;
  const auto controls = move.from(0);
  std::vector<double> y(kCount), position(kCount, 0.3);
  std::vector<float> in(kCount, 0.5F), drive(kCount, 1), a(kCount), b(kCount);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              Glide glide;
              glide.start(&curve, 5, {0, 0}, 1000, 1);
              glide.render(&curve, 0, controls, y);
              law.render(position, controls, a, b);
              Shaper shaper;
              shaper.render(shaper_program, drive, controls, 1, in, b);
            }),
            0);
}

}  // namespace

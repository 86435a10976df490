// SPDX-License-Identifier: MIT
#include "knotwave/dsp/glide.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"

#include "support/allocation_count.h"
#include "support/block_sweep.h"

namespace {

using knotwave::base::SampleTime;
using knotwave::curves::CurveProgram;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::Glide;

// 0 to 1 along t^2, over a domain that is not 0..1.
CurveProgram square() {
  CurveSpec spec;
  spec.degree = 2;
  spec.points = {0, 0, 1};
  spec.knots = {2, 2, 2, 6, 6, 6};
  return compile_function(NurbsCurve::create(spec).value()).value();
}

double value_at(Glide glide, const CurveProgram* curve, std::int64_t sample) {
  double y = 0;
  glide.render(curve, sample, {&y, 1});
  return y;
}

TEST(Glide, FollowsItsCurveFromASubSampleStart) {
  const CurveProgram curve = square();
  Glide glide;
  glide.reset(60);
  EXPECT_TRUE(glide.is_still(0));
  glide.start(&curve, 72, {100, 1u << 31}, 0.01, 48000);
  for (int i = 0; i < 479; ++i) {
    const double t = (i + 0.5) / 480;
    EXPECT_NEAR(value_at(glide, &curve, 101 + i), 60 + 12 * t * t, 1e-12);
  }
  EXPECT_FALSE(glide.is_still(580));
  EXPECT_TRUE(glide.is_still(581));
  EXPECT_EQ(value_at(glide, &curve, 581), 72);
}

TEST(Glide, HasABuiltInSCurve) {
  Glide glide;
  glide.reset(0);
  glide.start(nullptr, 1, {0, 0}, 1, 100);
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 100.0;
    EXPECT_NEAR(value_at(glide, nullptr, i), t * t * (3 - 2 * t), 1e-15);
  }
}

TEST(Glide, ANewTargetLeavesFromWhereItIs) {
  Glide glide;
  glide.reset(0);
  glide.start(nullptr, 1, {0, 0}, 1, 100);
  const double before = value_at(glide, nullptr, 40);
  glide.start(nullptr, -1, {40, 0}, 1, 100);
  EXPECT_EQ(value_at(glide, nullptr, 40), before);
  EXPECT_EQ(glide.target(), -1);
  EXPECT_EQ(value_at(glide, nullptr, 140), -1);
}

TEST(Glide, NoTimeIsAJumpAndNanIsIgnored) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Glide glide;
  glide.reset(nan);
  EXPECT_EQ(value_at(glide, nullptr, 0), 0);
  for (const double seconds : {0.0, -1.0, nan}) {
    glide.start(nullptr, 5, {0, 0}, seconds, 48000);
    EXPECT_EQ(value_at(glide, nullptr, 0), 5);
    glide.reset(1);
  }
  glide.start(nullptr, nan, {0, 0}, 1, 48000);
  EXPECT_EQ(glide.target(), 1);
}

TEST(Glide, BlockSizeDoesNotMatter) {
  const CurveProgram curve = square();
  for (const CurveProgram* program : {static_cast<const CurveProgram*>(nullptr), &curve}) {
    knotwave::support::expect_block_size_does_not_matter<double>(700, [&] {
      Glide glide;
      glide.reset(3);
      glide.start(program, 4, {0, 77}, 0.01, 48000);
      return [=](std::size_t first, std::span<double> out) mutable {
        glide.render(program, static_cast<std::int64_t>(first), out);
      };
    });
  }
}

TEST(Glide, AgreesAtEqualSecondsForAnyRate) {
  const CurveProgram curve = square();
  const auto played = [&](double rate_hz) {
    Glide glide;
    glide.reset(48);
    const double start = 0.0123 * rate_hz;
    const SampleTime time{static_cast<std::int64_t>(start),
                          static_cast<std::uint32_t>((start - std::floor(start)) * 0x1p32)};
    glide.start(&curve, 60, time, 0.5, rate_hz);
    std::vector<double> y;
    for (int i = 2; i < 60; ++i) {
      y.push_back(value_at(glide, &curve, static_cast<std::int64_t>(i * 0.01 * rate_hz + 0.5)));
    }
    return y;
  };
  const auto reference = played(48000);
  for (const double rate_hz : {44100.0, 96000.0, 384000.0}) {
    const auto y = played(rate_hz);
    for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(y[i], reference[i], 1e-6);
  }
}

TEST(Glide, DoesNotAllocate) {
  std::vector<double> out(1000);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              Glide glide;
              glide.start(nullptr, 5, {0, 0}, 0.01, 48000);
              glide.render(nullptr, 0, out);
            }),
            0);
}

}  // namespace

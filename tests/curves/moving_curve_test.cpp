// SPDX-License-Identifier: MIT
#include "knotwave/curves/moving_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"
#include "knotwave/curves/monotone.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/allocation_count.h"
#include "support/seed.h"
#include "support/simd_guard.h"
#include "time_oracle.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::MovingCurve;
using curves::NurbsCurve;
using curves::SimdLevel;

constexpr double kBound = 0x1p-24;

NurbsCurve timed(int degree, std::vector<double> points, std::vector<double> knots = {},
                 std::vector<double> weights = {}, std::vector<double> jumps = {}) {
  CurveSpec spec = spec_of(degree, std::move(points), std::move(knots), std::move(weights));
  spec.dim = 2;
  spec.jumps = std::move(jumps);
  return made(std::move(spec));
}

MovingCurve moving(const NurbsCurve& curve) {
  auto result = MovingCurve::create(curve);
  EXPECT_TRUE(result) << (result ? "" : result.error().message);
  return std::move(*result);
}

const MovingCurve& moving_cubic() {
  static const MovingCurve cubic = moving(timed(3, {0, 0, 0, 0, 1, 1, 1, 1}));
  return cubic;
}

/// Handles of a cubic that never goes back, up to the ellipse now and then.
std::vector<double> random_cubic(Dice& dice) {
  const double reach = dice.one_in(4) ? 4 / 3.0 : 1.0;
  curves::HandleLengths lengths{reach * dice.unit(), reach * dice.unit()};
  lengths = regularize_handles(lengths, curves::Regularization::keep_ratio);
  return {
      0, dice.between(-1, 1), lengths.a, dice.between(-1, 1), 1 - lengths.b, dice.between(-1, 1),
      1, dice.between(-1, 1)};
}

double range_of(std::span<const double> points) {
  double low = points[1], high = points[1];
  for (std::size_t i = 1; i < points.size(); i += 2) {
    low = std::min(low, points[i]);
    high = std::max(high, points[i]);
  }
  return high - low;
}

/// How far y is from all values the segment has within 2^-50 X of the time, in 2^-24 R.
double error_of(std::span<const double> points, double x, double y) {
  double largest = std::abs(x);
  for (std::size_t i = 0; i < points.size(); i += 2) {
    largest = std::max(largest, std::abs(points[i]));
  }
  const Wide beside = Wide(0x1p-50) * largest;
  const Wide from = segment_parameter(points, x - beside);
  const Wide to = segment_parameter(points, x + beside);
  double nearest = std::numeric_limits<double>::infinity(), low = nearest, high = -nearest;
  for (int i = 0; i <= 8; ++i) {
    const double value = static_cast<double>(segment_at(points, 1, from + (to - from) * i / 8));
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return std::max({0.0, low - y, y - high}) / (kBound * range_of(points));
}

double worst_of_cubics(int count) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < count; ++round) {
    const std::vector<double> points = random_cubic(dice);
    for (int k = 0; k < 2; ++k) {
      const double x = k == 0 ? dice.unit() : std::ldexp(dice.unit(), -dice.below(60));
      worst = std::max(worst, error_of(points, x, moving_cubic().at(x, points)));
    }
  }
  std::printf("worst %.3f of 2^-24 R\n", worst);
  return worst;
}

TEST(MovingCurve, RandomCubicsAreWithinTheStatedError) {
  EXPECT_LE(worst_of_cubics(support::test_count(10'000)), 1);
}

TEST(MovingCurveStress, RandomCubicsAreWithinTheStatedError) {
  EXPECT_LE(worst_of_cubics(support::test_count(100'000)), 1);
}

// Here at the very time, not only beside it: where x is flat at an end or half way, halving is
// exact.
TEST(MovingCurve, VerticalHandlesAreWithin2ToTheMinus24) {
  const double handles[][4] = {{0, 1, 0, 1},       {1, 0, 0, 1},
                               {0, 0, 1 / 3.0, 1}, {1 / 3.0, 1 / 3.0, 2 / 3.0, 2 / 3.0},
                               {1, 0, 1, 0},       {0, 0.5, 0, 1}};
  Dice dice(support::test_seed());
  double worst = 0;
  for (const auto& [x1, y1, x2, y2] : handles) {
    const std::vector<double> points = {0, 0, x1, y1, x2, y2, 1, 1};
    for (int k = 0; k < 300; ++k) {
      const double near = std::ldexp(dice.unit(), -dice.below(100));
      const double x = k % 3 == 0 ? near : k % 3 == 1 ? 1 - near : std::min(1.0, 0.5 + near);
      const double y = moving_cubic().at(x, points);
      worst = std::max(worst, std::abs(y - segment_value(points, x)) / kBound);
      ASSERT_LE(worst, 1) << x1 << " " << x2 << " at " << x;
    }
    EXPECT_EQ(moving_cubic().at(0, points), 0);
    EXPECT_EQ(moving_cubic().at(1, points), 1);
  }
  std::printf("worst %.3f of 2^-24\n", worst);
}

// Values of research by 40-digit arithmetic.
TEST(MovingCurve, MeetsTheKnownValuesOfEasings) {
  const auto easing = [](double x1, double y1, double x2, double y2, double x) {
    return moving_cubic().at(x, std::vector<double>{0, 0, x1, y1, x2, y2, 1, 1});
  };
  EXPECT_NEAR(easing(.25, .1, .25, 1, .5), .80240338758485699, 1e-13);
  EXPECT_NEAR(easing(.42, 0, 1, 1, .5), .3153568125725393, 1e-13);
  EXPECT_NEAR(easing(0, 1, 0, 1, .001), .271, 1e-13);
  EXPECT_NEAR(easing(1, 0, 0, 1, .25), .029724605511925197, 1e-13);
  EXPECT_NEAR(easing(0, 0, 1. / 3, 1, .25), .5, 1e-13);
}

/// A curve whose x rises by at least 0.05 from point to point.
NurbsCurve rising_curve(Dice& dice, int degree, bool rational) {
  const int inner = dice.below(4), n = degree + 1 + inner;
  std::vector<double> points, knots, weights;
  double x = dice.between(-2, 1);
  for (int i = 0; i < n; ++i) {
    points.insert(points.end(), {x, dice.between(-1, 1)});
    x += dice.between(0.05, 1);
    if (rational) weights.push_back(dice.between(0.3, 3));
  }
  knots.assign(std::size_t(degree) + 1, 0);
  for (int i = 0; i < inner; ++i) knots.push_back(dice.between(0.1, 0.9));
  std::sort(knots.begin(), knots.end());
  if (inner > 1 && degree > 2 && dice.one_in(2))
    knots[std::size_t(degree) + 2] = knots[std::size_t(degree) + 1];
  knots.insert(knots.end(), std::size_t(degree) + 1, 1);
  return timed(degree, points, knots, weights);
}

TEST(MovingCurve, AtRestItIsTheCompiledCurveWhateverDegreeKnotsAndWeights) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(300); ++round) {
    const NurbsCurve curve = rising_curve(dice, 1 + dice.below(7), dice.one_in(2));
    const MovingCurve live = moving(curve);
    curves::CompileOptions options;
    options.max_error = 1e-10;
    const auto program = compile_function(curve, options);
    ASSERT_TRUE(program) << program.error().message;
    const std::vector<double> points(curve.points().begin(), curve.points().end());
    const double low = program->u_min(), high = program->u_max();
    for (int k = 0; k < 30; ++k) {
      const double x = dice.between(low - 0.1, high + 0.1);
      const double off = std::abs(live.at(x, points) - program->at_u(x));
      worst = std::max(worst, off / (kBound * range_of(points)));
      ASSERT_LE(off, kBound * range_of(points) + 1e-10) << round << " at " << x;
    }
    EXPECT_NEAR(live.at(low, points), points[1], 1e-15);
    EXPECT_NEAR(live.at(high, points), points.back(), 1e-15);
  }
  std::printf("worst %.3f of 2^-24 R\n", worst);
}

TEST(MovingCurve, HalvesAsOftenAsDegreeAndWeightsAskFor) {
  EXPECT_EQ(moving_cubic().halvings(), 26);
  EXPECT_EQ(moving(timed(1, {0, 0, 1, 1})).halvings(), 26);
  EXPECT_EQ(moving(timed(4, std::vector<double>(10, 0.0))).halvings(), 27);
  EXPECT_EQ(moving(timed(6, std::vector<double>(14, 0.0))).halvings(), 27);
  EXPECT_EQ(moving(timed(7, std::vector<double>(16, 0.0))).halvings(), 28);
  EXPECT_EQ(moving(timed(3, {0, 0, 0, 0, 1, 1, 1, 1}, {}, {1, 16, 1, 1})).halvings(), 30);
}

/// Points and times as rows of samples, all of them moving.
struct Motion {
  std::vector<double> times;
  std::vector<std::vector<double>> rows;
  std::vector<const double*> pointers;

  Motion(Dice& dice, const NurbsCurve& curve, std::size_t count) : times(count) {
    for (double& time : times) time = dice.between(-0.2, 3);
    for (const double rest : curve.points()) {
      auto& row = rows.emplace_back(count);
      for (double& x : row) x = rest + dice.between(-0.02, 0.02);
    }
    times[count / 3] = std::nan("");
    rows[1][count / 2] = std::nan("");
    for (const auto& row : rows) pointers.push_back(row.data());
  }
};

TEST(MovingCurve, AnySplitOfABlockGivesTheSameBitsAndSoDoesEachSampleAlone) {
  Dice dice(support::test_seed());
  for (const int degree : {1, 2, 3, 4, 5, 6, 7}) {
    const NurbsCurve curve = rising_curve(dice, degree, degree % 2 == 0);
    const MovingCurve live = moving(curve);
    constexpr std::size_t kCount = 67;
    const Motion motion(dice, curve, kCount);
    std::vector<double> whole(kCount), parts(kCount);
    live.render(motion.times, motion.pointers, whole);
    for (std::size_t i = 0; i < kCount; ++i) {
      std::vector<double> points;
      for (const auto& row : motion.rows) points.push_back(row[i]);
      ASSERT_EQ(live.at(motion.times[i], points), whole[i]) << i;
      ASSERT_TRUE(std::isfinite(whole[i]));
    }
    for (std::size_t size = 1; size <= kCount; ++size) {
      for (std::size_t first = 0; first < kCount; first += size) {
        const std::size_t count = std::min(size, kCount - first);
        std::vector<const double*> rows = motion.pointers;
        for (const double*& row : rows) row += first;
        live.render(std::span(motion.times).subspan(first, count), rows,
                    std::span(parts).subspan(first, count));
      }
      ASSERT_EQ(parts, whole) << "blocks of " << size;
    }
  }
}

TEST(MovingCurve, EveryVectorUnitGivesTheSameBits) {
  Dice dice(support::test_seed());
  for (const int degree : {1, 2, 3, 4, 5, 6, 7}) {
    const NurbsCurve curve = rising_curve(dice, degree, degree % 2 == 1);
    const MovingCurve live = moving(curve);
    constexpr std::size_t kCount = 61;
    const Motion motion(dice, curve, kCount);
    std::vector<double> best(kCount), out(kCount);
    live.render(motion.times, motion.pointers, best);
    for (const SimdLevel level : curves::simd_levels()) {
      const support::SimdGuard guard(level);
      live.render(motion.times, motion.pointers, out);
      EXPECT_EQ(out, best) << degree << ' ' << curves::simd_level_name();
    }
  }
}

TEST(MovingCurve, NeverAllocates) {
  Dice dice(support::test_seed());
  const NurbsCurve curve = rising_curve(dice, 3, true);
  const MovingCurve live = moving(curve);
  const Motion motion(dice, curve, 64);
  std::vector<double> out(64), points(curve.points().begin(), curve.points().end());
  EXPECT_EQ(support::allocations_in([&] { live.render(motion.times, motion.pointers, out); }), 0);
  EXPECT_EQ(support::allocations_in([&] { live.at(0.3, points); }), 0);
}

TEST(MovingCurve, WhereTimeStandsStillTheValueAfterCounts) {
  const MovingCurve line = moving(timed(1, {0, 0, 1, 0.5, 1, -0.25, 2, 1}));
  const std::vector<double> points = {0, 0, 1, 0.5, 1, -0.25, 2, 1};
  EXPECT_EQ(line.at(1, points), -0.25);
  EXPECT_NEAR(line.at(std::nextafter(1, 0), points), 0.5, kBound);
  EXPECT_EQ(line.at(-5, points), 0);
  EXPECT_EQ(line.at(7, points), 1);
  const MovingCurve jump =
      moving(timed(1, {0, 0, 1, 0.5, 1, -0.25, 2, 1}, {0, 0, 0.5, 0.5, 1, 1}, {}, {0.5}));
  EXPECT_EQ(jump.at(1, points), -0.25);
  EXPECT_NEAR(jump.at(std::nextafter(1, 0), points), 0.5, kBound);
}

TEST(MovingCurve, StaysInTheHullWhateverComes) {
  Dice dice(support::test_seed());
  const double nasty[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, -0.0, 1e-320};
  for (int round = 0; round < 2000; ++round) {
    std::vector<double> points;
    for (int i = 0; i < 8; ++i) {
      points.push_back(dice.one_in(6) ? nasty[dice.below(6)] : dice.between(-1, 1));
    }
    const double time = dice.one_in(4) ? nasty[dice.below(6)] : dice.between(-1, 1);
    const double y = moving_cubic().at(time, points);
    double low = 1e6, high = -1e6;
    for (std::size_t i = 1; i < 8; i += 2) {
      const bool counts = std::abs(points[i]) >= 0x1p-800;  // not for NaN
      const double at = counts ? std::clamp(points[i], -1e6, 1e6) : 0;
      low = std::min(low, at);
      high = std::max(high, at);
    }
    ASSERT_TRUE(y >= low && y <= high) << y;
  }
  const std::vector<double> points = {0, 0.25, 0.2, 0, 0.8, 1, 1, 0.75};
  EXPECT_EQ(moving_cubic().at(std::nan(""), points), 0.25);
  EXPECT_EQ(moving_cubic().at(-HUGE_VAL, points), 0.25);
  EXPECT_EQ(moving_cubic().at(HUGE_VAL, points), 0.75);
}

TEST(MovingCurve, SaysWhatItCannotBe) {
  const auto code = [](const NurbsCurve& curve) { return MovingCurve::create(curve).error().code; };
  EXPECT_EQ(code(scalar(1, {0, 1})), ErrorCode::dimension_mismatch);
  EXPECT_EQ(code(timed(8, std::vector<double>(18, 0.0))), ErrorCode::degree_out_of_range);
  EXPECT_EQ(code(timed(1, {0, 0, 1, 1}, {}, {1e-6, 1e6})), ErrorCode::weight_out_of_range);
  CurveSpec spec = spec_of(2, {0, 0, 1, 0, 1, 1});
  spec.dim = 2;
  spec.periodic = true;
  EXPECT_EQ(code(made(spec)), ErrorCode::unsupported);
}

}  // namespace
}  // namespace knotwave::test

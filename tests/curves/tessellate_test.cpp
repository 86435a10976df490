// SPDX-License-Identifier: MIT
#include "knotwave/curves/tessellate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using base::index_of;
using curves::CurveSpec;
using curves::FixedStep;
using curves::MaxError;
using curves::MaxStep;
using curves::NurbsCurve;
using curves::Sampling;
using curves::Side;
using curves::Stretch;
using curves::TessellatorCalls;
using testing::ElementsAre;
using testing::HasSubstr;

NurbsCurve made(int degree, std::vector<double> points, std::vector<double> knots = {},
                std::vector<double> jumps = {}, int dim = 1) {
  CurveSpec spec;
  spec.name = "example";
  spec.degree = degree;
  spec.dim = dim;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.jumps = std::move(jumps);
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

std::vector<Stretch> sampled(const NurbsCurve& curve, const Sampling& sampling) {
  auto stretches = sample_parameters(curve, sampling, curve.u_min(), curve.u_max());
  EXPECT_TRUE(stretches) << (stretches ? "" : stretches.error().message);
  return stretches ? std::move(*stretches) : std::vector<Stretch>{};
}

using Value = std::array<double, curves::kMaxDim>;
Value value_at(const NurbsCurve& curve, double u, Side side) {
  Value value{};
  curve.evaluate(u, side, value);
  return value;
}

/// Steps of no coordinate by more than `size`, or none if that is refused for the one good reason:
/// from the double that is named to the next one the curve moves by more.
std::vector<Stretch> sampled_if_it_can_be(const NurbsCurve& curve, double size) {
  auto stretches = sample_parameters(curve, MaxStep{size}, curve.u_min(), curve.u_max());
  if (stretches) return std::move(*stretches);
  const std::string& message = stretches.error().message;
  EXPECT_EQ(stretches.error().code, ErrorCode::error_bound_missed) << message;
  constexpr std::string_view kBefore = "no step from u = ";
  double u = 0;
  const auto at = message.find(kBefore);
  EXPECT_NE(at, std::string::npos) << message;
  std::from_chars(message.data() + at + kBefore.size(), message.data() + message.size(), u);
  const Value from = value_at(curve, u, Side::right);
  const Value to = value_at(curve, std::nextafter(u, 1e300), Side::left);
  double farthest = 0;
  for (std::size_t c = 0; c < index_of(curve.dim()); ++c) {
    farthest = std::max(farthest, std::abs(to[c] - from[c]));
  }
  EXPECT_GT(farthest, size) << message;
  return {};
}

/// Work for each step and for places inside it: first, last, and the curve's value at t of it.
template <class Work>
void for_each_step(const NurbsCurve& curve, const std::vector<Stretch>& stretches, Work work) {
  for (const Stretch& stretch : stretches) {
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      const double a = stretch[i - 1], b = stretch[i];
      const Value first = value_at(curve, a, Side::right), last = value_at(curve, b, Side::left);
      for (int k = 1; k < 16; ++k) {
        const double u = a + (b - a) * k / 16;
        if (u > a && u < b) work(first, last, (u - a) / (b - a), value_at(curve, u, Side::right));
      }
    }
  }
}

double worst_error(const NurbsCurve& curve, const std::vector<Stretch>& stretches) {
  double worst = 0;
  for_each_step(curve, stretches, [&](const Value& a, const Value& b, double t, const Value& at) {
    double square = 0;
    for (std::size_t c = 0; c < index_of(curve.dim()); ++c) {
      const double apart = at[c] - (a[c] + (b[c] - a[c]) * t);
      square += apart * apart;
    }
    worst = std::max(worst, std::sqrt(square));
  });
  return worst;
}

double longest_move(const NurbsCurve& curve, const std::vector<Stretch>& stretches) {
  double longest = 0;
  for_each_step(curve, stretches, [&](const Value& a, const Value& b, double, const Value& at) {
    for (std::size_t c = 0; c < index_of(curve.dim()); ++c) {
      longest = std::max(
          {longest, std::abs(at[c] - a[c]), std::abs(at[c] - b[c]), std::abs(b[c] - a[c])});
    }
  });
  return longest;
}

std::size_t step_count(const std::vector<Stretch>& stretches) {
  std::size_t count = 0;
  for (const Stretch& stretch : stretches) count += stretch.size() - 1;
  return count;
}

TEST(Tessellate, FixedStepsAreEvenAndEndExactly) {
  const NurbsCurve curve = made(2, {0, 1, 0}, {0.1, 0.1, 0.1, 0.7, 0.7, 0.7});
  EXPECT_THAT(sampled(curve, FixedStep{5}),
              ElementsAre(ElementsAre(0.1, testing::DoubleEq(0.3), testing::DoubleEq(0.5), 0.7)));
  EXPECT_EQ(step_count(sampled(curve, FixedStep{})), 60u) << "100 a unit, as in GLU";
  EXPECT_EQ(step_count(sampled(curve, FixedStep{1e-3})), 1u);
}

TEST(Tessellate, ALineIsOneStep) {
  const NurbsCurve line = made(3, {0, 1.0 / 3, 2.0 / 3, 1});
  EXPECT_THAT(sampled(line, MaxError{-200}), ElementsAre(ElementsAre(0, 1)));
  const NurbsCurve more = made(3, {0, 1, 3, 5, 6}, {0, 0, 0, 0, 3, 6, 6, 6, 6});
  EXPECT_THAT(sampled(more, MaxError{-200}), ElementsAre(ElementsAre(0, 6)))
      << "a step may pass a knot where the curve is smooth";
}

// The chord of a parabola of second derivative 2 over a step h is h^2 / 4 away, so n steps of
// 1 / n are needed for a distance of 1 / (4 n^2), and no fewer.
TEST(Tessellate, AParabolaTakesAsFewStepsAsItCan) {
  const NurbsCurve parabola = made(2, {0, 0, 1});
  for (const int n : {4, 10, 100}) {
    const double error = 0.25 / (n * n);
    const auto stretches = sampled(parabola, MaxError{20 * std::log10(error)});
    EXPECT_LE(worst_error(parabola, stretches), error * (1 + 1e-9));
    EXPECT_GE(step_count(stretches), index_of(n));
    EXPECT_LE(double(step_count(stretches)), std::ceil(1.09 * n)) << n;
  }
}

TEST(Tessellate, NoPlaceIsFartherThanTheErrorAskedFor) {
  Dice dice(support::test_seed());
  const int rounds = support::test_count(300);
  for (int round = 0; round < rounds; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double full_scale = largest_coordinate(curve);
    if (!(full_scale > 0)) continue;
    const double error_db = dice.between(-60, -20);
    const auto stretches = sampled(curve, MaxError{error_db, full_scale});
    EXPECT_LE(worst_error(curve, stretches), full_scale * std::pow(10, error_db / 20) * (1 + 1e-9));
  }
}

TEST(Tessellate, NoStepMovesFartherThanAskedFor) {
  Dice dice(support::test_seed());
  const int rounds = support::test_count(300);
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double size = largest_coordinate(curve) * dice.between(0.01, 0.3);
    if (!(size > 0)) continue;
    const auto stretches = sampled_if_it_can_be(curve, size);
    refused += stretches.empty() ? 1 : 0;
    EXPECT_LE(longest_move(curve, stretches), size);
  }
  EXPECT_LE(refused, rounds / 20);
}

// Over most of a span the cost of a step says nothing of its length: all that is to be stepped over
// lies in 1e-12 of it.
TEST(Tessellate, StepsAreFoundWhereWeightsPutEverythingIntoAPointOfTheSpan) {
  CurveSpec spec;
  spec.name = "switch";
  spec.degree = 1;
  spec.points = {0, 1};
  spec.weights = {1e-6, 1e6};
  const NurbsCurve curve = *NurbsCurve::create(spec);
  for (const Sampling& sampling : {Sampling(MaxError{-40}), Sampling(MaxStep{0.05})}) {
    const auto stretches = sampled(curve, sampling);
    EXPECT_LE(worst_error(curve, stretches), 0.05);
    EXPECT_LT(stretches.front()[1], 1e-12);
    EXPECT_LT(step_count(stretches), 40u);
  }
  EXPECT_LE(longest_move(curve, sampled(curve, MaxStep{0.05})), 0.05);
}

TEST(Tessellate, MoreThanAStepBetweenNeighbouringDoublesIsRefusedWithThePlace) {
  CurveSpec spec;
  spec.name = "far from 0";
  spec.degree = 1;
  spec.points = {0, 1};
  spec.weights = {1e-6, 1e6};
  spec.knots = {1024, 1024, 1025, 1025};
  const NurbsCurve curve = *NurbsCurve::create(spec);
  const auto refused = sample_parameters(curve, MaxStep{0.125}, 1024, 1025);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::error_bound_missed);
  // 2^-42 of the span, and the weights are 1e12 apart: t 1e12 / (1 - t + t 1e12).
  EXPECT_THAT(refused.error().message,
              testing::MatchesRegex("curve 'far from 0': no step from u = 1024 is short enough: up "
                                    "to u = 1024.0000000000002, the next one there is, it moves by "
                                    "0.1852[0-9]*, but no more than 0.125 was asked for"));
  EXPECT_LE(longest_move(curve, sampled(curve, MaxStep{0.19})), 0.19);
  sampled(curve, MaxError{-120});  // from one double to the next no u is missed
}

TEST(Tessellate, AControllerRampTakesAStepAValue) {
  const auto stretches = sampled(made(3, {0, 0, 1, 1}), MaxStep{1.0 / 127});
  EXPECT_GE(step_count(stretches), 127u);
  EXPECT_LE(step_count(stretches), 140u);
}

TEST(Tessellate, BreakPointsAreACurveOfOrderTwo) {
  const NurbsCurve lines = made(1, {0, 1, 0.25, 0.25}, {0, 0, 1, 3, 4, 4});
  EXPECT_THAT(sampled(lines, MaxError{-120}), ElementsAre(ElementsAre(0, 1, 3, 4)));
  EXPECT_THAT(sampled(lines, FixedStep{0.5}), ElementsAre(ElementsAre(0, 1, 2, 3, 4)));
}

TEST(Tessellate, CornersAlwaysHaveAValueAndJumpsPartStretches) {
  const NurbsCurve curve =
      made(2, {0, 0.5, 1, 0.5, 0, 1, 1, 1}, {0, 0, 0, 0.4, 0.4, 0.7, 0.7, 0.7, 1, 1, 1}, {0.7});
  for (const Sampling& sampling :
       {Sampling(FixedStep{3}), Sampling(MaxError{-20}), Sampling(MaxStep{0.9})}) {
    const auto stretches = sampled(curve, sampling);
    ASSERT_EQ(stretches.size(), 2u);
    EXPECT_EQ(stretches[0].front(), 0);
    EXPECT_EQ(stretches[0].back(), 0.7);
    EXPECT_EQ(stretches[1].front(), 0.7);
    EXPECT_EQ(stretches[1].back(), 1);
    EXPECT_TRUE(std::count(stretches[0].begin(), stretches[0].end(), 0.4));
    for (const Stretch& stretch : stretches) {
      EXPECT_EQ(std::adjacent_find(stretch.begin(), stretch.end(), std::greater_equal<>()),
                stretch.end());
    }
  }
}

TEST(Tessellate, CallsComeInOrder) {
  const NurbsCurve curve = made(1, {0, 2, 7, 9}, {0, 0, 1, 1, 2, 2}, {1});
  std::string told;
  const auto number = [](double x) { return std::to_string(int(x)); };
  TessellatorCalls calls;
  calls.begin = [&](double u) { told += "begin " + number(u) + " "; };
  calls.value = [&](double u, std::span<const double> value) {
    told += number(u) + "=" + number(value[0]) + " ";
    EXPECT_EQ(value.size(), 1u);
  };
  calls.slope = [&](double, std::span<const double> slope) {
    told += "/" + number(slope[0]) + " ";
  };
  calls.end = [&](double u) { told += "end " + number(u) + " "; };
  ASSERT_TRUE(tessellate(curve, MaxError{}, calls));
  EXPECT_EQ(told, "begin 0 0=0 /2 1=2 /2 end 1 begin 1 1=7 /2 2=9 /2 end 2 ");
  EXPECT_TRUE(tessellate(curve, MaxError{}, {})) << "nobody has to listen";
}

TEST(Tessellate, WeightsAreDividedOut) {
  CurveSpec spec;
  spec.name = "quarter circle";
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {1, 0, 1, 1, 0, 1};
  spec.weights = {1, 1, 2};
  TessellatorCalls calls;
  int values = 0;
  calls.value = [&](double, std::span<const double> at) {
    EXPECT_NEAR(at[0] * at[0] + at[1] * at[1], 1, 1e-15);
    ++values;
  };
  ASSERT_TRUE(tessellate(*NurbsCurve::create(spec), MaxError{-60}, calls));
  EXPECT_GT(values, 10);
}

TEST(Tessellate, ThePolicyIsInTheUnitsOfTheCurve) {
  const NurbsCurve plain = made(3, {0, 1, -1, 0.5, 0});
  const NurbsCurve wide = made(3, {0, 100, -100, 50, 0}, {0, 0, 0, 0, 8, 16, 16, 16, 16});
  const auto a = sampled(plain, MaxError{-60, 1}), b = sampled(wide, MaxError{-60, 100});
  EXPECT_EQ(step_count(a), step_count(b)) << "full scale and time stretch alike";
  EXPECT_EQ(step_count(sampled(plain, FixedStep{48})), 48u);
  EXPECT_EQ(step_count(sampled(wide, FixedStep{3})), 48u);
}

TEST(Tessellate, PartsOfACurveAreSampledAlike) {
  const NurbsCurve parabola = made(2, {0, 0, 1});
  const auto part = sample_parameters(parabola, FixedStep{8}, 0.25, 0.75);
  ASSERT_TRUE(part);
  EXPECT_THAT(*part, ElementsAre(ElementsAre(0.25, 0.375, 0.5, 0.625, 0.75)));
}

TEST(Tessellate, APeriodicCurveIsOnePeriod) {
  CurveSpec spec;
  spec.name = "wave";
  spec.degree = 3;
  spec.points = {0, 1, 0, -1};
  spec.periodic = true;
  const NurbsCurve wave = *NurbsCurve::create(spec);
  std::vector<double> values;
  TessellatorCalls calls;
  calls.value = [&](double, std::span<const double> value) { values.push_back(value[0]); };
  for (const Sampling& sampling :
       {Sampling(MaxError{-40}), Sampling(MaxStep{0.1}), Sampling(FixedStep{20})}) {
    values.clear();
    ASSERT_TRUE(tessellate(wave, sampling, calls));
    EXPECT_EQ(values.front(), values.back());
    EXPECT_GT(values.size(), 8u);
  }
}

TEST(Tessellate, PolicyNumbersAreChecked) {
  EXPECT_EQ(FixedStep{}.steps_per_u, 100);
  EXPECT_EQ(MaxError{}.error_db, -96);
  EXPECT_EQ(MaxStep{}.size, 1.0 / 127);
  const NurbsCurve curve = made(2, {0, 1, 0});
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  int calls_made = 0;
  TessellatorCalls calls;
  calls.begin = [&](double) { ++calls_made; };
  for (const Sampling& sampling :
       {Sampling(FixedStep{0}), Sampling(FixedStep{-1}), Sampling(FixedStep{kNan}),
        Sampling(MaxError{kNan}), Sampling(MaxError{-400}), Sampling(MaxError{-60, 0}),
        Sampling(MaxStep{0}), Sampling(MaxStep{kNan})}) {
    const auto refused = tessellate(curve, sampling, calls);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::value_out_of_range);
  }
  const auto outside = sample_parameters(curve, FixedStep{}, -0.5, 1);
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().message, "curve 'example': u = -0.5 is outside 0..1");
  const auto backwards = sample_parameters(curve, FixedStep{}, 0.5, 0.5);
  ASSERT_FALSE(backwards);
  EXPECT_EQ(backwards.error().code, ErrorCode::empty_domain);
  EXPECT_EQ(calls_made, 0);
}

TEST(Tessellate, TooManyValuesAreRefusedBeforeAnyCall) {
  const NurbsCurve curve = made(2, {0, 1, 0});
  int calls_made = 0;
  TessellatorCalls calls;
  calls.value = [&](double, std::span<const double>) { ++calls_made; };
  const auto fixed = tessellate(curve, FixedStep{1e12}, calls);
  ASSERT_FALSE(fixed);
  EXPECT_EQ(fixed.error().code, ErrorCode::too_many_points);
  const auto error = tessellate(curve, MaxError{-120}, calls, 50);
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::too_many_points);
  EXPECT_THAT(error.error().message, HasSubstr("50 values are allowed"));
  EXPECT_TRUE(tessellate(curve, FixedStep{49}, calls, 50));
  EXPECT_FALSE(tessellate(curve, FixedStep{50}, calls, 50));
  EXPECT_EQ(calls_made, 50);
}

TEST(Tessellate, LessThanRoundingIsNoStep) {
  CurveSpec spec;
  spec.name = "large";
  spec.degree = 2;
  spec.points = {9e5, 9e5 + 1.0 / 3, 9e5};
  const auto refused = tessellate(*NurbsCurve::create(spec), MaxError{-300}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::error_bound_missed);
  EXPECT_THAT(refused.error().message,
              HasSubstr("values are rounded by more than the error asked for, -300 dB re 1"));
}

}  // namespace
}  // namespace knotwave::test

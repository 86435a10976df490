// SPDX-License-Identifier: MIT
#include "knotwave/curves/reparametrize.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;
using testing::ElementsAreArray;

// One Bézier segment of any degree, weights and domain: its knots are ends, which never round.
NurbsCurve random_segment(Dice& dice) {
  CurveSpec spec = random_spec(dice);
  const auto count = std::size_t(spec.degree) + 1;
  spec.periodic = false;
  spec.knots.clear();
  spec.points.resize(count * std::size_t(spec.dim));
  if (!spec.weights.empty()) spec.weights.resize(count);
  return made(spec);
}

double largest_knot(const NurbsCurve& curve) {
  double largest = 0;
  for (const double knot : curve.knots()) largest = std::max(largest, std::abs(knot));
  return largest;
}

// Random curves have knots 2^-60 beside others; elsewhere a double cannot tell them apart.
bool knots_fell_together(const Error& error) { return error.code == ErrorCode::knot_multiplicity; }

TEST(Reverse, SwapsPointsWeightsAndMirrorsKnots) {
  const auto back = reverse(made(spec_of(2, {0, 3, 1, 5}, {0, 0, 0, 0.25, 1, 1, 1}, {1, 2, 3, 4})));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->points(), ElementsAre(5, 1, 3, 0));
  EXPECT_THAT(back->weights(), ElementsAre(4, 3, 2, 1));
  EXPECT_THAT(back->knots(), ElementsAre(0, 0, 0, 0.75, 1, 1, 1));
}

TEST(Reverse, LeftAndRightOfAJumpChangePlaces) {
  const NurbsCurve curve = made(saw());
  const auto back = reverse(curve);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->jumps(), ElementsAre(0.75));
  EXPECT_EQ(at(*back, 0.75, Side::left), at(curve, 0.25, Side::right));
  EXPECT_EQ(at(*back, 0.75, Side::right), at(curve, 0.25, Side::left));
}

TEST(Reverse, TwiceGivesPointsToTheBitAndKnotsWithinAnUlp) {
  Dice dice(support::test_seed());
  int reversed = 0;
  for (int round = 0; round < support::test_count(10'000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const auto back = reverse(curve);
    if (!back && knots_fell_together(back.error())) continue;
    ASSERT_TRUE(back) << back.error().message;
    ++reversed;
    const auto again = reverse(*back);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_THAT(again->points(), ElementsAreArray(curve.points()));
    EXPECT_THAT(again->weights(), ElementsAreArray(curve.weights()));
    EXPECT_EQ(again->u_min(), curve.u_min());
    EXPECT_EQ(again->u_max(), curve.u_max());
    EXPECT_EQ(again->is_periodic(), curve.is_periodic());
    const double ulp = ulp_of(std::max(largest_knot(curve), largest_knot(*back)));
    const std::vector<double> before = curve.spec().knots, after = again->spec().knots;
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(after[i], before[i], ulp);
  }
  EXPECT_GT(reversed, support::test_count(9500));
}

// Where 1 - knot is exact the curve is the same one to the last bit that evaluation has.
TEST(Reverse, RunsTheCurveBackwards) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(2000); ++round) {
    CurveSpec spec = random_spec(dice);
    const auto count = spec.points.size() / std::size_t(spec.dim);
    spec.knots.clear();
    if (spec.periodic) {
      for (std::size_t i = 0; i <= count; ++i) spec.knots.push_back(double(i));
    } else {
      for (std::size_t i = 0; i < count + std::size_t(spec.degree) + 1; ++i) {
        spec.knots.push_back(double(i) - (spec.degree > 1 && i > count / 2));
      }
    }
    const NurbsCurve curve = made(spec);
    const auto back = reverse(curve);
    ASSERT_TRUE(back) << back.error().message;
    for (int i = 0; i < 8; ++i) {
      const double span = curve.u_max() - curve.u_min();
      const double u = curve.u_min() + span * dice.below(1025) / 1024;
      const Side side = i % 2 == 0 ? Side::left : Side::right;
      const double mirrored = curve.u_min() + curve.u_max() - u;
      double a[curves::kMaxDim], b[curves::kMaxDim];
      curve.evaluate(u, side, a);
      back->evaluate(mirrored, side == Side::left ? Side::right : Side::left, b);
      for (int c = 0; c < curve.dim(); ++c) {
        EXPECT_NEAR(a[c], b[c], ulp_of(largest_coordinate(curve)));
      }
    }
  }
}

TEST(Reverse, KnotsThatFallTogetherAreAnError) {
  const auto error = reverse(made(spec_of(1, {0, 1, 2}, {0, 0, 1e-270, 1, 1})));
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().code, ErrorCode::knot_multiplicity);
  EXPECT_EQ(error.error().message,
            "curve 'example': knot 2 (1) comes 3 times, degree 1 allows 2 (knots that differed are "
            "equal after rounding)");
}

TEST(Reparametrize, KeepsPointsToTheBitAndHitsBothEnds) {
  Dice dice(support::test_seed());
  int done = 0;
  for (int round = 0; round < support::test_count(10'000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double a = dice.between(-1000, 1000), b = a + dice.between(1, 1000);
    const auto moved = reparametrize(curve, a, b);
    if (!moved && knots_fell_together(moved.error())) continue;
    ASSERT_TRUE(moved) << moved.error().message;
    ++done;
    EXPECT_EQ(moved->u_min(), a);
    EXPECT_EQ(moved->u_max(), b);
    EXPECT_THAT(moved->points(), ElementsAreArray(curve.points()));
    EXPECT_THAT(moved->weights(), ElementsAreArray(curve.weights()));
    const auto back = reparametrize(*moved, curve.u_min(), curve.u_max());
    ASSERT_TRUE(back) << back.error().message;
    // Each knot was rounded where it was and where it is.
    const double length = curve.u_max() - curve.u_min();
    const double allowed =
        2 * ulp_of(largest_knot(curve)) + ulp_of(largest_knot(*moved)) * length / (b - a);
    const std::vector<double> before = curve.spec().knots, after = back->spec().knots;
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(after[i], before[i], allowed);
  }
  EXPECT_GT(done, support::test_count(9500));
}

TEST(Reparametrize, TakesJumpsAlongWithTheirKnots) {
  const NurbsCurve curve = made(saw());
  const auto moved = reparametrize(curve, 10, 14);
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_THAT(moved->jumps(), ElementsAre(11));
  EXPECT_THAT(moved->knots(), ElementsAre(10, 10, 11, 11, 14, 14));
  EXPECT_EQ(at(*moved, 11, Side::left), 1);
  EXPECT_EQ(at(*moved, 11, Side::right), -1);
}

TEST(Reparametrize, ReportsWhatIsNoDomain) {
  const NurbsCurve curve = made(spec_of(1, {0, 1}));
  EXPECT_EQ(reparametrize(curve, 1, 1).error().code, ErrorCode::empty_domain);
  EXPECT_EQ(reparametrize(curve, 2, 1).error().message,
            "curve 'example': the domain 2..1 has no length");
  EXPECT_EQ(reparametrize(curve, 0, std::nan("")).error().code, ErrorCode::not_finite);
  EXPECT_EQ(reparametrize(curve, 0, 2e9).error().code, ErrorCode::value_out_of_range);
  const NurbsCurve fine = made(spec_of(1, {0, 1, 0, 1}, {0, 0, 0.5, 0.5 + 0x1p-40, 1, 1}));
  EXPECT_EQ(reparametrize(fine, 1e8, 1e8 + 1).error().code, ErrorCode::knot_multiplicity);
}

// The NURBS Book, 6.4: with knots at the ends alone, weight i is multiplied by b^(p - i).
TEST(Bend, ABezierSegmentGetsPowersAsWeights) {
  const auto bent = bend(made(spec_of(3, {0, 1, 2, 5})), 2);
  ASSERT_TRUE(bent) << bent.error().message;
  EXPECT_THAT(bent->points(), ElementsAre(0, 1, 2, 5));
  EXPECT_THAT(bent->weights(), ElementsAre(8, 4, 2, 1));
  // g(1/2) = 1/3, C = 3 t + 2 t^3
  EXPECT_NEAR(at(*bent, 0.5), 1 + 2.0 / 27, 4 * 0x1p-53);
}

// x = 3 y / (1 + 2 y): 1/4 goes to 1/2, and 1/2 to 3/4.
TEST(Bend, KnotsGoWhereTheInverseSays) {
  const auto bent = bend(made(spec_of(1, {0, 1, -1, 2}, {0, 0, 0.25, 0.5, 1, 1})), 3);
  ASSERT_TRUE(bent) << bent.error().message;
  EXPECT_THAT(bent->knots(), ElementsAre(0, 0, 0.5, 0.75, 1, 1));
  EXPECT_THAT(bent->weights(), ElementsAre(3, 2, 1.5, 1));
  EXPECT_EQ(at(*bent, 0.5), 1);
}

TEST(Bend, SlopesAtTheEndsAreTheInverseAndTheBendItself) {
  const auto bent = bend(made(spec_of(1, {0, 1})), 4);
  ASSERT_TRUE(bent) << bent.error().message;
  double out[2];
  bent->derivatives(0, 1, Side::right, out);
  EXPECT_EQ(out[1], 0.25);
  bent->derivatives(1, 1, Side::left, out);
  EXPECT_EQ(out[1], 4);
}

TEST(Bend, BackGivesTheSameKnotsPointsAndWeights) {
  Dice dice(support::test_seed());
  double worst_weight = 0, worst_knot = 0;
  for (int round = 0; round < support::test_count(10'000); ++round) {
    CurveSpec spec = random_spec(dice);
    spec.periodic = false;
    spec.knots.clear();
    for (double& w : spec.weights) w = dice.between(0.25, 4);
    const NurbsCurve curve = made(spec);
    const double b = std::ldexp(dice.between(1, 2), dice.below(3) - 1);
    const auto bent = bend(curve, b);
    ASSERT_TRUE(bent) << bent.error().message;
    const auto back = bend(*bent, 1 / b);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_THAT(back->points(), ElementsAreArray(curve.points()));
    for (std::size_t i = 0; i < curve.knots().size(); ++i) {
      worst_knot = std::max(worst_knot, std::abs(back->knots()[i] - curve.knots()[i]) * 0x1p53);
    }
    for (std::size_t i = 0; i < curve.weights().size(); ++i) {
      const double scale = back->weights()[0] / curve.weights()[0];
      const double error = std::abs(back->weights()[i] / curve.weights()[i] / scale - 1) * 0x1p53;
      worst_weight = std::max(worst_weight, error / (4 + 4 * curve.degree()));
    }
  }
  std::printf("knots within %.2f * 2^-53, weights within %.2f * (4 + 4p) 2^-53\n", worst_knot,
              worst_weight);
  EXPECT_LE(worst_knot, 4);    // two roundings, of which b may stretch one, and that of 1/b
  EXPECT_LE(worst_weight, 1);  // both of a ratio: two roundings, p rounded knots and 1/b
}

TEST(Bend, TwiceIsTheProduct) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(2000); ++round) {
    const NurbsCurve curve = random_segment(dice);
    const double a = dice.between(0.75, 1.5), b = dice.between(0.75, 1.5);
    const auto once = bend(curve, a * b);
    const auto first = bend(curve, a);
    if (!once || !first) continue;  // weights at the limits already
    const auto twice = bend(*first, b);
    if (!twice) continue;
    for (std::size_t i = 0; i < curve.weights().size(); ++i) {
      const double ratio = twice->weights()[i] / once->weights()[i];
      const double first_ratio = twice->weights()[0] / once->weights()[0];
      EXPECT_NEAR(ratio / first_ratio, 1, 64 * 0x1p-53);
    }
  }
}

// D(x) = C(g(x)) at places where g(x) is a double: x = 1 - 2^-i and b = 1 + 2^i (2^j - 1) give
// g(x) = (1 - 2^-i) / 2^j. Then all that is rounded are the weights. Other places against exact
// rationals: edit_references_test.cpp.
TEST(Bend, SegmentsKeepWithin4UlpOfTheLargestPoint) {
  Dice dice(support::test_seed());
  double worst = 0;
  int done = 0;
  for (int round = 0; round < support::test_count(10'000); ++round) {
    const NurbsCurve curve = random_segment(dice);
    const double i = std::ldexp(1.0, 1 + dice.below(4)), j = std::ldexp(1.0, 1 + dice.below(2));
    const auto bent = bend(curve, 1 + i * (j - 1));
    if (!bent) continue;
    ++done;
    double want[curves::kMaxDim], got[curves::kMaxDim];
    curve.evaluate((1 - 1 / i) / j, want);
    bent->evaluate(1 - 1 / i, got);
    for (int c = 0; c < curve.dim(); ++c) {
      worst = std::max(worst, std::abs(want[c] - got[c]) / ulp_of(largest_coordinate(curve)));
    }
  }
  std::printf("%d segments, worst %.2f ulp of max|P|\n", done, worst);
  EXPECT_LE(worst, 4);
  EXPECT_GT(done, 5000);
}

TEST(Bend, TakesJumpsAlong) {
  const NurbsCurve curve = made(saw());
  const auto bent = bend(curve, 3);
  ASSERT_TRUE(bent) << bent.error().message;
  EXPECT_THAT(bent->jumps(), ElementsAre(0.5));
  EXPECT_EQ(at(*bent, 0.5, Side::left), 1);
  EXPECT_EQ(at(*bent, 0.5, Side::right), -1);
}

TEST(Bend, AnUnclampedCurveBecomesClamped) {
  const NurbsCurve open = made(spec_of(2, {0, 1, -1, 2}, {-8, -8, 0, 0.25, 1, 9, 9}));
  const auto bent = bend(open, 3);
  ASSERT_TRUE(bent) << bent.error().message;
  EXPECT_TRUE(bent->is_clamped());
  EXPECT_NEAR(at(*bent, 0.5), at(open, 0.25), 4 * 0x1p-53);
}

TEST(Bend, ByOneIsTheCurveItself) {
  const NurbsCurve open = made(spec_of(2, {0, 1, -1, 2}, {-8, -8, 0, 0.25, 1, 9, 9}));
  EXPECT_EQ(*bend(open, 1), open);
}

TEST(Bend, WeightsAreScaledTogetherWhereTheLimitsNeedIt) {
  const auto bent = bend(made(spec_of(2, {0, 1, 2}, {}, {1e6, 1, 1})), 8);
  ASSERT_TRUE(bent) << bent.error().message;
  EXPECT_EQ(bent->weights()[0] / bent->weights()[1], 8e6);
  EXPECT_EQ(bent->weights()[1] / bent->weights()[2], 8);
}

TEST(Bend, ReportsWhatItCannotDo) {
  const NurbsCurve curve = made(spec_of(3, {0, 1, 2, 5}));
  EXPECT_EQ(bend(curve, 0).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(bend(curve, -1).error().message, "curve 'example' bent by -1: a bend must be above 0");
  EXPECT_EQ(bend(curve, std::nan("")).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(bend(curve, 1e5).error().code, ErrorCode::weight_out_of_range);
  EXPECT_EQ(bend(curve, 1e300).error().code, ErrorCode::weight_out_of_range);
  EXPECT_EQ(bend(curve, 1e-300).error().code, ErrorCode::weight_out_of_range);
  CurveSpec wave = spec_of(2, {0, 1, 0, -1});
  wave.periodic = true;
  EXPECT_EQ(bend(made(wave), 2).error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Values of sums, products and compositions against exact rationals: edit_references_test.cpp.
#include "knotwave/curves/combine.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/reparametrize.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"
#include "wide_value.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsEmpty;

// Two random curves over one domain, with knots of their own.
std::pair<NurbsCurve, NurbsCurve> two_curves(Dice& dice, int most_degree, bool rational) {
  const auto one = [&](bool periodic) {
    CurveSpec spec = spec_of(1 + dice.below(most_degree), {});
    spec.periodic = periodic;
    const int inner = dice.below(5), p = spec.degree, n = p + 1 + inner;
    for (int i = 0; i < n; ++i) spec.points.push_back(dice.between(-1, 1));
    if (rational) {
      for (int i = 0; i < n; ++i) spec.weights.push_back(dice.between(0.25, 4));
    }
    std::vector<double> knots;
    for (int i = 0; i < (periodic ? n - 1 : inner); ++i) knots.push_back(dice.unit());
    if (inner > 1 && p > 1 && dice.one_in(3)) knots[1] = knots[0];
    if (dice.one_in(2)) {
      for (double& knot : knots) knot = std::floor(knot * 8) / 8;  // often in both curves
    }
    std::sort(knots.begin(), knots.end());
    const bool unclamped = !periodic && dice.one_in(4);
    for (int i = 0; i <= (periodic ? 0 : p); ++i) {
      knots.insert(knots.begin(), unclamped ? -0.1 * i : 0);
      knots.push_back(unclamped ? 1 + 0.1 * i : 1);
    }
    spec.knots = knots;
    return NurbsCurve::create(spec);
  };
  while (true) {  // floors can make a knot too frequent
    const bool periodic = dice.one_in(3);
    auto first = one(periodic), second = one(periodic && !dice.one_in(3));
    if (first && second) return {std::move(*first), std::move(*second)};
  }
}

TEST(Join, OfSplitIsTheCurveWithAKnotOfTheDegree) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(2000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = dice.between(curve.u_min(), curve.u_max());
    if (!(u > curve.u_min())) continue;
    const auto parts = split(curve, u);
    ASSERT_TRUE(parts) << parts.error().message;
    const auto whole = join(parts->left, parts->right);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_THAT(whole->jumps(), IsEmpty());
    EXPECT_EQ(std::count(whole->knots().begin(), whole->knots().end(), u), curve.degree());
    EXPECT_EQ(whole->u_max(), curve.u_max());
    worst = std::max(worst, distance_ulp(dice, curve, *whole, curve.u_min(), curve.u_max()));
  }
  std::printf("worst %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 4);
}

TEST(Join, ShiftsTheSecondAndRaisesTheLowerDegree) {
  const auto both = join(made(spec_of(1, {0, 2})), made(spec_of(2, {2, 5, 4}, {3, 3, 3, 5, 5, 5})));
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_THAT(both->knots(), ElementsAre(0, 0, 0, 1, 1, 3, 3, 3));
  EXPECT_THAT(both->points(), ElementsAre(0, 1, 2, 5, 4));
}

TEST(Join, EndsApartMakeADeclaredJumpUnlessTheToleranceJoinsThem) {
  const NurbsCurve up = made(spec_of(1, {0, 1})), next = made(spec_of(1, {1.125, 0}));
  const auto jump = join(up, next);
  EXPECT_THAT(jump->jumps(), ElementsAre(1));
  EXPECT_EQ(at(*jump, 1, Side::left), 1);
  EXPECT_EQ(at(*jump, 1, Side::right), 1.125);
  const auto joined = join(up, next, 0.125);
  EXPECT_THAT(joined->jumps(), IsEmpty());
  EXPECT_THAT(joined->points(), ElementsAre(0, 1, 0));
}

TEST(Join, KeepsJumpsOfBothParts) {
  const auto twice = join(made(saw()), made(saw()));
  ASSERT_TRUE(twice) << twice.error().message;
  EXPECT_THAT(twice->jumps(), ElementsAre(0.25, 1, 1.25));
  EXPECT_EQ(at(*twice, 1.25, Side::left), 1);
  EXPECT_EQ(at(*twice, 1.25, Side::right), -1);
}

TEST(Join, ReportsWhatHasNoEnds) {
  CurveSpec wave = spec_of(2, {0, 1, 0, -1});
  wave.periodic = true;
  CurveSpec plane = spec_of(1, {0, 0, 1, 1});
  plane.dim = 2;
  const NurbsCurve line = made(spec_of(1, {0, 1}));
  EXPECT_EQ(join(line, made(wave)).error().code, ErrorCode::unsupported);
  EXPECT_EQ(join(line, made(plane)).error().message,
            "curves 'example' and 'example': 1 and 2 coordinates");
  EXPECT_EQ(join(line, line, -1).error().code, ErrorCode::value_out_of_range);
  const NurbsCurve late = made(spec_of(1, {0, 1}, {999999999, 999999999, 1e9, 1e9}));
  EXPECT_EQ(join(late, line).error().code, ErrorCode::value_out_of_range);
}

TEST(MakeCompatible, GivesBothTheSameKnotsAndKeepsBothWithin4Ulp) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(2000); ++round) {
    const auto [first, second] = two_curves(dice, 6, round % 2 == 0);
    const auto both = make_compatible(first, second);
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_THAT(both->second.knots(), ElementsAreArray(both->first.knots()));
    EXPECT_EQ(both->first.degree(), both->second.degree());
    EXPECT_EQ(both->first.degree(), std::max(first.degree(), second.degree()));
    EXPECT_EQ(both->first.is_periodic(), first.is_periodic() && second.is_periodic());
    EXPECT_EQ(both->second.is_periodic(), both->first.is_periodic());
    worst = std::max({worst, distance_ulp(dice, first, both->first, 0, 1),
                      distance_ulp(dice, second, both->second, 0, 1)});
  }
  std::printf("worst %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 4);
}

// A third is another double over 0..3: within rounding, so it stays one knot.
TEST(MakeCompatible, KnotsThatRoundingMovedBecomeOne) {
  const NurbsCurve first = made(spec_of(1, {0, 1, 0, 2}));
  const auto second = reparametrize(first, 0.1, 0.7);
  ASSERT_TRUE(second);
  const auto both = make_compatible(first, *second);
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->first.point_count(), 4);
  EXPECT_THAT(both->second.knots(), ElementsAreArray(first.knots()));
}

TEST(MakeCompatible, OnADomainOfAFewUlpItSaysThatKnotsFellTogether) {
  const double low = 42.602941155433655, high = std::nextafter(low, 43.0);
  const NurbsCurve narrow = made(spec_of(1, {0, 1}, {low, low, high, high}));
  const auto both = make_compatible(narrow, made(spec_of(1, {0, 1, 2, 3, 4})));
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, ErrorCode::knot_multiplicity) << both.error().message;
  const auto few = make_compatible(narrow, made(spec_of(2, {0, 1, 2})));
  ASSERT_TRUE(few) << few.error().message;
  EXPECT_EQ(few->second.u_max(), high);
}

TEST(MakeCompatible, AJumpOfOneIsAJumpOfBoth) {
  const auto both = make_compatible(made(spec_of(2, {0, 1, 3})), made(saw()));
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_THAT(both->first.jumps(), ElementsAre(0.25));
  EXPECT_EQ(at(both->first, 0.25, Side::left), at(both->first, 0.25, Side::right));
  EXPECT_EQ(at(both->second, 0.25, Side::left), 1);
  EXPECT_EQ(at(both->second, 0.25, Side::right), -1);
}

TEST(MakeCompatible, SeamsOfPeriodicCurvesAreCountedFromOneEnd) {
  CurveSpec at_start = spec_of(2, {0, 1, 2, 3}, {0, 0, 1, 2, 4});
  CurveSpec at_end = spec_of(2, {0, 1, 2, 3}, {0, 1, 2, 4, 4});
  at_start.periodic = at_end.periodic = true;
  Dice dice(1);
  const NurbsCurve first = made(at_start), second = made(at_end);
  const auto both = make_compatible(first, second);
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_THAT(both->second.knots(), ElementsAreArray(both->first.knots()));
  EXPECT_LE(distance_ulp(dice, second, both->second, 0, 4), 1);
}

TEST(Morph, EndsAreTheCompatibleCurvesToTheBit) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(500); ++round) {
    const auto [first, second] = two_curves(dice, 5, round % 2 == 0);
    const auto both = make_compatible(first, second);
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(*morph(first, second, 0), both->first);
    const auto end = morph(first, second, 1);
    EXPECT_THAT(end->points(), ElementsAreArray(both->second.points()));
    EXPECT_THAT(end->weights(), ElementsAreArray(both->second.weights()));
    EXPECT_THAT(end->knots(), ElementsAreArray(both->second.knots()));
  }
}

TEST(Morph, OfPolynomialCurvesIsThePointwiseMix) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(1000); ++round) {
    const auto [first, second] = two_curves(dice, 6, false);
    const double amount = dice.unit(), u = dice.unit();
    const auto mix = morph(first, second, amount);
    ASSERT_TRUE(mix) << mix.error().message;
    const double want = (1 - amount) * at(first, u) + amount * at(second, u);
    const double size = std::max(largest_coordinate(first), largest_coordinate(second));
    worst = std::max(worst, std::abs(at(*mix, u) - want) / ulp_of(size));
  }
  std::printf("worst %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 4);
  EXPECT_EQ(morph(made(spec_of(1, {0, 1})), made(spec_of(1, {0, 1})), 1.5).error().code,
            ErrorCode::value_out_of_range);
}

TEST(SumAndProduct, ArePointwiseForAnyKnotsWeightsAndPeriods) {
  Dice dice(support::test_seed());
  double worst_sum = 0, worst_product = 0;
  for (int round = 0; round < support::test_count(2000); ++round) {
    const auto [first, second] = two_curves(dice, 7, round % 2 == 0);
    const auto total = sum(first, second), scaled = product(first, second);
    ASSERT_TRUE(total) << total.error().message;
    ASSERT_TRUE(scaled) << scaled.error().message;
    EXPECT_EQ(scaled->degree(), first.degree() + second.degree());
    EXPECT_EQ(scaled->is_periodic(), first.is_periodic() && second.is_periodic());
    const double size = std::max(largest_coordinate(first), largest_coordinate(second));
    for (int i = 0; i < 10; ++i) {
      const double u = std::clamp(random_parameter(dice, i < 5 ? first : second), 0.0, 1.0);
      for (const Side side : {Side::left, Side::right}) {
        const double a = at(first, u, side), b = at(second, u, side);
        worst_sum = std::max(worst_sum, std::abs(at(*total, u, side) - (a + b)) / ulp_of(size));
        // a and b are rounded to half an ulp themselves: twice 1/2 on either side of theirs.
        const double error = std::abs(at(*scaled, u, side) - a * b);
        worst_product = std::max(worst_product, error / ulp_of(largest_coordinate(*scaled)));
      }
    }
  }
  std::printf("sum %.2f, product %.2f ulp of max|P|\n", worst_sum, worst_product);
  EXPECT_LE(worst_sum, 4);
  EXPECT_LE(worst_product, 4);
}

TEST(SumAndProduct, AreAsSmoothAsTheLessSmoothCurve) {
  // A quadratic with a simple knot is C1, and so is its product with a line: multiplicity 3 - 1.
  const NurbsCurve bump = made(spec_of(2, {0, 1, 0, 2}));
  const auto scaled = product(bump, made(spec_of(1, {1, 3})));
  ASSERT_TRUE(scaled) << scaled.error().message;
  EXPECT_THAT(scaled->knots(), ElementsAre(0, 0, 0, 0, 0.5, 0.5, 1, 1, 1, 1));
  double left[2], right[2];
  scaled->derivatives(0.5, 1, Side::left, left);
  scaled->derivatives(0.5, 1, Side::right, right);
  EXPECT_NEAR(left[1], right[1], 1e-15);
}

TEST(SumAndProduct, KeepJumpsWithBothTheirSides) {
  const NurbsCurve line = made(spec_of(1, {1, 3}));
  for (const Side side : {Side::left, Side::right}) {
    const double v = side == Side::left ? 1 : -1;
    EXPECT_EQ(at(*sum(made(saw()), line), 0.25, side), v + 1.5);
    EXPECT_EQ(at(*product(line, made(saw())), 0.25, side), v * 1.5);
  }
  EXPECT_THAT(product(line, made(saw()))->jumps(), ElementsAre(0.25));
}

TEST(Product, OfAScalarScalesEveryCoordinate) {
  CurveSpec arc = spec_of(2, {1, 0, 1, 1, 0, 1}, {}, {1, 1, 2});
  arc.dim = 2;
  const NurbsCurve circle = made(arc), gain = made(spec_of(1, {2, 4}));
  for (const auto& scaled : {*product(circle, gain), *product(gain, circle)}) {
    double out[2];
    scaled.evaluate(0.5, out);
    EXPECT_NEAR(out[0], 3 * 0.6, 1e-15);
    EXPECT_NEAR(out[1], 3 * 0.8, 1e-15);
  }
  CurveSpec space = spec_of(1, {0, 0, 0, 1, 1, 1});
  space.dim = 3;
  EXPECT_EQ(product(circle, made(space)).error().code, ErrorCode::dimension_mismatch);
}

TEST(SumAndProduct, ReportWhatDoesNotFit) {
  const NurbsCurve line = made(spec_of(1, {0, 1}));
  const NurbsCurve later = made(spec_of(1, {0, 1}, {0, 0, 2, 2}));
  EXPECT_EQ(sum(line, later).error().message,
            "curves 'example' and 'example': their domains 0..1 and 0..2 differ; reparametrize() "
            "makes them equal");
  EXPECT_EQ(product(line, later).error().code, ErrorCode::parameter_out_of_range);
  const NurbsCurve high = made(spec_of(8, {0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(product(high, high).error().message,
            "curve 'example' with curve 'example': degree 16 is outside 1..15");
  const NurbsCurve large = made(spec_of(1, {1e6, 1e6}));
  EXPECT_EQ(product(large, large).error().code, ErrorCode::coordinate_out_of_range);
}

}  // namespace
}  // namespace knotwave::test

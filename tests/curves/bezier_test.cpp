// SPDX-License-Identifier: MIT
#include "knotwave/curves/bezier.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"
#include "wide_value.h"

namespace knotwave::test {
namespace {

using curves::BezierSegment;
using curves::CurveSpec;
using curves::NurbsCurve;
using curves::PowerSegment;
using curves::Side;
using testing::ElementsAre;

BezierSegment segment(double u0, double u1, std::vector<double> points,
                      std::vector<double> weights = {}) {
  weights.resize(points.size(), 1.0);
  return {u0, u1, static_cast<int>(points.size()) - 1, 1, std::move(points), std::move(weights)};
}

double worst_of_round_trips(int count) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < count; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const auto again = from_bezier(to_bezier(curve));
    if (!again) ADD_FAILURE() << again.error().message;
    EXPECT_THAT(again->jumps(), testing::IsEmpty());
    worst = std::max(worst, distance_ulp(dice, curve, *again, curve.u_min(), curve.u_max()));
  }
  std::printf("worst of %d curves: %.2f ulp of max|P|\n", count, worst);
  return worst;
}

TEST(FromBezier, OfToBezierIsTheCurveWithin4Ulp) {
  EXPECT_LE(worst_of_round_trips(support::test_count(4000)), 4);
}

TEST(FromBezierStress, OfToBezierIsTheCurveWithin4Ulp) {
  EXPECT_LE(worst_of_round_trips(support::test_count(100'000)), 4);
}

TEST(FromBezier, KnotsHaveTheDegreeAsMultiplicity) {
  const auto curve = from_bezier(std::vector{segment(0, 1, {0, 1, 2}), segment(1, 3, {2, 5, 4})});
  ASSERT_TRUE(curve) << curve.error().message;
  EXPECT_THAT(curve->knots(), ElementsAre(0, 0, 0, 1, 1, 3, 3, 3));
  EXPECT_THAT(curve->points(), ElementsAre(0, 1, 2, 5, 4));
  EXPECT_FALSE(curve->is_rational());
}

TEST(FromBezier, EndsApartMakeAJumpUnlessTheToleranceJoinsThem) {
  const std::vector segments{segment(0, 1, {0, 1}), segment(1, 2, {1.125, 3})};
  const auto jump = from_bezier(segments);
  ASSERT_TRUE(jump) << jump.error().message;
  EXPECT_THAT(jump->jumps(), ElementsAre(1));
  EXPECT_EQ(at(*jump, 1, Side::left), 1);
  EXPECT_EQ(at(*jump, 1, Side::right), 1.125);
  const auto joined = from_bezier(segments, 0.125);
  ASSERT_TRUE(joined) << joined.error().message;
  EXPECT_THAT(joined->jumps(), testing::IsEmpty());
  EXPECT_EQ(at(*joined, 1, Side::right), 1);
}

TEST(FromBezier, KeepsTheJumpsOfACurve) {
  CurveSpec spec;
  spec.degree = 2;
  spec.points = {0, 2, 1, -1, 3, 0};
  spec.knots = {0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1};
  spec.jumps = {0.5};
  const NurbsCurve curve = made(spec);
  const auto again = from_bezier(to_bezier(curve));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_THAT(again->jumps(), ElementsAre(0.5));
  EXPECT_THAT(again->points(), testing::ElementsAreArray(curve.points()));
  EXPECT_THAT(again->knots(), testing::ElementsAreArray(curve.knots()));
}

TEST(FromBezier, NeighboursAreScaledToACommonWeight) {
  const auto curve = from_bezier(
      std::vector{segment(0, 1, {0, 1, 2}, {1, 2, 4}), segment(1, 2, {2, 5, 4}, {1, 3, 2})});
  ASSERT_TRUE(curve) << curve.error().message;
  EXPECT_THAT(curve->weights(), ElementsAre(1, 2, 4, 12, 8));
  double expected;
  de_casteljau(segment(1, 2, {2, 5, 4}, {1, 3, 2}), 1.5, std::span(&expected, 1));
  EXPECT_NEAR(at(*curve, 1.5), expected, 1e-15);
}

TEST(FromBezier, NamesTheSegmentAtFault) {
  const auto fault = [](std::vector<BezierSegment> segments, double tolerance = 0) {
    const auto result = from_bezier(segments, tolerance);
    EXPECT_FALSE(result);
    return result ? Error{} : result.error();
  };
  const BezierSegment good = segment(0, 1, {0, 1});
  EXPECT_EQ(fault({}).code, ErrorCode::too_few_points);
  EXPECT_EQ(fault({good}, -1).code, ErrorCode::value_out_of_range);
  EXPECT_EQ(fault({good, segment(1.5, 2, {0, 1})}).message,
            "segment 1 begins at 1.5, the one before ends at 1");
  EXPECT_EQ(fault({good, segment(1, 2, {0, 1, 2})}).message,
            "segment 1 has degree 2, expected 1 as before");
  EXPECT_EQ(fault({good, segment(1, 1, {0, 1})}).code, ErrorCode::empty_domain);
  EXPECT_EQ(fault({segment(0, 1, {0, std::nan("")})}).code, ErrorCode::not_finite);
  EXPECT_EQ(fault({segment(0, 1, {0, 1}, {1, 0})}).code, ErrorCode::weight_not_positive);
  EXPECT_EQ(fault({segment(0, 1, {0, 1}, {1, 1e13})}).code, ErrorCode::weight_out_of_range);
  BezierSegment odd = good;
  odd.points.pop_back();
  EXPECT_EQ(fault({odd}).code, ErrorCode::dimension_mismatch);
  EXPECT_EQ(fault(std::vector<BezierSegment>(1, segment(0, 1, {0, 1e7}))).code,
            ErrorCode::coordinate_out_of_range);
}

// (1 - t)^3 0 + 3 (1 - t)^2 t 1 + 3 (1 - t) t^2 (-1) + t^3 2 = 3 t - 9 t^2 + 8 t^3.
TEST(PowerBasis, OfABezierSegmentByHand) {
  CurveSpec spec;
  spec.degree = 3;
  spec.points = {0, 1, -1, 2};
  const auto pieces = to_power_basis(made(spec));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_THAT(pieces[0].numerator, ElementsAre(0, 3, -9, 8));
  EXPECT_THAT(pieces[0].denominator, testing::IsEmpty());
}

// The quarter circle of The NURBS Book, example 1.13: (1 - t^2, 2 t) / (1 + t^2).
TEST(PowerBasis, OfTheQuarterCircleHasTheBooksPolynomials) {
  CurveSpec spec;
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {1, 0, 1, 1, 0, 1};
  spec.weights = {1, 1, 2};
  const auto pieces = to_power_basis(made(spec));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_THAT(pieces[0].numerator, ElementsAre(1, 0, 0, 2, -1, 0));
  EXPECT_THAT(pieces[0].denominator, ElementsAre(1, 0, 1));
  const auto again = from_power_basis(pieces[0]);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_THAT(again->points, ElementsAre(1, 0, 1, 1, 0, 1));
  EXPECT_THAT(again->weights, ElementsAre(1, 1, 2));
}

TEST(PowerBasis, EqualWeightsMakeNoDenominator) {
  CurveSpec spec;
  spec.degree = 1;
  spec.points = {1, 3};
  spec.weights = {8, 8};
  const auto pieces = to_power_basis(made(spec));
  EXPECT_THAT(pieces[0].numerator, ElementsAre(1, 2));
  EXPECT_THAT(pieces[0].denominator, testing::IsEmpty());
}

// One rounding of a coefficient, at most C(p, k) 2^k max|P|, weighs C(j, k) / C(p, k) in point j:
// together 3^p half ulp of max|P|, and as much again for what the weights do.
TEST(PowerBasis, BackAndForthMovesPointsByAtMost3ToThePUlp) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(2000); ++round) {
    CurveSpec spec = random_spec(dice);
    for (double& w : spec.weights) w = dice.between(1, 2);
    const NurbsCurve curve = made(spec);
    const auto segments = to_bezier(curve);
    const auto pieces = to_power_basis(curve);
    ASSERT_EQ(pieces.size(), segments.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto back = from_power_basis(pieces[i]);
      // The weights go astray as the points do: from degree 9 on they need not stay positive.
      if (!back && curve.is_rational() && curve.degree() > 9) continue;
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->u0, segments[i].u0);
      EXPECT_EQ(back->u1, segments[i].u1);
      const double allowed = std::pow(3.0, curve.degree()) * ulp_of(largest_coordinate(curve)) * 4;
      for (std::size_t c = 0; c < back->points.size(); ++c) {
        const double error = std::abs(back->points[c] - segments[i].points[c]);
        worst = std::max(worst, error / allowed);
      }
    }
  }
  std::printf("worst %.3f of what is allowed\n", worst);
  EXPECT_LE(worst, 1);
}

#if defined(__SIZEOF_FLOAT128__)
using Wide = __float128;
#else
using Wide = long double;
#endif

/// The powers of `piece` at u, not rounded on the way.
std::vector<double> value_of(const PowerSegment& piece, double u) {
  const Wide t = (Wide(u) - Wide(piece.u0)) / (Wide(piece.u1) - Wide(piece.u0));
  const auto sum_of = [&](const std::vector<double>& powers, std::size_t c, std::size_t step) {
    Wide sum = 0;
    for (std::size_t k = std::size_t(piece.degree) + 1; k-- > 0;) {
      sum = sum * t + Wide(powers[k * step + c]);
    }
    return sum;
  };
  const Wide below = piece.denominator.empty() ? Wide(1) : sum_of(piece.denominator, 0, 1);
  std::vector<double> value;
  for (std::size_t c = 0; c < std::size_t(piece.dim); ++c) {
    value.push_back(double(sum_of(piece.numerator, c, std::size_t(piece.dim)) / below));
  }
  return value;
}

double weight_ratio(const NurbsCurve& curve) {
  const auto [least, most] = std::ranges::minmax(curve.weights());
  return most / least;
}

TEST(PowerBasis, RoundingMovesTheCurveByAtMostWhatTheHeaderSays) {
  Dice dice(support::test_seed());
  double worst_plain = 0, worst_rational = 0;
  int rational = 0;
  for (int round = 0; round < support::test_count(2000); ++round) {
    CurveSpec spec = random_spec(dice);
    const double decades = dice.between(0, 6);
    for (double& w : spec.weights) w = std::pow(10, dice.between(-decades, decades));
    const NurbsCurve curve = made(spec);
    const double ratio = weight_ratio(curve), power = std::pow(3.0, curve.degree());
    if (power * ratio > 0x1p52) continue;
    rational += curve.is_rational();
    for (const PowerSegment& piece : to_power_basis(curve)) {
      for (int look = 0; look < 8; ++look) {
        const double near = std::ldexp(dice.unit(), -dice.below(50)) * (piece.u1 - piece.u0);
        const double u = dice.one_in(2) ? piece.u1 - near : piece.u0 + near;
        const Side side = u < piece.u1 ? Side::right : Side::left;
        const double error = error_in_ulp(curve, u, side, value_of(piece, u));
        if (curve.is_rational()) {
          worst_rational = std::max(worst_rational, error / (4 * power * ratio));
        } else {
          worst_plain = std::max(worst_plain, error / power);
        }
      }
    }
  }
  std::printf("worst %.3f and, with weights, %.3f of what is allowed\n", worst_plain,
              worst_rational);
  EXPECT_LE(worst_plain, 1);
  EXPECT_LE(worst_rational, 1);
  EXPECT_GT(rational, support::test_count(200));
}

TEST(PowerBasis, WithWeightsSquaresCancelAlready) {
  CurveSpec spec;
  spec.degree = 2;
  spec.points = {0.3, -1, 1};
  spec.weights = {1e6, 3e5, 1e-6};
  const NurbsCurve curve = made(spec);
  const PowerSegment piece = to_power_basis(curve).front();
  double worst = 0;
  for (int k = 0; k <= 2000; ++k) {
    const double u = 1 - std::pow(10, -k / 125.0);
    worst = std::max(worst, error_in_ulp(curve, u, Side::left, value_of(piece, u)));
  }
  EXPECT_GT(worst, 1e9) << "so 3^p = 9 ulp is no bound here";
  EXPECT_LE(worst, 4 * 9 * weight_ratio(curve));
  // docs/curves.md: a millionth of the range
  EXPECT_GT(worst * 0x1p-52, 1e-6);
}

TEST(PowerBasis, ReportsWhatIsNoPiece) {
  const auto code = [](PowerSegment piece) {
    const auto result = from_power_basis(piece);
    EXPECT_FALSE(result);
    return result ? ErrorCode::malformed : result.error().code;
  };
  EXPECT_EQ(code({0, 1, 16, 1, std::vector<double>(17), {}}), ErrorCode::degree_out_of_range);
  EXPECT_EQ(code({0, 1, 2, 1, {1, 2}, {}}), ErrorCode::dimension_mismatch);
  EXPECT_EQ(code({0, 1, 1, 1, {1, 2}, {1}}), ErrorCode::dimension_mismatch);
  EXPECT_EQ(code({1, 1, 1, 1, {1, 2}, {}}), ErrorCode::empty_domain);
  EXPECT_EQ(code({0, 1, 1, 1, {1, 2}, {1, -1}}), ErrorCode::weight_not_positive);
  EXPECT_EQ(code({0, 1, 1, 1, {1, INFINITY}, {}}), ErrorCode::not_finite);
  // 1 - 4 t + 4.5 t^2 is positive everywhere, its middle Bézier coefficient is -1.
  const auto error = from_power_basis(PowerSegment{0, 1, 2, 1, {1, 0, 0}, {1, -4, 4.5}});
  ASSERT_FALSE(error);
  EXPECT_EQ(error.error().message, "the denominator has the Bézier weight -1 at 1 of 2");
}

TEST(Blossom, OfEqualArgumentsIsTheCurve) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(5000); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double u = dice.between(curve.u_min(), curve.u_max());
    const std::vector<double> arguments(std::size_t(curve.degree()), u);
    double out[curves::kMaxDim + 1];
    blossom(curve, find_span(curve.knots(), curve.degree(), u, Side::right), arguments, out);
    for (int c = 0; c < curve.dim(); ++c) out[c] /= out[curve.dim()];
    worst = std::max(worst, error_in_ulp(curve, u, Side::right,
                                         std::span<const double>(out, std::size_t(curve.dim()))));
  }
  std::printf("worst %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 2.5);  // numerator, denominator and their quotient are rounded
}

TEST(Blossom, OfConsecutiveKnotsIsAControlPoint) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(2000); ++round) {
    CurveSpec spec = random_spec(dice);
    spec.periodic = false;
    spec.knots.clear();
    const NurbsCurve curve = made(spec);
    const int p = curve.degree();
    const int span = find_span(curve.knots(), p, dice.unit(), Side::right);
    const int i = span - p + dice.below(p + 1);
    double out[curves::kMaxDim + 1];
    blossom(curve, span, curve.knots().subspan(std::size_t(i + 1), std::size_t(p)), out);
    const double w = curve.weights()[std::size_t(i)];
    // Knots beyond the span extrapolate, and heavy points cancel.
    const double heaviest = *std::max_element(curve.weights().begin(), curve.weights().end());
    EXPECT_NEAR(out[curve.dim()], w, ulp_of(w) + 0x1p-70 * heaviest);
    for (int c = 0; c < curve.dim(); ++c) {
      const double expected = w * curve.points()[std::size_t(i * curve.dim() + c)];
      const double cancelled = 0x1p-70 * heaviest * largest_coordinate(curve);
      EXPECT_NEAR(out[c], expected, ulp_of(expected) + cancelled);
    }
  }
}

// f(a, b) of u^2 is a b, of a cubic's u^3 f(a, b, c) is a b c, on every span and outside of it too.
TEST(Blossom, OfAMonomialIsTheProductAndSymmetric) {
  CurveSpec spec;
  spec.degree = 3;
  spec.knots = {0, 0, 0, 0, 1, 2, 2, 4, 4, 4, 4};
  for (std::size_t i = 1; i <= 7; ++i) {
    spec.points.push_back(spec.knots[i] * spec.knots[i + 1] * spec.knots[i + 2]);
  }
  const NurbsCurve cube = made(spec);
  for (const int span : {3, 4, 6}) {
    double out[2];
    blossom(cube, span, std::vector<double>{-1, 5, 0.5}, out);
    EXPECT_NEAR(out[0], -2.5, 1e-15);
    EXPECT_EQ(out[1], 1);
    blossom(cube, span, std::vector<double>{0.5, -1, 5}, out);
    EXPECT_NEAR(out[0], -2.5, 1e-15);
  }
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Curves from data: scipy's splines, and bounds that hold where nobody looked when they were made.
#include "knotwave/curves/fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::FittedCurve;
using curves::NurbsCurve;
using curves::Spacing;
using support::test_count;
using support::test_seed;

struct Reference {
  int dim, degree, point_count;
  std::vector<double> parameters, values, knots, points;
};
std::vector<Reference> references() {
  return {
#include "golden/curves/fits.inc"
  };
}

TEST(Fit, GivesTheSplinesOfScipy) {
  int interpolated = 0, approximated = 0;
  for (const Reference& wanted : references()) {
    const bool through_all =
        static_cast<std::size_t>(wanted.point_count) == wanted.parameters.size();
    (through_all ? interpolated : approximated) += 1;
    const auto fit = curves::approximate(wanted.parameters, wanted.values, wanted.dim,
                                         wanted.degree, wanted.point_count);
    ASSERT_TRUE(fit) << fit.error().message;
    const auto curve = through_all ? curves::interpolate_at(wanted.parameters, wanted.values,
                                                            wanted.dim, wanted.degree)
                                   : Result<NurbsCurve>(fit->curve);
    ASSERT_TRUE(curve);
    ASSERT_EQ(curve->knots().size(), wanted.knots.size());
    ASSERT_EQ(curve->points().size(), wanted.points.size());
    for (std::size_t i = 0; i < wanted.knots.size(); ++i) {
      EXPECT_NEAR(curve->knots()[i], wanted.knots[i], 1e-13);
    }
    for (std::size_t i = 0; i < wanted.points.size(); ++i) {
      EXPECT_NEAR(curve->points()[i], wanted.points[i], 1e-9);
      EXPECT_NEAR(fit->curve.points()[i], wanted.points[i], 1e-9);
    }
  }
  EXPECT_EQ(interpolated, 6);
  EXPECT_EQ(approximated, 6);
}

// The NURBS Book, ex. 9.1: chord lengths 5, 5, 3, 5 of 17 and hence the parameters 5/17 and so on;
// the knot between is the mean (5 + 9 + 12) / (3 * 17) of 5/17, 9/17 and 14/17.
TEST(Interpolate, SpacesPointsAndKnotsAsTheNurbsBook) {
  const std::vector<double> points{0, 0, 3, 4, -1, 4, -4, 0, -4, -3};
  const auto curve = curves::interpolate(points, 2, 3, Spacing::chord);
  ASSERT_TRUE(curve) << curve.error().message;
  ASSERT_EQ(curve->knots().size(), 9u);
  EXPECT_NEAR(curve->knots()[4], 28.0 / 51, 1e-15);
  const double parameters[] = {0, 5.0 / 17, 9.0 / 17, 14.0 / 17, 1};
  for (std::size_t i = 0; i < 5; ++i) {
    double xy[2];
    curve->evaluate(parameters[i], xy);
    EXPECT_NEAR(xy[0], points[2 * i], 1e-13);
    EXPECT_NEAR(xy[1], points[2 * i + 1], 1e-13);
  }
}

TEST(Interpolate, GoesThroughEveryPointWithin1UlpOfMaxP) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(300); ++round) {
    const int degree = 1 + dice.below(9), n = degree + 1 + dice.below(30);
    std::vector<double> parameters, values;
    double u = dice.between(-3, 3);
    for (int i = 0; i < n; ++i, u += dice.between(0.1, 1)) {
      parameters.push_back(u);
      values.push_back(dice.between(-1, 1));
    }
    const auto curve = curves::interpolate_at(parameters, values, 1, degree);
    ASSERT_TRUE(curve) << curve.error().message;
    const double allowed = ulp_of(largest_coordinate(*curve));
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(at(*curve, parameters[i]), values[i], allowed) << "degree " << degree;
    }
  }
}

TEST(Interpolate, NamesWhatIsWrong) {
  const std::vector<double> twice{0, 0, 1, 1, 1, 1};
  EXPECT_EQ(curves::interpolate(twice, 2, 2).error().code, ErrorCode::knots_decrease);
  EXPECT_TRUE(curves::interpolate(twice, 2, 2, Spacing::uniform));
  EXPECT_EQ(curves::interpolate(twice, 2, 3, Spacing::uniform).error().code,
            ErrorCode::too_few_points);
  EXPECT_EQ(curves::interpolate(twice, 4, 1).error().code, ErrorCode::dimension_mismatch);
  EXPECT_EQ(curves::interpolate(twice, 2, 0, Spacing::uniform).error().code,
            ErrorCode::degree_out_of_range);
  EXPECT_EQ(curves::interpolate({}, 1, 3).error().code, ErrorCode::too_few_points);
  EXPECT_EQ(curves::interpolate_at(std::vector<double>{0, 0}, std::vector<double>{0, 1}, 1, 1)
                .error()
                .code,
            ErrorCode::knots_decrease);
  EXPECT_EQ(curves::interpolate(std::vector<double>{0, NAN, 1}, 1, 1).error().code,
            ErrorCode::not_finite);
}

TEST(Approximate, MeetsBothEndsExactlyAndStatesItsErrorInDecibels) {
  std::vector<double> times, values;
  for (int i = 0; i <= 100; ++i) {
    times.push_back(i / 100.0);
    values.push_back(0.5 + 2 * std::sin(i / 10.0));
  }
  const auto fit = curves::approximate(times, values, 1, 3, 14);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(at(fit->curve, 0), values.front());
  EXPECT_EQ(at(fit->curve, 1), values.back());
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    worst = std::max(worst, std::abs(at(fit->curve, times[i]) - values[i]));
    largest = std::max(largest, std::abs(values[i]));
  }
  EXPECT_EQ(fit->max_error, worst);
  EXPECT_NEAR(fit->max_error_db, 20 * std::log10(worst / largest), 1e-9);
  EXPECT_LT(fit->max_error_db, -50);
  const auto still = curves::approximate(times, std::vector<double>(101, 0.25), 1, 3, 5);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->max_error_db, -1000);
  EXPECT_EQ(curves::approximate(times, values, 1, 3, 3).error().code, ErrorCode::too_few_points);
  EXPECT_EQ(curves::approximate(times, values, 1, 3, 102).error().code, ErrorCode::too_many_points);
  EXPECT_EQ(curves::approximate(times, values, 1, 3, -1).error().code, ErrorCode::too_few_points);
}

// Least squares: moving any inner point makes the sum of squares larger.
TEST(Approximate, HasTheLeastSumOfSquares) {
  Dice dice(test_seed());
  std::vector<double> times, values;
  for (int i = 0; i < 60; ++i) {
    times.push_back(i + 0.5 * dice.unit());
    values.push_back(dice.between(-1, 1));
  }
  const auto fit = curves::approximate(times, values, 1, 3, 12);
  ASSERT_TRUE(fit);
  const auto squares = [&](const NurbsCurve& curve) {
    double sum = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      sum += std::pow(at(curve, times[i]) - values[i], 2);
    }
    return sum;
  };
  const double least = squares(fit->curve);
  for (std::size_t i = 1; i < 11; ++i) {
    for (const double step : {-1e-4, 1e-4}) {
      auto spec = fit->curve.spec();
      spec.points[i] += step;
      EXPECT_GT(squares(*NurbsCurve::create(spec)), least);
    }
  }
}

double line_at(const std::vector<double>& times, const std::vector<double>& values, double t) {
  const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, t) - times.begin();
  const auto i = static_cast<std::size_t>(after);
  const double fraction = (t - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] + fraction * (values[i] - values[i - 1]);
}

// The farthest the curve is from the lines, at 40 places on each.
double measured(const NurbsCurve& curve, const std::vector<double>& times,
                const std::vector<double>& values) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    for (int k = 0; k <= 40; ++k) {
      const double t = times[i] + (times[i + 1] - times[i]) * (k / 40.0);
      worst = std::max(worst, std::abs(at(curve, t) - line_at(times, values, t)));
    }
  }
  return worst;
}

// A simplifier that walks along and drops points (openDAW issue 363) was 19.8 times its tolerance
// of 0.01 off a smooth arc. Here the bound is never exceeded, and few points are left.
TEST(ReduceData, KeepsItsBoundOnTheSmoothArcThatGreedySimplifiersLose) {
  std::vector<double> times, values;
  for (int i = 0; i <= 500; ++i) {
    times.push_back(i / 500.0);
    values.push_back(std::sin(std::numbers::pi * i / 500.0));
  }
  for (const auto& [tolerance, most] : {std::pair{0.01, 6}, {1e-3, 8}, {1e-4, 14}}) {
    const auto fit = curves::reduce_data(times, values, tolerance);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LE(fit->max_error, tolerance);
    EXPECT_LE(measured(fit->curve, times, values), fit->max_error);
    EXPECT_LE(fit->curve.point_count(), most) << tolerance;
  }
}

TEST(ReduceData, ProvesItsBoundForAnyDataAndDegree) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(40); ++round) {
    const int degree = 1 + dice.below(5), n = 2 + dice.below(40);
    const int kind = dice.below(4);
    std::vector<double> times, values;
    double t = dice.between(-2, 2), walk = 0;
    for (int i = 0; i < n; ++i, t += dice.one_in(8) ? 1e-6 : dice.between(0.01, 0.1)) {
      walk += dice.between(-0.1, 0.1);
      times.push_back(t);
      values.push_back(kind == 0   ? dice.between(-1, 1)          // noise
                       : kind == 1 ? walk                         // a hand
                       : kind == 2 ? std::floor(3 * std::sin(t))  // steps
                                   : std::sin(3 * t));
    }
    const double tolerance = std::pow(10, dice.between(-4, -1));
    const auto fit = curves::reduce_data(times, values, tolerance, degree);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LE(fit->max_error, tolerance);
    EXPECT_LE(measured(fit->curve, times, values), fit->max_error + 1e-15);
    EXPECT_EQ(at(fit->curve, times.front()), values.front());
    EXPECT_EQ(at(fit->curve, times.back()), values.back());
    EXPECT_EQ(fit->curve.u_min(), times.front());
    EXPECT_EQ(fit->curve.u_max(), times.back());
    EXPECT_LE(fit->curve.point_count(), degree * (n - 1) + 1);
  }
}

// Coordinates that have nothing to do with each other: the distance is Euclidean, and between the
// data it is that of the lines.
TEST(ReduceData, ProvesItsBoundInTwoToFourCoordinates) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(30); ++round) {
    const int dim = 2 + dice.below(3), degree = 1 + dice.below(4), n = 2 + dice.below(40);
    std::vector<double> times, values;
    for (int i = 0; i < n; ++i) {
      times.push_back(i * 0.1 + dice.between(0, 0.05));
      values.push_back(std::sin(times.back()));
      values.push_back(dice.one_in(3) ? 1.5 : std::floor(times.back()));
      for (int c = 2; c < dim; ++c) values.push_back(dice.between(-0.1, 0.1));
    }
    const double tolerance = std::pow(10, dice.between(-4, -1));
    const auto fit = curves::reduce_data(times, values, tolerance, degree, dim);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LE(fit->max_error, tolerance);
    const auto d = static_cast<std::size_t>(dim);
    double place[curves::kMaxDim];
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      for (const double x : {0.0, 0.2, 0.5, 0.9, 1.0}) {
        fit->curve.evaluate(times[i] + x * (times[i + 1] - times[i]), place);
        double square = 0;
        for (std::size_t c = 0; c < d; ++c) {
          const double line = values[i * d + c] + x * (values[(i + 1) * d + c] - values[i * d + c]);
          square += (place[c] - line) * (place[c] - line);
        }
        EXPECT_LE(std::sqrt(square), fit->max_error + 4e-15);
      }
    }
    fit->curve.evaluate(times.back(), place);
    EXPECT_TRUE(std::equal(place, place + d, values.end() - dim));
  }
}

TEST(ReduceData, OneCoordinateTwiceIsOneCoordinate) {
  std::vector<double> times, values, twice;
  for (int i = 0; i <= 100; ++i) {
    times.push_back(i / 100.0);
    values.push_back(std::sin(7 * times.back()));
    twice.insert(twice.end(), 2, values.back());
  }
  const auto one = curves::reduce_data(times, values, 1e-3);
  const auto two = curves::reduce_data(times, twice, 1e-3 * std::numbers::sqrt2, 3, 2);
  ASSERT_TRUE(one && two);
  EXPECT_NEAR(two->max_error, one->max_error * std::numbers::sqrt2, 1e-9);
  EXPECT_EQ(two->curve.point_count(), one->curve.point_count());
}

TEST(ReduceData, NeedsNoInnerKnotForAStraightLineNorMoreThanOneCornerForTwo) {
  std::vector<double> times, line, bent;
  for (int i = 0; i <= 64; ++i) {
    times.push_back(i / 64.0);
    line.push_back(1 - i / 128.0);
    bent.push_back(i <= 32 ? i / 32.0 : 1);
  }
  const auto straight = curves::reduce_data(times, line, 1e-9);
  ASSERT_TRUE(straight);
  EXPECT_EQ(straight->curve.point_count(), 4);
  const auto corner = curves::reduce_data(times, bent, 1e-6, 1);
  ASSERT_TRUE(corner);
  EXPECT_EQ(corner->curve.point_count(), 3);
  EXPECT_LE(measured(corner->curve, times, bent), 1e-6);
  const auto cubic = curves::reduce_data(times, bent, 1e-6);
  ASSERT_TRUE(cubic);
  EXPECT_LE(cubic->curve.point_count(), 7) << "one triple knot does it";
}

// Half an ulp of time is 2e-8 of the way from one to the next.
TEST(ReduceData, TakesDataThatLieCloseAsTheyAre) {
  const std::vector<double> times{0, 1, 1 + 5e-9}, values{0, 1, -1};
  for (const double tolerance : {1e-9, 1e-15}) {
    const auto fit = curves::reduce_data(times, values, tolerance, 1);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LE(fit->max_error, tolerance);
    EXPECT_NEAR(at(fit->curve, 1), 1, tolerance);
  }
  const auto exact = curves::reduce_data(times, values, 1e-30, 1);
  ASSERT_TRUE(exact) << exact.error().message;
  EXPECT_EQ(exact->max_error, 0);
  EXPECT_EQ(exact->curve.points()[1], 1);
}

TEST(ReduceData, ProvesItsBoundWhereDataLieUlpsApart) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(40); ++round) {
    const int degree = 1 + dice.below(4), n = 3 + dice.below(8);
    std::vector<double> times{dice.between(-2, 2)}, values{dice.between(-1, 1)};
    for (int i = 1; i < n; ++i) {
      double next = times.back() + dice.between(0.1, 1);
      if (dice.one_in(2)) {
        next = times.back();
        for (int ulps = 1 + dice.below(20); ulps > 0; --ulps) next = std::nextafter(next, 1e9);
      }
      times.push_back(next);
      values.push_back(dice.between(-1, 1));
    }
    const auto fit = curves::reduce_data(times, values, 1e-12, degree);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LE(fit->max_error, 1e-12);
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_NEAR(at(fit->curve, times[i]), values[i], 1e-12 + 1e-15) << i;
    }
  }
}

TEST(ReduceData, TakesDataUpToTheLimitOfCoordinatesAndNamesADatumBeyond) {
  const std::vector<double> times{0, 1, 2, 3, 4};
  for (const double sign : {1.0, -1.0}) {
    const std::vector<double> peak{0, 0, sign * 1e6, 0, 0};
    for (const int degree : {1, 2, 3}) {
      const auto fit = curves::reduce_data(times, peak, 1e4, degree);
      ASSERT_TRUE(fit) << degree << ": " << fit.error().message;
      EXPECT_LE(fit->max_error, 1e4);
      EXPECT_NEAR(at(fit->curve, 2), sign * 1e6, 1e4);
    }
  }
  const auto beyond = curves::reduce_data(times, std::vector<double>{0, 0, 0, -1e7, 0}, 1e4);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, ErrorCode::coordinate_out_of_range);
  EXPECT_EQ(beyond.error().message, "reduced data: datum 3 (-1e+07) is outside -1e+06..1e+06");
}

TEST(ReduceData, NamesWhatIsWrong) {
  const std::vector<double> times{0, 1, 2}, values{0, 1, 0}, back{0, 2, 1};
  EXPECT_EQ(curves::reduce_data(times, values, 0).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::reduce_data(times, values, NAN).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::reduce_data(back, values, 0.1).error().code, ErrorCode::knots_decrease);
  EXPECT_EQ(curves::reduce_data(times, {values.data(), 2}, 0.1).error().code,
            ErrorCode::dimension_mismatch);
  EXPECT_EQ(curves::reduce_data(times, values, 0.1, 3, 2).error().code,
            ErrorCode::dimension_mismatch);
  EXPECT_EQ(curves::reduce_data({times.data(), 1}, {values.data(), 1}, 0.1).error().code,
            ErrorCode::too_few_points);
  EXPECT_EQ(curves::reduce_data(times, values, 0.1, 16).error().code,
            ErrorCode::degree_out_of_range);
  const std::vector<double> thirds{0.1, 0.7, 0.3};
  EXPECT_EQ(curves::reduce_data(times, thirds, 1e-30).error().code, ErrorCode::error_bound_missed);
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Curves that have a name, against what they are named after.
#include "knotwave/curves/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveProgram;
using curves::NurbsCurve;
using curves::Side;
using support::test_count;
using support::test_seed;
__extension__ using Wide = __float128;

std::array<double, 2> at(const NurbsCurve& curve, double u) {
  std::array<double, 2> xy{};
  curve.evaluate(u, std::span(xy).first(static_cast<std::size_t>(curve.dim())));
  return xy;
}

// How far (x / a, y / b) is from the unit circle, in ulp of 1.
double off_circle_ulp(std::array<double, 2> xy, double a, double b) {
  const Wide x = Wide(xy[0]) / a, y = Wide(xy[1]) / b;
  return std::abs(static_cast<double>((x * x + y * y - 1) / 2)) / 0x1p-52;
}

TEST(Bezier, IsWhatRepeatedCrossFadingGives) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(1000); ++round) {
    std::vector<double> points(static_cast<std::size_t>(2 + dice.below(15)));
    for (double& point : points) point = dice.between(-1, 1);
    const auto curve = curves::bezier(points);
    ASSERT_TRUE(curve) << curve.error().message;
    const double u = dice.unit();
    std::vector<Wide> fade(points.begin(), points.end());
    while (fade.size() > 1) {
      for (std::size_t i = 0; i + 1 < fade.size(); ++i) {
        fade[i] = (1 - Wide(u)) * fade[i] + Wide(u) * fade[i + 1];
      }
      fade.pop_back();
    }
    EXPECT_NEAR(at(*curve, u)[0], static_cast<double>(fade[0]), 0x1p-53);
  }
}

TEST(Bezier, NeedsTwoPointsAndAtMostSixteen) {
  EXPECT_EQ(curves::bezier(std::vector<double>{1}).error().code, ErrorCode::degree_out_of_range);
  EXPECT_EQ(curves::bezier(std::vector<double>(17, 0.5)).error().code,
            ErrorCode::degree_out_of_range);
  EXPECT_FALSE(curves::bezier(std::vector<double>{1, 2, 3}, 2));
  EXPECT_FALSE(curves::bezier(std::vector<double>{1, 2, 3}, 0));
}

TEST(Arc, KeepsItsRadiusWithin2Ulp) {
  Dice dice(test_seed());
  double worst = 0;
  for (int round = 0; round < test_count(2000); ++round) {
    const double radius = std::exp2(dice.between(-40, 19)), start = dice.between(-3, 3);
    const double length = dice.between(-1, 1);
    const auto curve = curves::arc(radius, start, length);
    ASSERT_TRUE(curve) << curve.error().message;
    for (int i = 0; i < 10; ++i) {
      worst = std::max(worst, off_circle_ulp(at(*curve, dice.unit()), radius, radius));
    }
  }
  RecordProperty("worst_ulp", std::to_string(worst));
  EXPECT_LE(worst, 2);
  EXPECT_GT(worst, 0);
}

TEST(Arc, FollowsItsAngleAndIsAtMost1Point1DegreesOffBetweenTheEndsOfPieces) {
  for (const double length : {0.25, -0.25, 0.1, 0.6, -1.0}) {
    const auto curve = curves::arc(2, 0.125, length);
    ASSERT_TRUE(curve);
    for (int i = 0; i <= 100; ++i) {
      const double u = i / 100.0;
      const auto xy = at(*curve, u);
      const double asked = 0.125 + length * u, found = std::atan2(xy[1], xy[0]);
      const double off = std::remainder(found / (2 * std::numbers::pi) - asked, 1);
      EXPECT_LE(std::abs(off) * 360, 1.1) << length << " at " << u;
    }
  }
}

TEST(Arc, HitsQuarterPointsExactlyAndClosesToTheBit) {
  const auto circle = curves::arc(3, 0.25, -1);
  ASSERT_TRUE(circle);
  EXPECT_EQ(circle->point_count(), 9);
  EXPECT_EQ(at(*circle, 0), (std::array{0.0, 3.0}));
  EXPECT_EQ(at(*circle, 0.25), (std::array{3.0, 0.0}));
  EXPECT_EQ(at(*circle, 0.5), (std::array{0.0, -3.0}));
  EXPECT_EQ(at(*circle, 0.75), (std::array{-3.0, 0.0}));
  EXPECT_EQ(at(*circle, 1), (std::array{0.0, 3.0}));
  Dice dice(test_seed());
  for (int round = 0; round < 100; ++round) {
    const auto closed = curves::arc(dice.between(0.1, 9), dice.between(-5, 5), 1);
    ASSERT_TRUE(closed);
    EXPECT_EQ(at(*closed, 0), at(*closed, 1));
  }
}

TEST(Arc, UsesTheFewestPiecesOfAtMostAQuarter) {
  for (const auto& [length, points] :
       {std::pair{0.25, 3}, {0.2501, 5}, {-0.5, 5}, {0.51, 7}, {0.9, 9}, {1.0, 9}}) {
    const auto curve = curves::arc(1, 0, length);
    ASSERT_TRUE(curve);
    EXPECT_EQ(curve->point_count(), points) << length;
    for (const double weight : curve->weights()) {
      EXPECT_GE(weight, std::sqrt(0.5) - 0x1p-53);
      EXPECT_LE(weight, 1);
    }
  }
}

TEST(Arc, RefusesWhatIsNoArc) {
  EXPECT_EQ(curves::arc(0, 0, 1).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::arc(1, 0, 0).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::arc(1, 0, 1.5).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::arc(1, NAN, 1).error().code, ErrorCode::not_finite);
  EXPECT_EQ(curves::arc(INFINITY, 0, 1).error().code, ErrorCode::not_finite);
  EXPECT_TRUE(curves::arc(1e6, 0, 1))
      << "the polygon of a whole circle from 0 stays within the limits";
  EXPECT_EQ(curves::arc(1e6, 0.125, 1).error().code, ErrorCode::coordinate_out_of_range);
}

TEST(Ellipse, SatisfiesItsEquation) {
  Dice dice(test_seed());
  for (int round = 0; round < 200; ++round) {
    const double a = std::exp2(dice.between(-9, 9)), b = std::exp2(dice.between(-9, 9));
    const auto curve = curves::ellipse(a, b);
    ASSERT_TRUE(curve);
    EXPECT_EQ(at(*curve, 0), (std::array{a, 0.0}));
    EXPECT_EQ(at(*curve, 0.25), (std::array{0.0, b}));
    for (int i = 0; i < 20; ++i) {
      EXPECT_LE(off_circle_ulp(at(*curve, dice.unit()), a, b), 2);
    }
  }
  EXPECT_EQ(curves::ellipse(1, -1).error().code, ErrorCode::value_out_of_range);
}

// The shoulder of a conic, u = 1/2, is at (m + w p1) / (1 + w), m half way from p0 to p2.
TEST(Conic, HasItsShoulderWhereTheShapeFactorSays) {
  const std::vector<double> p0{0, 0}, p1{1, 2}, p2{4, 0};
  for (const double w : {0.25, 1.0, 3.0}) {
    const auto curve = curves::conic(p0, p1, p2, w);
    ASSERT_TRUE(curve);
    const auto xy = at(*curve, 0.5);
    EXPECT_DOUBLE_EQ(xy[0], (2 + w) / (1 + w));
    EXPECT_DOUBLE_EQ(xy[1], 2 * w / (1 + w));
  }
  EXPECT_EQ(curves::conic(p0, p1, p2, 0).error().code, ErrorCode::weight_not_positive);
  EXPECT_EQ(curves::conic(p0, {p1.data(), 1}, p2, 1).error().code, ErrorCode::dimension_mismatch);
}

TEST(Conic, WithAShapeFactorAboveOneIsAHyperbola) {
  // x y = 1 from (1/2, 2) to (2, 1/2): tangents meet at (4/5, 4/5), shoulder (1, 1): w = 5/4.
  const auto curve =
      curves::conic(std::vector{0.5, 2.0}, std::vector{0.8, 0.8}, std::vector{2.0, 0.5}, 1.25);
  ASSERT_TRUE(curve);
  for (int i = 0; i <= 64; ++i) {
    const auto xy = at(*curve, i / 64.0);
    EXPECT_NEAR(xy[0] * xy[1], 1, 0x1p-51);
  }
}

double decay_error_db(const NurbsCurve& curve, double range_db) {
  double worst = 0;
  for (int i = 0; i <= 30011; ++i) {
    const double u = i / 30011.0;
    worst = std::max(worst, std::abs(20 * std::log10(at(curve, u)[0]) + range_db * u));
  }
  return worst;
}

TEST(ExponentialDecay, SaysHowFarItIsFromTheStraightLine) {
  const std::pair<double, double> promised[] = {{1, 1e-12},  {6, 1e-12},  {20, 1e-8}, {40, 5e-5},
                                                {60, 0.001}, {90, 0.035}, {120, 0.45}};
  for (const auto& [range, most] : promised) {
    const auto decay = curves::exponential_decay(range);
    ASSERT_TRUE(decay) << decay.error().message;
    EXPECT_LE(decay->max_error_db, most) << range;
    const double measured = decay_error_db(decay->curve, range);
    EXPECT_LE(measured, decay->max_error_db + 1e-13) << range;
    EXPECT_GE(measured, decay->max_error_db * 0.99 - 1e-13) << range;
  }
}

// Four ripples to either side of the middle, all of one height: no better curve meets both ends.
TEST(ExponentialDecay, HasEvenRipples) {
  for (const double range : {30.0, 60.0, 75.5, 96.0, 120.0}) {
    const auto decay = curves::exponential_decay(range);
    ASSERT_TRUE(decay);
    std::vector<double> ripples{0};
    double before = 0;
    for (int i = 1; i < 20000; ++i) {
      const double u = i / 20000.0;
      const double error = 20 * std::log10(at(decay->curve, u)[0]) + range * u;
      if (error * before < 0) ripples.push_back(0);
      ripples.back() = std::max(ripples.back(), std::abs(error));
      if (error != 0) before = error;
    }
    EXPECT_EQ(ripples.size(), 8u) << range;
    const auto [low, high] = std::minmax_element(ripples.begin(), ripples.end());
    EXPECT_LE(*high, *low * 1.01) << range;
  }
}

TEST(ExponentialDecay, FallsFromPointToPointForEveryRange) {
  for (int range = 1; range <= 120; ++range) {
    const auto decay = curves::exponential_decay(range);
    ASSERT_TRUE(decay) << range << ": " << decay.error().message;
    const auto points = decay->curve.points();
    EXPECT_TRUE(std::is_sorted(points.rbegin(), points.rend())) << range;
    EXPECT_EQ(points.size(), 5u);
    EXPECT_EQ(points[0], 1);
    EXPECT_DOUBLE_EQ(points[4], static_cast<double>(std::pow(10.0L, -range / 20.0L)));
  }
  EXPECT_EQ(curves::exponential_decay(0.5).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::exponential_decay(121).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::exponential_decay(NAN).error().code, ErrorCode::value_out_of_range);
}

double css_at(double x1, double y1, double x2, double y2, double time) {
  const auto curve = curves::css_cubic_bezier(x1, y1, x2, y2);
  EXPECT_TRUE(curve);
  const auto program = curves::compile_function(*curve, {.max_error = 1e-9});
  EXPECT_TRUE(program) << program.error().message;
  return program->at_u(time);
}

// Chromium, ui/gfx/geometry/cubic_bezier_unittest.cc, which allows 1.5e-4.
TEST(CssCubicBezier, GivesChromiumsTable) {
  const double ease[] = {0.01136, 0.03978, 0.07978, 0.12803, 0.18235,
                         0.24115, 0.30323, 0.36761, 0.43345, 0.5};
  const double overshoot[] = {-0.08954, -0.15613, -0.19641, -0.20651, -0.18232,
                              -0.11992, -0.01672, 0.12660,  0.30349,  0.5};
  for (std::size_t i = 0; i < std::size(overshoot); ++i) {
    const double time = 0.05 * static_cast<double>(i + 1);
    EXPECT_NEAR(css_at(0.25, 0, 0.75, 1, time), ease[i], 1e-5);
    EXPECT_NEAR(css_at(0.25, 0, 0.75, 1, 1 - time), 1 - ease[i], 1e-5);
    EXPECT_NEAR(css_at(0.5, -1, 0.5, 2, time), overshoot[i], 1e-5);
    EXPECT_NEAR(css_at(0.5, -1, 0.5, 2, 1 - time), 1 - overshoot[i], 1e-5);
  }
  EXPECT_NEAR(css_at(0.5, 1, 0.5, 1, 0.5), 0.875, 1e-9);
  EXPECT_NEAR(css_at(0.5, 2, 0.5, 2, 0.5), 1.625, 1e-9);
  EXPECT_NEAR(css_at(0.5, -1, 0.5, -1, 0.5), -0.625, 1e-9);
}

// 17 digits from a 40-digit solve with mpmath, vertical tangents and x = t^2 among them.
TEST(CssCubicBezier, GivesTheNamedEasingsTo9Digits) {
  EXPECT_NEAR(css_at(0.25, 0.1, 0.25, 1, 0.25), 0.40851059135539587, 1e-9);
  EXPECT_NEAR(css_at(0.25, 0.1, 0.25, 1, 0.5), 0.80240338758485699, 1e-9);
  EXPECT_NEAR(css_at(0.25, 0.1, 0.25, 1, 0.75), 0.96045897834897408, 1e-9);
  EXPECT_NEAR(css_at(0.42, 0, 1, 1, 0.5), 0.3153568125725393, 1e-9);
  EXPECT_NEAR(css_at(0, 0, 0.58, 1, 0.5), 0.6846431874274607, 1e-9);
  EXPECT_NEAR(css_at(0.42, 0, 0.58, 1, 0.25), 0.12916193104731981, 1e-9);
  EXPECT_NEAR(css_at(0, 1, 0, 1, 0.001), 0.271, 1e-9);
  EXPECT_NEAR(css_at(1, 0, 0, 1, 0.25), 0.029724605511925197, 1e-9);
  EXPECT_NEAR(css_at(0, 0, 1.0 / 3, 1, 0.25), 0.5, 1e-9);
}

TEST(CssCubicBezier, RefusesTimeThatMayGoBack) {
  EXPECT_EQ(curves::css_cubic_bezier(-0.1, 0, 1, 1).error().code, ErrorCode::not_a_function);
  EXPECT_EQ(curves::css_cubic_bezier(0, 0, 1.1, 1).error().code, ErrorCode::not_a_function);
  EXPECT_EQ(curves::css_cubic_bezier(0, NAN, 1, 1).error().code, ErrorCode::not_finite);
}

struct HermiteData {
  std::vector<double> times, values, in, out;
};
HermiteData random_hermite(Dice& dice, int dim) {
  HermiteData data;
  double time = dice.between(-5, 5);
  for (int n = 2 + dice.below(8); n > 0; --n, time += dice.between(0.01, 2)) {
    data.times.push_back(time);
    const bool corner = dice.one_in(3);
    for (int c = 0; c < dim; ++c) {
      data.values.push_back(dice.between(-1, 1));
      data.in.push_back(dice.between(-4, 4));
      data.out.push_back(corner ? dice.between(-4, 4) : data.in.back());
    }
  }
  return data;
}

// glTF 2.0, Appendix C.5: the cubic spline sampler.
TEST(Hermite, IsTheCubicSplineOfGltf) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(1000); ++round) {
    const int dim = 1 + dice.below(2);
    const auto size = static_cast<std::size_t>(dim);
    const HermiteData data = random_hermite(dice, dim);
    const auto curve = curves::hermite(data.times, data.values, data.in, data.out, dim);
    ASSERT_TRUE(curve) << curve.error().message;
    const double allowed = 4 * ulp_of(largest_coordinate(*curve));
    for (std::size_t k = 0; k + 1 < data.times.size(); ++k) {
      const double u = dice.between(data.times[k], data.times[k + 1]);
      const Wide step = Wide(data.times[k + 1]) - data.times[k],
                 t = (Wide(u) - data.times[k]) / step;
      const Wide t2 = t * t, t3 = t2 * t;
      for (std::size_t c = 0; c < size; ++c) {
        const std::size_t a = k * size + c, b = a + size;
        const Wide wanted = (2 * t3 - 3 * t2 + 1) * data.values[a] +
                            step * (t3 - 2 * t2 + t) * data.out[a] +
                            (3 * t2 - 2 * t3) * data.values[b] + step * (t3 - t2) * data.in[b];
        EXPECT_NEAR(at(*curve, u)[c], static_cast<double>(wanted), allowed);
      }
    }
  }
}

TEST(Hermite, HasTheGivenSlopesOnEitherSideOfEachTime) {
  Dice dice(test_seed());
  for (int round = 0; round < 200; ++round) {
    const HermiteData data = random_hermite(dice, 1);
    const auto curve = curves::hermite(data.times, data.values, data.in, data.out);
    ASSERT_TRUE(curve);
    std::size_t points = 2;
    for (std::size_t k = 0; k < data.times.size(); ++k) {
      double out[2];
      if (k > 0) {
        curve->derivatives(data.times[k], 1, Side::left, out);
        EXPECT_NEAR(out[0], data.values[k], 1e-14);
        EXPECT_NEAR(out[1], data.in[k], 1e-10);
        points += 2;
      }
      if (k + 1 < data.times.size()) {
        curve->derivatives(data.times[k], 1, Side::right, out);
        EXPECT_NEAR(out[1], data.out[k], 1e-10);
        if (k > 0 && data.in[k] != data.out[k]) ++points;
      }
    }
    EXPECT_EQ(static_cast<std::size_t>(curve->point_count()), points) << "C1 costs 2 points";
  }
}

TEST(Hermite, NamesWhatIsWrong) {
  const std::vector<double> two{0, 1}, three{0, 1, 2}, back{1, 1};
  EXPECT_EQ(curves::hermite({two.data(), 1}, two, two, two).error().code,
            ErrorCode::too_few_points);
  EXPECT_EQ(curves::hermite(two, two, three, two).error().code, ErrorCode::dimension_mismatch);
  EXPECT_EQ(curves::hermite(two, two, two, two, 0).error().code, ErrorCode::dimension_mismatch);
  const auto stands = curves::hermite(back, two, two, two);
  EXPECT_EQ(stands.error().code, ErrorCode::knots_decrease);
  EXPECT_EQ(stands.error().message, "a Hermite curve: time 1 (1) is not above time 0 (1)");
  EXPECT_EQ(curves::hermite(two, std::vector<double>{0.0, NAN}, two, two).error().code,
            ErrorCode::not_finite);
}

// Barry & Goldman, A recursive evaluation algorithm for a class of Catmull-Rom splines (1988): the
// pyramid over four points, in quadruple precision but for the distances.
Wide barry_goldman(const Wide (&t)[4], const Wide (&p)[4], Wide at_time) {
  const auto fade = [at_time](Wide a, Wide b, Wide from, Wide to) {
    return (a * (to - at_time) + b * (at_time - from)) / (to - from);
  };
  const Wide a1 = fade(p[0], p[1], t[0], t[1]), a2 = fade(p[1], p[2], t[1], t[2]);
  const Wide a3 = fade(p[2], p[3], t[2], t[3]);
  return fade(fade(a1, a2, t[0], t[2]), fade(a2, a3, t[1], t[3]), t[1], t[2]);
}

TEST(CatmullRom, IsThePyramidOfBarryAndGoldman) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(500); ++round) {
    const double alpha = round % 4 == 0 ? dice.unit() : (round % 4 - 1) / 2.0;
    const std::size_t n = static_cast<std::size_t>(4 + dice.below(6));
    const bool closed = dice.one_in(2);
    std::vector<double> points;
    for (std::size_t i = 0; i < 2 * n; ++i) points.push_back(dice.between(-1, 1));
    const auto curve = curves::catmull_rom(points, 2, alpha, closed);
    ASSERT_TRUE(curve) << curve.error().message;
    std::vector<double> times{0};
    const std::size_t steps = closed ? n : n - 1;
    for (std::size_t i = 0; i < steps; ++i) {
      const std::size_t a = 2 * i, b = 2 * ((i + 1) % n);
      const double d = std::hypot(points[b] - points[a], points[b + 1] - points[a + 1]);
      times.push_back(times.back() + std::pow(d, alpha));
    }
    for (std::size_t i = closed ? 0 : 1; i + (closed ? 0 : 1) < steps; ++i) {
      const double u = dice.unit();
      for (std::size_t c = 0; c < 2; ++c) {
        Wide t[4], p[4];
        for (std::size_t k = 0; k < 4; ++k) {
          const std::size_t j = i + k + n - 1;  // n more than the point meant
          p[k] = points[2 * (j % n) + c];
          const std::size_t place = j - n;  // wraps below for the point before the first
          t[k] = i + k == 0      ? Wide(times[n - 1]) - times[n]
                 : place > steps ? Wide(times[steps]) + times[place - steps]
                                 : Wide(times[place]);
        }
        const Wide wanted = barry_goldman(t, p, t[1] + Wide(u) * (t[2] - t[1]));
        const double where = static_cast<double>((t[1] + Wide(u) * (t[2] - t[1])) / times[steps]);
        EXPECT_NEAR(at(*curve, where)[c], static_cast<double>(wanted), 2e-12);
      }
    }
  }
}

TEST(CatmullRom, GoesThroughItsPointsAndClosesSmoothly) {
  const std::vector<double> points{0, 0, 1, 0, 1, 2, -1, 1};
  const auto closed = curves::catmull_rom(points, 2, 0, true);
  ASSERT_TRUE(closed);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto xy = at(*closed, static_cast<double>(i) / 4);
    EXPECT_NEAR(xy[0], points[2 * i], 1e-15);
    EXPECT_NEAR(xy[1], points[2 * i + 1], 1e-15);
  }
  double start[4], end[4];
  closed->derivatives(0, 1, Side::right, start);
  closed->derivatives(1, 1, Side::left, end);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(start[i], end[i], 1e-13);
}

TEST(CatmullRom, OfThreePointsOnAParabolaIsTheParabola) {
  const std::vector<double> points{0, 1, 4};
  const auto curve = curves::catmull_rom(points, 1, 0);
  ASSERT_TRUE(curve);
  for (int i = 0; i <= 20; ++i) {
    EXPECT_NEAR(at(*curve, i / 20.0)[0], 4 * (i / 20.0) * (i / 20.0), 1e-15);
  }
  const auto line = curves::catmull_rom(std::vector<double>{1, 3}, 1);
  ASSERT_TRUE(line);
  EXPECT_NEAR(at(*line, 0.25)[0], 1.5, 1e-15);
}

TEST(CatmullRom, NamesWhatIsWrong) {
  const std::vector<double> twice{0, 0, 1, 1, 1, 1};
  EXPECT_EQ(curves::catmull_rom(twice, 2).error().code, ErrorCode::knots_decrease);
  EXPECT_TRUE(curves::catmull_rom(twice, 2, 0));
  EXPECT_EQ(curves::catmull_rom(twice, 2, 1.5).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(curves::catmull_rom(twice, 4).error().code, ErrorCode::dimension_mismatch);
  EXPECT_EQ(curves::catmull_rom({twice.data(), 2}, 1, 0, true).error().code,
            ErrorCode::too_few_points);
  EXPECT_FALSE(curves::catmull_rom(std::vector<double>{0.0, NAN, 1.0}, 1));
}

}  // namespace
}  // namespace knotwave::test

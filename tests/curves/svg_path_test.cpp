// SPDX-License-Identifier: MIT
// Path data, read as SVG 2 says and written within the error asked for.
#include "knotwave/curves/svg_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "knotwave/curves/shapes.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::curves_from_svg_path;
using curves::NurbsCurve;
using curves::svg_path_from_curve;
using curves::SvgY;
using support::test_count;
using support::test_seed;

std::array<double, 2> at(const NurbsCurve& curve, double u) {
  std::array<double, 2> xy{};
  curve.evaluate(u, std::span(xy).first(static_cast<std::size_t>(curve.dim())));
  return xy;
}

std::vector<NurbsCurve> read(std::string_view d, SvgY y = SvgY::down) {
  auto curves = curves_from_svg_path(d, y);
  EXPECT_TRUE(curves) << d << ": " << curves.error().message;
  return curves ? std::move(*curves) : std::vector<NurbsCurve>{};
}

void expect_points(const NurbsCurve& curve, std::vector<double> wanted) {
  EXPECT_TRUE(std::ranges::equal(curve.points(), wanted)) << ::testing::PrintToString(
      std::vector<double>(curve.points().begin(), curve.points().end()));
}

// The examples of SVG 2, 9.3, and what their figures show.
TEST(SvgPath, ReadsTheExamplesOfTheSpecification) {
  const auto triangle = read("M 100 100 L 300 100 L 200 300 z");
  ASSERT_EQ(triangle.size(), 1u);
  EXPECT_EQ(triangle[0].degree(), 1);
  expect_points(triangle[0], {100, 100, 300, 100, 200, 300, 100, 100});
  const auto wave = read("M100,200 C100,100 250,100 250,200 S400,300 400,200");
  expect_points(wave.at(0), {100, 200, 100, 100, 250, 100, 250, 200, 250, 300, 400, 300, 400, 200});
  EXPECT_EQ(at(wave.at(0), 1), (std::array{250.0, 200.0})) << "segment i is u in i..i+1";
  const auto quadratic = read("M200,300 Q400,50 600,300 T1000,300");
  EXPECT_EQ(quadratic.at(0).degree(), 2);
  expect_points(quadratic.at(0), {200, 300, 400, 50, 600, 300, 800, 550, 1000, 300});
}

TEST(SvgPath, ReadsRelativeCommandsLikeAbsoluteOnes) {
  const auto absolute = read(
      "M 10 20 L 30 40 H 50 V 10 C 1 2 3 4 5 6 S 7 8 9 10 Q 11 12 13 14 T 15 16 Z M 1 1 L 2 2");
  const auto relative = read(
      "m 10 20 l 20 20 h 20 v -30 c -49 -8 -47 -6 -45 -4 s 2 2 4 4 q 2 2 4 4 t 2 2 z m -9 -19 l 1 "
      "1");
  ASSERT_EQ(absolute.size(), 2u);
  ASSERT_EQ(relative.size(), 2u);
  EXPECT_EQ(absolute[0], relative[0]);
  EXPECT_EQ(absolute[1], relative[1]);
  EXPECT_EQ(absolute[0].degree(), 3);
  EXPECT_EQ(absolute[0].u_max(), 8) << "Z has a way to go back";
}

TEST(SvgPath, ReadsNumbersWithoutSpaceBetween) {
  EXPECT_EQ(read("M10-5.5L.5.25+1e1,-.5e-1"), read("M 10 -5.5 L 0.5 0.25 L 10 -0.05"));
}

TEST(SvgPath, GoesOnWithTheSameCommandAndWithLinesAfterAMove) {
  EXPECT_EQ(read("M0 0 1 1 2 0"), read("M0 0L1 1L2 0"));
  EXPECT_EQ(read("m1 1 1 1 2 0z"), read("M1 1L2 2L4 2L1 1"));
  EXPECT_EQ(read("M0 0C1 1 2 2 3 3 4 4 5 5 6 6"), read("M0 0C1 1 2 2 3 3C4 4 5 5 6 6"));
}

TEST(SvgPath, TurnsYUpForTheEar) {
  const auto up = read("M0 0L1 -3", SvgY::up);
  expect_points(up.at(0), {0, 0, 1, 3});
  expect_points(read("M0 0L1 -3", SvgY::down).at(0), {0, 0, 1, -3});
  EXPECT_EQ(curves_from_svg_path("M0 0L1 -3")->at(0), up[0]) << "as nothing else is said";
}

TEST(SvgPath, BeginsANewSubpathWhereItClosedTheLastOne) {
  const auto curves = read("M1 1L2 1L2 2ZL0 0");
  ASSERT_EQ(curves.size(), 2u);
  expect_points(curves[1], {1, 1, 0, 0});
  EXPECT_EQ(curves[0].name(), "path_1");
  EXPECT_EQ(curves[1].name(), "path_2");
  EXPECT_EQ(read("M5 5M0 0L1 1M7 7").size(), 1u) << "a move alone draws nothing";
}

// SVG 2, 9.3.8: 3/4 of a circle about (300, 200), radius 150.
TEST(SvgPath, ReadsArcsAsExactCircles) {
  const auto pie = read("M300,200 h-150 a150,150 0 1,0 150,-150 z");
  ASSERT_EQ(pie.size(), 1u);
  EXPECT_EQ(pie[0].u_max(), 6) << "line, four arcs, line";
  for (int i = 0; i <= 400; ++i) {
    const auto xy = at(pie[0], 1 + i / 100.0);
    EXPECT_NEAR(std::hypot(xy[0] - 300, xy[1] - 200), 150, 1.5e-13);
  }
  const auto lowest = at(pie[0], 2.0 + 1.0 / 3);  // it goes down and round: y above 200 there
  EXPECT_GT(lowest[1], 200);
  const auto joined = read("M0 0A5 5 0 0110 0");  // flags need no space
  EXPECT_NEAR(at(joined.at(0), 1)[1], -5, 1e-14) << "positive angles turn from x to y";
}

// Judged without the formulas of the specification: on the unit circle, the points of an arc have
// one centre, turn one way, and go more than half a turn or less.
TEST(SvgPath, ReadsRotatedEllipticalArcsByTheirDefinition) {
  Dice dice(test_seed());
  for (int round = 0; round < test_count(500); ++round) {
    const double rx = dice.between(1, 5), ry = dice.between(1, 5), turn = dice.between(-400, 400);
    const bool large = dice.one_in(2), sweep = dice.one_in(2);
    const double x0 = dice.between(-9, 9), y0 = dice.between(-9, 9);
    const double dx = dice.between(-0.7, 0.7), dy = dice.between(-0.7, 0.7);
    const std::string d = "M" + std::to_string(x0) + " " + std::to_string(y0) + "a" +
                          std::to_string(rx) + " " + std::to_string(ry) + " " +
                          std::to_string(turn) + (large ? " 1" : " 0") + (sweep ? " 1 " : " 0 ") +
                          std::to_string(dx) + " " + std::to_string(dy);
    const auto curves = read(d);
    ASSERT_EQ(curves.size(), 1u);
    const double angle = turn * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    std::vector<std::array<double, 2>> unit;
    for (int i = 0; i <= 64; ++i) {
      const auto xy = at(curves[0], curves[0].u_max() * i / 64);
      unit.push_back({(c * xy[0] + s * xy[1]) / rx, (c * xy[1] - s * xy[0]) / ry});
    }
    // Centre: where the perpendiculars of two chords meet.
    const auto [ax, ay] = unit[0];
    const double bx = unit[24][0] - ax, by = unit[24][1] - ay;
    const double ex = unit[48][0] - ax, ey = unit[48][1] - ay;
    const double cross = 2 * (bx * ey - by * ex);
    const double cx = (ey * (bx * bx + by * by) - by * (ex * ex + ey * ey)) / cross;
    const double cy = (bx * (ex * ex + ey * ey) - ex * (bx * bx + by * by)) / cross;
    double turned = 0;
    for (std::size_t i = 0; i < unit.size(); ++i) {
      const double px = unit[i][0] - ax - cx, py = unit[i][1] - ay - cy;
      EXPECT_NEAR(std::hypot(px, py), 1, 1e-4) << d;  // to_string has 6 digits
      if (i == 0) continue;
      const double qx = unit[i - 1][0] - ax - cx, qy = unit[i - 1][1] - ay - cy;
      turned += std::atan2(qx * py - qy * px, qx * px + qy * py);
    }
    EXPECT_EQ(turned > 0, sweep) << d;
    EXPECT_EQ(std::abs(turned) > std::numbers::pi, large) << d;
  }
}

TEST(SvgPath, EnlargesRadiiThatAreTooSmallAndDrawsALineForRadiusZero) {
  const auto half = read("M0 0A1 1 0 0 1 10 0");  // radius 5 is the least
  for (int i = 0; i <= 20; ++i) {
    const auto xy = at(half.at(0), half[0].u_max() * i / 20);
    EXPECT_NEAR(std::hypot(xy[0] - 5, xy[1]), 5, 1e-14);
  }
  EXPECT_EQ(read("M0 0A0 5 0 0 1 10 0"), read("M0 0L10 0"));
  EXPECT_EQ(read("M0 0A5 5 0 0 1 0 0L1 1"), read("M0 0L1 1")) << "an arc to where it is";
}

TEST(SvgPath, NamesThePlaceOfAFault) {
  const std::tuple<std::string_view, ErrorCode, long long> faults[] = {
      {"L 1 1", ErrorCode::syntax, 1},
      {"M 1 1 L 2", ErrorCode::syntax, 9},
      {"M 1 1 X 2 2", ErrorCode::syntax, 7},
      {"M 1 1 L 2,,2", ErrorCode::syntax, 10},
      {"M 1 1 A 5 5 0 2 1 3 3", ErrorCode::syntax, 14},
      {"M 1 1 L nan 2", ErrorCode::syntax, 8},
      {"M 1 1 L 2 2 #", ErrorCode::syntax, 12},
      {"M 1 1 L 1e7 2", ErrorCode::coordinate_out_of_range, 8},
      {"M 1 1 L 1e999 2", ErrorCode::coordinate_out_of_range, 8},
      {"M 1 1 Z 5", ErrorCode::syntax, 8}};
  for (const auto& [d, code, offset] : faults) {
    const auto curves = curves_from_svg_path(d);
    ASSERT_FALSE(curves) << d;
    EXPECT_EQ(curves.error().code, code) << d << ": " << curves.error().message;
    EXPECT_EQ(curves.error().offset, offset) << d << ": " << curves.error().message;
  }
  EXPECT_EQ(curves_from_svg_path("").error().code, ErrorCode::too_few_points);
  EXPECT_EQ(curves_from_svg_path("M 1 1").error().code, ErrorCode::too_few_points);
  EXPECT_EQ(curves_from_svg_path("M 9e5 0 l 9e5 0").error().code,
            ErrorCode::coordinate_out_of_range);
}

TEST(SvgPath, NumbersThatNoDoubleHoldsAre0OrTooLarge) {
  const std::string zeros(400, '0');
  const std::string tiny[] = {"1e-400",           "-1E-400",
                              "0.00001e-330",     ".5e-99999999999999999999",
                              "0." + zeros + "1", "0." + zeros + "1e+3"};
  for (const std::string& number : tiny) {
    expect_points(read("M0 0L1 " + number).at(0), {0, 0, 1, 0});
  }
  EXPECT_EQ(read("M0 0L1 1" + zeros + "e-400").at(0), read("M0 0L1 1").at(0)) << "a plain 1";
  const std::pair<std::string, std::string> large[] = {
      {"1e400", "1e400"},
      {"-2e+400", "-2e+400"},
      {"1e99999999999999999999", "1e99999999999999999999"},
      {"1" + zeros, "1" + zeros.substr(0, 23) + "..."},
      {"1" + zeros + "e-1", "1" + zeros.substr(0, 23) + "..."},
      {"1e7", "1e+07"}};
  for (const auto& [number, shown] : large) {
    const auto curves = curves_from_svg_path("M0 0L1 " + number);
    ASSERT_FALSE(curves) << number;
    EXPECT_EQ(curves.error().code, ErrorCode::coordinate_out_of_range);
    EXPECT_EQ(curves.error().message, "path data: " + shown + " is beyond 1e+06");
    EXPECT_EQ(curves.error().offset, 7);
  }
}

TEST(SvgPath, StretchesADrawnLineOntoTheUnitSquare) {
  const auto line = in_unit_square(read("M 10,50 C 10,10 20,0 50,0", SvgY::up)[0]);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->points()[0], 0);
  EXPECT_EQ(line->points()[1], 0);
  EXPECT_EQ(line->points()[6], 1);
  EXPECT_EQ(line->points()[7], 1);
  const auto level = in_unit_square(read("M 3,4 H 5", SvgY::up)[0]);
  EXPECT_EQ(level->points()[1], 0);
  EXPECT_EQ(level->points()[3], 0);
  const auto circle = in_unit_square(*curves::ellipse(3, 200));
  for (int i = 0; i <= 1000; ++i) {
    const auto xy = at(*circle, i / 1000.0);
    EXPECT_NEAR(std::hypot(xy[0] - 0.5, xy[1] - 0.5), 0.5, 4 * 0x1p-53);
  }
}

TEST(SvgPath, WritesCubicsThatReadBackToTheBit) {
  const char* const d = "M 0,0 C 0.1,-0.7 0.3,1e-9 1,2 C 3,4 0.1,0.2 -7,0.30000000000000004";
  const auto path = svg_path_from_curve(read(d).at(0), 1e-12, SvgY::down);
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(read(path->d), read(d));
  EXPECT_EQ(svg_path_from_curve(read("M0 0L1 1L2 0Z", SvgY::up).at(0), 1e-9)->d,
            "M 0,0 L 1,1 L 2,0 L 0,0 Z");
}

// A value over u: x of the path says which u each of its points belongs to.
TEST(SvgPath, StaysWithinTheErrorForAnyCurve) {
  Dice dice(test_seed());
  int written = 0;
  for (int round = 0; round < test_count(60); ++round) {
    auto spec = random_spec(dice, 1 + dice.below(5));
    if (spec.dim != 1) continue;
    const auto curve = NurbsCurve::create(spec);
    ASSERT_TRUE(curve);
    const double size = std::max(largest_coordinate(*curve), std::abs(curve->u_max()));
    const double asked = size * std::pow(10, dice.between(-4, -2));
    const auto path = svg_path_from_curve(*curve, asked, SvgY::down);
    if (!path) {
      EXPECT_EQ(path.error().code, ErrorCode::error_bound_missed);
      continue;
    }
    EXPECT_LE(path->max_error, asked);
    const auto drawn = curves_from_svg_path(path->d, SvgY::down);
    if (!drawn) continue;  // longer than a curve may be
    ++written;
    for (const NurbsCurve& part : *drawn) {
      for (double segment = 0; segment < part.u_max(); ++segment) {
        for (const double t : {0.1, 0.3, 0.5, 0.8}) {
          const auto xy = at(part, segment + t);
          EXPECT_NEAR(at(*curve, xy[0])[0], xy[1], path->max_error + size * 1e-9);
        }
      }
    }
  }
  EXPECT_GT(written, 5);
}

TEST(SvgPath, WritesACircleWithinTheErrorItStates) {
  const auto circle = curves::ellipse(100, 100);
  ASSERT_TRUE(circle);
  const std::pair<double, int> cases[] = {{1, 8}, {1.0 / 16, 16}, {1e-3, 64}, {1e-6, 256}};
  for (const auto& [asked, cubics] : cases) {
    const auto path = svg_path_from_curve(*circle, asked);
    ASSERT_TRUE(path) << path.error().message;
    EXPECT_EQ(path->d.back(), 'Z');
    EXPECT_EQ(std::count(path->d.begin(), path->d.end(), 'C'), cubics);
    EXPECT_LE(path->max_error, asked);
    double worst = 0;
    const auto curves = read(path->d, SvgY::up);
    ASSERT_EQ(curves.size(), 1u);
    const NurbsCurve& drawn = curves[0];
    for (int i = 0; i <= 2000; ++i) {
      const auto xy = at(drawn, drawn.u_max() * i / 2000);
      worst = std::max(worst, std::abs(std::hypot(xy[0], xy[1]) - 100));
    }
    EXPECT_LE(worst, path->max_error + 1e-13);
  }
}

TEST(SvgPath, WritesAValueOverUAndBeginsAgainAtAJump) {
  curves::CurveSpec spec;
  spec.degree = 1;
  spec.points = {0, 1, 3, 2};
  spec.knots = {0, 0, 0.5, 0.5, 1, 1};
  spec.jumps = {0.5};
  const auto path = svg_path_from_curve(*NurbsCurve::create(spec), 1e-9, SvgY::down);
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(path->d, "M 0,0 L 0.5,1 M 0.5,3 L 1,2");
}

TEST(SvgPath, RefusesWhatCannotBeWritten) {
  curves::CurveSpec spec;
  spec.degree = 1;
  spec.dim = 3;
  spec.points = {0, 0, 0, 1, 1, 1};
  const auto solid = NurbsCurve::create(spec);
  EXPECT_EQ(svg_path_from_curve(*solid, 1).error().code, ErrorCode::dimension_mismatch);
  const auto circle = curves::ellipse(1, 1);
  EXPECT_EQ(svg_path_from_curve(*circle, 0).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(svg_path_from_curve(*circle, NAN).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(svg_path_from_curve(*circle, 1e-18).error().code, ErrorCode::error_bound_missed);
}

}  // namespace
}  // namespace knotwave::test

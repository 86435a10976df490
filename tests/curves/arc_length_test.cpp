// SPDX-License-Identifier: MIT
// arc_length() and parameter_at_length() of calculus.h; figures of 30 digits:
// analysis_references_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/reparametrize.h"
#include "knotwave/curves/shapes.h"

#include "example_curve.h"
#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

NurbsCurve path(int degree, std::vector<double> points, std::vector<double> knots = {},
                std::vector<double> jumps = {}) {
  CurveSpec spec = spec_of(degree, std::move(points), std::move(knots));
  spec.dim = 2;
  spec.jumps = std::move(jumps);
  return made(std::move(spec));
}

double length_of(const NurbsCurve& curve, double u_a, double u_b) {
  const auto length = arc_length(curve, u_a, u_b);
  EXPECT_TRUE(length) << (length ? "" : length.error().message);
  return length ? *length : -1;
}
double length_of(const NurbsCurve& curve) { return length_of(curve, curve.u_min(), curve.u_max()); }

double distance(const NurbsCurve& curve, double a, Side side_a, double b, Side side_b) {
  double p[curves::kMaxDim], q[curves::kMaxDim];
  curve.evaluate(a, side_a, p);
  curve.evaluate(b, side_b, q);
  double square = curve.dim() == 1 ? (b - a) * (b - a) : 0;
  for (int c = 0; c < curve.dim(); ++c) square += (p[c] - q[c]) * (p[c] - q[c]);
  return std::sqrt(square);
}

TEST(ArcLength, OfLinesCirclesAndParabolas) {
  EXPECT_EQ(length_of(path(1, {0, 0, 3, 4})), 5);
  EXPECT_EQ(length_of(path(3, {0, 0, 1, 0, 5, 0, 6, 0})), 6);
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(length_of(*curves::ellipse(1, 1)), 2 * kPi, 4e-15);
  EXPECT_NEAR(length_of(*curves::arc(3, 0.1, -0.25)), 3 * kPi / 2, 4e-15);
  // y = x^2 over 0..1, as a path and as a graph: sqrt(5) / 2 + asinh(2) / 4.
  const double parabola = std::sqrt(5.0) / 2 + std::asinh(2.0) / 4;
  EXPECT_NEAR(length_of(path(2, {0, 0, 0.5, 0, 1, 1})), parabola, 1e-15);
  EXPECT_NEAR(length_of(scalar(2, {0, 0, 1})), parabola, 1e-15);
  EXPECT_EQ(length_of(scalar(1, {7, 7}, {2, 2, 5, 5})), 3);
}

// Octave's NURBS toolbox, nrbmeasure.m: a part of a circle of radius 1 and a quarter of radius 1.
TEST(ArcLength, IsThatOfOctavesExamples) {
  EXPECT_NEAR(length_of(*curves::arc(1, 0, 1 / 6.0)), std::numbers::pi / 3, 1e-15);
  EXPECT_NEAR(length_of(*curves::arc(1, 0, 0.25)), std::numbers::pi / 2, 1e-15);
}

// (t^2, t^3) has a cusp at 0: ((4 + 9 t^2)^1.5 - 8) / 27 from there to t.
TEST(ArcLength, PassesCuspsAndRests) {
  const double arm = (std::pow(13, 1.5) - 8) / 27;
  const NurbsCurve half = path(3, {0, 0, 0, 0, 1 / 3.0, 0, 1, 1});
  EXPECT_NEAR(length_of(half), arm, 1e-15);
  // Over -1..1, the cusp inside: blossoms of t^2 and t^3.
  const NurbsCurve whole = path(3, {1, -1, -1 / 3.0, 1, -1 / 3.0, -1, 1, 1});
  EXPECT_NEAR(length_of(whole), 2 * arm, 1e-14);
  EXPECT_NEAR(length_of(whole, 0, 0.5), arm, 1e-14);
  // There and back along a line: the speed changes sign within.
  EXPECT_NEAR(length_of(path(2, {0, 0, 1, 0, 0, 0})), 1, 1e-15);
  // Standing still for a span, and altogether.
  const NurbsCurve rest = path(1, {0, 0, 1, 0, 1, 0, 1, 2}, {0, 0, 1, 2, 3, 3});
  EXPECT_EQ(length_of(rest), 3);
  EXPECT_EQ(length_of(rest, 1, 2), 0);
  EXPECT_EQ(*parameter_at_length(rest, 1), 1) << "the first of all places";
  EXPECT_EQ(*parameter_at_length(rest, 2), 2.5);
  EXPECT_EQ(length_of(path(2, {1, 1, 1, 1, 1, 1})), 0);
}

TEST(ArcLength, JumpsAddNothingAndEitherSideIsAtTheirPlace) {
  const NurbsCurve two = path(1, {0, 0, 1, 0, 5, 5, 5, 7}, {0, 0, 0.5, 0.5, 1, 1}, {0.5});
  EXPECT_EQ(length_of(two), 3);
  EXPECT_EQ(length_of(two, 0, 0.5), 1);
  EXPECT_EQ(length_of(two, 0.5, 1), 2);
  EXPECT_EQ(length_of(two, 0.75, 0.25), 1.5);
  EXPECT_EQ(*parameter_at_length(two, 1), 0.5);
  EXPECT_EQ(*parameter_at_length(two, 2), 0.75);
}

TEST(ArcLength, LiesBetweenChordsAndControlPolygonAndAddsUp) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(600); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double size = polygon_length(curve), rounding = 0x1p-50 * size;
    const double whole = length_of(curve);
    ASSERT_LE(whole, size + rounding) << round;
    double a = dice.between(curve.u_min(), curve.u_max());
    double b = dice.between(curve.u_min(), curve.u_max());
    if (a > b) std::swap(a, b);
    const double before = length_of(curve, curve.u_min(), a), between = length_of(curve, b, a),
                 after = length_of(curve, b, curve.u_max());
    const double error = std::abs(before + between + after - whole) / rounding;
    worst = std::max(worst, error);
    ASSERT_LE(error, 1) << round;
    ASSERT_GE(between, distance(curve, a, Side::right, b, Side::left) - 2 * rounding) << round;
  }
  std::printf("parts and whole differ by %.3f of 2^-50 of the polygon at worst\n", worst);
}

TEST(ArcLength, StaysWhenTheCurveIsWrittenOtherwise) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(200); ++round) {
    CurveSpec spec = random_spec(dice, 1 + dice.below(5));
    spec.dim = 2;
    spec.points.resize(spec.points.size() / 2 * 2);
    spec.periodic = false;
    spec.knots.clear();
    const std::size_t n = std::max(spec.points.size() / 2, std::size_t(spec.degree) + 1);
    spec.points.resize(2 * n, 0.5);
    spec.weights.clear();
    for (std::size_t i = 0; i < n; ++i) spec.weights.push_back(dice.between(0.2, 4));
    const NurbsCurve curve = made(spec);
    const double length = length_of(curve), slack = 0x1p-44 * polygon_length(curve);
    EXPECT_NEAR(length_of(*reverse(curve)), length, slack);
    EXPECT_NEAR(length_of(*elevate_degree(curve)), length, slack);
    EXPECT_NEAR(length_of(*bend(curve, 1.5)), length, slack);
    EXPECT_NEAR(length_of(*insert_knot(curve, 0.3123)), length, slack);
  }
}

TEST(ParameterAtLength, UndoesArcLength) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < support::test_count(300); ++round) {
    const NurbsCurve curve = random_curve(dice);
    const double whole = length_of(curve), unit = 0x1p-49 * polygon_length(curve);
    const double length = whole * dice.unit();
    const auto u = parameter_at_length(curve, length);
    ASSERT_TRUE(u) << u.error().message;
    const double found = length_of(curve, curve.u_min(), *u);
    // Where the path is fast a double of u is long.
    const double below = std::max(std::nextafter(*u, -1e30), curve.u_min());
    const double above = std::min(std::nextafter(*u, 1e30), curve.u_max());
    const double step = length_of(curve, below, above);
    ASSERT_LE(std::abs(found - length), unit + step) << round;
    if (step < unit) worst = std::max(worst, std::abs(found - length) / unit);
    EXPECT_EQ(*parameter_at_length(curve, whole) <= curve.u_max(), true);
    EXPECT_EQ(*parameter_at_length(curve, 0), curve.u_min());
  }
  std::printf("worst %.3f of 2^-49 of the polygon\n", worst);
}

TEST(ArcLength, SaysWhatIsOutside) {
  const NurbsCurve line = path(1, {0, 0, 3, 4});
  EXPECT_EQ(arc_length(line, 0, 1.5).error().message, "curve 'example': u = 1.5 is outside 0..1");
  EXPECT_EQ(arc_length(line, std::nan(""), 1).error().code, ErrorCode::parameter_out_of_range);
  EXPECT_EQ(parameter_at_length(line, 6).error().message,
            "curve 'example': length 6 is outside 0..5");
  EXPECT_EQ(parameter_at_length(line, -1).error().code, ErrorCode::parameter_out_of_range);
  EXPECT_EQ(parameter_at_length(line, std::nan("")).error().code,
            ErrorCode::parameter_out_of_range);
  EXPECT_EQ(*parameter_at_length(line, 5), 1);
  EXPECT_EQ(*parameter_at_length(line, std::nextafter(5, 6)), 1) << "rounding is forgiven";
}

}  // namespace
}  // namespace knotwave::test

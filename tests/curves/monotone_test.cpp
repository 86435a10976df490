// SPDX-License-Identifier: MIT
#include "knotwave/curves/monotone.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::HandleLengths;
using curves::is_monotone_cubic;
using curves::NurbsCurve;
using curves::Regularization;
using enum curves::Regularization;

constexpr Regularization kRepairs[] = {contain, keep_start, keep_ratio, limit_active,
                                       limit_opposite};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

NurbsCurve timed(std::vector<double> points, std::vector<double> knots = {},
                 std::vector<double> jumps = {}) {
  CurveSpec spec;
  spec.name = "example";
  spec.dim = 2;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.jumps = std::move(jumps);
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

// The places named in OpenUSD's text: corners of the square and of the ellipse.
TEST(MonotoneCubic, NamedPlacesOfTheEllipse) {
  for (const auto& [a, b] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}) {
    EXPECT_TRUE(is_monotone_cubic(a, b)) << a << " " << b;
  }
  const double longest = 4.0 / 3;  // this double is below 4/3, and so is its ellipse
  EXPECT_TRUE(is_monotone_cubic(longest, 1.0 / 3));
  EXPECT_TRUE(is_monotone_cubic(1.0 / 3, longest));
  EXPECT_FALSE(is_monotone_cubic(std::nextafter(longest, 2), 1.0 / 3));
  EXPECT_FALSE(is_monotone_cubic(1.2, 1.2));
  EXPECT_FALSE(is_monotone_cubic(1.2, 0)) << "below the ellipse";
  EXPECT_TRUE(is_monotone_cubic(1.2, 0.5));
  EXPECT_FALSE(is_monotone_cubic(-1e-300, 0.5));
  EXPECT_FALSE(is_monotone_cubic(std::nan(""), 0.5));
  EXPECT_FALSE(is_monotone_cubic(0.5, std::nan("")));
  EXPECT_FALSE(is_monotone_cubic(kInfinity, 0.5));
}

/// a^2 + b^2 + ab - 2a - 2b + 1 of whole numbers over 2^60, times 2^120: exact in 128 bits.
__int128 ellipse(__int128 a, __int128 b) {
  const __int128 one = __int128(1) << 60;
  return a * a + b * b + a * b - 2 * one * a - 2 * one * b + one * one;
}

TEST(MonotoneCubic, IsExactBesideTheEllipse) {
  Dice dice(support::test_seed());
  int inside = 0, outside = 0;
  for (int round = 0; round < support::test_count(100000); ++round) {
    const double a = dice.one_in(2) ? dice.between(1, 4.0 / 3) : dice.between(0x1p-7, 4.0 / 3);
    const double root = std::sqrt(a * (4 - 3 * a));
    double b = 0.5 * ((2 - a) + (dice.one_in(2) ? root : -root));
    for (int steps = dice.below(4); steps > 0; --steps) b = std::nextafter(b, dice.below(3));
    if (b < 0x1p-7 || (a <= 1 && b <= 1)) continue;
    const bool exact = ellipse(static_cast<__int128>(std::ldexp(a, 60)),
                               static_cast<__int128>(std::ldexp(b, 60))) <= 0;
    ASSERT_EQ(is_monotone_cubic(a, b), exact) << a << " " << b;
    ASSERT_EQ(is_monotone_cubic(b, a), exact) << a << " " << b;
    ++(exact ? inside : outside);
  }
  EXPECT_GT(inside, support::test_count(10000));
  EXPECT_GT(outside, support::test_count(10000));
}

TEST(MonotoneCubic, IsExactBesideNothing) {
  for (const double tiny : {5e-324, 1e-310, 1e-200, 0x1p-104}) {
    EXPECT_TRUE(is_monotone_cubic(tiny, 1));
    EXPECT_FALSE(is_monotone_cubic(tiny, std::nextafter(1.0, 2))) << tiny;
    EXPECT_FALSE(is_monotone_cubic(std::nextafter(1.0, 2), tiny)) << tiny;
  }
  // With b = 1 + e, e = 2^-52, and a = e^2 (1 + k e) the sum is e^3 (1 - k) + about 2 e^4.
  const double square = 0x1p-104, one_more = std::nextafter(square, 1);
  EXPECT_FALSE(is_monotone_cubic(one_more, std::nextafter(1.0, 2)));
  EXPECT_TRUE(is_monotone_cubic(std::nextafter(one_more, 1), std::nextafter(1.0, 2)));
}

// OpenUSD, pxr/base/ts/testenv/testTsRegressionPreventer.testenv/baseline: widths in a segment 11
// (1 for the last two) long, which USD keeps 1e-5 of the segment inside the ellipse.
TEST(RegularizeHandles, GivesTheFiguresOfOpenUsd) {
  constexpr double kInside = 1e-5;
  const auto ratio = regularize_handles({15.8 / 11, 3.6665566666666662 / 11}, keep_ratio);
  EXPECT_NEAR(ratio.a, 14.66002966057313 / 11 + kInside, 1e-9);
  EXPECT_NEAR(ratio.b, 3.401930051059418 / 11 + kInside, 1e-9);
  const auto start = regularize_handles({15.8 / 11, 16.8 / 11}, keep_start);
  EXPECT_NEAR(start.a, 14.666556666666665 / 11 + kInside, 1e-9);
  EXPECT_NEAR(start.b, 3.6665566666666662 / 11 + kInside, 1e-9);
  const auto opposite = regularize_handles({0.8, 1.3}, limit_opposite, false);
  EXPECT_EQ(opposite.b, 1.3);
  EXPECT_NEAR(opposite.a, 0x1.0f7f3ae9122b3p-1 + kInside, 1e-9);
  const auto active = regularize_handles({1.3, 0x1.999999999999ap-1}, limit_active);
  EXPECT_NEAR(active.a, 0x1.2a69b463e86acp+0 + kInside, 1e-9);
  EXPECT_EQ(active.b, 0.8);
}

TEST(RegularizeHandles, FringesBehaveAsOpenUsdSays) {
  // Long active handle, short other one: limit_opposite stops the active one on the fringe.
  const auto fringe = regularize_handles({1.3, 0.1}, limit_opposite);
  EXPECT_EQ(fringe.b, 0.1);
  EXPECT_LT(fringe.a, 1.3);
  EXPECT_NEAR(fringe.a, 0.5 * (1.9 + std::sqrt(0.1 * 3.7)), 1e-15);
  // A long other one gives way down to (4/3, 1/3).
  const auto corner = regularize_handles({2, 0.9}, limit_opposite);
  EXPECT_DOUBLE_EQ(corner.a, 4.0 / 3);
  EXPECT_DOUBLE_EQ(corner.b, 1.0 / 3);
  // keep_start lengthens the end there, as Maya does.
  const auto longer = regularize_handles({1.3, 0.1}, keep_start);
  EXPECT_EQ(longer.a, 1.3);
  EXPECT_NEAR(longer.b, 0.5 * (0.7 - std::sqrt(1.3 * 0.1)), 1e-15);
  // limit_active where shortening can't help.
  const auto both = regularize_handles({0.05, 1.32}, limit_active);
  EXPECT_EQ(both.a, 0.05);
  EXPECT_LT(both.b, 1.32);
}

TEST(RegularizeHandles, AreMonotoneOnTheEllipseAndKeptWhenTheyFit) {
  Dice dice(support::test_seed());
  const auto length = [&dice] {
    if (dice.one_in(20)) return dice.one_in(2) ? kInfinity : -1.0;
    if (dice.one_in(4)) return std::ldexp(dice.unit(), dice.below(40) - 20);
    return dice.between(0, 1.7);
  };
  int repaired = 0;
  for (int round = 0; round < support::test_count(20000); ++round) {
    const HandleLengths drawn{length(), length()};
    for (const Regularization mode : kRepairs) {
      const bool start = dice.one_in(2);
      const HandleLengths kept = regularize_handles(drawn, mode, start);
      ASSERT_TRUE(is_monotone_cubic(kept.a, kept.b))
          << drawn.a << " " << drawn.b << " mode " << static_cast<int>(mode);
      const HandleLengths again = regularize_handles(kept, mode, start);
      EXPECT_EQ(kept.a, again.a);
      EXPECT_EQ(kept.b, again.b);
      if (is_monotone_cubic(drawn.a, drawn.b) && mode != contain) {
        EXPECT_EQ(kept.a, drawn.a);
        EXPECT_EQ(kept.b, drawn.b);
        continue;
      }
      if (drawn.a < 0 || drawn.b < 0 || mode == contain) continue;
      // No farther than it must: a little longer and time would go back.
      const double more = 1 + 1e-14;
      const bool edge =
          !is_monotone_cubic(kept.a * more, kept.b) || !is_monotone_cubic(kept.a, kept.b * more) ||
          !is_monotone_cubic(kept.a / more, kept.b) || !is_monotone_cubic(kept.a, kept.b / more);
      EXPECT_TRUE(edge) << drawn.a << " " << drawn.b << " -> " << kept.a << " " << kept.b;
      ++repaired;
    }
  }
  EXPECT_GT(repaired, support::test_count(10000));
}

TEST(Regularize, MonotoneCurvesComeBackToTheBit) {
  const NurbsCurve handles = timed({0, 0, 1, 0.3, 0, 0.7, 1, 1});
  for (const Regularization mode : kRepairs) {
    const auto same = regularize(handles, mode);
    ASSERT_TRUE(same);
    EXPECT_EQ(*same, handles);
  }
  EXPECT_EQ(*regularize(handles, none), handles);
}

TEST(Regularize, ContainAlsoCutsHandlesThatDoNoHarm) {
  const NurbsCurve bold = timed({0, 0, 1.25, 0.5, 0.5, 0.7, 1, 1});
  EXPECT_EQ(*regularize(bold, keep_ratio), bold);
  const auto cut = regularize(bold, contain);
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->points()[2], 1);
  EXPECT_DOUBLE_EQ(cut->points()[3], 0.4) << "y follows x";
}

TEST(Regularize, ContainLeavesNoHandleOutsideNotByABitAndIsDoneOnce) {
  Dice dice(support::test_seed());
  int cut = 0;
  for (int round = 0; round < support::test_count(3000); ++round) {
    const int segments = 1 + dice.below(3);
    const double scale = std::pow(10, dice.between(-6, 4));
    std::vector<double> points, knots(4, 0.0);
    for (int i = 0; i <= 3 * segments; ++i) {
      points.push_back(scale * (i % 3 == 0 ? i : i + dice.between(-3, 3)));
      points.push_back(scale * dice.between(-1, 1));
    }
    for (int i = 1; i < segments; ++i) knots.insert(knots.end(), 3, i);
    knots.insert(knots.end(), 4, segments);
    const NurbsCurve drawn = timed(points, knots);
    const auto kept = regularize(drawn, contain);
    ASSERT_TRUE(kept) << kept.error().message;
    cut += *kept != drawn;
    for (const curves::BezierSegment& s : to_bezier(*kept)) {
      EXPECT_GE(s.points[2], s.points[0]);
      EXPECT_LE(s.points[2], s.points[6]);
      EXPECT_GE(s.points[4], s.points[0]);
      EXPECT_LE(s.points[4], s.points[6]);
    }
    EXPECT_EQ(*regularize(*kept, contain), *kept);
  }
  EXPECT_GT(cut, support::test_count(500));
}

TEST(Regularize, OnlyTheSegmentThatGoesBackChanges) {
  const NurbsCurve curve = timed({0, 0, 0.3, 1, 0.6, 1, 1, 0,  //
                                  3, 4, 0, 1, 2, 2},
                                 {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2});
  EXPECT_FALSE(curves::is_non_decreasing(curve));
  for (const Regularization mode : kRepairs) {
    const auto repaired = regularize(curve, mode);
    ASSERT_TRUE(repaired) << repaired.error().message;
    EXPECT_TRUE(curves::is_non_decreasing(*repaired));
    EXPECT_EQ(repaired->name(), "example");
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(repaired->points()[i], curve.points()[i]);
    const auto p = repaired->points();
    EXPECT_NEAR((p[9] - 0) / (p[8] - 1), 4 / 2.0, 1e-12) << "along the handle";
    EXPECT_NEAR((p[11] - 2) / (p[10] - 2), (1 - 2) / (0 - 2.0), 1e-12);
  }
}

TEST(Regularize, HandlesThatPointBackBecomeNothing) {
  const auto repaired = regularize(timed({0, 0, -1, 1, 0.5, 1, 1, 0}), keep_ratio);
  ASSERT_TRUE(repaired);
  EXPECT_EQ(repaired->points()[2], 0);
  EXPECT_EQ(repaired->points()[3], 0);
  EXPECT_EQ(repaired->points()[4], 0.5);
  // No time at all: a vertical line.
  const auto line = regularize(timed({1, 0, 2, 1, 0, 2, 1, 3}), keep_start);
  ASSERT_TRUE(line);
  EXPECT_TRUE(curves::is_non_decreasing(*line));
}

TEST(Regularize, JumpsInValueKeepTheirSides) {
  const NurbsCurve curve = timed({0, 0, 2, 1, -1, 1, 1, 0, 1, 5, 1.2, 5, 1.5, 6, 2, 7},
                                 {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}, {1});
  const auto repaired = regularize(curve, keep_ratio);
  ASSERT_TRUE(repaired) << repaired.error().message;
  double left[2], right[2];
  repaired->evaluate(1, curves::Side::left, left);
  repaired->evaluate(1, curves::Side::right, right);
  EXPECT_EQ(left[1], 0);
  EXPECT_EQ(right[1], 5);
  ASSERT_EQ(repaired->jumps().size(), 1u);
}

TEST(Regularize, SaysWhatItCannotRepair) {
  const auto ends_early = regularize(timed({1, 0, 2, 1, 2, 1, 0, 0}), keep_ratio);
  ASSERT_FALSE(ends_early);
  EXPECT_EQ(ends_early.error().code, ErrorCode::not_a_function);
  EXPECT_EQ(ends_early.error().message,
            "curve 'example': time goes back from 1 to 0 between u = 0 and 1");
  const auto not_asked = regularize(timed({0, 0, 2, 1, -1, 1, 1, 0}), none);
  EXPECT_EQ(not_asked.error().code, ErrorCode::not_a_function);
  const auto jump_back = regularize(timed({0, 0, 0, 1, 1, 1, 1, 0, 0.9, 5, 1.2, 5, 1.5, 6, 2, 7},
                                          {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}, {1}),
                                    keep_ratio);
  EXPECT_EQ(jump_back.error().code, ErrorCode::not_a_function);
  CurveSpec spec;
  spec.points = {0, 1, 2, 3};
  EXPECT_EQ(regularize(*NurbsCurve::create(spec), contain).error().code,
            ErrorCode::dimension_mismatch);
  spec.degree = 1;
  EXPECT_EQ(regularize(*NurbsCurve::create(spec), contain).error().code, ErrorCode::unsupported);
}

// Cubics with many handles, their ends in order; unclamped and C2 ones too.
TEST(Regularize, NoRandomCurveGoesBackAfterwards) {
  Dice dice(support::test_seed());
  int repaired = 0, refused = 0;
  for (int round = 0; round < support::test_count(10000); ++round) {
    CurveSpec spec;
    spec.dim = 2;
    const int n = 4 + dice.below(8);
    const double wild = dice.one_in(2) ? 0.8 : 3;
    for (int i = 0; i < n; ++i) {
      spec.points.push_back(i + wild * dice.between(-1, 1));
      spec.points.push_back(dice.between(-1, 1));
    }
    if (dice.one_in(3)) {
      for (int i = 0; i < n + 4; ++i) spec.knots.push_back(i);
    }
    auto curve = NurbsCurve::create(spec);
    ASSERT_TRUE(curve);
    const auto good = regularize(*curve, kRepairs[dice.below(5)]);
    if (!good) {
      EXPECT_EQ(good.error().code, ErrorCode::not_a_function);
      ++refused;
      continue;
    }
    repaired += *good != *curve;
    EXPECT_TRUE(curves::is_non_decreasing(*good));
    for (const curves::BezierSegment& s : to_bezier(*good)) {
      EXPECT_LE(s.points[0], s.points[2]);
      EXPECT_LE(s.points[4], s.points[6]);
    }
  }
  std::printf("%d repaired, %d refused\n", repaired, refused);
  EXPECT_GT(repaired, support::test_count(1000));
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Rows that are not exact: rational surfaces, high degrees along v, moved weights.
#include <cstdio>

#include <gtest/gtest.h>

#include "table_cases.h"
#include "waveforms.h"

namespace {

using namespace knotwave::test;  // table_cases.h, waveforms.h

TEST(WaveTables, ARationalSurfaceIsFittedWithinTheErrorItStates) {
  const NurbsSurface surface = morph(true);
  const WaveTables tables = made(WaveTables::create(surface));
  EXPECT_GT(tables.fit_error(), 0);
  EXPECT_LE(tables.fit_error(), 1e-6);
  std::printf("rational surface: %d rows, fit error %.2g\n", tables.rows(), tables.fit_error());
  for (const double position : {0.0, 0.05, 1 / 3.0, 0.41, 0.5, 0.93, 1.0}) {
    const WaveTables truth = made(WaveTables::create(surface.iso_curve_at_v(position)));
    EXPECT_LT(difference(tables, position, truth), 5e-6) << "position " << position;
  }
}

TEST(WaveTables, ADegreeAboveSevenAlongVIsFitted) {
  const NurbsSurface surface = morph(false, 9);
  const WaveTables tables = made(WaveTables::create(surface));
  for (const double position : {0.0, 0.21, 0.6, 1.0}) {
    const WaveTables truth = made(WaveTables::create(surface.iso_curve_at_v(position)));
    EXPECT_LT(difference(tables, position, truth), 5e-6) << "position " << position;
  }
}

TEST(WaveTables, AControlBecomesAPosition) {
  using knotwave::curves::ControlRange;
  auto spec = smooth_spec();
  const auto curve = NurbsCurve::create(spec);
  ASSERT_TRUE(curve);
  ControlRange point;
  point.kind = ControlRange::Kind::coordinate;
  point.point = 5;
  point.low = -1;
  point.high = 3;
  const WaveTables moved = made(WaveTables::create(*curve, point));
  EXPECT_EQ(moved.rows(), 2);
  ControlRange weight;
  weight.point = 5;
  weight.low = 0.1;
  weight.high = 10;
  const WaveTables weighted = made(WaveTables::create(*curve, weight));
  std::printf("weight 0.1 to 10: %d rows, fit error %.2g\n", weighted.rows(), weighted.fit_error());
  for (const double position : {0.0, 0.02, 0.5, 0.9, 1.0}) {
    auto at = spec;
    at.points[5] = -1 + 4 * position;
    EXPECT_LT(difference(moved, position, of_curve(at)), 2e-6) << "point at " << position;
    at = spec;
    at.weights.assign(at.points.size(), 1.0);
    at.weights[5] = 0.1 + 9.9 * position;
    EXPECT_LT(difference(weighted, position, of_curve(at)), 5e-6) << "weight at " << position;
  }
  ControlRange knot;
  knot.kind = ControlRange::Kind::knot;
  knot.point = 5;
  knot.low = 4.2 / 16;
  knot.high = 5.7 / 16;
  const WaveTables shifted = made(WaveTables::create(*curve, knot));
  std::printf("knot between its neighbours: %d rows, fit error %.2g\n", shifted.rows(),
              shifted.fit_error());
  for (const double position : {0.0, 0.1, 0.5, 0.93, 1.0}) {
    auto at = curve->spec();
    at.knots[5] = (4.2 + 1.5 * position) / 16;
    EXPECT_LT(difference(shifted, position, of_curve(at)), 5e-6) << "knot at " << position;
  }
  knot.high = 6.1 / 16;
  EXPECT_FALSE(WaveTables::create(*curve, knot));
  point.point = 16;
  const auto wrong = WaveTables::create(*curve, point);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, "'C2 16 points' has points 0..15, not 16");
}

}  // namespace

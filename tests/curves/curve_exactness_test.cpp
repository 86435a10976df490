// SPDX-License-Identifier: MIT
// Curve values against quadruple precision: "within 4 ulp of max|P|" for any valid curve.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "random_curve.h"
#include "support/seed.h"
#include "wide_value.h"

namespace knotwave::test {
namespace {

using curves::NurbsCurve;
using curves::Side;

struct Worst {
  double evaluate = 0;
  double de_boor = 0;
  double bezier = 0;
};

Worst worst_of_random_curves(int count) {
  Dice dice(support::test_seed());
  Worst worst;
  for (int round = 0; round < count; ++round) {
    const NurbsCurve curve = random_curve(dice, 1 + round % curves::kMaxDegree);
    const auto segments = to_bezier(curve);
    for (int i = 0; i < 2; ++i) {
      const double u = std::clamp(random_parameter(dice, curve), curve.u_min(), curve.u_max());
      double out[curves::kMaxDim];
      for (const Side side : {Side::left, Side::right}) {
        curve.evaluate(u, side, out);
        worst.evaluate = std::max(worst.evaluate, error_in_ulp(curve, u, side, out));
      }
      de_boor(curve, u, out);
      worst.de_boor = std::max(worst.de_boor, error_in_ulp(curve, u, Side::right, out));
      const auto segment =
          std::find_if(segments.rbegin(), segments.rend(), [u](auto& s) { return s.u0 <= u; });
      de_casteljau(*segment, u, out);
      worst.bezier = std::max(worst.bezier, error_in_ulp(curve, u, Side::right, out));
    }
  }
  std::printf("worst of %d curves in ulp of max|P|: evaluate %.3f, de Boor %.3f, Bezier %.3f\n",
              count, worst.evaluate, worst.de_boor, worst.bezier);
  return worst;
}

// Half an ulp is one rounding, and that of a value near max|P|: nothing better can be had.
void expect_correct_to_rounding(const Worst& worst) {
  EXPECT_LE(worst.evaluate, 0.5 + 1e-9);
  EXPECT_LE(worst.de_boor, 0.5 + 1e-9);
  EXPECT_LE(worst.bezier, 4.0);  // points and weights of the segments are rounded as well
}

TEST(CurveExactness, TenThousandRandomCurvesAreRoundedOnce) {
  expect_correct_to_rounding(worst_of_random_curves(support::test_count(10'000)));
}

TEST(CurveExactnessStress, AMillionRandomCurvesAreRoundedOnce) {
  expect_correct_to_rounding(worst_of_random_curves(support::test_count(1'000'000)));
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Curve values against quadruple precision: "within 4 ulp of max|P|" for any valid curve.
//
// Why 113 bits are enough to judge by. The Cox-de Boor recursion with positive weights only adds
// and multiplies numbers that are not negative (knot differences, basis functions, weights). A
// basis function of degree p <= 15 then carries at most 5 roundings a level, 75 in all; weight,
// point, sums and quotient add fewer than 50. So the reference is within 125 * 2^-113 max|P|, below
// 2^-53 of the ulp it is measured in. tests/golden/curves/references.txt judges the same code by
// exact rationals.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::NurbsCurve;
using curves::Side;

#if defined(__SIZEOF_FLOAT128__)
using Wide = __float128;
#else
using Wide = long double;
static_assert(std::numeric_limits<Wide>::digits >= 113, "needs quadruple precision");
#endif

// All basis functions, from degree 0 up, on the span that holds u: the recursion of the definition.
std::vector<Wide> wide_basis(std::span<const double> knots, int degree, double u, Side side) {
  const auto count = knots.size() - std::size_t(degree) - 1;
  std::vector<Wide> basis(knots.size() - 1, Wide(0));
  std::size_t span = 0;
  for (std::size_t i = std::size_t(degree); i < count; ++i) {
    const bool starts = side == Side::left && u > knots[std::size_t(degree)] ? knots[i] < u
                        : u >= knots[count]                                  ? knots[i] < u
                                                                             : knots[i] <= u;
    if (knots[i] < knots[i + 1] && starts) span = i;
  }
  basis[span] = Wide(1);
  for (int p = 1; p <= degree; ++p) {
    for (std::size_t i = 0; i + std::size_t(p) + 1 < knots.size(); ++i) {
      const Wide left = Wide(knots[i]), right = Wide(knots[i + std::size_t(p) + 1]);
      const Wide left_width = Wide(knots[i + std::size_t(p)]) - left;
      const Wide right_width = right - Wide(knots[i + 1]);
      Wide value = Wide(0);
      if (left_width > Wide(0)) value += (Wide(u) - left) / left_width * basis[i];
      if (right_width > Wide(0)) value += (right - Wide(u)) / right_width * basis[i + 1];
      basis[i] = value;
    }
  }
  basis.resize(count);
  return basis;
}

// Error of `computed` in ulp of max|P|, the worst coordinate.
double worst_ulp(const NurbsCurve& curve, double u, Side side, std::span<const double> computed) {
  const std::vector<Wide> basis = wide_basis(curve.knots(), curve.degree(), u, side);
  const double ulp = ulp_of(largest_coordinate(curve));
  double worst = 0;
  for (int c = 0; c < curve.dim(); ++c) {
    Wide sum = Wide(0), total = Wide(0);
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const Wide share = basis[i] * Wide(curve.weights()[i]);
      sum += share * Wide(curve.points()[i * std::size_t(curve.dim()) + std::size_t(c)]);
      total += share;
    }
    const double error = static_cast<double>(Wide(computed[std::size_t(c)]) - sum / total);
    worst = std::max(worst, std::abs(error) / ulp);
  }
  return worst;
}

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
      if (curve.is_periodic() && u == curve.u_max()) continue;  // is u_min, by definition
      double out[curves::kMaxDim];
      curve.evaluate(u, Side::right, out);
      worst.evaluate = std::max(worst.evaluate, worst_ulp(curve, u, Side::right, out));
      de_boor(curve, u, out);
      worst.de_boor = std::max(worst.de_boor, worst_ulp(curve, u, Side::right, out));
      const auto segment =
          std::find_if(segments.rbegin(), segments.rend(), [u](auto& s) { return s.u0 <= u; });
      de_casteljau(*segment, u, out);
      worst.bezier = std::max(worst.bezier, worst_ulp(curve, u, Side::right, out));
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

TEST(CurveExactnessStress, HundredThousandRandomCurvesAreRoundedOnce) {
  expect_correct_to_rounding(worst_of_random_curves(support::test_count(100'000)));
}

}  // namespace
}  // namespace knotwave::test

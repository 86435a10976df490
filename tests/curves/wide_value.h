// SPDX-License-Identifier: MIT
// What a curve is worth at u, by the definition and in quadruple precision.
//
// Why 113 bits are enough to judge by. The Cox-de Boor recursion with positive weights only adds
// and multiplies numbers that are not negative (knot differences, basis functions, weights). A
// basis function of degree p <= 15 then carries at most 5 roundings a level, 75 in all; weight,
// point, sums and quotient add fewer than 50. So the reference is within 125 * 2^-113 max|P|, below
// 2^-53 of the ulp it is measured in. The knots of a periodic curve's neighbouring periods are
// exact sums, which is checked. tests/golden/curves/references.txt judges the same code by exact
// rationals.
#pragma once
#include <span>

#include "knotwave/curves/nurbs_curve.h"

#include "random_curve.h"

namespace knotwave::test {

/// How far `computed` [dim] is from C(u), in ulp of max|P|, the worst coordinate. u in the domain.
double error_in_ulp(const curves::NurbsCurve& curve, double u, curves::Side side,
                    std::span<const double> computed);

/// Farthest that `edited` is over [low, high] from `curve` as evaluated and from what it is in the
/// reals, in ulp of max|P| of `curve`: 10 places, knots and their sides among them.
double distance_ulp(Dice& dice, const curves::NurbsCurve& curve, const curves::NurbsCurve& edited,
                    double low, double high);

}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Curves of every kind for property tests: degrees, knots, weights and coordinates a user may
// write, the nasty ones more often than a user would.
#pragma once
#include <cstdint>
#include <random>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::test {

/// Numbers from a seed, the same everywhere.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [0, 1), all 53 bits.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

/// A valid spec of degree `degree`, or of any degree when it is 0.
curves::CurveSpec random_spec(Dice& dice, int degree = 0);
curves::NurbsCurve random_curve(Dice& dice, int degree = 0);
/// Without weights, degree 1..most_degree.
curves::NurbsCurve plain_curve(Dice& dice, int most_degree);

/// A parameter to try: anywhere, on a knot, beside a knot, at an end.
double random_parameter(Dice& dice, const curves::NurbsCurve& curve);

double largest_coordinate(const curves::NurbsCurve& curve);
/// Of the control polygon; of the graph's, with u, for one coordinate.
double polygon_length(const curves::NurbsCurve& curve);
/// Distance from |x| to the next larger double: what "4 ulp of max|P|" counts in.
double ulp_of(double x);

}  // namespace knotwave::test

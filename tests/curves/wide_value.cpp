// SPDX-License-Identifier: MIT
#include "wide_value.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "random_curve.h"

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

Wide exact_sum(Wide a, Wide b) {
  const Wide sum = a + b;
  EXPECT_TRUE(sum - a == b && sum - b == a) << "these knots need more than 113 bits";
  return sum;
}

// [n+p+1], as written and, for a periodic curve, p more on either side.
std::vector<Wide> wide_knots(const NurbsCurve& curve) {
  const std::vector<double> written = curve.spec().knots;
  std::vector<Wide> knots;
  if (!curve.is_periodic()) {
    knots.assign(curve.knots().begin(), curve.knots().end());
    return knots;
  }
  const std::size_t p = std::size_t(curve.degree()), n = written.size() - 1;
  const Wide period = exact_sum(Wide(written[n]), -Wide(written[0]));
  for (std::size_t i = n - p; i < n; ++i) knots.push_back(exact_sum(Wide(written[i]), -period));
  knots.insert(knots.end(), written.begin(), written.end());
  for (std::size_t i = 1; i <= p; ++i) knots.push_back(exact_sum(Wide(written[i]), period));
  return knots;
}

// The piece that holds u: from its left knot to before its right one, or the other way round.
std::size_t span_of(const std::vector<Wide>& knots, std::size_t degree, double u, Side side) {
  const auto count = knots.size() - degree - 1;
  const bool from_left = u >= knots[count] || (side == Side::left && u > knots[degree]);
  std::size_t span = 0;
  for (std::size_t i = degree; i < count; ++i) {
    if (knots[i] < knots[i + 1] && (from_left ? knots[i] < u : knots[i] <= u)) span = i;
  }
  return span;
}

// All basis functions, from degree 0 up: the recursion of the definition. Those left out are 0.
std::vector<Wide> wide_basis(const std::vector<Wide>& knots, std::size_t degree, std::size_t span,
                             double u) {
  std::vector<Wide> basis(knots.size() - 1, Wide(0));
  basis[span] = Wide(1);
  for (std::size_t p = 1; p <= degree; ++p) {
    for (std::size_t i = span - p; i <= span; ++i) {
      const Wide left = knots[i], right = knots[i + p + 1];
      const Wide left_width = knots[i + p] - left, right_width = right - knots[i + 1];
      Wide value = Wide(0);
      if (left_width > Wide(0)) value += (Wide(u) - left) / left_width * basis[i];
      if (right_width > Wide(0)) value += (right - Wide(u)) / right_width * basis[i + 1];
      basis[i] = value;
    }
  }
  return basis;
}

}  // namespace

double error_in_ulp(const NurbsCurve& curve, double u, Side side,
                    std::span<const double> computed) {
  if (curve.is_periodic() && side == Side::right && u == curve.u_max()) u = curve.u_min();
  if (curve.is_periodic() && side == Side::left && u == curve.u_min()) u = curve.u_max();
  const std::vector<Wide> knots = wide_knots(curve);
  const std::size_t p = std::size_t(curve.degree()), dim = std::size_t(curve.dim());
  const std::size_t span = span_of(knots, p, u, side);
  const std::vector<Wide> basis = wide_basis(knots, p, span, u);
  double worst = 0;
  for (std::size_t c = 0; c < dim; ++c) {
    Wide sum = Wide(0), total = Wide(0);
    for (std::size_t i = span - p; i <= span; ++i) {
      const Wide share = basis[i] * Wide(curve.weights()[i]);
      sum += share * Wide(curve.points()[i * dim + c]);
      total += share;
    }
    worst = std::max(worst, std::abs(static_cast<double>(Wide(computed[c]) - sum / total)));
  }
  return worst / ulp_of(largest_coordinate(curve));
}

double distance_ulp(Dice& dice, const NurbsCurve& curve, const NurbsCurve& edited, double low,
                    double high) {
  const double ulp = ulp_of(largest_coordinate(curve));
  double worst = 0;
  for (int i = 0; i < 10; ++i) {
    const double u =
        std::clamp(i < 2 ? random_parameter(dice, edited) : dice.between(low, high), low, high);
    const Side side = i % 2 == 0 ? Side::left : Side::right;
    // A part's ends are its own: what lies beyond them is not in it.
    const bool beyond = (u == low && side == Side::left) || (u == high && side == Side::right);
    if (beyond && !edited.is_periodic()) continue;
    double a[curves::kMaxDim], b[curves::kMaxDim];
    curve.evaluate(u, side, a);
    edited.evaluate(u, side, b);
    for (int c = 0; c < curve.dim(); ++c) worst = std::max(worst, std::abs(a[c] - b[c]) / ulp);
    worst = std::max(worst, error_in_ulp(curve, u, side, b));
  }
  return worst;
}

}  // namespace knotwave::test

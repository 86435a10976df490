// SPDX-License-Identifier: MIT
#include "random_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "example_curve.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;

std::vector<double> inner_knots(Dice& dice, int degree, int count) {
  std::vector<double> inner(static_cast<std::size_t>(count));
  for (double& knot : inner) knot = dice.between(0.001, 0.999);
  if (dice.one_in(3)) {  // uniform
    for (int i = 0; i < count; ++i) inner[std::size_t(i)] = (i + 1.0) / (count + 1.0);
  }
  if (count > 1 && dice.one_in(4)) {  // a knot several times
    for (int i = 1; i < std::min(count, degree); ++i) inner[std::size_t(i)] = inner[0];
  }
  if (count > 1 && dice.one_in(4)) inner[1] = inner[0] + std::ldexp(1.0, -10 - dice.below(20));
  std::sort(inner.begin(), inner.end());
  return inner;
}

// A period from 0 to 1, now and then with knots right beside its seam: 2^-10 down to 2^-`nearest`.
std::vector<double> period_of_knots(Dice& dice, int degree, int count, int nearest) {
  std::vector<double> knots = inner_knots(dice, degree, count - 1);
  if (knots.size() > 1 && dice.one_in(3)) {
    knots.front() = std::ldexp(1.0, -10 - dice.below(nearest - 9));
  }
  if (knots.size() > 1 && dice.one_in(3)) knots.back() = 1 - std::ldexp(1.0, -10 - dice.below(20));
  knots.insert(knots.begin(), 0.0);
  knots.push_back(1.0);
  return knots;
}

void fill_knots(Dice& dice, CurveSpec& spec, int count) {
  const int p = spec.degree;
  if (dice.one_in(5)) return;  // left out
  const double scale = dice.one_in(3) ? std::ldexp(1.0, dice.below(40) - 20) : 1.0;
  double shift = 0;
  if (dice.one_in(3)) shift = std::floor(dice.between(-1000, 1000));
  if (dice.one_in(3)) shift = dice.between(-2, 2);  // knots that a period does not shift exactly
  std::vector<double> knots;
  if (spec.periodic) {
    knots = period_of_knots(dice, p, count, shift == 0 ? 60 : 30);
  } else {
    knots = inner_knots(dice, p, count - p - 1);
    const bool clamped = !dice.one_in(4);
    for (int i = 0; i <= p; ++i) {
      knots.insert(knots.begin(), clamped ? 0.0 : -0.01 * i);
      knots.push_back(clamped ? 1.0 : 1.0 + 0.3 * i);
    }
  }
  for (double& knot : knots) knot = scale * (shift + knot);
  spec.knots = knots;
}

}  // namespace

CurveSpec random_spec(Dice& dice, int degree) {
  CurveSpec spec;
  spec.name = "random";
  spec.degree = degree > 0 ? degree : 1 + dice.below(curves::kMaxDegree);
  spec.dim = 1 + dice.below(3);
  spec.periodic = dice.one_in(4);
  const int count = spec.degree + 1 + dice.below(12);
  const int size = dice.below(13) - 6;
  const bool offset = dice.one_in(3);  // all just below a power of two: the ulp counts double
  for (int i = 0; i < count * spec.dim; ++i) {
    spec.points.push_back(offset ? 1.96875 + dice.between(0, 0.03)
                                 : std::ldexp(dice.between(-1, 1), 3 * size));
  }
  if (dice.one_in(2)) {
    const double decades = dice.one_in(2) ? 6 : 1;
    for (int i = 0; i < count; ++i) {
      spec.weights.push_back(
          std::clamp(std::pow(10.0, dice.between(-decades, decades)), 1e-6, 1e6));
    }
  }
  fill_knots(dice, spec, count);
  return spec;
}

curves::NurbsCurve random_curve(Dice& dice, int degree) { return made(random_spec(dice, degree)); }

curves::NurbsCurve plain_curve(Dice& dice, int most_degree) {
  CurveSpec spec = random_spec(dice, 1 + dice.below(most_degree));
  spec.weights.clear();
  return made(std::move(spec));
}

double random_parameter(Dice& dice, const curves::NurbsCurve& curve) {
  const auto knots = curve.knots();
  const double knot = knots[std::size_t(dice.below(static_cast<int>(knots.size())))];
  switch (dice.below(6)) {
    case 0:
      return knot;
    case 1:
      // Near 0 doubles are nearer than knots may be, should it become one.
      if (std::abs(knot) < 0x1p-800) return knot + (dice.one_in(2) ? -1e-270 : 1e-270);
      return std::nextafter(knot, dice.one_in(2) ? -1e30 : 1e30);
    case 2:
      return dice.one_in(2) ? curve.u_min() : curve.u_max();
    default:
      return dice.between(curve.u_min(), curve.u_max());
  }
}

double largest_coordinate(const curves::NurbsCurve& curve) {
  double largest = 0;
  for (const double x : curve.points()) largest = std::max(largest, std::abs(x));
  return largest;
}

double polygon_length(const curves::NurbsCurve& curve) {
  double sum = curve.dim() == 1 ? curve.u_max() - curve.u_min() : 0;
  const auto points = curve.points();
  const auto dim = std::size_t(curve.dim());
  for (std::size_t i = dim; i < points.size(); i += dim) {
    double square = 0;
    for (std::size_t c = 0; c < dim; ++c) {
      square += (points[i + c] - points[i - dim + c]) * (points[i + c] - points[i - dim + c]);
    }
    sum += std::sqrt(square);
  }
  return sum;
}

double ulp_of(double x) {
  return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x);
}

}  // namespace knotwave::test

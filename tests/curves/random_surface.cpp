// SPDX-License-Identifier: MIT
#include "random_surface.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace knotwave::test {
namespace {

// Clamped over [0, 1], knots repeated at most `degree` times.
std::vector<double> random_knots(Dice& dice, int degree, int count) {
  std::vector<double> inner;
  while (static_cast<int>(inner.size()) < count - degree - 1) {
    inner.push_back(dice.between(0.01, 0.99));
    const auto same = std::count(inner.begin(), inner.end(), inner.front());
    if (dice.one_in(3) && same < degree) inner.back() = inner.front();
  }
  std::sort(inner.begin(), inner.end());
  inner.insert(inner.begin(), std::size_t(degree) + 1, 0.0);
  inner.insert(inner.end(), std::size_t(degree) + 1, 1.0);
  return inner;
}

double place_in(Dice& dice, std::span<const double> knots, double low, double high) {
  if (dice.one_in(3)) return dice.between(low, high);
  const double knot = knots[std::size_t(dice.below(static_cast<int>(knots.size())))];
  return std::clamp(knot, low, high);
}

}  // namespace

curves::SurfaceSpec random_surface_spec(Dice& dice) {
  curves::SurfaceSpec spec;
  spec.name = "random";
  spec.degree_u = 1 + dice.below(7);
  spec.degree_v = 1 + dice.below(5);
  spec.dim = 1 + dice.below(3);
  spec.count_u = spec.degree_u + 1 + dice.below(5);
  spec.count_v = spec.degree_v + 1 + dice.below(5);
  spec.periodic_u = dice.one_in(2);
  const int count = spec.count_u * spec.count_v;
  for (int i = 0; i < count * spec.dim; ++i) spec.points.push_back(dice.between(-1, 1));
  if (dice.one_in(2)) {
    for (int i = 0; i < count; ++i) spec.weights.push_back(dice.between(0.1, 3));
  }
  if (!spec.periodic_u && dice.one_in(2)) {
    spec.knots_u = random_knots(dice, spec.degree_u, spec.count_u);
  }
  if (dice.one_in(2)) spec.knots_v = random_knots(dice, spec.degree_v, spec.count_v);
  return spec;
}

curves::NurbsSurface random_surface(Dice& dice) {
  auto surface = curves::NurbsSurface::create(random_surface_spec(dice));
  EXPECT_TRUE(surface) << (surface ? "" : surface.error().message);
  return std::move(*surface);
}

double surface_distance_ulp(Dice& dice, const curves::NurbsSurface& surface,
                            const curves::NurbsSurface& edited) {
  double largest = 0, worst = 0;
  for (const double x : surface.points()) largest = std::max(largest, std::abs(x));
  const double u_low = std::max(surface.u_min(), edited.u_min());
  const double u_high = std::min(surface.u_max(), edited.u_max());
  const double v_low = std::max(surface.v_min(), edited.v_min());
  const double v_high = std::min(surface.v_max(), edited.v_max());
  for (int i = 0; i < 12; ++i) {
    double u = place_in(dice, edited.knots_u(), u_low, u_high);
    const double v = place_in(dice, edited.knots_v(), v_low, v_high);
    // What was cut open ends where the period does.
    if (u == surface.u_max() && surface.is_periodic_u()) u = u_low;
    double a[curves::kMaxDim], b[curves::kMaxDim];
    surface.evaluate(u, v, a);
    edited.evaluate(u, v, b);
    for (int c = 0; c < surface.dim(); ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
  }
  return worst / ulp_of(largest);
}

}  // namespace knotwave::test

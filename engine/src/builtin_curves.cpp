// SPDX-License-Identifier: MIT
#include "builtin_curves.h"

#include <string>

#include "knotwave/base/elementary.h"

namespace knotwave::engine {
namespace {

constexpr std::string_view kNames[] = {"sine", "triangle", "saw", "square"};
constexpr double kPi = 3.14159265358979323846;

// B-spline coefficients of a sine are a sine, 1 / sinc^6(1 / n) higher for a uniform quintic; what
// is left are harmonics n k +- 1, each below (1 / (n k - 1))^6. Point i pulls most at (i - 2) / n.
curves::CurveSpec sine() {
  constexpr int kPoints = 64;
  const double x = kPi / kPoints;
  const double sinc = base::sin_cos_cycles(0.5 / kPoints).sin / x;
  const double sinc2 = sinc * sinc;
  const double height = 1 / (sinc2 * sinc2 * sinc2);
  curves::CurveSpec spec;
  spec.degree = 5;
  spec.periodic = true;
  for (int i = 0; i < kPoints; ++i) {
    spec.points.push_back(height * base::sin_cos_cycles(double(i - 2) / kPoints).sin);
  }
  return spec;
}

curves::CurveSpec straight(std::vector<double> points, std::vector<double> knots,
                           std::vector<double> jumps = {}) {
  curves::CurveSpec spec;
  spec.degree = 1;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  spec.jumps = std::move(jumps);
  return spec;
}

curves::CurveSpec builtin_spec(std::string_view name) {
  if (name == "sine") return sine();
  if (name == "triangle") return straight({0, 1, -1, 0}, {0, 0, 0.25, 0.75, 1, 1});
  if (name == "saw") return straight({-1, 1}, {0, 0, 1, 1});
  return straight({1, 1, -1, -1}, {0, 0, 0.5, 0.5, 1, 1}, {0.5});
}

}  // namespace

std::span<const std::string_view> builtin_curve_names() { return kNames; }

curves::NurbsCurve builtin_curve(std::string_view name) {
  curves::CurveSpec spec = builtin_spec(name);
  spec.name = name;
  return curves::NurbsCurve::create(std::move(spec)).value();
}

}  // namespace knotwave::engine

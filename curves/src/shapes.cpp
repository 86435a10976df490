// SPDX-License-Identifier: MIT
#include "knotwave/curves/shapes.h"

#include <cmath>

#include "knotwave/base/document.h"

#include "circle.h"

namespace knotwave::curves {
namespace {

using base::number_text;

Result<void> check_radius(const std::string& what, double radius) {
  if (!std::isfinite(radius)) {
    return fail(ErrorCode::not_finite, what + " = " + number_text(radius) + " is not finite");
  }
  if (radius > 0) return {};
  return fail(ErrorCode::value_out_of_range,
              what + " = " + number_text(radius) + " must be above 0");
}

Result<NurbsCurve> scaled_arc(std::string name, double radius_x, double radius_y,
                              const UnitArc& arc) {
  CurveSpec spec;
  spec.name = std::move(name);
  spec.degree = 2;
  spec.dim = 2;
  for (const UnitArc::Point& point : arc.points) {
    spec.points.push_back((point.x * DoubleDouble(radius_x)).hi + 0.0);  // -0 becomes 0
    spec.points.push_back((point.y * DoubleDouble(radius_y)).hi + 0.0);
    spec.weights.push_back(point.weight.hi);
  }
  spec.knots = arc.knots;
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> bezier(std::span<const double> points, int dim) {
  CurveSpec spec;
  spec.name = "bezier";
  spec.dim = dim;
  spec.degree = dim < 1 ? 1 : static_cast<int>(points.size()) / dim - 1;
  spec.points.assign(points.begin(), points.end());
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsCurve> arc(double radius, double start_cycles, double length_cycles) {
  if (auto good = check_radius("an arc: radius", radius); !good) return good.error();
  const auto unit = unit_arc("an arc", start_cycles, length_cycles);
  if (!unit) return unit.error();
  return scaled_arc("arc", radius, radius, *unit);
}

Result<NurbsCurve> ellipse(double radius_x, double radius_y) {
  if (auto good = check_radius("an ellipse: radius_x", radius_x); !good) return good.error();
  if (auto good = check_radius("an ellipse: radius_y", radius_y); !good) return good.error();
  return scaled_arc("ellipse", radius_x, radius_y, *unit_arc("an ellipse", 0, 1));
}

Result<NurbsCurve> conic(std::span<const double> p0, std::span<const double> p1,
                         std::span<const double> p2, double w) {
  if (p0.size() != 2 || p1.size() != 2 || p2.size() != 2) {
    return fail(ErrorCode::dimension_mismatch,
                "a conic: three points of 2 coordinates are needed, found " +
                    std::to_string(p0.size()) + ", " + std::to_string(p1.size()) + " and " +
                    std::to_string(p2.size()));
  }
  CurveSpec spec;
  spec.name = "conic";
  spec.degree = 2;
  spec.dim = 2;
  spec.points = {p0[0], p0[1], p1[0], p1[1], p2[0], p2[1]};
  spec.weights = {1, w, 1};
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsCurve> css_cubic_bezier(double x1, double y1, double x2, double y2) {
  for (const double x : {x1, x2}) {
    if (x < 0 || x > 1) {
      return fail(ErrorCode::not_a_function, "cubic-bezier(" + number_text(x1) + ", " +
                                                 number_text(y1) + ", " + number_text(x2) + ", " +
                                                 number_text(y2) + "): x = " + number_text(x) +
                                                 " is outside 0..1, where time may go back");
    }
  }
  CurveSpec spec;
  spec.name = "cubic-bezier";
  spec.dim = 2;
  spec.points = {0, 0, x1, y1, x2, y2, 1, 1};
  return NurbsCurve::create(std::move(spec));
}

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Curves that have a name, SVG paths, and curves from data.
#include "knotwave/curves/shapes.h"

#include "knotwave/curves/fit.h"
#include "knotwave/curves/svg_path.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using curves::NurbsCurve;

/// One for each datum.
std::span<const double> parameters_of(const char* name, const Array& parameters,
                                      const Array& data) {
  if (parameters.ndim() != 1 && data.ndim() > 0) {
    check_shape(name, parameters, {data.shape(0)});
  }
  return numbers(parameters);
}

std::vector<NurbsCurve> from_svg_path(std::string_view d, std::string_view y) {
  constexpr std::string_view kWords[] = {"up", "down"};
  const auto direction = choice("y", y, kWords) == 0 ? curves::SvgY::up : curves::SvgY::down;
  return take(curves::curves_from_svg_path(d, direction));
}

NurbsCurve interpolate(const Array& points, int degree, std::string_view spacing) {
  constexpr std::string_view kWords[] = {"uniform", "chord", "centripetal"};
  constexpr curves::Spacing kModes[] = {curves::Spacing::uniform, curves::Spacing::chord,
                                        curves::Spacing::centripetal};
  const auto mode = kModes[choice("spacing", spacing, kWords)];
  return take(curves::interpolate(numbers(points), dim_of(points), degree, mode));
}

}  // namespace

void add_shapes(py::module_& module) {
  module
      .def(
          "bezier",
          [](const Array& points) { return take(curves::bezier(numbers(points), dim_of(points))); },
          py::arg("points"), "Bezier curve of points [n] or [n, dim] over 0..1, degree n - 1.")
      .def(
          "arc",
          [](double radius, double start_cycles, double length_cycles) {
            return take(curves::arc(radius, start_cycles, length_cycles));
          },
          py::arg("radius"), py::arg("start_cycles"), py::arg("length_cycles"),
          "Arc about (0, 0); angles in cycles, a negative length is clockwise.")
      .def(
          "ellipse",
          [](double radius_x, double radius_y) {
            return take(curves::ellipse(radius_x, radius_y));
          },
          py::arg("radius_x"), py::arg("radius_y"), "A closed ellipse about (0, 0).")
      .def(
          "conic",
          [](const Array& p0, const Array& p1, const Array& p2, double w) {
            return take(curves::conic(row("p0", p0), row("p1", p1), row("p2", p2), w));
          },
          py::arg("p0"), py::arg("p1"), py::arg("p2"), py::arg("w"),
          "From p0 [2] to p2 [2], tangents meet in p1 [2], shape factor w.")
      .def(
          "exponential_decay",
          [](double range_db) { return take(curves::exponential_decay(range_db)); },
          py::arg("range_db"), WithoutGil(),
          "A FittedDecay from 1 to -range_db, straight in decibels.")
      .def(
          "css_cubic_bezier",
          [](double x1, double y1, double x2, double y2) {
            return take(curves::css_cubic_bezier(x1, y1, x2, y2));
          },
          py::arg("x1"), py::arg("y1"), py::arg("x2"), py::arg("y2"),
          "CSS cubic-bezier(x1, y1, x2, y2) as a 2-D cubic, x the time.")
      .def(
          "hermite",
          [](const Array& times, const Array& values, const Array& slopes_in,
             const Array& slopes_out) {
            check_shape("slopes_in", slopes_in, shape_of(values));
            check_shape("slopes_out", slopes_out, shape_of(values));
            return take(curves::hermite(row("times", times), numbers(values), numbers(slopes_in),
                                        numbers(slopes_out), dim_of(values)));
          },
          py::arg("times"), py::arg("values"), py::arg("slopes_in"), py::arg("slopes_out"),
          "Cubic through values [n] or [n, dim] at times [n] with those slopes on either side.")
      .def(
          "catmull_rom",
          [](const Array& points, double alpha, bool closed) {
            return take(curves::catmull_rom(numbers(points), dim_of(points), alpha, closed));
          },
          py::arg("points"), py::arg("alpha") = 0.5, py::arg("closed") = false,
          "Through points [n] or [n, dim]; alpha 0 uniform, 0.5 centripetal, 1 chordal.")
      .def("curves_from_svg_path", &from_svg_path, py::arg("d"), py::arg("y") = "up",
           "The subpaths of the attribute `d` as 2-D curves. y 'up' changes the sign of y.");
}

void add_fits(py::module_& module) {
  module
      .def("interpolate", &interpolate, py::arg("points"), py::arg("degree") = 3,
           py::arg("spacing") = "centripetal",
           "Through every point [n] or [n, dim], over 0..1; spacing 'uniform', 'chord' or\n"
           "'centripetal'.")
      .def(
          "interpolate_at",
          [](const Array& parameters, const Array& points, int degree) {
            return take(curves::interpolate_at(parameters_of("parameters", parameters, points),
                                               numbers(points), dim_of(points), degree));
          },
          py::arg("parameters"), py::arg("points"), py::arg("degree") = 3, WithoutGil(),
          "Through points [n] or [n, dim] at parameters [n], strictly increasing.")
      .def(
          "approximate",
          [](const Array& parameters, const Array& values, int degree, int point_count) {
            return take(curves::approximate(parameters_of("parameters", parameters, values),
                                            numbers(values), dim_of(values), degree, point_count));
          },
          py::arg("parameters"), py::arg("values"), py::arg("degree"), py::arg("point_count"),
          WithoutGil(),
          "A Fitted by least squares with point_count control points; values [n] or [n, dim].")
      .def(
          "reduce_data",
          [](const Array& times, const Array& values, double tolerance, int degree) {
            return take(curves::reduce_data(parameters_of("times", times, values), numbers(values),
                                            tolerance, degree, dim_of(values)));
          },
          py::arg("times"), py::arg("values"), py::arg("tolerance"), py::arg("degree") = 3,
          WithoutGil(),
          "A Fitted with few points, everywhere within tolerance of the straight lines between\n"
          "values [n] or [n, dim] at times [n]; max_error is proved.");
}

}  // namespace knotwave::python

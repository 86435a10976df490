// SPDX-License-Identifier: MIT
// Methods of knotwave.Surface that make other surfaces, and surfaces made from curves.
#include "knotwave/curves/surface_algorithms.h"
#include "knotwave/curves/surface_shapes.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using curves::Direction;
using curves::NurbsCurve;
using curves::NurbsSurface;

Direction direction_of(std::string_view direction) {
  constexpr std::string_view kWords[] = {"u", "v"};
  return choice("direction", direction, kWords) == 0 ? Direction::u : Direction::v;
}

NurbsSurface lofted(const std::vector<NurbsCurve>& rows, int degree_v,
                    const std::optional<Array>& positions) {
  return take(curves::lofted(rows, degree_v, copied_row("positions", positions)));
}

NurbsSurface bilinear(const Array& corners) {
  return take(curves::bilinear(numbers(corners), dim_of(corners)));
}

void add_smaller(py::class_<NurbsSurface>& surface) {
  surface
      .def(
          "remove_knot",
          [](const NurbsSurface& self, std::string_view direction, double at, int times,
             double tolerance) {
            return take(curves::remove_knot(self, direction_of(direction), at, times, tolerance));
          },
          py::arg("direction"), py::arg("at"), py::arg("times"), py::arg("tolerance"), WithoutGil(),
          "A ReducedSurface: the knot out up to `times` times, as far as the tolerance allows.")
      .def(
          "reduce_degree",
          [](const NurbsSurface& self, std::string_view direction, double tolerance) {
            return take(curves::reduce_degree(self, direction_of(direction), tolerance));
          },
          py::arg("direction"), py::arg("tolerance"), WithoutGil(),
          "A ReducedSurface of one degree less.");
}

}  // namespace

void add_surface_edits(py::class_<NurbsSurface>& surface) {
  surface
      .def(
          "insert_knot",
          [](const NurbsSurface& self, std::string_view direction, double at, int times) {
            return take(curves::insert_knot(self, direction_of(direction), at, times));
          },
          py::arg("direction"), py::arg("at"), py::arg("times") = 1, WithoutGil(),
          "The same surface with that knot; direction 'u' or 'v', here and below.")
      .def(
          "refine",
          [](const NurbsSurface& self, std::string_view direction, const Array& knots) {
            return take(curves::refine(self, direction_of(direction), row("knots", knots)));
          },
          py::arg("direction"), py::arg("knots"), WithoutGil(),
          "The same surface with all of knots [m], in any order.")
      .def(
          "elevate_degree",
          [](const NurbsSurface& self, std::string_view direction, int times) {
            return take(curves::elevate_degree(self, direction_of(direction), times));
          },
          py::arg("direction"), py::arg("times") = 1, WithoutGil(), "The same surface.")
      .def(
          "sub_surface",
          [](const NurbsSurface& self, std::string_view direction, double a, double b) {
            return take(curves::sub_surface(self, direction_of(direction), a, b));
          },
          py::arg("direction"), py::arg("a"), py::arg("b"), WithoutGil(), "The part over [a, b].")
      .def(
          "split",
          [](const NurbsSurface& self, std::string_view direction, double at) {
            auto parts = take(curves::split(self, direction_of(direction), at));
            return std::pair(std::move(parts.low), std::move(parts.high));
          },
          py::arg("direction"), py::arg("at"), WithoutGil(), "Both parts: (low, high).")
      .def(
          "reverse",
          [](const NurbsSurface& self, std::string_view direction) {
            return take(curves::reverse(self, direction_of(direction)));
          },
          py::arg("direction"), WithoutGil(), "Backwards over the same domain.")
      .def(
          "reparametrize",
          [](const NurbsSurface& self, std::string_view direction, double a, double b) {
            return take(curves::reparametrize(self, direction_of(direction), a, b));
          },
          py::arg("direction"), py::arg("a"), py::arg("b"), WithoutGil(), "Over [a, b] instead.")
      .def(
          "transpose", [](const NurbsSurface& self) { return take(curves::transpose(self)); },
          WithoutGil(), "u and v change places.");
  add_smaller(surface);
}

void add_surface_shapes(py::module_& module) {
  py::class_<curves::ReducedSurface>(module, "ReducedSurface",
                                     "A smaller surface and a proved bound.")
      .def_readonly("surface", &curves::ReducedSurface::surface)
      .def_readonly("removed", &curves::ReducedSurface::removed, "Knots, or degrees.")
      .def_readonly("max_error", &curves::ReducedSurface::max_error,
                    "No point is farther than this from the surface at the same (u, v).");
  module
      .def(
          "ruled",
          [](const NurbsCurve& first, const NurbsCurve& second) {
            return take(curves::ruled(first, second));
          },
          py::arg("first"), py::arg("second"), WithoutGil(),
          "Straight lines between the points of two curves, v from 0 to 1.")
      .def("lofted", &lofted, py::arg("rows"), py::arg("degree_v"),
           py::arg("positions") = py::none(), WithoutGil(),
           "Through every row, a list of curves; positions [len(rows)] along v, by the distance\n"
           "from row to row without.")
      .def(
          "revolved",
          [](const NurbsCurve& profile, double length_cycles) {
            return take(curves::revolved(profile, length_cycles));
          },
          py::arg("profile"), py::arg("length_cycles") = 1.0, WithoutGil(),
          "A profile (distance from the axis, height) turned about the axis; 1 is a whole turn.")
      .def("bilinear", &bilinear, py::arg("corners"), WithoutGil(),
           "From corners [4] or [4, dim]: (0, 0), (1, 0), (0, 1), (1, 1).")
      .def(
          "coons",
          [](const NurbsCurve& bottom, const NurbsCurve& top, const NurbsCurve& left,
             const NurbsCurve& right,
             double tolerance) { return take(curves::coons(bottom, top, left, right, tolerance)); },
          py::arg("bottom"), py::arg("top"), py::arg("left"), py::arg("right"),
          py::arg("tolerance") = 1e-9, WithoutGil(),
          "Inside four border curves: bottom and top along u, left and right along v.");
}

}  // namespace knotwave::python

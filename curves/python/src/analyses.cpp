// SPDX-License-Identifier: MIT
// Methods of knotwave.Curve that measure, what they give back, and functions of two curves.
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/combine.h"
#include "knotwave/curves/fit.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/shapes.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using curves::NurbsCurve;

py::array_t<double> column(const std::vector<double>& values) {
  return new_array(values, {static_cast<py::ssize_t>(values.size())});
}

py::array_t<double> span_hulls(const NurbsCurve& curve, int coordinate) {
  check_coordinate(curve, coordinate);
  std::vector<double> rows;
  for (const curves::SpanHull& hull : curves::span_hulls(curve, coordinate)) {
    rows.insert(rows.end(), {hull.u0, hull.u1, hull.low, hull.high});
  }
  return new_array(rows, {static_cast<py::ssize_t>(rows.size()) / 4, 4});
}

py::array_t<double> breaks(const NurbsCurve& curve, int max_order, int coordinate) {
  if (max_order > 0) check_order(max_order);
  check_coordinate(curve, coordinate);
  std::vector<double> rows;
  for (const curves::Break& found : curves::breaks_of(curve, max_order, coordinate)) {
    rows.insert(rows.end(), {found.u, static_cast<double>(found.order), found.size});
  }
  return new_array(rows, {static_cast<py::ssize_t>(rows.size()) / 3, 3});
}

void add_answers(py::module_& module) {
  py::class_<curves::Extremum>(module, "Extremum", "Where a curve is lowest or highest.")
      .def_readonly("u", &curves::Extremum::u)
      .def_readonly("value", &curves::Extremum::value);
  py::class_<curves::ValueRange>(module, "ValueRange", "Least and greatest value, and where.")
      .def_readonly("low", &curves::ValueRange::low)
      .def_readonly("high", &curves::ValueRange::high);
  py::class_<curves::ClosestPoint>(module, "ClosestPoint",
                                   "Where a curve is nearest, and how near.")
      .def_readonly("u", &curves::ClosestPoint::u)
      .def_readonly("distance", &curves::ClosestPoint::distance);
  py::class_<curves::ReducedCurve>(module, "Reduced", "A smaller curve and a proved bound.")
      .def_readonly("curve", &curves::ReducedCurve::curve)
      .def_readonly("removed", &curves::ReducedCurve::removed, "Knots, or degrees.")
      .def_readonly("max_error", &curves::ReducedCurve::max_error,
                    "No point is farther than this from the curve at the same u.");
  py::class_<curves::FittedCurve>(module, "Fitted", "A curve near data, and how near.")
      .def_readonly("curve", &curves::FittedCurve::curve)
      .def_readonly("max_error", &curves::FittedCurve::max_error)
      .def_readonly("max_error_db", &curves::FittedCurve::max_error_db,
                    "Relative to the largest value; -1000 if exact.");
  py::class_<curves::FittedDecay>(module, "FittedDecay", "A decay straight in decibels, nearly.")
      .def_readonly("curve", &curves::FittedDecay::curve)
      .def_readonly("max_error_db", &curves::FittedDecay::max_error_db);
}

}  // namespace

void add_analyses(py::module_& module, py::class_<NurbsCurve>& curve) {
  add_answers(module);
  curve
      .def(
          "value_range",
          [](const NurbsCurve& self, int coordinate) {
            check_coordinate(self, coordinate);
            return curves::value_range(self, coordinate);
          },
          py::arg("coordinate") = 0, WithoutGil(), "A ValueRange: least and greatest value.")
      .def(
          "hull_range",
          [](const NurbsCurve& self, int coordinate) {
            check_coordinate(self, coordinate);
            const auto range = curves::hull_range(self, coordinate);
            return std::pair(range.low, range.high);
          },
          py::arg("coordinate") = 0,
          "(low, high) of the control points: the curve never leaves them.")
      .def(
          "parameters_at",
          [](const NurbsCurve& self, double value, int coordinate) {
            check_coordinate(self, coordinate);
            return column(curves::parameters_at(self, value, coordinate));
          },
          py::arg("value"), py::arg("coordinate") = 0,
          "[k]: every u, in order, where the coordinate is `value`.")
      .def(
          "total_variation",
          [](const NurbsCurve& self, int coordinate) {
            check_coordinate(self, coordinate);
            return curves::total_variation(self, coordinate);
          },
          py::arg("coordinate") = 0, WithoutGil(), "Sum of all rises and falls.")
      .def("span_hulls", &span_hulls, py::arg("coordinate") = 0,
           "[s, 4]: u0, u1, low, high of each span.")
      .def("breaks", &breaks, py::arg("max_order"), py::arg("coordinate") = 0,
           "[k, 3]: u, order, size of each jump of a derivative up to max_order at a knot.")
      .def(
          "closest_point",
          [](const NurbsCurve& self, const Array& point) {
            return take(curves::closest_point(self, row("point", point)));
          },
          py::arg("point"), WithoutGil(), "The ClosestPoint to point [dim].")
      .def(
          "is_non_decreasing",
          [](const NurbsCurve& self, int coordinate) {
            check_coordinate(self, coordinate);
            return curves::is_non_decreasing(self, coordinate);
          },
          py::arg("coordinate") = 0, WithoutGil(), "Whether a coordinate never falls.")
      .def(
          "greville_abscissae",
          [](const NurbsCurve& self) { return column(curves::greville_abscissae(self)); },
          "[n]: the u where each control point pulls most.")
      .def(
          "integral",
          [](const NurbsCurve& self, double u_a, double u_b, int coordinate) {
            check_coordinate(self, coordinate);
            return take(curves::integral(self, u_a, u_b, coordinate));
          },
          py::arg("u_a"), py::arg("u_b"), py::arg("coordinate") = 0, WithoutGil(),
          "Integral of one coordinate from u_a to u_b.")
      .def(
          "arc_length",
          [](const NurbsCurve& self, double u_a, double u_b) {
            return take(curves::arc_length(self, u_a, u_b));
          },
          py::arg("u_a"), py::arg("u_b"), WithoutGil(),
          "Length of the path between u_a and u_b, or of the graph of a scalar curve.")
      .def(
          "parameter_at_length",
          [](const NurbsCurve& self, double length) {
            return take(curves::parameter_at_length(self, length));
          },
          py::arg("length"), WithoutGil(),
          "The least u at which the path from u_min is `length` long.");
}

void add_combinations(py::module_& module) {
  const auto sum = [](const NurbsCurve& first, const NurbsCurve& second) {
    return take(curves::sum(first, second));
  };
  const auto product = [](const NurbsCurve& first, const NurbsCurve& second) {
    return take(curves::product(first, second));
  };
  module
      .def(
          "join",
          [](const NurbsCurve& first, const NurbsCurve& second, double join_tolerance) {
            return take(curves::join(first, second, join_tolerance));
          },
          py::arg("first"), py::arg("second"), py::arg("join_tolerance") = 0.0, WithoutGil(),
          "`second` after `first`; ends farther apart than join_tolerance make a jump.")
      .def(
          "make_compatible",
          [](const NurbsCurve& first, const NurbsCurve& second) {
            auto both = take(curves::make_compatible(first, second));
            return std::pair(std::move(both.first), std::move(both.second));
          },
          py::arg("first"), py::arg("second"), WithoutGil(),
          "(first, second) with one degree, one knot vector, one count of points.")
      .def(
          "make_all_compatible",
          [](const std::vector<NurbsCurve>& curves) {
            return take(curves::make_compatible(std::span<const NurbsCurve>(curves)));
          },
          py::arg("curves"), WithoutGil(), "The same for a list of any length.")
      .def(
          "morph",
          [](const NurbsCurve& first, const NurbsCurve& second, double amount) {
            return take(curves::morph(first, second, amount));
          },
          py::arg("first"), py::arg("second"), py::arg("amount"), WithoutGil(),
          "(1 - amount) first + amount second.")
      .def("sum", sum, py::arg("first"), py::arg("second"), WithoutGil(),
           "first + second over equal domains.")
      .def("product", product, py::arg("first"), py::arg("second"), WithoutGil(),
           "first * second over equal domains.")
      .def(
          "compose",
          [](const NurbsCurve& outer, const NurbsCurve& inner) {
            return take(curves::compose(outer, inner));
          },
          py::arg("outer"), py::arg("inner"), WithoutGil(), "outer(inner(u)) as a curve.");
}

}  // namespace knotwave::python

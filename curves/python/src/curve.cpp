// SPDX-License-Identifier: MIT
// knotwave.Curve: made, asked, evaluated.
#include <sstream>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/extrapolate.h"
#include "knotwave/curves/plot.h"
#include "knotwave/curves/svg_path.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using base::index_of;
using curves::NurbsCurve;

NurbsCurve make_curve(const Array& points, int degree, const std::optional<Array>& weights,
                      const std::optional<Array>& knots, bool periodic,
                      const std::optional<Array>& jumps, std::string name) {
  curves::CurveSpec spec;
  spec.name = std::move(name);
  spec.degree = degree;
  spec.dim = dim_of(points);
  spec.points.assign(points.data(), points.data() + points.size());
  if (weights && weights->ndim() > 1) check_shape("weights", *weights, {points.shape(0)});
  spec.weights = copied_row("weights", weights);
  spec.knots = copied_row("knots", knots);
  spec.periodic = periodic;
  spec.jumps = copied_row("jumps", jumps);
  return take(NurbsCurve::create(std::move(spec)));
}

/// The arguments that make an equal curve.
py::dict spec_of(const NurbsCurve& curve) {
  const curves::CurveSpec spec = curve.spec();
  const auto count = static_cast<py::ssize_t>(spec.points.size() / index_of(spec.dim));
  const auto optional = [](const std::vector<double>& values) -> py::object {
    if (values.empty()) return py::none();
    return new_array(values, {static_cast<py::ssize_t>(values.size())});
  };
  py::dict made;
  made["points"] = new_array(spec.points, with_dim({count}, spec.dim));
  made["degree"] = spec.degree;
  made["weights"] = optional(spec.weights);
  made["knots"] = optional(spec.knots);
  made["periodic"] = spec.periodic;
  made["jumps"] = optional(spec.jumps);
  made["name"] = spec.name;
  return made;
}

/// values[i] = work(u[i]), a row of `size` numbers each.
template <class Work>
void for_each_u(const Array& u, std::span<double> out, int size, Work&& work) {
  const py::gil_scoped_release others_go_on;
  const auto places = numbers(u);
  for (std::size_t i = 0; i < places.size(); ++i) {
    work(places[i], out.subspan(i * index_of(size), index_of(size)));
  }
}

py::object evaluate(const NurbsCurve& curve, const Array& u, std::string_view side) {
  const curves::Side from = side_of(side);
  py::array_t<double> out(with_dim(shape_of(u), curve.dim()));
  for_each_u(u, numbers(out), curve.dim(),
             [&](double at, std::span<double> value) { curve.evaluate(at, from, value); });
  return scalar_or(std::move(out));
}

py::array_t<double> derivatives(const NurbsCurve& curve, const Array& u, int order,
                                std::string_view side) {
  check_order(order);
  const curves::Side from = side_of(side);
  Shape shape = shape_of(u);
  shape.push_back(order + 1);
  py::array_t<double> out(with_dim(std::move(shape), curve.dim()));
  for_each_u(u, numbers(out), (order + 1) * curve.dim(),
             [&](double at, std::span<double> rows) { curve.derivatives(at, order, from, rows); });
  return out;
}

py::object evaluate_extrapolated(const NurbsCurve& curve, const Array& u, std::string_view before,
                                 std::string_view after) {
  constexpr std::string_view kWords[] = {"hold", "linear", "periodic", "mirror"};
  constexpr curves::Extrapolation kModes[] = {
      curves::Extrapolation::hold, curves::Extrapolation::linear, curves::Extrapolation::periodic,
      curves::Extrapolation::mirror};
  const auto low = kModes[choice("before", before, kWords)];
  const auto high = kModes[choice("after", after, kWords)];
  py::array_t<double> out(with_dim(shape_of(u), curve.dim()));
  for_each_u(u, numbers(out), curve.dim(), [&](double at, std::span<double> value) {
    curves::evaluate_extrapolated(curve, at, low, high, value);
  });
  return scalar_or(std::move(out));
}

py::object curvature(const NurbsCurve& curve, const Array& u, std::string_view side) {
  const curves::Side from = side_of(side);
  py::array_t<double> out(shape_of(u));
  for_each_u(u, numbers(out), 1, [&](double at, std::span<double> value) {
    value[0] = curves::curvature(curve, at, from);
  });
  return scalar_or(std::move(out));
}

std::string described(const NurbsCurve& curve) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "<knotwave.Curve '" << curve.name() << "' degree " << curve.degree() << ", "
       << curve.point_count() << " points of dim " << curve.dim()
       << (curve.is_rational() ? ", rational" : "") << (curve.is_periodic() ? ", periodic" : "")
       << ", u " << curve.u_min() << " to " << curve.u_max() << ">";
  return text.str();
}

py::tuple svg_path(const NurbsCurve& curve, double max_error, std::string_view y) {
  constexpr std::string_view kWords[] = {"up", "down"};
  const auto direction = choice("y", y, kWords) == 0 ? curves::SvgY::up : curves::SvgY::down;
  const auto path = take(curves::svg_path_from_curve(curve, max_error, direction));
  return py::make_tuple(path.d, path.max_error);
}

void add_properties(py::class_<NurbsCurve>& curve) {
  curve.def_property_readonly("name", &NurbsCurve::name)
      .def_property_readonly("degree", &NurbsCurve::degree)
      .def_property_readonly("dim", &NurbsCurve::dim, "Numbers a point.")
      .def_property_readonly("is_rational", &NurbsCurve::is_rational)
      .def_property_readonly("is_periodic", &NurbsCurve::is_periodic)
      .def_property_readonly("is_clamped", &NurbsCurve::is_clamped)
      .def_property_readonly("u_min", &NurbsCurve::u_min)
      .def_property_readonly("u_max", &NurbsCurve::u_max)
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            const auto& made = self.cast<const NurbsCurve&>();
            return lent(made.points(), with_dim({made.point_count()}, made.dim()), self);
          },
          "Control points as evaluated, [n] or [n, dim]: a read-only view. A periodic curve has\n"
          "its first `degree` points again at the end.")
      .def_property_readonly(
          "weights",
          [](const py::object& self) {
            const auto& made = self.cast<const NurbsCurve&>();
            return lent(made.weights(), {made.point_count()}, self);
          },
          "[n]: a read-only view; 1 without weights.")
      .def_property_readonly(
          "knots",
          [](const py::object& self) {
            const auto all = self.cast<const NurbsCurve&>().knots();
            return lent(all, {static_cast<py::ssize_t>(all.size())}, self);
          },
          "[n + degree + 1]: a read-only view.")
      .def_property_readonly(
          "jumps",
          [](const py::object& self) {
            const auto all = self.cast<const NurbsCurve&>().jumps();
            return lent(all, {static_cast<py::ssize_t>(all.size())}, self);
          },
          "Knots where the curve may jump: a read-only view.");
}

void add_evaluation(py::class_<NurbsCurve>& curve) {
  curve
      .def("__call__", &evaluate, py::arg("u"), py::arg("side") = "right",
           "C(u), the exact value rounded once. u [...] gives [...], or [..., dim] where dim is\n"
           "above 1. u is clamped to the domain (wrapped if periodic), NaN counts as u_min. side\n"
           "'left' or 'right' tells which value at a jump.")
      .def("derivatives", &derivatives, py::arg("u"), py::arg("order") = 1,
           py::arg("side") = "right",
           "C and its first `order` derivatives by u: [..., order + 1] for u [...], or\n"
           "[..., order + 1, dim] where dim is above 1.")
      .def("evaluate_extrapolated", &evaluate_extrapolated, py::arg("u"),
           py::arg("before") = "hold", py::arg("after") = "hold",
           "C(u) for any u; beyond its ends the curve does 'hold', 'linear', 'periodic' or\n"
           "'mirror'. Shapes as of a call.")
      .def("curvature", &curvature, py::arg("u"), py::arg("side") = "right",
           "Signed curvature of a 2-D path, or of the graph of a scalar curve: [...] for u [...].");
}

}  // namespace

void add_curve(py::module_& module) {
  py::class_<NurbsCurve> curve(
      module, "Curve",
      "A NURBS curve u -> R^dim: immutable, checked when it is made.\n\n"
      "Where dim is 1 arrays of points and values have no axis for it: points [n], else [n, dim].");
  curve
      .def(py::init(&make_curve), py::arg("points"), py::arg("degree") = 3,
           py::arg("weights") = py::none(), py::arg("knots") = py::none(),
           py::arg("periodic") = false, py::arg("jumps") = py::none(), py::arg("name") = "",
           "points [n] or [n, dim], dim 1..4; degree 1..15; weights [n], all 1 without; knots\n"
           "[n + degree + 1] (periodic [n + 1]), clamped uniform on 0..1 without. A periodic\n"
           "curve lists each point once. jumps: inner knots that may come degree + 1 times.")
      .def("spec", &spec_of, "The arguments that make an equal curve: Curve(**curve.spec()).")
      .def("__repr__", &described)
      .def(
          "__eq__", [](const NurbsCurve& a, const NurbsCurve& b) { return a == b; },
          py::is_operator())
      .def("__reduce__",
           [](const py::object& self) {
             const py::dict spec = spec_of(self.cast<const NurbsCurve&>());
             return py::make_tuple(
                 py::type::of(self),
                 py::make_tuple(spec["points"], spec["degree"], spec["weights"], spec["knots"],
                                spec["periodic"], spec["jumps"], spec["name"]));
           })
      .def("to_svg_path", &svg_path, py::arg("max_error"), py::arg("y") = "up",
           "(d, bound): SVG path data and how far it is from the curve at most. y 'up' changes\n"
           "the sign of y, 'down' keeps it.")
      .def(
          "plot_text",
          [](const NurbsCurve& self, int columns, int rows) {
            return curves::plot_text(self, columns, rows);
          },
          py::arg("columns") = 72, py::arg("rows") = 14, "A picture for a terminal.")
      .def(
          "plot_svg",
          [](const NurbsCurve& self, int width_px, int height_px) {
            check_pixels(width_px, height_px);
            curves::PlotOptions options;
            options.width_px = width_px;
            options.height_px = height_px;
            return curves::plot_svg(self, options);
          },
          py::arg("width_px") = 960, py::arg("height_px") = 540,
          "A picture as SVG, 64 to 16384 pixels each way.")
      .def("_repr_svg_", [](const NurbsCurve& self) { return curves::plot_svg(self); });
  add_properties(curve);
  add_evaluation(curve);
  add_edits(curve);
  add_analyses(module, curve);
}

}  // namespace knotwave::python

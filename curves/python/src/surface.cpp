// SPDX-License-Identifier: MIT
// knotwave.Surface.
#include "knotwave/curves/nurbs_surface.h"
#include "knotwave/curves/plot.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using base::index_of;
using curves::NurbsSurface;

/// Points [rows, count] have one coordinate, points [rows, count, dim] have dim.
void set_points(curves::SurfaceSpec& spec, const Array& points) {
  const bool is_path = points.ndim() == 3;
  if (points.ndim() != 2 && !is_path) {
    throw Fault{fail(ErrorCode::dimension_mismatch,
                     "points have " + std::to_string(points.ndim()) +
                         " axes, not [count_v, count_u] or [count_v, count_u, dim]")};
  }
  spec.count_v = static_cast<int>(points.shape(0));
  spec.count_u = static_cast<int>(points.shape(1));
  spec.dim = is_path ? static_cast<int>(points.shape(2)) : 1;
  spec.points.assign(points.data(), points.data() + points.size());
}

NurbsSurface make_surface(const Array& points, int degree_u, int degree_v,
                          const std::optional<Array>& weights, const std::optional<Array>& knots_u,
                          const std::optional<Array>& knots_v, bool periodic_u, std::string name) {
  curves::SurfaceSpec spec;
  spec.name = std::move(name);
  spec.degree_u = degree_u;
  spec.degree_v = degree_v;
  set_points(spec, points);
  if (weights) {
    check_shape("weights", *weights, {points.shape(0), points.shape(1)});
    spec.weights.assign(weights->data(), weights->data() + weights->size());
  }
  spec.knots_u = copied_row("knots_u", knots_u);
  spec.knots_v = copied_row("knots_v", knots_v);
  spec.periodic_u = periodic_u;
  return take(NurbsSurface::create(std::move(spec)));
}

py::object evaluate(const NurbsSurface& surface, const Array& u, const Array& v) {
  const auto [all_u, all_v] = broadcast(u, v);
  py::array_t<double> out(with_dim(shape_of(all_u), surface.dim()));
  const auto places_u = numbers(all_u), places_v = numbers(all_v);
  const std::span<double> values = numbers(out);
  {
    const py::gil_scoped_release others_go_on;
    const std::size_t dim = index_of(surface.dim());
    for (std::size_t i = 0; i < places_u.size(); ++i) {
      surface.evaluate(places_u[i], places_v[i], values.subspan(i * dim, dim));
    }
  }
  return scalar_or(std::move(out));
}

py::array_t<double> grid(const NurbsSurface& surface, const Array& u, const Array& v) {
  py::array_t<double> out(with_dim({v.size(), u.size()}, surface.dim()));
  const auto places_u = row("u", u), places_v = row("v", v);
  std::span<double> values = numbers(out);
  {
    const py::gil_scoped_release others_go_on;
    const std::size_t dim = index_of(surface.dim());
    for (const double at_v : places_v) {
      for (const double at_u : places_u) {
        surface.evaluate(at_u, at_v, values.first(dim));
        values = values.subspan(dim);
      }
    }
  }
  return out;
}

py::array_t<double> derivatives(const NurbsSurface& surface, double u, double v, int order) {
  constexpr int kMost = curves::kMaxDegree;
  if (order < 0 || order > kMost) {
    throw Fault{
        fail(ErrorCode::value_out_of_range,
             "order " + std::to_string(order) + " is not within 0.." + std::to_string(kMost))};
  }
  py::array_t<double> out(with_dim({order + 1, order + 1}, surface.dim()));
  surface.derivatives(u, v, order, numbers(out));
  return out;
}

py::dict spec_of(const NurbsSurface& surface) {
  const curves::SurfaceSpec spec = surface.spec();
  const auto optional = [](const std::vector<double>& values, Shape shape) -> py::object {
    if (values.empty()) return py::none();
    return new_array(values, std::move(shape));
  };
  py::dict made;
  made["points"] = new_array(spec.points, with_dim({spec.count_v, spec.count_u}, spec.dim));
  made["degree_u"] = spec.degree_u;
  made["degree_v"] = spec.degree_v;
  made["weights"] = optional(spec.weights, {spec.count_v, spec.count_u});
  made["knots_u"] = optional(spec.knots_u, {static_cast<py::ssize_t>(spec.knots_u.size())});
  made["knots_v"] = optional(spec.knots_v, {static_cast<py::ssize_t>(spec.knots_v.size())});
  made["periodic_u"] = spec.periodic_u;
  made["name"] = spec.name;
  return made;
}

void add_properties(py::class_<NurbsSurface>& surface) {
  surface.def_property_readonly("name", &NurbsSurface::name)
      .def_property_readonly("degree_u", &NurbsSurface::degree_u)
      .def_property_readonly("degree_v", &NurbsSurface::degree_v)
      .def_property_readonly("dim", &NurbsSurface::dim)
      .def_property_readonly("is_rational", &NurbsSurface::is_rational)
      .def_property_readonly("is_periodic_u", &NurbsSurface::is_periodic_u)
      .def_property_readonly("u_min", &NurbsSurface::u_min)
      .def_property_readonly("u_max", &NurbsSurface::u_max)
      .def_property_readonly("v_min", &NurbsSurface::v_min)
      .def_property_readonly("v_max", &NurbsSurface::v_max)
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            const auto& made = self.cast<const NurbsSurface&>();
            return lent(made.points(), with_dim({made.count_v(), made.count_u()}, made.dim()),
                        self);
          },
          "[count_v, count_u] or [count_v, count_u, dim] as evaluated: a read-only view.")
      .def_property_readonly(
          "weights",
          [](const py::object& self) {
            const auto& made = self.cast<const NurbsSurface&>();
            return lent(made.weights(), {made.count_v(), made.count_u()}, self);
          },
          "[count_v, count_u]: a read-only view.")
      .def_property_readonly("knots_u",
                             [](const py::object& self) {
                               const auto all = self.cast<const NurbsSurface&>().knots_u();
                               return lent(all, {static_cast<py::ssize_t>(all.size())}, self);
                             })
      .def_property_readonly("knots_v", [](const py::object& self) {
        const auto all = self.cast<const NurbsSurface&>().knots_v();
        return lent(all, {static_cast<py::ssize_t>(all.size())}, self);
      });
}

}  // namespace

void add_surface(py::module_& module) {
  py::class_<NurbsSurface> surface(
      module, "Surface", "A NURBS surface (u, v) -> R^dim: a curve of curves, immutable.");
  surface
      .def(py::init(&make_surface), py::arg("points"), py::arg("degree_u") = 3,
           py::arg("degree_v") = 3, py::arg("weights") = py::none(),
           py::arg("knots_u") = py::none(), py::arg("knots_v") = py::none(),
           py::arg("periodic_u") = false, py::arg("name") = "",
           "points [count_v, count_u] or [count_v, count_u, dim]: rows of u, one row a v; weights\n"
           "[count_v, count_u]; knots as of Curve. periodic_u: rows are closed.")
      .def("spec", &spec_of, "The arguments that make an equal surface: Surface(**s.spec()).")
      .def(
          "__eq__", [](const NurbsSurface& a, const NurbsSurface& b) { return a == b; },
          py::is_operator())
      .def("__call__", &evaluate, py::arg("u"), py::arg("v"),
           "S(u, v): u and v are broadcast to one shape [...], which gives [...], or [..., dim]\n"
           "where dim is above 1.")
      .def("grid", &grid, py::arg("u"), py::arg("v"),
           "S at every (u[i], v[j]): [len(v), len(u)] or [len(v), len(u), dim].")
      .def("derivatives", &derivatives, py::arg("u"), py::arg("v"), py::arg("order") = 1,
           "d^(k+l)S / du^k dv^l at [k, l] of [order + 1, order + 1] (and dim); 0 where k + l is\n"
           "above order, which is 0..15.")
      .def("iso_curve_at_v", &NurbsSurface::iso_curve_at_v, py::arg("v"), WithoutGil(),
           "The curve u -> S(u, v).")
      .def("iso_curve_at_u", &NurbsSurface::iso_curve_at_u, py::arg("u"), WithoutGil(),
           "The curve v -> S(u, v).")
      .def("_repr_svg_", [](const NurbsSurface& self) { return curves::plot_svg(self); });
  add_properties(surface);
  add_surface_edits(surface);
}

}  // namespace knotwave::python

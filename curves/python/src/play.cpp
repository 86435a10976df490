// SPDX-License-Identifier: MIT
// knotwave.JoinProgram, FastProgram, MovingCurve and TrimRegion.
#include <limits>

#include "knotwave/curves/compile.h"
#include "knotwave/curves/fast_program.h"
#include "knotwave/curves/moving_curve.h"
#include "knotwave/curves/trim_region.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using base::index_of;
using curves::FastProgram;
using curves::JoinProgram;
using curves::MovingCurve;
using curves::NurbsCurve;
using curves::TrimRegion;

py::tuple deltas_of(const JoinProgram::Deltas& deltas) {
  return py::make_tuple(deltas.dp0, deltas.dp1, deltas.limited);
}

void add_join(py::module_& module) {
  py::class_<JoinProgram>(module, "JoinProgram",
                          "A section that starts from any value and slope: it plays program(u) +\n"
                          "dp0 * basis(u, 0) + dp1 * basis(u, 1).")
      .def_readonly("basis", &JoinProgram::basis, "A Program of two coordinates.")
      .def_readonly("u_join", &JoinProgram::u_join)
      .def_readonly(
          "u_basis_end", &JoinProgram::u_basis_end,
          "From here on both bases are 0. But a join of degree 1 in the last span has basis 1 = 1\n"
          "at the end; it doesn't sound, as such a join never moves P1.")
      .def_readonly("moves_p1", &JoinProgram::moves_p1, "Whether a join takes a slope on.")
      .def(
          "start",
          [](const JoinProgram& self, double value, const std::optional<double>& slope) {
            return deltas_of(slope ? self.join(value, *slope) : self.join_c0(value));
          },
          py::arg("value"), py::arg("slope") = py::none(),
          "(dp0, dp1, limited) to start at that value, with that slope by u or the curve's own.");
  module.def(
      "compile_join",
      [](const NurbsCurve& curve, double u_join, double max_error, int max_pieces) {
        return take(curves::compile_join(curve, u_join, {max_error, max_pieces, {}}));
      },
      py::arg("curve"), py::arg("u_join"), py::arg("max_error") = 1e-7,
      py::arg("max_pieces") = 4096, WithoutGil(), "A JoinProgram at u_join.");
}

void check_coordinate_of(const FastProgram& program, int coordinate) {
  if (coordinate >= 0 && coordinate < program.accurate().dim()) return;
  throw Fault{fail(ErrorCode::dimension_mismatch,
                   "the program has no coordinate " + std::to_string(coordinate) + ", only 0 to " +
                       std::to_string(program.accurate().dim() - 1))};
}

py::array_t<float> render(const FastProgram& program, double origin, double step, py::ssize_t count,
                          std::int64_t first, int coordinate) {
  check_coordinate_of(program, coordinate);
  if (count < 0) {
    throw Fault{fail(ErrorCode::value_out_of_range, "count is " + std::to_string(count))};
  }
  py::array_t<float> out(Shape{count});
  const std::span<float> samples(out.mutable_data(), static_cast<std::size_t>(count));
  const py::gil_scoped_release others_go_on;
  curves::CurveCursor cursor;
  program.render(curves::GridRun{origin, step, first}, samples, cursor, coordinate);
  return out;
}

void add_fast(py::module_& module) {
  py::class_<FastProgram>(module, "FastProgram",
                          "A Program in float32: several times as fast, with a proved error.")
      .def(py::init([](const curves::CurveProgram& program, double max_error) {
             return FastProgram(program, max_error);
           }),
           py::arg("program"), py::arg("max_error") = std::numeric_limits<double>::infinity(),
           "Pieces whose float32 error would be above max_error are played in double.")
      .def(
          "max_error",
          [](const FastProgram& self, int coordinate) {
            check_coordinate_of(self, coordinate);
            return self.max_error(coordinate);
          },
          py::arg("coordinate") = 0, "No sample is farther from the curve: proved.")
      .def(
          "fast_piece_count",
          [](const FastProgram& self, int coordinate) {
            check_coordinate_of(self, coordinate);
            return self.fast_piece_count(coordinate);
          },
          py::arg("coordinate") = 0, "How many pieces are played in float32.")
      .def("render", &render, py::arg("origin"), py::arg("step"), py::arg("count"),
           py::arg("first") = 0, py::arg("coordinate") = 0,
           "[count] float32: values at origin + (first + i) * step.");
}

py::object moving_at(const MovingCurve& curve, const Array& times, const Array& points) {
  const auto count = static_cast<py::ssize_t>(curve.point_count());
  const bool is_row = points.ndim() == 2;
  const bool fits =
      (is_row || (points.ndim() == 3 && times.ndim() == 1 && points.shape(0) == times.shape(0))) &&
      points.shape(points.ndim() - 2) == count && points.shape(points.ndim() - 1) == 2;
  if (!fits) {
    throw Fault{fail(ErrorCode::dimension_mismatch, "points are [" + std::to_string(count) +
                                                        ", 2], or [n, " + std::to_string(count) +
                                                        ", 2] for times [n]")};
  }
  py::array_t<double> out(shape_of(times));
  const auto places = numbers(times), all = numbers(points);
  const std::span<double> values = numbers(out);
  const std::size_t row = 2 * index_of(curve.point_count());
  {
    const py::gil_scoped_release others_go_on;
    for (std::size_t i = 0; i < places.size(); ++i) {
      values[i] = curve.at(places[i], is_row ? all : all.subspan(i * row, row));
    }
  }
  return scalar_or(std::move(out));
}

void add_moving(py::module_& module) {
  py::class_<MovingCurve>(module, "MovingCurve",
                          "y at a time, of a curve (time, value) whose points move.")
      .def(py::init([](const NurbsCurve& curve) { return take(MovingCurve::create(curve)); }),
           py::arg("curve"), "Degree (7 at most), knots, weights and jumps of a 2-D curve.")
      .def_property_readonly("degree", &MovingCurve::degree)
      .def_property_readonly("point_count", &MovingCurve::point_count)
      .def_property_readonly("halvings", &MovingCurve::halvings)
      .def("__call__", &moving_at, py::arg("times"), py::arg("points"),
           "[...] at times [...] with points [point_count, 2]; or at times [n] with points\n"
           "[n, point_count, 2], one set for each.");
}

py::array_t<double> rows_of(const std::vector<curves::Interval>& kept) {
  std::vector<double> ends;
  for (const auto& [low, high] : kept) ends.insert(ends.end(), {low, high});
  return new_array(ends, {static_cast<py::ssize_t>(kept.size()), 2});
}

py::object contains(const TrimRegion& region, const Array& u, const Array& v) {
  const auto [all_u, all_v] = broadcast(u, v);
  py::array_t<bool> out(shape_of(all_u));
  for (py::ssize_t i = 0; i < out.size(); ++i) {
    out.mutable_data()[i] = region.contains(all_u.data()[i], all_v.data()[i]);
  }
  return scalar_or(std::move(out));
}

void add_region(py::module_& module) {
  py::class_<TrimRegion>(module, "TrimRegion", "A part of the (u, v) plane inside closed curves.")
      .def(py::init([](const std::vector<curves::TrimLoop>& loops, double tolerance) {
             return take(TrimRegion::create(loops, tolerance));
           }),
           py::arg("loops"), py::arg("tolerance") = 1e-9,
           "A list of loops, each a list of 2-D curves end to end: counter-clockwise ones keep\n"
           "their inside, clockwise ones the outside.")
      .def_property_readonly("is_unbounded", &TrimRegion::is_unbounded,
                             "Whether what lies beyond all loops is kept.")
      .def("contains", &contains, py::arg("u"), py::arg("v"),
           "Whether (u, v) is kept: [...] for u and v broadcast to one shape.")
      .def(
          "intervals_at_v",
          [](const TrimRegion& self, double v) { return rows_of(self.intervals_at_v(v)); },
          py::arg("v"), "[m, 2]: low and high of what is kept at this v.")
      .def(
          "intervals_at_u",
          [](const TrimRegion& self, double u) { return rows_of(self.intervals_at_u(u)); },
          py::arg("u"), "[m, 2]: the same at this u.");
  module.def(
      "rectangle_loop",
      [](double u_low, double u_high, double v_low, double v_high) {
        return take(curves::rectangle_loop(u_low, u_high, v_low, v_high));
      },
      py::arg("u_low"), py::arg("u_high"), py::arg("v_low"), py::arg("v_high"),
      "A loop (a list of one curve) that keeps the inside of a rectangle.");
}

}  // namespace

void add_play(py::module_& module) {
  add_join(module);
  add_fast(module);
  add_moving(module);
  add_region(module);
}

}  // namespace knotwave::python

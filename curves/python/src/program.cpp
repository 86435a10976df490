// SPDX-License-Identifier: MIT
// knotwave.Program: curves compiled to what an audio thread plays, rendered into numpy arrays.
#include "knotwave/curves/compile.h"
#include "knotwave/curves/curve_program.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using base::index_of;
using curves::CompileOptions;
using curves::ControlRange;
using curves::CurveProgram;
using curves::NurbsCurve;

ControlRange make_control(std::string_view kind, int point, double low, double high,
                          int coordinate) {
  constexpr std::string_view kWords[] = {"weight", "coordinate", "knot"};
  constexpr ControlRange::Kind kKinds[] = {
      ControlRange::Kind::weight, ControlRange::Kind::coordinate, ControlRange::Kind::knot};
  return {kKinds[choice("kind", kind, kWords)], point, coordinate, low, high};
}

using Compiler = Result<CurveProgram> (*)(const NurbsCurve&, const CompileOptions&);

template <Compiler kCompile>
CurveProgram compile_with(const NurbsCurve& curve, double max_error, int max_pieces,
                          const std::vector<ControlRange>& controls) {
  return take(kCompile(curve, {max_error, max_pieces, controls}));
}

void check_coordinate_of(const CurveProgram& program, int coordinate, int rows) {
  if (coordinate >= 0 && coordinate < rows) return;
  throw Fault{fail(ErrorCode::dimension_mismatch,
                   "the program has no coordinate " + std::to_string(coordinate) + ", only 0 to " +
                       std::to_string(rows - 1) + (program.is_rational() ? " (rational)" : ""))};
}

void check_coordinate_of(const CurveProgram& program, int coordinate) {
  check_coordinate_of(program, coordinate, program.dim());
}

py::object evaluate(const CurveProgram& program, const Array& u, int coordinate,
                    const std::optional<Array>& controls) {
  check_coordinate_of(program, coordinate);
  const std::size_t count = index_of(program.control_count());
  if (controls && static_cast<std::size_t>(controls->size()) != count) {
    throw Fault{fail(
        ErrorCode::dimension_mismatch,
        std::to_string(controls->size()) + " controls, the program has " + std::to_string(count))};
  }
  py::array_t<double> out(shape_of(u));
  const auto places = numbers(u);
  const auto moved = controls ? row("controls", *controls) : std::span<const double>();
  const std::span<double> values = numbers(out);
  {
    const py::gil_scoped_release others_go_on;
    if (moved.empty()) {
      curves::CurveCursor cursor;
      program.render(places, values, cursor, coordinate);
    } else {
      for (std::size_t i = 0; i < places.size(); ++i) {
        values[i] = program.at_u(places[i], coordinate, moved);
      }
    }
  }
  return scalar_or(std::move(out));
}

/// Calls `render` with the samples of `out`, floats or doubles, which must be one block of memory.
template <class Render>
void render_into(py::array& out, Render&& render) {
  const bool is_float = py::isinstance<py::array_t<float>>(out);
  const bool is_block = (out.flags() & py::array::c_style) != 0 && out.writeable();
  if ((!is_float && !py::isinstance<py::array_t<double>>(out)) || !is_block || out.ndim() != 1) {
    throw Fault{fail(ErrorCode::wrong_type,
                     "out must be a writable contiguous array [n] of float32 or float64")};
  }
  const auto count = static_cast<std::size_t>(out.size());
  void* const samples = out.mutable_data();
  const py::gil_scoped_release others_go_on;
  if (is_float) {
    render(std::span<float>(static_cast<float*>(samples), count));
  } else {
    render(std::span<double>(static_cast<double*>(samples), count));
  }
}

py::array render(const CurveProgram& program, double origin, double step,
                 const std::optional<py::ssize_t>& count, std::int64_t first, int coordinate,
                 std::optional<py::array> out) {
  check_coordinate_of(program, coordinate);
  if (out.has_value() == count.has_value()) {
    throw Fault{fail(ErrorCode::malformed, "give either count or out")};
  }
  if (count && *count < 0) {
    throw Fault{fail(ErrorCode::value_out_of_range, "count is " + std::to_string(*count))};
  }
  py::array block = out ? *out : py::array(py::array_t<double>(Shape{*count}));
  render_into(block, [&](auto samples) {
    curves::CurveCursor cursor;
    program.render(curves::GridRun{origin, step, first}, samples, cursor, coordinate);
  });
  return block;
}

py::array_t<float> grid(const CurveProgram& program, double u1, double u2, std::int64_t n) {
  constexpr std::int64_t kMost = std::int64_t(1) << 40;
  if (n < 1 || n > kMost) {
    throw Fault{fail(ErrorCode::value_out_of_range, "a grid of " + std::to_string(n) + " steps")};
  }
  py::array_t<float> out(Shape{static_cast<py::ssize_t>(n) + 1});
  const std::span<float> samples(out.mutable_data(), static_cast<std::size_t>(n) + 1);
  const py::gil_scoped_release others_go_on;
  program.evaluate_grid({u1, u2, n}, 0, samples);
  return out;
}

void add_compilers(py::module_& module) {
  py::class_<ControlRange>(module, "Control",
                           "Something that may be moved while a curve plays, with its range.")
      .def(py::init(&make_control), py::arg("kind"), py::arg("point"), py::arg("low"),
           py::arg("high"), py::arg("coordinate") = 0,
           "kind 'weight', 'coordinate' or 'knot'; point (or knot) from 0; low and high in\n"
           "absolute values.");
  const std::vector<ControlRange> none;
  module
      .def("compile_function", &compile_with<curves::compile_function>, py::arg("curve"),
           py::arg("max_error") = 1e-7, py::arg("max_pieces") = 4096, py::arg("controls") = none,
           WithoutGil(),
           "A curve as a function: of u (dim 1), or of its first coordinate, the time (dim 2).")
      .def("compile_parametric", &compile_with<curves::compile_parametric>, py::arg("curve"),
           py::arg("max_error") = 1e-7, py::arg("max_pieces") = 4096, py::arg("controls") = none,
           WithoutGil(), "Every coordinate as a function of u.")
      .def("compile_polynomial", &compile_with<curves::compile_polynomial>, py::arg("curve"),
           py::arg("max_error") = 1e-7, py::arg("max_pieces") = 4096, py::arg("controls") = none,
           WithoutGil(), "The same, rational spans too as polynomial pieces within max_error.");
}

void add_properties(py::class_<CurveProgram>& program) {
  program.def_property_readonly("dim", &CurveProgram::dim)
      .def_property_readonly("is_rational", &CurveProgram::is_rational)
      .def_property_readonly("is_periodic", &CurveProgram::is_periodic)
      .def_property_readonly("piece_count", &CurveProgram::piece_count)
      .def_property_readonly("piece_degree", &CurveProgram::piece_degree)
      .def_property_readonly("u_min", &CurveProgram::u_min)
      .def_property_readonly("u_max", &CurveProgram::u_max)
      .def_property_readonly("max_error", &CurveProgram::max_error,
                             "Largest |program - curve| that was measured.")
      .def_property_readonly("control_count", &CurveProgram::control_count)
      .def_property_readonly(
          "breaks",
          [](const py::object& self) {
            const auto all = self.cast<const CurveProgram&>().breaks();
            return lent(all, {static_cast<py::ssize_t>(all.size())}, self);
          },
          "[piece_count + 1]: where pieces meet; a read-only view.");
}

}  // namespace

void add_program(py::module_& module) {
  add_compilers(module);
  py::class_<CurveProgram> program(
      module, "Program", "A curve as an audio thread plays it: pieces with a measured error.");
  program
      .def("__call__", &evaluate, py::arg("u"), py::arg("coordinate") = 0,
           py::arg("controls") = py::none(),
           "Values of one coordinate: [...] for u [...]. controls [control_count], rest values\n"
           "without.")
      .def("render", &render, py::arg("origin"), py::arg("step"), py::arg("count") = py::none(),
           py::arg("first") = 0, py::arg("coordinate") = 0, py::arg("out") = py::none(),
           "Values at origin + (first + i) * step: [count], or written to out [n] (float32 or\n"
           "float64), which is given back. Any split into blocks gives the same bits.")
      .def("grid", &grid, py::arg("u1") = 0.0, py::arg("u2") = 1.0, py::arg("n") = 256,
           "[n + 1] float32: n steps from u1 to u2, both ends exact (glMapGrid).")
      .def(
          "range",
          [](const CurveProgram& self, int coordinate) {
            check_coordinate_of(self, coordinate);
            return std::pair(self.low(coordinate), self.high(coordinate));
          },
          py::arg("coordinate") = 0, "(low, high): what a coordinate never leaves.")
      .def(
          "coefficients",
          [](const py::object& self, int piece, int coordinate) {
            const auto& made = self.cast<const CurveProgram&>();
            check_coordinate_of(made, coordinate, made.dim() + (made.is_rational() ? 1 : 0));
            if (piece < 0 || piece >= made.piece_count()) {
              throw Fault{fail(ErrorCode::parameter_out_of_range,
                               "the program has no piece " + std::to_string(piece))};
            }
            return lent(made.coefficients(piece, coordinate), {made.piece_degree() + 1}, self);
          },
          py::arg("piece"), py::arg("coordinate") = 0,
          "[piece_degree + 1]: powers of the part of the piece that is past, lowest first; a\n"
          "read-only view. Coordinate dim of a rational program is the denominator.");
  add_properties(program);
}

}  // namespace knotwave::python

// SPDX-License-Identifier: MIT
// The Python module: what all its parts share, and its exception.
#include <algorithm>

#include "knotwave/base/suggest.h"

#include "arrays.h"

namespace knotwave::python {

std::vector<double> copied(const std::optional<Array>& array) {
  if (!array) return {};
  const auto all = numbers(*array);
  return {all.begin(), all.end()};
}

py::array_t<double> new_array(std::span<const double> values, Shape shape) {
  py::array_t<double> array(std::move(shape));
  std::copy(values.begin(), values.end(), array.mutable_data());
  return array;
}

int dim_of(const Array& points) {
  if (points.ndim() == 1) return 1;
  if (points.ndim() == 2 && points.shape(1) >= 1 && points.shape(1) <= curves::kMaxDim) {
    return static_cast<int>(points.shape(1));
  }
  std::string shape;
  for (const py::ssize_t size : shape_of(points)) {
    shape += (shape.empty() ? "" : ", ") + std::to_string(size);
  }
  throw Fault{fail(ErrorCode::dimension_mismatch,
                   "points have the shape [" + shape + "], not [n] or [n, 1..4]")};
}

Shape with_dim(Shape shape, int dim) {
  if (dim > 1) shape.push_back(dim);
  return shape;
}

py::object scalar_or(py::array array) {
  if (array.ndim() > 0) return array;
  return array.attr("__getitem__")(py::tuple());
}

py::array_t<double> lent(std::span<const double> values, Shape shape, py::handle owner) {
  py::array_t<double> view(std::move(shape), values.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

std::size_t choice(std::string_view what, std::string_view word,
                   std::span<const std::string_view> choices) {
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  std::string all;
  for (const std::string_view one : choices) {
    all += (all.empty() ? "'" : ", '") + std::string(one) + "'";
  }
  throw Fault{fail(ErrorCode::unknown_name, std::string(what) + " is '" + std::string(word) +
                                                "', none of " + all +
                                                base::suggestion(word, choices))};
}

curves::Side side_of(std::string_view side) {
  constexpr std::string_view kSides[] = {"left", "right"};
  return choice("side", side, kSides) == 0 ? curves::Side::left : curves::Side::right;
}

void check_coordinate(const curves::NurbsCurve& curve, int coordinate) {
  if (coordinate >= 0 && coordinate < curve.dim()) return;
  throw Fault{fail(ErrorCode::dimension_mismatch,
                   "curve '" + curve.name() + "' has no coordinate " + std::to_string(coordinate) +
                       ", only 0 to " + std::to_string(curve.dim() - 1))};
}

void check_order(int order) {
  constexpr int kMost = 1000;
  if (order >= 0 && order <= kMost) return;
  throw Fault{fail(ErrorCode::value_out_of_range,
                   "order " + std::to_string(order) + " is not within 0..1000")};
}

namespace {

PyObject* error_type = nullptr;  // made once, with the module

void set_python_error(const Error& error) {
  const std::string text = error.source.empty() ? error.message : error.to_string();
  py::object made = py::reinterpret_borrow<py::object>(error_type)(text);
  made.attr("code") = base::to_string(error.code);
  made.attr("source") = error.source;
  made.attr("line") = error.line;
  made.attr("column") = error.column;
  PyErr_SetObject(error_type, made.ptr());
}

void add_error(py::module_& module) {
  error_type = PyErr_NewExceptionWithDoc(
      "knotwave.Error",
      "What the library could not do, in one sentence with names, indexes and numbers.\n\n"
      "code: the fault as a word, such as 'knots_decrease' (knotwave/base/result.h lists them).\n"
      "source, line, column: where in a file; '', 0 and 0 where there is none.",
      PyExc_ValueError, nullptr);
  if (error_type == nullptr) throw py::error_already_set();
  module.add_object("Error", error_type);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Fault& fault) {
      set_python_error(fault.error);
    }
  });
}

}  // namespace
}  // namespace knotwave::python

PYBIND11_MODULE(_knotwave, module) {
  using namespace knotwave::python;
  module.attr("__name__") = "knotwave";  // where users find what is defined here
  add_error(module);
  add_curve(module);
  add_combinations(module);
  add_surface(module);
  add_program(module);
  add_maps(module);
  add_files(module);
  add_shapes(module);
  add_fits(module);
  add_surface_shapes(module);
  add_play(module);
  module.attr("__version__") = KNOTWAVE_VERSION;
}

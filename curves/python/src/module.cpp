// SPDX-License-Identifier: MIT
// The Python module: what all its parts share, and its exception.
#include <algorithm>

#include "knotwave/base/suggest.h"

#include "arrays.h"

namespace knotwave::python {

namespace {

py::object numpy(const char* name) { return py::module_::import("numpy").attr(name); }

/// Whether every number came through: read back as `given` they are the same.
bool is_without_loss(const py::array& given, const py::array& doubles) {
  const char kind = given.dtype().kind();
  if (kind == 'b' || (kind == 'f' && given.itemsize() <= py::ssize_t{sizeof(double)})) return true;
  if (kind == 'i' || kind == 'u') {
    constexpr std::int64_t kMost = std::int64_t{1} << 53;  // up to it doubles skip no whole number
    if (given.itemsize() <= 4 || given.size() == 0) return true;
    const py::int_ least = given.attr("min")(), most = given.attr("max")();
    if (least >= py::int_(-kMost) && most <= py::int_(kMost)) return true;
    for (const py::handle one : given.attr("ravel")().attr("tolist")()) {
      const py::object back = py::int_(py::float_(py::reinterpret_borrow<py::object>(one)));
      if (!back.equal(one)) return false;
    }
    return true;
  }
  const py::object same = doubles.attr("__eq__")(given), nan = numpy("isnan")(doubles);
  return py::cast<bool>(py::bool_(numpy("all")(numpy("logical_or")(same, nan))));
}

/// Lists of numbers of Python's own that numpy has no type for: whole numbers beyond 64 bits and
/// fractions.
bool are_numbers(const py::array& objects) {
  const py::object number = py::module_::import("numbers").attr("Number");
  for (const py::handle one : objects.attr("ravel")()) {
    if (!py::isinstance(one, number)) return false;
  }
  return true;
}

Error no_double_holds(const py::array& given, const std::string& what_helps) {
  return fail(ErrorCode::value_out_of_range,
              "an array of " + std::string(py::str(given.dtype())) +
                  " has numbers that no double holds: " + what_helps);
}

Array doubles_of(const py::array& given) {
  try {
    return Array(Array::Base(numpy("asarray")(given, "float64", "C")));
  } catch (const py::error_already_set& fault) {
    if (!fault.matches(PyExc_OverflowError)) throw;
    throw Fault{no_double_holds(given, "the largest is 1.8e308")};
  }
}

}  // namespace

Array array_of(py::handle given) {
  if (py::array_t<double, py::array::c_style>::check_(given) &&
      Py_TYPE(given.ptr()) == py::detail::npy_api::get().PyArray_Type_) {
    return Array(py::reinterpret_borrow<Array::Base>(given));
  }
  if (PyFloat_Check(given.ptr())) {
    Array::Base one(Shape{});
    *one.mutable_data() = PyFloat_AS_DOUBLE(given.ptr());
    return Array(std::move(one));
  }
  const py::object masked = py::module_::import("numpy.ma").attr("is_masked")(given);
  if (masked.cast<bool>()) {
    throw py::type_error("an array with masked values: say what they are with .filled()");
  }
  const py::array all = numpy("asarray")(given);
  const char kind = all.dtype().kind();
  const bool is_number = std::string_view("biuf").find(kind) != std::string_view::npos;
  if (!is_number && !(kind == 'O' && are_numbers(all))) {
    throw py::type_error("no numbers: " + std::string(py::str(py::repr(given))).substr(0, 80));
  }
  Array doubles = doubles_of(all);
  if (!is_without_loss(all, doubles)) {
    throw Fault{no_double_holds(all, "round them with .astype(float)")};
  }
  return doubles;
}

std::string shape_text(const Shape& shape) {
  std::string text;
  for (const py::ssize_t size : shape) {
    text += (text.empty() ? "" : ", ") + std::to_string(size);
  }
  return "[" + text + "]";
}

void check_shape(const char* name, const Array& array, const Shape& wanted) {
  if (shape_of(array) == wanted) return;
  throw Fault{fail(ErrorCode::dimension_mismatch, std::string(name) + " have the shape " +
                                                      shape_text(shape_of(array)) + ", not " +
                                                      shape_text(wanted))};
}

std::span<const double> row(const char* name, const Array& array) {
  if (array.ndim() <= 1) return numbers(array);
  throw Fault{fail(ErrorCode::dimension_mismatch,
                   std::string(name) + ": the shape is " + shape_text(shape_of(array)) +
                       ", not that of a row, [" + std::to_string(array.size()) + "]")};
}

std::vector<double> copied_row(const char* name, const std::optional<Array>& array) {
  if (!array) return {};
  const auto all = row(name, *array);
  return {all.begin(), all.end()};
}

std::pair<Array, Array> broadcast(const Array& u, const Array& v) {
  const py::object both = numpy("broadcast_arrays")(u, v);
  const auto pair = py::reinterpret_borrow<py::sequence>(both);
  return {array_of(pair[0]), array_of(pair[1])};
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
  throw Fault{
      fail(ErrorCode::dimension_mismatch,
           "points have the shape " + shape_text(shape_of(points)) + ", not [n] or [n, 1..4]")};
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

void check_pixels(int width_px, int height_px) {
  constexpr int kLeast = 64, kMost = 16384;
  if (std::min(width_px, height_px) >= kLeast && std::max(width_px, height_px) <= kMost) return;
  throw Fault{fail(ErrorCode::value_out_of_range, "a picture of " + std::to_string(width_px) +
                                                      " by " + std::to_string(height_px) +
                                                      " pixels: each must be 64 to 16384")};
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

/// An object whose __init__ never ran holds nothing. pybind11 would make room for it, unfilled, as
/// soon as it is used.
void* refuse_unmade(std::size_t) {
  throw py::type_error("an object of knotwave that was never made: its __init__ has not run");
}

void refuse_what_was_never_made(const py::module_& module) {
  for (const auto& [name, item] : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(item.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(item.ptr());
    if (auto* const known = py::detail::get_type_info(type)) known->operator_new = &refuse_unmade;
  }
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
  refuse_what_was_never_made(module);
  module.attr("__version__") = KNOTWAVE_VERSION;
}

// SPDX-License-Identifier: MIT
// Between numpy arrays and the library's spans, and results that are exceptions in Python.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "knotwave/base/index.h"
#include "knotwave/base/result.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::python {

namespace py = pybind11;

/// What is doubles without loss: numbers, lists, arrays of floats and of integers that a double
/// holds. A contiguous array of doubles is not copied. None, texts and masked values are no
/// numbers.
class Array : public py::array_t<double, py::array::c_style> {
 public:
  using Base = py::array_t<double, py::array::c_style>;
  using Base::Base;
  explicit Array(Base numbers) : Base(std::move(numbers)) {}
};
/// The numbers of an argument. Throws type_error, or value_out_of_range where a digit would be
/// lost.
Array array_of(py::handle given);
using Shape = std::vector<py::ssize_t>;

/// An Error on its way to a knotwave.Error.
struct Fault {
  Error error;
};

/// The value, or the exception.
template <class T>
T take(Result<T> result) {
  if (!result) throw Fault{std::move(result).error()};
  return std::move(*result);
}

/// For calls that may take long: other threads of Python go on meanwhile. The arguments of such a
/// function are references, so that none is given up inside.
using WithoutGil = py::call_guard<py::gil_scoped_release>;

inline std::span<const double> numbers(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}
inline std::span<double> numbers(py::array_t<double>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}
/// The numbers of an array [n], or one number; `name` is for the message. Errors:
/// dimension_mismatch.
std::span<const double> row(const char* name, const Array& array);
/// The same as a copy, none without.
std::vector<double> copied_row(const char* name, const std::optional<Array>& array);
/// For messages: "[4, 2]".
std::string shape_text(const Shape& shape);
/// Errors: dimension_mismatch, with both shapes.
void check_shape(const char* name, const Array& array, const Shape& wanted);
py::array_t<double> new_array(std::span<const double> values, Shape shape);

/// Points [n] have one coordinate, points [n, dim] have dim. Errors: dimension_mismatch.
int dim_of(const Array& points);
/// The shape of something, one value of `dim` coordinates each: nothing is added where dim is 1.
Shape with_dim(Shape shape, int dim);
inline Shape shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}
/// u and v with one shape.
std::pair<Array, Array> broadcast(const Array& u, const Array& v);
/// A number instead of an array without dimensions.
py::object scalar_or(py::array array);

/// A read-only view of numbers that `owner` keeps alive.
py::array_t<double> lent(std::span<const double> values, Shape shape, py::handle owner);

/// Index of `word` in `choices`, or unknown_name with a suggestion.
std::size_t choice(std::string_view what, std::string_view word,
                   std::span<const std::string_view> choices);
curves::Side side_of(std::string_view side);
/// A picture's size, 64 to 16384 each way. Errors: value_out_of_range.
void check_pixels(int width_px, int height_px);

/// Errors: dimension_mismatch.
void check_coordinate(const curves::NurbsCurve& curve, int coordinate);
/// A derivative's order, 0..1000. Errors: value_out_of_range.
void check_order(int order);

// Each adds its part of the module.
void add_curve(py::module_& module);
void add_edits(py::class_<curves::NurbsCurve>& curve);
void add_analyses(py::module_& module, py::class_<curves::NurbsCurve>& curve);
void add_combinations(py::module_& module);
void add_surface(py::module_& module);
void add_surface_edits(py::class_<curves::NurbsSurface>& surface);
void add_surface_shapes(py::module_& module);
void add_play(py::module_& module);
void add_program(py::module_& module);
void add_maps(py::module_& module);
void add_files(py::module_& module);
void add_shapes(py::module_& module);
void add_fits(py::module_& module);

}  // namespace knotwave::python

namespace pybind11::detail {

template <>
struct handle_type_name<knotwave::python::Array> : handle_type_name<knotwave::python::Array::Base> {
};
template <>
struct pyobject_caster<knotwave::python::Array> {
  using type = knotwave::python::Array;
  bool load(handle from, bool convert) {
    if (!convert && !type::check_(from)) return false;
    value = knotwave::python::array_of(from);
    return true;
  }
  static handle cast(const handle& from, return_value_policy, handle) { return from.inc_ref(); }
  PYBIND11_TYPE_CASTER(type, handle_type_name<type>::name);
};

}  // namespace pybind11::detail

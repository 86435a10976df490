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

/// What numpy turns into doubles without loss: numbers, lists, integer arrays. A contiguous array
/// of doubles is not copied.
using Array = py::array_t<double, py::array::c_style>;
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
std::vector<double> copied(const std::optional<Array>& array);
py::array_t<double> new_array(std::span<const double> values, Shape shape);

/// Points [n] have one coordinate, points [n, dim] have dim. Errors: dimension_mismatch.
int dim_of(const Array& points);
/// The shape of something, one value of `dim` coordinates each: nothing is added where dim is 1.
Shape with_dim(Shape shape, int dim);
inline Shape shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}
/// A number instead of an array without dimensions.
py::object scalar_or(py::array array);

/// A read-only view of numbers that `owner` keeps alive.
py::array_t<double> lent(std::span<const double> values, Shape shape, py::handle owner);

/// Index of `word` in `choices`, or unknown_name with a suggestion.
std::size_t choice(std::string_view what, std::string_view word,
                   std::span<const std::string_view> choices);
curves::Side side_of(std::string_view side);

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

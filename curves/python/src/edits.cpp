// SPDX-License-Identifier: MIT
// Methods of knotwave.Curve that make other curves.
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/monotone.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "arrays.h"

namespace knotwave::python {
namespace {

using base::index_of;
using curves::BezierSegment;
using curves::NurbsCurve;

NurbsCurve regularize(const NurbsCurve& curve, std::string_view mode) {
  constexpr std::string_view kWords[] = {"none",       "contain",      "keep_start",
                                         "keep_ratio", "limit_active", "limit_opposite"};
  constexpr curves::Regularization kModes[] = {
      curves::Regularization::none,         curves::Regularization::contain,
      curves::Regularization::keep_start,   curves::Regularization::keep_ratio,
      curves::Regularization::limit_active, curves::Regularization::limit_opposite};
  return take(curves::regularize(curve, kModes[choice("mode", mode, kWords)]));
}

py::tuple to_bezier(const NurbsCurve& curve) {
  std::vector<double> ends{curve.u_min()}, points, weights;
  for (const BezierSegment& segment : curves::to_bezier(curve)) {
    ends.push_back(segment.u1);
    points.insert(points.end(), segment.points.begin(), segment.points.end());
    weights.insert(weights.end(), segment.weights.begin(), segment.weights.end());
  }
  const auto count = static_cast<py::ssize_t>(ends.size()) - 1;
  const py::ssize_t row = curve.degree() + 1;
  return py::make_tuple(new_array(ends, {count + 1}),
                        new_array(points, with_dim({count, row}, curve.dim())),
                        new_array(weights, {count, row}));
}

NurbsCurve from_bezier(const Array& ends, const Array& points, const std::optional<Array>& weights,
                       double join_tolerance) {
  const py::ssize_t count = ends.size() - 1;
  const bool has_shape = ends.ndim() == 1 && (points.ndim() == 2 || points.ndim() == 3);
  if (count < 1 || !has_shape || points.shape(0) != count ||
      (weights && (weights->ndim() != 2 || weights->shape(0) != count ||
                   weights->shape(1) != points.shape(1)))) {
    throw Fault{fail(ErrorCode::dimension_mismatch,
                     "ends [s + 1] go with points [s, degree + 1] or [s, degree + 1, dim] and "
                     "weights [s, degree + 1]; there are " +
                         std::to_string(ends.size()) + " ends")};
  }
  const auto row = static_cast<std::size_t>(points.shape(1));
  const auto dim = points.ndim() == 3 ? static_cast<std::size_t>(points.shape(2)) : 1;
  std::vector<BezierSegment> segments;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    BezierSegment segment{numbers(ends)[i],
                          numbers(ends)[i + 1],
                          static_cast<int>(row) - 1,
                          static_cast<int>(dim),
                          {},
                          {}};
    const auto all = numbers(points).subspan(i * row * dim, row * dim);
    segment.points.assign(all.begin(), all.end());
    segment.weights.assign(row, 1.0);
    if (weights) {
      const auto given = numbers(*weights).subspan(i * row, row);
      segment.weights.assign(given.begin(), given.end());
    }
    segments.push_back(std::move(segment));
  }
  return take(curves::from_bezier(segments, join_tolerance));
}

py::tuple to_power_basis(const NurbsCurve& curve) {
  std::vector<double> ends{curve.u_min()}, numerators, denominators;
  for (const curves::PowerSegment& piece : curves::to_power_basis(curve)) {
    ends.push_back(piece.u1);
    numerators.insert(numerators.end(), piece.numerator.begin(), piece.numerator.end());
    if (piece.denominator.empty()) {
      denominators.push_back(1);
      denominators.resize(denominators.size() + index_of(piece.degree), 0.0);
    } else {
      denominators.insert(denominators.end(), piece.denominator.begin(), piece.denominator.end());
    }
  }
  const auto count = static_cast<py::ssize_t>(ends.size()) - 1;
  const py::ssize_t row = curve.degree() + 1;
  return py::make_tuple(new_array(ends, {count + 1}),
                        new_array(numerators, with_dim({count, row}, curve.dim())),
                        new_array(denominators, {count, row}));
}

void add_exact_edits(py::class_<NurbsCurve>& curve) {
  curve
      .def(
          "insert_knot",
          [](const NurbsCurve& self, double u, int times) {
            return take(curves::insert_knot(self, u, times));
          },
          py::arg("u"), py::arg("times") = 1, WithoutGil(),
          "The same curve with knot u, `times` times more.")
      .def(
          "refine",
          [](const NurbsCurve& self, const Array& knots) {
            return take(curves::refine(self, row("knots", knots)));
          },
          py::arg("knots"), WithoutGil(), "The same curve with all of knots [k] more.")
      .def(
          "elevate_degree",
          [](const NurbsCurve& self, int times) {
            return take(curves::elevate_degree(self, times));
          },
          py::arg("times") = 1, WithoutGil(), "The same curve with a higher degree.")
      .def(
          "sub_curve",
          [](const NurbsCurve& self, double u_a, double u_b) {
            return take(curves::sub_curve(self, u_a, u_b));
          },
          py::arg("u_a"), py::arg("u_b"), WithoutGil(), "The part over [u_a, u_b], clamped.")
      .def(
          "split",
          [](const NurbsCurve& self, double u) {
            auto parts = take(curves::split(self, u));
            return std::pair(std::move(parts.left), std::move(parts.right));
          },
          py::arg("u"), WithoutGil(), "(left, right): both parts at u.")
      .def("to_bezier", &to_bezier,
           "(ends [s + 1], points [s, degree + 1] or [s, degree + 1, dim], weights\n"
           "[s, degree + 1]): one Bezier segment a span of positive length.")
      .def_static("from_bezier", &from_bezier, py::arg("ends"), py::arg("points"),
                  py::arg("weights") = py::none(), py::arg("join_tolerance") = 0.0,
                  "One curve from what to_bezier() gives. Ends of neighbours farther apart than\n"
                  "join_tolerance make a jump.")
      .def("to_power_basis", &to_power_basis,
           "(ends [s + 1], numerators [s, degree + 1] or [s, degree + 1, dim], denominators\n"
           "[s, degree + 1]): powers of t = (u - ends[i]) / (ends[i + 1] - ends[i]), lowest "
           "first.");
}

void add_other_edits(py::class_<NurbsCurve>& curve) {
  curve
      .def(
          "remove_knot",
          [](const NurbsCurve& self, double u, int times, double tolerance) {
            return take(curves::remove_knot(self, u, times, tolerance));
          },
          py::arg("u"), py::arg("times"), py::arg("tolerance"), WithoutGil(),
          "A Reduced: knot u taken out up to `times` times, as long as the proved bound stays\n"
          "within tolerance.")
      .def(
          "remove_knots",
          [](const NurbsCurve& self, double tolerance) {
            return take(curves::remove_knots(self, tolerance));
          },
          py::arg("tolerance"), WithoutGil(),
          "A Reduced: as many knots taken out as tolerance allows, cheapest first.")
      .def(
          "reduce_degree",
          [](const NurbsCurve& self, double tolerance) {
            return take(curves::reduce_degree(self, tolerance));
          },
          py::arg("tolerance"), WithoutGil(), "A Reduced of degree - 1 within tolerance.")
      .def(
          "reverse", [](const NurbsCurve& self) { return take(curves::reverse(self)); },
          WithoutGil(), "The curve backwards over the same domain.")
      .def(
          "reparametrize",
          [](const NurbsCurve& self, double u_a, double u_b) {
            return take(curves::reparametrize(self, u_a, u_b));
          },
          py::arg("u_a"), py::arg("u_b"), WithoutGil(), "The same curve over [u_a, u_b].")
      .def(
          "bend", [](const NurbsCurve& self, double b) { return take(curves::bend(self, b)); },
          py::arg("b"), WithoutGil(),
          "The same path at a Moebius pace: 1 changes nothing, above 1 starts slower;\n"
          "bend(b).bend(1 / b) undoes it.")
      .def("regularize", &regularize, py::arg("mode"), WithoutGil(),
           "A 2-D cubic whose x never goes back, handles repaired: mode 'contain', 'keep_start',\n"
           "'keep_ratio', 'limit_active', 'limit_opposite' or 'none'.")
      .def(
          "hodograph", [](const NurbsCurve& self) { return take(curves::hodograph(self)); },
          WithoutGil(), "The derivative by u as a curve.")
      .def(
          "antiderivative",
          [](const NurbsCurve& self, double start) {
            return take(curves::antiderivative(self, start));
          },
          py::arg("start") = 0.0, WithoutGil(), "start + integral from u_min to u, as a curve.");
}

}  // namespace

void add_edits(py::class_<NurbsCurve>& curve) {
  add_exact_edits(curve);
  add_other_edits(curve);
}

}  // namespace knotwave::python

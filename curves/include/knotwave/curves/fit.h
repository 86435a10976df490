// SPDX-License-Identifier: MIT
// Curves from data. [control]
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: 9.2.1 (interpolation, (9.4) to (9.6), (9.8)),
// 9.4.1 (least squares, (9.63) to (9.69)). Linear systems are solved in double-double, so points
// are rounded once. reduce_data() is our own; its bound is that of src/curve_distance.h.
#pragma once
#include <span>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Parameters from one point to the next: even, by distance, or by the square root of it.
enum class Spacing { uniform, chord, centripetal };

/// Through every point [n*dim] (within 1 ulp of max|P| of the curve), degree <= n - 1, over [0, 1]:
/// parameters by `spacing`, knots by averaging. Errors: too_few_points, degree_out_of_range,
/// not_finite, knots_decrease (neighbours at the same place, spacing not uniform),
/// dimension_mismatch, and those of NurbsCurve::create. O(n p^2).
Result<NurbsCurve> interpolate(std::span<const double> points, int dim, int degree,
                               Spacing spacing = Spacing::centripetal);

/// The same at given parameters [n], strictly increasing, over [parameters.front(),
/// parameters.back()].
Result<NurbsCurve> interpolate_at(std::span<const double> parameters,
                                  std::span<const double> points, int dim, int degree);

/// A curve near data, and how near.
struct FittedCurve {
  NurbsCurve curve;
  double max_error = 0;     ///< Euclidean, output units
  double max_error_db = 0;  ///< 20 log10(max_error / largest |value|); -1000 if exact
};

/// Least squares with `point_count` control points at parameters [n], strictly increasing, values
/// [n*dim]; the first and last value are met exactly, and all within rounding if point_count = n.
/// max_error is the largest at the data. Errors: too_few_points (point_count < degree + 1),
/// too_many_points (point_count > n), and those of interpolate_at(). O(n p^2).
Result<FittedCurve> approximate(std::span<const double> parameters, std::span<const double> values,
                                int dim, int degree, int point_count);

/// Values [n*dim] over time (recorded automation, a drawn line) as a curve with few points:
/// everywhere, not only at the data, it is within `tolerance` of the straight lines from one datum
/// to the next, and max_error <= tolerance is the proof of that, from Bézier points, rounding
/// included. The first and last value are met exactly. Knots are put at data times where the bound
/// fails, more of them at corners; then those that the tolerance can spare are taken out, each with
/// its neighbourhood fitted anew. Not the fewest points there could be. Errors: too_few_points (n <
/// 2), degree_out_of_range, value_out_of_range (tolerance not above 0), error_bound_missed (the
/// tolerance is below the rounding of the lines' own Bézier points), coordinate_out_of_range (a
/// datum beyond kMaxCoordinate), knots_decrease, dimension_mismatch, not_finite, too_many_points
/// (more than kMaxPoints needed).
Result<FittedCurve> reduce_data(std::span<const double> times, std::span<const double> values,
                                double tolerance, int degree = 3, int dim = 1);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Control points from linear systems. Private to curves. [control]
#pragma once
#include <span>
#include <vector>

#include "knotwave/base/result.h"

#include "double_double.h"

namespace knotwave::curves {

/// A clamped polynomial spline on its way to its points.
struct Spline {
  int degree = 3;
  int dim = 1;
  std::vector<double> knots;   ///< [n+p+1]
  std::vector<double> points;  ///< [n*dim]

  int count() const { return static_cast<int>(knots.size()) - degree - 1; }
};

/// Strictly increasing parameters and what the curve should be there.
struct Samples {
  std::span<const double> at;      ///< [n]
  std::span<const double> values;  ///< [n*dim]
};

/// Whether `samples` are as many as they say, finite and increasing. Errors: dimension_mismatch,
/// not_finite, knots_decrease; `what` begins the message.
Result<void> check_samples(const std::string& what, const Samples& samples, int dim);

/// Points first..last by least squares at the samples in their support, the others held. False if
/// the samples there do not settle the points.
bool fit_points(Spline& spline, const Samples& samples, int first, int last);

/// As many points as samples: the spline through them all. False as above. The matrix is totally
/// positive, so no pivots are sought (de Boor, A Practical Guide to Splines, XIII).
bool interpolate_points(Spline& spline, const Samples& samples);
/// The same for values of any number of columns: `values` [n*columns] at the parameters `at` become
/// the points. Of `frame` the degree and knots count.
bool solve_interpolation(const Spline& frame, std::span<const double> at,
                         std::vector<DoubleDouble>& values, int columns);

/// Each end p + 1 times.
std::vector<double> clamped_knots(double low, const std::vector<double>& inner, double high, int p);
/// For interpolation at these parameters (The NURBS Book, (9.8)): by averaging.
std::vector<double> averaged_knots(std::span<const double> parameters, int p);

}  // namespace knotwave::curves

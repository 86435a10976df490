// SPDX-License-Identifier: MIT
// What is wrong with a curve or surface as written, and with which number.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::curves {

/// The first fault of a spec. Curve files use `part` and `index` to find the line and column.
struct SpecFault {
  enum class Part { degree, degree_v, points, weights, knots, knots_v, jumps };
  Error error;
  Part part = Part::points;
  int index = -1;  ///< in the flat vector of that part; -1 = the whole of it
};

std::optional<SpecFault> find_fault(const CurveSpec& spec);
std::optional<SpecFault> find_fault(const SurfaceSpec& spec);

/// One direction of a curve or surface, for the checks both share.
struct KnotRules {
  std::string what;  ///< "curve 'bell'": what messages begin with
  int degree = 3;
  int count = 0;  ///< points as written in this direction
  bool periodic = false;
  std::span<const double> knots;  ///< empty = left out, nothing to check
  std::span<const double> jumps;
  SpecFault::Part degree_part = SpecFault::Part::degree;
  SpecFault::Part knots_part = SpecFault::Part::knots;
};
std::optional<SpecFault> find_knot_fault(const KnotRules& rules);

/// Points and weights: finite, within the limits, as many weights as points (or none).
std::optional<SpecFault> find_number_fault(const std::string& what, int dim,
                                           std::span<const double> points,
                                           std::span<const double> weights);

/// Whether u is in the domain. Errors: parameter_out_of_range, with u and the domain.
Result<void> check_parameter(const NurbsCurve& curve, double u);

}  // namespace knotwave::curves

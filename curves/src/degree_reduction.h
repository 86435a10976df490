// SPDX-License-Identifier: MIT
// A lower degree by least squares, whatever it costs. Private to curves. [control]
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// What reduce_degree() measures. Errors: degree_out_of_range, error_bound_missed (there is no such
/// curve; the message says why).
Result<NurbsCurve> least_squares_reduction(const NurbsCurve& curve);

/// An error_bound_missed says what tolerance was asked for.
Error with_tolerance(Error error, double tolerance);

}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
// Splines that were fitted, as curves. Private to curves. [control]
#pragma once
#include <string>

#include "knotwave/curves/fit.h"

#include "spline_fit.h"

namespace knotwave::curves {

Result<NurbsCurve> curve_of(std::string name, Spline spline);

/// With the error in dB of the largest value [n*dim].
FittedCurve fitted_curve(NurbsCurve curve, std::span<const double> values, double max_error);

}  // namespace knotwave::curves

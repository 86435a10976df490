// SPDX-License-Identifier: MIT
// What controllers may move: checks, and the curve each one adds. Private to curves. [control]
#pragma once
#include <vector>

#include "knotwave/curves/compile.h"

#include "homogeneous.h"

namespace knotwave::curves {

/// Checks every control against the curve and the limits of curve files.
Result<void> check_controls(const NurbsCurve& curve, const std::vector<ControlRange>& controls);

/// The number a control moves, as written.
double rest_value(const CurveSpec& spec, const ControlRange& control);

/// What the weighted curve gains for each unit `control` is moved from rest: P_i N_i and N_i for a
/// weight, w_i N_i in one coordinate for a coordinate.
HomogeneousCurve control_term(const NurbsCurve& curve, const ControlRange& control);

/// The curve with control k at values[k].
Result<NurbsCurve> curve_with(const NurbsCurve& curve, const std::vector<ControlRange>& controls,
                              const std::vector<double>& values);

/// Hull of one coordinate over all controls.
HullRange hull_over(const NurbsCurve& curve, int coordinate,
                    const std::vector<ControlRange>& controls);

}  // namespace knotwave::curves

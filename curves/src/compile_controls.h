// SPDX-License-Identifier: MIT
// What controllers may move: checks, and the curve each one adds. Private to curves. [control]
#pragma once
#include <vector>

#include "knotwave/curves/compile.h"

#include "homogeneous.h"

namespace knotwave::curves {

/// The number a control moves, as written.
double rest_value(const CurveSpec& spec, const ControlRange& control);

/// What the weighted curve gains for each unit `control` is moved from rest: P_i N_i and N_i for a
/// weight, w_i N_i in one coordinate for a coordinate; nothing for a knot, which adds nothing.
HomogeneousCurve control_term(const NurbsCurve& curve, const ControlRange& control);

/// Whether one of them is a knot: the program then plays by LiveSpline.
bool moves_knots(const std::vector<ControlRange>& controls);

/// Hull of one coordinate over all controls.
HullRange hull_over(const NurbsCurve& curve, int coordinate,
                    const std::vector<ControlRange>& controls);

}  // namespace knotwave::curves

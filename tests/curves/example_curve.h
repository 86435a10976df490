// SPDX-License-Identifier: MIT
// Curves written down in a test, and their values.
#pragma once
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::test {

/// create() of a spec that has to be right; named "example" if it has no name.
curves::NurbsCurve made(curves::CurveSpec spec);

/// One coordinate.
curves::CurveSpec spec_of(int degree, std::vector<double> points, std::vector<double> knots = {},
                          std::vector<double> weights = {});
curves::NurbsCurve scalar(int degree, std::vector<double> points, std::vector<double> knots = {},
                          std::vector<double> jumps = {});

/// Lines from 0 to 1 and from -1 to 0.5, with a jump at 0.25.
curves::CurveSpec saw();

double at(const curves::NurbsCurve& curve, double u, curves::Side side = curves::Side::right,
          int coordinate = 0);

}  // namespace knotwave::test

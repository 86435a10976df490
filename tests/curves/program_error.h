// SPDX-License-Identifier: MIT
// How far a compiled program is from its curve.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>

#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves::testing {

/// Largest |program - curve| at places the compiler did not look at.
inline double worst_error(const CurveProgram& program, const NurbsCurve& curve, int places,
                          std::span<const double> controls = {}) {
  double worst = 0;
  for (int i = 0; i <= places; ++i) {
    const double u = curve.u_min() + (curve.u_max() - curve.u_min()) * i / places;
    double exact[kMaxDim];
    curve.evaluate(u, exact);
    for (int c = 0; c < program.dim(); ++c) {
      worst = std::max(worst, std::abs(program.at_u(u, c, controls) - exact[c]));
    }
  }
  return worst;
}

}  // namespace knotwave::curves::testing

// SPDX-License-Identifier: MIT
// The spans of a cubic without weights as powers of t, in one sweep over all of them: what
// span_polynomials() computes, for the curve that is compiled most. Private to curves. [control]
#pragma once
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Breaks [spans + 1] and coefficients [(span * dim + coordinate) * 4 + power], right to the last
/// bit but for ties: worked out in double-double and rounded once.
struct CubicSpans {
  std::vector<double> breaks;
  std::vector<double> coefficients;
};

/// `curve` has degree 3 and no weights but 1.
CubicSpans cubic_spans(const NurbsCurve& curve);

}  // namespace knotwave::curves

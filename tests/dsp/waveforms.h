// SPDX-License-Identifier: MIT
// The waveforms the alias measurements of docs/alias-free.md use, all within -1..1.
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::test {

/// One jump.
inline curves::CurveSpec saw_spec() {
  curves::CurveSpec spec;
  spec.name = "saw";
  spec.degree = 1;
  spec.points = {-1, 1};
  return spec;
}

/// Six cubic Bézier segments that meet in corners (C0), closed.
inline curves::CurveSpec corners_spec() {
  curves::CurveSpec spec;
  spec.name = "C0 Bezier";
  spec.degree = 3;
  spec.points = {0.0,  0.7, -0.3, 0.8, -0.9, 0.5, -0.6, 1.0, 0.2, -1.0,
                 -0.2, 0.6, 0.9,  0.1, -0.8, 0.4, -0.5, 0.3, 0.0};
  spec.knots = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 6};
  return spec;
}

/// A closed C2 cubic with 16 points, bright on purpose.
inline curves::CurveSpec smooth_spec() {
  curves::CurveSpec spec;
  spec.name = "C2 16 points";
  spec.degree = 3;
  spec.periodic = true;
  spec.points = {0.1,  0.9, -0.7, 0.4, -1.0, 0.8,  0.3, -0.6,
                 -0.2, 1.0, -0.9, 0.6, 0.2,  -1.0, 0.7, -0.4};
  return spec;
}

}  // namespace knotwave::test

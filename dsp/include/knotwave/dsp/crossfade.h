// SPDX-License-Identifier: MIT
// Crossfade laws and pan. The equal-power law is the exact rational quarter circle with an odd
// quintic reparametrisation, so a^2 + b^2 = 1 to rounding and the angle is linear within 0.0005
// degree; no sin, no cos.
#pragma once
#include <span>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"
#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::dsp {

struct GainPair {
  float a = 1;
  float b = 0;
};

/// position 0 = all a, 1 = all b; clamped, NaN = 0. |a^2 + b^2 - 1| <= 2e-7. [audio]
GainPair equal_power(double position) KNOTWAVE_RT;
/// a = 1 - position, b = position. [audio]
GainPair equal_gain(double position) KNOTWAVE_RT;

/// Any curve as a law: 1-D gives b = c(position), a = c(1 - position); 2-D gives a = x, b = y.
class CrossfadeLaw {
 public:
  enum class Kind { equal_power, equal_gain, curve };
  CrossfadeLaw() = default;  ///< equal power
  static CrossfadeLaw linear();
  /// [control] Errors: not_scalar (dim > 2), those of compile_parametric.
  static Result<CrossfadeLaw> create(const curves::NurbsCurve& curve);
  /// [audio]
  GainPair at(double position, curves::CurveCursor& cursor) const KNOTWAVE_RT;

 private:
  Kind kind_ = Kind::equal_power;
  curves::CurveProgram program_;
};

}  // namespace knotwave::dsp

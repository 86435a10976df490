// SPDX-License-Identifier: MIT
// Any curve as a waveshaper with first-order antiderivative anti-aliasing by the blossom mean: the
// mean of a polynomial over [x0, x1] is a polynomial in x0 and x1, so there is no division by
// x1 - x0 and no epsilon.
#pragma once
#include <span>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"
#include "knotwave/curves/compile.h"

namespace knotwave::dsp {

/// The curve's parameter (2-D: x) is the input, -1..1 by habit; outside the domain the end values
/// hold. Immutable.
class ShaperProgram {
 public:
  /// [control] Errors: those of compile_function, then of the polynomial form.
  static Result<ShaperProgram> create(const curves::NurbsCurve& curve);

  /// Value at x. [audio]
  double at(double x) const KNOTWAVE_RT { return program_.at_u(x); }
  /// Mean of the curve between x0 and x1 (either order; equal gives the value). [audio] Within
  /// -130 dB of the exact integral for any |x1 - x0|, denormal to 2.
  double mean(double x0, double x1) const KNOTWAVE_RT;

 private:
  curves::CurveProgram program_;  ///< polynomial, degree <= 7
  std::vector<double> area_;      ///< integral of whole pieces up to each break
};

/// One channel's memory: the last input.
class Shaper {
 public:
  void reset() KNOTWAVE_RT { last_ = 0; }
  /// out = mix * mean + (1 - mix) * in (delayed half a sample to agree). drive [n] multiplies the
  /// input. in and out may be the same. [audio]
  void render(const ShaperProgram& program, std::span<const float> drive, float mix,
              std::span<const float> in, std::span<float> out) KNOTWAVE_RT;

 private:
  double last_ = 0;
  double last_dry_ = 0;
};

}  // namespace knotwave::dsp

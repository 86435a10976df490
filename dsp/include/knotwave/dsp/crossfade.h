// SPDX-License-Identifier: MIT
// Crossfade laws and pan. The equal-power law is the exact rational quarter circle with an odd
// quintic reparametrisation, so a^2 + b^2 = 1 to rounding and the angle is linear within 0.0002
// degree; no sin, no cos. Right for sources that have nothing to do with each other; two copies of
// the same sound keep their level under equal gain.
#pragma once
#include <span>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"
#include "knotwave/curves/compile.h"

namespace knotwave::dsp {

struct GainPair {
  float a = 1;
  float b = 0;
};

/// position 0 = all a, 1 = all b, exactly; clamped, NaN = 0. |a^2 + b^2 - 1| <= 2e-7, which is a
/// power ripple below 1e-6 dB. [audio] Cost about 14 operations and a division.
GainPair equal_power(double position) KNOTWAVE_RT;
/// a = 1 - position, b = position; clamped, NaN = 0. [audio]
GainPair equal_gain(double position) KNOTWAVE_RT;
/// The same at every sample of a block, to the bit; a and b [position.size()]. [audio]
void equal_power(std::span<const double> position, std::span<float> a,
                 std::span<float> b) KNOTWAVE_RT;

/// Any curve as a law: 1-D gives b = c(position), a = c(1 - position); 2-D gives a = x, b = y.
/// Position 0..1 runs over the whole domain of the curve.
class CrossfadeLaw {
 public:
  enum class Kind { equal_power, equal_gain, curve };
  CrossfadeLaw() = default;  ///< equal power
  static CrossfadeLaw linear();
  /// [control] Errors: not_scalar (dim > 2), those of compile_parametric.
  static Result<CrossfadeLaw> create(const curves::NurbsCurve& curve,
                                     const curves::CompileOptions& options = {});

  Kind kind() const KNOTWAVE_RT { return kind_; }
  /// Gains at one position, clamped to 0..1, NaN = 0. [audio]
  /// `controls` as curves::CurveProgram::at_u has them.
  GainPair at(double position, std::span<const double> controls = {}) const KNOTWAVE_RT;
  /// The same at every sample of a block, to the bit; a and b [position.size()]. [audio]
  void render(std::span<const double> position, std::span<float> a,
              std::span<float> b) const KNOTWAVE_RT {
    render(position, {}, a, b);
  }
  /// The same where control k of the curve moves every sample by controls[k][i]; none: at rest.
  /// [audio]
  void render(std::span<const double> position, std::span<const double* const> controls,
              std::span<float> a, std::span<float> b) const KNOTWAVE_RT;

 private:
  Kind kind_ = Kind::equal_power;
  curves::CurveProgram program_;
};

}  // namespace knotwave::dsp

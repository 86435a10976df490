// SPDX-License-Identifier: MIT
// Any curve as a waveshaper with first-order antiderivative anti-aliasing by the blossom mean: the
// mean of a polynomial over [x0, x1] is a polynomial in x0 and x1, so nothing is divided by
// x1 - x0 that could vanish, and there is no epsilon. The classic quotient of antiderivatives:
// Parker, Zavalishin, Le Bivic, "Reducing the aliasing of nonlinear waveshaping using
// continuous-time convolution", DAFx 2016.
#pragma once
#include <span>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"
#include "knotwave/curves/compile.h"

namespace knotwave::dsp {

/// The curve's parameter (2-D: x) is the input, -1..1 by habit; outside the domain the end values
/// hold. NaN counts as 0, |x| < 1e-20 as 0 and |x| > 1e6 as 1e6. Immutable.
class ShaperProgram {
 public:
  /// [control] Errors: those of compile_function, then of the polynomial form. With `controls` the
  /// curve stays as it is drawn, quotients included, and its mean is taken by the 16-point rule of
  /// Gauss and Legendre in every piece: exact for polynomials, checked within -150 dB for quotients
  /// at the ends of the controls' ranges, where pieces are halved as needed (error_bound_missed
  /// when 64 do not suffice).
  static Result<ShaperProgram> create(const curves::NurbsCurve& curve,
                                      std::span<const curves::ControlRange> controls = {});

  /// Value at x, controls at rest. [audio]
  double at(double x) const KNOTWAVE_RT;
  /// Mean of the curve between x0 and x1 (either order, to the bit; equal gives the value). [audio]
  /// Within -130 dB of the exact integral for any |x1 - x0|, denormal to 2. Cost a search for each
  /// end, then 4 operations a degree for each end's piece; with controls 16 values of the curve for
  /// each piece between x0 and x1.
  double mean(double x0, double x1) const KNOTWAVE_RT;
  int control_count() const KNOTWAVE_RT { return moving_.control_count(); }
  /// Largest |program - curve|. [control]
  double max_error() const noexcept { return max_error_; }

 private:
  friend class Shaper;
  /// An input and the piece it lies in: -1 below the domain, piece count above.
  struct Input {
    double x = 0;
    int piece = 0;
  };
  Input locate(double x, int hint) const KNOTWAVE_RT;
  /// Controls as CurveProgram::at_u has them; empty unless control_count() > 0.
  double mean(Input a, Input b, std::span<const double> controls) const KNOTWAVE_RT;
  double still_mean(Input a, Input b) const KNOTWAVE_RT;
  double moving_mean(Input a, Input b, std::span<const double> controls) const KNOTWAVE_RT;
  static Result<ShaperProgram> create_moving(const curves::NurbsCurve& curve,
                                             std::span<const curves::ControlRange> controls);
  double piece_mean(int piece, double x0, double x1) const KNOTWAVE_RT;

  int pieces_ = 0;
  int degree_ = 0;
  double max_error_ = 0;
  double first_value_ = 0, last_value_ = 0;  ///< below and above the domain
  std::vector<double> breaks_;               ///< [pieces + 1]
  std::vector<double> inverse_widths_;       ///< [pieces]
  std::vector<double> terms_;    ///< [pieces * (degree + 1)] coefficient k of local t over k + 1
  std::vector<double> area_;     ///< [pieces + 1] integral of whole pieces up to each break
  curves::CurveProgram moving_;  ///< with controls, in place of all but the breaks
};

/// One of the curves of a blend.
struct ShaperLayer {
  const ShaperProgram* program = nullptr;  ///< without controls, or these at rest
  std::span<const double> weight;          ///< [n] NaN counts as 0
};
/// What moves a blend, each [n].
struct ShaperMotion {
  std::span<const float> drive;   ///< multiplies the input
  std::span<const double> bias;   ///< is added to it then
  std::span<const double> level;  ///< how much of the blend's value at rest (input 0) is taken away
  std::span<const double> mix;    ///< clamped to 0..1, NaN = 0
  bool rests = false;  ///< every number, the layers' weights too, is the first one all the time
};

/// One channel's memory: the last input.
class Shaper {
 public:
  /// As if `x` (driven and biased) had always come in.
  void reset(double x = 0) KNOTWAVE_RT {
    *this = {};
    last_ = x;
  }
  /// out = mix * mean + (1 - mix) * in (delayed half a sample to agree, as the mean of two inputs).
  /// drive [n] multiplies the input. mix is clamped to 0..1, NaN = 0; NaN in `in` counts as 0. in
  /// and out may be the same. [audio]
  void render(const ShaperProgram& program, std::span<const float> drive, float mix,
              std::span<const float> in, std::span<float> out) KNOTWAVE_RT {
    render(program, drive, {}, mix, in, out);
  }
  /// The same where control k of the curve moves every sample by controls[k][i]; none: at rest.
  /// [audio]
  void render(const ShaperProgram& program, std::span<const float> drive,
              std::span<const double* const> controls, float mix, std::span<const float> in,
              std::span<float> out) KNOTWAVE_RT;
  /// A blend of up to kMostLayers curves: the mean of a blend is the blend of their means. One
  /// layer of weight 1 without bias and level is the render() above, to the bit. A layer costs
  /// nothing where its weight is 0. [audio]
  static constexpr std::size_t kMostLayers = 4;
  void render(std::span<const ShaperLayer> layers, const ShaperMotion& motion,
              std::span<const float> in, std::span<float> out) KNOTWAVE_RT;

 private:
  struct Blend;
  template <bool rests>
  void render_one(const ShaperLayer& layer, const ShaperMotion& motion, std::span<const float> in,
                  std::span<float> out) KNOTWAVE_RT;
  double last_ = 0;
  double last_dry_ = 0;
  int last_piece_ = 0;  ///< only a hint
};

}  // namespace knotwave::dsp

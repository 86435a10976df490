// SPDX-License-Identifier: MIT
// From one value to another along any curve, in absolute time: portamento and other glides.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "knotwave/base/time.h"
#include "knotwave/curves/curve_program.h"

namespace knotwave::dsp {

/// value = from + (to - from) c((now - start) / seconds), where c is a curve read from the start to
/// the end of its domain, 0 and 1 there, or without a curve the S 3 t^2 - 2 t^3. A function of time
/// with a sub-sample start: the same at equal seconds for any sample rate.
class Glide {
 public:
  /// At rest at `value` (NaN = 0). [audio]
  void reset(double value) KNOTWAVE_RT;
  /// Leaves for `target` at `time`, from where it is then; arrives `seconds` later, and 0 or less
  /// is a jump. NaN target is ignored. `curve` may be null and must be the one passed to render
  /// until the next start. [audio]
  void start(const curves::CurveProgram* curve, double target, base::SampleTime time,
             double seconds, double rate_hz) KNOTWAVE_RT;
  /// Values at samples first.., none before the last start. [audio]
  void render(const curves::CurveProgram* curve, std::int64_t first,
              std::span<double> out) KNOTWAVE_RT {
    render(curve, first, {}, out);
  }
  /// The same where control k of the curve moves every sample by controls[k][i]; none: at rest. A
  /// start on the way then leaves from where the last sample's controls had it. [audio]
  void render(const curves::CurveProgram* curve, std::int64_t first,
              std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT;
  /// Exactly target() from sample `first` on. [audio]
  bool is_still(std::int64_t first) const KNOTWAVE_RT { return !(progress(first, 0) < 1); }
  double target() const KNOTWAVE_RT { return target_; }

 private:
  double progress(std::int64_t sample, std::uint32_t fraction) const KNOTWAVE_RT;

  double from_ = 0, target_ = 0;
  base::SampleTime start_;
  double samples_ = 0;
  std::size_t control_count_ = 0;  ///< of last_controls_, those of the last sample
  std::array<double, curves::kMaxControls> last_controls_{};
  curves::CurveCursor cursor_;
};

}  // namespace knotwave::dsp

// SPDX-License-Identifier: MIT
// The pitch of a voice on its way from one key to the next, along a curve in absolute time.
#pragma once
#include <algorithm>
#include <cstdint>

#include "knotwave/base/time.h"
#include "knotwave/curves/curve_program.h"

namespace knotwave::engine {

/// All [audio]. Without a curve the way is the smoothest step 6 t^5 - 15 t^4 + 10 t^3.
class Glide {
 public:
  /// At rest at `pitch` (a note number).
  void reset(double pitch) KNOTWAVE_RT {
    from_ = to_ = pitch;
    samples_ = 0;
  }
  /// From `from` at `time` to `to`, `samples` later (not a whole number in general; 0: at once).
  void start(double from, double to, base::SampleTime time, double samples) KNOTWAVE_RT {
    from_ = from;
    to_ = to;
    start_ = time;
    samples_ = from == to ? 0 : samples;
  }
  /// `way`: 0 to 1 over its domain, or null.
  double pitch_at(std::int64_t sample, const curves::CurveProgram* way) const KNOTWAVE_RT {
    if (is_still(sample)) return to_;
    const double t = std::max(base::samples_since(start_, sample), 0.0) / samples_;
    if (way == nullptr) return from_ + (to_ - from_) * (t * t * t * (10 + t * (6 * t - 15)));
    return from_ + (to_ - from_) * way->at_u(way->u_min() + t * (way->u_max() - way->u_min()));
  }
  /// At rest for all samples from `first` on.
  bool is_still(std::int64_t first) const KNOTWAVE_RT {
    return base::samples_since(start_, first) >= samples_;
  }
  double target() const KNOTWAVE_RT { return to_; }

 private:
  double from_ = 0, to_ = 0;
  base::SampleTime start_;
  double samples_ = 0;
};

}  // namespace knotwave::engine

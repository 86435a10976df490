// SPDX-License-Identifier: MIT
// Gain smoothing defined on the absolute sample index.
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/base/rt.h"

namespace knotwave::dsp {

/// Follows a target along C2 S-curves (smoothest step of degree 5) of fixed length. A new target
/// while moving starts a new move from the present value and slope. Where a move begins is the
/// sample of the event, so block size does not matter.
class Smoother {
 public:
  /// `samples` is the length of a move, >= 1. [audio]
  void reset(double value, int samples) KNOTWAVE_RT;
  /// A new target at engine sample `sample`. [audio]
  void set_target(double target, std::int64_t sample) KNOTWAVE_RT;
  /// Values at samples first.. [audio]
  void render(std::int64_t first, std::span<float> out) KNOTWAVE_RT;
  double value_at(std::int64_t sample) const KNOTWAVE_RT;
  /// At rest for all samples from `first` on. [audio]
  bool is_still(std::int64_t first) const KNOTWAVE_RT { return first >= start_ + length_; }
  double target() const KNOTWAVE_RT { return target_; }

 private:
  double from_ = 0, slope_ = 0, target_ = 0;
  std::int64_t start_ = 0;
  int length_ = 1;
};

}  // namespace knotwave::dsp

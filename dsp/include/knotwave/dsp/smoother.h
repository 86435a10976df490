// SPDX-License-Identifier: MIT
// Gain smoothing defined on the absolute sample index.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "knotwave/base/rt.h"

namespace knotwave::dsp {

/// Follows a target with two continuous derivatives and never leaves the range of the targets it
/// was given. Each new target adds its step times a smoothest step 6 t^5 - 15 t^4 + 10 t^3 of fixed
/// length; the sum of the steps under way is a weighted mean of the targets. (It is the target
/// signal convolved with 30 t^2 (1 - t)^2.) A move begins at the sample of its event, so block size
/// does not matter; only targets that come closer together than an eighth of the length wait for
/// that eighth to pass, and the last of them counts.
class Smoother {
 public:
  /// At rest at `value` (NaN = 0). `samples` is the length of a move, >= 1. [audio]
  void reset(double value, int samples) KNOTWAVE_RT;
  /// A new target at engine sample `sample`, no earlier than the one before; heard from the next
  /// sample on. NaN is ignored. [audio]
  void set_target(double target, std::int64_t sample) KNOTWAVE_RT;
  /// Values at samples first.., at or after the last event. [audio]
  void render(std::int64_t first, std::span<float> out) const KNOTWAVE_RT;
  void render(std::int64_t first, std::span<double> out) const KNOTWAVE_RT;
  double value_at(std::int64_t sample) const KNOTWAVE_RT;
  /// At rest for all samples from `first` on. [audio]
  bool is_still(std::int64_t first) const KNOTWAVE_RT {
    return count_ == 0 || first >= moves_[static_cast<std::size_t>(count_ - 1)].start + length_;
  }
  double target() const KNOTWAVE_RT { return target_; }

 private:
  static constexpr int kMovesInLength = 8;
  struct Move {
    std::int64_t start = 0;
    double step = 0;  ///< how far it carries
  };
  void drop_finished(std::int64_t sample) KNOTWAVE_RT;
  template <class Float>
  void fill(std::int64_t first, std::span<Float> out) const KNOTWAVE_RT;

  double target_ = 0;
  double before_last_ = 0;  ///< target before the newest move
  int length_ = 1;
  int count_ = 0;
  std::array<Move, kMovesInLength + 1> moves_;  ///< under way, oldest first, and one that waits
};

}  // namespace knotwave::dsp

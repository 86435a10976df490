// SPDX-License-Identifier: MIT
// A gain that goes from 0 to 1 or back along the smoothest step, placed on the absolute sample
// index.
#pragma once
#include <algorithm>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::engine {

/// All [audio]. Until start() it is 1.
class Fade {
 public:
  enum class Direction : std::uint8_t { none, in, out };

  void reset() KNOTWAVE_RT { direction_ = Direction::none; }
  void start(Direction direction, std::int64_t sample, std::int64_t samples) KNOTWAVE_RT {
    direction_ = direction;
    start_ = sample;
    samples_ = std::max<std::int64_t>(samples, 1);
  }
  double at(std::int64_t sample) const KNOTWAVE_RT {
    if (direction_ == Direction::none) return 1;
    const double t =
        std::clamp(static_cast<double>(sample - start_) / static_cast<double>(samples_), 0.0, 1.0);
    const double risen = t * t * t * (10 + t * (6 * t - 15));
    return direction_ == Direction::in ? risen : 1 - risen;
  }
  bool is_out() const KNOTWAVE_RT { return direction_ == Direction::out; }
  bool is_moving(std::int64_t first) const KNOTWAVE_RT {
    return direction_ == Direction::out ||
           (direction_ == Direction::in && first < start_ + samples_);
  }
  /// Faded out before `sample`: nothing is heard from there on.
  bool is_over(std::int64_t sample) const KNOTWAVE_RT {
    return is_out() && sample >= start_ + samples_;
  }
  std::int64_t end() const KNOTWAVE_RT { return start_ + samples_; }

 private:
  Direction direction_ = Direction::none;
  std::int64_t start_ = 0, samples_ = 1;
};

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Where a block stands in time, from what a server says of its cycle.
#pragma once
#include <algorithm>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::io {

class CycleClock {
 public:
  struct Cycle {
    std::uint32_t frame_time = 0;  ///< the server's count of frames at its begin; wraps
    std::int64_t age_us = 0;       ///< since its begin; a filtered begin may lie in the future
    std::uint32_t frames = 0;
  };

  /// The next cycle, asked for at `now_ns`. Frames begin at 0, never overlap and jump over cycles
  /// that were skipped; a step back of the server's count is none of ours. Times never go back, and
  /// an age beyond a second, or half a second before the begin, is no age. [audio]
  void advance(const Cycle& cycle, std::int64_t now_ns) KNOTWAVE_RT {
    const std::uint32_t moved = cycle.frame_time - last_;
    const bool is_step_back = moved > 0x7FFFFFFFU;
    if (has_begun_) frame_ += is_step_back ? last_frames_ : std::max(moved, last_frames_);
    has_begun_ = true;
    last_ = cycle.frame_time;
    last_frames_ = cycle.frames;
    const bool is_age = cycle.age_us >= -500'000 && cycle.age_us <= 1'000'000;
    time_ns_ = std::max(time_ns_, now_ns - (is_age ? cycle.age_us * 1000 : 0));
  }
  std::int64_t frame() const KNOTWAVE_RT { return frame_; }
  std::int64_t time_ns() const KNOTWAVE_RT { return time_ns_; }

 private:
  bool has_begun_ = false;
  std::uint32_t last_ = 0, last_frames_ = 0;
  std::int64_t frame_ = 0, time_ns_ = 0;
};

}  // namespace knotwave::io

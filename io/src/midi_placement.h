// SPDX-License-Identifier: MIT
// Where in a cycle of a server messages go: what was due while the last cycle lasted, at the same
// place in this one, so that every message is one block late and none is early or late by more.
#pragma once
#include <algorithm>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::io {

class MidiPlacement {
 public:
  /// The next cycle: its first frame by the server's count, when it began, and its length. [audio]
  void advance(std::int64_t frame, std::int64_t begin_ns, std::int64_t frames) KNOTWAVE_RT {
    has_last_ = has_begun_;
    has_begun_ = true;
    gap_ = frame - frame_;
    last_ns_ = begin_ns_;
    frame_ = frame;
    begin_ns_ = begin_ns;
    frames_ = frames;
    lowest_ = 0;
  }

  bool is_due(std::int64_t due_ns) const KNOTWAVE_RT { return has_last_ && due_ns < begin_ns_; }

  /// The nearest frame of this cycle, 0..frames-1, for what is_due(); frames rise. What was due
  /// before the last cycle, or in one that was skipped, goes first.
  std::int64_t offset(std::int64_t due_ns) KNOTWAVE_RT {
    const std::int64_t length_ns = begin_ns_ - last_ns_;
    std::int64_t at = 0;
    if (due_ns > last_ns_ && length_ns > 0) {
      at = ((due_ns - last_ns_) * gap_ + length_ns / 2) / length_ns - (gap_ - frames_);
    }
    lowest_ = std::clamp(at, lowest_, frames_ - 1);
    return lowest_;
  }
  /// How long before the first frame of this cycle a message should have stood; 0: it is in time.
  std::int64_t late_ns(std::int64_t due_ns) const KNOTWAVE_RT {
    const std::int64_t length_ns = begin_ns_ - last_ns_;
    const std::int64_t skipped_ns = gap_ > frames_ ? length_ns / gap_ * (gap_ - frames_) : 0;
    return std::max<std::int64_t>(last_ns_ + skipped_ns - due_ns, 0);
  }

 private:
  bool has_begun_ = false, has_last_ = false;
  std::int64_t frame_ = 0, begin_ns_ = 0, frames_ = 1;
  std::int64_t gap_ = 0, last_ns_ = 0;
  std::int64_t lowest_ = 0;
};

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// From the steady clock to engine samples: a second-order delay-locked loop over the times at which
// the device asks for blocks. Source: F. Adriaensen, "Using a DLL to filter time", 2005.
#pragma once
#include <cstddef>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::engine {

/// The most of a value over the last four to eight seconds.
class RecentMost {
 public:
  void add(double value) KNOTWAVE_RT {
    if (value > now_) now_ = value;
  }
  /// Another four seconds have passed.
  void turn() KNOTWAVE_RT {
    before_ = now_;
    now_ = 0;
  }
  double value() const KNOTWAVE_RT { return now_ > before_ ? now_ : before_; }

 private:
  double now_ = 0, before_ = 0;  ///< of values above 0
};

/// All [audio].
class LiveClock {
 public:
  explicit LiveClock(double rate_hz) KNOTWAVE_RT;

  /// The block that begins at engine sample `now` was asked for at `time_ns`. A device asks for the
  /// next one when this one's `frames` have passed. Where the time is far from what was expected
  /// the loop begins anew.
  void begin_block(std::int64_t time_ns, std::int64_t now, std::size_t frames) KNOTWAVE_RT;

  /// Where what was heard at time_ns sounds: latency_frames() later, to the nearest sample. Never
  /// further ahead than a block and the latency.
  std::int64_t sample_of(std::int64_t time_ns) const KNOTWAVE_RT;

  /// The longest recent block, and how much earlier than the loop expects blocks have come lately,
  /// in steps of half a millisecond and at least one: with less, what is heard just after a block
  /// was asked for would be late in the next.
  double latency_frames() const KNOTWAVE_RT { return latency_frames_; }

 private:
  void restart(std::int64_t time_ns) KNOTWAVE_RT;
  void follow(double error_ns) KNOTWAVE_RT;
  double since_origin(std::int64_t time_ns) const KNOTWAVE_RT;

  const double rate_hz_;
  const double usual_ns_per_frame_;
  bool runs_ = false;
  std::int64_t origin_ns_ = 0;
  double start_ns_ = 0;  ///< of this block, filtered, since the origin
  double next_ns_ = 0;   ///< of the next one, as predicted
  double ns_per_frame_;
  double elapsed_s_ = 0;  ///< since the loop began
  double window_s_ = 0;
  std::int64_t now_ = 0;
  double frames_ = 0;
  double latency_frames_ = 0;
  RecentMost block_frames_, early_frames_;
};

}  // namespace knotwave::engine

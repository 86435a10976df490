// SPDX-License-Identifier: MIT
// What becomes of the samples of the live engine: the tap, the peaks, the fade.
#pragma once
#include <atomic>
#include <cstdint>
#include <span>

#include "knotwave/base/spsc_ring.h"
#include "knotwave/engine/live_engine.h"

namespace knotwave::engine {

/// Samples on their way to whoever records them, in runs without a gap.
class LiveTap {
 public:
  explicit LiveTap(std::size_t frames);  ///< [control]

  void set_on(bool on) KNOTWAVE_RT { wanted_.store(on, std::memory_order_relaxed); }
  /// [audio] Looks once a block whether it is on.
  void begin_block() KNOTWAVE_RT;
  /// The samples from engine time `first` on. [audio]
  void write(std::int64_t first, std::span<const float> left,
             std::span<const float> right) KNOTWAVE_RT;
  std::int64_t dropped_frames() const KNOTWAVE_RT { return dropped_; }  ///< [audio]

  /// As LiveEngine::take_tap(). The reader's thread.
  LiveEngine::Tap read(std::span<float> interleaved) KNOTWAVE_RT;

 private:
  struct Frame {
    float left, right;
  };
  /// Where a run begins: so many frames after the first of all, and at which engine time.
  struct Mark {
    std::uint64_t position = 0;
    std::int64_t time = 0;
  };
  bool begin_run(std::int64_t time) KNOTWAVE_RT;

  std::atomic<bool> wanted_{false};
  base::SpscRing<Frame> frames_;
  base::SpscRing<Mark> marks_;
  // The audio thread.
  bool is_on_ = false, in_run_ = false;
  std::uint64_t written_ = 0;
  std::int64_t dropped_ = 0;
  // The reader.
  std::uint64_t read_ = 0;
  std::int64_t read_time_ = 0;
  bool has_mark_ = false;
  Mark mark_;  ///< of the next run
};

/// The last gain of all, which the performance knows nothing of.
class LiveFade {
 public:
  void set(float gain_lin, float seconds) KNOTWAVE_RT;  ///< [any]
  /// [audio]
  void apply(double rate_hz, std::span<float> left, std::span<float> right) KNOTWAVE_RT;

 private:
  void follow(double rate_hz) KNOTWAVE_RT;

  std::atomic<std::uint64_t> wanted_{0};  ///< two floats; never 0 once set
  std::uint64_t heard_ = 0;
  double gain_ = 1, from_ = 1, to_ = 1;
  double step_ = 0;  ///< of the way, a sample
  double way_ = 1;   ///< 0..1
};

/// The loudest sample since somebody looked. One writer, one reader.
class LivePeak {
 public:
  void add(std::span<const float> samples) KNOTWAVE_RT;  ///< [audio]
  float take() KNOTWAVE_RT { return most_.exchange(0, std::memory_order_relaxed); }

 private:
  std::atomic<float> most_{0};
};

}  // namespace knotwave::engine

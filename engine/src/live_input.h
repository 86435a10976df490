// SPDX-License-Identifier: MIT
// One input of the live engine: what its thread pushes waits in a ring until it is due. What ends
// notes has places of its own in the ring, and a word besides for when even those are taken.
#pragma once
#include <atomic>
#include <cstdint>

#include "knotwave/base/spsc_ring.h"
#include "knotwave/engine/live_message.h"

#include "live_clock.h"

namespace knotwave::engine {

/// A message with the engine sample it sounds at.
struct PlacedMessage {
  std::int64_t sample = 0;
  LiveMessage message;
};

class LiveInput {
 public:
  /// [control] Room for so many messages, and as many again that end notes.
  explicit LiveInput(int messages);

  /// False: dropped. The input's own thread. [any]
  bool push(const LiveMessage& message) KNOTWAVE_RT;
  std::int64_t dropped() const KNOTWAVE_RT { return dropped_.load(std::memory_order_relaxed); }

  /// A block begins at engine sample `now`: what is in the ring by now may be played in it.
  /// [audio], and so is all below.
  void begin_block(const LiveClock& clock, std::int64_t now) KNOTWAVE_RT;
  /// The next message, or null. Samples never decrease and are at or after the block's first.
  const PlacedMessage* front() KNOTWAVE_RT { return has_front_ ? &front_ : nullptr; }
  /// Of what may be played in this block only what ends notes, chooses a sound or sets the tempo
  /// or the song position still is.
  void panic(const LiveClock& clock) KNOTWAVE_RT;
  /// Goes on to the next one.
  void pop(const LiveClock& clock) KNOTWAVE_RT;

  std::int64_t heard() const KNOTWAVE_RT { return heard_; }  ///< messages that came through
  std::int64_t late() const KNOTWAVE_RT { return late_; }
  std::int64_t stale() const KNOTWAVE_RT { return stale_; }  ///< note-ons nobody wants any more

 private:
  void load(const LiveClock& clock) KNOTWAVE_RT;
  bool load_loss() KNOTWAVE_RT;
  /// False where the message is not played.
  bool place(const LiveClock& clock) KNOTWAVE_RT;

  // The input's thread.
  base::SpscRing<LiveMessage> ring_;
  const std::size_t ordinary_;
  std::uint64_t pushed_ = 0;
  std::atomic<std::int64_t> dropped_{0};
  // Both threads. Bit c of lost_: something that ends notes of channel c found no room, and at most
  // lost_at_ messages were pushed before it.
  std::atomic<std::uint64_t> lost_at_{0};
  std::atomic<std::uint32_t> lost_{0};
  // The audio thread.
  std::uint32_t losses_ = 0;
  std::uint64_t losses_at_ = 0;
  int loss_step_ = 0;
  std::size_t available_ = 0;  ///< in the ring when the block began
  std::size_t panicked_ = 0;   ///< of those, heard before a panic
  std::uint64_t popped_ = 0;
  bool has_front_ = false;
  PlacedMessage front_;
  std::int64_t now_ = 0;
  std::int64_t last_sample_ = 0;
  std::int64_t heard_ = 0, late_ = 0, stale_ = 0;
};

}  // namespace knotwave::engine

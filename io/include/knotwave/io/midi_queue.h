// SPDX-License-Identifier: MIT
// Complete messages with a time, from one thread to another, wait-free; system
// exclusive is copied.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/spsc_ring.h"

namespace knotwave::io {

/// The longest message an output takes. Source: RtMidi drops what its ring for JACK, 16 KiB, does
/// not hold.
inline constexpr std::size_t kLongestMidi = 16000;

class MidiQueue {
 public:
  struct Message {
    std::int64_t due_ns = 0;
    std::span<const std::uint8_t> bytes;  ///< status first, system exclusive with F0 and F7
    base::MidiEvent event;                ///< the same
  };

  /// [control]
  MidiQueue(std::size_t messages, std::size_t sysex_bytes);

  /// False: no room, no message of MIDI's, or longer than kLongestMidi; nothing was taken.
  /// [audio], the producer
  bool push(const base::MidiEvent& event, std::int64_t due_ns) KNOTWAVE_RT;

  /// The oldest message, valid until drop_front(); null: there is none. [audio], the consumer
  const Message* front() KNOTWAVE_RT;
  void drop_front() KNOTWAVE_RT;

  /// All that was pushed has been dropped, as far as the caller may know. [any]
  bool is_empty() const KNOTWAVE_RT { return taken_.load(std::memory_order_acquire) == 0; }

 private:
  struct Item {
    std::int64_t due_ns = 0;
    base::MidiEvent event;
    std::uint32_t size = 0;  ///< of system exclusive with F0 and F7, which stands in sysex_
  };
  base::SpscRing<Item> items_;
  base::SpscRing<std::uint8_t> sysex_;
  std::atomic<std::int64_t> taken_{0};
  std::vector<std::uint8_t> bytes_;  ///< of front()
  Message front_;
  bool has_front_ = false;
};

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_queue.h"

#include <algorithm>
#include <array>

#include "complete_midi.h"

namespace knotwave::io {

MidiQueue::MidiQueue(std::size_t messages, std::size_t sysex_bytes)
    : items_(messages), sysex_(sysex_bytes), bytes_(kLongestMidi) {}

bool MidiQueue::push(const base::MidiEvent& event, std::int64_t due_ns) KNOTWAVE_RT {
  Item item{.due_ns = due_ns, .event = event};
  const bool is_sysex = event.bytes[0] == 0xF0;
  if (!is_sysex && message_size(event.bytes[0]) == 0) return false;
  if (items_.size() == items_.capacity()) return false;
  if (is_sysex) {
    item.size = event.sysex_size + 2;
    if (item.size > kLongestMidi || sysex_.capacity() - sysex_.size() < item.size) return false;
    constexpr std::array<std::uint8_t, 2> kFrame = {0xF0, 0xF7};
    sysex_.write(std::span(kFrame).first(1));
    sysex_.write({event.sysex, event.sysex_size});
    sysex_.write(std::span(kFrame).last(1));
  }
  taken_.fetch_add(1, std::memory_order_relaxed);
  items_.push(item);
  return true;
}

const MidiQueue::Message* MidiQueue::front() KNOTWAVE_RT {
  if (has_front_) return &front_;
  Item item;
  if (!items_.pop(item)) return nullptr;
  const bool is_sysex = item.size > 0;
  const std::size_t size = is_sysex ? item.size : message_size(item.event.bytes[0]);
  if (is_sysex) {
    sysex_.read(std::span(bytes_).first(size));
  } else {
    std::copy_n(item.event.bytes, size, bytes_.begin());
  }
  front_ = {item.due_ns, std::span<const std::uint8_t>(bytes_).first(size), item.event};
  if (is_sysex) front_.event.sysex = bytes_.data() + 1;
  has_front_ = true;
  return &front_;
}

void MidiQueue::drop_front() KNOTWAVE_RT {
  if (!has_front_) return;
  has_front_ = false;
  taken_.fetch_sub(1, std::memory_order_release);
}

}  // namespace knotwave::io

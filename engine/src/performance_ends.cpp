// SPDX-License-Identifier: MIT
// The end of every note, told once. A note lives while a voice plays it or, in a monophonic patch,
// a key or a pedal holds it: then it may be heard again.
#include <algorithm>
#include <utility>

#include "performance.h"

namespace knotwave::engine {

void Performance::tell_end(int channel, int key, std::int32_t number) KNOTWAVE_RT {
  if (ended_count_ == ended_notes_.size()) return;
  ended_notes_[ended_count_++] = {number, channel, key};
}

void Performance::part_from(VoiceSlot& slot) KNOTWAVE_RT {
  const std::uint64_t serial = std::exchange(slot.serial, 0);
  const NoteStack& stack = monos_[static_cast<std::size_t>(slot.channel)].stack;
  if (serial == 0 || stack.knows(serial) || is_played(serial)) return;
  tell_end(slot.channel, slot.key, slot.number);
}

// By two voices where a monophonic note that was stolen came back before it had faded out.
bool Performance::is_played(std::uint64_t serial) const KNOTWAVE_RT {
  const auto slots = slots_.all();
  return std::any_of(slots.begin(), slots.end(),
                     [serial](const VoiceSlot& slot) { return slot.serial == serial; });
}

void Performance::tell_gone() KNOTWAVE_RT {
  for (int channel = 0; channel < kChannels; ++channel) {
    NoteStack& stack = monos_[static_cast<std::size_t>(channel)].stack;
    for (const NoteStack::Entry& entry : stack.gone()) {
      if (!is_played(entry.serial)) tell_end(channel, entry.key, entry.number);
    }
    stack.forget_gone();
  }
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Which notes a full cable lets in: one that is left out is left out with its end, and the end of
// one that was let in always has a place. All [audio].
#pragma once
#include <array>
#include <cstdint>

#include "knotwave/engine/channel_state.h"

#include "cable.h"

namespace knotwave::engine {

class NoteAdmission {
 public:
  /// As many beginnings of one key may wait for their ends; ends beyond them are as other messages.
  static constexpr std::uint8_t kMostOfAKey = 2;
  static_assert(OutputPort::kNoteOffs == 16 * 128 * kMostOfAKey);

  /// `waiting` messages wait already.
  bool admit(const base::MidiEvent& event, std::size_t waiting) KNOTWAVE_RT {
    const bool has_room = waiting < OutputPort::kMostWaiting;
    const base::MidiStatus status = event.status();
    const bool is_off = status == base::MidiStatus::note_off ||
                        (status == base::MidiStatus::note_on && event.bytes[2] == 0);
    if (is_off) return admit_off(key_of(event), has_room);
    if (status == base::MidiStatus::note_on) return admit_on(key_of(event), has_room);
    if (!ends_notes(event)) return has_room;
    const bool is_let_in = waiting < OutputPort::kMostWaiting + OutputPort::kEndings;
    if (is_let_in && event.bytes[1] != kSustain) forget_left_out(event.channel());
    return is_let_in;
  }

 private:
  struct Key {
    std::uint8_t open = 0;  ///< let in, and not ended
    std::uint16_t left_out = 0;
  };
  Key& key_of(const base::MidiEvent& event) KNOTWAVE_RT {
    return keys_[static_cast<std::size_t>(event.channel() * 128 + (event.bytes[1] & 127))];
  }
  static bool admit_on(Key& key, bool has_room) KNOTWAVE_RT {
    if (!has_room) {
      if (key.left_out < 0xFFFF) ++key.left_out;
    } else if (key.open < kMostOfAKey) {
      ++key.open;
    }
    return has_room;
  }
  static bool admit_off(Key& key, bool has_room) KNOTWAVE_RT {
    if (key.open > 0) {
      --key.open;
      return true;
    }
    if (key.left_out == 0) return has_room;
    --key.left_out;
    return false;
  }
  /// All notes off: nobody may end them one by one. What was let in keeps its place for an end,
  /// since a receiver in omni mode does not listen to it (MIDI 1.0).
  void forget_left_out(int channel) KNOTWAVE_RT {
    for (std::size_t key = 0; key < 128; ++key) {
      keys_[static_cast<std::size_t>(channel) * 128 + key].left_out = 0;
    }
  }

  std::array<Key, 16 * 128> keys_{};
};

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// The keys that hold a monophonic instrument, in the order they were pressed, with what keeps each
// of them: the key itself or a pedal. All [audio].
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "knotwave/base/rt.h"
#include "knotwave/engine/event.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

/// At most one entry a key, so it cannot overflow.
class NoteStack {
 public:
  struct Entry {
    std::uint8_t key = 0;
    std::uint8_t velocity = 0;
    bool key_down = false;
    bool sostenuto = false;
    std::int32_t number = Event::kNoNote;  ///< the player's own (Event::note)
    std::uint64_t serial = 0;              ///< the engine's own, 0 where it has none
  };

  void clear() KNOTWAVE_RT;
  bool is_empty() const KNOTWAVE_RT { return size_ == 0; }
  int size() const KNOTWAVE_RT { return size_; }
  /// Pressed (again): moves to the newest place.
  void press(int key, int velocity, std::int32_t number = Event::kNoNote,
             std::uint64_t serial = 0) KNOTWAVE_RT;
  /// The key goes up; it stays while `sustain` or its sostenuto holds it. True if it was down.
  /// With `number` that of this number, or one of the key without a number.
  bool lift(int key, bool sustain, std::int32_t number = Event::kNoNote) KNOTWAVE_RT;
  bool holds(std::int32_t number) const KNOTWAVE_RT;    ///< a numbered note
  bool is_down(std::int32_t number) const KNOTWAVE_RT;  ///< its key is down
  /// The entry of that number or, without one, of that key or Event::kEveryKey, whatever holds it.
  void remove(int key, std::int32_t number) KNOTWAVE_RT;
  /// Sostenuto goes down: holds the keys that are down now.
  void catch_sostenuto() KNOTWAVE_RT;
  void drop_sostenuto(bool sustain) KNOTWAVE_RT;
  /// Sustain goes up: keys that only it held leave.
  void drop_sustain() KNOTWAVE_RT;
  /// Every key goes up.
  void lift_all(bool sustain) KNOTWAVE_RT;
  /// The entry that sounds, or null when empty. Keys that are down go before those a pedal holds.
  const Entry* choose(NotePriority priority) const KNOTWAVE_RT;

  /// Entries with a serial that have gone since forget_gone(), 128 at most.
  std::span<const Entry> gone() const KNOTWAVE_RT { return std::span(gone_).first(gone_count_); }
  void forget_gone() KNOTWAVE_RT { gone_count_ = 0; }
  /// It is here, or gone and not forgotten.
  bool knows(std::uint64_t serial) const KNOTWAVE_RT;

 private:
  void erase(int index) KNOTWAVE_RT;
  void drop_if(bool sustain) KNOTWAVE_RT;

  std::array<Entry, 128> entries_;
  int size_ = 0;
  std::array<Entry, 128> gone_;
  std::size_t gone_count_ = 0;
};

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Who holds which voice and what keeps it: the key, a pedal, or nothing any more. Knows no sound,
// so every stuck-note case can be tested without one. All [audio] but the constructor.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/base/rt.h"
#include "knotwave/engine/event.h"

namespace knotwave::engine {

class BankProgram;
class PatchProgram;

struct VoiceSlot {
  enum class State : std::uint8_t { free, sounding, fading };
  State state = State::free;
  bool key_down = false;
  bool pedal_held = false;  ///< the key is up, a pedal keeps the gate open
  bool sostenuto = false;   ///< caught by the sostenuto pedal
  bool is_mono = false;     ///< follows its channel's note stack, not its own key
  int channel = 0;
  int bus = 0;  ///< the channel it is mixed into: the zone's master under MPE
  int key = 0;
  int choke_group = 0;
  std::int32_t number = Event::kNoNote;  ///< the player's own of the note
  std::uint64_t serial = 0;              ///< of the note it plays; 0: that went to another place
  const PatchProgram* patch = nullptr;
  const BankProgram* bank = nullptr;
  std::uint64_t age = 0;  ///< number of its note: smaller is older
  double level = 0;       ///< loudness at the last sample

  bool gate_is_open() const KNOTWAVE_RT { return key_down || pedal_held; }
  bool is_sounding() const KNOTWAVE_RT { return state == State::sounding; }
};

/// `max_voices` may sound, as many again may be fading out.
class VoiceSlots {
 public:
  explicit VoiceSlots(int max_voices)
      : max_voices_(max_voices), slots_(2 * static_cast<std::size_t>(max_voices)) {}

  int max_voices() const KNOTWAVE_RT { return max_voices_; }
  std::span<VoiceSlot> all() KNOTWAVE_RT { return slots_; }
  std::span<const VoiceSlot> all() const KNOTWAVE_RT { return slots_; }
  VoiceSlot& at(int index) KNOTWAVE_RT { return slots_[static_cast<std::size_t>(index)]; }
  const VoiceSlot& at(int index) const KNOTWAVE_RT {
    return slots_[static_cast<std::size_t>(index)];
  }
  void clear() KNOTWAVE_RT;

  int sounding_count() const KNOTWAVE_RT;
  /// Voices of one patch on one bus.
  int sounding_count(int bus, const PatchProgram* patch) const KNOTWAVE_RT;
  /// The lowest free place, or -1.
  int free_place() const KNOTWAVE_RT;
  /// Bit b: something sounds or fades on bus b.
  std::uint32_t sounding_buses() const KNOTWAVE_RT;
  bool is_playing(const BankProgram* bank) const KNOTWAVE_RT;

  /// What a new note may take: released voices first, the quietest of them; then those a pedal
  /// holds, then those a key holds, the oldest first. -1 when nothing sounds. With `patch`, only
  /// its voices on `bus`.
  int victim(int bus, const PatchProgram* patch) const KNOTWAVE_RT;

  /// The oldest voice of a key that is down: a note-off belongs to the first note-on not yet
  /// answered. -1 when there is none. Mono voices are not meant.
  int oldest_down(int channel, int key) const KNOTWAVE_RT;
  /// The same of a numbered note; where there is none, of a note of that key without a number.
  int down(std::int32_t number, int channel, int key) const KNOTWAVE_RT;

 private:
  template <class Meant>
  int oldest(Meant is_meant) const KNOTWAVE_RT;

  int max_voices_;
  std::vector<VoiceSlot> slots_;
};

}  // namespace knotwave::engine

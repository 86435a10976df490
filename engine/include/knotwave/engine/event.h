// SPDX-License-Identifier: MIT
// What the engine is told, with its time: MIDI, tempo, and patch changes are all events, so a
// journal of them is the whole performance.
#pragma once
#include <cstdint>

#include "knotwave/base/midi_event.h"

namespace knotwave::engine {

class BankProgram;

inline constexpr int kSongClocksPerQuarter = 24;

struct Event {
  enum class Kind : std::uint8_t { midi, tempo, install_bank, all_notes_off, set_target, position };
  /// The slot that means every slot of the channel.
  static constexpr int kEverySlot = 0xFFFF;
  Kind kind = Kind::midi;
  base::MidiEvent midi;  ///< Kind::midi; midi.time is the time of every kind
  std::uint32_t microseconds_per_quarter = 500000;  ///< Kind::tempo
  const BankProgram* bank = nullptr;  ///< Kind::install_bank; kept alive by the caller
  std::uint16_t slot = 0;             ///< Kind::set_target: a slot of map_slots.h, or kEverySlot
  double number = 0;  ///< Kind::set_target: added there in every voice of midi.channel()
  /// Kind::set_target: in the voices of all channels instead, beside what is added by channel. A
  /// system reset leaves it; kEverySlot takes back only these numbers.
  bool every_channel = false;
  /// Kind::position: where the song is, in MIDI clocks of 1/24 quarter note since its start.
  std::int64_t song_clocks = 0;

  base::SampleTime time() const KNOTWAVE_RT { return midi.time; }
};

}  // namespace knotwave::engine

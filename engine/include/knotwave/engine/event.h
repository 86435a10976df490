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
  enum class Kind : std::uint8_t {
    midi,
    tempo,
    install_bank,
    all_notes_off,
    set_target,
    position,
    set_note,
    choke
  };
  /// The slot that means every slot of the channel.
  static constexpr int kEverySlot = 0xFFFF;
  /// Slots of Kind::set_note: what the note's own pressure and timbre are, 0 to 1.
  static constexpr int kNotePressure = 0xFFFE, kNoteTimbre = 0xFFFD;
  static constexpr int kEveryKey = 0xFF;
  static constexpr std::int32_t kNoNote = -1;
  Kind kind = Kind::midi;
  base::MidiEvent midi;  ///< Kind::midi; midi.time is the time of every kind
  std::uint32_t microseconds_per_quarter = 500000;  ///< Kind::tempo
  const BankProgram* bank = nullptr;  ///< Kind::install_bank; kept alive by the caller
  std::uint16_t slot = 0;             ///< Kind::set_target: a slot of map_slots.h, or kEverySlot
  double number = 0;  ///< Kind::set_target: added there in every voice of midi.channel()
  /// Kind::set_target: in the voices of all channels instead, beside what is added by channel. A
  /// system reset leaves it; kEverySlot takes back only these numbers.
  bool every_channel = false;
  /// A number the player gave a note, 0 or more. Kind::midi: of this note on; this note off ends
  /// that note, wherever others of its key are. Kind::set_note and Kind::choke: only that note.
  std::int32_t note = kNoNote;
  /// Kind::set_note and Kind::choke without `note`: the notes of midi.channel() (or every_channel)
  /// on the key midi.bytes[1] (or kEveryKey). Choked ones fade out in 5 ms, whatever key or pedal
  /// holds them; a key that is down does not sound again. What a number is added to is `slot`; a
  /// note that begins at the same sample has it from its beginning, others glide.
  /// Two numbers may be added to one slot of a note: of modulation and of expression.
  bool is_expression = false;
  /// Kind::position: where the song is, in MIDI clocks of 1/24 quarter note since its start.
  std::int64_t song_clocks = 0;

  base::SampleTime time() const KNOTWAVE_RT { return midi.time; }
};

}  // namespace knotwave::engine

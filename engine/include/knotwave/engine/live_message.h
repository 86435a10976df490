// SPDX-License-Identifier: MIT
// What a player does, as it is handed from the thread that heard it to the audio thread.
#pragma once
#include <array>
#include <cstdint>
#include <type_traits>

#include "knotwave/base/midi_event.h"

namespace knotwave::engine {

/// Fixed size, copied through a ring.
struct LiveMessage {
  /// System exclusive that the engine understands is shorter (docs/engine.md).
  static constexpr int kMaxSysex = 24;
  enum class Kind : std::uint8_t {
    midi,
    tempo,       ///< number: microseconds per quarter note
    set_target,  ///< number is added to slot `index` (map_slots.h) of channel bytes[0] & 15
    all_notes_off,
    position,  ///< number: where the song is, in whole MIDI clocks (24 a quarter note)
  };

  std::int64_t time_ns = 0;  ///< when it was heard, by the steady clock; 0: as soon as can be
  Kind kind = Kind::midi;
  std::uint8_t bytes[3] = {0, 0, 0};  ///< as base::MidiEvent
  std::uint8_t port = 0;
  std::uint8_t sysex_size = 0;
  std::uint16_t index = 0;
  double number = 0;
  std::array<std::uint8_t, kMaxSysex> sysex{};
};
static_assert(std::is_trivially_copyable_v<LiveMessage>);

/// A message of a cable, heard at time_ns. [any] Longer system exclusive comes out with size 0,
/// which the engine counts as unknown.
LiveMessage live_message(const base::MidiEvent& event, std::int64_t time_ns) KNOTWAVE_RT;

}  // namespace knotwave::engine

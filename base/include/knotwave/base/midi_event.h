// SPDX-License-Identifier: MIT
// One complete MIDI message with its time. What files, devices and plugins hand to the engine.
#pragma once
#include <cstdint>

#include "knotwave/base/time.h"

namespace knotwave::base {

/// Status nibbles of channel messages.
enum class MidiStatus : std::uint8_t {
  note_off = 0x80,
  note_on = 0x90,
  poly_pressure = 0xA0,
  control_change = 0xB0,
  program_change = 0xC0,
  channel_pressure = 0xD0,
  pitch_bend = 0xE0,
  system = 0xF0,
};

/// A complete message: running status is resolved before it gets here. System exclusive data is
/// held by reference; who made the event keeps it alive as long as the event.
struct MidiEvent {
  SampleTime time;
  std::uint8_t bytes[3] = {0, 0, 0};  ///< status, data 1, data 2 (0 where the message has none)
  std::uint8_t port = 0;              ///< which input or track group; the engine does not read it
  std::uint32_t sysex_size = 0;       ///< bytes at `sysex`, F0 and F7 not counted
  const std::uint8_t* sysex = nullptr;

  constexpr MidiStatus status() const KNOTWAVE_RT {
    return static_cast<MidiStatus>(bytes[0] & 0xF0);
  }
  constexpr int channel() const KNOTWAVE_RT { return bytes[0] & 0x0F; }  ///< 0..15
};

}  // namespace knotwave::base

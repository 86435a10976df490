// SPDX-License-Identifier: MIT
// A MIDI message that came in one piece.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "knotwave/base/midi_event.h"

namespace knotwave::io {

/// Bytes of a message of this status, itself included; 0 where MIDI defines none or any number.
/// Source: MIDI 1.0 Detailed Specification 4.2, table 1. [any]
std::size_t message_size(std::uint8_t status) KNOTWAVE_RT;

/// Reads `bytes`, which must be one message and nothing else; system exclusive from F0 to F7 is
/// referred to where it stands. False, with `event` as it was: too short, too long, without a
/// status, data above 7F, or a status that MIDI leaves undefined. [audio]
bool read_complete_midi(std::span<const std::uint8_t> bytes, base::MidiEvent& event) KNOTWAVE_RT;

}  // namespace knotwave::io

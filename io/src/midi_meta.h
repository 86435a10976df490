// SPDX-License-Identifier: MIT
// Private to io: meta events of a track.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {

inline constexpr std::uint8_t kMetaPort = 0x21;
inline constexpr std::uint8_t kMetaEndOfTrack = 0x2F;
inline constexpr std::uint8_t kMetaTempo = 0x51;
inline constexpr std::uint8_t kMetaMeter = 0x58;

struct MetaEvent {
  std::uint64_t tick = 0;
  std::uint16_t track = 0;
  std::size_t offset = 0;  ///< of its FF
  std::uint8_t type = 0;
  std::span<const std::byte> content = {};
};

/// Adds a tempo, meter or text to the song. What means nothing to us is passed over; what is out of
/// its range is left out with a warning.
void take_meta(const MetaEvent& event, Song& song);

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// Private to io: one track chunk of a MIDI file, and the warnings of a song.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {

/// A typed error at a byte of a named file.
Error midi_error(ErrorCode code, std::string message, std::string_view source, std::size_t offset);

/// Keeps the first kMaxWarnings and counts the rest.
inline constexpr std::size_t kMaxWarnings = 100;
void add_warning(Song& song, std::size_t offset, std::string message);

/// A number from big-endian bytes; the caller has checked that `count` bytes are there.
std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at, int count);

struct TrackInput {
  std::span<const std::byte> bytes;  ///< the whole file
  std::string_view source_name;
  std::size_t begin = 0;  ///< first byte after the chunk header
  std::size_t limit = 0;  ///< no byte at or past it is read
  std::uint16_t track = 0;
  std::uint64_t start_tick = 0;
};

struct TrackEnd {
  std::size_t next = 0;  ///< the byte after the last one read
  std::uint64_t tick = 0;
  bool has_end_of_track = false;
  std::uint64_t ports = 0;  ///< bit p: a port prefix named port p (63 stands for all above)
};

/// Appends a track's events to `song`, in the order of the file. Errors: malformed (a number of
/// more than four bytes), file_too_large (too many events).
Result<TrackEnd> read_track(const TrackInput& input, Song& song);

}  // namespace knotwave::io

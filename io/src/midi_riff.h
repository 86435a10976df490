// SPDX-License-Identifier: MIT
// Private to io: where in a file the MIDI data is.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {

/// Bytes [begin, end) of the file hold the MIDI data; `begin` is its "MThd".
struct MidiExtent {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Finds "MThd": at the start, in the data chunk of a RIFF RMID file, or after at most 1 KiB of
/// something else (a MacBinary header, say), with a warning. Errors: malformed.
Result<MidiExtent> find_midi(std::span<const std::byte> bytes, std::string_view source_name,
                             Song& song);

/// Whether the four bytes at `at` read `id`; false where fewer are left.
bool has_id(std::span<const std::byte> bytes, std::size_t at, std::string_view id);

}  // namespace knotwave::io

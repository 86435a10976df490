// SPDX-License-Identifier: MIT
#include "midi_riff.h"

#include <algorithm>

#include "midi_track.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kMaxJunkBytes = 1024;
constexpr std::size_t kRiffHeaderBytes = 12;  // "RIFF", size, "RMID"
constexpr std::size_t kChunkHeaderBytes = 8;

std::size_t little_endian(std::span<const std::byte> bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;)
    value = value << 8 | std::to_integer<std::size_t>(bytes[at + i]);
  return value;
}

Error not_midi(std::span<const std::byte> bytes, std::string_view source_name) {
  std::string message = "not a MIDI file: it does not begin with 'MThd'";
  if (!bytes.empty() && bytes[0] == std::byte{'<'}) message += " (it looks like a web page)";
  return midi_error(ErrorCode::malformed, std::move(message), source_name, 0);
}

Result<MidiExtent> open_rmid(std::span<const std::byte> bytes, std::string_view source_name,
                             Song& song) {
  std::size_t at = kRiffHeaderBytes;
  while (bytes.size() >= kChunkHeaderBytes && at <= bytes.size() - kChunkHeaderBytes) {
    std::size_t size = little_endian(bytes, at + 4);
    const std::size_t content = at + kChunkHeaderBytes;
    if (has_id(bytes, at, "data")) {
      if (size > bytes.size() - content) {
        add_warning(song, at,
                    "the RIFF data chunk says " + std::to_string(size) + " bytes, " +
                        std::to_string(bytes.size() - content) + " are there");
        size = bytes.size() - content;
      }
      if (!has_id(bytes, content, "MThd")) break;
      return MidiExtent{content, content + size};
    }
    size += size & 1;  // chunks are padded to even
    if (size > bytes.size() - content) break;
    at = content + size;
  }
  return midi_error(ErrorCode::malformed, "RIFF RMID file without MIDI data", source_name, at);
}

}  // namespace

bool has_id(std::span<const std::byte> bytes, std::size_t at, std::string_view id) {
  return at <= bytes.size() && bytes.size() - at >= id.size() &&
         std::equal(id.begin(), id.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, std::byte b) { return static_cast<std::byte>(a) == b; });
}

Result<MidiExtent> find_midi(std::span<const std::byte> bytes, std::string_view source_name,
                             Song& song) {
  if (bytes.empty()) {
    return midi_error(ErrorCode::malformed, "not a MIDI file: it is empty", source_name, 0);
  }
  if (has_id(bytes, 0, "MThd")) return MidiExtent{0, bytes.size()};
  if (has_id(bytes, 0, "RIFF") && has_id(bytes, 8, "RMID")) {
    return open_rmid(bytes, source_name, song);
  }
  for (std::size_t at = 1; at <= kMaxJunkBytes && at < bytes.size(); ++at) {
    if (!has_id(bytes, at, "MThd")) continue;
    add_warning(song, 0, std::to_string(at) + " bytes before the MIDI data are passed over");
    return MidiExtent{at, bytes.size()};
  }
  return not_midi(bytes, source_name);
}

}  // namespace knotwave::io

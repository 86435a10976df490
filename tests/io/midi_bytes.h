// SPDX-License-Identifier: MIT
// MIDI files built byte by byte, one fault at a time.
#pragma once
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {

using Bytes = std::vector<std::uint8_t>;

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
inline Bytes text_bytes(const std::string& text) { return {text.begin(), text.end()}; }
inline Bytes big_endian_bytes(std::uint32_t value, int count) {
  Bytes out;
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(value >> shift));
  }
  return out;
}

inline Bytes header(int format = 0, int tracks = 1, int division = 96) {
  return text_bytes("MThd") + big_endian_bytes(6, 4) +
         big_endian_bytes(static_cast<std::uint32_t>(format), 2) +
         big_endian_bytes(static_cast<std::uint32_t>(tracks), 2) +
         big_endian_bytes(static_cast<std::uint32_t>(division), 2);
}
inline Bytes chunk(const std::string& id, const Bytes& body, long long declared = -1) {
  const auto size =
      declared < 0 ? static_cast<std::uint32_t>(body.size()) : static_cast<std::uint32_t>(declared);
  return text_bytes(id) + big_endian_bytes(size, 4) + body;
}
inline Bytes track(const Bytes& body, long long declared = -1) {
  return chunk("MTrk", body, declared);
}
inline Bytes meta(int type, const Bytes& content) {
  return Bytes{0x00, 0xFF, static_cast<std::uint8_t>(type),
               static_cast<std::uint8_t>(content.size())} +
         content;
}

inline const Bytes kEnd = {0x00, 0xFF, 0x2F, 0x00};
inline const Bytes kNote = {0x00, 0x90, 0x3C, 0x64, 0x60, 0x80, 0x3C, 0x40};  ///< 96 ticks long

inline Result<Song> parse(const Bytes& bytes) {
  return parse_midi(std::as_bytes(std::span(bytes)), "test.mid");
}
/// A format 0 file of one track.
inline Result<Song> parse_track(const Bytes& body) { return parse(header() + track(body)); }

inline Bytes bytes_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace knotwave::io

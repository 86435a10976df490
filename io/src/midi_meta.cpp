// SPDX-License-Identifier: MIT
// Tempo, meter and text, each checked. Key signature and SMPTE offset are only checked: nothing
// here plays them, but a value out of range says that the file is damaged.
#include "midi_meta.h"

#include "midi_track.h"

namespace knotwave::io {
namespace {

constexpr std::uint8_t kMetaLastText = 0x0F;
constexpr std::uint8_t kMetaSmpteOffset = 0x54;
constexpr std::uint8_t kMetaKey = 0x59;
constexpr int kMaxMeterPower = 7;         ///< 128th notes
constexpr std::size_t kMaxTexts = 65536;  ///< keeps memory within a small multiple of the file

int content_byte(const MetaEvent& event, std::size_t i) {
  return std::to_integer<int>(event.content[i]);
}

void leave_out(const MetaEvent& event, const std::string& what, Song& song) {
  add_warning(song, event.offset, what + ", left out");
}

void take_tempo(const MetaEvent& event, Song& song) {
  if (event.content.size() != 3) {
    return leave_out(event, "tempo of " + std::to_string(event.content.size()) + " bytes, not 3",
                     song);
  }
  const std::uint32_t microseconds = big_endian(event.content, 0, 3);
  if (microseconds == 0) return leave_out(event, "tempo of 0 microseconds a quarter note", song);
  song.tempos.push_back({event.tick, microseconds});
}

void take_meter(const MetaEvent& event, Song& song) {
  if (event.content.size() != 4) {
    return leave_out(event, "meter of " + std::to_string(event.content.size()) + " bytes, not 4",
                     song);
  }
  const int numerator = content_byte(event, 0);
  const int power = content_byte(event, 1);
  if (numerator == 0 || power > kMaxMeterPower) {
    return leave_out(event, "meter " + std::to_string(numerator) + "/2^" + std::to_string(power),
                     song);
  }
  song.meters.push_back({event.tick, numerator, 1 << power});
}

void check_key(const MetaEvent& event, Song& song) {
  bool is_valid = event.content.size() == 2;
  if (is_valid) {
    const int byte = content_byte(event, 0);
    const int sharps = byte < 128 ? byte : byte - 256;
    is_valid = sharps >= -7 && sharps <= 7 && content_byte(event, 1) <= 1;
  }
  if (!is_valid) leave_out(event, "key signature out of range", song);
}

void check_smpte_offset(const MetaEvent& event, Song& song) {
  bool is_valid = event.content.size() == 5;
  if (is_valid) {  // the hour byte carries the frame rate in bits 5 and 6
    is_valid = (content_byte(event, 0) & 0x1F) <= 23 && content_byte(event, 0) < 0x80 &&
               content_byte(event, 1) <= 59 && content_byte(event, 2) <= 59 &&
               content_byte(event, 3) <= 29 && content_byte(event, 4) <= 99;
  }
  if (!is_valid) leave_out(event, "SMPTE offset out of range", song);
}

void take_text(const MetaEvent& event, Song& song) {
  if (event.content.empty()) return;
  if (song.texts.size() == kMaxTexts) {
    return leave_out(event, "more than " + std::to_string(kMaxTexts) + " texts", song);
  }
  const auto* text = reinterpret_cast<const char*>(event.content.data());
  song.texts.push_back(
      {event.tick, event.track, event.type, std::string(text, event.content.size())});
}

}  // namespace

void take_meta(const MetaEvent& event, Song& song) {
  if (event.type >= 1 && event.type <= kMetaLastText) return take_text(event, song);
  switch (event.type) {
    case kMetaTempo:
      return take_tempo(event, song);
    case kMetaMeter:
      return take_meter(event, song);
    case kMetaKey:
      return check_key(event, song);
    case kMetaSmpteOffset:
      return check_smpte_offset(event, song);
    default:
      return;
  }
}

}  // namespace knotwave::io

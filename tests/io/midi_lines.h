// SPDX-License-Identifier: MIT
// A song in the words of midicsv, so that it can be compared with what midicsv says.
#pragma once
#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {

/// Lines of midicsv, or of ours in its words: one a channel message, system exclusive or tempo.
using Lines = std::vector<std::string>;

inline std::string line_of(const SongEvent& event, const Song& song) {
  std::ostringstream line;
  line << event.track + 1 << ", " << event.tick << ", ";
  const int channel = event.bytes[0] & 15;
  const int a = event.bytes[1];
  const int b = event.bytes[2];
  switch (event.bytes[0] >> 4) {
    case 0x8:
      line << "Note_off_c, " << channel << ", " << a << ", " << b;
      break;
    case 0x9:
      line << "Note_on_c, " << channel << ", " << a << ", " << b;
      break;
    case 0xA:
      line << "Poly_aftertouch_c, " << channel << ", " << a << ", " << b;
      break;
    case 0xB:
      line << "Control_c, " << channel << ", " << a << ", " << b;
      break;
    case 0xC:
      line << "Program_c, " << channel << ", " << a;
      break;
    case 0xD:
      line << "Channel_aftertouch_c, " << channel << ", " << a;
      break;
    case 0xE:
      line << "Pitch_bend_c, " << channel << ", " << (a | b << 7);
      break;
    default:
      line << "System_exclusive, " << event.sysex_size + 1;
      for (std::uint32_t i = 0; i < event.sysex_size; ++i) {
        line << ", " << static_cast<int>(song.sysex_bytes[event.sysex_begin + i]);
      }
      line << ", 247";
  }
  return line.str();
}

inline Lines our_lines(const Song& song) {
  std::vector<SongEvent> events = song.events;
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.track < b.track; });
  Lines lines;
  for (const SongEvent& event : events) lines.push_back(line_of(event, song));
  for (const TempoChange& tempo : song.tempos) {
    lines.push_back(std::to_string(tempo.tick) + ", Tempo, " +
                    std::to_string(tempo.microseconds_per_quarter));
  }
  return lines;
}

inline Lines midicsv_lines(const std::string& csv) {
  Lines lines;
  std::vector<std::pair<std::uint64_t, std::string>> tempos;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) {
    const std::size_t tick = line.find(", ") + 2;
    const std::size_t word = line.find(", ", tick) + 2;
    if (line.compare(word, 6, "Tempo,") == 0) {
      tempos.emplace_back(std::stoull(line.substr(tick)), line.substr(tick));
    } else if (line.find("_c, ", word) != std::string::npos &&
               line.find('"') == std::string::npos) {
      lines.push_back(line);
    } else if (line.compare(word, 17, "System_exclusive,") == 0) {
      lines.push_back(line);
    }
  }
  std::stable_sort(tempos.begin(), tempos.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [tick, line] : tempos) lines.push_back(line);
  return lines;
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// Notes written as a MIDI file at 120 beats a minute, for tests that render them.
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/io/midi_file.h"

#include "support/program.h"

namespace knotwave::render {

struct Note {
  double beat, beats;
  int key;
  int velocity;
  int channel = 1;
};

/// In `folder`, with more events among them; the path.
inline std::string notes_file(const support::ScratchFolder& folder, const std::vector<Note>& notes,
                              const std::vector<io::SongEvent>& more = {}) {
  constexpr double kTicks = 480;
  io::Song song;
  song.track_count = 1;
  song.events.assign(more.begin(), more.end());
  for (const Note& note : notes) {
    const auto key = static_cast<std::uint8_t>(note.key);
    const auto velocity = static_cast<std::uint8_t>(note.velocity);
    const auto note_on = static_cast<std::uint8_t>(0x90 + note.channel - 1);
    const auto note_off = static_cast<std::uint8_t>(0x80 + note.channel - 1);
    const auto on = static_cast<std::uint64_t>(note.beat * kTicks);
    const auto off = static_cast<std::uint64_t>((note.beat + note.beats) * kTicks);
    song.events.push_back({on, 0, {note_on, key, velocity}, 0, 0});
    song.events.push_back({off, 0, {note_off, key, 64}, 0, 0});
    song.length_ticks = std::max(song.length_ticks, off);
  }
  std::stable_sort(song.events.begin(), song.events.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  const auto bytes = io::write_midi(song);
  std::string path = folder.file("notes.mid");
  EXPECT_TRUE(base::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  return path;
}

}  // namespace knotwave::render

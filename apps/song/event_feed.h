// SPDX-License-Identifier: MIT
// A song as the engine's events, made block by block: memory does not grow with the song.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "knotwave/engine/event.h"
#include "knotwave/io/midi_file.h"

namespace knotwave::song {

/// A message of a song, without its time.
engine::Event engine_event(const io::Song& song, const io::SongEvent& event);

/// MIDI messages and tempo changes by time; at equal ticks the tempo comes first. At the end of the
/// song, after everything else, all notes off.
class EventFeed {
 public:
  /// `song` must outlive the feed.
  EventFeed(const io::Song& song, int rate_hz);

  /// The events before sample `end` that were not given yet. Valid until the next call.
  std::span<const engine::Event> before(std::int64_t end);
  /// When the song ends.
  base::SampleTime end() const { return end_; }
  /// Bit c: channel c plays a note.
  std::uint32_t channels() const { return channels_; }

 private:
  std::optional<engine::Event> peek();

  const io::Song& song_;
  io::TickClock clock_;
  base::SampleTime end_;
  std::uint32_t channels_ = 0;
  std::size_t next_event_ = 0;
  std::size_t next_tempo_ = 0;
  bool ended_ = false;
  std::vector<engine::Event> block_;
};

}  // namespace knotwave::song

// SPDX-License-Identifier: MIT
#include "event_feed.h"

namespace knotwave::song {

EventFeed::EventFeed(const io::Song& song, int rate_hz)
    : song_(song),
      clock_(song, static_cast<std::uint32_t>(rate_hz)),
      end_(clock_.at(song.length_ticks)) {
  for (const io::SongEvent& event : song.events) {
    const bool is_note_on = (event.bytes[0] & 0xF0) == 0x90 && event.bytes[2] > 0;
    if (is_note_on) channels_ |= 1u << (event.bytes[0] & 0x0F);
  }
}

engine::Event engine_event(const io::Song& song, const io::SongEvent& event) {
  engine::Event out;
  for (int i = 0; i < 3; ++i) out.midi.bytes[i] = event.bytes[i];
  if (event.sysex_size > 0) {
    out.midi.sysex = song.sysex_bytes.data() + event.sysex_begin;
    out.midi.sysex_size = event.sysex_size;
  }
  return out;
}

/// The next event in order, still to be taken.
std::optional<engine::Event> EventFeed::peek() {
  const bool has_event = next_event_ < song_.events.size();
  const bool has_tempo = next_tempo_ < song_.tempos.size();
  engine::Event event;
  if (has_tempo &&
      (!has_event || song_.tempos[next_tempo_].tick <= song_.events[next_event_].tick)) {
    const io::TempoChange& tempo = song_.tempos[next_tempo_];
    event.kind = engine::Event::Kind::tempo;
    event.microseconds_per_quarter = tempo.microseconds_per_quarter;
    event.midi.time = clock_.at(tempo.tick);
    return event;
  }
  if (has_event) {
    const io::SongEvent& next = song_.events[next_event_];
    event = engine_event(song_, next);
    event.midi.time = clock_.at(next.tick);
    return event;
  }
  if (ended_) return std::nullopt;
  event.kind = engine::Event::Kind::all_notes_off;
  event.midi.time = end_;
  return event;
}

std::span<const engine::Event> EventFeed::before(std::int64_t end) {
  block_.clear();
  for (auto event = peek(); event && event->time().sample < end; event = peek()) {
    block_.push_back(*event);
    switch (event->kind) {
      case engine::Event::Kind::tempo:
        ++next_tempo_;
        break;
      case engine::Event::Kind::all_notes_off:
        ended_ = true;
        break;
      default:
        ++next_event_;
    }
  }
  return block_;
}

}  // namespace knotwave::song

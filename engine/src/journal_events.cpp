// SPDX-License-Identifier: MIT
// A journal's records as the engine's events.
#include <algorithm>

#include "knotwave/engine/journal.h"

namespace knotwave::engine {

std::vector<Event> journal_events(const Journal& journal) {
  std::vector<Event> events;
  events.reserve(journal.records.size());
  for (const JournalRecord& record : journal.records) {
    Event& event = events.emplace_back();
    event.kind = record.kind;
    event.midi.time = record.time;
    event.note = record.note;
    std::copy_n(record.bytes, 3, event.midi.bytes);
    if (record.sysex_size > 0) {
      event.midi.sysex = record.sysex.data();
      event.midi.sysex_size = record.sysex_size;
    }
    if (record.kind == Event::Kind::tempo) {
      event.microseconds_per_quarter = static_cast<std::uint32_t>(record.number);
    } else if (record.kind == Event::Kind::set_target || record.kind == Event::Kind::set_note) {
      event.slot = static_cast<std::uint16_t>(record.index);
      event.number = record.number;
      event.every_channel = record.every_channel;
      event.is_expression = record.is_expression;
    } else if (record.kind == Event::Kind::choke) {
      event.every_channel = record.every_channel;
    } else if (record.kind == Event::Kind::position) {
      event.song_clocks = static_cast<std::int64_t>(record.number);
    }
  }
  return events;
}

}  // namespace knotwave::engine

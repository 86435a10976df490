// SPDX-License-Identifier: MIT
// Any bytes as a MIDI file: no crash, and what is accepted keeps its promises.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "knotwave/io/midi_file.h"

namespace {

using namespace knotwave;
using knotwave::io::Song;

void require(bool claim, const char* what) {
  if (claim) return;
  std::fprintf(stderr, "fuzz_smf: %s\n", what);
  std::abort();
}

void check_order(const Song& song, std::size_t bytes) {
  require(song.events.size() <= bytes, "more events than bytes");
  std::uint64_t tick = 0;
  for (const io::SongEvent& event : song.events) {
    require(event.tick >= tick && event.tick <= song.length_ticks, "ticks go back or past the end");
    tick = event.tick;
    require(event.track < song.track_count, "an event of no track");
    require(event.bytes[0] >= 0x80 && event.bytes[0] <= 0xF0, "an event of no status");
    require(event.bytes[1] < 0x80 && event.bytes[2] < 0x80, "a data byte above 127");
    const std::uint64_t end = std::uint64_t{event.sysex_begin} + event.sysex_size;
    require(end <= song.sysex_bytes.size(), "system exclusive out of its bytes");
  }
  for (const io::TempoChange& tempo : song.tempos) {
    require(tempo.microseconds_per_quarter >= 1, "a tempo of 0");
  }
}

void check_times(const Song& song) {
  io::TickClock clock(song, 768000);
  base::SampleTime last;
  for (const io::SongEvent& event : song.events) {
    const base::SampleTime time = clock.at(event.tick);
    require(time >= last, "time goes back");
    last = time;
  }
}

void check_round_trip(const Song& song) {
  const auto bytes = io::write_midi(song);
  const auto again = io::parse_midi(std::as_bytes(std::span(bytes)), "again");
  require(again.has_value(), "what was written is refused");
  require(again->warnings.empty() || song.track_count == 0, "what was written gives warnings");
  require(again->tempos == song.tempos && again->meters == song.meters, "tempos or meters differ");
  require(again->texts == song.texts, "texts differ");
  require(again->length_ticks == song.length_ticks, "lengths differ");
  require(again->time_base == song.time_base, "time bases differ");
  require(again->events.size() == song.events.size(), "counts of events differ");
  for (std::size_t i = 0; i < song.events.size(); ++i) {
    const io::SongEvent& a = song.events[i];
    const io::SongEvent& b = again->events[i];
    require(a.tick == b.tick && a.track == b.track && a.sysex_size == b.sysex_size,
            "events differ");
    for (int k = 0; k < 3; ++k) require(a.bytes[k] == b.bytes[k], "bytes of events differ");
    for (std::uint32_t k = 0; k < a.sysex_size; ++k) {
      require(song.sysex_bytes[a.sysex_begin + k] == again->sysex_bytes[b.sysex_begin + k],
              "system exclusives differ");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto song = io::parse_midi(std::as_bytes(std::span(data, size)), "fuzz");
  if (!song) {
    require(song.error().offset >= 0 && song.error().offset <= static_cast<long long>(size),
            "an error at no byte of the file");
    return 0;
  }
  check_order(*song, size);
  check_times(*song);
  check_round_trip(*song);
  for (const io::SongText& text : song->texts) io::printable(text.text);
  return 0;
}

// SPDX-License-Identifier: MIT
// A MIDI file in, what would be sent out: the generator without devices.
#pragma once
#include <string>
#include <vector>

#include "knotwave/io/midi_file.h"

#include "env_input.h"
#include "sent_list.h"

namespace knotwave::env {

struct PortUse {
  std::string name;
  std::int64_t messages = 0, bytes = 0;
  double bytes_per_second = 0;
  double share = 0;  ///< of what its cable can carry; 0: it has no budget
};

struct DryRun {
  SentList sent;
  SentNames names;
  std::int64_t messages_in = 0;
  std::int64_t lost = 0;            ///< for which the generator or a port had no room
  std::int64_t overload_bytes = 0;  ///< passed through, of messages that waited too long
  std::int64_t end = 0;             ///< samples of the virtual clock
  std::vector<PortUse> ports;
  std::vector<engine::PortSpec> port_specs;    ///< of `ports`
  std::vector<std::vector<int>> output_ports;  ///< [patch][output]; -1: OSC or voltage
  bool came_to_rest = true;
};

/// The whole song, `tail_s` more, and the way to rest, 30 s at most. Errors: those of
/// make_generator(), value_out_of_range (a song of more than a day).
Result<DryRun> dry_run(const EnvOptions& options, const EnvInput& input, const io::Song& song);

/// What a program says at the end, one line.
std::string dry_run_line(const DryRun& run, const std::string& path);

/// MIDI messages and tempos of a song in order, those before it ends; equal ticks: the tempo first.
/// `tempo` is called with (time, microseconds_per_quarter), `message` with an event that has its
/// time.
template <class Tempo, class Message>
void play_song(const io::Song& song, Tempo&& tempo, Message&& message) {
  io::TickClock clock(song, kClockHz);
  std::size_t next = 0;
  const auto tempos_until = [&](std::uint64_t tick) {
    for (; next < song.tempos.size() && song.tempos[next].tick <= tick; ++next) {
      tempo(clock.at(song.tempos[next].tick), song.tempos[next].microseconds_per_quarter);
    }
  };
  for (const io::SongEvent& event : song.events) {
    tempos_until(event.tick);
    base::MidiEvent midi;
    midi.time = clock.at(event.tick);
    for (int i = 0; i < 3; ++i) midi.bytes[i] = event.bytes[i];
    if (event.sysex_size > 0) {
      midi.sysex = song.sysex_bytes.data() + event.sysex_begin;
      midi.sysex_size = event.sysex_size;
    }
    message(midi);
  }
  tempos_until(song.length_ticks);
}

}  // namespace knotwave::env

// SPDX-License-Identifier: MIT
#include "take/take_midi.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <vector>

#include "knotwave/base/document.h"
#include "knotwave/engine/channel_state.h"

namespace knotwave::take {
namespace {

using engine::Event;
using engine::JournalRecord;

constexpr std::int64_t kMicroseconds = 1'000'000;
constexpr std::int64_t kUsualTempo = 500'000;  // microseconds per quarter note
constexpr std::int64_t kSlowestTempo = 16'777'215;
constexpr std::int64_t kMostTicks = 32'767;

struct Clock {
  int ticks_per_quarter = 0;
  std::uint32_t microseconds_per_quarter = 0;
};

/// Ticks and tempo whose quotient is the rate, the tempo as near to 120 a minute as can be.
Result<Clock> clock_of(double rate_hz) {
  const auto rate = static_cast<std::int64_t>(rate_hz);
  if (rate >= 1 && static_cast<double>(rate) == rate_hz) {
    const std::int64_t common = std::gcd(rate, kMicroseconds);
    const std::int64_t ticks = rate / common, tempo = kMicroseconds / common;
    const std::int64_t most = std::min(kMostTicks / ticks, kSlowestTempo / tempo);
    const std::int64_t wanted = std::max<std::int64_t>((kUsualTempo + tempo / 2) / tempo, 1);
    if (const std::int64_t times = std::min(most, wanted); times >= 1) {
      return Clock{static_cast<int>(times * ticks), static_cast<std::uint32_t>(times * tempo)};
    }
  }
  return fail(ErrorCode::unsupported, "a MIDI file has no time base for exactly " +
                                          base::number_text(rate_hz) + " ticks a second");
}

bool is_note(const JournalRecord& r) {
  return r.kind == Event::Kind::midi && ((r.bytes[0] & 0xE0) == 0x80);
}
bool is_note_on(const JournalRecord& r) {
  return is_note(r) && (r.bytes[0] & 0x10) != 0 && r.bytes[2] > 0;
}

/// For each record before `first`: whether it is a note that had ended, or the end of one.
std::vector<bool> notes_over(std::span<const JournalRecord> records, std::int64_t first) {
  std::vector<bool> over(records.size(), false);
  std::array<std::vector<std::size_t>, 16 * 128> down;
  for (std::size_t i = 0; i < records.size() && records[i].time.sample < first; ++i) {
    if (!is_note(records[i])) continue;
    auto& key = down[static_cast<std::size_t>((records[i].bytes[0] & 15) * 128 +
                                              (records[i].bytes[1] & 127))];
    if (is_note_on(records[i])) {
      key.push_back(i);
      continue;
    }
    over[i] = true;
    if (key.empty()) continue;
    over[key.front()] = true;  // the engine answers the oldest note-on
    key.erase(key.begin());
  }
  return over;
}

class SongWriter {
 public:
  explicit SongWriter(io::Song& song) : song_(song) {}

  void add(std::uint64_t tick, const JournalRecord& record) {
    if (record.kind == Event::Kind::all_notes_off) {
      for (int channel = 0; channel < 16; ++channel) {
        for (const int controller : {engine::kSustain, engine::kSostenuto, engine::kAllNotesOff}) {
          message(tick, 0xB0 | channel, controller);
        }
      }
    }
    if (record.kind == Event::Kind::choke) choke(tick, record);
    if (record.kind != Event::Kind::midi) return;
    if (record.note >= 0 && is_note_on(record)) numbered_[record.note] = record;
    const int status = record.bytes[0];
    if (status >= 0x80 && status < 0xF0 && ((record.bytes[1] | record.bytes[2]) & 0x80) == 0) {
      io::SongEvent& event = message(tick, status, record.bytes[1]);
      const bool has_two = (status & 0xE0) != 0xC0;
      event.bytes[2] = has_two ? record.bytes[2] : std::uint8_t{0};
    } else if (status == 0xF0 && record.sysex_size > 0) {
      io::SongEvent& event = message(tick, status, 0);
      event.sysex_begin = static_cast<std::uint32_t>(song_.sysex_bytes.size());
      event.sysex_size = record.sysex_size;
      song_.sysex_bytes.insert(song_.sysex_bytes.end(), record.sysex.begin(),
                               record.sysex.begin() + record.sysex_size);
    }
  }

 private:
  /// MIDI knows no choke of one key: its note ends there.
  void choke(std::uint64_t tick, const JournalRecord& record) {
    if (record.note >= 0) {
      const auto on = numbered_.find(record.note);
      if (on != numbered_.end()) end_key(tick, on->second.bytes[0] & 15, on->second.bytes[1]);
      return;
    }
    for (int channel = 0; channel < 16; ++channel) {
      if (!record.every_channel && channel != (record.bytes[0] & 15)) continue;
      if (record.bytes[1] == Event::kEveryKey) {
        message(tick, 0xB0 | channel, engine::kAllSoundOff);
      } else {
        end_key(tick, channel, record.bytes[1] & 127);
      }
    }
  }
  void end_key(std::uint64_t tick, int channel, int key) {
    message(tick, 0x80 | channel, key).bytes[2] = 64;
  }
  io::SongEvent& message(std::uint64_t tick, int status, int one) {
    io::SongEvent& event = song_.events.emplace_back();
    event.tick = tick;
    event.bytes[0] = static_cast<std::uint8_t>(status);
    event.bytes[1] = static_cast<std::uint8_t>(one);
    return event;
  }
  io::Song& song_;
  std::map<std::int32_t, JournalRecord> numbered_;  ///< note ons
};

}  // namespace

Result<io::Song> midi_song(const engine::Journal& journal) {
  const auto clock = clock_of(journal.rate_hz);
  if (!clock) return clock.error();
  io::Song song;
  song.format = 1;
  song.track_count = 1;
  song.time_base.ticks_per_quarter = clock->ticks_per_quarter;
  song.tempos.push_back({0, clock->microseconds_per_quarter});
  const std::vector<bool> over = notes_over(journal.records, journal.first);
  SongWriter writer(song);
  for (std::size_t i = 0; i < journal.records.size(); ++i) {
    const JournalRecord& record = journal.records[i];
    const std::int64_t sample = base::first_sample(record.time);
    if (over[i]) continue;
    if (sample > journal.end) break;
    writer.add(static_cast<std::uint64_t>(std::max<std::int64_t>(sample - journal.first, 0)),
               record);
  }
  song.length_ticks = static_cast<std::uint64_t>(journal.end - journal.first);
  return song;
}

}  // namespace knotwave::take

// SPDX-License-Identifier: MIT
// Standard MIDI files (SMF 1.0, RP-001): read with warnings or one typed error, and written.
// [control] Never allocates from a length field; time and memory are bounded by the file's size.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"

namespace knotwave::io {

inline constexpr std::size_t kMaxMidiFileBytes = 64u << 20;
inline constexpr std::size_t kMaxMidiEvents = 20'000'000;

/// One channel message or system exclusive of a song, in ticks. A system exclusive split over
/// packets is one event, at the tick of its last packet.
struct SongEvent {
  std::uint64_t tick = 0;
  std::uint16_t track = 0;
  std::uint8_t bytes[3] = {0, 0, 0};  ///< status 0x80..0xEF and data; 0xF0 for system exclusive
  std::uint32_t sysex_begin = 0;      ///< into Song::sysex_bytes
  std::uint32_t sysex_size = 0;       ///< F0 and F7 not counted; 0 for channel messages
  friend bool operator==(const SongEvent&, const SongEvent&) = default;
};

struct TempoChange {
  std::uint64_t tick = 0;
  std::uint32_t microseconds_per_quarter = 500000;  ///< 1..16777215
  friend bool operator==(const TempoChange&, const TempoChange&) = default;
};
struct MeterChange {
  std::uint64_t tick = 0;
  int numerator = 4;    ///< 1..255
  int denominator = 4;  ///< a power of two, 1..128
  friend bool operator==(const MeterChange&, const MeterChange&) = default;
};
struct SongText {
  std::uint64_t tick = 0;
  std::uint16_t track = 0;
  int meta_type = 1;  ///< 1 text, 3 track name, 5 lyric, 6 marker ...
  std::string text;   ///< as in the file, not sanitised; print with printable()
  friend bool operator==(const SongText&, const SongText&) = default;
};
struct SongWarning {
  std::size_t offset = 0;  ///< in bytes
  std::string message;
};

/// Where ticks stand in time.
struct TimeBase {
  int ticks_per_quarter = 480;  ///< 1..32767, or 0 when SMPTE
  int smpte_fps = 0;            ///< 24, 25, 29 (29.97 drop) or 30
  int ticks_per_frame = 0;      ///< 1..255 when SMPTE
  friend bool operator==(const TimeBase&, const TimeBase&) = default;
};

struct Song {
  int format = 1;  ///< as in the file. Format 2 patterns are laid one after another.
  int track_count = 0;
  TimeBase time_base;
  std::vector<SongEvent> events;    ///< by tick; equal ticks in file order, track by track
  std::vector<TempoChange> tempos;  ///< by tick; 120 bpm before the first
  std::vector<MeterChange> meters;
  std::vector<SongText> texts;
  std::vector<std::uint8_t> sysex_bytes;
  std::uint64_t length_ticks = 0;  ///< the last End of Track
  std::vector<SongWarning> warnings;
  std::size_t warnings_left_out = 0;  ///< past the first 100
};

/// Bytes to a song. A RIFF RMID wrapper is opened; up to 1 KiB before "MThd" is passed over with a
/// warning. Errors, with byte offset: malformed, unsupported_format, file_too_large. What can be
/// read of a damaged track is kept, with a warning; an event out of its range is left out, with a
/// warning. A valid file gives no warning. Cost O(n log n) in events; memory at
/// most 64 MiB and 16 times the size of `bytes`.
Result<Song> parse_midi(std::span<const std::byte> bytes, std::string_view source_name);
/// The same from a file. Errors besides: file_not_found, io_failed.
Result<Song> read_midi_file(const std::string& path);

/// Format 1 with the song's tracks (0 if it has one), tempos and meters in the first of them.
/// Reading it back gives the same events, tempos, meters, texts and length.
std::vector<std::uint8_t> write_midi(const Song& song);

/// Ticks to samples by exact 128-bit rational arithmetic over the tempo map, floored to 2^-32
/// sample. [control]
class TickClock {
 public:
  /// `song` must outlive the clock. rate_hz 1..768000.
  TickClock(const Song& song, std::uint32_t rate_hz);
  /// When a tick is; saturates at 2^62 samples. Going forward costs O(1) a call over the song;
  /// going back starts over.
  base::SampleTime at(std::uint64_t tick);

 private:
  void start_over();

  const Song* song_;
  std::uint32_t rate_hz_;
  std::uint64_t denominator_ = 1;
  std::uint64_t smpte_per_tick_ = 0;  ///< numerator of a tick's samples; 0 when ticks are musical
  std::size_t next_tempo_ = 0;
  std::uint64_t segment_tick_ = 0;           ///< the last tempo change at or before the tick
  unsigned __int128 segment_numerator_ = 0;  ///< samples * denominator there
  std::uint64_t per_tick_ = 0;
};

/// Text with control characters, escapes, changes of direction and bad UTF-8 replaced, cut to
/// max_chars code points: safe to print.
std::string printable(std::string_view text, std::size_t max_chars = 80);

}  // namespace knotwave::io

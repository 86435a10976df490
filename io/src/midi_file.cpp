// SPDX-License-Identifier: MIT
// The container of a MIDI file: header and chunks. Tracks are in midi_track.cpp.
#include "knotwave/io/midi_file.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "knotwave/base/file.h"

#include "midi_riff.h"
#include "midi_track.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kHeaderBytes = 6;
constexpr int kMaxTracks = 65535;

struct Header {
  int format = 0;
  int tracks = 0;
  TimeBase time_base;
};

Result<TimeBase> read_time_base(unsigned division, std::string_view source, std::size_t offset) {
  if (division < 0x8000) {
    if (division == 0) {
      return midi_error(ErrorCode::malformed, "0 ticks a quarter note", source, offset);
    }
    return TimeBase{static_cast<int>(division), 0, 0};
  }
  const int fps = 256 - static_cast<int>(division >> 8);
  const int ticks = static_cast<int>(division & 0xFF);
  if (fps != 24 && fps != 25 && fps != 29 && fps != 30) {
    return midi_error(ErrorCode::malformed,
                      "SMPTE time of " + std::to_string(fps) +
                          " frames a second, which is none of 24, 25, 29 and 30",
                      source, offset);
  }
  if (ticks == 0) {
    return midi_error(ErrorCode::malformed, "SMPTE time of 0 ticks a frame", source, offset);
  }
  return TimeBase{0, fps, ticks};
}

/// Reads the header chunk at `at` and moves `at` past it.
Result<Header> read_header(std::span<const std::byte> bytes, std::string_view source,
                           std::size_t& at) {
  const std::size_t left = bytes.size() - at;
  if (left < kChunkHeaderBytes + kHeaderBytes) {
    return midi_error(ErrorCode::malformed, "the file ends inside its header", source, at);
  }
  const std::uint32_t size = big_endian(bytes, at + 4, 4);
  if (size < kHeaderBytes || size > left - kChunkHeaderBytes) {
    return midi_error(ErrorCode::malformed,
                      "the header says it has " + std::to_string(size) + " bytes; 6 to " +
                          std::to_string(left - kChunkHeaderBytes) + " are possible",
                      source, at + 4);
  }
  Header header;
  header.format = static_cast<int>(big_endian(bytes, at + 8, 2));
  header.tracks = static_cast<int>(big_endian(bytes, at + 10, 2));
  if (header.format > 2) {
    return midi_error(
        ErrorCode::unsupported_format,
        "MIDI file format " + std::to_string(header.format) + "; 0, 1 and 2 are known", source,
        at + 8);
  }
  auto time_base = read_time_base(big_endian(bytes, at + 12, 2), source, at + 12);
  if (!time_base) return std::move(time_base).error();
  header.time_base = *time_base;
  at += kChunkHeaderBytes + size;
  return header;
}

/// Whether a chunk could begin here: four printable characters, or the end of the file.
bool is_chunk_start(std::span<const std::byte> bytes, std::size_t at) {
  if (at == bytes.size()) return true;
  if (bytes.size() - at < kChunkHeaderBytes) return false;
  return std::all_of(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4, [](std::byte b) {
                       const int c = std::to_integer<int>(b);
                       return c >= 0x20 && c < 0x7F;
                     });
}

class SongReader {
 public:
  SongReader(std::span<const std::byte> bytes, std::string_view source, Song& song)
      : bytes_(bytes), source_(source), song_(song) {}

  Result<void> read(std::size_t at);

 private:
  enum class Step { next, stop };
  Result<Step> chunk();
  Result<void> track(std::uint32_t declared_bytes);
  void begin_pattern();

  std::span<const std::byte> bytes_;  ///< up to the end of the MIDI data
  std::string_view source_;
  Song& song_;
  std::size_t at_ = 0;
  std::uint64_t ports_ = 0;
};

Result<void> SongReader::read(std::size_t at) {
  at_ = at;
  const auto header = read_header(bytes_, source_, at_);
  if (!header) return header.error();
  song_.format = header->format;
  song_.time_base = header->time_base;
  while (at_ < bytes_.size()) {
    const auto step = chunk();
    if (!step) return step.error();
    if (*step == Step::stop) break;
  }
  if (song_.track_count != header->tracks || song_.track_count == 0) {
    add_warning(song_, at,
                "the header says " + std::to_string(header->tracks) + " tracks, the file has " +
                    std::to_string(song_.track_count));
  } else if (song_.format == 0 && song_.track_count > 1) {
    add_warning(song_, at, "format 0 with " + std::to_string(song_.track_count) + " tracks");
  }
  if ((ports_ & (ports_ - 1)) != 0) {
    add_warning(song_, at, "the song is for several MIDI ports; here they share 16 channels");
  }
  return {};
}

Result<SongReader::Step> SongReader::chunk() {
  const std::size_t begin = at_;
  if (bytes_.size() - at_ < kChunkHeaderBytes || !is_chunk_start(bytes_, at_)) {
    add_warning(song_, begin,
                std::to_string(bytes_.size() - begin) + " bytes after the last chunk are not read");
    return Step::stop;
  }
  const std::uint32_t size = big_endian(bytes_, at_ + 4, 4);
  if (has_id(bytes_, at_, "MThd")) {
    add_warning(song_, begin, "a second MIDI file begins here and is not read");
    return Step::stop;
  }
  if (has_id(bytes_, at_, "MTrk")) {
    if (song_.track_count == kMaxTracks) {
      add_warning(song_, begin, "tracks beyond the 65535th are not read");
      return Step::stop;
    }
    at_ += kChunkHeaderBytes;
    if (const auto done = track(size); !done) return done.error();
    return Step::next;
  }
  at_ += kChunkHeaderBytes;
  const std::size_t left = bytes_.size() - at_;
  if (size > left) {
    const std::string what = "a chunk that is no track says it has " + std::to_string(size) +
                             " bytes where " + std::to_string(left) + " are left";
    if (song_.track_count == 0) {
      return midi_error(ErrorCode::malformed, what + ", and no track came before it", source_,
                        begin);
    }
    add_warning(song_, begin, what);
    return Step::stop;
  }
  at_ += size;
  return Step::next;
}

/// A track ends at its End of Track. Its declared length binds where the file agrees with it, that
/// is, where another chunk or the end of the file follows; elsewhere the track is read on.
Result<void> SongReader::track(std::uint32_t declared_bytes) {
  const std::size_t begin = at_;
  const bool is_inside = declared_bytes <= bytes_.size() - begin;
  const std::size_t declared_end = is_inside ? begin + declared_bytes : bytes_.size();
  const bool is_plausible = is_inside && is_chunk_start(bytes_, declared_end);
  TrackInput input{.bytes = bytes_, .source_name = source_, .begin = begin};
  input.limit = is_plausible ? declared_end : bytes_.size();
  input.track = static_cast<std::uint16_t>(song_.track_count++);
  if (song_.format == 2) {
    begin_pattern();
    input.start_tick = song_.length_ticks;
  }
  const auto end = read_track(input, song_);
  if (!end) return end.error();
  if (!is_inside || end->next > declared_end) {
    add_warning(song_, begin - 4,
                "track " + std::to_string(input.track) + " says it has " +
                    std::to_string(declared_bytes) + " bytes; " +
                    std::to_string(end->next - begin) + " were read");
  } else if (is_plausible && end->next < declared_end) {
    add_warning(
        song_, end->next,
        std::to_string(declared_end - end->next) + " bytes after End of Track are not read");
  }
  at_ = is_inside ? std::max(end->next, declared_end) : end->next;
  song_.length_ticks = std::max(song_.length_ticks, end->tick);
  ports_ |= end->ports;
  return {};
}

/// Every pattern of format 2 starts from 120 bpm in 4/4, whatever the one before it left.
void SongReader::begin_pattern() {
  const TempoChange tempo{.tick = song_.length_ticks};
  const MeterChange meter{.tick = song_.length_ticks};
  if (!song_.tempos.empty()) song_.tempos.push_back(tempo);
  if (!song_.meters.empty()) song_.meters.push_back(meter);
}

/// By tick; equal ticks stay as read. An index sort and a permutation in place need 4 bytes an
/// event, where std::stable_sort would need a second copy of them all.
void sort_events(std::vector<SongEvent>& events) {
  const auto by_tick = [](const SongEvent& a, const SongEvent& b) { return a.tick < b.tick; };
  if (std::is_sorted(events.begin(), events.end(), by_tick)) return;
  std::vector<std::uint32_t> from(events.size());
  std::iota(from.begin(), from.end(), 0u);
  std::sort(from.begin(), from.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(events[a].tick, a) < std::pair(events[b].tick, b);
  });
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    if (from[i] == i) continue;
    const SongEvent first = events[i];
    std::uint32_t to = i;
    while (from[to] != i) {
      const std::uint32_t source = from[to];
      events[to] = events[source];
      from[to] = to;
      to = source;
    }
    events[to] = first;
    from[to] = to;
  }
}

void sort_song(Song& song) {
  const auto by_tick = [](const auto& a, const auto& b) { return a.tick < b.tick; };
  sort_events(song.events);
  std::stable_sort(song.tempos.begin(), song.tempos.end(), by_tick);
  std::stable_sort(song.meters.begin(), song.meters.end(), by_tick);
  std::stable_sort(song.texts.begin(), song.texts.end(), by_tick);
}

}  // namespace

Error midi_error(ErrorCode code, std::string message, std::string_view source, std::size_t offset) {
  Error error = fail(code, std::move(message));
  error.source = source;
  error.offset = static_cast<long long>(offset);
  return error;
}

void add_warning(Song& song, std::size_t offset, std::string message) {
  if (song.warnings.size() < kMaxWarnings) {
    song.warnings.push_back({offset, std::move(message)});
  } else {
    ++song.warnings_left_out;
  }
}

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[at++]);
  return value;
}

Result<Song> parse_midi(std::span<const std::byte> bytes, std::string_view source_name) {
  if (bytes.size() > kMaxMidiFileBytes) {
    return midi_error(ErrorCode::file_too_large,
                      std::to_string(bytes.size()) + " bytes; at most " +
                          std::to_string(kMaxMidiFileBytes) + " are read",
                      source_name, 0);
  }
  Song song;
  const auto extent = find_midi(bytes, source_name, song);
  if (!extent) return extent.error();
  // An event takes at least two bytes. Reserving that many costs address space, not memory, and
  // spares the copies of a growing vector.
  song.events.reserve(std::min(bytes.size() / 2, kMaxMidiEvents));
  const auto done = SongReader(bytes.first(extent->end), source_name, song).read(extent->begin);
  if (!done) return done.error();
  sort_song(song);
  return song;
}

Result<Song> read_midi_file(const std::string& path) {
  const auto text = base::read_file(path, kMaxMidiFileBytes);
  if (!text) return text.error();
  return parse_midi(std::as_bytes(std::span(*text)), path);
}

}  // namespace knotwave::io

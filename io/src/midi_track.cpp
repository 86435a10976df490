// SPDX-License-Identifier: MIT
// One MTrk chunk: delta times, running status, channel messages and system exclusive. Meta events
// are in midi_meta.cpp.
#include "midi_track.h"

#include <algorithm>
#include <array>

#include "midi_meta.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kMaxNumberBytes = 4;

/// Data bytes of a channel message, by status nibble 8..E.
constexpr std::array<std::size_t, 7> kDataBytes = {2, 2, 2, 2, 1, 1, 2};

/// Data bytes of the system messages F1..FE a file should not hold; F0, F7 and FF are its own.
constexpr std::size_t system_data_bytes(std::uint8_t status) {
  return status == 0xF2 ? 2 : status == 0xF1 || status == 0xF3 ? 1 : 0;
}

std::string hex(unsigned byte) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  return {'0', 'x', kDigits[byte >> 4 & 15], kDigits[byte & 15]};
}

class TrackReader {
 public:
  TrackReader(const TrackInput& input, Song& song)
      : in_(input), song_(song), at_(input.begin), tick_(input.start_tick) {}

  Result<TrackEnd> read() {
    Step step = Step::next;
    while (step == Step::next) step = event();
    if (step == Step::fail) return std::move(error_);
    close_sysex();
    return TrackEnd{at_, tick_, has_end_, ports_};
  }

 private:
  enum class Step { next, stop, fail };

  std::uint8_t byte(std::size_t at) const { return std::to_integer<std::uint8_t>(in_.bytes[at]); }
  std::size_t left() const { return in_.limit - at_; }

  /// The track ends before its time: what was read stays.
  Step cut(std::size_t offset, const std::string& what) {
    add_warning(song_, offset,
                what + ", the rest of track " + std::to_string(in_.track) + " is not read");
    at_ = in_.limit;
    return Step::stop;
  }
  Step fail_at(std::size_t offset, ErrorCode code, std::string message) {
    error_ = midi_error(code, std::move(message), in_.source_name, offset);
    return Step::fail;
  }

  Step event();
  Step number(std::uint32_t& value, std::string_view what);
  Step block(std::string_view what, std::span<const std::byte>& content);
  Step channel_message(std::uint8_t status);
  Step system_message(std::uint8_t status);
  Step meta();
  Step sysex(std::uint8_t status);
  Step push(const SongEvent& event);
  void close_sysex();
  void append_sysex(std::span<const std::byte> content);

  const TrackInput& in_;
  Song& song_;
  std::size_t at_;
  std::uint64_t tick_;
  std::uint8_t running_status_ = 0;  ///< 0: none yet
  bool interrupted_ = false;         ///< a meta or system event came after running_status_
  bool told_interrupted_ = false;
  bool has_end_ = false;
  std::uint64_t ports_ = 0;
  bool sysex_open_ = false;  ///< packets have come, F7 has not
  std::size_t sysex_begin_ = 0;
  std::uint64_t sysex_tick_ = 0;
  Error error_;
};

/// A variable-length number: 7 bits a byte, the last one below 0x80.
TrackReader::Step TrackReader::number(std::uint32_t& value, std::string_view what) {
  const std::size_t begin = at_;
  value = 0;
  while (left() > 0) {
    const std::uint8_t b = byte(at_++);
    value = value << 7 | (b & 0x7Fu);
    if (b < 0x80) return Step::next;
    if (at_ - begin == kMaxNumberBytes) {
      return fail_at(
          begin, ErrorCode::malformed,
          std::string(what) + " of track " + std::to_string(in_.track) + " has more than 4 bytes");
    }
  }
  return cut(begin, std::string(what) + " is cut off");
}

/// A length and that many bytes.
TrackReader::Step TrackReader::block(std::string_view what, std::span<const std::byte>& content) {
  const std::size_t begin = at_;
  std::uint32_t size = 0;
  if (const Step step = number(size, what); step != Step::next) return step;
  if (size > left()) {
    return cut(begin, std::string(what) + " of " + std::to_string(size) + " bytes where " +
                          std::to_string(left()) + " are left");
  }
  content = in_.bytes.subspan(at_, size);
  at_ += size;
  return Step::next;
}

TrackReader::Step TrackReader::event() {
  if (left() == 0) {
    add_warning(song_, at_, "track " + std::to_string(in_.track) + " has no End of Track");
    return Step::stop;
  }
  std::uint32_t delta = 0;
  if (const Step step = number(delta, "a delta time"); step != Step::next) return step;
  tick_ += delta;
  if (left() == 0) return cut(at_, "an event is cut off");
  const std::uint8_t first = byte(at_);
  if (first < 0x80 && running_status_ == 0) {
    return cut(at_, "data byte " + hex(first) + " comes before any status");
  }
  if (first < 0xF0) return channel_message(first);
  ++at_;
  interrupted_ = true;
  if (first == 0xFF) return meta();
  if (first == 0xF0 || first == 0xF7) return sysex(first);
  return system_message(first);
}

TrackReader::Step TrackReader::channel_message(std::uint8_t status) {
  const std::size_t begin = at_;
  if (status >= 0x80) {
    ++at_;
    running_status_ = status;
    interrupted_ = false;
  } else if (interrupted_ && !told_interrupted_) {
    told_interrupted_ = true;
    add_warning(song_, at_,
                "running status of track " + std::to_string(in_.track) +
                    " goes on after a meta or system event, which should end it");
  }
  const std::size_t count = kDataBytes[(running_status_ >> 4) - 8u];
  if (left() < count) return cut(begin, "a channel message is cut off");
  close_sysex();
  SongEvent event;
  event.tick = tick_;
  event.track = in_.track;
  event.bytes[0] = running_status_;
  bool is_valid = true;
  for (std::size_t i = 0; i < count; ++i) {
    event.bytes[i + 1] = byte(at_ + i);
    is_valid = is_valid && event.bytes[i + 1] < 0x80;
  }
  at_ += count;
  if (is_valid) return push(event);
  add_warning(song_, begin,
              "message " + hex(running_status_) + " with a data byte above 0x7F is left out");
  return Step::next;
}

TrackReader::Step TrackReader::system_message(std::uint8_t status) {
  add_warning(song_, at_ - 1, "system message " + hex(status) + " is left out");
  at_ += std::min(system_data_bytes(status), left());
  return Step::next;
}

TrackReader::Step TrackReader::meta() {
  const std::size_t begin = at_ - 1;
  if (left() == 0) return cut(begin, "a meta event is cut off");
  MetaEvent event{.tick = tick_, .track = in_.track, .offset = begin, .type = byte(at_++)};
  if (const Step step = block("a meta event", event.content); step != Step::next) return step;
  if (event.type == kMetaEndOfTrack) {
    has_end_ = true;
    if (!event.content.empty()) add_warning(song_, begin, "End of Track is not empty");
    return Step::stop;
  }
  if (event.type == kMetaPort && event.content.size() == 1) {
    const unsigned port = std::to_integer<unsigned>(event.content[0]);
    ports_ |= std::uint64_t{1} << std::min(port, 63u);
  }
  take_meta(event, song_);
  return Step::next;
}

/// F0 begins a message, F7 goes on with it; the message is whole with the F7 in its data. An F7
/// packet with no message open is an escape (real-time bytes and the like): nothing of ours.
TrackReader::Step TrackReader::sysex(std::uint8_t status) {
  const std::size_t begin = at_ - 1;
  std::span<const std::byte> content;
  if (status == 0xF0) close_sysex();
  if (const Step step = block("system exclusive", content); step != Step::next) return step;
  if (status == 0xF7 && !sysex_open_) return Step::next;
  if (status == 0xF0) {
    if (content.empty()) {
      add_warning(song_, begin, "system exclusive of no bytes is left out");
      return Step::next;
    }
    sysex_open_ = true;
    sysex_begin_ = song_.sysex_bytes.size();
  }
  sysex_tick_ = tick_;
  if (content.empty() || content.back() != std::byte{0xF7}) {
    append_sysex(content);
    return Step::next;
  }
  append_sysex(content.first(content.size() - 1));
  sysex_open_ = false;
  SongEvent event;
  event.tick = tick_;
  event.track = in_.track;
  event.bytes[0] = 0xF0;
  event.sysex_begin = static_cast<std::uint32_t>(sysex_begin_);
  event.sysex_size = static_cast<std::uint32_t>(song_.sysex_bytes.size() - sysex_begin_);
  return push(event);
}

void TrackReader::append_sysex(std::span<const std::byte> content) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(content.data());
  song_.sysex_bytes.insert(song_.sysex_bytes.end(), bytes, bytes + content.size());
}

/// A message whose F7 never came: other synths would wait for it, so it is not played.
void TrackReader::close_sysex() {
  if (!sysex_open_) return;
  sysex_open_ = false;
  song_.sysex_bytes.resize(sysex_begin_);
  add_warning(song_, at_,
              "system exclusive at tick " + std::to_string(sysex_tick_) +
                  " has no end (F7) and is left out");
}

TrackReader::Step TrackReader::push(const SongEvent& event) {
  if (song_.events.size() >= kMaxMidiEvents) {
    return fail_at(at_, ErrorCode::file_too_large,
                   "more than " + std::to_string(kMaxMidiEvents) + " events");
  }
  song_.events.push_back(event);
  return Step::next;
}

}  // namespace

Result<TrackEnd> read_track(const TrackInput& input, Song& song) {
  return TrackReader(input, song).read();
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
#include "sent_files.h"

#include <algorithm>

#include "knotwave/base/document.h"

namespace knotwave::env {
namespace {

using base::MidiStatus;

/// What the columns of a table hold.
struct Fields {
  std::string kind, channel, number, value;
};

Fields fields_of(const SentMessage& message, const SentNames& names) {
  const auto text = [](int number) { return std::to_string(number); };
  if (message.port < 0) {
    const auto patch = static_cast<std::size_t>(message.patch);
    const auto output = static_cast<std::size_t>(message.output);
    return {"osc", "", names.addresses[patch][output], base::number_text(message.number)};
  }
  const int status = message.bytes[0], one = message.bytes[1], two = message.bytes[2];
  const std::string channel = text((status & 15) + 1);
  switch (static_cast<MidiStatus>(status & 0xF0)) {
    case MidiStatus::note_off:
      return {"note off", channel, text(one), text(two)};
    case MidiStatus::note_on:
      return {"note on", channel, text(one), text(two)};
    case MidiStatus::poly_pressure:
      return {"poly pressure", channel, text(one), text(two)};
    case MidiStatus::control_change:
      return {"control", channel, text(one), text(two)};
    case MidiStatus::program_change:
      return {"program", channel, "", text(one)};
    case MidiStatus::channel_pressure:
      return {"pressure", channel, "", text(one)};
    case MidiStatus::pitch_bend:
      return {"bend", channel, "", text((two << 7 | one) - 8192)};
    default:
      return {status == 0xF0 ? "exclusive" : "system", "", "", ""};
  }
}

std::string hex_of(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text;
  for (const std::uint8_t byte : bytes) text += {kDigits[byte >> 4], kDigits[byte & 15]};
  return text;
}

/// RFC 4180: a field with a comma, a quote or a new line stands in quotes.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string port_name(const SentMessage& message, const SentNames& names) {
  return message.port < 0 ? "osc" : names.ports[static_cast<std::size_t>(message.port)];
}

io::SongEvent song_event(const SentMessage& message, io::Song& song) {
  io::SongEvent event;
  // Half a sample and more is nearer to the next tick.
  event.tick = static_cast<std::uint64_t>(std::max<std::int64_t>(message.time.sample, 0)) +
               (message.time.fraction >> 31);
  event.track = static_cast<std::uint16_t>(message.port + 1);
  std::copy_n(message.bytes, 3, event.bytes);
  if (message.bytes[0] == 0xF0) {
    event.sysex_begin = static_cast<std::uint32_t>(song.sysex_bytes.size());
    event.sysex_size = static_cast<std::uint32_t>(message.sysex.size());
    song.sysex_bytes.insert(song.sysex_bytes.end(), message.sysex.begin(), message.sysex.end());
  }
  return event;
}

}  // namespace

io::Song song_of(std::span<const SentMessage> messages, const SentNames& names, std::int64_t end,
                 std::size_t& left_out) {
  io::Song song;
  song.track_count = static_cast<int>(names.ports.size()) + 1;
  song.time_base.ticks_per_quarter = kClockHz / 2;
  song.tempos.push_back({0, 500'000});
  for (std::size_t i = 0; i < names.ports.size(); ++i) {
    song.texts.push_back({0, static_cast<std::uint16_t>(i + 1), 3, names.ports[i]});
  }
  left_out = 0;
  for (const SentMessage& message : messages) {
    const bool has_place = message.port >= 0 && message.bytes[0] <= 0xF0 &&
                           (message.bytes[0] != 0xF0 || !message.sysex.empty());
    if (has_place) {
      song.events.push_back(song_event(message, song));
    } else {
      ++left_out;
    }
  }
  std::stable_sort(song.events.begin(), song.events.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  song.length_ticks = static_cast<std::uint64_t>(std::max<std::int64_t>(end, 0));
  if (!song.events.empty()) {
    song.length_ticks = std::max(song.length_ticks, song.events.back().tick);
  }
  return song;
}

std::string csv_of(std::span<const SentMessage> messages, const SentNames& names) {
  std::string text = "time_s,port,message,channel,number,value,hex\n";
  for (const SentMessage& message : messages) {
    const Fields fields = fields_of(message, names);
    text += seconds_text(message.time, kClockHz) + "," + quoted(port_name(message, names)) + "," +
            fields.kind + "," + fields.channel + "," + fields.number + "," + fields.value + "," +
            hex_of(message.wire()) + "\n";
  }
  return text;
}

std::string message_text(const SentMessage& message, const SentNames& names) {
  const Fields fields = fields_of(message, names);
  if (message.port < 0) return fields.number + " " + fields.value;
  if (message.bytes[0] >= 0xF0) return fields.kind + " " + hex_of(message.wire());
  const bool is_control = fields.kind == "control";
  return (is_control ? "CC" : fields.kind) + (fields.number.empty() ? "" : " " + fields.number) +
         (is_control ? " = " : " ") + fields.value + " ch " + fields.channel;
}

}  // namespace knotwave::env

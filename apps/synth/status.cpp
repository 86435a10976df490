// SPDX-License-Identifier: MIT
#include "status.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "command_line/json.h"

namespace knotwave::synth {
namespace {

using command_line::json_string;

constexpr std::array<const char*, 12> kNoteNames = {"C",  "C#", "D",  "D#", "E",  "F",
                                                    "F#", "G",  "G#", "A",  "A#", "B"};

std::string note_words(int key) {
  return std::string(kNoteNames[static_cast<std::size_t>(key % 12)]) +
         std::to_string(key / 12 - 1) + " (" + std::to_string(key) + ")";
}

/// In the fewest digits that say it to six places; null for what JSON has no number for.
std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 40> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), end.ptr};
}

/// Builds an object field by field.
class JsonObject {
 public:
  JsonObject& raw(const char* key, const std::string& value) {
    text_ += (text_.size() == 1 ? "\"" : ", \"") + std::string(key) + "\": " + value;
    return *this;
  }
  JsonObject& text(const char* key, const std::string& value) {
    return raw(key, json_string(value));
  }
  JsonObject& number(const char* key, double value) { return raw(key, json_number(value)); }
  JsonObject& count(const char* key, std::int64_t value) { return raw(key, std::to_string(value)); }
  JsonObject& truth(const char* key, bool value) { return raw(key, value ? "true" : "false"); }
  std::string done() const { return text_ + "}"; }

 private:
  std::string text_ = "{";
};

const char* state_word(const SynthStatus& status) {
  if (status.is_lost || status.stream.state == io::AudioStatus::State::lost) return "lost";
  return status.stream.state == io::AudioStatus::State::running ? "running" : "stopped";
}

std::string midi_json(const std::vector<io::MidiPortStatus>& ports) {
  std::string list = "[";
  for (const auto& port : ports) {
    list += (list.size() == 1 ? "" : ", ") + JsonObject()
                                                 .text("api", port.api)
                                                 .text("name", port.name)
                                                 .truth("open", port.is_open)
                                                 .count("messages", port.messages)
                                                 .count("faults", port.faults)
                                                 .done();
  }
  return list + "]";
}

}  // namespace

double dbfs(float peak) {
  return peak > 0 ? 20 * std::log10(static_cast<double>(peak))
                  : -std::numeric_limits<double>::infinity();
}

std::string midi_words(const std::uint8_t (&bytes)[3]) {
  const int first = bytes[1], second = bytes[2];
  std::string words;
  switch (bytes[0] >> 4) {
    case 0x8:
      words = "note off " + note_words(first);
      break;
    case 0x9:
      words = second == 0 ? "note off " + note_words(first)
                          : "note on " + note_words(first) + ", velocity " + std::to_string(second);
      break;
    case 0xA:
      words = "pressure of " + note_words(first) + ": " + std::to_string(second);
      break;
    case 0xB:
      words = "controller " + std::to_string(first) + ": " + std::to_string(second);
      break;
    case 0xC:
      words = "program " + std::to_string(first);
      break;
    case 0xD:
      words = "pressure " + std::to_string(first);
      break;
    case 0xE:
      words = "pitch bend " + std::to_string(first + 128 * second - 8192);
      break;
    case 0xF:
      return bytes[0] == 0xF0 ? "system exclusive" : "system message";
    default:
      return {};
  }
  return words + ", channel " + std::to_string((bytes[0] & 15) + 1);
}

std::string clock_text(double seconds) {
  const auto tenths = static_cast<long long>(std::floor(seconds * 10));
  const long long hours = tenths / 36000, minutes = tenths / 600 % 60;
  const auto two = [](long long number) {
    return (number < 10 ? "0" : "") + std::to_string(number);
  };
  const std::string in_minute = two(tenths / 10 % 60) + "." + std::to_string(tenths % 10);
  if (hours == 0) return std::to_string(minutes) + ":" + in_minute;
  return std::to_string(hours) + ":" + two(minutes) + ":" + in_minute;
}

std::string plain_line(const SynthStatus& status) {
  const auto& live = status.live;
  std::string line =
      std::string(state_word(status)) + ", " + status.patch + ", " +
      std::to_string(live.counters.voices_now) + " voices, " + std::to_string(live.messages) +
      " messages, xruns " + std::to_string(status.stream.xruns) + ", dropped " +
      std::to_string(live.messages_dropped) + ", late " + std::to_string(live.messages_late);
  if (!status.recording.empty()) line += ", recording " + status.recording;
  return line;
}

std::string json_line(const SynthStatus& status) {
  const auto& live = status.live;
  const auto& stream = status.stream;
  return JsonObject()
      .number("seconds", status.seconds)
      .text("patch", status.patch)
      .text("patch_name", status.patch_name)
      .text("state", state_word(status))
      .text("lost_reason", status.lost_reason)
      .text("api", status.format.api)
      .text("device", status.format.device)
      .number("rate_hz", status.format.rate_hz)
      .count("block_frames", status.format.block_frames)
      .number("latency_s", status.format.latency_s)
      .count("blocks", stream.blocks)
      .number("load", stream.load)
      .number("load_p99", stream.load_p99)
      .number("load_max", stream.load_max)
      .count("xruns", stream.xruns)
      .count("overruns", stream.overruns)
      .count("now", live.now)
      .count("voices", live.counters.voices_now)
      .count("voices_peak", live.counters.voices_peak)
      .count("voices_stolen", live.counters.voices_stolen)
      .count("notes", live.counters.notes)
      .count("notes_without_patch", live.counters.notes_without_patch)
      .count("messages", live.messages)
      .count("messages_dropped", live.messages_dropped)
      .count("messages_late", live.messages_late)
      .count("journal_dropped", live.journal_dropped)
      .count("tap_dropped_frames", live.tap_dropped_frames)
      .number("message_latency_frames", live.latency_frames)
      .number("peak_left_dbfs", dbfs(live.peak_left))
      .number("peak_right_dbfs", dbfs(live.peak_right))
      .text("last_midi", midi_words(live.last_midi))
      .raw("midi", midi_json(status.midi))
      .number("clock_bpm", status.clock_bpm)
      .number("clock_jitter_ms", status.clock_jitter_ms)
      .text("osc", status.osc)
      .count("osc_messages", status.osc_messages)
      .count("osc_faults", status.osc_faults)
      .text("song", status.song)
      .number("song_s", status.song_s)
      .number("song_length_s", status.song_length_s)
      .text("recording", status.recording)
      .number("recorded_s", status.recorded_s)
      .text("last_message", status.messages.empty() ? "" : status.messages.back())
      .done();
}

}  // namespace knotwave::synth

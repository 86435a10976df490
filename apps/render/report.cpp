// SPDX-License-Identifier: MIT
// Numbers go through to_chars only, so no locale can change them.
#include "report.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "knotwave/io/midi_file.h"

#include "command_line/json.h"

namespace knotwave::render {
namespace {

using command_line::json_string;

std::string json_number(double value, int decimals) {
  return std::isfinite(value) ? fixed(value, decimals) : "null";
}

/// An object being written, two blanks a level.
class JsonObject {
 public:
  explicit JsonObject(int level) : indent_(static_cast<std::size_t>(2 * level), ' ') {}
  void add(std::string_view key, const std::string& value) {
    text_ += (text_.empty() ? "" : ",\n") + indent_ + "  \"" + std::string(key) + "\": " + value;
  }
  std::string text() const { return "{\n" + text_ + "\n" + indent_ + "}"; }

 private:
  std::string indent_;
  std::string text_;
};

std::string json_list(const std::vector<std::string>& items) {
  if (items.empty()) return "[]";
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ",") + ("\n    " + item);
  return "[" + text + "\n  ]";
}

std::string json_stem(const StemReport& stem) {
  JsonObject object(2);
  object.add("path", json_string(stem.path));
  object.add("channel", std::to_string(stem.channel));
  object.add("peak_dbfs", json_number(stem.peak_dbfs, 2));
  object.add("sha256", json_string(stem.sha256));
  object.add("sha256_file", json_string(stem.sha256_file));
  return object.text();
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return value < 0 ? "-inf" : "inf";
  std::array<char, 400> text;
  const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), value,
                                         std::chars_format::fixed, decimals);
  return {text.data(), end};
}

std::string report_line(const RenderReport& r) {
  return io::printable(r.path, 4096) + ": " + fixed(r.seconds(), 3) + " s, " +
         std::to_string(r.rate_hz) + " Hz, " + std::to_string(r.channels) + " channels, peak " +
         fixed(r.peak_dbfs, 2) + " dBFS, rms " + fixed(r.rms_dbfs, 2) + " dBFS, seed " +
         std::to_string(r.seed) + ", sha256 " + r.sha256 + ", " + fixed(r.realtime_factor, 1) +
         " times real time" +
         (r.notes_without_patch > 0
              ? ", " + std::to_string(r.notes_without_patch) +
                    (r.notes_without_patch == 1 ? " note" : " notes") + " without a patch"
              : "");
}

std::string report_json(const RenderReport& r) {
  std::vector<std::string> warnings, stems;
  for (const auto& warning : r.warnings) warnings.push_back(json_string(warning));
  for (const auto& stem : r.stems) stems.push_back(json_stem(stem));
  JsonObject object(0);
  object.add("path", json_string(r.path));
  object.add("seconds", json_number(r.seconds(), 6));
  object.add("frames", std::to_string(r.frames));
  object.add("rate_hz", std::to_string(r.rate_hz));
  object.add("channels", std::to_string(r.channels));
  object.add("peak_dbfs", json_number(r.peak_dbfs, 2));
  object.add("rms_dbfs", json_number(r.rms_dbfs, 2));
  object.add("seed", std::to_string(r.seed));
  object.add("sha256", json_string(r.sha256));
  object.add("sha256_file", r.sha256_file.empty() ? "null" : json_string(r.sha256_file));
  object.add("realtime_factor", json_number(r.realtime_factor, 2));
  object.add("voices_peak", std::to_string(r.voices_peak));
  object.add("voices_stolen", std::to_string(r.voices_stolen));
  object.add("notes_without_patch", std::to_string(r.notes_without_patch));
  object.add("clipped_samples", std::to_string(r.clipped_samples));
  object.add("stems", json_list(stems));
  object.add("warnings", json_list(warnings));
  return object.text() + "\n";
}

}  // namespace knotwave::render

// SPDX-License-Identifier: MIT
#include "page.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "knotwave/curves/plot.h"
#include "knotwave/io/midi_file.h"

#include "keyboard.h"

namespace knotwave::synth {
namespace {

using Style = PageLine::Style;
constexpr int kLabelColumns = 8;
constexpr std::size_t kLevelColumns = 12;
constexpr int kMessagesShown = 4;
constexpr int kLeastCurveRows = 6, kMostCurveRows = 14;

std::string percent(double share) {
  return std::to_string(std::lround(std::clamp(share, 0.0, 99.0) * 100)) + " %";
}

std::string decimal(double value) {
  std::array<char, 40> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(),
                                 std::clamp(value, -1e9, 1e9), std::chars_format::fixed, 1);
  return {text.data(), end.ptr};
}

PageLine labelled(std::string label, const std::string& text, Style style = Style::plain) {
  label.resize(kLabelColumns, ' ');
  return {label + text, style};
}

PageLine title(const SynthStatus& status) {
  std::string text = status.patch;
  if (!status.patch_name.empty() && status.patch_name != status.patch) {
    text = status.patch_name + "  (" + status.patch + ")";
  }
  return labelled("patch", text, Style::title);
}

PageLine sound(const SynthStatus& status) {
  if (status.is_lost) return labelled("sound", "LOST: " + status.lost_reason, Style::alarm);
  const auto& format = status.format;
  std::string text = format.api + (format.device.empty() ? "" : ": " + format.device) + ", " +
                     std::to_string(std::lround(format.rate_hz)) + " Hz, " +
                     std::to_string(format.block_frames) + " frames";
  if (format.latency_s >= 0) text += ", latency " + decimal(1e3 * format.latency_s) + " ms";
  return labelled("sound", text);
}

PageLine midi(const SynthStatus& status) {
  std::string text;
  for (const auto& port : status.midi) {
    text += (text.empty() ? "" : ", ") + port.name + (port.is_open ? "" : " (gone)");
  }
  if (status.format.has_midi) text += (text.empty() ? "" : ", ") + std::string("its own JACK port");
  if (text.empty()) text = "no input";
  if (status.clock_bpm > 0) {
    text += "; clock " + decimal(status.clock_bpm) + " bpm, unsteady by " +
            decimal(status.clock_jitter_ms) + " ms";
  }
  if (!status.osc.empty()) {
    text += "; OSC at " + status.osc + ", " + std::to_string(status.osc_messages) + " messages";
  }
  return labelled("midi", text);
}

PageLine last(const SynthStatus& status) {
  const std::string words = midi_words(status.live.last_midi);
  return labelled("last", words.empty() ? "nothing was played yet" : words, Style::dim);
}

PageLine load(const SynthStatus& status) {
  const auto& stream = status.stream;
  const Style style = stream.load_p99 > 0.9
                          ? Style::alarm
                          : (stream.load_p99 > 0.6 ? Style::warning : Style::plain);
  return labelled("load",
                  "mean " + percent(stream.load) + "  p99 " + percent(stream.load_p99) + "  max " +
                      percent(stream.load_max) + "   xruns " + std::to_string(stream.xruns) +
                      "  overruns " + std::to_string(stream.overruns),
                  style);
}

PageLine voices(const SynthStatus& status) {
  const auto& live = status.live;
  const bool is_lossy = live.messages_dropped > 0;
  return labelled("voices",
                  std::to_string(live.counters.voices_now) + "  peak " +
                      std::to_string(live.counters.voices_peak) + "  stolen " +
                      std::to_string(live.counters.voices_stolen) + "   messages " +
                      std::to_string(live.messages) + "  dropped " +
                      std::to_string(live.messages_dropped) + "  late " +
                      std::to_string(live.messages_late),
                  is_lossy ? Style::warning : Style::plain);
}

PageLine level(const char* label, float peak, int columns) {
  const double level_dbfs = dbfs(peak);
  std::string number = std::isfinite(level_dbfs) ? decimal(level_dbfs) + " dBFS" : "silence";
  number.insert(0, number.size() < kLevelColumns ? kLevelColumns - number.size() : 0, ' ');
  const int bar = std::max(8, columns - kLabelColumns - static_cast<int>(kLevelColumns));
  return labelled(label, meter(level_dbfs, bar) + number, peak > 1 ? Style::alarm : Style::good);
}

std::size_t characters_in(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

/// The curve as `knotwave-curve plot` draws it, with a mark below where it is played.
void add_curve(std::vector<PageLine>& lines, const SynthStatus& status, int columns, int rows) {
  std::istringstream drawn(curves::plot_text(*status.envelope, columns, rows - 2));
  for (std::string line; std::getline(drawn, line);) {
    lines.push_back({line, Style::plain});
    const std::size_t corner = line.find("└");
    if (corner == std::string::npos) continue;
    const auto left = characters_in(line.substr(0, corner)) + 1;
    const double position = status.live.envelope_position;
    std::string mark;
    if (position >= 0) {
      const auto last = static_cast<double>(characters_in(line) - left) - 1;
      mark = std::string(left + static_cast<std::size_t>(std::lround(
                                    std::clamp(position, 0.0, 1.0) * std::max(0.0, last))),
                         ' ') +
             "▲";
    }
    lines.push_back({mark, Style::good});
  }
}

void add_footer(std::vector<PageLine>& lines, const SynthStatus& status) {
  const auto& told = status.messages;
  const std::size_t first = told.size() - std::min<std::size_t>(told.size(), kMessagesShown);
  for (std::size_t i = first; i < told.size(); ++i) lines.push_back({told[i], Style::warning});
  if (!status.has_keys) return;
  lines.push_back({"octave " + std::to_string(status.octave) +
                       "   ? help   space silence   tab next patch   r record   m learn   q quit",
                   Style::dim});
}

std::vector<PageLine> top(const SynthStatus& status, int columns) {
  std::vector<PageLine> lines = {title(status), sound(status), midi(status),
                                 last(status),  load(status),  voices(status)};
  lines.push_back(level("left", status.live.peak_left, columns));
  lines.push_back(level("right", status.live.peak_right, columns));
  if (!status.knobs_to_turn.empty()) {
    std::string text;
    for (const std::string& knob : status.knobs_to_turn) text += (text.empty() ? "" : ", ") + knob;
    lines.push_back(labelled("knobs", text, Style::warning));
  }
  if (!status.song.empty()) {
    lines.push_back(labelled("song", clock_text(status.song_s) + " of " +
                                         clock_text(status.song_length_s) + "  " + status.song));
  }
  if (!status.recording.empty()) {
    lines.push_back(
        labelled("REC", clock_text(status.recorded_s) + "  " + status.recording, Style::alarm));
  }
  return lines;
}

}  // namespace

std::string meter(double level_dbfs, int columns) {
  constexpr double kFloor = -60;
  const double share = std::clamp((level_dbfs - kFloor) / -kFloor, 0.0, 1.0);
  const auto full = static_cast<int>(std::lround(share * columns));
  std::string bar;
  for (int i = 0; i < columns; ++i) bar += i < full ? "█" : "·";
  return bar;
}

std::vector<PageLine> page(const SynthStatus& status, PageSize size) {
  std::vector<PageLine> lines = top(status, size.columns);
  std::vector<PageLine> footer;
  add_footer(footer, status);
  const int room = size.rows - static_cast<int>(lines.size() + footer.size()) - 1;
  if (status.is_help_shown) {
    lines.push_back({});
    for (const std::string& line : keyboard_help()) lines.push_back({line, Style::plain});
  } else if (status.envelope != nullptr && room >= kLeastCurveRows) {
    add_curve(lines, status, size.columns, std::min(room, kMostCurveRows));
  }
  lines.insert(lines.end(), footer.begin(), footer.end());
  if (lines.size() > static_cast<std::size_t>(size.rows)) {
    lines.resize(static_cast<std::size_t>(std::max(1, size.rows)));
  }
  const auto columns = static_cast<std::size_t>(std::max(2, size.columns));
  for (PageLine& line : lines) {
    const bool is_long = characters_in(line.text) > columns;
    line.text = io::printable(line.text, is_long ? columns - 1 : columns);  // and an ellipsis
  }
  return lines;
}

std::string terminal_text(const PageLine& line, bool has_colour) {
  if (!has_colour || line.style == Style::plain) return line.text;
  const char* code = "";
  switch (line.style) {
    case Style::plain:
      break;
    case Style::title:
      code = "1";
      break;
    case Style::dim:
      code = "2";
      break;
    case Style::good:
      code = "32";
      break;
    case Style::warning:
      code = "33";
      break;
    case Style::alarm:
      code = "1;31";
      break;
  }
  return "\x1b[" + std::string(code) + "m" + line.text + "\x1b[0m";
}

}  // namespace knotwave::synth

// SPDX-License-Identifier: MIT
// parameter_page: docs/plugin-parameters.md from the plugins' own tables, on standard output.
// parameter_page picture: docs/pictures/plugins.svg, what goes in and out of each.
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/plugins/plugin_list.h"

namespace {

using namespace knotwave::plugins;

std::string ports(std::span<const AudioPort> all) {
  std::string text;
  for (const AudioPort& port : all) {
    text += (text.empty() ? "" : ", ") + std::string(port.name);
    text += port.is_voltage      ? " (control voltage, LV2)"
            : port.channels == 2 ? " (stereo)"
                                 : " (mono)";
  }
  return text.empty() ? "none" : text;
}

std::string range(const Parameter& parameter) {
  if (!parameter.choices.empty()) {
    std::string words;
    for (const std::string& choice : parameter.choices)
      words += (words.empty() ? "" : ", ") + choice;
    return words;
  }
  return parameter_text(parameter, parameter.low) + " to " +
         parameter_text(parameter, parameter.high);
}

std::string section(const PluginInfo& info) {
  std::string text =
      "\n## " + std::string(info.name) + "\n\n" + std::string(info.description) + ".\n\n";
  text += "- Key `" + std::string(info.key) + "`: CLAP `org.knotwave." + std::string(info.key) +
          "`, LV2 `urn:knotwave:" + std::string(info.key) + "`\n";
  text += "- In: " + ports(info.inputs) + (info.takes_midi ? ", MIDI" : "") + "\n";
  text += "- Out: " + ports(info.outputs) + (info.gives_midi ? ", MIDI" : "") + "\n";
  std::string presets;
  for (const std::string& preset : info.presets) presets += (presets.empty() ? "" : ", ") + preset;
  text += "- Presets: " + presets + "\n\n";
  text += "| parameter | group | range | at first | word |\n|---|---|---|---|---|\n";
  for (const Parameter& parameter : info.parameters->all()) {
    text += "| " + parameter.name + " | " + parameter.group + " | " + range(parameter) + " | " +
            parameter_text(parameter, parameter.initial) + " | `" + parameter.word + "` |\n";
  }
  return text;
}

// The picture: a box for each plugin, cables in on the left and out on the right.

constexpr int kWidth = 760, kBoxLeft = 260, kBoxWidth = 240, kLine = 22, kMargin = 24;
constexpr std::string_view kAudio = "#1b6ca8", kVoltage = "#b3541e", kMidi = "#3c7a3c";

struct Cable {
  std::string name;
  std::string_view colour;
};
std::vector<Cable> cables(std::span<const AudioPort> ports, bool has_midi) {
  std::vector<Cable> all;
  for (const AudioPort& port : ports) {
    all.push_back({std::string(port.name), port.is_voltage ? kVoltage : kAudio});
  }
  if (has_midi) all.push_back({"MIDI", kMidi});
  return all;
}

std::string text_at(int x, int y, std::string_view anchor, int size, std::string_view text) {
  return "<text x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" text-anchor=\"" +
         std::string(anchor) + "\" font-size=\"" + std::to_string(size) + "\">" +
         std::string(text) + "</text>\n";
}

std::string side(const std::vector<Cable>& all, int top, bool is_input) {
  std::string drawn;
  const int from = is_input ? kBoxLeft - 60 : kBoxLeft + kBoxWidth;
  int y = top + kLine;
  for (const Cable& cable : all) {
    drawn += "<line x1=\"" + std::to_string(from) + "\" y1=\"" + std::to_string(y) + "\" x2=\"" +
             std::to_string(from + 60) + "\" y2=\"" + std::to_string(y) + "\" stroke=\"" +
             std::string(cable.colour) + "\" stroke-width=\"3\"/>\n";
    drawn +=
        text_at(is_input ? from - 8 : from + 68, y + 5, is_input ? "end" : "start", 14, cable.name);
    y += kLine;
  }
  return drawn;
}

std::string picture() {
  std::string boxes;
  int top = kMargin;
  for (const PluginInfo* info : all_plugins()) {
    const auto in = cables(info->inputs, info->takes_midi);
    const auto out = cables(info->outputs, info->gives_midi);
    const int rows = static_cast<int>(std::max({in.size(), out.size(), std::size_t{2}}));
    const int height = (rows + 1) * kLine;
    boxes += "<rect x=\"" + std::to_string(kBoxLeft) + "\" y=\"" + std::to_string(top) +
             "\" width=\"" + std::to_string(kBoxWidth) + "\" height=\"" + std::to_string(height) +
             "\" rx=\"6\" fill=\"#f4f1ea\" stroke=\"#444\"/>\n";
    const int middle = kBoxLeft + kBoxWidth / 2;
    boxes += text_at(middle, top + height / 2, "middle", 16, info->name);
    boxes += text_at(middle, top + height / 2 + 20, "middle", 12,
                     std::to_string(info->parameters->size()) + " parameters, " +
                         std::to_string(info->presets.size()) + " presets");
    boxes += side(in, top, true) + side(out, top, false);
    top += height + kMargin;
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + std::to_string(kWidth) + " " +
         std::to_string(top) +
         "\" font-family=\"sans-serif\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"white\"/>\n" +
         boxes + "</svg>\n";
}

std::string page() {
  std::string text =
      "# Parameters of the plugins\n\n"
      "![What goes in and out: sound blue, control voltage brown, MIDI "
      "green](pictures/plugins.svg)\n\n"
      "Made of the tables the plugins are made of: `build/release/tools/parameter_page`. Words are "
      "those "
      "of states; symbols in LV2\n"
      "are the same with `_` for each `.`. [plugins.md](plugins.md) says what they do.\n";
  for (const PluginInfo* info : all_plugins()) text += section(*info);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  const bool is_picture = argc == 2 && std::string_view(argv[1]) == "picture";
  if (argc != 1 && !is_picture) {
    std::fputs("usage: parameter_page [picture]\n", stderr);
    return 2;
  }
  const std::string text = is_picture ? picture() : page();
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
}

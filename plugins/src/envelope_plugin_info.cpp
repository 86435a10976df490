// SPDX-License-Identifier: MIT
// What hosts are told of Knotwave Envelope, and what they may automate.
#include <string>
#include <vector>

#include "knotwave/plugins/plugin_list.h"

#include "envelope_plugin.h"
#include "parameter_kinds.h"

namespace knotwave::plugins {
namespace {

constexpr int kEach = 8;  ///< depths, offsets, macros

std::vector<Parameter> all_parameters() {
  std::vector<Parameter> all = {
      number_parameter("time", "Envelope time", "Speed", "octaves", {-5, 5, 0}),
      number_parameter("rate", "LFO rate", "Speed", "octaves", {-5, 5, 0}),
      choice_parameter("gate_source", "Gate source", "Gate",
                       {"Patch", "Side chain", "Song", "Hand"}, 0),
      number_parameter("gate_velocity", "Gate velocity", "Gate", "", {1, 127, 100}),
      choice_parameter("gate", "Gate by hand", "Gate", {"Closed", "Open"}, 0),
      number_parameter("threshold", "Side chain threshold", "Side chain", "dB", {-80, 0, -24}),
      number_parameter("hysteresis", "Side chain hysteresis", "Side chain", "dB", {0, 40, 6}),
      number_parameter("hold", "Side chain hold", "Side chain", "ms", {0, 2000, 30}),
  };
  const auto add = [&all](const std::string& word, const std::string& name, Range range) {
    for (int i = 1; i <= kEach; ++i) {
      const std::string count = std::to_string(i);
      all.push_back(
          number_parameter(word + "." + count, name + " " + count, name + "s", "", range));
    }
  };
  add("depth", "Depth", {-2, 2, 1});
  add("offset", "Offset", {-1, 1, 0});
  add("macro", "Macro", {-1, 1, 0});
  return all;
}

constexpr AudioPort kInputs[] = {{.name = "Side chain"}};
constexpr AudioPort kOutputs[] = {{.name = "Through"},
                                  {.name = "CV 1", .channels = 1, .is_voltage = true},
                                  {.name = "CV 2", .channels = 1, .is_voltage = true},
                                  {.name = "CV 3", .channels = 1, .is_voltage = true},
                                  {.name = "CV 4", .channels = 1, .is_voltage = true},
                                  {.name = "CV 5", .channels = 1, .is_voltage = true},
                                  {.name = "CV 6", .channels = 1, .is_voltage = true},
                                  {.name = "CV 7", .channels = 1, .is_voltage = true},
                                  {.name = "CV 8", .channels = 1, .is_voltage = true}};
static_assert(std::size(kOutputs) == 1 + EnvelopePlugin::kVoltages);

/// Places in it stay for ever: new ones come at the end.
constexpr std::string_view kPresets[] = {"filter-swell",  "drum-duck",    "tempo-tremolo",
                                         "four-voltages", "mpe-pressure", "pitch-adsr"};

}  // namespace

const ParameterTable& EnvelopePlugin::table() {
  static const ParameterTable all(all_parameters());
  return all;
}

const PluginInfo& envelope_info() {
  static const std::vector<std::string> names(std::begin(kPresets), std::end(kPresets));
  static const PluginInfo info{
      .key = "envelope",
      .name = "Knotwave Envelope",
      .description =
          "Drawn curves as controllers, bends, pressures and control voltages, opened "
          "by keys, the song or a side chain",
      .inputs = kInputs,
      .outputs = kOutputs,
      .kind = PluginInfo::Kind::note_effect,
      .takes_midi = true,
      .gives_midi = true,
      .parameters = &EnvelopePlugin::table(),
      .presets = names,
      .create = []() -> std::unique_ptr<Plugin> { return std::make_unique<EnvelopePlugin>(); },
  };
  return info;
}

}  // namespace knotwave::plugins

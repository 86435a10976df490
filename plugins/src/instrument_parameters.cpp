// SPDX-License-Identifier: MIT
// A parameter of the instrument adds to a slot of every voice (engine/map_slots.h), beside what the
// patch and its maps say; at its initial value it adds nothing, so a plugin nobody touched sounds
// as knotwave-render.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/engine/target_words.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/instrument.h"
#include "knotwave/plugins/plugin_list.h"

namespace knotwave::plugins {
namespace {

/// What slots whose word ends so have in common.
struct Kind {
  std::string_view ending;  ///< of the word
  std::string_view unit;
  double low, high;
};
constexpr Kind kKinds[] = {
    {"amp", "dB", -60, 12},
    {"level", "dB", -60, 12},
    {"drive", "dB", -24, 24},
    {"gain", "", -1, 1},
    {"pitch", "semitones", -48, 48},
    {"cutoff", "semitones", -96, 96},
    {"pan", "", -1, 1},
    {"phase", "cycles", -1, 1},
    {"position", "", -1, 1},
    {"resonance", "", -1, 1},
    {"crossfade", "", -1, 1},
    {"rate", "octaves", -5, 5},
    {"time", "octaves", -5, 5},
    {"", "", -1, 1},  // free numbers and moved ones
};
/// The noise has neither.
constexpr std::string_view kOfNobody[] = {"noise.pitch", "noise.phase", "noise.position"};

const Kind& kind_of(std::string_view word) {
  return *std::find_if(std::begin(kKinds), std::end(kKinds),
                       [word](const Kind& kind) { return word.ends_with(kind.ending); });
}

std::string capital(std::string word) {
  if (!word.empty() && word[0] >= 'a' && word[0] <= 'z') {
    word[0] = static_cast<char>(word[0] - 'a' + 'A');
  }
  return word;
}

/// "oscillator.1.level": of "Oscillator 1", named "Oscillator 1 level".
void name(Parameter& parameter) {
  std::string text = parameter.word;
  if (text.starts_with("free.")) text = "macro." + text.substr(5);
  if (text.starts_with("moved.")) text = "moved number." + text.substr(6);
  const std::size_t last = text.rfind('.');
  parameter.group = last == std::string::npos ? "Voice" : text.substr(0, last);
  if (parameter.group == "macro" || parameter.group == "moved number") parameter.group += "s";
  for (std::string* words : {&text, &parameter.group}) {
    std::replace(words->begin(), words->end(), '.', ' ');
    *words = capital(std::move(*words));
  }
  parameter.name = text;
  for (std::string* words : {&parameter.name, &parameter.group}) {
    if (words->starts_with("Lfo")) words->replace(0, 3, "LFO");
  }
}

std::vector<Parameter> table_of_slots() {
  std::vector<Parameter> all;
  for (int slot = 0; slot < engine::kSlotCount; ++slot) {
    Parameter parameter;
    parameter.word = engine::slot_word(slot);
    if (std::count(std::begin(kOfNobody), std::end(kOfNobody), parameter.word) != 0) continue;
    name(parameter);
    const Kind& kind = kind_of(parameter.word);
    parameter.unit = kind.unit;
    parameter.low = kind.low;
    parameter.high = kind.high;
    parameter.slot = slot;
    all.push_back(std::move(parameter));
  }
  return all;
}

constexpr AudioPort kOutputs[] = {{.name = "Output"}};

}  // namespace

const ParameterTable& Instrument::table() {
  static const ParameterTable all(table_of_slots());
  return all;
}

const PluginInfo& instrument_info() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Preset& preset : factory_presets()) all.push_back(preset.name);
    return all;
  }();
  static const PluginInfo info{
      .key = "instrument",
      .name = "Knotwave",
      .description = "Curves played as waves, envelopes, LFOs and surfaces",
      .inputs = {},
      .outputs = kOutputs,
      .kind = PluginInfo::Kind::instrument,
      .takes_midi = true,
      .gives_midi = false,
      .parameters = &Instrument::table(),
      .presets = names,
      .create = []() -> std::unique_ptr<Plugin> { return std::make_unique<Instrument>(); },
  };
  return info;
}

}  // namespace knotwave::plugins

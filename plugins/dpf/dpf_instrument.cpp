// SPDX-License-Identifier: MIT
// The instrument under DPF, which makes LV2 and VST3 of it.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <DistrhoPlugin.hpp>

#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/instrument.h"
#include "knotwave/plugins/parameters.h"

START_NAMESPACE_DISTRHO

namespace {

namespace kw = knotwave::plugins;
using knotwave::engine::Event;

constexpr const char* kStateKey = "patch";

/// Groups in the order in which the table first names them.
std::vector<std::string> groups() {
  std::vector<std::string> names;
  for (const kw::Parameter& parameter : kw::parameters()) {
    if (std::find(names.begin(), names.end(), parameter.group) == names.end()) {
      names.push_back(parameter.group);
    }
  }
  return names;
}
std::uint32_t group_number(const std::string& name) {
  const std::vector<std::string> names = groups();
  return static_cast<std::uint32_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

Event event_of(const MidiEvent& midi) {
  Event event;
  event.midi.time.sample = midi.frame;
  const bool is_long = midi.size > MidiEvent::kDataSize;
  const std::uint8_t* bytes = is_long ? midi.dataExt : midi.data;
  if (bytes[0] == 0xF0) {
    const bool is_ended = bytes[midi.size - 1] == 0xF7;
    event.midi.bytes[0] = 0xF0;
    event.midi.sysex = bytes + 1;
    event.midi.sysex_size = midi.size - 1 - (is_ended ? 1 : 0);
  } else {
    std::copy_n(bytes, std::min<std::uint32_t>(midi.size, 3), event.midi.bytes);
  }
  return event;
}

kw::Transport transport_of(const TimePosition& position) {
  kw::Transport transport;
  const TimePosition::BarBeatTick& bbt = position.bbt;
  if (!bbt.valid || !(bbt.ticksPerBeat > 0) || !(bbt.beatType > 0)) return transport;
  transport.beats_per_minute = bbt.beatsPerMinute;
  transport.is_playing = position.playing;
  transport.has_position = true;
  const double beats = (bbt.barStartTick + bbt.tick) / bbt.ticksPerBeat + bbt.beat - 1;
  transport.quarters = beats * 4 / static_cast<double>(bbt.beatType);
  return transport;
}

class DpfInstrument : public Plugin {
 public:
  DpfInstrument()
      : Plugin(static_cast<std::uint32_t>(kw::parameters().size()),
               static_cast<std::uint32_t>(kw::factory_presets().size()), 1) {}

 protected:
  const char* getLabel() const override { return "knotwave"; }
  const char* getDescription() const override {
    return "Curves played as waves, envelopes, LFOs and surfaces";
  }
  const char* getMaker() const override { return "Knotwave"; }
  const char* getHomePage() const override { return "urn:knotwave"; }
  const char* getLicense() const override { return "MIT"; }
  std::uint32_t getVersion() const override {
    return d_version(KNOTWAVE_VERSION_MAJOR, KNOTWAVE_VERSION_MINOR, KNOTWAVE_VERSION_PATCH);
  }
  std::int64_t getUniqueId() const override { return d_cconst('K', 'n', 'w', 'v'); }

  void initAudioPort(bool is_input, std::uint32_t index, AudioPort& port) override {
    port.groupId = kPortGroupStereo;
    Plugin::initAudioPort(is_input, index, port);
  }
  void initParameter(std::uint32_t index, Parameter& out) override {
    const kw::Parameter& parameter = kw::parameters()[index];
    out.hints = kParameterIsAutomatable;
    out.name = parameter.name.c_str();
    out.symbol = parameter.symbol.c_str();
    out.unit = std::string(parameter.unit).c_str();
    out.ranges.min = static_cast<float>(parameter.low);
    out.ranges.max = static_cast<float>(parameter.high);
    out.ranges.def = static_cast<float>(parameter.initial);
    out.groupId = group_number(parameter.group);
  }
  void initPortGroup(std::uint32_t group, PortGroup& out) override {
    const std::vector<std::string> names = groups();
    if (group >= names.size()) return Plugin::initPortGroup(group, out);
    std::string symbol = names[group];
    std::replace(symbol.begin(), symbol.end(), ' ', '_');
    out.name = names[group].c_str();
    out.symbol = symbol.c_str();
  }
  void initProgramName(std::uint32_t index, String& name) override {
    name = kw::factory_presets()[index].name.c_str();
  }
  void initState(std::uint32_t, State& state) override {
    state.hints = kStateIsOnlyForDSP;
    state.key = kStateKey;
    state.label = "Patch";
    state.defaultValue = "";
  }

  float getParameterValue(std::uint32_t index) const override {
    return static_cast<float>(instrument_.parameter(index));
  }
  void setParameterValue(std::uint32_t index, float value) override {
    instrument_.set_parameter(index, static_cast<double>(value));
  }
  void loadProgram(std::uint32_t index) override { (void)instrument_.load_preset(index); }
  String getState(const char* key) const override {
    return std::strcmp(key, kStateKey) == 0 ? String(instrument_.state().c_str()) : String();
  }
  void setState(const char* key, const char* value) override {
    if (std::strcmp(key, kStateKey) != 0 || value[0] == '\0') return;
    if (const auto loaded = instrument_.load_state(value); !loaded) {
      d_stderr2("Knotwave: %s", loaded.error().message.c_str());
    }
  }

  void activate() override {
    if (const auto active = instrument_.activate(getSampleRate()); !active) {
      d_stderr2("Knotwave: %s", active.error().message.c_str());
    }
  }
  void deactivate() override { instrument_.deactivate(); }

  void run(const float**, float** outputs, std::uint32_t frames, const MidiEvent* midi,
           std::uint32_t count) override {
    if (!instrument_.is_active()) {  // of a rate that is refused
      for (int i = 0; i < 2; ++i) std::fill_n(outputs[i], frames, 0.0F);
      return;
    }
    instrument_.begin({outputs[0], frames}, {outputs[1], frames});
    instrument_.add_transport(transport_of(getTimePosition()), 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (midi[i].size > 0) instrument_.add(event_of(midi[i]));
    }
    instrument_.render();
  }

 private:
  kw::Instrument instrument_;

  DISTRHO_DECLARE_NON_COPYABLE_WITH_LEAK_DETECTOR(DpfInstrument)
};

}  // namespace

Plugin* createPlugin() { return new DpfInstrument; }

END_NAMESPACE_DISTRHO

// SPDX-License-Identifier: MIT
// A plugin under DPF, which makes LV2 and VST3 of it: the one that DistrhoPluginInfo.h names.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <DistrhoPlugin.hpp>

#include "knotwave/plugins/plugin_list.h"

#include "dpf_beyond.h"
#include "lv2_song.h"

START_NAMESPACE_DISTRHO

namespace {

namespace kw = knotwave::plugins;
using knotwave::engine::Event;

constexpr const char* kStateKey = "patch";

constexpr std::size_t kInputs = DISTRHO_PLUGIN_NUM_INPUTS, kOutputs = DISTRHO_PLUGIN_NUM_OUTPUTS;

const kw::PluginInfo& info() { return kw::KNOTWAVE_PLUGIN_INFO(); }

/// Groups in the order in which the table first names them.
std::vector<std::string> groups() {
  std::vector<std::string> names;
  for (const kw::Parameter& parameter : info().parameters->all()) {
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

/// A port of one channel of ours, as DPF counts them.
struct Channel {
  const kw::AudioPort* port = nullptr;
  std::size_t port_number = 0;
  int channel = 0;
};
Channel channel_of(std::span<const kw::AudioPort> ports, std::size_t index) {
  for (std::size_t number = 0; number < ports.size(); ++number) {
    const auto channels = static_cast<std::size_t>(ports[number].channels);
    if (index < channels) return {&ports[number], number, static_cast<int>(index)};
    index -= channels;
  }
  return {};
}

std::size_t channels_of(std::span<const kw::AudioPort> ports) {
  std::size_t count = 0;
  for (const kw::AudioPort& port : ports) count += static_cast<std::size_t>(port.channels);
  return count;
}

/// Control voltages are ports in LV2 only.
std::size_t channels_shown(std::span<const kw::AudioPort> ports) {
  std::size_t count = 0;
  for (const kw::AudioPort& port : ports) {
#ifndef DISTRHO_PLUGIN_TARGET_LV2
    if (port.is_voltage) continue;
#endif
    count += static_cast<std::size_t>(port.channels);
  }
  return count;
}

#if DISTRHO_PLUGIN_WANT_MIDI_INPUT
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
#endif

#if DISTRHO_PLUGIN_WANT_MIDI_OUTPUT
MidiEvent midi_of(const knotwave::base::MidiEvent& given) {
  const std::uint8_t status = given.bytes[0];
  const bool is_short = (status & 0xE0) == 0xC0;
  MidiEvent midi{};
  midi.frame = static_cast<std::uint32_t>(std::max<std::int64_t>(given.time.sample, 0));
  midi.size = status >= 0xF8 ? 1 : is_short ? 2 : 3;
  std::copy_n(given.bytes, 3, midi.data);
  return midi;
}
#endif

double value_of(std::uint32_t index, double normalized) KNOTWAVE_RT {
  const kw::Parameter& parameter = (*info().parameters)[index];
  const double range = parameter.high - parameter.low;
  const double part = std::clamp(normalized, 0.0, 1.0);
  // A host that keeps floats still gives back the initial value itself.
  const bool is_initial =
      static_cast<float>(part) == static_cast<float>((parameter.initial - parameter.low) / range);
  return is_initial ? parameter.initial : held(parameter, parameter.low + part * range);
}

/// What happens in a block, in order of time and, at one sample, in the order it was told.
struct Happening {
  enum class Kind { transport, point, midi };
  std::int64_t sample = 0;
  std::uint32_t order = 0;
  std::uint32_t index = 0;  ///< of the transport, the parameter, the MIDI event
  Kind kind = Kind::point;
  double value = 0;
  bool operator<(const Happening& other) const {
    return sample != other.sample ? sample < other.sample : order < other.order;
  }
};

class DpfPlugin : public Plugin, public kw::DpfBeyond {
 public:
  DpfPlugin()
      : Plugin(static_cast<std::uint32_t>(info().parameters->size()),
               static_cast<std::uint32_t>(info().presets.size()), 1),
        inside_(info().create()),
        label_("knotwave-" + std::string(info().key)),
        description_(info().description),
        happenings_(kMostHappenings) {}

  // What DPF has no word for.

  float add_point(std::uint32_t index, double normalized,
                  std::int64_t sample) KNOTWAVE_RT override {
    const double value = value_of(index, normalized);
    happens(Happening::Kind::point, sample, index, value);
    return static_cast<float>(value);
  }
  void flush_points() KNOTWAVE_RT override {
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Happening& one = happenings_[i];
      if (one.kind == Happening::Kind::point) inside_->set_parameter(one.index, one.value);
    }
    count_ = transport_count_ = 0;
  }
  void add_transport(const kw::Transport& transport, std::int64_t sample) KNOTWAVE_RT override {
    if (transport_count_ == transports_.size()) return;
    transports_[transport_count_] = transport;
    happens(Happening::Kind::transport, sample, transport_count_++);
  }
  void hear_song(const kw::BarsAndBeats& told, std::int64_t sample) KNOTWAVE_RT override {
    add_transport(song_.hear(told, sample), sample);
  }
  std::int64_t tail() const KNOTWAVE_RT override { return inside_->tail_samples(); }
  std::string save() const override { return inside_->state(); }
  bool load(const std::string& text) override {
    const auto loaded = inside_->load_state(text);
    if (!loaded) d_stderr2("Knotwave: %s", loaded.error().message.c_str());
    return loaded.has_value();
  }
  std::string text(std::uint32_t index, double normalized) const override {
    const kw::Parameter& parameter = (*info().parameters)[index];
    return parameter_text(parameter, parameter.low + normalized * (parameter.high - parameter.low));
  }
  double normalized(std::uint32_t index, const std::string& text) const override {
    const kw::Parameter& parameter = (*info().parameters)[index];
    const auto value = parameter_value(parameter, text);
    if (!value) return std::numeric_limits<double>::quiet_NaN();
    return std::clamp((held(parameter, *value) - parameter.low) / (parameter.high - parameter.low),
                      0.0, 1.0);
  }

 protected:
  const char* getLabel() const override { return label_.c_str(); }
  const char* getDescription() const override { return description_.c_str(); }
  const char* getMaker() const override { return "Knotwave"; }
  const char* getHomePage() const override { return "urn:knotwave"; }
  const char* getLicense() const override { return "MIT"; }
  std::uint32_t getVersion() const override {
    return d_version(KNOTWAVE_VERSION_MAJOR, KNOTWAVE_VERSION_MINOR, KNOTWAVE_VERSION_PATCH);
  }
  /// VST3 makes its class id of it: of the key's first four letters, the instrument's apart.
  std::int64_t getUniqueId() const override {
    const std::string_view key = info().key == "instrument" ? "Knwv" : info().key;
    const auto letter = [&](std::size_t place) { return static_cast<std::uint8_t>(key[place]); };
    return d_cconst(letter(0), letter(1), letter(2), letter(3));
  }

  /// The main ports have the symbols that DPF gives them ("lv2_audio_in_1"): hosts keep them.
  void initAudioPort(bool is_input, std::uint32_t index, AudioPort& out) override {
    Plugin::initAudioPort(is_input, index, out);
    const Channel channel = channel_of(is_input ? info().inputs : info().outputs, index);
    if (channel.port == nullptr) return;
    std::string name(channel.port->name);
    if (channel.port->channels > 1) name += channel.channel == 0 ? " left" : " right";
    out.name = name.c_str();
    if (channel.port_number == 0 && channel.port->channels == 2) out.groupId = kPortGroupStereo;
    if (channel.port_number == 0) return;
    for (char& letter : name) {
      letter = letter == ' '                    ? '_'
               : letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32)
                                                : letter;
    }
    out.symbol = name.c_str();
    if (channel.port->is_voltage) {  // -1 to 1; what DPF calls scaled would be in volts
      out.hints = kAudioPortIsCV | kCVPortHasBipolarRange;
    } else if (is_input) {
      out.hints = kAudioPortIsSidechain;
    }
  }
  void initParameter(std::uint32_t index, Parameter& out) override {
    const kw::Parameter& parameter = (*info().parameters)[index];
    out.hints = kParameterIsAutomatable;
    if (!parameter.choices.empty()) {
      const std::size_t count = parameter.choices.size();
      out.hints |= kParameterIsInteger;
      out.enumValues.count = static_cast<std::uint8_t>(count);
      out.enumValues.restrictedMode = true;
      out.enumValues.values = new ParameterEnumerationValue[count];
      for (std::size_t i = 0; i < count; ++i) {
        out.enumValues.values[i].label = parameter.choices[i].c_str();
        out.enumValues.values[i].value = static_cast<float>(i);
      }
    }
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
    name = info().presets[index].c_str();
  }
  void initState(std::uint32_t, State& state) override {
    state.hints = kStateIsOnlyForDSP;
    state.key = kStateKey;
    state.label = "Patch";
    state.defaultValue = "";
  }

  float getParameterValue(std::uint32_t index) const override {
    return static_cast<float>(inside_->parameter(index));
  }
  void setParameterValue(std::uint32_t index, float value) override {
    inside_->set_parameter(index, static_cast<double>(value));
  }
  void loadProgram(std::uint32_t index) override { (void)inside_->load_preset(index); }
  String getState(const char* key) const override {
    return std::strcmp(key, kStateKey) == 0 ? String(inside_->state().c_str()) : String();
  }
  void setState(const char* key, const char* value) override {
    if (std::strcmp(key, kStateKey) != 0 || value[0] == '\0') return;
    if (const auto loaded = inside_->load_state(value); !loaded) {
      d_stderr2("Knotwave: %s", loaded.error().message.c_str());
    }
  }

  void activate() override {
    song_.reset(getSampleRate());
    if (const auto active = inside_->activate(getSampleRate()); !active) {
      d_stderr2("Knotwave: %s", active.error().message.c_str());
    }
  }
  void deactivate() override { inside_->deactivate(); }

#if DISTRHO_PLUGIN_WANT_MIDI_INPUT
  void run(const float** inputs, float** outputs, std::uint32_t frames, const MidiEvent* midi,
           std::uint32_t count) override {
#else
  void run(const float** inputs, float** outputs, std::uint32_t frames) override {
#endif
    if (!inside_->is_active()) {  // of a rate that is refused
      flush_points();
      for (std::size_t i = 0; i < kOutputs; ++i) std::fill_n(outputs[i], frames, 0.0F);
      return;
    }
#if DISTRHO_PLUGIN_WANT_MIDI_INPUT
    for (std::uint32_t i = 0; i < count; ++i) {
      if (midi[i].size > 0) happens(Happening::Kind::midi, midi[i].frame, i);
    }
#endif
    const auto end = happenings_.begin() + static_cast<std::ptrdiff_t>(count_);
    std::sort(happenings_.begin(), end);
    std::array<const float*, kw::Block::kMostChannels> in{};  // what is not shown stays null
    std::array<float*, kw::Block::kMostChannels> out{};
    std::copy_n(inputs, kInputs, in.begin());
    std::copy_n(outputs, kOutputs, out.begin());
    inside_->begin({{in.data(), channels_of(info().inputs)},
                    {out.data(), channels_of(info().outputs)},
                    frames});
    if (song_.is_known()) inside_->add_transport(song_.begin(), 0);
    for (auto it = happenings_.begin(); it != end; ++it) {
      // A host's error: the block has no such sample.
      const std::int64_t sample = std::clamp<std::int64_t>(it->sample, 0, frames - 1);
      if (it->kind == Happening::Kind::transport) {
        inside_->add_transport(transports_[it->index], sample);
      } else if (it->kind == Happening::Kind::point) {
        inside_->add_parameter(it->index, it->value, sample);
#if DISTRHO_PLUGIN_WANT_MIDI_INPUT
      } else {
        Event event = event_of(midi[it->index]);
        event.midi.time.sample = sample;
        inside_->add(event);
#endif
      }
    }
    count_ = transport_count_ = 0;
    inside_->render();
    song_.end_block(frames);
#if DISTRHO_PLUGIN_WANT_MIDI_OUTPUT
    for (const knotwave::base::MidiEvent& given : inside_->midi_out()) {
      if (given.sysex == nullptr && !writeMidiEvent(midi_of(given))) break;
    }
#endif
  }

 private:
  void happens(Happening::Kind kind, std::int64_t sample, std::uint32_t index,
               double value = 0) KNOTWAVE_RT {
    if (count_ == happenings_.size()) return;
    happenings_[count_] = {sample, count_, index, kind, value};
    ++count_;
  }

  std::unique_ptr<kw::Plugin> inside_;
  std::string label_, description_;

  // The audio thread.
  static constexpr std::size_t kMostHappenings = 8192;  ///< of a block; DPF gives 4096 of MIDI
  std::vector<Happening> happenings_;
  std::uint32_t count_ = 0;
  std::array<kw::Transport, 256> transports_{};
  std::uint32_t transport_count_ = 0;
  kw::Lv2Song song_;

  DISTRHO_DECLARE_NON_COPYABLE_WITH_LEAK_DETECTOR(DpfPlugin)
};

}  // namespace

/// None where DistrhoPluginInfo.h says other things than PluginInfo.
Plugin* createPlugin() {
  if (channels_shown(info().inputs) != kInputs || channels_shown(info().outputs) != kOutputs ||
      info().takes_midi != (DISTRHO_PLUGIN_WANT_MIDI_INPUT != 0) ||
      info().gives_midi != (DISTRHO_PLUGIN_WANT_MIDI_OUTPUT != 0) ||
      info().name != DISTRHO_PLUGIN_NAME) {
    d_stderr2("Knotwave: the ports of %s are not those it was built with", DISTRHO_PLUGIN_NAME);
    return nullptr;
  }
  return new DpfPlugin;
}

END_NAMESPACE_DISTRHO

namespace knotwave::plugins {

DpfBeyond& dpf_beyond(void* plugin) {
  return *static_cast<DISTRHO_NAMESPACE::DpfPlugin*>(
      static_cast<DISTRHO_NAMESPACE::Plugin*>(plugin));
}

std::string turtle_text(const char* text) {
  std::string escaped;
  for (; *text != '\0'; ++text) {
    if (*text == '\\' || *text == '"') escaped += '\\';
    escaped += *text;
  }
  return escaped;
}

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
#include "clap_instrument.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <string>

#include <clap/ext/audio-ports.h>
#include <clap/ext/latency.h>
#include <clap/ext/note-ports.h>
#include <clap/ext/params.h>
#include <clap/ext/state.h>

#include "knotwave/plugins/instrument.h"
#include "knotwave/plugins/parameters.h"

#include "clap_events.h"

namespace knotwave::plugins {
namespace {

/// A state is a patch or bank and its curves: the GM bank is 0.25 MB.
constexpr std::size_t kMostStateBytes = 64 << 20;

struct ClapInstrument {
  explicit ClapInstrument(const clap_host* of_host);
  clap_plugin plugin{};
  const clap_host* host;
  Instrument instrument;
};

Instrument& instrument_of(const clap_plugin* plugin) {
  return static_cast<ClapInstrument*>(plugin->plugin_data)->instrument;
}

template <std::size_t n>
void put(char (&out)[n], std::string_view text) {
  const std::size_t size = std::min(text.size(), n - 1);
  std::copy_n(text.data(), size, out);
  out[size] = '\0';
}

// Ports.

std::uint32_t audio_port_count(const clap_plugin*, bool is_input) { return is_input ? 0 : 1; }
bool audio_port(const clap_plugin*, std::uint32_t index, bool is_input,
                clap_audio_port_info* info) {
  if (is_input || index != 0) return false;
  *info = {};
  put(info->name, "Output");
  info->flags = CLAP_AUDIO_PORT_IS_MAIN;
  info->channel_count = 2;
  info->port_type = CLAP_PORT_STEREO;
  info->in_place_pair = CLAP_INVALID_ID;
  return true;
}
constexpr clap_plugin_audio_ports kAudioPorts{audio_port_count, audio_port};

std::uint32_t note_port_count(const clap_plugin*, bool is_input) { return is_input ? 1 : 0; }
bool note_port(const clap_plugin*, std::uint32_t index, bool is_input, clap_note_port_info* info) {
  if (!is_input || index != 0) return false;
  *info = {};
  info->supported_dialects =
      CLAP_NOTE_DIALECT_CLAP | CLAP_NOTE_DIALECT_MIDI | CLAP_NOTE_DIALECT_MIDI_MPE;
  info->preferred_dialect = CLAP_NOTE_DIALECT_MIDI;
  put(info->name, "Notes");
  return true;
}
constexpr clap_plugin_note_ports kNotePorts{note_port_count, note_port};

std::uint32_t latency(const clap_plugin*) { return 0; }
constexpr clap_plugin_latency kLatency{latency};

// Parameters.

std::uint32_t parameter_count(const clap_plugin*) {
  return static_cast<std::uint32_t>(parameters().size());
}
bool parameter_info(const clap_plugin*, std::uint32_t index, clap_param_info* info) {
  if (index >= parameters().size()) return false;
  const Parameter& parameter = parameters()[index];
  *info = {};
  info->id = parameter.id;
  info->flags = CLAP_PARAM_IS_AUTOMATABLE;
  put(info->name, parameter.name);
  put(info->module, parameter.group);
  info->min_value = parameter.low;
  info->max_value = parameter.high;
  info->default_value = parameter.initial;
  return true;
}
bool parameter_number(const clap_plugin* plugin, clap_id id, double* value) {
  const std::size_t place = parameter_of_id(id);
  if (place >= parameters().size()) return false;
  *value = instrument_of(plugin).parameter(place);
  return true;
}
bool text_of_value(const clap_plugin*, clap_id id, double value, char* out, std::uint32_t size) {
  const std::size_t place = parameter_of_id(id);
  if (place >= parameters().size() || size == 0) return false;
  const std::string text = parameter_text(parameters()[place], value);
  const std::size_t count = std::min<std::size_t>(text.size(), size - 1);
  std::copy_n(text.data(), count, out);
  out[count] = '\0';
  return true;
}
bool value_of_text(const clap_plugin*, clap_id id, const char* text, double* value) {
  const std::size_t place = parameter_of_id(id);
  if (place >= parameters().size() || text == nullptr) return false;
  const auto read = parameter_value(parameters()[place], text);
  if (read) *value = *read;
  return static_cast<bool>(read);
}
void flush(const clap_plugin* plugin, const clap_input_events* in, const clap_output_events*) {
  set_clap_parameters(instrument_of(plugin), *in);
}
constexpr clap_plugin_params kParameters{parameter_count, parameter_info, parameter_number,
                                         text_of_value,   value_of_text,  flush};

// State.

bool save(const clap_plugin* plugin, const clap_ostream* stream) {
  const std::string text = instrument_of(plugin).state();
  for (std::size_t done = 0; done < text.size();) {
    const std::int64_t n = stream->write(stream, text.data() + done, text.size() - done);
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}
bool load(const clap_plugin* plugin, const clap_istream* stream) {
  std::string text;
  char part[4096];
  for (;;) {
    const std::int64_t n = stream->read(stream, part, sizeof part);
    if (n < 0 || text.size() > kMostStateBytes) return false;
    if (n == 0) break;
    text.append(part, static_cast<std::size_t>(n));
  }
  if (!instrument_of(plugin).load_state(text)) return false;
  const clap_host* host = static_cast<ClapInstrument*>(plugin->plugin_data)->host;
  const auto* rescan =
      static_cast<const clap_host_params*>(host->get_extension(host, CLAP_EXT_PARAMS));
  if (rescan != nullptr) rescan->rescan(host, CLAP_PARAM_RESCAN_VALUES);
  return true;
}
constexpr clap_plugin_state kState{save, load};

const void* extension(const clap_plugin*, const char* id) {
  if (std::strcmp(id, CLAP_EXT_AUDIO_PORTS) == 0) return &kAudioPorts;
  if (std::strcmp(id, CLAP_EXT_NOTE_PORTS) == 0) return &kNotePorts;
  if (std::strcmp(id, CLAP_EXT_PARAMS) == 0) return &kParameters;
  if (std::strcmp(id, CLAP_EXT_STATE) == 0) return &kState;
  if (std::strcmp(id, CLAP_EXT_LATENCY) == 0) return &kLatency;
  return nullptr;
}

// Life.

void destroy(const clap_plugin* plugin) {
  delete static_cast<ClapInstrument*>(plugin->plugin_data);
}
bool activate(const clap_plugin* plugin, double rate_hz, std::uint32_t, std::uint32_t) {
  return static_cast<bool>(instrument_of(plugin).activate(rate_hz));
}
void deactivate(const clap_plugin* plugin) { instrument_of(plugin).deactivate(); }

clap_process_status process(const clap_plugin* plugin, const clap_process* block) KNOTWAVE_RT {
  Instrument& instrument = instrument_of(plugin);
  if (block->audio_outputs_count != 1 || block->audio_outputs[0].channel_count != 2 ||
      block->audio_outputs[0].data32 == nullptr) {
    return CLAP_PROCESS_ERROR;
  }
  float* const* out = block->audio_outputs[0].data32;
  instrument.begin({out[0], block->frames_count}, {out[1], block->frames_count});
  if (block->transport != nullptr) add_clap_transport(instrument, *block->transport, 0);
  const std::uint32_t count = block->in_events->size(block->in_events);
  for (std::uint32_t i = 0; i < count; ++i) {
    const clap_event_header* header = block->in_events->get(block->in_events, i);
    if (header != nullptr) add_clap_event(instrument, *header);
  }
  instrument.render();
  block->audio_outputs[0].constant_mask = 0;
  return instrument.is_idle() ? CLAP_PROCESS_SLEEP : CLAP_PROCESS_CONTINUE;
}

ClapInstrument::ClapInstrument(const clap_host* of_host) : host(of_host) {
  plugin.desc = &kClapInstrument;
  plugin.plugin_data = this;
  plugin.init = [](const clap_plugin*) { return true; };
  plugin.destroy = destroy;
  plugin.activate = activate;
  plugin.deactivate = deactivate;
  plugin.start_processing = [](const clap_plugin*) { return true; };
  plugin.stop_processing = [](const clap_plugin*) {};
  plugin.reset = [](const clap_plugin* of) { instrument_of(of).reset(); };
  plugin.process = process;
  plugin.get_extension = extension;
  plugin.on_main_thread = [](const clap_plugin* of) { instrument_of(of).collect(); };
}

constexpr const char* kFeatures[] = {CLAP_PLUGIN_FEATURE_INSTRUMENT,
                                     CLAP_PLUGIN_FEATURE_SYNTHESIZER, CLAP_PLUGIN_FEATURE_STEREO,
                                     nullptr};

}  // namespace

const clap_plugin_descriptor kClapInstrument = {
    .clap_version = CLAP_VERSION,
    .id = "org.knotwave.instrument",
    .name = "Knotwave",
    .vendor = "Knotwave",
    .url = "",
    .manual_url = "",
    .support_url = "",
    .version = KNOTWAVE_VERSION,
    .description = "Curves played as waves, envelopes, LFOs and surfaces",
    .features = const_cast<const char**>(kFeatures),
};

const clap_plugin* create_clap_instrument(const clap_host* host) {
  auto* made = new (std::nothrow) ClapInstrument(host);
  return made == nullptr ? nullptr : &made->plugin;
}

}  // namespace knotwave::plugins

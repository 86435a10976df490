// SPDX-License-Identifier: MIT
// Audio and note ports of a CLAP plugin. CLAP has no ports for control voltages.
#include <algorithm>
#include <string_view>

#include <clap/ext/audio-ports.h>
#include <clap/ext/note-ports.h>

#include "clap_plugin.h"
#include "clap_text.h"

namespace knotwave::plugins {
namespace {

std::span<const AudioPort> shown(const clap_plugin* plugin, bool is_input) {
  const PluginInfo& info = plugin_of(plugin).info();
  const std::span<const AudioPort> all = is_input ? info.inputs : info.outputs;
  const auto voltage = std::ranges::find_if(all, &AudioPort::is_voltage);
  return all.first(static_cast<std::size_t>(voltage - all.begin()));
}

std::uint32_t audio_port_count(const clap_plugin* plugin, bool is_input) {
  return static_cast<std::uint32_t>(shown(plugin, is_input).size());
}
bool audio_port(const clap_plugin* plugin, std::uint32_t index, bool is_input,
                clap_audio_port_info* info) {
  const auto ports = shown(plugin, is_input);
  if (index >= ports.size()) return false;
  const auto others = shown(plugin, !is_input);
  *info = {};
  info->id = index;
  put(info->name, ports[index].name);
  info->flags = index == 0 ? CLAP_AUDIO_PORT_IS_MAIN : 0;
  info->channel_count = static_cast<std::uint32_t>(ports[index].channels);
  info->port_type = ports[index].channels == 2 ? CLAP_PORT_STEREO : CLAP_PORT_MONO;
  const bool is_paired = index == 0 && !others.empty() && others[0].channels == ports[0].channels;
  info->in_place_pair = is_paired ? 0 : CLAP_INVALID_ID;
  return true;
}
constexpr clap_plugin_audio_ports kAudioPorts{audio_port_count, audio_port};

std::uint32_t note_port_count(const clap_plugin* plugin, bool is_input) {
  const PluginInfo& info = plugin_of(plugin).info();
  return (is_input ? info.takes_midi : info.gives_midi) ? 1 : 0;
}
bool note_port(const clap_plugin* plugin, std::uint32_t index, bool is_input,
               clap_note_port_info* info) {
  if (index >= note_port_count(plugin, is_input)) return false;
  *info = {};
  info->preferred_dialect = CLAP_NOTE_DIALECT_MIDI;
  info->supported_dialects = CLAP_NOTE_DIALECT_MIDI;
  if (is_input) info->supported_dialects |= CLAP_NOTE_DIALECT_CLAP | CLAP_NOTE_DIALECT_MIDI_MPE;
  put(info->name, is_input ? "Notes" : "MIDI");
  return true;
}
constexpr clap_plugin_note_ports kNotePorts{note_port_count, note_port};

}  // namespace

const void* const kClapAudioPorts = &kAudioPorts;
const void* const kClapNotePorts = &kNotePorts;

}  // namespace knotwave::plugins

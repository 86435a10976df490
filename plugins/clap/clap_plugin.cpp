// SPDX-License-Identifier: MIT
#include "clap_plugin.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <clap/ext/audio-ports.h>
#include <clap/ext/latency.h>
#include <clap/ext/note-ports.h>
#include <clap/ext/params.h>
#include <clap/ext/state.h>

#include "knotwave/plugins/plugin_list.h"

#include "clap_events.h"
#include "clap_later.h"

namespace knotwave::plugins {
namespace {

/// A state is a patch or bank and its curves: the GM bank is 0.25 MB.
constexpr std::size_t kMostStateBytes = 64 << 20;

struct ClapPlugin {
  clap_plugin plugin{};
  const clap_host* host = nullptr;
  std::unique_ptr<Plugin> inside;
};

// State.

bool save(const clap_plugin* plugin, const clap_ostream* stream) {
  const std::string text = plugin_of(plugin).state();
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
  if (!plugin_of(plugin).load_state(text)) return false;
  tell_new_values(plugin);
  return true;
}
constexpr clap_plugin_state kState{save, load};

std::uint32_t latency(const clap_plugin*) { return 0; }
constexpr clap_plugin_latency kLatency{latency};

std::uint32_t tail(const clap_plugin* plugin) {
  const std::int64_t samples = plugin_of(plugin).tail_samples();
  const bool is_endless = samples == Plugin::kEndless || samples >= kClapEndlessTail;
  return is_endless ? kClapEndlessTail : static_cast<std::uint32_t>(samples);
}
constexpr ClapTail kTail{tail};

const void* extension(const clap_plugin* plugin, const char* id) {
  const PluginInfo& info = plugin_of(plugin).info();
  if (std::strcmp(id, CLAP_EXT_AUDIO_PORTS) == 0) return kClapAudioPorts;
  if (std::strcmp(id, CLAP_EXT_NOTE_PORTS) == 0) {
    return info.takes_midi || info.gives_midi ? kClapNotePorts : nullptr;
  }
  if (std::strcmp(id, CLAP_EXT_PARAMS) == 0) return kClapParameters;
  if (std::strcmp(id, CLAP_EXT_STATE) == 0) return &kState;
  if (std::strcmp(id, CLAP_EXT_LATENCY) == 0) return &kLatency;
  if (std::strcmp(id, kClapTail) == 0) return &kTail;
  for (const char* const load : kClapPresetLoad) {
    if (std::strcmp(id, load) == 0) return kClapLoadsPresets;
  }
  return nullptr;
}

// Life.

void destroy(const clap_plugin* plugin) { delete static_cast<ClapPlugin*>(plugin->plugin_data); }
bool activate(const clap_plugin* plugin, double rate_hz, std::uint32_t, std::uint32_t) {
  return static_cast<bool>(plugin_of(plugin).activate(rate_hz));
}

/// The channels of all ports of a block, one after the other; what CLAP does not show stays null.
template <class Channel>
bool gather(std::span<const AudioPort> ports, const clap_audio_buffer* buffers, std::uint32_t count,
            std::array<Channel*, Block::kMostChannels>& out, std::size_t& channels) KNOTWAVE_RT {
  std::uint32_t buffer = 0;
  for (const AudioPort& port : ports) {
    const auto n = static_cast<std::uint32_t>(port.channels);
    if (!port.is_voltage) {
      if (buffer == count || buffers[buffer].channel_count != n ||
          buffers[buffer].data32 == nullptr) {
        return false;
      }
      for (std::uint32_t i = 0; i < n; ++i) out[channels + i] = buffers[buffer].data32[i];
      ++buffer;
    }
    channels += n;
  }
  return buffer == count;
}

clap_process_status process(const clap_plugin* plugin, const clap_process* block) KNOTWAVE_RT {
  Plugin& inside = plugin_of(plugin);
  const PluginInfo& info = inside.info();
  if (!inside.is_active()) return CLAP_PROCESS_ERROR;
  std::array<const float*, Block::kMostChannels> in{};
  std::array<float*, Block::kMostChannels> out{};
  std::size_t ins = 0, outs = 0;
  if (!gather(info.inputs, block->audio_inputs, block->audio_inputs_count, in, ins) ||
      !gather(info.outputs, block->audio_outputs, block->audio_outputs_count, out, outs)) {
    return CLAP_PROCESS_ERROR;
  }
  inside.begin({{in.data(), ins}, {out.data(), outs}, block->frames_count});
  if (block->transport != nullptr) add_clap_transport(inside, *block->transport, 0);
  const std::uint32_t last = block->frames_count == 0 ? 0 : block->frames_count - 1;
  const auto give_ends = [&](std::uint32_t sample) {
    if (inside.ended_notes().empty()) return;
    if (block->out_events != nullptr) {
      give_clap_ends(inside.ended_notes(), std::min(sample, last), *block->out_events);
    }
    inside.forget_ended_notes();
  };
  const std::uint32_t count = block->in_events->size(block->in_events);
  for (std::uint32_t i = 0; i < count; ++i) {
    const clap_event_header* header = block->in_events->get(block->in_events, i);
    if (header == nullptr) continue;
    add_clap_event(inside, *header);
    give_ends(header->time);
  }
  inside.render();
  if (block->out_events != nullptr && info.gives_midi) {
    give_clap_events(inside.midi_out(), *block->out_events);
  }
  give_ends(last);
  for (std::uint32_t i = 0; i < block->audio_outputs_count; ++i) {
    block->audio_outputs[i].constant_mask = 0;
  }
  return inside.is_idle() && inside.may_sleep() ? CLAP_PROCESS_SLEEP : CLAP_PROCESS_CONTINUE;
}

// What hosts read before there is one.

std::span<const char* const> features_of(PluginInfo::Kind kind) {
  static constexpr const char* kInstrument[] = {CLAP_PLUGIN_FEATURE_INSTRUMENT,
                                                CLAP_PLUGIN_FEATURE_SYNTHESIZER,
                                                CLAP_PLUGIN_FEATURE_STEREO, nullptr};
  static constexpr const char* kDistortion[] = {CLAP_PLUGIN_FEATURE_AUDIO_EFFECT,
                                                CLAP_PLUGIN_FEATURE_DISTORTION,
                                                CLAP_PLUGIN_FEATURE_STEREO, nullptr};
  static constexpr const char* kMixer[] = {CLAP_PLUGIN_FEATURE_AUDIO_EFFECT,
                                           CLAP_PLUGIN_FEATURE_MIXING, CLAP_PLUGIN_FEATURE_STEREO,
                                           nullptr};
  static constexpr const char* kFilter[] = {CLAP_PLUGIN_FEATURE_AUDIO_EFFECT,
                                            CLAP_PLUGIN_FEATURE_FILTER, CLAP_PLUGIN_FEATURE_STEREO,
                                            nullptr};
  static constexpr const char* kNotes[] = {CLAP_PLUGIN_FEATURE_NOTE_EFFECT, nullptr};
  switch (kind) {
    case PluginInfo::Kind::distortion:
      return kDistortion;
    case PluginInfo::Kind::mixer:
      return kMixer;
    case PluginInfo::Kind::filter:
      return kFilter;
    case PluginInfo::Kind::note_effect:
      return kNotes;
    case PluginInfo::Kind::instrument:
      break;
  }
  return kInstrument;
}

struct Described {
  std::string id, name, description;
  clap_plugin_descriptor descriptor{};
};

std::vector<Described> described_plugins() {
  std::vector<Described> all;
  all.reserve(all_plugins().size());
  for (const PluginInfo* info : all_plugins()) {
    Described& one = all.emplace_back();
    one.id = "org.knotwave." + std::string(info->key);
    one.name = info->name;
    one.description = info->description;
    one.descriptor = {
        .clap_version = CLAP_VERSION,
        .id = one.id.c_str(),
        .name = one.name.c_str(),
        .vendor = "Knotwave",
        .url = "",
        .manual_url = "",
        .support_url = "",
        .version = KNOTWAVE_VERSION,
        .description = one.description.c_str(),
        .features = const_cast<const char**>(features_of(info->kind).data()),
    };
  }
  return all;
}

}  // namespace

Plugin& plugin_of(const clap_plugin* plugin) {
  return *static_cast<ClapPlugin*>(plugin->plugin_data)->inside;
}

const clap_host* host_of(const clap_plugin* plugin) {
  return static_cast<ClapPlugin*>(plugin->plugin_data)->host;
}

void tell_new_values(const clap_plugin* plugin) {
  const clap_host* host = host_of(plugin);
  const auto* rescan =
      static_cast<const clap_host_params*>(host->get_extension(host, CLAP_EXT_PARAMS));
  if (rescan != nullptr) rescan->rescan(host, CLAP_PARAM_RESCAN_VALUES);
}

const clap_plugin_descriptor& clap_descriptor(std::size_t number) {
  static const std::vector<Described> all = described_plugins();
  return all[number].descriptor;
}

const clap_plugin* create_clap_plugin(std::size_t number, const clap_host* host) {
  auto* made = new (std::nothrow) ClapPlugin;
  if (made == nullptr) return nullptr;
  made->host = host;
  made->inside = all_plugins()[number]->create();
  clap_plugin& plugin = made->plugin;
  plugin.desc = &clap_descriptor(number);
  plugin.plugin_data = made;
  plugin.init = [](const clap_plugin*) { return true; };
  plugin.destroy = destroy;
  plugin.activate = activate;
  plugin.deactivate = [](const clap_plugin* of) { plugin_of(of).deactivate(); };
  plugin.start_processing = [](const clap_plugin*) { return true; };
  plugin.stop_processing = [](const clap_plugin*) {};
  plugin.reset = [](const clap_plugin* of) { plugin_of(of).reset(); };
  plugin.process = process;
  plugin.get_extension = extension;
  plugin.on_main_thread = [](const clap_plugin* of) { plugin_of(of).collect(); };
  return &plugin;
}

}  // namespace knotwave::plugins

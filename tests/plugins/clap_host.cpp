// SPDX-License-Identifier: MIT
#include "clap_host.h"

#include <algorithm>
#include <cstring>

#include <dlfcn.h>
#include <gtest/gtest.h>

namespace knotwave::test {
namespace {

clap_event_header header(std::uint32_t sample, int type, std::size_t size) {
  return {static_cast<std::uint32_t>(size), sample, CLAP_CORE_EVENT_SPACE_ID,
          static_cast<std::uint16_t>(type), 0};
}

const void* host_extension(const clap_host*, const char* id) {
  static const clap_host_params params{[](const clap_host* host, clap_param_rescan_flags) {
                                         ++static_cast<HostCalls*>(host->host_data)->rescans;
                                       },
                                       [](const clap_host*, clap_id, clap_param_clear_flags) {},
                                       [](const clap_host*) {}};
  return std::strcmp(id, CLAP_EXT_PARAMS) == 0 ? &params : nullptr;
}

}  // namespace

ClapEvent clap_note(std::uint32_t sample, int type, int channel, int key, double velocity) {
  ClapEvent event{};
  event.note = {header(sample, type, sizeof(clap_event_note)),
                -1,
                0,
                static_cast<std::int16_t>(channel),
                static_cast<std::int16_t>(key),
                velocity};
  return event;
}

ClapEvent clap_numbered(std::uint32_t sample, int type, std::int32_t note, int channel, int key,
                        double velocity) {
  ClapEvent event = clap_note(sample, type, channel, key, velocity);
  event.note.note_id = note;
  return event;
}

ClapEvent clap_expression(std::uint32_t sample, int what, std::int32_t note, int channel, int key,
                          double value) {
  ClapEvent event{};
  event.expression = {
      header(sample, CLAP_EVENT_NOTE_EXPRESSION, sizeof(clap_event_note_expression)),
      what,
      note,
      -1,
      static_cast<std::int16_t>(channel),
      static_cast<std::int16_t>(key),
      value};
  return event;
}

ClapEvent clap_modulation(std::uint32_t sample, clap_id id, std::int32_t note, int channel, int key,
                          double amount) {
  ClapEvent event{};
  event.mod = {header(sample, CLAP_EVENT_PARAM_MOD, sizeof(clap_event_param_mod)),
               id,
               nullptr,
               note,
               -1,
               static_cast<std::int16_t>(channel),
               static_cast<std::int16_t>(key),
               amount};
  return event;
}

ClapEvent clap_value(std::uint32_t sample, clap_id id, double value) {
  ClapEvent event{};
  event.value = {header(sample, CLAP_EVENT_PARAM_VALUE, sizeof(clap_event_param_value)),
                 id,
                 nullptr,
                 -1,
                 -1,
                 -1,
                 -1,
                 value};
  return event;
}

ClapEvent clap_midi(std::uint32_t sample, int status, int one, int two) {
  ClapEvent event{};
  event.midi.header = header(sample, CLAP_EVENT_MIDI, sizeof(clap_event_midi));
  event.midi.data[0] = static_cast<std::uint8_t>(status);
  event.midi.data[1] = static_cast<std::uint8_t>(one);
  event.midi.data[2] = static_cast<std::uint8_t>(two);
  return event;
}

ClapPlugin::ClapPlugin(const clap_plugin_factory* factory, const char* id) {
  host_.clap_version = CLAP_VERSION;
  host_.host_data = &calls_;
  host_.name = "knotwave tests";
  host_.vendor = host_.url = "";
  host_.version = "1";
  host_.get_extension = host_extension;
  host_.request_restart = host_.request_process = host_.request_callback = [](const clap_host*) {};
  plugin_ = factory->create_plugin(factory, &host_, id);
  EXPECT_NE(plugin_, nullptr);
  EXPECT_TRUE(plugin_->init(plugin_));
}

ClapPlugin::~ClapPlugin() {
  stop();
  plugin_->destroy(plugin_);
}

bool ClapPlugin::start(double rate_hz, std::uint32_t max_frames) {
  stop();
  if (!plugin_->activate(plugin_, rate_hz, 1, max_frames)) return false;
  is_started_ = plugin_->start_processing(plugin_);
  return is_started_;
}

void ClapPlugin::stop() {
  if (!std::exchange(is_started_, false)) return;
  plugin_->stop_processing(plugin_);
  plugin_->deactivate(plugin_);
}

clap_process_status ClapPlugin::process(const std::vector<ClapEvent>& events, std::size_t frames,
                                        StereoSound& out, const clap_event_transport* transport) {
  Channels channels;
  const auto status =
      process(events, frames, Channels(this->channels(true), std::vector<float>(frames)), channels,
              transport);
  out.left = channels.at(0);
  out.right = channels.at(1);
  return status;
}

std::size_t ClapPlugin::channels(bool is_input) const {
  const auto* ports = extension<clap_plugin_audio_ports>(CLAP_EXT_AUDIO_PORTS);
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < ports->count(plugin_, is_input); ++i) {
    clap_audio_port_info info{};
    EXPECT_TRUE(ports->get(plugin_, i, is_input, &info));
    count += info.channel_count;
  }
  return count;
}

namespace {

/// The buffers of all ports on one side.
struct Buffers {
  std::vector<clap_audio_buffer> ports;
  std::vector<float*> channels;
};
Buffers buffers_of(const ClapPlugin& plugin, bool is_input, Channels& samples) {
  const auto* ports = plugin.extension<clap_plugin_audio_ports>(CLAP_EXT_AUDIO_PORTS);
  Buffers buffers;
  for (auto& channel : samples) buffers.channels.push_back(channel.data());
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < ports->count(plugin.get(), is_input); ++i) {
    clap_audio_port_info info{};
    EXPECT_TRUE(ports->get(plugin.get(), i, is_input, &info));
    clap_audio_buffer& buffer = buffers.ports.emplace_back();
    buffer.data32 = buffers.channels.data() + next;
    buffer.channel_count = info.channel_count;
    next += info.channel_count;
  }
  return buffers;
}
bool may_share(const ClapPlugin& plugin) {
  const auto* ports = plugin.extension<clap_plugin_audio_ports>(CLAP_EXT_AUDIO_PORTS);
  clap_audio_port_info info{};
  return ports->get(plugin.get(), 0, true, &info) && info.in_place_pair != CLAP_INVALID_ID;
}

}  // namespace

clap_process_status ClapPlugin::process(const std::vector<ClapEvent>& events, std::size_t frames,
                                        const Channels& in, Channels& out,
                                        const clap_event_transport* transport, bool in_place) {
  Channels heard = in;
  out.assign(channels(false), std::vector<float>(frames, 9));
  Buffers inputs = buffers_of(*this, true, heard), outputs = buffers_of(*this, false, out);
  if (in_place && may_share(*this)) {
    for (std::uint32_t i = 0; i < inputs.ports[0].channel_count; ++i) {
      out[i] = in[i];
      inputs.channels[i] = outputs.channels[i];
    }
  }
  using Events = std::vector<ClapEvent>;
  clap_input_events from{};
  from.ctx = const_cast<Events*>(&events);
  from.size = [](const clap_input_events* list) {
    return static_cast<std::uint32_t>(static_cast<Events*>(list->ctx)->size());
  };
  from.get = [](const clap_input_events* list, std::uint32_t i) -> const clap_event_header* {
    return &(*static_cast<Events*>(list->ctx))[i].header;
  };
  given_.clear();
  const clap_output_events to{
      &given_, [](const clap_output_events* list, const clap_event_header* event) {
        ClapEvent& kept = static_cast<Events*>(list->ctx)->emplace_back();
        std::memcpy(&kept, event, std::min<std::size_t>(event->size, sizeof kept));
        return true;
      }};
  clap_process block{};
  block.steady_time = -1;
  block.frames_count = static_cast<std::uint32_t>(frames);
  block.transport = transport;
  block.audio_inputs = inputs.ports.data();
  block.audio_inputs_count = static_cast<std::uint32_t>(inputs.ports.size());
  block.audio_outputs = outputs.ports.data();
  block.audio_outputs_count = static_cast<std::uint32_t>(outputs.ports.size());
  block.in_events = &from;
  block.out_events = &to;
  return plugin_->process(plugin_, &block);
}

StereoSound ClapPlugin::play(const std::vector<ClapEvent>& events, std::size_t frames,
                             std::size_t block) {
  StereoSound all, part;
  auto next = events.begin();
  for (std::size_t first = 0; first < frames; first += block) {
    const std::size_t n = std::min(block, frames - first);
    std::vector<ClapEvent> now;
    for (; next != events.end() && next->header.time < first + n; ++next) {
      now.push_back(*next);
      now.back().header.time -= static_cast<std::uint32_t>(first);
    }
    EXPECT_NE(process(now, n, part), CLAP_PROCESS_ERROR);
    all.left.insert(all.left.end(), part.left.begin(), part.left.end());
    all.right.insert(all.right.end(), part.right.begin(), part.right.end());
  }
  return all;
}

namespace {
struct Stream {
  std::string bytes;
  std::size_t at = 0, at_once = 0;
};
}  // namespace

std::string ClapPlugin::save(std::size_t bytes_at_once) const {
  const auto* state = extension<clap_plugin_state>(CLAP_EXT_STATE);
  Stream stream{{}, 0, bytes_at_once};
  clap_ostream out{&stream, [](const clap_ostream* to, const void* buffer, std::uint64_t size) {
                     auto& kept = *static_cast<Stream*>(to->ctx);
                     const std::size_t n = std::min<std::size_t>(size, kept.at_once);
                     kept.bytes.append(static_cast<const char*>(buffer), n);
                     return static_cast<std::int64_t>(n);
                   }};
  EXPECT_TRUE(state->save(plugin_, &out));
  return stream.bytes;
}

bool ClapPlugin::load(const std::string& bytes, std::size_t bytes_at_once) {
  const auto* state = extension<clap_plugin_state>(CLAP_EXT_STATE);
  Stream stream{bytes, 0, bytes_at_once};
  clap_istream in{&stream, [](const clap_istream* from, void* buffer, std::uint64_t size) {
                    auto& kept = *static_cast<Stream*>(from->ctx);
                    const std::size_t n = std::min({static_cast<std::size_t>(size), kept.at_once,
                                                    kept.bytes.size() - kept.at});
                    std::copy_n(kept.bytes.data() + kept.at, n, static_cast<char*>(buffer));
                    kept.at += n;
                    return static_cast<std::int64_t>(n);
                  }};
  return state->load(plugin_, &in);
}

ClapLibrary::ClapLibrary(const std::string& path) {
  library_ = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) ADD_FAILURE() << dlerror();
  entry_ = static_cast<const clap_plugin_entry*>(dlsym(library_, "clap_entry"));
  EXPECT_NE(entry_, nullptr);
  EXPECT_TRUE(entry_->init(path.c_str()));
  factory_ = static_cast<const clap_plugin_factory*>(entry_->get_factory(CLAP_PLUGIN_FACTORY_ID));
  EXPECT_NE(factory_, nullptr);
}

ClapLibrary::~ClapLibrary() {
  entry_->deinit();
  dlclose(library_);
}

}  // namespace knotwave::test

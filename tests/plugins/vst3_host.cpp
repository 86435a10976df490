// SPDX-License-Identifier: MIT
#include "vst3_host.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "vst3_objects.h"

namespace knotwave::test {
namespace {

void add_midi(const Vst3Plugin& plugin, const Story::Midi& midi, Events& events, Changes& changes) {
  const int status = midi.bytes[0] & 0xF0, channel = midi.bytes[0] & 0x0F;
  v3_event event{};
  event.sample_offset = static_cast<std::int32_t>(midi.sample);
  const auto key = static_cast<std::int16_t>(midi.bytes[1]);
  const float part = static_cast<float>(midi.bytes[2]) / 127.0F;
  if (status == 0x90) {
    event.type = V3_EVENT_NOTE_ON;
    event.note_on = {static_cast<std::int16_t>(channel), key, 0, part, 0, -1};
  } else if (status == 0x80) {
    event.type = V3_EVENT_NOTE_OFF;
    event.note_off = {static_cast<std::int16_t>(channel), key, part, -1, 0};
  } else if (status == 0xA0) {
    event.type = V3_EVENT_POLY_PRESSURE;
    event.poly_pressure = {static_cast<std::int16_t>(channel), key, part, -1};
  } else if (status == 0xB0) {
    changes.add(midi.sample, plugin.of_controller(channel, midi.bytes[1]), midi.bytes[2] / 127.0);
    return;
  } else if (status == 0xD0) {
    changes.add(midi.sample, plugin.of_controller(channel, 128), midi.bytes[1] / 127.0);
    return;
  } else {
    const int bend = midi.bytes[1] | midi.bytes[2] << 7;
    changes.add(midi.sample, plugin.of_controller(channel, 129), bend / 16383.0);
    return;
  }
  events.all.push_back(event);
}

/// The bytes that an event of the plugin stands for.
std::array<std::uint8_t, 3> bytes_of(const v3_event& event) {
  const auto bytes = [](int status, int channel, int one, int two) {
    return std::array{static_cast<std::uint8_t>(status | channel), static_cast<std::uint8_t>(one),
                      static_cast<std::uint8_t>(two)};
  };
  const auto part = [](float of) { return static_cast<int>(std::lround(of * 127)); };
  const auto& on = event.note_on;
  const auto& off = event.note_off;
  const auto& pressure = event.poly_pressure;
  const auto& cc = event.midi_cc_out;
  switch (event.type) {
    case V3_EVENT_NOTE_ON:
      EXPECT_EQ(on.note_id, -1) << "a number of its own would be a number to keep";
      return bytes(0x90, on.channel, on.pitch, part(on.velocity));
    case V3_EVENT_NOTE_OFF:
      EXPECT_EQ(off.note_id, -1);
      return bytes(0x80, off.channel, off.pitch, part(off.velocity));
    case V3_EVENT_POLY_PRESSURE:
      EXPECT_EQ(pressure.note_id, -1);
      return bytes(0xA0, pressure.channel, pressure.pitch, part(pressure.pressure));
    default:
      EXPECT_EQ(event.type, V3_EVENT_LEGACY_MIDI_CC_OUT);
      if (cc.cc_number == 128) return bytes(0xD0, cc.channel, cc.value, 0);
      if (cc.cc_number == 129) return bytes(0xE0, cc.channel, cc.value, cc.value2);
      return bytes(0xB0, cc.channel, cc.cc_number, cc.value);
  }
}

v3_process_context context_of(const Story::Song& told) {
  v3_process_context song{};
  const auto flag = [&](bool is_set, std::uint32_t bit) { song.state |= is_set ? bit : 0; };
  flag(told.transport.is_playing, V3_PROCESS_CTX_PLAYING);
  flag(told.transport.has_position, V3_PROCESS_CTX_PROJECT_TIME_VALID);
  flag(told.transport.beats_per_minute != 0, V3_PROCESS_CTX_TEMPO_VALID);
  flag(told.has_signature, V3_PROCESS_CTX_TIME_SIG_VALID);
  song.sample_rate = 48000;
  song.project_time_quarters = told.transport.quarters;
  song.bpm = told.transport.beats_per_minute;
  song.time_sig_numerator = told.beats_per_bar;
  song.time_sig_denom = told.beat_unit;
  return song;
}

}  // namespace

std::string Vst3Module::binary(const std::string& bundle) {
  std::string name = bundle.substr(bundle.rfind('/') + 1);
  name.resize(name.size() - std::strlen(".vst3"));
  return bundle + "/Contents/" KNOTWAVE_PROCESSOR "-linux/" + name + ".so";
}

Vst3Module::Vst3Module(const std::string& bundle) {
  library_ = dlopen(binary(bundle).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) {
    ADD_FAILURE() << dlerror();
    return;
  }
  const auto enter = reinterpret_cast<bool (*)(void*)>(dlsym(library_, "ModuleEntry"));
  const auto get = reinterpret_cast<v3_plugin_factory** (*)()>(dlsym(library_, "GetPluginFactory"));
  if (enter == nullptr || get == nullptr || !enter(library_)) {
    ADD_FAILURE() << bundle << " is no module of VST3";
    return;
  }
  factory_ = get();
}

Vst3Module::~Vst3Module() {
  if (library_ == nullptr) return;
  if (factory_ != nullptr) v3_cpp_obj_unref(factory_);
  const auto leave = reinterpret_cast<bool (*)()>(dlsym(library_, "ModuleExit"));
  if (leave != nullptr) leave();
  dlclose(library_);
}

std::vector<v3_class_info> Vst3Module::classes() const {
  std::vector<v3_class_info> all(
      static_cast<std::size_t>(v3_cpp_obj(factory_)->num_classes(factory_)));
  for (std::size_t i = 0; i < all.size(); ++i) {
    v3_cpp_obj(factory_)->get_class_info(factory_, static_cast<std::int32_t>(i), &all[i]);
  }
  return all;
}

Vst3Plugin::Vst3Plugin(const Vst3Module& module) {
  v3_plugin_factory** const factory = module.factory();
  const std::vector<v3_class_info> classes = module.classes();
  v3_cpp_obj(factory)->create_instance(factory, classes.at(0).class_id, v3_component_iid,
                                       reinterpret_cast<void**>(&component_));
  EXPECT_EQ(v3_cpp_obj_initialize(component_, nullptr), V3_OK);
  v3_cpp_obj_query_interface(component_, v3_audio_processor_iid, &processor_);
  v3_cpp_obj_query_interface(component_, v3_edit_controller_iid, &controller_);
  v3_cpp_obj_query_interface(component_, v3_midi_mapping_iid, &mapping_);
  v3_cpp_obj_initialize(controller_, nullptr);
  for (const int direction : {V3_INPUT, V3_OUTPUT}) {
    const int count = v3_cpp_obj(component_)->get_bus_count(component_, V3_AUDIO, direction);
    for (int i = 0; i < count; ++i) {
      v3_bus_info info{};
      EXPECT_EQ(v3_cpp_obj(component_)->get_bus_info(component_, V3_AUDIO, direction, i, &info),
                V3_OK);
      (direction == V3_INPUT ? inputs_ : outputs_).push_back(info.channel_count);
    }
  }
  const int count = v3_cpp_obj(controller_)->get_parameter_count(controller_);
  for (int i = 0; i < count; ++i) {
    v3_param_info info{};
    EXPECT_EQ(v3_cpp_obj(controller_)->get_parameter_info(controller_, i, &info), V3_OK);
    if ((info.flags & V3_PARAM_IS_HIDDEN) == 0) parameters_.push_back(info);
  }
}

Vst3Plugin::~Vst3Plugin() {
  stop();
  v3_cpp_obj_terminate(controller_);
  v3_cpp_obj_unref(controller_);
  v3_cpp_obj_unref(processor_);
  v3_cpp_obj_terminate(component_);
  v3_cpp_obj_unref(component_);
}

bool Vst3Plugin::start(double rate_hz, std::size_t max_frames) {
  for (const int direction : {V3_INPUT, V3_OUTPUT}) {
    const std::size_t count = (direction == V3_INPUT ? inputs_ : outputs_).size();
    for (std::size_t i = 0; i < count; ++i) {
      v3_cpp_obj(component_)
          ->activate_bus(component_, V3_AUDIO, direction, static_cast<std::int32_t>(i), true);
    }
  }
  v3_process_setup setup{V3_REALTIME, V3_SAMPLE_32, static_cast<std::int32_t>(max_frames), rate_hz};
  is_started_ = v3_cpp_obj(processor_)->setup_processing(processor_, &setup) == V3_OK &&
                v3_cpp_obj(component_)->set_active(component_, true) == V3_OK &&
                set_processing(true);
  passed_ = 0;
  given_.clear();
  return is_started_;
}

void Vst3Plugin::stop() {
  if (!is_started_) return;
  is_started_ = false;
  set_processing(false);
  v3_cpp_obj(component_)->set_active(component_, false);
}

bool Vst3Plugin::set_processing(bool is_on) {
  return v3_cpp_obj(processor_)->set_processing(processor_, is_on) == V3_OK;
}

Channels Vst3Plugin::process(const Story& story, const std::vector<Vst3Value>& more) {
  Events events, given;
  Changes changes, told;
  for (const Story::Midi& midi : story.midi) add_midi(*this, midi, events, changes);
  for (const Story::Point& point : story.points) {
    changes.add(point.sample, parameters_.at(point.place).param_id, point.part);
  }
  for (const Vst3Value& value : more) changes.add(value.sample, value.id, value.normalized);

  std::vector<float*> in, out;
  Channels sound;
  for (const std::vector<float>& channel : story.inputs) {
    in.push_back(const_cast<float*>(channel.data()));  // the interface has no const
  }
  std::vector<float> silence(story.frames);
  in.resize(static_cast<std::size_t>(std::accumulate(inputs_.begin(), inputs_.end(), 0)),
            silence.data());
  for (const int count : outputs_) {
    for (int i = 0; i < count; ++i) sound.emplace_back(story.frames, 99.0F);
  }
  for (std::vector<float>& channel : sound) out.push_back(channel.data());
  std::vector<v3_audio_bus_buffers> in_buses, out_buses;
  const auto fill = [](const std::vector<int>& buses, std::vector<float*>& channels,
                       std::vector<v3_audio_bus_buffers>& filled) {
    std::size_t first = 0;
    for (const int count : buses) {
      v3_audio_bus_buffers bus{};
      bus.num_channels = count;
      bus.channel_buffers_32 = channels.data() + first;
      filled.push_back(bus);
      first += static_cast<std::size_t>(count);
    }
  };
  fill(inputs_, in, in_buses);
  fill(outputs_, out, out_buses);
  v3_process_data data{};
  data.symbolic_sample_size = V3_SAMPLE_32;
  data.nframes = static_cast<std::int32_t>(story.frames);
  data.num_input_buses = static_cast<std::int32_t>(in_buses.size());
  data.num_output_buses = static_cast<std::int32_t>(out_buses.size());
  data.inputs = in_buses.data();
  data.outputs = out_buses.data();
  data.input_params = changes.seen();
  data.output_params = told.seen();
  data.input_events = events.seen();
  data.output_events = given.seen();
  v3_process_context song{};
  if (!story.song.empty()) {
    song = context_of(story.song.front());
    data.ctx = &song;
  }
  given.all.reserve(4096);
  v3_result done = V3_FALSE;
  call_block_([&] { done = v3_cpp_obj(processor_)->process(processor_, &data); });
  EXPECT_EQ(done, V3_OK);
  for (const v3_event& event : given.all) {
    given_.push_back({passed_ + static_cast<std::size_t>(event.sample_offset), bytes_of(event)});
  }
  passed_ += story.frames;
  return sound;
}

Channels Vst3Plugin::play(const Story& story, std::size_t block) {
  Channels all;
  for (std::size_t from = 0; from < story.frames; from += block) {
    append(all, process(story.part(from, std::min(block, story.frames - from))));
  }
  return all;
}

std::string Vst3Plugin::save(std::size_t bytes_at_once) const {
  Stream stream;
  stream.at_once = bytes_at_once;
  EXPECT_EQ(v3_cpp_obj(component_)->get_state(component_, stream.seen()), V3_OK);
  return stream.bytes;
}

bool Vst3Plugin::load(const std::string& state, std::size_t bytes_at_once) {
  Stream stream;
  stream.bytes = state;
  stream.at_once = bytes_at_once;
  return v3_cpp_obj(component_)->set_state(component_, stream.seen()) == V3_OK;
}

std::vector<v3_param_info> Vst3Plugin::parameters() const { return parameters_; }

v3_param_id Vst3Plugin::of_controller(int channel, int controller) const {
  v3_param_id id = 0;
  EXPECT_EQ(v3_cpp_obj(mapping_)->get_midi_controller_assignment(
                mapping_, 0, static_cast<std::int16_t>(channel),
                static_cast<std::int16_t>(controller), &id),
            V3_TRUE);
  return id;
}

}  // namespace knotwave::test

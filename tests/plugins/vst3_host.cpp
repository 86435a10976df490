// SPDX-License-Identifier: MIT
#include "vst3_host.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include <dlfcn.h>
#include <gtest/gtest.h>

namespace knotwave::test {
namespace {

// Objects of the host: what the plugin holds is the address of the first member, the table. They
// outlive every call, so nobody counts.

v3_result V3_API no_interface(void*, const v3_tuid, void** object) {
  *object = nullptr;
  return V3_NO_INTERFACE;
}
std::uint32_t V3_API one(void*) { return 1; }
template <class Table>
void make_unknown(Table& table) {
  table.query_interface = no_interface;
  table.ref = one;
  table.unref = one;
}

struct Queue {
  v3_param_value_queue_cpp* table;
  v3_param_id id;
  std::vector<std::pair<std::int32_t, double>> points;

  static v3_param_value_queue_cpp* queue_table() {
    static v3_param_value_queue_cpp made = [] {
      v3_param_value_queue_cpp queue{};
      make_unknown(queue);
      queue.queue.get_param_id = [](void* self) { return static_cast<Queue*>(self)->id; };
      queue.queue.get_point_count = [](void* self) {
        return static_cast<std::int32_t>(static_cast<Queue*>(self)->points.size());
      };
      queue.queue.get_point = [](void* self, std::int32_t index, std::int32_t* sample,
                                 double* value) -> v3_result {
        const auto& point = static_cast<Queue*>(self)->points.at(static_cast<std::size_t>(index));
        *sample = point.first;
        *value = point.second;
        return V3_OK;
      };
      queue.queue.add_point = [](void* self, std::int32_t sample, double value,
                                 std::int32_t*) -> v3_result {
        static_cast<Queue*>(self)->points.emplace_back(sample, value);
        return V3_OK;
      };
      return queue;
    }();
    return &made;
  }
};

struct Changes {
  v3_param_changes_cpp* table = changes_table();
  std::vector<std::unique_ptr<Queue>> queues;

  void add(std::size_t sample, v3_param_id id, double value) {
    auto found = std::ranges::find(queues, id, [](const auto& queue) { return queue->id; });
    if (found == queues.end()) {
      queues.push_back(std::make_unique<Queue>(Queue{Queue::queue_table(), id, {}}));
      found = queues.end() - 1;
    }
    (*found)->points.emplace_back(static_cast<std::int32_t>(sample), value);
  }
  v3_param_changes** seen() { return reinterpret_cast<v3_param_changes**>(this); }

  static v3_param_changes_cpp* changes_table() {
    static v3_param_changes_cpp made = [] {
      v3_param_changes_cpp changes{};
      make_unknown(changes);
      changes.changes.get_param_count = [](void* self) {
        return static_cast<std::int32_t>(static_cast<Changes*>(self)->queues.size());
      };
      changes.changes.get_param_data = [](void* self, std::int32_t index) {
        return reinterpret_cast<v3_param_value_queue**>(
            static_cast<Changes*>(self)->queues.at(static_cast<std::size_t>(index)).get());
      };
      changes.changes.add_param_data = [](void* self, v3_param_id* id, std::int32_t* index) {
        auto& given = static_cast<Changes*>(self)->queues;
        given.push_back(std::make_unique<Queue>(Queue{Queue::queue_table(), *id, {}}));
        *index = static_cast<std::int32_t>(given.size()) - 1;
        return reinterpret_cast<v3_param_value_queue**>(given.back().get());
      };
      return changes;
    }();
    return &made;
  }
};

struct Events {
  v3_event_list_cpp* table = events_table();
  std::vector<v3_event> all;
  v3_event_list** seen() { return reinterpret_cast<v3_event_list**>(this); }

  static v3_event_list_cpp* events_table() {
    static v3_event_list_cpp made = [] {
      v3_event_list_cpp list{};
      make_unknown(list);
      list.list.get_event_count = [](void* self) {
        return static_cast<std::uint32_t>(static_cast<Events*>(self)->all.size());
      };
      list.list.get_event = [](void* self, std::int32_t index, v3_event* event) -> v3_result {
        *event = static_cast<Events*>(self)->all.at(static_cast<std::size_t>(index));
        return V3_OK;
      };
      list.list.add_event = [](void* self, v3_event* event) -> v3_result {
        static_cast<Events*>(self)->all.push_back(*event);
        return V3_OK;
      };
      return list;
    }();
    return &made;
  }
};

/// Reads and writes at most `at_once` bytes a call.
struct Stream {
  struct Table : v3_funknown {
    v3_bstream stream;
  };
  Table* table = stream_table();
  std::string bytes;
  std::size_t at_once = 0, place = 0;
  v3_bstream** seen() { return reinterpret_cast<v3_bstream**>(this); }

  static Table* stream_table() {
    static Table made = [] {
      Table stream{};
      make_unknown(stream);
      stream.stream.read = [](void* self, void* to, std::int32_t count,
                              std::int32_t* read) -> v3_result {
        auto& from = *static_cast<Stream*>(self);
        const std::size_t done = std::min(
            {static_cast<std::size_t>(count), from.at_once, from.bytes.size() - from.place});
        std::memcpy(to, from.bytes.data() + from.place, done);
        from.place += done;
        if (read != nullptr) *read = static_cast<std::int32_t>(done);
        return V3_OK;
      };
      stream.stream.write = [](void* self, void* from, std::int32_t count,
                               std::int32_t* written) -> v3_result {
        auto& to = *static_cast<Stream*>(self);
        const std::size_t done = std::min(static_cast<std::size_t>(count), to.at_once);
        to.bytes.append(static_cast<const char*>(from), done);
        if (written != nullptr) *written = static_cast<std::int32_t>(done);
        return V3_OK;
      };
      stream.stream.seek = [](void*, std::int64_t, std::int32_t, std::int64_t*) -> v3_result {
        return V3_NOT_IMPLEMENTED;
      };
      stream.stream.tell = [](void*, std::int64_t*) -> v3_result { return V3_NOT_IMPLEMENTED; };
      return stream;
    }();
    return &made;
  }
};

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
  EXPECT_EQ(v3_cpp_obj(processor_)->process(processor_, &data), V3_OK);
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

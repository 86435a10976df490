// SPDX-License-Identifier: MIT
// plugin_cost WAY BLOCKS: the same notes and parameters through the engine itself, through the
// plugins' own class and through the CLAP, LV2 and VST3 files, or the same sound through an effect
// and through what it is made of, for callgrind: the instructions of two runs of different length,
// subtracted, are those of their blocks. plugin_cost scan FILE: what a host's scan of a CLAP file
// takes.
#include "plugin_cost.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <clap/entry.h>
#include <clap/events.h>
#include <clap/ext/params.h>
#include <clap/plugin-factory.h>
#include <dlfcn.h>

#include "knotwave/engine/engine.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/instrument.h"

#include "plugin_cost_told.h"

namespace {

using namespace knotwave;

using bench::kBlock;
using bench::kRate;
using bench::Told;
using bench::told_in;

const plugins::Parameter& cutoff() {
  return plugins::Instrument::table()[plugins::Instrument::table().of_word("cutoff")];
}

double by_engine(int blocks) {
  const auto spec = engine::read_bank(plugins::factory_presets()[0].path, plugins::factory_files());
  const auto bank = engine::BankProgram::create(*spec);
  const auto engine = engine::Engine::create({.rate_hz = kRate}, bank->get());
  std::array<float, kBlock> left, right;
  std::vector<engine::Event> events;
  double sum = 0;
  for (int block = 0; block < blocks; ++block) {
    events.clear();
    const Told told = told_in(block);
    for (const auto& bytes : told.midi) {
      engine::Event& event = events.emplace_back();
      event.midi.time.sample = (*engine)->now();
      std::copy(bytes.begin(), bytes.end(), event.midi.bytes);
    }
    if (told.moves) {
      engine::Event& event = events.emplace_back();
      event.kind = engine::Event::Kind::set_target;
      event.midi.time.sample = (*engine)->now();
      event.slot = static_cast<std::uint16_t>(cutoff().slot);
      event.number = told.cutoff;
      event.every_channel = true;
    }
    (*engine)->process(events, left, right);
    sum += static_cast<double>(left[0]);
  }
  return sum;
}

double by_instrument(int blocks) {
  plugins::Instrument instrument;
  if (!instrument.activate(kRate)) return 0;
  std::array<float, kBlock> left, right;
  double sum = 0;
  for (int block = 0; block < blocks; ++block) {
    instrument.begin(left, right);
    const Told told = told_in(block);
    for (const auto& bytes : told.midi) {
      engine::Event event;
      std::copy(bytes.begin(), bytes.end(), event.midi.bytes);
      instrument.add(event);
    }
    if (told.moves) {
      instrument.add_parameter(plugins::Instrument::table().of_id(cutoff().id), told.cutoff, 0);
    }
    instrument.render();
    sum += static_cast<double>(left[0]);
  }
  return sum;
}

const clap_plugin_factory* factory_of(const char* path) {
  void* const file = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (file == nullptr) return nullptr;
  const auto* entry = static_cast<const clap_plugin_entry*>(dlsym(file, "clap_entry"));
  if (entry == nullptr || !entry->init(path)) return nullptr;
  return static_cast<const clap_plugin_factory*>(entry->get_factory(CLAP_PLUGIN_FACTORY_ID));
}

const clap_host kHost = {CLAP_VERSION,
                         nullptr,
                         "plugin_cost",
                         "",
                         "",
                         "1",
                         [](const clap_host*, const char*) -> const void* { return nullptr; },
                         [](const clap_host*) {},
                         [](const clap_host*) {},
                         [](const clap_host*) {}};

union HostEvent {
  clap_event_header header;
  clap_event_midi midi;
  clap_event_param_value value;
};

double by_clap(int blocks) {
  const clap_plugin_factory* factory = factory_of(KNOTWAVE_CLAP_FILE);
  if (factory == nullptr) return 0;
  const clap_plugin* plugin = factory->create_plugin(factory, &kHost, "org.knotwave.instrument");
  plugin->init(plugin);
  plugin->activate(plugin, kRate, 1, kBlock);
  plugin->start_processing(plugin);
  std::array<float, kBlock> left, right;
  float* channels[] = {left.data(), right.data()};
  clap_audio_buffer buffer{};
  buffer.data32 = channels;
  buffer.channel_count = 2;
  std::vector<HostEvent> events;
  const clap_input_events in{
      &events,
      [](const clap_input_events* list) {
        return static_cast<std::uint32_t>(static_cast<std::vector<HostEvent>*>(list->ctx)->size());
      },
      [](const clap_input_events* list, std::uint32_t i) -> const clap_event_header* {
        return &(*static_cast<std::vector<HostEvent>*>(list->ctx))[i].header;
      }};
  const clap_output_events out{
      nullptr, [](const clap_output_events*, const clap_event_header*) { return true; }};
  double sum = 0;
  for (int block = 0; block < blocks; ++block) {
    events.clear();
    const Told told = told_in(block);
    for (const auto& bytes : told.midi) {
      HostEvent& event = events.emplace_back();
      event.midi = {{sizeof event.midi, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI, 0}, 0, {}};
      std::copy(bytes.begin(), bytes.end(), event.midi.data);
    }
    if (told.moves) {
      HostEvent& event = events.emplace_back();
      event.value = {{sizeof event.value, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE, 0},
                     cutoff().id,
                     nullptr,
                     -1,
                     -1,
                     -1,
                     -1,
                     told.cutoff};
    }
    clap_process process{};
    process.steady_time = -1;
    process.frames_count = kBlock;
    process.audio_outputs = &buffer;
    process.audio_outputs_count = 1;
    process.in_events = &in;
    process.out_events = &out;
    plugin->process(plugin, &process);
    sum += static_cast<double>(left[0]);
  }
  plugin->stop_processing(plugin);
  plugin->deactivate(plugin);
  plugin->destroy(plugin);
  return sum;
}

int scan(const char* path) {
  const auto begin = std::chrono::steady_clock::now();
  const clap_plugin_factory* factory = factory_of(path);
  if (factory == nullptr) {
    std::cerr << "plugin_cost: " << path << " is no CLAP file\n";
    return 1;
  }
  const std::uint32_t count = factory->get_plugin_count(factory);
  for (std::uint32_t i = 0; i < count; ++i) {
    const clap_plugin* plugin =
        factory->create_plugin(factory, &kHost, factory->get_plugin_descriptor(factory, i)->id);
    plugin->init(plugin);
    plugin->destroy(plugin);
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  std::cout << count << " plugins found, made and destroyed in " << took.count() << " ms\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string verb = argc == 3 ? argv[1] : "";
  if (verb == "scan") return scan(argv[2]);
  const int blocks = argc == 3 ? std::atoi(argv[2]) : 0;
  double sum = std::nan("");
  if (blocks > 0 && verb == "engine") {
    sum = by_engine(blocks);
  } else if (blocks > 0 && verb == "instrument") {
    sum = by_instrument(blocks);
  } else if (blocks > 0 && verb == "clap") {
    sum = by_clap(blocks);
  } else if (blocks > 0 && (verb == "lv2" || verb == "vst3")) {
#ifdef KNOTWAVE_LV2_FILE
    sum = bench::by_host(verb, blocks);
#endif
  } else if (blocks > 0) {
    sum = bench::by_effect(verb, blocks);
  }
  if (sum == sum) return std::cout << sum << "\n", 0;
  std::cerr << "usage: plugin_cost WAY BLOCKS, or plugin_cost scan FILE; ways: engine, instrument, "
               "clap, lv2, vst3, shaper[-dc][-dsp], crossfade[-dsp], curve, "
               "envelope[-engine]-16|64|512\n";
  return 2;
}

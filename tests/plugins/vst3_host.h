// SPDX-License-Identifier: MIT
// A VST3 host for tests, over the format's binary interface as DPF's travesty headers describe it:
// opens a module as any host does, plays events and automation into it, keeps its sound.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <travesty/audio_processor.h>
#include <travesty/component.h>
#include <travesty/edit_controller.h>
#include <travesty/factory.h>
#include <travesty/host.h>

#include "story.h"

namespace knotwave::test {

class Vst3Module {
 public:
  explicit Vst3Module(const std::string& bundle);  ///< "…/knotwave.vst3"
  ~Vst3Module();
  Vst3Module(const Vst3Module&) = delete;
  Vst3Module& operator=(const Vst3Module&) = delete;
  v3_plugin_factory** factory() const { return factory_; }
  std::vector<v3_class_info> classes() const;
  /// The binary in the bundle.
  static std::string binary(const std::string& bundle);

 private:
  void* library_ = nullptr;
  v3_plugin_factory** factory_ = nullptr;
};

struct Vst3Value {
  std::size_t sample = 0;
  v3_param_id id = 0;
  double normalized = 0;
};

/// One that makes sound, with its controller.
class Vst3Plugin {
 public:
  explicit Vst3Plugin(const Vst3Module& module);
  ~Vst3Plugin();
  Vst3Plugin(const Vst3Plugin&) = delete;
  Vst3Plugin& operator=(const Vst3Plugin&) = delete;

  v3_component** component() const { return component_; }
  v3_audio_processor** processor() const { return processor_; }
  v3_edit_controller** controller() const { return controller_; }

  /// Every bus switched on, processing.
  bool start(double rate_hz, std::size_t max_frames);
  void stop();
  bool set_processing(bool is_on);

  /// One call of process(). The parameters of `story` are those of the plugin's table.
  Channels process(const Story& story, const std::vector<Vst3Value>& more = {});
  /// A story in blocks.
  Channels play(const Story& story, std::size_t block);
  void call_blocks_by(CallBlock call) { call_block_ = std::move(call); }
  /// MIDI of all blocks since start(), by its sample since then.
  const std::vector<Story::Midi>& given() const { return given_; }

  std::string save(std::size_t bytes_at_once = 1 << 20) const;
  bool load(const std::string& state, std::size_t bytes_at_once = 1 << 20);

  /// Of the plugin's own parameters, not those that stand for controllers.
  std::vector<v3_param_info> parameters() const;
  /// That a host is told for a controller of MIDI; 128 is pressure, 129 the bend.
  v3_param_id of_controller(int channel, int controller) const;

 private:
  v3_component** component_ = nullptr;
  v3_audio_processor** processor_ = nullptr;
  v3_edit_controller** controller_ = nullptr;
  v3_midi_mapping** mapping_ = nullptr;
  std::vector<int> inputs_, outputs_;  ///< channels of each bus
  bool is_started_ = false;
  CallBlock call_block_ = [](const std::function<void()>& block) { block(); };
  std::size_t passed_ = 0;
  std::vector<Story::Midi> given_;
  std::vector<v3_param_info> parameters_;
};

}  // namespace knotwave::test

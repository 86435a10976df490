// SPDX-License-Identifier: MIT
// An LV2 host for tests, over the format's binary interface: what jalv does to a plugin, without a
// sound server and in blocks of any size.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <lv2/lv2.h>
#include <lv2/state.h>
#include <lv2/urid.h>
#include <lv2/worker.h>

#include "story.h"

namespace knotwave::test {

class Lv2Plugin {
 public:
  /// `binary` is "…/knotwave.lv2/knotwave.so".
  Lv2Plugin(const plugins::PluginInfo& info, const std::string& binary, double rate_hz);
  ~Lv2Plugin();
  Lv2Plugin(const Lv2Plugin&) = delete;
  Lv2Plugin& operator=(const Lv2Plugin&) = delete;

  const LV2_Descriptor* descriptor() const { return descriptor_; }
  void activate();
  void deactivate();
  /// One call of run(). Points count at its begin, as ports do.
  Channels run(const Story& story);
  Channels play(const Story& story, std::size_t block);
  void call_blocks_by(CallBlock call) { call_block_ = std::move(call); }
  /// MIDI of all blocks since activate(), by its sample since then.
  const std::vector<Story::Midi>& given() const { return given_; }
  /// What save() stores under the plugin's own key.
  std::string save() const;
  bool load(const std::string& text);

 private:
  std::uint32_t number_of(const char* uri);

  const plugins::PluginInfo& info_;
  void* library_ = nullptr;
  const LV2_Descriptor* descriptor_ = nullptr;
  LV2_Handle handle_ = nullptr;
  LV2_URID_Map map_{};
  LV2_Worker_Schedule worker_{};
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<float> controls_;
  std::vector<std::uint64_t> events_in_, events_out_;
  bool is_active_ = false;
  CallBlock call_block_ = [](const std::function<void()>& block) { block(); };
  std::size_t passed_ = 0;
  std::vector<Story::Midi> given_;
};

}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Every effect inside the gate: presets and curve files loaded while it plays, a storm of
// parameters and of the host's transport, NaN in the sound, and resets.
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/effect.h"
#include "knotwave/plugins/plugin_list.h"

#include "preset_control.h"
#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

constexpr std::size_t kBlock = 96;
constexpr std::size_t kChannels = plugins::Block::kMostChannels;
constexpr int kLoads = 40;
constexpr const char* kCurve =
    "format = 1\nkind = \"curve\"\n[curves.any]\ndegree = 1\npoints = [0, 0.5, 1]\n";

/// The audio thread of a host.
class Storm {
 public:
  explicit Storm(plugins::Plugin& plugin) : plugin_(plugin) {
    for (std::size_t c = 0; c < kChannels; ++c) from_[c] = to_[c] = sound_[c].data();
  }

  void block() {
    for (auto& channel : sound_) {
      for (float& sample : channel) sample = static_cast<float>(random_.bipolar(draw_++));
      if (bits() % 8 == 0) channel[bits() % kBlock] = std::numeric_limits<float>::quiet_NaN();
    }
    plugin_.begin({from_, to_, kBlock});
    for (std::int64_t sample = 0; sample < static_cast<std::int64_t>(kBlock);
         sample += 1 + static_cast<std::int64_t>(bits() % 30)) {
      plugin_.add_transport({.beats_per_minute = 60.0 + static_cast<double>(bits() % 4),
                             .quarters = random_.bipolar(draw_++) * 20,
                             .is_playing = bits() % 3 != 0,
                             .has_position = true},
                            sample);
      plugin_.add_parameter(bits() % plugins::ParameterValues::kMost, random_.bipolar(draw_++) * 20,
                            sample);
    }
    plugin_.render();
    if (blocks_ % 500 == 499) plugin_.reset();
    for (const float sample : sound_[0]) is_finite_ = is_finite_ && std::isfinite(sample);
    ++blocks_;
  }
  bool is_finite() const { return is_finite_; }
  bool has_enough() const { return true; }

 private:
  std::uint64_t bits() { return random_.bits(draw_++); }

  plugins::Plugin& plugin_;
  std::array<std::array<float, kBlock>, kChannels> sound_{};
  std::array<const float*, kChannels> from_{};
  std::array<float*, kChannels> to_{};
  base::RandomStream random_{support::test_seed(), 0, 5102};
  std::uint64_t draw_ = 0;
  int blocks_ = 0;
  bool is_finite_ = true;
};

void every_effect_in_a_storm(Gate gate) {
  for (const plugins::PluginInfo* info : plugins::all_plugins()) {
    const auto plugin = info->create();
    if (dynamic_cast<plugins::Effect*>(plugin.get()) == nullptr) continue;
    ASSERT_TRUE(plugin->activate(48000));
    Storm storm(*plugin);
    const StormReport report = storm_in_gate(
        gate, storm,
        {.count = kLoads,
         .load =
             [&](int load) {
               const auto preset = static_cast<std::size_t>(load) % info->presets.size();
               EXPECT_TRUE(load % 2 == 0 ? plugin->load_state(kCurve)
                                         : plugin->load_preset(preset));
             },
         .collect = [&] { plugin->collect(); }});
    EXPECT_EQ(report.gate.findings(), "") << info->key;
    EXPECT_TRUE(storm.is_finite()) << info->key;
    EXPECT_LT(report.blocks, kMostBlocks) << info->key;
  }
}

TEST(EffectInTheGate, PlaysInAStormUnderTheSanitizer) { every_effect_in_a_storm(Gate::sanitizer); }
TEST(EffectInTheGate, PlaysInAStormWithoutSystemCallsAndWaits) {
  every_effect_in_a_storm(Gate::system);
}

}  // namespace
}  // namespace knotwave::rt

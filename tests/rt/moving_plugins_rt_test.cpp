// SPDX-License-Identifier: MIT
// Knotwave Envelope and Knotwave Curve inside the gate: every preset loaded while it plays, a storm
// of notes, of parameters, of sound and of the host's transport, and resets.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/plugin_list.h"

#include "preset_control.h"
#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

using plugins::Plugin;
using plugins::PluginInfo;

constexpr std::size_t kBlock = 64;
constexpr std::size_t kSentAtLeast = 500;

/// The audio thread of a host.
class Storm {
 public:
  explicit Storm(Plugin& plugin) : plugin_(plugin), parameters_(plugin.info().parameters->size()) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      in_[c] = input_.data();
      out_[c] = outputs_[c].data();
    }
    for (const auto& port : plugin.info().outputs) {
      outs_ += static_cast<std::size_t>(port.channels);
    }
  }

  void block() {
    for (float& sample : input_) {
      sample = blocks_ % 7 < 4 ? static_cast<float>(random_.bipolar(draw_++)) : 0;
    }
    plugin_.begin({std::span(in_).first(2), std::span(out_).first(outs_), kBlock});
    plugin_.add_transport({.beats_per_minute = 60.0 + static_cast<double>(bits() % 4),
                           .quarters = static_cast<double>(blocks_ % 700) / 100,
                           .is_playing = blocks_ % 90 < 60,
                           .has_position = true},
                          0);
    for (std::int64_t sample = 0; sample < static_cast<std::int64_t>(kBlock);
         sample += 1 + static_cast<std::int64_t>(bits() % 20)) {
      if (bits() % 2 == 0) {
        plugin_.add_parameter(bits() % parameters_, random_.bipolar(draw_++) * 20, sample);
      } else {
        plugin_.add(random_message(bits(), sample));
      }
    }
    plugin_.render();
    sent_ += plugin_.midi_out().size();
    if (blocks_ % 500 == 499) plugin_.reset();
    for (std::size_t c = 0; c < outs_; ++c) {
      for (const float sample : outputs_[c]) loudest_ = std::max(loudest_, std::abs(sample));
    }
    ++blocks_;
  }
  float loudest() const { return loudest_; }
  bool has_enough() const { return !plugin_.info().gives_midi || sent_ >= kSentAtLeast; }

 private:
  static constexpr std::size_t kChannels = plugins::Block::kMostChannels;
  std::uint64_t bits() { return random_.bits(draw_++); }

  Plugin& plugin_;
  std::size_t parameters_, outs_ = 0;
  std::array<float, kBlock> input_{};
  std::array<std::array<float, kBlock>, kChannels> outputs_{};
  std::array<const float*, kChannels> in_{};
  std::array<float*, kChannels> out_{};
  base::RandomStream random_{support::test_seed(), 0, 5003};
  std::uint64_t draw_ = 0;
  int blocks_ = 0;
  float loudest_ = 0;
  std::size_t sent_ = 0;
};

void every_preset_in_a_storm(const PluginInfo& info, Gate gate) {
  const auto plugin = info.create();
  ASSERT_TRUE(plugin->activate(48000));
  Storm storm(*plugin);
  const auto presets = static_cast<int>(info.presets.size());
  const StormReport report =
      storm_in_gate(gate, storm,
                    {.count = presets,
                     .load =
                         [&](int preset) {
                           const auto i = static_cast<std::size_t>(preset);
                           EXPECT_TRUE(plugin->load_preset(i));
                           plugin->set_parameter(i % info.parameters->size(), 0.5);
                         },
                     .collect = [&] { plugin->collect(); }});
  EXPECT_EQ(report.gate.findings(), "");
  EXPECT_GT(storm.loudest(), 0.01F);
  EXPECT_TRUE(storm.has_enough());
  EXPECT_GE(report.blocks, kBlocksOfALoad * presets);
  EXPECT_LT(report.blocks, kMostBlocks);
}

class MovingPluginInTheGate : public testing::TestWithParam<Gate> {};
TEST_P(MovingPluginInTheGate, EnvelopePlaysEveryPresetInAStorm) {
  every_preset_in_a_storm(plugins::envelope_info(), GetParam());
}
TEST_P(MovingPluginInTheGate, CurvePlaysEveryPresetInAStorm) {
  every_preset_in_a_storm(plugins::curve_info(), GetParam());
}
INSTANTIATE_TEST_SUITE_P(Both, MovingPluginInTheGate,
                         testing::Values(Gate::sanitizer, Gate::system), [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "Sanitizer" : "System";
                         });

}  // namespace
}  // namespace knotwave::rt

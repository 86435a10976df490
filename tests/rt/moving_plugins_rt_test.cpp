// SPDX-License-Identifier: MIT
// Knotwave Envelope and Knotwave Curve inside the gate: every preset loaded while it plays, a storm
// of notes, of parameters, of sound and of the host's transport, and resets.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/plugin_list.h"

#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

using plugins::Plugin;
using plugins::PluginInfo;

constexpr std::size_t kBlock = 64;
constexpr int kBlocksOfAPreset = 24;
constexpr int kMostBlocks = 200'000;

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
        plugin_.add(message(sample));
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
  std::size_t sent() const { return sent_; }

 private:
  static constexpr std::size_t kChannels = plugins::Block::kMostChannels;
  std::uint64_t bits() { return random_.bits(draw_++); }
  engine::Event message(std::int64_t sample) {
    constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x90, 0x80,
                                                     0xB0, 0xC0, 0xD0, 0xE0};
    const std::uint64_t draw = bits();
    engine::Event event;
    event.midi.time.sample = sample;
    event.midi.bytes[0] = static_cast<std::uint8_t>(kStatus[draw & 7] | (draw >> 3 & 15));
    event.midi.bytes[1] = static_cast<std::uint8_t>(draw >> 8 & 127);
    event.midi.bytes[2] = static_cast<std::uint8_t>(draw >> 16 & 127);
    return event;
  }

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

/// The control thread: loads one preset after the other while blocks are played.
class Control {
 public:
  explicit Control(Plugin& plugin) : thread_([this, &plugin] { run(plugin); }) {}
  ~Control() { thread_.join(); }

  void play(Storm& storm) {
    while (!is_done_.load() && blocks_.load() < kMostBlocks) {
      storm.block();
      blocks_.fetch_add(1);
    }
  }
  int blocks() const { return blocks_.load(); }

 private:
  void run(Plugin& plugin) {
    for (std::size_t preset = 0; preset < plugin.info().presets.size(); ++preset) {
      const int begin = blocks_.load();
      EXPECT_TRUE(plugin.load_preset(preset));
      plugin.set_parameter(preset % plugin.info().parameters->size(), 0.5);
      while (blocks_.load() < begin + kBlocksOfAPreset && blocks_.load() < kMostBlocks) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      plugin.collect();
    }
    is_done_ = true;
  }

  std::atomic<int> blocks_{0};
  std::atomic<bool> is_done_{false};
  std::thread thread_;
};

void every_preset_in_a_storm(const PluginInfo& info, Gate gate) {
  const auto plugin = info.create();
  ASSERT_TRUE(plugin->activate(48000));
  Storm storm(*plugin);
  std::unique_ptr<Control> control;
  const GateReport report = run_in_gate(
      gate, [&] { control->play(storm); },
      [&] {
        Control(*plugin).play(storm);
        control = std::make_unique<Control>(*plugin);
      });
  const int blocks = control->blocks();
  control.reset();
  EXPECT_EQ(report.findings(), "");
  EXPECT_GT(storm.loudest(), 0.01F);
  if (info.gives_midi) {
    EXPECT_GT(storm.sent(), 500u);
  }
  EXPECT_GE(blocks, kBlocksOfAPreset * static_cast<int>(info.presets.size()));
  EXPECT_LT(blocks, kMostBlocks);
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

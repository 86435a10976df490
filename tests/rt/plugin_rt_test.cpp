// SPDX-License-Identifier: MIT
// The instrument of the plugins inside the gate: every preset loaded while it plays, a storm of
// notes, of parameters and of the host's transport, and resets.
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/instrument.h"
#include "knotwave/plugins/parameters.h"

#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

using plugins::Instrument;

constexpr std::size_t kBlock = 64;
constexpr int kBlocksOfAPreset = 24;
constexpr int kMostBlocks = 200'000;

/// The audio thread of a host.
class HostStorm {
 public:
  explicit HostStorm(Instrument& instrument) : instrument_(instrument) {}

  void block() {
    instrument_.begin(left_, right_);
    instrument_.add_transport({.beats_per_minute = 60.0 + static_cast<double>(bits() % 4),
                               .quarters = static_cast<double>(blocks_ % 700) / 100,
                               .is_playing = blocks_ % 90 < 60,
                               .has_position = true},
                              0);
    for (std::int64_t sample = 0; sample < static_cast<std::int64_t>(kBlock);
         sample += 1 + static_cast<std::int64_t>(bits() % 20)) {
      if (bits() % 2 == 0) {
        instrument_.add_parameter(bits() % plugins::Instrument::table().size(),
                                  random_.bipolar(draw_++) * 20, sample);
      } else if (bits() % 4 == 0) {
        instrument_.add_modulation(
            bits() % plugins::Instrument::table().size(), random_.bipolar(draw_++) * 3,
            {static_cast<std::int32_t>(bits() % 40) - 20, -1, static_cast<int>(bits() % 140) - 12},
            sample);
      } else {
        instrument_.add(message(sample));
      }
    }
    instrument_.render();
    if (blocks_ % 500 == 499) instrument_.reset();
    for (const float sample : left_) loudest_ = std::max(loudest_, sample < 0 ? -sample : sample);
    ++blocks_;
  }
  float loudest() const { return loudest_; }

 private:
  std::uint64_t bits() { return random_.bits(draw_++); }
  engine::Event message(std::int64_t sample) {
    constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x90, 0x80,
                                                     0xB0, 0xC0, 0xD0, 0xE0};
    const std::uint64_t draw = bits();
    engine::Event event;
    event.midi.time.sample = sample;
    event.note = static_cast<std::int32_t>(draw >> 40 & 31) - 12;
    event.midi.bytes[0] = static_cast<std::uint8_t>(kStatus[draw & 7] | (draw >> 3 & 15));
    event.midi.bytes[1] = static_cast<std::uint8_t>(draw >> 8 & 127);
    event.midi.bytes[2] = static_cast<std::uint8_t>(draw >> 16 & 127);
    return event;
  }

  Instrument& instrument_;
  std::array<float, kBlock> left_{}, right_{};
  base::RandomStream random_{support::test_seed(), 0, 5002};
  std::uint64_t draw_ = 0;
  int blocks_ = 0;
  float loudest_ = 0;
};

/// The control thread: loads one preset after the other while blocks are played.
class Control {
 public:
  explicit Control(Instrument& instrument) : thread_([this, &instrument] { run(instrument); }) {}
  ~Control() { thread_.join(); }

  void play(HostStorm& storm) {
    while (!is_done_.load() && blocks_.load() < kMostBlocks) {
      storm.block();
      blocks_.fetch_add(1);
    }
  }
  int blocks() const { return blocks_.load(); }

 private:
  void run(Instrument& instrument) {
    for (std::size_t preset = 0; preset < plugins::factory_presets().size(); ++preset) {
      const int begin = blocks_.load();
      EXPECT_TRUE(instrument.load_preset(preset));
      instrument.set_parameter(preset % plugins::Instrument::table().size(), 0.5);
      while (blocks_.load() < begin + kBlocksOfAPreset && blocks_.load() < kMostBlocks) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      instrument.collect();
    }
    is_done_ = true;
  }

  std::atomic<int> blocks_{0};
  std::atomic<bool> is_done_{false};
  std::thread thread_;
};

void every_preset_in_a_storm(Gate gate) {
  Instrument instrument;
  ASSERT_TRUE(instrument.activate(48000));
  HostStorm storm(instrument);
  std::unique_ptr<Control> control;
  const GateReport report = run_in_gate(
      gate, [&] { control->play(storm); },
      [&] {
        Control(instrument).play(storm);
        control = std::make_unique<Control>(instrument);
      });
  const int blocks = control->blocks();
  control.reset();
  EXPECT_EQ(report.findings(), "");
  EXPECT_GT(storm.loudest(), 0.01F);
  EXPECT_GE(blocks, kBlocksOfAPreset * static_cast<int>(plugins::factory_presets().size()));
  EXPECT_LT(blocks, kMostBlocks);
}

TEST(PluginInTheGate, PlaysEveryPresetInAStormUnderTheSanitizer) {
  every_preset_in_a_storm(Gate::sanitizer);
}
TEST(PluginInTheGate, PlaysEveryPresetInAStormWithoutSystemCallsAndWaits) {
  every_preset_in_a_storm(Gate::system);
}

}  // namespace
}  // namespace knotwave::rt

// SPDX-License-Identifier: MIT
// The instrument of the plugins inside the gate: every preset loaded while it plays, a storm of
// notes, of parameters and of the host's transport, and resets.
#include <array>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/instrument.h"
#include "knotwave/plugins/parameters.h"

#include "preset_control.h"
#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

using plugins::Instrument;

constexpr std::size_t kBlock = 64;

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
  bool has_enough() const { return true; }

 private:
  std::uint64_t bits() { return random_.bits(draw_++); }
  engine::Event message(std::int64_t sample) {
    const std::uint64_t draw = bits();
    engine::Event event = random_message(draw, sample);
    event.note = static_cast<std::int32_t>(draw >> 40 & 31) - 12;
    return event;
  }

  Instrument& instrument_;
  std::array<float, kBlock> left_{}, right_{};
  base::RandomStream random_{support::test_seed(), 0, 5002};
  std::uint64_t draw_ = 0;
  int blocks_ = 0;
  float loudest_ = 0;
};

void every_preset_in_a_storm(Gate gate) {
  Instrument instrument;
  ASSERT_TRUE(instrument.activate(48000));
  HostStorm storm(instrument);
  const auto presets = static_cast<int>(plugins::factory_presets().size());
  const StormReport report =
      storm_in_gate(gate, storm,
                    {.count = presets,
                     .load =
                         [&](int preset) {
                           const auto i = static_cast<std::size_t>(preset);
                           EXPECT_TRUE(instrument.load_preset(i));
                           instrument.set_parameter(i % Instrument::table().size(), 0.5);
                         },
                     .collect = [&] { instrument.collect(); }});
  EXPECT_EQ(report.gate.findings(), "");
  EXPECT_GT(storm.loudest(), 0.01F);
  EXPECT_GE(report.blocks, kBlocksOfALoad * presets);
  EXPECT_LT(report.blocks, kMostBlocks);
}

TEST(PluginInTheGate, PlaysEveryPresetInAStormUnderTheSanitizer) {
  every_preset_in_a_storm(Gate::sanitizer);
}
TEST(PluginInTheGate, PlaysEveryPresetInAStormWithoutSystemCallsAndWaits) {
  every_preset_in_a_storm(Gate::system);
}

}  // namespace
}  // namespace knotwave::rt

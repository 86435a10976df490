// SPDX-License-Identifier: MIT
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/plugin_list.h"

#include "effect_host.h"
#include "support/seed.h"

namespace knotwave::plugins {
namespace {

using support::Channels;
using support::HostAction;
using support::HostRun;
using support::place_of;
using support::set_at;
using support::Settings;
using support::transport_at;

std::unique_ptr<Plugin> active(const Settings& settings, double rate_hz = 48000) {
  return support::active(curve_info(), settings, rate_hz);
}
Channels ones(std::size_t samples) { return {2, std::vector<float>(samples, 1.0F)}; }

Transport at(double quarters, double bpm = 120) {
  return {.beats_per_minute = bpm, .quarters = quarters, .is_playing = true, .has_position = true};
}
HostAction note_at(std::int64_t sample) {
  return {sample, [](Plugin& plugin, std::int64_t offset) {
            engine::Event event;
            event.midi.time.sample = offset;
            event.midi.bytes[0] = 0x90;
            event.midi.bytes[1] = 60;
            event.midi.bytes[2] = 100;
            plugin.add(event);
          }};
}
double part_of(double x) { return x - std::floor(x); }

TEST(CurvePlugin, TheGainIsAFunctionOfTheSongsPlaceToTheSample) {
  const auto plugin = active({{"curve", "Up"}, {"length", "1/2"}, {"smooth", "0"}});
  const std::vector<HostAction> actions = {transport_at(0, at(3.3)),
                                           transport_at(20000, at(100.75)),
                                           transport_at(40000, at(0.125, 90))};
  const Channels out = support::play(*plugin, ones(60000), {.actions = actions});
  for (std::size_t i = 0; i < 60000; ++i) {
    const double t = static_cast<double>(i);
    const double quarters = i < 20000   ? 3.3 + t / 24000
                            : i < 40000 ? 100.75 + (t - 20000) / 24000
                                        : 0.125 + (t - 40000) / 32000;
    const double gain = part_of(quarters / 2);
    if (gain < 1e-6 || gain > 1 - 1e-6) continue;
    ASSERT_NEAR(out[0][i], gain, 1e-6) << i;
    ASSERT_EQ(out[1][i], out[0][i]);
  }
}

TEST(CurvePlugin, AHostsLoopComesRoundToTheSameBits) {
  const auto plugin = active({{"curve", "Trance"}, {"length", "1 bar"}, {"smooth", "0"}});
  std::vector<HostAction> actions;
  for (std::int64_t turn = 0; turn < 4; ++turn) {
    actions.push_back(transport_at(turn * 48000, at(8)));
  }
  const Channels out = support::play(*plugin, ones(4 * 48000), {.actions = actions});
  for (std::size_t i = 48000; i < 4 * 48000; ++i) {
    if (i % 6000 < 2 || i % 6000 > 5997) continue;  // at the steps' edges
    ASSERT_EQ(out[0][i], out[0][i % 48000]) << i;
  }
  EXPECT_EQ(out[0][3000], 1);
  EXPECT_EQ(out[0][9000], 0);
}

TEST(CurvePlugin, WithoutASongItRunsOnByItself) {
  const auto plugin = active({{"curve", "Up"}, {"length", "1/4"}, {"smooth", "0"}});
  const Transport stands{.beats_per_minute = 60, .is_playing = false, .has_position = true};
  const Channels out = support::play(*plugin, ones(96000), {.actions = {transport_at(0, stands)}});
  for (std::size_t i = 10; i < 47990; ++i) {
    ASSERT_NEAR(out[0][i], static_cast<double>(i) / 48000, 1e-6);
  }
}

TEST(CurvePlugin, AKeyBeginsTheCycleAtItsSample) {
  for (const char* trigger : {"Note", "Note, once"}) {
    const auto plugin =
        active({{"curve", "Down"}, {"length", "1/8"}, {"smooth", "0"}, {"trigger", trigger}});
    const std::vector<HostAction> actions = {note_at(5000), transport_at(9000, at(77)),
                                             note_at(30000)};
    const Channels out = support::play(*plugin, ones(60000), {.actions = actions});
    const bool once = std::string(trigger) == "Note, once";
    for (std::size_t i = 5000; i < 60000; ++i) {
      const double passed = static_cast<double>(i - (i < 30000 ? 5000 : 30000)) / 12000;
      const double gain = once ? std::max(1 - passed, 0.0) : 1 - part_of(passed);
      if (!once && (gain < 1e-6 || gain > 1 - 1e-6)) continue;
      ASSERT_NEAR(out[0][i], gain, 1e-6) << trigger << i << ": the song's jump changes nothing";
    }
    if (once) {
      EXPECT_EQ(out[0][4999], 0) << "before the first key it is at its end";
    }
  }
}

TEST(CurvePlugin, WithEveryDepthAtZeroItPassesTheBits) {
  const auto plugin = active({{"gain", "0"}});
  const Channels in = support::music(2, 20000);
  support::expect_same(support::play(*plugin, in), in, "through");
  const auto dry = active({{"mix", "0"}, {"filter", "Low-pass"}, {"pan", "1"}});
  support::expect_same(support::play(*dry, in), in, "dry");
}

TEST(CurvePlugin, PanTurnsOneSideDownAndLeavesTheOther) {
  const auto plugin =
      active({{"curve", "Up"}, {"length", "1/2"}, {"smooth", "0"}, {"gain", "0"}, {"pan", "1"}});
  const Channels out = support::play(*plugin, ones(48000));
  for (std::size_t i = 1; i < 47999; ++i) {
    const double pan = 2 * static_cast<double>(i) / 48000 - 1;
    ASSERT_NEAR(out[0][i], std::min(1.0, 1 - pan), 1e-6);
    ASSERT_NEAR(out[1][i], std::min(1.0, 1 + pan), 1e-6);
  }
}

TEST(CurvePlugin, TheFilterFollowsTheCurveBetweenItsTwoCutoffs) {
  // A low-pass at rest: its gain at a frequency is that of the analogue filter.
  const auto loudness = [](const char* curve) {
    const auto plugin = active({{"curve", curve},
                                {"length", "8 bars"},
                                {"gain", "0"},
                                {"filter", "Low-pass"},
                                {"cutoff_low", "-4"},
                                {"cutoff_high", "4"},
                                {"resonance", "0"}});
    Channels in(2, std::vector<float>(9600));
    for (std::size_t i = 0; i < 9600; ++i) {
      const double sine = std::sin(2 * 3.14159265358979 * 1000 * static_cast<double>(i) / 48000);
      in[0][i] = in[1][i] = static_cast<float>(sine);
    }
    const Channels out = support::play(*plugin, in);
    float most = 0;
    for (std::size_t i = 4800; i < 9600; ++i) most = std::max(most, std::abs(out[0][i]));
    return static_cast<double>(most);
  };
  EXPECT_LT(loudness("Up"), 0.006) << "62.5 Hz, two poles: 1000 Hz is 48 dB down";
  EXPECT_GT(loudness("Down"), 0.98) << "16 kHz";
}

TEST(CurvePlugin, AnyBlocksGiveTheSameBits) {
  const std::vector<HostAction> actions = {
      transport_at(0, at(0.9, 173)),
      set_at(40, place_of(curve_info(), "curve"), 10),
      note_at(100),
      set_at(333, place_of(curve_info(), "filter"), 3),
      set_at(400, place_of(curve_info(), "filter"), 1),
      set_at(500, place_of(curve_info(), "length"), 12),
      set_at(501, place_of(curve_info(), "beats"), 0.05),
      set_at(600, place_of(curve_info(), "trigger"), 1),
      transport_at(700, at(4.2, 99)),
      note_at(801),
      set_at(900, place_of(curve_info(), "smooth"), 20),
      set_at(1000, place_of(curve_info(), "pan"), -1),
      set_at(1100, place_of(curve_info(), "curve"), 0),
  };
  support::expect_any_blocks_the_same(
      [] {
        return active({{"length", "1/16"}, {"filter", "High-pass"}, {"pan", "0.4"}});
      },
      support::music(2, 1700), actions);
}

TEST(CurvePlugin, EveryPresetLoadsIsHeardAndIsTheSameAgain) {
  const auto plugin = curve_info().create();
  ASSERT_GE(curve_info().presets.size(), 8u);
  std::set<std::string> heard;
  for (std::size_t preset = 0; preset < curve_info().presets.size(); ++preset) {
    const auto loaded = plugin->load_preset(preset);
    ASSERT_TRUE(loaded) << curve_info().presets[preset] << loaded.error().to_string();
    ASSERT_TRUE(plugin->activate(48000));
    const Channels in = support::music(2, 48000);
    const Channels out =
        support::play(*plugin, in, {.actions = {transport_at(0, at(0)), note_at(4000)}});
    EXPECT_LT(support::loudest(out), 4) << curve_info().presets[preset];
    heard.insert(support::hash_of(out));
    const auto other = curve_info().create();
    ASSERT_TRUE(other->load_state(plugin->state()));
    EXPECT_EQ(other->state(), plugin->state());
  }
  heard.insert(support::hash_of(support::music(2, 48000)));
  EXPECT_EQ(heard.size(), curve_info().presets.size() + 1);
}

TEST(CurvePlugin, ACurveBeyondZeroToOneIsRefusedAndNothingChanges) {
  const auto plugin = curve_info().create();
  const std::string kept = plugin->state();
  const auto loaded = plugin->load_state(
      "format = 1\nkind = 'plugin'\nplugin = 'curve'\n[curves.own]\ndegree = 1\n"
      "points = [-0.5, 1]\n");
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message,
              testing::HasSubstr("'own' lie from -0.5 to 1; they must lie from 0 to 1"));
  EXPECT_EQ(plugin->state(), kept);
}

TEST(CurvePlugin, AStormLeavesNoNaNAndAResetIsANewBeginning) {
  const base::RandomStream random{support::test_seed(), 0, 12};
  std::uint64_t draw = 0;
  const auto plugin = active({});
  Channels in = support::music(2, 40000);
  std::vector<HostAction> actions;
  for (std::int64_t sample = 0; sample < 40000;
       sample += 1 + std::int64_t(random.bits(draw++) % 90)) {
    const std::uint64_t what = random.bits(draw++) % 4;
    if (what < 2) {
      const double value =
          random.bits(draw++) % 9 == 0 ? std::nan("") : 40 * random.bipolar(draw++);
      actions.push_back(set_at(sample, random.bits(draw++) % 14, value));
    } else if (what == 2) {
      const double bpm = 2000 * random.unit(draw++);
      actions.push_back(transport_at(sample, at(1e4 * random.bipolar(draw++), bpm)));
    } else {
      actions.push_back(note_at(sample));
    }
    in[0][static_cast<std::size_t>(sample)] = std::nanf("");
  }
  EXPECT_LT(support::loudest(support::play(*plugin, in, {.actions = actions})), 1e6F);
  const auto fresh = curve_info().create();
  for (std::size_t place = 0; place < 14; ++place) {
    fresh->set_parameter(place, plugin->parameter(place));
  }
  ASSERT_TRUE(fresh->activate(48000));
  plugin->reset();
  const Channels music = support::music(2, 5000);
  support::expect_same(support::play(*plugin, music), support::play(*fresh, music), "reset");
}

}  // namespace
}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
// What all effects have in common, shown by the shaper.
#include "knotwave/plugins/effect.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include "knotwave/base/file.h"
#include "knotwave/base/random.h"
#include "knotwave/plugins/exchange.h"
#include "knotwave/plugins/plugin_list.h"
#include "knotwave/plugins/song.h"

#include "effect_host.h"
#include "support/seed.h"

namespace knotwave::plugins {
namespace {

using support::active;
using support::Channels;
using support::music;
using support::place_of;
using support::play;
using support::set_at;
using testing::HasSubstr;

std::string refused(Plugin& plugin, std::string_view text) {
  const auto loaded = plugin.load_state(text);
  return loaded ? "" : loaded.error().to_string();
}

const std::string kHead = "format = 1\nkind = \"plugin\"\nplugin = \"shaper\"\n";

TEST(Effect, AStateIsTextWithWhatWasMovedAndTheOwnCurves) {
  const auto plugin = shaper_info().create();
  EXPECT_EQ(plugin->state(), kHead);
  support::set(*plugin, {{"drive", "12.5 dB"}, {"curve_a", "Fold"}, {"dc_block", "Off"}});
  EXPECT_EQ(plugin->state(),
            kHead + "\n[parameters]\ncurve_a = \"Fold\"\ndrive = 12.5\ndc_block = \"Off\"\n");
  const std::string state = kHead +
                            "\n[parameters]\ncurve_a = \"Own\"\nmix = 0.1\n"
                            "\n[curves.a]\ndegree = 2\npoints = [-1, 0.25, 1]\n";
  ASSERT_EQ(refused(*plugin, state), "");
  EXPECT_EQ(plugin->state(), state);
  EXPECT_EQ(plugin->parameter(place_of(shaper_info(), "drive")), 0);
}

TEST(Effect, AStateReadAgainIsTheSameAndSoundsTheSame) {
  const Channels in = music(2, 3000);
  const auto first = shaper_info().create();
  ASSERT_EQ(refused(*first, kHead + "[parameters]\ncurve_a = \"Own\"\ncurve_b = \"Own\"\n"
                                    "morph = 0.3\ndrive = 7.123456789012345\nbias = -0.1\n"
                                    "[curves.a]\ndegree = 1\npoints = [-0.5, 0.25, 0.5]\n"
                                    "knots = [-1, -1, 0, 1, 1]\n"
                                    "[curves.b]\ndegree = 3\npoints = [-1, 1, -1, 1]\n"
                                    "weights = [1, 2, 3, 1]\n"),
            "");
  const auto second = shaper_info().create();
  ASSERT_EQ(refused(*second, first->state()), "");
  EXPECT_EQ(second->state(), first->state());
  ASSERT_TRUE(first->activate(44100));
  ASSERT_TRUE(second->activate(44100));
  support::expect_same(play(*first, in), play(*second, in), "after loading");
}

TEST(Effect, ADamagedStateIsRefusedWholeWithItsPlace) {
  const auto plugin = shaper_info().create();
  support::set(*plugin, {{"drive", "3"}});
  const std::string before = plugin->state();
  const struct {
    std::string text, message;
  } cases[] = {
      {"", "'format' is missing"},
      {"0123456789abcdef0", "error"},
      {"format = 1\nkind = \"patch\"\n", "kind = \"plugin\""},
      {"format = 2\nkind = \"plugin\"\n", "format is 2"},
      {"format = 1\nkind = \"plugin\"\n", "'plugin' is missing"},
      {"format = 1\nkind = \"plugin\"\nplugin = \"crossfade\"\n",
       ":3:10: error: state: this is a state of the plugin 'crossfade'"},
      {kHead + "colour = 3\n", ":4:1: error: state: unknown key 'colour'"},
      {kHead + "[parameters]\ndriev = 3\n", ":5:1: error: [parameters]: unknown key 'driev'; did "},
      {kHead + "[parameters]\ndrive = 49\n", ":5:9: error: "},
      {kHead + "[parameters]\ndrive = \"loud\"\n", ":5:9: error: "},
      {kHead + "[parameters]\ndrive = nan\n", ":5:"},
      {kHead + "[parameters]\ncurve_a = \"Fald\"\n", "no choice of 'curve_a'; did you mean 'Fold'"},
      {kHead + "[parameters]\ncurve_a = 2\n", ":5:11: error: "},
      {kHead + "[curves.c]\ndegree = 1\npoints = [0, 1]\n", "has no curve 'c' of its own"},
      {kHead + "[curves.a]\ndegree = 1\npoints = [0, 1]\nknots = [0, 0, 1]\n", ":7:"},
      {kHead + "[curves.a]\ncurve_file = \"/etc/passwd\"\n", "error"},
      {kHead + "[surfaces.a]\ndegree_u = 1\n", "unknown key 'surfaces'"},
      {kHead + "[parameters]\ndrive = 9\n[curves.a]\ndegree = 1\n"
               "points = [[-1, 0], [1, 0], [0, 0]]\n",
       "the plugin's state: error: "},
      {kHead + "[parameters]\ndrive = 9\n[parameters]\n", "error"},
  };
  for (const auto& damaged : cases) {
    EXPECT_THAT(refused(*plugin, damaged.text), HasSubstr(damaged.message)) << damaged.text;
    EXPECT_EQ(plugin->state(), before) << damaged.text;
  }
}

TEST(Effect, EveryTruncatedAndEveryFlippedStateIsReadOrRefusedWhole) {
  const std::string state = kHead +
                            "[parameters]\ncurve_a = \"Own\"\ndrive = 9\n"
                            "[curves.a]\ndegree = 1\npoints = [0, 1]\n";
  const auto plugin = shaper_info().create();
  const auto check = [&](const std::string& text) {
    const std::string before = plugin->state();
    if (!plugin->load_state(text)) {
      EXPECT_EQ(plugin->state(), before) << text;
    }
    const std::string now = plugin->state();
    EXPECT_EQ(refused(*plugin, now), "") << now;
    EXPECT_EQ(plugin->state(), now);
  };
  for (std::size_t size = 0; size < state.size(); ++size) check(state.substr(0, size));
  const base::RandomStream random{support::test_seed(), 0, 6103};
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(support::test_count(300)); ++i) {
    std::string text = state;
    text[random.bits(2 * i) % text.size()] = static_cast<char>(random.bits(2 * i + 1));
    check(text);
  }
}

TEST(Effect, ACurveFileBecomesTheOwnCurveAndIsChosen) {
  const auto plugin = shaper_info().create();
  support::set(*plugin, {{"drive", "3"}});
  const std::string file = "format = 1\nkind = \"curve\"\n[curves.anything]\ndegree = 1\n";
  ASSERT_EQ(refused(*plugin, file + "points = [-1, 0.5, 1]\n"), "");
  EXPECT_EQ(plugin->state(), kHead +
                                 "\n[parameters]\ncurve_a = \"Own\"\ndrive = 3\n"
                                 "\n[curves.a]\ndegree = 1\npoints = [-1, 0.5, 1]\n");
  const std::string more = "points = [0, 1]\n[curves.two]\ndegree = 1\npoints = [1, 0]\n";
  ASSERT_EQ(refused(*plugin, file + more), "");
  EXPECT_EQ(plugin->parameter(place_of(shaper_info(), "curve_b")), 0);
  EXPECT_THAT(refused(*plugin, file + more + "[curves.three]\ndegree = 1\npoints = [1, 0]\n"),
              HasSubstr("the file holds 3 curves and 0 surfaces; this plugin takes 2"));
}

TEST(Effect, EveryPresetOfEveryEffectLoadsAndSounds) {
  for (const PluginInfo* info : all_plugins()) {
    const auto plugin = info->create();
    if (dynamic_cast<Effect*>(plugin.get()) == nullptr) continue;
    EXPECT_GE(info->presets.size(), 6u) << info->key;
    std::size_t inputs = 0;
    for (const AudioPort& port : info->inputs) inputs += static_cast<std::size_t>(port.channels);
    for (std::size_t number = 0; number < info->presets.size(); ++number) {
      const auto loaded = plugin->load_preset(number);
      ASSERT_TRUE(loaded) << info->presets[number] << ": " << loaded.error().to_string();
      ASSERT_TRUE(plugin->activate(48000));
      support::HostRun run;
      if (info->takes_midi) {  // some begin with a note
        run.actions.push_back({0, [](Plugin& of, std::int64_t offset) {
                                 engine::Event note;
                                 note.midi = {{offset, 0}, {0x90, 60, 100}};
                                 of.add(note);
                               }});
      }
      const float loud = support::loudest(play(*plugin, music(inputs, 96000, 0.5F), run));
      EXPECT_GT(loud, 0.05F) << info->presets[number];
      EXPECT_LT(loud, 2) << info->presets[number];
    }
    const auto none = plugin->load_preset(info->presets.size());
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::value_out_of_range);
  }
}

std::string parameter_lines() {
  std::string lines;
  for (const PluginInfo* info : {&shaper_info(), &crossfade_info()}) {
    for (const Parameter& parameter : info->parameters->all()) {
      lines += std::string(info->key) + " | " + parameter.word + " | " + parameter.name + " | " +
               parameter.group + " | " + std::to_string(parameter.id) + " | " +
               parameter_text(parameter, parameter.initial) + " |";
      for (const std::string& choice : parameter.choices) lines += " " + choice + ",";
      if (parameter.choices.empty()) {
        lines += " " + parameter_text(parameter, parameter.low) + " to " +
                 parameter_text(parameter, parameter.high);
      }
      lines += "\n";
    }
  }
  return lines;
}

// Sessions name parameters by place, symbol and id, and states choices by their word: lines and
// choices are added, none changes.
TEST(Effect, ParametersAreThoseOfTheList) {
  const auto kept =
      base::read_file(KNOTWAVE_SOURCE_DIR "/tests/plugins/effect_parameters.txt", 1 << 20);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(parameter_lines(), *kept);
}

TEST(Effect, EveryStateThatWasEverWrittenIsReadAndWrittenTheSame) {
  int count = 0;
  for (const PluginInfo* info : {&shaper_info(), &crossfade_info()}) {
    for (const auto& entry : std::filesystem::directory_iterator(
             KNOTWAVE_SOURCE_DIR "/tests/plugins/states/" + std::string(info->key))) {
      const auto text = base::read_file(entry.path().string(), 1 << 20);
      ASSERT_TRUE(text) << entry.path();
      const auto plugin = info->create();
      EXPECT_EQ(refused(*plugin, *text), "") << entry.path();
      EXPECT_EQ(plugin->state(), *text) << entry.path();
      ++count;
    }
  }
  EXPECT_GE(count, 2);
}

TEST(Effect, AParameterGlidesFor5MillisecondsFromItsSample) {
  const PluginInfo& info = shaper_info();
  const auto plugin = active(info, {{"curve_a", "Straight"}, {"dc_block", "Off"}});
  const Channels in(2, std::vector<float>(1000, 0.25F));
  const auto out = play(*plugin, in, {.actions = {set_at(100, place_of(info, "output"), -6)}})[0];
  const auto quarter = static_cast<float>(0.25 * std::pow(10, -0.3));
  EXPECT_EQ(out[100], 0.25F);
  EXPECT_LT(out[101], 0.25F);
  EXPECT_NEAR(out[220], 0.25 * std::pow(10, -0.15), 1e-6);
  EXPECT_GT(out[338], quarter);
  EXPECT_EQ(out[340], quarter);
  for (std::size_t i = 101; i < 340; ++i) EXPECT_LE(out[i], out[i - 1]) << i;
}

TEST(Effect, ParametersSetBeforeItIsActivatedAreThereAtOnce) {
  const PluginInfo& info = shaper_info();
  const auto plugin = active(
      info, {{"curve_a", "Straight"}, {"curve_b", "Clip"}, {"output", "-6"}, {"dc_block", "Off"}});
  const Channels out = play(*plugin, Channels(2, std::vector<float>(10, 0.25F)));
  EXPECT_EQ(out[0][1], out[0][9]);
  EXPECT_NEAR(out[0][9], 0.25 * std::pow(10, -0.3), 1e-7);
}

TEST(Effect, ParametersBetweenBlocksAreHeardFromTheNextOne) {
  const PluginInfo& info = shaper_info();
  const std::size_t place = place_of(info, "drive");
  const auto told = active(info), played = active(info);
  told->set_parameter(place, 20);
  const Channels in = music(2, 500);
  support::expect_same(play(*told, in), play(*played, in, {.actions = {set_at(0, place, 20)}}),
                       "drive");
}

TEST(Effect, ResetIsAsIfJustActivated) {
  const PluginInfo& info = shaper_info();
  const Channels in = music(2, 2000);
  const auto plugin = active(info, {{"curve_a", "Valve"}, {"drive", "12"}});
  const Channels first = play(*plugin, in);
  plugin->set_parameter(place_of(info, "curve_a"), 6);
  play(*plugin, in);
  plugin->set_parameter(place_of(info, "curve_a"), 5);
  plugin->begin({{}, {}, 0});
  plugin->reset();
  support::expect_same(first, play(*plugin, in), "after reset");
}

TEST(Effect, ChannelsThatAreNotThereAreSilentAndUnheard) {
  const auto plugin = active(shaper_info());
  std::vector<float> out(100, 7);
  const float* const in[] = {nullptr, nullptr};
  float* const to[] = {out.data(), nullptr};
  plugin->begin({in, to, out.size()});
  plugin->render();
  EXPECT_EQ(out, std::vector<float>(100, 0));
  plugin->begin({{}, {}, 100});
  plugin->render();
}

TEST(Effect, OwnCurvesAreExchangedWhileItPlaysWithoutAClickAndFreedLater) {
  const PluginInfo& info = shaper_info();
  const auto plugin = active(info, {{"curve_a", "Own"}, {"dc_block", "Off"}});
  const Channels in(2, std::vector<float>(64, 0.5F));
  float last = 0.5F, steepest = 0;
  play(*plugin, in);
  for (int i = 0; i < 400; ++i) {
    const std::string top = i % 2 == 0 ? "-0.5" : "1";
    ASSERT_EQ(refused(*plugin, kHead + "[parameters]\ncurve_a = \"Own\"\ndc_block = \"Off\"\n" +
                                   "[curves.a]\ndegree = 1\npoints = [-1, " + top +
                                   "]\nknots = [-1, -1, 1, 1]\n"),
              "");
    plugin->collect();
    const Channels out = play(*plugin, in);
    for (const float sample : out[0]) {
      steepest = std::max(steepest, std::abs(sample - last));
      last = sample;
    }
  }
  // The step of 1.125 over 240 samples is 1.875 / 240 of it at its steepest.
  EXPECT_GT(steepest, 0.001F);
  EXPECT_LT(steepest, 1.125F * 1.9F / 240);
}

TEST(Effect, ARateThatIsNoneIsRefused) {
  const auto plugin = shaper_info().create();
  for (const double rate_hz : {0.0, 7999.0, 768001.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto activated = plugin->activate(rate_hz);
    ASSERT_FALSE(activated);
    EXPECT_EQ(activated.error().code, ErrorCode::value_out_of_range);
    EXPECT_FALSE(plugin->is_active());
  }
}

TEST(Song, RunsByTheTempoWhateverTheBlocksAre) {
  Song song;
  song.reset(48000);
  EXPECT_EQ(song.quarters_at(24000), 1);
  const auto told = [](double bpm, double quarters) {
    return Transport{bpm, quarters, true, true};
  };
  EXPECT_TRUE(song.follow(told(60, 8), 24000));
  EXPECT_EQ(song.quarters_at(72000), 9);
  // The same, in words that were rounded.
  EXPECT_FALSE(song.follow(told(60, 9.0009), 72000));
  EXPECT_EQ(song.quarters_at(120000), 10);
  EXPECT_FALSE(song.follow(told(240, 10), 120000));
  EXPECT_EQ(song.quarters_at(132000), 11);
  EXPECT_TRUE(song.follow(told(240, -2), 132000));
  EXPECT_EQ(song.quarters_at(144000), -1);
}

TEST(Song, RunsOnWhereTheHostStandsStillOrSaysNothingOrNonsense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Transport& transport :
       {Transport{120, 3, false, true}, Transport{0, 3, true, false},
        Transport{nan, nan, true, true}, Transport{1e9, 1e300, true, true}, Transport{}}) {
    Song song;
    song.reset(48000);
    EXPECT_FALSE(song.follow(transport, 12000));
    EXPECT_EQ(song.quarters_at(24000), 1);
  }
}

TEST(Exchange, WhatIsChosenOnTheWayBeginsWhenItIsOver) {
  const int a = 1, b = 2, c = 3;
  Exchange<int> exchange;
  exchange.reset(&a, 10);
  exchange.begin(0);
  EXPECT_TRUE(exchange.is_still());
  exchange.choose(&b);
  EXPECT_TRUE(exchange.uses(b));
  exchange.begin(5);
  EXPECT_EQ(exchange.steady(5), 10u);
  exchange.choose(&c);
  exchange.begin(9);
  EXPECT_EQ(exchange.from(), a);
  EXPECT_EQ(exchange.to(), b);
  EXPECT_EQ(exchange.steady(9), 6u);
  std::vector<double> weights(11);
  exchange.weights(5, weights);
  EXPECT_EQ(weights[0], 0);
  EXPECT_NEAR(weights[5], 0.5, 1e-15);
  EXPECT_EQ(weights[10], 1);
  exchange.begin(15);
  EXPECT_FALSE(exchange.uses(a));
  EXPECT_EQ(exchange.from(), b);
  EXPECT_EQ(exchange.to(), c);
  exchange.begin(25);
  EXPECT_TRUE(exchange.is_still());
  EXPECT_FALSE(exchange.uses(b));
}

}  // namespace
}  // namespace knotwave::plugins

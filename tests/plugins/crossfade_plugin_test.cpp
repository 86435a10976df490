// SPDX-License-Identifier: MIT
// Knotwave Crossfade against dsp::CrossfadeLaw, and what a player relies on.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/crossfade.h"
#include "knotwave/plugins/plugin_list.h"

#include "effect_host.h"
#include "support/seed.h"

namespace knotwave::plugins {
namespace {

using dsp::CrossfadeLaw;
using support::active;
using support::Channels;
using support::HostAction;
using support::music;
using support::place_of;
using support::play;
using support::set_at;
using support::Settings;
using support::transport_at;

std::size_t place(const std::string& word) { return place_of(crossfade_info(), word); }

CrossfadeLaw law_of(const std::string& name) {
  static const auto set =
      curves::read_curves(KNOTWAVE_SOURCE_DIR "/examples/curves/crossfades.toml").value();
  return CrossfadeLaw::create(*set.find_curve(name)).value();
}

/// A is 1 and B is 0 on the left, the other way round on the right: the outputs are the gains.
Channels gains_in(std::size_t samples) {
  Channels in(4, std::vector<float>(samples));
  std::fill(in[0].begin(), in[0].end(), 1.0F);
  std::fill(in[3].begin(), in[3].end(), 1.0F);
  return in;
}
Channels gains(const Settings& settings, std::size_t samples,
               std::vector<HostAction> actions = {}) {
  return play(*active(crossfade_info(), settings), gains_in(samples),
              {.actions = std::move(actions)});
}

/// The position of a plugin whose law is equal gain.
std::vector<float> positions(Settings settings, std::size_t samples,
                             std::vector<HostAction> actions = {}) {
  settings.emplace_back("law", "Equal gain");
  return gains(settings, samples, std::move(actions))[1];
}

TEST(CrossfadePlugin, IsTheLawOfTheEngineToTheBit) {
  const Channels in = music(4, 500);
  const std::pair<std::string, CrossfadeLaw> laws[] = {{"Equal power", CrossfadeLaw()},
                                                       {"Equal gain", CrossfadeLaw::linear()},
                                                       {"Between", law_of("between")},
                                                       {"Cut", law_of("cut")},
                                                       {"Gap", law_of("gap")}};
  for (const auto& [word, law] : laws) {
    for (const char* position : {"0", "0.125", "0.5", "0.75", "1"}) {
      const auto plugin = active(crossfade_info(), {{"law", word}, {"position", position}});
      const Channels out = play(*plugin, in);
      const dsp::GainPair gain = law.at(plugin->parameter(place("position")));
      const double a = static_cast<double>(gain.a), b = static_cast<double>(gain.b);
      for (std::size_t c = 0; c < 2; ++c) {
        for (std::size_t i = 0; i < out[c].size(); ++i) {
          const double sum =
              a * static_cast<double>(in[c][i]) + b * static_cast<double>(in[c + 2][i]);
          ASSERT_EQ(out[c][i], static_cast<float>(sum)) << word << " at " << position;
        }
      }
    }
  }
}

TEST(CrossfadePlugin, AtItsEndsASourcePassesToTheBit) {
  const Channels in = music(4, 500);
  for (const char* law : {"Equal power", "Equal gain", "Between", "Cut", "Gap"}) {
    const Channels a = play(*active(crossfade_info(), {{"law", law}, {"position", "0"}}), in);
    support::expect_same(a, {in[0], in[1]}, law);
    const Channels b = play(*active(crossfade_info(), {{"law", law}, {"position", "1"}}), in);
    support::expect_same(b, {in[2], in[3]}, law);
  }
}

TEST(CrossfadePlugin, EqualPowerKeepsThePowerWithinAMillionthOfADecibelAllTheWay) {
  const auto out = gains({{"position", "0"}}, 4800, {set_at(1000, place("position"), 1)});
  double worst = 0;
  for (std::size_t i = 0; i < out[0].size(); ++i) {
    const double a = static_cast<double>(out[0][i]), b = static_cast<double>(out[1][i]);
    worst = std::max(worst, std::abs(10 * std::log10(a * a + b * b)));
  }
  std::printf("worst %.2e dB\n", worst);
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(out[1][1000], 0);
  EXPECT_GT(out[1][1120], 0.6F);
  EXPECT_EQ(out[1][1240], 1);
}

TEST(CrossfadePlugin, ACurveOfTwoCoordinatesGivesBothGains) {
  const auto plugin = crossfade_info().create();
  const auto loaded = plugin->load_state(
      "format = 1\nkind = \"plugin\"\nplugin = \"crossfade\"\n[parameters]\nlaw = \"Own\"\n"
      "position = 0.25\n[curves.law]\ndegree = 1\npoints = [[1, 0], [0.5, 0.9], [0, 0.25]]\n");
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  ASSERT_TRUE(plugin->activate(48000));
  const Channels out = play(*plugin, gains_in(10));
  EXPECT_FLOAT_EQ(out[0][0], 0.75F);
  EXPECT_FLOAT_EQ(out[1][0], 0.45F);
  EXPECT_FALSE(
      plugin->load_state("format = 1\nkind = \"plugin\"\nplugin = \"crossfade\"\n"
                         "[curves.law]\ndegree = 1\npoints = [[1, 0, 0], [0.5, 0.9, 0]]\n"));
}

TEST(CrossfadePlugin, TheMotionFollowsTheSong) {
  const Settings settings = {
      {"source", "Motion"}, {"motion", "Ramp"}, {"beats", "4 beats"}, {"smooth", "0"}};
  const auto at =
      positions(settings, 200000,
                {transport_at(0, {120, 1, true, true}), transport_at(48000, {120, 3, true, true}),
                 transport_at(100000, {60, 100, true, true})});
  // 120 beats a minute: 4 beats are 96000 samples.
  EXPECT_FLOAT_EQ(at[0], 0.25F);
  EXPECT_FLOAT_EQ(at[24000], 0.5F);
  EXPECT_FLOAT_EQ(at[48000], 0.75F);
  EXPECT_FLOAT_EQ(at[72000], 0);
  EXPECT_FLOAT_EQ(at[72000 - 1], 1 - 1 / 96000.0F);
  EXPECT_FLOAT_EQ(at[100000], 0);
  EXPECT_FLOAT_EQ(at[196000], 0.5F);
}

TEST(CrossfadePlugin, TheMotionRunsOnWhereTheHostStandsStill) {
  const Settings settings = {
      {"source", "Motion"}, {"motion", "Ramp"}, {"beats", "4 beats"}, {"smooth", "0"}};
  const auto alone = positions(settings, 96000);
  EXPECT_FLOAT_EQ(alone[24000], 0.25F);
  const auto stopped =
      positions(settings, 96000,
                {transport_at(0, {60, 2, true, true}), transport_at(48000, {60, 3, false, true})});
  EXPECT_FLOAT_EQ(stopped[48000], 0.75F);
  EXPECT_FLOAT_EQ(stopped[72000], 0.875F);
}

TEST(CrossfadePlugin, AJumpOfTheSongIsSmoothedAsItSays) {
  const Settings settings = {
      {"source", "Motion"}, {"motion", "Ramp"}, {"beats", "128 beats"}, {"smooth", "10"}};
  const auto at =
      positions(settings, 6000,
                {transport_at(0, {120, 0, true, true}), transport_at(1000, {120, 64, true, true})});
  EXPECT_NEAR(at[999], 0, 1e-3);
  // Time constant 10 ms = 480 samples.
  EXPECT_NEAR(at[1479], 0.5 * (1 - std::exp(-1)), 1e-3);
  EXPECT_NEAR(at[5999], 0.5 + 5000 / 3072000.0, 1e-3);
}

TEST(CrossfadePlugin, TheLoudnessOfTheSecondInputMovesIt) {
  constexpr std::size_t kSize = 48000;
  Channels in = gains_in(kSize);
  for (std::size_t c = 2; c < 4; ++c) std::fill(in[c].begin(), in[c].end(), 0.0F);
  const float loud = static_cast<float>(std::pow(10, -34 / 20.0));
  for (std::size_t c = 2; c < 4; ++c) std::fill(in[c].begin() + 4800, in[c].begin() + 24000, loud);
  const auto plugin = active(crossfade_info(), {{"law", "Equal gain"},
                                                {"position", "0"},
                                                {"source", "Audio"},
                                                {"threshold", "-40"},
                                                {"range", "12"},
                                                {"attack", "10"},
                                                {"release", "100"}});
  const auto out = play(*plugin, in)[0];  // 1 - position + position * B
  const auto position = [&](std::size_t i) {
    const double b = static_cast<double>(in[2][i]);
    return (1 - static_cast<double>(out[i])) / (1 - b);
  };
  EXPECT_EQ(out[4799], 1);
  // The power's time constant is 10 ms: 6 dB are reached from 1 - e^-t = 10^-0.6 on.
  EXPECT_NEAR(position(4800 + 480), (6 + 10 * std::log10(1 - std::exp(-1))) / 12, 2e-3);
  EXPECT_NEAR(position(23999), 0.5, 1e-3);
  // 100 ms: 4.34 dB.
  EXPECT_NEAR(position(24000 + 4800), (6 - 10 * std::log10(std::exp(1))) / 12, 2e-3);
  EXPECT_EQ(out[47999], 1);
}

TEST(CrossfadePlugin, TheAmountSaysHowFarTheSourceCarriesItAndWhichWay) {
  const auto at = [&](const std::string& amount) {
    return positions({{"position", "0.5"},
                      {"source", "Motion"},
                      {"motion", "Ramp"},
                      {"phase", "0.75"},
                      {"beats", "128 beats"},
                      {"amount", amount}},
                     1)[0];
  };
  EXPECT_FLOAT_EQ(at("1"), 0.75F);
  EXPECT_FLOAT_EQ(at("0.5"), 0.625F);
  EXPECT_FLOAT_EQ(at("0"), 0.5F);
  EXPECT_FLOAT_EQ(at("-0.5"), 0.375F);
  EXPECT_FLOAT_EQ(at("-1"), 0.25F);
}

std::vector<HostAction> automation() {
  const auto word = [](const char* name) { return place(name); };
  std::vector<HostAction> actions = {transport_at(0, {133, 7, true, true}),
                                     set_at(30, word("position"), 0.9),
                                     set_at(100, word("source"), 1),
                                     set_at(130, word("motion"), 4),
                                     set_at(300, word("beats"), 1),
                                     transport_at(301, {133, 2, true, true}),
                                     set_at(500, word("law"), 5),
                                     set_at(520, word("law"), 2),
                                     set_at(700, word("source"), 2),
                                     set_at(701, word("threshold"), -20),
                                     set_at(900, word("attack"), 1),
                                     set_at(905, word("source"), 1),
                                     set_at(1146, word("source"), 0),
                                     set_at(1390, word("source"), 1),
                                     set_at(1400, word("amount"), -0.5),
                                     set_at(1401, word("smooth"), 9),
                                     transport_at(1500, {90, 50, false, true}),
                                     set_at(1700, word("output"), -9)};
  for (int i = 0; i < 40; ++i) actions.push_back(set_at(1800 + 7 * i, word("position"), i / 40.0));
  return actions;
}

TEST(CrossfadePlugin, BlockSizeDoesNotMatterNorWhetherItWorksInPlace) {
  support::expect_any_blocks_the_same([] { return active(crossfade_info()); }, music(4, 2500),
                                      automation());
}

TEST(CrossfadePlugin, SoundsAsItAlwaysDid) {
  const auto plugin = active(crossfade_info());
  EXPECT_EQ(support::hash_of(play(*plugin, music(4, 48000), {.actions = automation()})),
            "9aeb7722a9cffdeafed80a6b0afcddf88fe2d0b96d517e658a4bca4264547af6");
}

TEST(CrossfadePlugin, SilenceInIsSilenceOutAndIdle) {
  const auto plugin = active(crossfade_info(), {{"source", "Audio"}});
  play(*plugin, music(4, 100));
  EXPECT_FALSE(plugin->is_idle());
  EXPECT_EQ(support::loudest(play(*plugin, Channels(4, std::vector<float>(100)))), 0);
  EXPECT_TRUE(plugin->is_idle());
  EXPECT_FALSE(plugin->may_sleep()) << "what input B was is forgotten by and by";
  EXPECT_EQ(plugin->tail_samples(), 0);
}

TEST(CrossfadePlugin, NoInputAndNoAutomationGivesNanOrPoisonsIt) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array<float, 6> odd = {nan, INFINITY, -INFINITY, 1e-42F, -3e38F, -0.0F};
  const base::RandomStream random{support::test_seed(), 0, 6202};
  const auto plugin = active(crossfade_info());
  const auto& table = *crossfade_info().parameters;
  std::uint64_t draw = 0;
  const auto number = [&] {
    const bool is_nan = random.bits(draw++) % 9 == 0;
    return is_nan ? std::numeric_limits<double>::quiet_NaN() : 60 * random.bipolar(draw++);
  };
  for (int round = 0; round < support::test_count(30); ++round) {
    Channels in = music(4, 1000, 3);
    std::vector<HostAction> actions;
    for (std::int64_t i = 0; i < 1000; i += 1 + std::int64_t(random.bits(draw++) % 30)) {
      auto& channel = in[random.bits(draw++) % 4];
      channel[std::size_t(i)] = odd[random.bits(draw++) % odd.size()];
      actions.push_back(set_at(i, random.bits(draw++) % (table.size() + 1), number()));
      const double bpm = number();
      actions.push_back(transport_at(i, {bpm, number(), i % 2 == 0, i % 3 == 0}));
    }
    support::loudest(play(*plugin, in, {.actions = actions}));
  }
  for (std::size_t i = 0; i < table.size(); ++i) plugin->set_parameter(i, table[i].initial);
  play(*plugin, Channels(4, std::vector<float>(4800)));
  const Channels in = music(4, 3000);
  support::expect_same(play(*plugin, in), play(*active(crossfade_info()), in), "afterwards");
}

}  // namespace
}  // namespace knotwave::plugins

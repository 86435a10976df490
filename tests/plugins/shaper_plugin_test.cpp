// SPDX-License-Identifier: MIT
// Knotwave Shaper against dsp::Shaper, and what a player relies on.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/elementary.h"
#include "knotwave/base/random.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/shaper.h"
#include "knotwave/plugins/plugin_list.h"

#include "effect_host.h"
#include "support/seed.h"
#include "support/spectrum.h"

namespace knotwave::plugins {
namespace {

using dsp::ShaperProgram;
using support::active;
using support::Channels;
using support::expect_same;
using support::HostAction;
using support::music;
using support::place_of;
using support::play;
using support::set_at;
using support::Settings;

ShaperProgram program_of(const std::string& name) {
  static const auto set =
      curves::read_curves(KNOTWAVE_SOURCE_DIR "/examples/curves/shapers.toml").value();
  return ShaperProgram::create(*set.find_curve(name)).value();
}

std::vector<float> shaped(const ShaperProgram& program, const std::vector<float>& in, double drive,
                          float mix) {
  std::vector<float> out(in.size());
  const std::vector<float> drives(in.size(), static_cast<float>(base::db_to_gain(drive)));
  dsp::Shaper shaper;
  shaper.render(program, drives, mix, in, out);
  return out;
}

std::size_t place(const std::string& word) { return place_of(shaper_info(), word); }
Channels played(const Settings& settings, const Channels& in) {
  return play(*active(shaper_info(), settings), in);
}

TEST(ShaperPlugin, IsTheShaperOfTheEngineToTheBit) {
  const Channels in = music(2, 3000);
  const auto& choices = (*shaper_info().parameters)[place("curve_a")].choices;
  for (std::size_t choice = 1; choice < choices.size(); ++choice) {
    std::string name = choices[choice];
    name[0] = static_cast<char>(name[0] - 'A' + 'a');
    for (const double drive : {0.0, 9.0}) {
      for (const float mix : {1.0F, 0.5F, 0.0F}) {
        const Channels out = played({{"curve_a", choices[choice]},
                                     {"drive", drive == 0 ? "0" : "9"},
                                     {"mix", mix == 1   ? "1"
                                             : mix == 0 ? "0"
                                                        : "0.5"},
                                     {"dc_block", "Off"}},
                                    in);
        const ShaperProgram program = program_of(name);
        expect_same(out, {shaped(program, in[0], drive, mix), shaped(program, in[1], drive, mix)},
                    name);
      }
    }
  }
}

TEST(ShaperPlugin, TheMorphIsTheBlendOfBothShapers) {
  const Channels in = music(2, 2000);
  const auto morphed = [&](const std::string& morph) {
    return played({{"curve_a", "Valve"},
                   {"curve_b", "Fold"},
                   {"morph", morph},
                   {"drive", "6"},
                   {"dc_block", "Off"}},
                  in);
  };
  const auto valve = shaped(program_of("valve"), in[0], 6, 1);
  const auto fold = shaped(program_of("fold"), in[0], 6, 1);
  EXPECT_EQ(morphed("0")[0], valve);
  EXPECT_EQ(morphed("1")[0], fold);
  const auto middle = morphed("0.25")[0];
  for (std::size_t i = 0; i < middle.size(); ++i) {
    EXPECT_NEAR(middle[i],
                0.75 * static_cast<double>(valve[i]) + 0.25 * static_cast<double>(fold[i]), 1.2e-7);
  }
}

TEST(ShaperPlugin, TheBiasMovesAlongTheCurve) {
  const Channels in = music(2, 1000, 0.4F);
  Channels moved = in;
  for (auto& channel : moved) {
    for (float& sample : channel) sample += 0.25F;
  }
  const Channels plain = played({{"curve_a", "Valve"}, {"dc_block", "Off"}}, moved);
  const Channels biased = played({{"curve_a", "Valve"}, {"bias", "0.25"}, {"dc_block", "Off"}}, in);
  for (std::size_t i = 1; i < in[0].size(); ++i) EXPECT_NEAR(plain[0][i], biased[0][i], 1e-6) << i;
}

TEST(ShaperPlugin, TheDcBlockTakesAwayWhatACurveAddsAndLeavesTheRest) {
  constexpr std::size_t kSize = 48000;
  Channels in(2, std::vector<float>(2 * kSize));
  for (std::size_t i = 0; i < 2 * kSize; ++i) {
    in[0][i] = in[1][i] =
        static_cast<float>(0.5 * base::sin_cos_cycles(static_cast<double>(i) * 100 / kSize).sin);
  }
  const auto mean = [&](const std::string& block) {
    const auto out = played({{"curve_a", "Full"}, {"dc_block", block}}, in)[0];
    double sum = 0;
    for (std::size_t i = kSize; i < 2 * kSize; ++i) sum += static_cast<double>(out[i]);
    return sum / kSize;
  };
  EXPECT_GT(mean("Off"), 0.3);
  EXPECT_LT(std::abs(mean("On")), 1e-5);
  const auto on = played({{"curve_a", "Straight"}}, in)[0];
  const auto off = played({{"curve_a", "Straight"}, {"dc_block", "Off"}}, in)[0];
  double most_on = 0, most_off = 0;
  for (std::size_t i = kSize; i < 2 * kSize; ++i) {
    most_on = std::max(most_on, static_cast<double>(on[i]));
    most_off = std::max(most_off, static_cast<double>(off[i]));
  }
  EXPECT_NEAR(20 * std::log10(most_on / most_off), 0, 0.03);
}

TEST(ShaperPlugin, SilenceInIsSilenceOutWithAnyCurveAndBias) {
  const Channels silence(2, std::vector<float>(4800));
  for (const char* curve : {"Valve", "Full", "Fold"}) {
    const auto plugin = active(shaper_info(), {{"curve_a", curve}, {"bias", "0.3"}});
    EXPECT_EQ(support::loudest(play(*plugin, silence)), 0) << curve;
    play(*plugin, music(2, 4800, 100));
    plugin->begin({{}, {}, 0});
    plugin->reset();
    EXPECT_EQ(support::loudest(play(*plugin, silence)), 0) << curve;
  }
}

TEST(ShaperPlugin, ItsTailIsAsLongAsItSays) {
  const auto plugin = active(shaper_info(), {{"curve_a", "Valve"}, {"drive", "40"}});
  Channels in = music(2, 96000);
  for (auto& channel : in) std::fill(channel.begin() + 9600, channel.end(), 0.0F);
  const Channels out = play(*plugin, in);
  const auto tail = static_cast<std::size_t>(plugin->tail_samples());
  for (std::size_t i = 9600 + tail; i < 96000; ++i) ASSERT_LE(std::abs(out[0][i]), 1e-6F) << i;
  EXPECT_TRUE(plugin->is_idle());
  EXPECT_TRUE(plugin->may_sleep());
  play(*plugin, music(2, 64));
  EXPECT_FALSE(plugin->is_idle());
}

/// Something of everything, at odd samples.
std::vector<HostAction> automation() {
  std::vector<HostAction> actions = {
      set_at(50, place("drive"), 24),     set_at(51, place("drive"), 3),
      set_at(300, place("curve_a"), 6),   set_at(400, place("curve_a"), 0),
      set_at(430, place("curve_b"), 5),   set_at(431, place("morph"), 0.7),
      set_at(700, place("bias"), -0.4),   set_at(701, place("mix"), 0.3),
      set_at(900, place("dc_block"), 0),  set_at(950, place("output"), -20),
      set_at(1200, place("dc_block"), 1), set_at(1201, place("curve_a"), 7)};
  for (int i = 0; i < 40; ++i) actions.push_back(set_at(1300 + 7 * i, place("morph"), i / 40.0));
  return actions;
}

TEST(ShaperPlugin, BlockSizeDoesNotMatterNorWhetherItWorksInPlace) {
  support::expect_any_blocks_the_same(
      [] {
        return active(shaper_info(), {{"curve_a", "Valve"}});
      },
      music(2, 2500), automation());
}

TEST(ShaperPlugin, SoundsAsItAlwaysDid) {
  const auto plugin = active(shaper_info(), {{"curve_a", "Valve"}});
  EXPECT_EQ(support::hash_of(play(*plugin, music(2, 48000), {.actions = automation()})),
            "932ac25b8a7c22fbf405b76be8c2e2289160b4d76d7c7d6499a8a0c063229e5b");
}

/// Of a filter that has rested: loud direct current, and the switch.
TEST(ShaperPlugin, SwitchingTheDirectCurrentBlockDoesNotClick) {
  constexpr std::int64_t kOff = 9600, kOn = 19200;
  const std::size_t place = place_of(shaper_info(), "dc_block");
  Channels in(2, std::vector<float>(28800));
  for (auto& channel : in) {
    for (std::size_t i = 0; i < channel.size(); ++i) {
      channel[i] = 0.4F + 0.3F * static_cast<float>(std::sin(0.01 * static_cast<double>(i)));
    }
  }
  const auto plugin = active(shaper_info(), {{"curve_a", "Straight"}});
  const Channels out =
      play(*plugin, in, {.actions = {set_at(kOff, place, 0), set_at(kOn, place, 1)}});
  const auto steepest = [&](std::int64_t from, std::int64_t to) {
    float most = 0;
    for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(to); ++i) {
      most = std::max(most, std::abs(out[0][i] - out[0][i - 1]));
    }
    return most;
  };
  // 0.4 in 5 ms is 0.0031 a sample at its steepest; the sine has 0.003.
  EXPECT_LT(steepest(4800, kOn), 0.0065F);
  // It begins where the signal is, and comes to rest around 0 without a step.
  EXPECT_LT(steepest(kOn, 28800), 0.0065F);
  EXPECT_NEAR(*std::max_element(out[0].end() - 1000, out[0].end()), 0.3, 0.02);
}

TEST(ShaperPlugin, NoInputAndNoAutomationGivesNanOrPoisonsIt) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array<float, 6> odd = {nan, INFINITY, -INFINITY, 1e-42F, -3e38F, -0.0F};
  const base::RandomStream random{support::test_seed(), 0, 6201};
  const auto plugin = active(shaper_info());
  const auto& table = *shaper_info().parameters;
  std::uint64_t draw = 0;
  for (int round = 0; round < support::test_count(30); ++round) {
    Channels in = music(2, 1000, 3);
    std::vector<HostAction> actions;
    for (std::int64_t i = 0; i < 1000; i += 1 + std::int64_t(random.bits(draw++) % 30)) {
      auto& channel = in[random.bits(draw++) % 2];
      channel[std::size_t(i)] = odd[random.bits(draw++) % odd.size()];
      const std::size_t where = random.bits(draw++) % (table.size() + 1);
      const double value = random.bits(draw++) % 9 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                                        : 60 * random.bipolar(draw++);
      actions.push_back(set_at(i, where, value));
    }
    support::loudest(play(*plugin, in, {.actions = actions}));
  }
  for (std::size_t i = 0; i < table.size(); ++i) plugin->set_parameter(i, table[i].initial);
  play(*plugin, Channels(2, std::vector<float>(96000)));
  const Channels in = music(2, 3000);
  const Channels after = play(*plugin, in);
  const Channels fresh = play(*active(shaper_info()), in);
  for (std::size_t i = 0; i < 3000; ++i) ASSERT_NEAR(after[0][i], fresh[0][i], 1e-6) << i;
}

TEST(ShaperPlugin, HalfASampleIsAllItsLatency) {
  Channels in(2, std::vector<float>(10));
  in[0][4] = 0.5F;
  const auto out = played({{"curve_a", "Straight"}, {"dc_block", "Off"}}, in)[0];
  EXPECT_EQ(out, (std::vector<float>{0, 0, 0, 0, 0.25F, 0.25F, 0, 0, 0, 0}));
}

// A sine at -1 dBFS through the clip: what is no harmonic, below 18 kHz, beside the same without
// anti-aliasing.
TEST(ShaperPlugin, LowersTheAliasesOfTheClip) {
  constexpr std::size_t kSize = 1 << 14;
  const ShaperProgram program = program_of("clip");
  for (const double frequency_hz : {440.0, 1244.0, 2637.0}) {
    const int bin = support::coherent_bin(frequency_hz, 48000, kSize);
    Channels in(2, std::vector<float>(2 * kSize));
    std::vector<float> plain(kSize);
    for (std::size_t i = 0; i < 2 * kSize; ++i) {
      const double cycles =
          static_cast<double>((i * static_cast<std::size_t>(bin)) % kSize) / kSize;
      in[0][i] = in[1][i] = static_cast<float>(0.9 * base::sin_cos_cycles(cycles).sin);
      if (i < kSize) {
        plain[i] =
            static_cast<float>(program.at(base::db_to_gain(12) * static_cast<double>(in[0][i])));
      }
    }
    const auto sum_db = [&](std::span<const float> samples) {
      const auto lines = support::line_spectrum(samples);
      double power = 0, worst = 0;
      for (std::size_t b = 1; b * 48000 < 18000 * kSize; ++b) {
        if (b % static_cast<std::size_t>(bin) == 0) continue;
        power += std::norm(lines[b]);
        worst = std::max(worst, std::abs(lines[b]));
      }
      return std::pair{10 * std::log10(power), support::decibels(worst)};
    };
    const auto out = played({{"curve_a", "Clip"}, {"drive", "12"}, {"dc_block", "Off"}}, in)[0];
    const auto before = sum_db(plain);
    const auto after = sum_db(std::span(out).last(kSize));
    std::printf("%.0f Hz: sum %.1f -> %.1f dBFS, worst line %.1f -> %.1f dBFS\n", frequency_hz,
                before.first, after.first, before.second, after.second);
    EXPECT_LT(after.first, before.first - 9);
  }
}

}  // namespace
}  // namespace knotwave::plugins

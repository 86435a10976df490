// SPDX-License-Identifier: MIT
// The LV2 plugins as a host has them.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"

#include "lv2_host.h"
#include "support/program.h"

namespace knotwave::test {
namespace {

using plugins::PluginInfo;

std::string folder_of(const PluginInfo& info) {
  return KNOTWAVE_BIN_DIR "/../plugins/lv2/" + file_of(info) + ".lv2/";
}
std::string binary_of(const PluginInfo& info) { return folder_of(info) + file_of(info) + ".so"; }

std::vector<const PluginInfo*> those_with_notes() {
  std::vector<const PluginInfo*> those;
  std::ranges::copy_if(plugins::all_plugins(), std::back_inserter(those),
                       [](const PluginInfo* info) { return info->takes_midi; });
  return those;
}

class Lv2 : public testing::TestWithParam<const PluginInfo*> {
 protected:
  const PluginInfo& info() const { return *GetParam(); }
  std::unique_ptr<Lv2Plugin> plugin(double rate_hz = 48000) const {
    auto made = std::make_unique<Lv2Plugin>(info(), binary_of(info()), rate_hz);
    made->activate();
    return made;
  }
};

INSTANTIATE_TEST_SUITE_P(Plugins, Lv2, testing::ValuesIn(plugins::all_plugins()),
                         [](const auto& named) { return std::string(named.param->key); });

/// Those that take MIDI.
class Lv2Notes : public Lv2 {};
INSTANTIATE_TEST_SUITE_P(Plugins, Lv2Notes, testing::ValuesIn(those_with_notes()),
                         [](const auto& named) { return std::string(named.param->key); });

bool all_of(const Channels& sound, bool (*holds)(float)) {
  return std::ranges::all_of(
      sound, [&](const auto& channel) { return std::ranges::all_of(channel, holds); });
}
bool is_silent(const Channels& sound) {
  return all_of(sound, [](float x) { return x == 0; });
}
bool is_finite(const Channels& sound) {
  return all_of(sound, [](float x) { return std::isfinite(x); });
}

// Voltages too, which no other format shows.
TEST_P(Lv2, SoundsAsThePluginItselfToTheBit) {
  for (const double rate_hz : {44100.0, 48000.0, 96000.0}) {
    for (const std::size_t block : {480u, 17u, 2027u}) {
      const Story story = story_of(info(), 12000);
      const Channels sound = plugin(rate_hz)->play(story, block);
      EXPECT_FALSE(is_silent(sound));
      EXPECT_TRUE(sound == played_by_itself(info(), story, rate_hz, block, Points::at_the_block))
          << rate_hz << ' ' << block;
    }
  }
}

TEST_P(Lv2, AStateComesBackWholeAndIsTheTextOfEveryFormat) {
  const auto one = plugin(), two = plugin();
  Story story;
  story.frames = 64;
  for (std::size_t i = 0; i < info().parameters->size(); ++i) story.points.push_back({0, i, 0.3});
  one->run(story);
  const std::string state = one->save();
  EXPECT_TRUE(two->load(state));
  EXPECT_EQ(two->save(), state);
  EXPECT_TRUE(info().create()->load_state(state));
}

TEST_P(Lv2, ADamagedStateIsRefusedAndNothingChanges) {
  const auto played = plugin();
  const std::string state = played->save();
  for (const std::string& text :
       {std::string("x"), state + "x", state.substr(0, state.size() / 2)}) {
    EXPECT_FALSE(played->load(text));
    EXPECT_EQ(played->save(), state);
  }
}

// Also in the middle of blocks.
TEST_P(Lv2, FollowsTheSongOfTheHostToTheSample) {
  for (const std::size_t off : {0u, 123u}) {
    const Story story = story_with_song(info(), 480, off);
    const Channels expected = played_by_itself(info(), story, 48000, 480, Points::at_the_block);
    for (const std::size_t block : {480u, 4800u}) {
      EXPECT_TRUE(plugin()->play(story, block) == expected) << off << ' ' << block;
    }
    Story silent = story;
    silent.song.clear();
    const bool follows = info().key == "curve" || info().key == "crossfade";
    EXPECT_TRUE(!follows ||
                played_by_itself(info(), silent, 48000, 480, Points::at_the_block) != expected);
  }
}

TEST_P(Lv2Notes, GivesTheMidiOfThePluginItself) {
  const Story story = story_for_midi(info());
  const auto played = plugin();
  played->play(story, 480);
  EXPECT_EQ(played->given().empty(), !info().gives_midi);
  EXPECT_TRUE(played->given() == midi_given_by_itself(info(), story, 480));
}

TEST_P(Lv2, FollowsTheRunningBeatOfAHostWithoutATimeSignature) {
  Story story = story_with_song(info(), 480, 7);
  story.song.resize(2);
  for (Story::Song& told : story.song) told.has_signature = false;
  EXPECT_TRUE(plugin()->play(story, 480) ==
              played_by_itself(info(), story, 48000, 480, Points::at_the_block));
}

TEST_P(Lv2, SurvivesAnyTimeSignatureAndPlace) {
  const auto played = plugin();
  Story story;
  story.frames = 64;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const auto& [beats, unit] :
       {std::pair{1, 8}, {0, 0}, {4, 0}, {0, 4}, {-1, -1}, {1, 1 << 30}}) {
    for (const double quarters : {-1e300, -0.5, 1e18, infinity, nan}) {
      for (const double bpm : {120.0, 0.0, -1.0, 1e300, infinity, nan}) {
        story.song = {{0, {bpm, quarters, true, true}, beats, unit},
                      {70, {bpm, quarters, true, true}}};
        EXPECT_TRUE(is_finite(played->run(story))) << beats << '/' << unit;
      }
    }
  }
}

TEST_P(Lv2Notes, AHeldNoteEndsWhereTheHostSwitchesOff) {
  const auto played = plugin();
  Story held, quiet;
  held.frames = quiet.frames = 4800;
  held.midi = {{0, {0x90, 60, 127}}, {2, {0xB0, 64, 127}}};
  EXPECT_TRUE(is_finite(played->run(held)));
  played->deactivate();
  played->activate();
  const Channels sound = played->run(quiet);
  EXPECT_TRUE(is_finite(sound));
  if (info().kind == PluginInfo::Kind::instrument) {
    EXPECT_TRUE(is_silent(sound));
  }
}

TEST_P(Lv2, ShowsNothingButItsEntries) {
  const auto run = support::run_program(
      {"/usr/bin/nm", "-D", "--defined-only", "--format=just-symbols", binary_of(info())});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "lv2_descriptor\nlv2_generate_ttl\n");
}

TEST_P(Lv2, SixtyFourInstancesOfTwoThreadsPlayTheSame) {
  const Story story = story_of(info(), 2400);
  const Channels expected = played_by_itself(info(), story, 48000, 480, Points::at_the_block);
  const auto kept = plugin();  // so that neither thread unloads the file under the other
  std::array<int, 2> same{};
  const auto play = [&](int& count) {
    std::vector<std::unique_ptr<Lv2Plugin>> all;
    for (int i = 0; i < 32; ++i) {
      all.push_back(plugin());
      if (i % 8 != 0) continue;
      count += all.back()->play(story, 480) == expected && all.back()->load(all.back()->save());
    }
    while (!all.empty()) all.erase(all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2));
  };
  std::thread other([&] { play(same[0]); });
  play(same[1]);
  other.join();
  EXPECT_EQ(same[0], 4);
  EXPECT_EQ(same[1], 4);
}

/// The text between the next two """ from `from` on, as Turtle reads it.
std::string next_long_string(const std::string& turtle, std::size_t& from) {
  std::string read;
  from = turtle.find("\"\"\"", from);
  if (from == std::string::npos) return read;
  for (from += 3; turtle.compare(from, 3, "\"\"\"") != 0; ++from) {
    if (turtle[from] == '\\') ++from;
    read += turtle[from];
  }
  from += 3;
  return read;
}

TEST_P(Lv2, ThePresetsOfTheBundleAreTheStatesOfThePlugin) {
  const auto turtle = base::read_file(folder_of(info()) + "presets.ttl", 64 << 20);
  ASSERT_TRUE(turtle) << turtle.error().message;
  std::size_t from = 0;
  for (std::size_t i = 0; i < info().presets.size(); ++i) {
    const auto itself = info().create();
    ASSERT_TRUE(itself->load_preset(i));
    EXPECT_EQ(next_long_string(*turtle, from), itself->state()) << info().presets[i];
  }
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// The VST3 modules as a host has them.
#include <algorithm>
#include <clocale>
#include <cmath>
#include <iterator>
#include <thread>

#include <gtest/gtest.h>

#include "story.h"
#include "support/background_program.h"
#include "support/program.h"
#include "vst3_host.h"

namespace knotwave::test {
namespace {

using plugins::PluginInfo;

std::string bundle_of(const PluginInfo& info) {
  return KNOTWAVE_BIN_DIR "/../plugins/vst3/" + file_of(info) + ".vst3";
}

std::vector<const PluginInfo*> those_with_notes() {
  std::vector<const PluginInfo*> those;
  std::ranges::copy_if(plugins::all_plugins(), std::back_inserter(those),
                       [](const PluginInfo* info) { return info->takes_midi; });
  return those;
}

class Vst3 : public testing::TestWithParam<const PluginInfo*> {
 protected:
  const PluginInfo& info() const { return *GetParam(); }
  std::unique_ptr<Vst3Plugin> plugin() const { return std::make_unique<Vst3Plugin>(module_); }
  Channels audible(Channels all) const {
    all.resize(audio_channels(info().outputs));
    return all;
  }

  Vst3Module module_{bundle_of(info())};
};

INSTANTIATE_TEST_SUITE_P(Plugins, Vst3, testing::ValuesIn(plugins::all_plugins()),
                         [](const auto& named) { return std::string(named.param->key); });

/// Those that take MIDI.
class Vst3Notes : public Vst3 {};
INSTANTIATE_TEST_SUITE_P(Plugins, Vst3Notes, testing::ValuesIn(those_with_notes()),
                         [](const auto& named) { return std::string(named.param->key); });

bool is_silent(const Channels& sound) {
  return std::ranges::all_of(sound, [](const auto& channel) {
    return std::ranges::all_of(channel, [](float x) { return x == 0; });
  });
}
bool is_finite(const Channels& sound) {
  return std::ranges::all_of(sound, [](const auto& channel) {
    return std::ranges::all_of(channel, [](float x) { return std::isfinite(x); });
  });
}

// Parameters move at their samples, which DPF as it comes has not.
TEST_P(Vst3, SoundsAsThePluginItselfToTheBit) {
  for (const double rate_hz : {44100.0, 48000.0, 96000.0}) {
    const Story story = story_of(info(), 24000);
    const auto played = plugin();
    ASSERT_TRUE(played->start(rate_hz, 512));
    const Channels sound = played->play(story, 480);
    EXPECT_FALSE(is_silent(sound));
    EXPECT_TRUE(sound == audible(played_by_itself(info(), story, rate_hz, 480))) << rate_hz;
  }
}

TEST_P(Vst3, BlocksOfAnySizeGiveTheSameSamples) {
  const Story story = story_of(info(), 12000);
  const Channels whole = audible(played_by_itself(info(), story, 48000, 12000));
  for (const std::size_t block : {1u, 17u, 256u, 2027u, 12000u}) {
    const auto played = plugin();
    ASSERT_TRUE(played->start(48000, 16384));
    EXPECT_TRUE(played->play(story, block) == whole) << block;
  }
}

TEST_P(Vst3, AStateComesBackWholeAlsoInPiecesOf17Bytes) {
  const auto one = plugin(), two = plugin();
  ASSERT_TRUE(one->start(48000, 512));
  Story story;
  story.frames = 64;
  for (std::size_t i = 0; i < info().parameters->size(); ++i) {
    story.points.push_back({i, i, 0.123 + 0.001 * static_cast<double>(i)});
  }
  one->process(story);
  const std::string state = one->save();
  EXPECT_EQ(state, one->save(17));
  ASSERT_TRUE(two->load(state, 17));
  EXPECT_EQ(two->save(), state);
  const auto itself = info().create();
  ASSERT_TRUE(itself->load_state(state)) << "is the text that every format has";
  for (const auto& parameter : one->parameters()) {
    const auto value = [&](const Vst3Plugin& of) {
      return v3_cpp_obj(of.controller())
          ->get_parameter_normalised(of.controller(), parameter.param_id);
    };
    EXPECT_EQ(value(*one), value(*two));
  }
}

TEST_P(Vst3, ADamagedStateIsRefusedAndNothingChanges) {
  const auto played = plugin();
  const std::string state = played->save();
  for (const std::string& text :
       {std::string(), std::string("x"), std::string(1 << 20, '\0'), state + "x",
        state.substr(0, state.size() / 2), std::string("__dpf_program__\0001\0", 18)}) {
    EXPECT_FALSE(played->load(text)) << text.substr(0, 40);
    EXPECT_EQ(played->save(), state);
  }
}

/// Debian: the package locales; localedef writes it into a folder of the test's own.
class GermanLocale {
 public:
  GermanLocale() {
    const auto made = support::run_program(
        {"/usr/bin/localedef", "-i", "de_DE", "-f", "UTF-8", folder_.file("de_DE.UTF-8")});
    path_ = std::make_unique<support::SetVariable>("LOCPATH", folder_.path());
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    EXPECT_TRUE(is_set_) << "apt-get install locales: " << made.err;
  }
  ~GermanLocale() { std::setlocale(LC_ALL, "C"); }

 private:
  support::ScratchFolder folder_;
  std::unique_ptr<support::SetVariable> path_;
  bool is_set_ = false;
};

TEST_P(Vst3, AHostInGermanGetsTheSameStatesAndTexts) {
  const auto seen = [&] {
    const auto played = plugin();
    EXPECT_TRUE(played->start(48000, 512));
    Story story;
    story.frames = 64;
    story.points = {{1, 0, 0.123}};
    played->process(story);
    std::string all = played->save();
    for (const auto& parameter : played->parameters()) {
      v3_str_128 text{};
      double back = -1;
      EXPECT_EQ(
          v3_cpp_obj(played->controller())
              ->get_parameter_string_for_value(played->controller(), parameter.param_id, 0.3, text),
          V3_OK);
      EXPECT_EQ(v3_cpp_obj(played->controller())
                    ->get_parameter_value_for_string(played->controller(), parameter.param_id, text,
                                                     &back),
                V3_OK);
      for (const int letter : text) {
        if (letter == 0) break;
        all += static_cast<char>(letter);
      }
      all += ' ' + std::to_string(std::llround(back * 1e6)) + '\n';
    }
    EXPECT_TRUE(played->load(played->save()));
    return all;
  };
  const std::string in_english = seen();
  const GermanLocale german;
  ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  EXPECT_EQ(seen(), in_english);
}

TEST_P(Vst3, ShowsTheTableOfParameters) {
  const auto played = plugin();
  const auto shown = played->parameters();
  const auto& table = *info().parameters;
  ASSERT_EQ(shown.size(), table.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    std::string name;
    for (const int letter : shown[i].title) {
      if (letter == 0) break;
      name += static_cast<char>(letter);
    }
    EXPECT_EQ(name, table[i].name);
    // Hosts keep them in sessions: the program and 16 x 130 controllers are before.
    EXPECT_EQ(shown[i].param_id, i + 1 + (info().takes_midi ? 2080 : 0));
    const auto choices = static_cast<int>(table[i].choices.size());
    EXPECT_EQ(shown[i].step_count, choices > 0 ? choices - 1 : 0) << name;
    EXPECT_EQ((shown[i].flags & V3_PARAM_IS_LIST) != 0, choices > 1) << name;
    EXPECT_NEAR(shown[i].default_normalised_value,
                (table[i].initial - table[i].low) / (table[i].high - table[i].low), 1e-6);
  }
}

double told_value(const Vst3Plugin& of, v3_param_id id) {
  return v3_cpp_obj(of.controller())->get_parameter_normalised(of.controller(), id);
}

// DPF as it comes counts the first parameter among MIDI's controllers, which have no value.
TEST_P(Vst3, AHostReadsWhatItSetAndWhatIsLoaded) {
  const auto one = plugin(), two = plugin();
  const auto itself = info().create();
  const auto& table = *info().parameters;
  const auto shown = one->parameters();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto& parameter = shown[i];
    EXPECT_NEAR(told_value(*one, parameter.param_id), parameter.default_normalised_value, 1e-6);
    const double part = parameter.step_count > 0 ? 1.0 : 0.25;
    ASSERT_EQ(v3_cpp_obj(one->controller())
                  ->set_parameter_normalised(one->controller(), parameter.param_id, part),
              V3_OK);
    EXPECT_NEAR(told_value(*one, parameter.param_id), part, 1e-6);
    itself->set_parameter(i, value_of(table[i], part));
  }
  EXPECT_EQ(one->save(), itself->state()) << "nothing is processed: it counts at once";
  ASSERT_TRUE(two->load(one->save()));
  for (const auto& parameter : shown) {
    EXPECT_EQ(told_value(*two, parameter.param_id), told_value(*one, parameter.param_id));
  }
}

TEST_P(Vst3, APresetIsChosenByTheProgramParameter) {
  const auto played = plugin();
  const std::size_t last = std::max<std::size_t>(info().presets.size(), 1) - 1;
  ASSERT_EQ(
      v3_cpp_obj(played->controller())->set_parameter_normalised(played->controller(), 0, 1.0),
      V3_OK);
  const auto itself = info().create();
  ASSERT_EQ(itself->load_preset(last).has_value(), !info().presets.empty());
  EXPECT_EQ(played->save(), itself->state());
}

TEST_P(Vst3, PointsCountWhereABlockHasNoFrames) {
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  Story story;
  story.points = {{0, 0, 0.25}};
  played->process(story);
  const auto itself = info().create();
  itself->set_parameter(0, value_of((*info().parameters)[0], 0.25));
  EXPECT_EQ(played->save(), itself->state());
}

TEST_P(Vst3, AKnobTurnedWhileItIsSwitchedOffIsKept) {
  const auto played = plugin();
  v3_edit_controller** const controller = played->controller();
  const auto itself = info().create();
  const auto shown = played->parameters();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const plugins::Parameter& parameter = (*info().parameters)[i];
    const auto value = [&] {
      return v3_cpp_obj(controller)->get_parameter_normalised(controller, shown[i].param_id);
    };
    const double range = parameter.high - parameter.low;
    EXPECT_NEAR(value(), (parameter.initial - parameter.low) / range, 1e-6) << parameter.name;
    EXPECT_EQ(
        v3_cpp_obj(controller)->set_parameter_normalised(controller, shown[i].param_id, 0.625),
        V3_OK);
    itself->set_parameter(i, value_of(parameter, 0.625));
    EXPECT_NEAR(value(), (itself->parameter(i) - parameter.low) / range, 1e-6) << parameter.name;
  }
  EXPECT_EQ(played->save(), itself->state());
}

TEST_P(Vst3, FollowsTheSongOfTheHostToTheSample) {
  for (const std::size_t block : {480u, 48u}) {
    const Story story = told_every_block(story_with_song(info(), 480, 0), 48000, block);
    const Channels expected = audible(played_by_itself(info(), story, 48000, block));
    const auto played = plugin();
    ASSERT_TRUE(played->start(48000, 512));
    EXPECT_TRUE(played->play(story, block) == expected) << block;
    Story silent = story;
    silent.song.clear();
    const bool follows = info().key == "curve" || info().key == "crossfade";
    EXPECT_TRUE(!follows || audible(played_by_itself(info(), silent, 48000, block)) != expected);
  }
}

TEST_P(Vst3Notes, GivesTheMidiOfThePluginItself) {
  const Story story = story_for_midi(info());
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  played->play(story, 480);
  EXPECT_EQ(played->given().empty(), !info().gives_midi);
  EXPECT_TRUE(played->given() == midi_given_by_itself(info(), story, 480));
}

TEST_P(Vst3, SurvivesAnyTimeSignature) {
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  Story story;
  story.frames = 64;
  for (const auto& [beats, unit] :
       {std::pair{1, 8}, {3, 16}, {0, 0}, {4, 0}, {-1, -1}, {1, 1 << 30}}) {
    for (const double quarters : {-1e300, -0.5, 0.0, 1e300, std::nan("")}) {
      story.song = {{0, {120, quarters, true, true}, beats, unit}};
      EXPECT_TRUE(is_finite(played->process(story))) << beats << '/' << unit;
    }
  }
}

TEST_P(Vst3Notes, ABendHasItsSteps) {
  const auto played = plugin();
  v3_param_info bend{};
  const auto place = static_cast<std::int32_t>(played->of_controller(3, 129));
  ASSERT_EQ(
      v3_cpp_obj(played->controller())->get_parameter_info(played->controller(), place, &bend),
      V3_OK);
  EXPECT_EQ(bend.step_count, 16383);
}

// Hosts leave out what is called so. Ardour kept all 2080 in its sessions otherwise, and sent them
// when it opened one: volume 0 on every channel.
TEST_P(Vst3Notes, WhatStandsForControllersIsNamedAsHostsKnowIt) {
  const auto played = plugin();
  for (int controller = 0; controller < 130; ++controller) {
    v3_param_info info{};
    ASSERT_EQ(v3_cpp_obj(played->controller())
                  ->get_parameter_info(
                      played->controller(),
                      static_cast<std::int32_t>(played->of_controller(15, controller)), &info),
              V3_OK);
    std::string name;
    for (const int letter : info.title) {
      if (letter == 0) break;
      name += static_cast<char>(letter);
    }
    EXPECT_EQ(name, "MIDI CC 16|" + std::to_string(controller));
    EXPECT_NE(info.flags & V3_PARAM_IS_HIDDEN, 0);
  }
}

TEST_P(Vst3Notes, AHeldNoteEndsWhereTheHostStopsChangesTheRateOrSwitchesOff) {
  Story held, quiet;
  held.frames = quiet.frames = 4800;
  held.midi = {{0, {0x90, 60, 127}}, {2, {0xB0, 64, 127}}};
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 4800));
  for (const int what : {0, 1, 2, 3}) {
    EXPECT_TRUE(is_finite(played->process(held)));
    if (what == 0) {
      played->set_processing(false);
      played->set_processing(true);
    } else if (what == 1) {
      played->stop();
      ASSERT_TRUE(played->start(48000, 4800));
    } else if (what == 2) {
      played->stop();
      ASSERT_TRUE(played->start(96000, 4800));
    } else {  // some hosts never stop
      v3_process_setup setup{V3_REALTIME, V3_SAMPLE_32, 4800, 44100};
      v3_cpp_obj(played->processor())->setup_processing(played->processor(), &setup);
    }
    const Channels sound = played->process(quiet);
    EXPECT_TRUE(is_finite(sound));
    if (info().kind == PluginInfo::Kind::instrument) {
      EXPECT_TRUE(is_silent(sound)) << what;
    }
  }
}

TEST_P(Vst3Notes, NoEndOfANoteIsLostInAFullBlock) {
  Story story;
  story.frames = 4096;
  for (std::size_t i = 0; i < 900; ++i) {
    story.midi.push_back({4 * i, {0x90, static_cast<std::uint8_t>(20 + i % 90), 100}});
    story.midi.push_back({4 * i + 2, {0x80, static_cast<std::uint8_t>(20 + i % 90), 0}});
  }
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 4096));
  EXPECT_TRUE(played->process(story) == audible(played_by_itself(info(), story, 48000, 4096)));
  Story quiet;
  quiet.frames = 4096;
  int blocks = 0;
  while (!is_silent(played->process(quiet)) && blocks < 1000) ++blocks;
  EXPECT_LT(blocks, 1000) << "a note hangs";
}

TEST_P(Vst3, RatesFrom8000To768000AndSilenceAtOthers) {
  const Story story = story_of(info(), 4800);
  for (const double rate_hz : {8000.0, 11025.0, 12345.678, 192000.0, 768000.0}) {
    const auto played = plugin();
    ASSERT_TRUE(played->start(rate_hz, 512));
    EXPECT_TRUE(is_finite(played->play(story, 512))) << rate_hz;
  }
  const auto played = plugin();
  ASSERT_TRUE(played->start(1234.5678, 512));
  EXPECT_TRUE(is_silent(played->play(story, 512)));
}

TEST_P(Vst3, ShowsNothingButItsEntries) {
  const auto run =
      support::run_program({"/usr/bin/nm", "-D", "--defined-only", "--format=just-symbols",
                            Vst3Module::binary(bundle_of(info()))});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "GetPluginFactory\nModuleEntry\nModuleExit\n");
}

TEST_P(Vst3, SixtyFourInstancesOfTwoThreadsPlayTheSame) {
  const Story story = story_of(info(), 2400);
  const Channels expected = audible(played_by_itself(info(), story, 48000, 480));
  std::array<int, 2> same{};
  const auto play = [&](int& count) {
    std::vector<std::unique_ptr<Vst3Plugin>> all;
    for (int i = 0; i < 32; ++i) {
      all.push_back(plugin());
      if (!all.back()->start(48000, 512)) return;
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

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// The plugins in a host made of JUCE, VST3 and LV2: found, loaded, played, automated, saved and
// restored as its users do. Debian: juce-modules-source.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"

#include "juce_session.h"
#include "support/background_program.h"
#include "support/program.h"

namespace knotwave::test {
namespace {

using plugins::Parameter;
using plugins::PluginInfo;

class JuceHost : public testing::TestWithParam<std::tuple<const char*, const PluginInfo*>> {
 protected:
  std::string format() const { return std::get<0>(GetParam()); }
  bool is_lv2() const { return format() == "lv2"; }
  const PluginInfo& info() const { return *std::get<1>(GetParam()); }
  Session session() const { return Session(format(), KNOTWAVE_BIN_DIR); }
  void load(Session& session, double rate_hz = 48000, std::size_t frames = 8192) const {
    session.say("load", info().name, rate_hz, frames);
  }
  Channels audible(Channels all) const {
    all.resize(audio_channels(info().outputs));
    return all;
  }
  Points points() const { return is_lv2() ? Points::at_the_block : Points::at_their_sample; }
};

INSTANTIATE_TEST_SUITE_P(Plugins, JuceHost,
                         testing::Combine(testing::Values("vst3", "lv2"),
                                          testing::ValuesIn(plugins::all_plugins())),
                         [](const auto& named) {
                           return std::string(std::get<0>(named.param)) + "_" +
                                  std::string(std::get<1>(named.param)->key);
                         });

bool is_controller(const Story::Midi& event) {
  const int status = event.bytes[0] & 0xF0;
  return status == 0xB0 || status == 0xD0 || status == 0xE0;
}
/// Controllers come where JUCE puts them, at the begin of a block, and no two of a kind in one.
Story story_for_juce(const PluginInfo& info, std::size_t frames, std::size_t block) {
  Story story = story_of(info, frames);
  story.points.clear();
  std::set<std::tuple<std::size_t, int, int>> known;
  std::vector<Story::Midi> kept;
  for (Story::Midi event : story.midi) {
    if (is_controller(event)) {
      event.sample -= event.sample % block;
      const int kind = (event.bytes[0] & 0xF0) == 0xB0 ? event.bytes[1] : 0;
      if (!known.insert({event.sample, event.bytes[0], kind}).second) continue;
    }
    kept.push_back(event);
  }
  std::ranges::stable_sort(kept, {}, [](const Story::Midi& event) {
    return std::pair(event.sample, is_controller(event));
  });
  story.midi = std::move(kept);
  return story;
}

TEST_P(JuceHost, ItsScannerFindsThePlugin) {
  Session host = session();
  host.run();
  const auto found = std::ranges::find_if(host.scanned(), [&](const std::string& line) {
    return line.starts_with(std::string(info().name) + "\t");
  });
  ASSERT_NE(found, host.scanned().end());
  const Lines words = split(*found, '\t');
  EXPECT_EQ(words.at(1), "Knotwave");
  EXPECT_EQ(words.at(3), info().kind == PluginInfo::Kind::instrument ? "1" : "0") << *found;
}

TEST_P(JuceHost, SoundsAsThePluginItselfToTheBitInBlocksOfAnySize) {
  Session host = session();
  constexpr std::size_t kFrames = 16384;
  for (const std::size_t block : {1u, 17u, 333u, 8192u}) {
    load(host, 48000, block);
    host.play(story_for_juce(info(), kFrames, block), block, std::to_string(block));
  }
  host.run();
  for (const std::size_t block : {1u, 17u, 333u, 8192u}) {
    const Story story = story_for_juce(info(), kFrames, block);
    EXPECT_TRUE(audible(host.sound(std::to_string(block), kFrames)) ==
                audible(played_by_itself(info(), story, 48000, block)))
        << block;
  }
}

TEST_P(JuceHost, SoundsAsThePluginItselfAtOtherRates) {
  Session host = session();
  const Story story = story_for_juce(info(), 9600, 480);
  const std::vector<double> rates = {8000, 44100, 192000};
  for (const double rate_hz : rates) {
    load(host, rate_hz, 480);
    host.play(story, 480, std::to_string(rate_hz));
  }
  host.run();
  for (const double rate_hz : rates) {
    EXPECT_TRUE(audible(host.sound(std::to_string(rate_hz), story.frames)) ==
                audible(played_by_itself(info(), story, rate_hz, 480)))
        << rate_hz;
  }
}

TEST_P(JuceHost, GivesTheMidiOfThePluginItself) {
  const Story story = story_for_juce(info(), 48000, 480);
  Session host = session();
  load(host, 48000, 480);
  host.play(story, 480, "sound");
  host.run();
  std::string expected;
  for (const Story::Midi& event : midi_given_by_itself(info(), story, 480)) {
    expected += std::to_string(event.sample);
    for (const int byte : event.bytes) expected += ' ' + std::to_string(byte);
    expected += '\n';
  }
  EXPECT_EQ(expected.empty(), !info().gives_midi);
  EXPECT_EQ(*base::read_file(host.file("sound.midi"), 1 << 24), expected);
}

TEST_P(JuceHost, AnotherRateAndAResetBeginAnew) {
  const Story story = story_for_juce(info(), 9600, 480);
  const Story held = story.part(0, 1920);
  Session host = session();
  load(host, 48000, 480);
  host.play(held, 480, "held");
  host.say("prepare", 96000, 480);
  host.play(story, 480, "faster");
  host.play(held, 480, "held");
  host.say("reset");
  host.play(story, 480, "again");
  host.run();
  const Channels expected = audible(played_by_itself(info(), story, 96000, 480));
  EXPECT_TRUE(audible(host.sound("faster", story.frames)) == expected);
  if (is_lv2()) return;  // JUCE has no reset of LV2
  EXPECT_TRUE(audible(host.sound("again", story.frames)) == expected);
}

TEST_P(JuceHost, PlaysWithTheBusesThatItSwitchesOnItself) {
  Story story = story_for_juce(info(), 9600, 480);
  Session host = session();
  host.say("load", info().name, 48000, 480, "as it is");
  host.play(story, 480, "sound");
  host.run();
  if (!is_lv2()) {  // a side chain is off at first
    for (std::size_t i = 2; i < story.inputs.size(); ++i) story.inputs[i].assign(9600, 0);
  }
  EXPECT_TRUE(audible(host.sound("sound", story.frames)) ==
              audible(played_by_itself(info(), story, 48000, 480)));
}

TEST_P(JuceHost, FollowsTheSongOfTheHost) {
  const Story story = [&] {
    Story told = story_for_juce(info(), 48000, 480);
    told.song = {{4800, {133.5, 3.25, true, true}}, {24000, {90, 40.75, true, true}}};
    return told_every_block(told, 48000, 480);
  }();
  Story part = story.part(0, 4800);
  Session host = session();
  load(host, 48000, 480);
  host.play(part, 480, "before");
  host.say("song", 133.5, 3.25, 1);
  host.play(story.part(4800, 19200), 480, "first");
  host.say("song", 90, 40.75, 1);
  host.play(story.part(24000, 24000), 480, "second");
  host.run();
  Channels heard = host.sound("before", 4800);
  append(heard, host.sound("first", 19200));
  append(heard, host.sound("second", 24000));
  EXPECT_TRUE(audible(heard) == audible(played_by_itself(info(), story, 48000, 480)));
}

TEST_P(JuceHost, ShowsTheParametersByNameWithTextBothWays) {
  Session host = session();
  load(host);
  const auto& table = *info().parameters;
  for (const Parameter& parameter : table.all()) {
    host.say("text", parameter.name, 0.25);
    host.say("value", parameter.name, parameter_text(parameter, value_of(parameter, 0.25)));
  }
  host.say("parameters");
  const Lines lines = host.run();
  ASSERT_GE(lines.size(), 3 * table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Parameter& parameter = table[i];
    const double value = value_of(parameter, 0.25), range = parameter.high - parameter.low;
    const std::string text = parameter_text(parameter, value);
    if (!is_lv2()) {
      EXPECT_EQ(lines[2 * i], text) << parameter.name;
    }
    EXPECT_NEAR(std::stod(lines[2 * i + 1]), (value - parameter.low) / range, 0.001 / range + 1e-6)
        << text;
    const auto shown = std::find_if(
        lines.begin() + static_cast<std::ptrdiff_t>(2 * table.size()), lines.end(),
        [&](const std::string& line) { return line.starts_with(parameter.name + "\t"); });
    ASSERT_NE(shown, lines.end()) << parameter.name;
    const Lines words = split(*shown, '\t');
    if (!is_lv2()) {
      EXPECT_EQ(words.at(1), parameter.unit);
      EXPECT_EQ(words.at(3), parameter_text(parameter, parameter.initial)) << parameter.name;
    }
    EXPECT_NEAR(std::stod(words.at(2)), (parameter.initial - parameter.low) / range, 1e-6)
        << *shown;
  }
}

TEST_P(JuceHost, AutomationMovesParametersAtTheirBlocks) {
  const auto& table = *info().parameters;
  Story story = story_for_juce(info(), 24000, 480);
  Session host = session();
  load(host, 48000, 480);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::size_t sample = 480 * (i % 50);
    const float part = 0.25F + 0.5F * static_cast<float>(i % 2);
    const auto low = static_cast<float>(table[i].low), high = static_cast<float>(table[i].high);
    // LV2 has floats, and JUCE's arithmetic of them is not ours.
    if (is_lv2() && static_cast<double>(low + (high - low) * part) !=
                        value_of(table[i], static_cast<double>(part)))
      continue;
    story.points.push_back({sample, i, static_cast<double>(part)});
    host.say("point", sample, table[i].name, part);
  }
  std::ranges::stable_sort(story.points, {}, &Story::Point::sample);
  EXPECT_GT(story.points.size(), table.size() / 4);
  host.play(story, 480, "sound");
  host.run();
  EXPECT_TRUE(audible(host.sound("sound", story.frames)) ==
              audible(played_by_itself(info(), story, 48000, 480, points())));
}

TEST_P(JuceHost, ANewInstanceHasTheParametersAndTheSamplesOfTheStateThatWasSaved) {
  const auto& table = *info().parameters;
  Story quiet;
  quiet.frames = 48000;
  const Story story = story_for_juce(info(), 9600, 480);
  Session host = session();
  load(host, 48000, 480);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].choices.empty())
      host.say("set", table[i].name, 0.375 + 0.25 * static_cast<double>(i % 2));
  }
  host.play(quiet, 480, "quiet");
  host.say("parameters");
  host.say("save", host.file("state"));
  host.play(story, 480, "first");
  host.say("destroy");
  load(host, 48000, 480);
  host.say("restore", host.file("state"));
  host.say("parameters");
  host.play(quiet, 480, "quiet");
  host.say("save", host.file("state again"));
  host.play(story, 480, "second");
  const Lines lines = host.run();
  const Lines before(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(lines.size() / 2));
  const Lines after(lines.begin() + static_cast<std::ptrdiff_t>(lines.size() / 2), lines.end());
  EXPECT_GE(before.size(), table.size());
  EXPECT_EQ(before, after);
  const Channels first = host.sound("first", story.frames);
  EXPECT_TRUE(first == host.sound("second", story.frames));
  EXPECT_TRUE(info().gives_midi ||  // sound goes through that one
              audible(first) != audible(played_by_itself(info(), story, 48000, 480)));
  EXPECT_EQ(*base::read_file(host.file("state"), 1 << 24),
            *base::read_file(host.file("state again"), 1 << 24));
}

TEST_P(JuceHost, ADamagedStateIsRefusedWholeAndThePluginPlaysOn) {
  const Story story = story_for_juce(info(), 19200, 480);
  const auto& first = (*info().parameters)[0];
  Session host = session();
  load(host, 48000, 480);
  host.play(story.part(0, 9600), 480, "first");
  host.say("save", host.file("state"));
  host.say("mangle", "format = 1", "format = 77", host.file("state"), host.file("bad"));
  host.say("parameters");
  host.say("restore", host.file("bad"));
  host.say("parameters");
  host.play(story.part(9600, 9600), 480, "second");
  const Lines lines = host.run();
  const Lines before(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(lines.size() / 2));
  EXPECT_EQ(before,
            Lines(lines.begin() + static_cast<std::ptrdiff_t>(lines.size() / 2), lines.end()))
      << first.name;
  Channels heard = host.sound("first", 9600);
  append(heard, host.sound("second", 9600));
  EXPECT_TRUE(audible(heard) == audible(played_by_itself(info(), story, 48000, 480)));
}

TEST_P(JuceHost, ItsProgramsAreThePresetsAndOneIsChosen) {
  const std::size_t last = info().presets.size() - 1;
  Session host = session();
  load(host, 48000, 480);
  host.say("programs");
  host.say("program", info().presets[last]);
  Story quiet;
  quiet.frames = 480;
  host.play(quiet, 480, "quiet");
  host.say("parameters");
  const Lines lines = host.run();
  ASSERT_GT(lines.size(), last);
  Lines programs(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  const auto itself = info().create();
  ASSERT_TRUE(itself->load_preset(last));
  const auto& table = *info().parameters;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto shown = std::ranges::find_if(
        lines, [&](const std::string& line) { return line.starts_with(table[i].name + "\t"); });
    ASSERT_NE(shown, lines.end());
    EXPECT_NEAR(std::stod(split(*shown, '\t').at(2)),
                (itself->parameter(i) - table[i].low) / (table[i].high - table[i].low), 1e-6)
        << *shown;
  }
  std::ranges::sort(programs);  // LV2's come in any order
  Lines presets(info().presets.begin(), info().presets.end());
  std::ranges::sort(presets);
  EXPECT_EQ(programs, presets);
}

TEST_P(JuceHost, AHostInGermanGetsTheSameStatesAndTexts) {
  const support::ScratchFolder folder;
  support::run_program(
      {"/usr/bin/localedef", "-i", "de_DE", "-f", "UTF-8", folder.file("de_DE.UTF-8")});
  const support::SetVariable path("LOCPATH", folder.path());
  const auto seen = [&](bool is_german) {
    Session host = session();
    if (is_german) host.say("german");
    load(host, 48000, 480);
    Story quiet;
    quiet.frames = 480;
    const auto& first = (*info().parameters)[0];
    host.say("set", first.name, 0.3);
    host.play(quiet, 480, "quiet");
    host.say("save", host.file("state"));
    host.say("restore", host.file("state"));
    host.say("parameters");
    for (const Parameter& parameter : info().parameters->all()) {
      host.say("value", parameter.name, parameter_text(parameter, value_of(parameter, 0.3)));
    }
    Lines lines = host.run();
    if (is_german) {
      EXPECT_EQ(lines.at(0), ",") << "apt-get install locales";
      lines.erase(lines.begin());
    }
    lines.push_back(*base::read_file(host.file("state"), 1 << 24));
    return lines;
  };
  EXPECT_EQ(seen(true), seen(false));
}

}  // namespace
}  // namespace knotwave::test

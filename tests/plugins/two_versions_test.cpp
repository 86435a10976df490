// SPDX-License-Identifier: MIT
// Two copies of a plugin's file in one process, as two versions of it are: they share nothing.
#include <algorithm>
#include <filesystem>
#include <functional>

#include <gtest/gtest.h>

#include "clap_host.h"
#include "lv2_host.h"
#include "support/program.h"
#include "vst3_host.h"

namespace knotwave::test {
namespace {

using plugins::PluginInfo;

constexpr std::size_t kFrames = 9600, kBlock = 480;

std::string built(const std::string& path) { return KNOTWAVE_BIN_DIR "/../plugins/" + path; }

/// A file or a bundle under another path: another file to whoever loads it.
class Copy {
 public:
  explicit Copy(const std::string& path) : path_(folder_.file(path.substr(path.rfind('/') + 1))) {
    std::filesystem::copy(path, path_, std::filesystem::copy_options::recursive);
  }
  const std::string& path() const { return path_; }

 private:
  support::ScratchFolder folder_;
  std::string path_;
};

using PlayBlock = std::function<Channels(const Story& block)>;

/// Block by block in turn.
std::pair<Channels, Channels> play_in_turn(const Story& story, const PlayBlock& one,
                                           const PlayBlock& two) {
  std::pair<Channels, Channels> sound;
  for (std::size_t from = 0; from < story.frames; from += kBlock) {
    const Story block = story.part(from, kBlock);
    append(sound.first, one(block));
    append(sound.second, two(block));
  }
  return sound;
}

class TwoVersions : public testing::TestWithParam<const PluginInfo*> {
 protected:
  const PluginInfo& info() const { return *GetParam(); }
  Story story() const {
    Story story = story_of(info(), kFrames);
    story.points.clear();
    return story;
  }
  /// Every parameter elsewhere.
  std::string state(double part) const {
    const auto plugin = info().create();
    const auto preset = std::ranges::find(info().presets, preset_);
    if (preset != info().presets.end()) {
      EXPECT_TRUE(plugin->load_preset(static_cast<std::size_t>(preset - info().presets.begin())));
    }
    for (std::size_t i = 0; i < info().parameters->size(); ++i) {
      const plugins::Parameter& parameter = (*info().parameters)[i];
      if (parameter.choices.empty()) plugin->set_parameter(i, value_of(parameter, part));
    }
    return plugin->state();
  }
  /// What one alone gives from that state.
  Channels alone(const std::string& state, std::size_t channels) const {
    const auto plugin = info().create();
    EXPECT_TRUE(plugin->load_state(state));
    EXPECT_TRUE(plugin->activate(48000));
    Channels all = play(*plugin, story(), kBlock);
    all.resize(channels);
    return all;
  }
  void expect_apart(const PlayBlock& one, const PlayBlock& two) const {
    const auto [first, second] = play_in_turn(story(), one, two);
    const Channels expected = alone(state(0.45), first.size());
    EXPECT_TRUE(first == expected);
    EXPECT_TRUE(second == alone(state(0.55), second.size()));
    // Sound goes through the envelopes; what they make of their states is in voltages and MIDI.
    if (info().gives_midi && first.size() == audio_channels(info().outputs)) return;
    EXPECT_TRUE(first != second) << "the states are heard";
  }

  std::string preset_;  ///< where the plugin has one of that name
};

INSTANTIATE_TEST_SUITE_P(Plugins, TwoVersions, testing::ValuesIn(plugins::all_plugins()),
                         [](const auto& named) { return std::string(named.param->key); });

TEST_P(TwoVersions, OfAVst3ModuleEachPlayItsOwnState) {
  const std::string bundle = built("vst3/" + file_of(info()) + ".vst3");
  const Copy copy(bundle);
  const Vst3Module module(bundle), other(copy.path());
  ASSERT_NE(module.factory(), other.factory());
  Vst3Plugin one(module), two(other);
  ASSERT_TRUE(one.load(state(0.45)) && two.load(state(0.55)));
  ASSERT_TRUE(one.start(48000, kBlock) && two.start(48000, kBlock));
  expect_apart([&](const Story& block) { return one.process(block); },
               [&](const Story& block) { return two.process(block); });
  EXPECT_TRUE(!info().gives_midi || one.given() != two.given());
  EXPECT_EQ(one.save(), state(0.45));
  EXPECT_EQ(two.save(), state(0.55));
}

TEST_P(TwoVersions, OfAnLv2BundleEachPlayItsOwnState) {
  preset_ = "four-voltages";
  const std::string folder = built("lv2/" + file_of(info()) + ".lv2");
  const Copy copy(folder);
  Lv2Plugin one(info(), folder + "/" + file_of(info()) + ".so", 48000);
  Lv2Plugin two(info(), copy.path() + "/" + file_of(info()) + ".so", 48000);
  ASSERT_NE(one.descriptor(), two.descriptor());
  ASSERT_TRUE(one.load(state(0.45)) && two.load(state(0.55)));
  one.activate();
  two.activate();
  expect_apart([&](const Story& block) { return one.run(block); },
               [&](const Story& block) { return two.run(block); });
  EXPECT_EQ(one.save(), state(0.45));
  EXPECT_EQ(two.save(), state(0.55));
}

std::vector<ClapEvent> clap_events(const Story& story) {
  std::vector<ClapEvent> events;
  for (const Story::Midi& midi : story.midi) {
    events.push_back(clap_midi(static_cast<std::uint32_t>(midi.sample), midi.bytes[0],
                               midi.bytes[1], midi.bytes[2]));
  }
  return events;
}

TEST_P(TwoVersions, OfAClapFileEachPlayItsOwnState) {
  const std::string path = built("clap/knotwave.clap");
  const Copy copy(path);
  const ClapLibrary library(path), other(copy.path());
  ASSERT_NE(library.factory(), other.factory());
  const std::string id = "org.knotwave." + std::string(info().key);
  ClapPlugin one(library.factory(), id.c_str()), two(other.factory(), id.c_str());
  ASSERT_TRUE(one.load(state(0.45)) && two.load(state(0.55)));
  ASSERT_TRUE(one.start(48000, kBlock) && two.start(48000, kBlock));
  const auto play = [&](ClapPlugin& plugin, const Story& block) {
    Channels out;
    plugin.process(clap_events(block), block.frames, block.inputs, out);
    return out;
  };
  expect_apart([&](const Story& block) { return play(one, block); },
               [&](const Story& block) { return play(two, block); });
  EXPECT_EQ(one.save(), state(0.45));
  EXPECT_EQ(two.save(), state(0.55));
}

}  // namespace
}  // namespace knotwave::test

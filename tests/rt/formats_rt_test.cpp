// SPDX-License-Identifier: MIT
// The calls of a block that hosts of VST3 and LV2 make, inside the gate: notes, automation, sound
// and the host's song, in the built modules.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "plugins/lv2_host.h"
#include "plugins/vst3_host.h"
#include "rt_gate.h"

namespace knotwave::rt {
namespace {

using plugins::PluginInfo;
using test::Story;

constexpr std::size_t kBlock = 240;

std::string built(const std::string& path) { return KNOTWAVE_BIN_DIR "/../plugins/" + path; }

/// Notes, points and the song: all at once.
Story story_of_all(const PluginInfo& info) {
  Story story = test::told_every_block(test::story_with_song(info, kBlock, 0), 48000, kBlock);
  story.points = test::story_of(info, story.frames).points;
  return story;
}

/// Plays it twice, the second time in the gate, and says what was found.
template <class Plugin>
std::string found(Plugin& plugin, const Story& story, Gate gate) {
  plugin.play(story, kBlock);
  std::string all;
  bool is_watched = false;
  plugin.call_blocks_by([&](const std::function<void()>& block) {
    const GateReport report = run_in_gate(gate, block);
    is_watched = report.watched;
    if (report.system_calls != 0 || report.voluntary_waits != 0) all += report.findings() + '\n';
  });
  plugin.play(story, kBlock);
  EXPECT_TRUE(is_watched);
  return all;
}

class FormatsInTheGate : public testing::TestWithParam<std::tuple<const PluginInfo*, Gate>> {
 protected:
  const PluginInfo& info() const { return *std::get<0>(GetParam()); }
  Gate gate() const { return std::get<1>(GetParam()); }
  void SetUp() override {
#ifndef KNOTWAVE_HAVE_RTSAN
    if (gate() == Gate::sanitizer) GTEST_SKIP() << "no RealtimeSanitizer runtime";
#endif
  }
};

INSTANTIATE_TEST_SUITE_P(Plugins, FormatsInTheGate,
                         testing::Combine(testing::ValuesIn(plugins::all_plugins()),
                                          testing::Values(Gate::sanitizer, Gate::system)),
                         [](const auto& named) {
                           return std::string(std::get<0>(named.param)->key) +
                                  (std::get<1>(named.param) == Gate::system ? "_system"
                                                                            : "_sanitizer");
                         });

TEST_P(FormatsInTheGate, AVst3ModuleProcessesWithoutAllocatingLockingOrCallingTheSystem) {
  const test::Vst3Module module(built("vst3/" + test::file_of(info()) + ".vst3"));
  test::Vst3Plugin plugin(module);
  ASSERT_TRUE(plugin.start(48000, kBlock));
  EXPECT_EQ(found(plugin, story_of_all(info()), gate()), "");
}

TEST_P(FormatsInTheGate, AnLv2PluginRunsWithoutAllocatingLockingOrCallingTheSystem) {
  const std::string name = test::file_of(info());
  test::Lv2Plugin plugin(info(), built("lv2/" + name + ".lv2/" + name + ".so"), 48000);
  plugin.activate();
  EXPECT_EQ(found(plugin, story_of_all(info()), gate()), "");
}

// Or the tests above would say nothing.
TEST(FormatsInTheGateDeathTest, TheGateSeesWhatAModuleAllocates) {
#ifndef KNOTWAVE_HAVE_RTSAN
  GTEST_SKIP() << "no RealtimeSanitizer runtime";
#endif
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const test::Vst3Module module(built("vst3/knotwave-curve.vst3"));
  const v3_class_info kind = module.classes().at(0);
  v3_component** made = nullptr;
  EXPECT_DEATH(run_in_gate(Gate::sanitizer,
                           [&] {
                             v3_cpp_obj(module.factory())
                                 ->create_instance(module.factory(), kind.class_id,
                                                   v3_component_iid,
                                                   reinterpret_cast<void**>(&made));
                           }),
               "malloc");
}

}  // namespace
}  // namespace knotwave::rt

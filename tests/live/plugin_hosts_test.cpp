// SPDX-License-Identifier: MIT
// The LV2 plugins in hosts: what is heard in jalv under a JACK server is what the engine gives for
// the same notes. Debian packages: jalv lv2-dev sordi lilv-utils.
#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/plugins/plugin_list.h"

#include "plugin_sound.h"
#include "support/jack_server.h"

namespace knotwave {
namespace {

using support::BackgroundProgram;
using support::JackServer;

TEST(PluginHosts, JalvGivesTheVerySamplesOfTheEngine) {
  JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  const support::SetVariable path("LV2_PATH", KNOTWAVE_BIN_DIR "/../plugins/lv2");
  const support::ScratchFolder folder;
  const BackgroundProgram jalv(
      {"sh", "-c", "sleep 60 | exec jalv -x -n plugin urn:knotwave:instrument"},
      folder.file("jalv.log"));
  ASSERT_TRUE(support::comes("plugin:lv2_events_in", 10))
      << *base::read_file(folder.file("jalv.log"), 1 << 20);
  support::expect_heard("plugin:lv2_events_in", "plugin:lv2_audio_out_1", "plugin:lv2_audio_out_2",
                        support::rendered());
}

// What it finds wrong is vocabulary that is not installed: mod:brand and mod:label of MOD's
// devices.
TEST(PluginHosts, TheLv2ValidatorFindsNothingOfOursWrong) {
  const auto run = support::run_program(
      {"/bin/sh", "-c", "lv2_validate " KNOTWAVE_BIN_DIR "/../plugins/lv2/*.lv2/*.ttl 2>&1"});
  std::size_t found = 0, of_mod = 0, place = run.out.find("error: ");
  ASSERT_NE(run.out.find("restrictions)"), std::string::npos)
      << run.out << "apt-get install lv2-dev sordi";
  while (place != std::string::npos) {
    const std::size_t next = run.out.find("error: ", place + 1);
    const std::string error = run.out.substr(place, next - place);
    ++found;
    of_mod += error.find("http://moddevices.com/ns/mod#") != std::string::npos;
    place = next;
  }
  EXPECT_EQ(found, of_mod) << run.out;
}

TEST(PluginHosts, LilvListsThePluginsAndTheirPresets) {
  const support::SetVariable path("LV2_PATH", KNOTWAVE_BIN_DIR "/../plugins/lv2");
  for (const plugins::PluginInfo* info : plugins::all_plugins()) {
    const auto run =
        support::run_program({"/usr/bin/lv2info", "urn:knotwave:" + std::string(info->key)});
    EXPECT_EQ(run.exit_code, 0) << run.err << "apt-get install lilv-utils";
    EXPECT_EQ(run.err, "");
    for (const std::string& preset : info->presets) {
      EXPECT_NE(run.out.find(preset), std::string::npos) << preset;
    }
  }
}

}  // namespace
}  // namespace knotwave

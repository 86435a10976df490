// SPDX-License-Identifier: MIT
// A CLAP host's browser finds every preset and loads it.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/plugins/plugin_list.h"

#include "clap_host.h"
#include "clap_later.h"

namespace knotwave::test {
namespace {

using namespace plugins;

const ClapLibrary& library() {
  static const ClapLibrary opened(KNOTWAVE_BIN_DIR "/../plugins/clap/knotwave.clap");
  return opened;
}

struct Found {
  std::string name, key, plugin;
};
struct Browser {
  std::vector<ClapPresetLocation> locations;
  std::vector<Found> presets;
  std::size_t wanted = SIZE_MAX;
};

Browser browsed(std::size_t wanted = SIZE_MAX) {
  Browser browser;
  browser.wanted = wanted;
  const auto* factory = static_cast<const ClapPresetFactory*>(
      library().entry()->get_factory(kClapPresetDiscovery[0]));
  EXPECT_EQ(library().entry()->get_factory(kClapPresetDiscovery[1]), factory);
  EXPECT_EQ(factory->count(factory), 1u);
  EXPECT_EQ(factory->get_descriptor(factory, 1), nullptr);
  ClapPresetIndexer indexer{};
  indexer.data = &browser;
  indexer.declare_location = [](const ClapPresetIndexer* of, const ClapPresetLocation* location) {
    static_cast<Browser*>(of->data)->locations.push_back(*location);
    return true;
  };
  EXPECT_EQ(factory->create(factory, &indexer, "org.knotwave.nobody"), nullptr);
  const ClapPresetProvider* provider =
      factory->create(factory, &indexer, factory->get_descriptor(factory, 0)->id);
  EXPECT_TRUE(provider->init(provider));
  ClapPresetReceiver receiver{};
  receiver.data = &browser;
  receiver.begin_preset = [](const ClapPresetReceiver* of, const char* name, const char* key) {
    auto& found = *static_cast<Browser*>(of->data);
    if (found.presets.size() == found.wanted) return false;
    found.presets.push_back({name, key, ""});
    return true;
  };
  receiver.add_plugin_id = [](const ClapPresetReceiver* of, const ClapUniversalId* id) {
    EXPECT_STREQ(id->abi, "clap");
    static_cast<Browser*>(of->data)->presets.back().plugin = id->id;
  };
  receiver.set_flags = [](const ClapPresetReceiver*, std::uint32_t flags) { EXPECT_EQ(flags, 1u); };
  receiver.add_creator = [](const ClapPresetReceiver*, const char*) {};
  EXPECT_TRUE(provider->get_metadata(provider, kPresetInPlugin, nullptr, &receiver));
  EXPECT_FALSE(provider->get_metadata(provider, kPresetFile, "/tmp", &receiver));
  provider->destroy(provider);
  return browser;
}

TEST(ClapPresets, AreAllFoundInsideThePlugin) {
  const Browser browser = browsed();
  ASSERT_EQ(browser.locations.size(), 1u);
  EXPECT_EQ(browser.locations[0].kind, std::uint32_t{kPresetInPlugin});
  EXPECT_EQ(browser.locations[0].location, nullptr);
  std::size_t count = 0;
  for (const PluginInfo* info : all_plugins()) count += info->presets.size();
  EXPECT_EQ(browser.presets.size(), count);
  EXPECT_EQ(browsed(3).presets.size(), 3u);
}

TEST(ClapPresets, EachLoadsIntoItsPluginAndIntoNoOther) {
  std::map<std::string, std::unique_ptr<ClapPlugin>> made;
  for (const Found& preset : browsed().presets) {
    auto& plugin = made[preset.plugin];
    if (plugin == nullptr) {
      plugin = std::make_unique<ClapPlugin>(library().factory(), preset.plugin.c_str());
    }
    const auto* loads = plugin->extension<ClapPresetLoad>(kClapPresetLoad[0]);
    ASSERT_NE(loads, nullptr);
    EXPECT_TRUE(loads->from_location(plugin->get(), kPresetInPlugin, nullptr, preset.key.c_str()))
        << preset.key;
    EXPECT_FALSE(
        loads->from_location(plugin->get(), kPresetInPlugin, nullptr, preset.name.c_str()));
    EXPECT_FALSE(loads->from_location(plugin->get(), kPresetInPlugin, nullptr, nullptr));
    EXPECT_FALSE(loads->from_location(plugin->get(), 7, nullptr, preset.key.c_str()));
  }
  EXPECT_EQ(made.size(), all_plugins().size());
}

TEST(ClapPresets, AFileIsLoadedAndItsHostReadsParametersAgain) {
  ClapPlugin plugin(library().factory(), "org.knotwave.instrument");
  const auto* loads = plugin.extension<ClapPresetLoad>(kClapPresetLoad[1]);
  const std::string before = plugin.save();
  EXPECT_FALSE(loads->from_location(plugin.get(), kPresetFile, "/nowhere.toml", nullptr));
  EXPECT_FALSE(loads->from_location(plugin.get(), kPresetFile, nullptr, nullptr));
  EXPECT_EQ(plugin.save(), before);
  EXPECT_EQ(plugin.calls().rescans, 0);
  EXPECT_TRUE(loads->from_location(plugin.get(), kPresetFile,
                                   KNOTWAVE_SOURCE_DIR "/examples/patches/bell.toml", nullptr));
  EXPECT_EQ(plugin.calls().rescans, 1);
  EXPECT_NE(plugin.save().find("bell.toml"), std::string::npos);
}

}  // namespace
}  // namespace knotwave::test

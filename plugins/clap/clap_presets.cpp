// SPDX-License-Identifier: MIT
// The presets inside the plugins in a CLAP host's browser, and files it loads into one.
#include <cstring>
#include <memory>
#include <new>
#include <string>

#include "knotwave/plugins/plugin_list.h"

#include "clap_later.h"
#include "clap_plugin.h"

namespace knotwave::plugins {
namespace {

/// "shaper:Fold": one container holds the presets of all plugins.
std::string key_of(const PluginInfo& info, const std::string& preset) {
  return std::string(info.key) + ":" + preset;
}

Result<void> load(Plugin& plugin, std::uint32_t kind, const char* location, const char* key) {
  if (kind == kPresetFile && location != nullptr) return plugin.load_file(location);
  const PluginInfo& info = plugin.info();
  for (std::size_t i = 0; kind == kPresetInPlugin && key != nullptr && i < info.presets.size();
       ++i) {
    if (key_of(info, info.presets[i]) == key) return plugin.load_preset(i);
  }
  return fail(ErrorCode::unknown_name,
              std::string(info.name) + " has no preset '" + (key == nullptr ? "" : key) + "'");
}

bool from_location(const clap_plugin* plugin, std::uint32_t kind, const char* location,
                   const char* key) {
  const clap_host* host = host_of(plugin);
  const ClapHostPresetLoad* told = nullptr;
  for (const char* const id : kClapPresetLoad) {
    if (told == nullptr) {
      told = static_cast<const ClapHostPresetLoad*>(host->get_extension(host, id));
    }
  }
  const auto loaded = load(plugin_of(plugin), kind, location, key);
  if (!loaded) {
    if (told != nullptr) {
      told->on_error(host, kind, location, key, 0, loaded.error().to_string().c_str());
    }
    return false;
  }
  tell_new_values(plugin);
  if (told != nullptr) told->loaded(host, kind, location, key);
  return true;
}
constexpr ClapPresetLoad kLoad{from_location};

// What a browser reads.

constexpr ClapPresetProviderDescriptor kProvider{CLAP_VERSION, "org.knotwave.presets",
                                                 "Knotwave's presets", "Knotwave"};

bool declare(const ClapPresetProvider* provider) {
  const auto* indexer = static_cast<const ClapPresetIndexer*>(provider->data);
  const ClapPresetLocation inside{kPresetOfFactory, "Knotwave", kPresetInPlugin, nullptr};
  return indexer->declare_location(indexer, &inside);
}

bool metadata(const ClapPresetProvider*, std::uint32_t kind, const char*,
              const ClapPresetReceiver* receiver) {
  if (kind != kPresetInPlugin) return false;
  for (std::size_t number = 0; number < all_plugins().size(); ++number) {
    const PluginInfo& info = *all_plugins()[number];
    const ClapUniversalId id{"clap", clap_descriptor(number).id};
    for (const std::string& preset : info.presets) {
      if (!receiver->begin_preset(receiver, preset.c_str(), key_of(info, preset).c_str())) {
        return true;
      }
      receiver->add_plugin_id(receiver, &id);
      receiver->set_flags(receiver, kPresetOfFactory);
      receiver->add_creator(receiver, "Knotwave");
    }
  }
  return true;
}

std::uint32_t count(const ClapPresetFactory*) { return 1; }
const ClapPresetProviderDescriptor* descriptor(const ClapPresetFactory*, std::uint32_t index) {
  return index == 0 ? &kProvider : nullptr;
}
const ClapPresetProvider* create(const ClapPresetFactory*, const ClapPresetIndexer* indexer,
                                 const char* id) {
  if (indexer == nullptr || id == nullptr || std::strcmp(id, kProvider.id) != 0) return nullptr;
  return new (std::nothrow) ClapPresetProvider{
      &kProvider, const_cast<ClapPresetIndexer*>(indexer),
      declare,    [](const ClapPresetProvider* provider) { delete provider; },
      metadata,   [](const ClapPresetProvider*, const char*) -> const void* { return nullptr; }};
}
constexpr ClapPresetFactory kFactory{count, descriptor, create};

}  // namespace

const void* const kClapLoadsPresets = &kLoad;
const void* const kClapShowsPresets = &kFactory;

}  // namespace knotwave::plugins

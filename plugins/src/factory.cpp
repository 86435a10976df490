// SPDX-License-Identifier: MIT
#include "knotwave/plugins/factory.h"

#include <algorithm>

#include "factory_bytes.h"

namespace knotwave::plugins {
namespace {

constexpr std::string_view kPatches = "patches/", kBanks = "banks/", kEnding = ".toml";

/// Drums and test pieces of the bank play there; what a player would choose comes by itself.
std::vector<Preset> presets() {
  std::vector<Preset> all;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.starts_with(kPatches)) continue;
    const std::string_view name =
        file.name.substr(kPatches.size(), file.name.size() - kPatches.size() - kEnding.size());
    all.push_back({std::string(name), std::string(file.name)});
  }
  const auto first = std::find_if(all.begin(), all.end(),
                                  [](const Preset& preset) { return preset.name == "keys"; });
  if (first != all.end()) std::rotate(all.begin(), first, first + 1);
  all.push_back({"General MIDI", std::string(kBanks) + "general-midi.toml"});
  return all;
}

std::vector<engine::FileText> files() {
  std::vector<engine::FileText> all;
  for (const EmbeddedFile& file : embedded_files()) {
    all.push_back({std::string(file.name), std::string(file.bytes.begin(), file.bytes.end())});
  }
  return all;
}

}  // namespace

std::span<const Preset> factory_presets() {
  static const std::vector<Preset> all_presets = presets();
  return all_presets;
}

std::span<const engine::FileText> factory_files() {
  static const std::vector<engine::FileText> all_files = files();
  return all_files;
}

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
#include "knotwave/plugins/factory.h"

#include <algorithm>
#include <map>

#include "factory_bytes.h"

namespace knotwave::plugins {
namespace {

constexpr std::string_view kPatches = "patches/", kBanks = "banks/", kPlugins = "plugins/";
constexpr std::string_view kEnding = ".toml";

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

/// "warm-valve": "Warm valve"
std::string shown_name(std::string_view stem) {
  std::string name(stem);
  std::replace(name.begin(), name.end(), '-', ' ');
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') {
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
  }
  return name;
}

std::map<std::string_view, std::vector<Preset>> presets_by_key() {
  std::map<std::string_view, std::vector<Preset>> all;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.starts_with(kPlugins)) continue;
    const std::string_view stem =
        file.name.substr(kPlugins.size(), file.name.size() - kPlugins.size() - kEnding.size());
    const std::size_t dash = stem.find('-');
    if (dash == std::string_view::npos) continue;
    all[stem.substr(0, dash)].push_back(
        {shown_name(stem.substr(dash + 1)), std::string(file.name)});
  }
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

std::string_view factory_text(std::string_view path) {
  for (const engine::FileText& file : factory_files()) {
    if (file.path == path) return file.bytes;
  }
  return {};
}

std::span<const Preset> effect_presets(std::string_view key) {
  static const auto all_presets = presets_by_key();
  const auto found = all_presets.find(key);
  return found == all_presets.end() ? std::span<const Preset>() : found->second;
}

std::vector<std::string> preset_names(std::span<const Preset> presets) {
  std::vector<std::string> names;
  for (const Preset& preset : presets) names.push_back(preset.name);
  return names;
}

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
// What is inside every plugin: the patches, the bank, the curves and the states of examples/. [any]
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/engine/bank.h"

namespace knotwave::plugins {

struct Preset {
  std::string name;  ///< "keys"; "General MIDI" is the bank
  std::string path;  ///< among factory_files()
};
/// In the order of hosts' menus; new ones come at the end of the patches.
std::span<const Preset> factory_presets();
/// What they are read from: paths below examples/. [control] Made at the first call.
std::span<const engine::FileText> factory_files();
/// The bytes of one of them; empty: there is none.
std::string_view factory_text(std::string_view path);

/// Those of an effect: "plugins/KEY-warm-valve.toml" is "Warm valve". The order is that of
/// cmake/KnotwaveExamples.cmake; new ones come at the end.
std::span<const Preset> effect_presets(std::string_view key);
std::vector<std::string> preset_names(std::span<const Preset> presets);

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
// The patches and the bank that are inside every plugin: those of examples/. [any]
#pragma once
#include <cstddef>
#include <span>
#include <string>
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

}  // namespace knotwave::plugins

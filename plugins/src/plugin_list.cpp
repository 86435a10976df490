// SPDX-License-Identifier: MIT
#include "knotwave/plugins/plugin_list.h"

namespace knotwave::plugins {

std::span<const PluginInfo* const> all_plugins() {
  static const PluginInfo* const all[] = {&instrument_info(), &shaper_info(), &crossfade_info(),
                                          &curve_info(), &envelope_info()};
  return all;
}

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
// The plugins there are. [any] Each is made at the first call.
#pragma once
#include <span>

#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

const PluginInfo& instrument_info();
const PluginInfo& shaper_info();
const PluginInfo& crossfade_info();
const PluginInfo& curve_info();
const PluginInfo& envelope_info();

/// All of them, in the order of menus.
std::span<const PluginInfo* const> all_plugins();

}  // namespace knotwave::plugins

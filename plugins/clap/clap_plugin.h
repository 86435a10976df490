// SPDX-License-Identifier: MIT
// Any plugin as a CLAP plugin.
#pragma once
#include <clap/plugin.h>

#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

/// What hosts read of it, kept for ever.
const clap_plugin_descriptor& clap_descriptor(std::size_t number);
/// all_plugins()[number] in a host. Goes with its destroy(). Null only where memory is out.
/// [control]
const clap_plugin* create_clap_plugin(std::size_t number, const clap_host* host);
Plugin& plugin_of(const clap_plugin* plugin);
const clap_host* host_of(const clap_plugin* plugin);
/// The host reads all parameters again. [control]
void tell_new_values(const clap_plugin* plugin);

extern const void* const kClapAudioPorts;
extern const void* const kClapNotePorts;
extern const void* const kClapParameters;
extern const void* const kClapLoadsPresets;
extern const void* const kClapShowsPresets;  ///< a factory of the file

}  // namespace knotwave::plugins

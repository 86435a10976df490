// SPDX-License-Identifier: MIT
// The instrument as a CLAP plugin.
#pragma once
#include <clap/plugin.h>

namespace knotwave::plugins {

extern const clap_plugin_descriptor kClapInstrument;
/// Goes with its destroy(). Null only where memory is out. [control]
const clap_plugin* create_clap_instrument(const clap_host* host);

}  // namespace knotwave::plugins

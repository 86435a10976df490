// SPDX-License-Identifier: MIT
// What a CLAP host finds in the file.
#include <cstring>

#include <clap/entry.h>
#include <clap/plugin-factory.h>

#include "knotwave/plugins/plugin_list.h"

#include "clap_later.h"
#include "clap_plugin.h"

namespace {

using namespace knotwave::plugins;

std::uint32_t count(const clap_plugin_factory*) {
  return static_cast<std::uint32_t>(all_plugins().size());
}
const clap_plugin_descriptor* descriptor(const clap_plugin_factory*, std::uint32_t index) {
  return index < all_plugins().size() ? &clap_descriptor(index) : nullptr;
}
const clap_plugin* create(const clap_plugin_factory*, const clap_host* host, const char* id) {
  if (host == nullptr || id == nullptr || !clap_version_is_compatible(host->clap_version)) {
    return nullptr;
  }
  for (std::size_t i = 0; i < all_plugins().size(); ++i) {
    if (std::strcmp(id, clap_descriptor(i).id) == 0) return create_clap_plugin(i, host);
  }
  return nullptr;
}
constexpr clap_plugin_factory kFactory{count, descriptor, create};

bool init(const char*) { return true; }
void deinit() {}
const void* factory(const char* id) {
  for (const char* const discovery : kClapPresetDiscovery) {
    if (std::strcmp(id, discovery) == 0) return kClapShowsPresets;
  }
  return std::strcmp(id, CLAP_PLUGIN_FACTORY_ID) == 0 ? &kFactory : nullptr;
}

}  // namespace

const clap_plugin_entry clap_entry = {CLAP_VERSION, init, deinit, factory};

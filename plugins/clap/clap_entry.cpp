// SPDX-License-Identifier: MIT
// What a CLAP host finds in the file.
#include <cstring>

#include <clap/entry.h>
#include <clap/plugin-factory.h>

#include "clap_instrument.h"

namespace {

using knotwave::plugins::kClapInstrument;

std::uint32_t count(const clap_plugin_factory*) { return 1; }
const clap_plugin_descriptor* descriptor(const clap_plugin_factory*, std::uint32_t index) {
  return index == 0 ? &kClapInstrument : nullptr;
}
const clap_plugin* create(const clap_plugin_factory*, const clap_host* host, const char* id) {
  if (host == nullptr || id == nullptr || !clap_version_is_compatible(host->clap_version)) {
    return nullptr;
  }
  if (std::strcmp(id, kClapInstrument.id) != 0) return nullptr;
  return knotwave::plugins::create_clap_instrument(host);
}
constexpr clap_plugin_factory kFactory{count, descriptor, create};

bool init(const char*) { return true; }
void deinit() {}
const void* factory(const char* id) {
  return std::strcmp(id, CLAP_PLUGIN_FACTORY_ID) == 0 ? &kFactory : nullptr;
}

}  // namespace

const clap_plugin_entry clap_entry = {CLAP_VERSION, init, deinit, factory};

// SPDX-License-Identifier: MIT
// The parameters of a CLAP plugin, from its table.
#include <clap/ext/params.h>

#include "clap_events.h"
#include "clap_plugin.h"
#include "clap_text.h"

namespace knotwave::plugins {
namespace {

const ParameterTable& table_of(const clap_plugin* plugin) {
  return *plugin_of(plugin).info().parameters;
}

std::uint32_t count(const clap_plugin* plugin) {
  return static_cast<std::uint32_t>(table_of(plugin).size());
}
bool describe(const clap_plugin* plugin, std::uint32_t index, clap_param_info* info) {
  if (index >= count(plugin)) return false;
  const Parameter& parameter = table_of(plugin)[index];
  *info = {};
  info->id = parameter.id;
  info->flags = CLAP_PARAM_IS_AUTOMATABLE;
  if (!parameter.choices.empty()) info->flags |= CLAP_PARAM_IS_STEPPED;
  if (plugin_of(plugin).info().kind == PluginInfo::Kind::instrument) {
    info->flags |= CLAP_PARAM_IS_MODULATABLE | CLAP_PARAM_IS_MODULATABLE_PER_NOTE_ID |
                   CLAP_PARAM_IS_MODULATABLE_PER_KEY | CLAP_PARAM_IS_MODULATABLE_PER_CHANNEL;
  }
  put(info->name, parameter.name);
  put(info->module, parameter.group);
  info->min_value = parameter.low;
  info->max_value = parameter.high;
  info->default_value = parameter.initial;
  return true;
}
bool number(const clap_plugin* plugin, clap_id id, double* value) {
  const std::size_t place = table_of(plugin).of_id(id);
  if (place >= table_of(plugin).size()) return false;
  *value = plugin_of(plugin).parameter(place);
  return true;
}
bool text_of_value(const clap_plugin* plugin, clap_id id, double value, char* out,
                   std::uint32_t size) {
  const ParameterTable& table = table_of(plugin);
  const std::size_t place = table.of_id(id);
  if (place >= table.size() || size == 0) return false;
  put(out, size, parameter_text(table[place], value));
  return true;
}
bool value_of_text(const clap_plugin* plugin, clap_id id, const char* text, double* value) {
  const ParameterTable& table = table_of(plugin);
  const std::size_t place = table.of_id(id);
  if (place >= table.size() || text == nullptr) return false;
  const auto read = parameter_value(table[place], text);
  if (read) *value = *read;
  return static_cast<bool>(read);
}
void flush(const clap_plugin* plugin, const clap_input_events* in, const clap_output_events*) {
  set_clap_parameters(plugin_of(plugin), *in);
}
constexpr clap_plugin_params kParameters{count,         describe,      number,
                                         text_of_value, value_of_text, flush};

}  // namespace

const void* const kClapParameters = &kParameters;

}  // namespace knotwave::plugins

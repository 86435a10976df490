// SPDX-License-Identifier: MIT
// An effect as text: docs/plugin-state.md.
#include <algorithm>
#include <optional>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/base/suggest.h"
#include "knotwave/plugins/effect.h"
#include "knotwave/plugins/factory.h"

namespace knotwave::plugins {
namespace {

using base::Node;
using base::TableReader;

constexpr const char* kSource = "the plugin's state";

Error with_source(Error error) {
  if (error.source.empty()) error.source = kSource;
  return error;
}

/// A parameter's value as a state has it: a number within its range, or a choice's word.
std::optional<double> read_value(TableReader& reader, const Parameter& parameter) {
  const Node* node = reader.node(parameter.word);
  if (node == nullptr) return std::nullopt;
  if (parameter.choices.empty()) {
    return reader.number(parameter.word, parameter.initial, parameter.low, parameter.high);
  }
  const std::string word = reader.string(parameter.word);
  const auto& choices = parameter.choices;
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<double>(found - choices.begin());
  const std::vector<std::string_view> known(choices.begin(), choices.end());
  reader.fail_at(
      *node, ErrorCode::unknown_name,
      "'" + word + "' is no choice of '" + parameter.word + "'" + base::suggestion(word, known));
  return std::nullopt;
}

std::string value_text(const Parameter& parameter, double value) {
  if (parameter.choices.empty()) return base::number_text(value);
  return '"' + parameter.choices[static_cast<std::size_t>(value)] + '"';
}

std::vector<double> initial_values(const ParameterTable& table) {
  std::vector<double> values;
  for (const Parameter& parameter : table.all()) values.push_back(parameter.initial);
  return values;
}

/// The first curve whose name is none of the effect's own is an error at its place.
Result<void> check_names(TableReader& reader, const Node& curves, std::span<const OwnCurve> own) {
  std::vector<std::string_view> known;
  for (const OwnCurve& curve : own) known.push_back(curve.name);
  for (const Node::Member& member : curves.members) {
    if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
    reader.fail_at(member.value, ErrorCode::unknown_name,
                   "this plugin has no curve '" + member.key + "' of its own" +
                       base::suggestion(member.key, known));
  }
  return reader.finish();
}

}  // namespace

struct Effect::State {
  std::vector<double> values;
  curves::CurveSet own;
};

Result<Effect::State> Effect::read_state(const Node& root) const {
  const ParameterTable& table = *info_->parameters;
  State state{initial_values(table), {}};
  TableReader reader(root, kSource, "state");
  for (const char* key : {"format", "kind"}) reader.node(key);
  for (const char* key : {"name", "about"}) reader.string(key, "");
  const std::string key = reader.string("plugin");
  if (reader.ok() && key != info_->key) {
    reader.fail_at(*root.find("plugin"), ErrorCode::unsupported,
                   "this is a state of the plugin '" + key + "'; one of '" +
                       std::string(info_->key) + "' is needed here");
  }
  const Node* parameters = reader.table("parameters");
  const Node* curves = reader.table("curves");
  if (auto ok = reader.finish(); !ok) return ok.error();
  if (parameters != nullptr) {
    TableReader values(*parameters, kSource, "[parameters]");
    for (std::size_t place = 0; place < table.size(); ++place) {
      if (const auto value = read_value(values, table[place])) state.values[place] = *value;
    }
    if (auto ok = values.finish(); !ok) return ok.error();
  }
  if (curves == nullptr) return state;
  if (auto ok = check_names(reader, *curves, own_); !ok) return ok.error();
  auto set = curves::read_curve_tables(root, kSource);
  if (!set) return set.error();
  state.own = *std::move(set);
  return state;
}

Result<Effect::State> Effect::read_curve_file(std::string_view text) const {
  auto set = curves::parse_curves(text, kSource);
  if (!set) return set.error();
  if (!set->surfaces.empty() || set->curves.size() > own_.size()) {
    return fail(ErrorCode::unsupported, "the file holds " + std::to_string(set->curves.size()) +
                                            " curves and " + std::to_string(set->surfaces.size()) +
                                            " surfaces; this plugin takes " +
                                            std::to_string(own_.size()) + " curves at most");
  }
  State state;
  for (std::size_t place = 0; place < info_->parameters->size(); ++place) {
    state.values.push_back(parameter(place));
  }
  state.own = own_curves_;
  for (std::size_t i = 0; i < set->curves.size(); ++i) {
    curves::CurveSpec spec = set->curves[i].spec();
    spec.name = own_[i].name;
    auto named = curves::NurbsCurve::create(std::move(spec));
    if (!named) return named.error();
    auto& all = state.own.curves;
    std::erase_if(all, [&](const auto& curve) { return curve.name() == own_[i].name; });
    all.push_back(*std::move(named));
    state.values[own_[i].parameter] = 0;
  }
  return state;
}

Result<void> Effect::load_state(std::string_view text) {
  const auto root = base::parse_document(text, kSource);
  if (!root) return root.error();
  const auto kind = curves::read_file_kind(*root, kSource);
  if (!kind) return kind.error();
  if (*kind != curves::FileKind::plugin && *kind != curves::FileKind::curve) {
    return with_source(fail(ErrorCode::unsupported,
                            "a plugin's state (kind = \"plugin\") or a curve file is needed here"));
  }
  auto state = *kind == curves::FileKind::plugin ? read_state(*root) : read_curve_file(text);
  if (!state) return with_source(state.error());
  auto compiled = compile(state->own);
  if (!compiled) return with_source(compiled.error());
  own_curves_ = std::move(state->own);
  curves_.publish(*std::move(compiled));
  for (std::size_t place = 0; place < state->values.size(); ++place) {
    set_parameter(place, state->values[place]);
  }
  return {};
}

std::string Effect::state() const {
  std::string text =
      "format = 1\nkind = \"plugin\"\nplugin = \"" + std::string(info_->key) + "\"\n";
  std::string moved;
  for (std::size_t place = 0; place < info_->parameters->size(); ++place) {
    const Parameter& description = (*info_->parameters)[place];
    if (parameter(place) == description.initial) continue;
    moved += description.word + " = " + value_text(description, parameter(place)) + "\n";
  }
  if (!moved.empty()) text += "\n[parameters]\n" + moved;
  return text + curves::write_curve_tables(own_curves_);
}

Result<void> Effect::load_preset(std::size_t number) {
  const auto presets = effect_presets(info_->key);
  if (number >= presets.size()) {
    return fail(ErrorCode::value_out_of_range, "there is no preset " + std::to_string(number) +
                                                   "; 0 to " + std::to_string(presets.size() - 1) +
                                                   " are there");
  }
  return load_state(factory_text(presets[number].path));
}

}  // namespace knotwave::plugins

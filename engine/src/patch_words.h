// SPDX-License-Identifier: MIT
// The words of maps: what `from` and `to` may say. [control]
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/engine/patch.h"

namespace knotwave::engine {

/// The names of `items`, in their order.
template <class Item>
std::vector<std::string_view> names_of(const std::vector<Item>& items) {
  std::vector<std::string_view> names;
  names.reserve(items.size());
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

/// One of `items` is called so.
template <class Item>
bool has_name(const std::vector<Item>& items, std::string_view name) {
  for (const Item& item : items) {
    if (item.name == name) return true;
  }
  return false;
}

/// What comes before the name of a free number.
inline constexpr std::string_view kFreePrefix = "free.";

/// A source with its index (control number, envelope, LFO or free number).
struct SourceWord {
  MapSource source = MapSource::constant;
  int index = 0;
};

/// Whether a word means a source by itself, so that no envelope or LFO may be called so.
bool is_source_word(std::string_view word);
/// "cc" and a number, whether there is such a controller or not.
bool is_controller_word(std::string_view word);
/// The whole number after a prefix, "cc74" or "nrpn100", or -1.
int number_after(std::string_view prefix, std::string_view word);
/// Whether a word begins targets, so that no oscillator may be called so.
bool is_target_word(std::string_view word);

/// The source `word` of the patch, or none.
std::optional<SourceWord> find_source(const PatchSpec& patch, std::string_view word);
/// `; did you mean 'mod'?` for a word that is no source of the patch, or empty. [control]
std::string source_suggestion(const PatchSpec& patch, std::string_view word);
/// The same for a word that is no target.
std::string target_suggestion(const PatchSpec& patch, std::string_view word);

/// A target that is no curve.
struct TargetWord {
  MapTarget target = MapTarget::amp;
  int index = -1;  ///< as MapSpec::target_index
};
struct TargetChoice {
  std::string word;
  TargetWord target;
};
/// Every target of the patch that is no curve.
std::vector<TargetChoice> target_choices(const PatchSpec& patch);

/// Whether a map's target is a number of a curve.
constexpr bool moves_a_number(const MapSpec& map) {
  return map.target == MapTarget::curve_weight || map.target == MapTarget::curve_point ||
         map.target == MapTarget::curve_knot;
}

/// The target `word` of the patch, or none; curves are left to the reader of maps.
std::optional<TargetWord> find_target(const PatchSpec& patch, std::string_view word);

}  // namespace knotwave::engine

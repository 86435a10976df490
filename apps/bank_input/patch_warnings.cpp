// SPDX-License-Identifier: MIT
#include "bank_input/patch_warnings.h"

#include <algorithm>

namespace knotwave::bank_input {
namespace {

bool is_played(const engine::PatchSpec& patch, const std::string& curve) {
  const auto names = [&curve](const auto& items, auto... members) {
    return std::any_of(items.begin(), items.end(),
                       [&](const auto& item) { return ((item.*members == curve) || ...); });
  };
  return names(patch.oscillators, &engine::OscillatorSpec::wave) ||
         names(patch.envelopes, &engine::EnvelopeUse::curve) ||
         names(patch.lfos, &engine::LfoUse::curve) ||
         names(patch.maps, &engine::MapSpec::curve, &engine::MapSpec::surface) ||
         curve == patch.crossfade_law || curve == patch.shaper_curve || curve == patch.glide_curve;
}

}  // namespace

std::vector<std::string> patch_warnings(const engine::PatchSpec& patch) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < patch.maps.size(); ++i) {
    const engine::MapSpec& map = patch.maps[i];
    if (!map.enabled || map.target_curve.empty() || is_played(patch, map.target_curve)) continue;
    const engine::Place place = patch.place_of("maps." + std::to_string(i) + ".to");
    std::string where = patch.source_name + ":";
    if (place.line > 0) {
      where += std::to_string(place.line) + ":" + std::to_string(place.column) + ":";
    }
    warnings.push_back(where + " warning: this map moves '" + map.target_curve +
                       "', which nothing plays");
  }
  return warnings;
}

}  // namespace knotwave::bank_input

// SPDX-License-Identifier: MIT
#include "bank_input/patch_warnings.h"

#include <algorithm>
#include <span>

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

bool is_read(const engine::PatchSpec& patch, int free_number) {
  constexpr auto kFree = engine::MapSource::free_number;
  return std::any_of(patch.maps.begin(), patch.maps.end(), [&](const engine::MapSpec& map) {
    return map.enabled && ((map.source == kFree && map.source_index == free_number) ||
                           (map.source_v == kFree && map.source_v_index == free_number));
  });
}

/// What the map does for nothing; empty where it is heard.
std::string idle_work(const engine::PatchSpec& patch, std::span<const engine::OutputSpec> outputs,
                      const engine::MapSpec& map) {
  if (!map.enabled) return {};
  const auto has_output = [outputs](auto&& is_wanted) {
    return std::any_of(outputs.begin(), outputs.end(), is_wanted);
  };
  const bool is_sent_along = has_output(
      [&map](const engine::OutputSpec& output) { return output.curve == map.target_curve; });
  if (!map.target_curve.empty() && !is_played(patch, map.target_curve) && !is_sent_along) {
    return "moves '" + map.target_curve + "', which nothing plays";
  }
  const bool is_sent = has_output([&map](const engine::OutputSpec& output) {
    return output.source == engine::MapSource::free_number &&
           output.source_index == map.target_index;
  });
  if (map.target == engine::MapTarget::free_number && !is_read(patch, map.target_index) &&
      !is_sent) {
    const auto& name = patch.free_numbers[static_cast<std::size_t>(map.target_index)];
    const std::string readers = patch.has_sound ? "no map reads" : "no map and no output reads";
    return "moves 'free." + name + "', which " + readers + " (from = \"free." + name + "\")";
  }
  return {};
}

std::vector<std::string> warnings_of(const engine::PatchSpec& patch,
                                     std::span<const engine::OutputSpec> outputs) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < patch.maps.size(); ++i) {
    const std::string work = idle_work(patch, outputs, patch.maps[i]);
    if (work.empty()) continue;
    const engine::Place place = patch.place_of("maps." + std::to_string(i) + ".to");
    std::string where = patch.source_name + ":";
    if (place.line > 0) {
      where += std::to_string(place.line) + ":" + std::to_string(place.column) + ":";
    }
    where += " warning: this map ";
    warnings.push_back(where + work);
  }
  return warnings;
}

}  // namespace

std::vector<std::string> patch_warnings(const engine::PatchSpec& patch) {
  return warnings_of(patch, {});
}

std::vector<std::string> patch_warnings(const engine::EnvelopePatchSpec& patch) {
  return warnings_of(patch.patch, patch.outputs);
}

}  // namespace knotwave::bank_input

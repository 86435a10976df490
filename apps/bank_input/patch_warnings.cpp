// SPDX-License-Identifier: MIT
#include "bank_input/patch_warnings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/curves/analysis.h"

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

/// `file.toml:30:1: warning: `
std::string warning_at(const engine::PatchSpec& patch, const std::string& path) {
  const engine::Place place = patch.place_of(path);
  std::string where = patch.source_name + ":";
  if (place.line > 0) {
    where += std::to_string(place.line) + ":" + std::to_string(place.column) + ":";
  }
  return where + " warning: ";
}

std::vector<std::string> warnings_of(const engine::PatchSpec& patch,
                                     std::span<const engine::OutputSpec> outputs) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < patch.maps.size(); ++i) {
    const std::string work = idle_work(patch, outputs, patch.maps[i]);
    if (work.empty()) continue;
    warnings.push_back(warning_at(patch, "maps." + std::to_string(i) + ".to") + "this map " + work);
  }
  return warnings;
}

struct Reach {
  std::string name;
  double low = 0, high = 1;
};

/// Between what an output's source runs; nothing where maps say that.
std::optional<Reach> reach_of(const engine::PatchSpec& patch, const engine::OutputSpec& output) {
  const auto index = static_cast<std::size_t>(output.source_index);
  const bool is_envelope = output.source == engine::MapSource::envelope;
  if (!is_envelope && output.source != engine::MapSource::lfo) return std::nullopt;
  const std::string& name = is_envelope ? patch.envelopes[index].name : patch.lfos[index].name;
  if (!is_envelope && patch.lfos[index].spec.random) return Reach{name, -1, 1};
  const std::string& played = is_envelope ? patch.envelopes[index].curve : patch.lfos[index].curve;
  const curves::NurbsCurve* curve = patch.curves.find_curve(played);
  const bool is_moved = std::any_of(
      patch.maps.begin(), patch.maps.end(),
      [&played](const engine::MapSpec& map) { return map.enabled && map.target_curve == played; });
  if (curve == nullptr || is_moved) return std::nullopt;
  const auto range = curves::value_range(*curve, curve->dim() - 1);
  return Reach{name, range.low.value, range.high.value};
}

std::string short_number(double value) {
  return base::number_text(std::floor(value * 1000 + 0.5) / 1000);
}

/// Outputs that say nothing of `of`, whose source goes beyond what is then usual by 1 % and more.
std::vector<std::string> clip_warnings(const engine::EnvelopePatchSpec& spec) {
  constexpr double kSlack = 0.01;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
    const engine::OutputSpec& output = spec.outputs[i];
    const std::string path = "outputs." + std::to_string(i);
    if (spec.patch.places.contains(path + ".of")) continue;
    const auto reach = reach_of(spec.patch, output);
    if (!reach) continue;
    const double slack = kSlack * (output.of_high - output.of_low);
    if (reach->low >= output.of_low - slack && reach->high <= output.of_high + slack) continue;
    warnings.push_back(warning_at(spec.patch, path + ".from") + "output " + std::to_string(i + 1) +
                       " clips: '" + reach->name + "' runs from " + short_number(reach->low) +
                       " to " + short_number(reach->high) + ", of = [" +
                       base::number_text(output.of_low) + ", " + base::number_text(output.of_high) +
                       "]");
  }
  return warnings;
}

}  // namespace

std::vector<std::string> patch_warnings(const engine::PatchSpec& patch) {
  return warnings_of(patch, {});
}

std::vector<std::string> patch_warnings(const engine::EnvelopePatchSpec& patch) {
  std::vector<std::string> warnings = warnings_of(patch.patch, patch.outputs);
  for (std::string& line : clip_warnings(patch)) warnings.push_back(std::move(line));
  return warnings;
}

}  // namespace knotwave::bank_input

// SPDX-License-Identifier: MIT
#include "knotwave/engine/target_words.h"

#include <algorithm>
#include <charconv>

#include "patch_words.h"

namespace knotwave::engine {
namespace {

/// Slots with one name around their number; of a single one `before` is all.
struct Group {
  int first = 0, count = 0;  ///< count 0: a single one
  std::string_view before, after;
};
constexpr Group kGroups[] = {
    {kSlotAmp, 0, "amp", ""},
    {kSlotGain, 0, "gain", ""},
    {kSlotPitch, 0, "pitch", ""},
    {kSlotPan, 0, "pan", ""},
    {kSlotCutoff, 0, "cutoff", ""},
    {kSlotResonance, 0, "resonance", ""},
    {kSlotDrive, 0, "drive", ""},
    {kSlotCrossfade, 0, "crossfade", ""},
    {kSlotSourceLevel, kMaxOscillators, "oscillator.", ".level"},
    {kSlotSourceGain, kMaxOscillators, "oscillator.", ".gain"},
    {kSlotSourcePitch, kMaxOscillators, "oscillator.", ".pitch"},
    {kSlotSourcePan, kMaxOscillators, "oscillator.", ".pan"},
    {kSlotSourcePhase, kMaxOscillators, "oscillator.", ".phase"},
    {kSlotSourcePosition, kMaxOscillators, "oscillator.", ".position"},
    {kSlotSourceLevel + kNoiseSource, 0, "noise.level", ""},
    {kSlotSourceGain + kNoiseSource, 0, "noise.gain", ""},
    {kSlotSourcePitch + kNoiseSource, 0, "noise.pitch", ""},
    {kSlotSourcePan + kNoiseSource, 0, "noise.pan", ""},
    {kSlotSourcePhase + kNoiseSource, 0, "noise.phase", ""},
    {kSlotSourcePosition + kNoiseSource, 0, "noise.position", ""},
    {kSlotLfoRate, kMaxLfos, "lfo.", ".rate"},
    {kSlotEnvelopeTime, kMaxVoiceEnvelopes, "envelope.", ".time"},
    {kSlotFree, kMaxFreeNumbers, "free.", ""},
    {kSlotControl, kMaxMaps, "moved.", ""},
};

/// The number between `before` and `after`, 1..count, or 0.
int number_in(std::string_view word, const Group& group) {
  if (!word.starts_with(group.before) || !word.ends_with(group.after)) return 0;
  if (word.size() <= group.before.size() + group.after.size()) return 0;
  word.remove_prefix(group.before.size());
  word.remove_suffix(group.after.size());
  int number = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_plain = status == std::errc{} && end == word.data() + word.size() && word[0] != '0';
  return is_plain && number >= 1 && number <= group.count ? number : 0;
}

std::string number_word(const MapSpec& map) {
  const std::string curve = "curve." + map.target_curve;
  const std::string point = std::to_string(map.target_point);
  if (map.target == MapTarget::curve_weight) return curve + ".weight." + point;
  if (map.target == MapTarget::curve_knot) return curve + ".knot." + point;
  constexpr std::string_view kCoordinates[] = {"", ".y", ".z"};
  const auto coordinate = static_cast<std::size_t>(std::clamp(map.target_coordinate, 0, 2));
  return curve + ".point." + point + std::string(kCoordinates[coordinate]);
}

}  // namespace

std::string slot_word(int slot) {
  for (const Group& group : kGroups) {
    if (group.count == 0 && slot == group.first) return std::string(group.before);
    if (slot >= group.first && slot < group.first + group.count) {
      return std::string(group.before) + std::to_string(slot - group.first + 1) +
             std::string(group.after);
    }
  }
  return {};
}

std::optional<int> slot_of_word(std::string_view word) {
  for (const Group& group : kGroups) {
    if (group.count == 0 && word == group.before) return group.first;
    if (const int number = number_in(word, group); number > 0) return group.first + number - 1;
  }
  return std::nullopt;
}

std::vector<TargetName> targets_of(const PatchSpec& patch) {
  std::vector<TargetName> names;
  for (TargetChoice& choice : target_choices(patch)) {
    names.push_back({std::move(choice.word), slot_of(choice.target.target, choice.target.index)});
  }
  int moved = 0;  // as the compiler counts them
  for (const MapSpec& map : patch.maps) {
    if (!map.enabled || !moves_a_number(map)) continue;
    names.push_back({number_word(map), kSlotControl + moved++});
  }
  return names;
}

Result<int> find_slot(const PatchSpec& patch, std::string_view word) {
  for (const TargetName& name : targets_of(patch)) {
    if (name.word == word) return name.slot;
  }
  if (const auto slot = slot_of_word(word)) return *slot;
  return fail(ErrorCode::unknown_name, "there is no target '" + std::string(word) + "' in patch '" +
                                           patch.name + "'" + target_suggestion(patch, word));
}

}  // namespace knotwave::engine

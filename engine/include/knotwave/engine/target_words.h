// SPDX-License-Identifier: MIT
// Names of the slots a set_target event may move: those every patch has, and a patch's own words.
// [control]
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/map_slots.h"

namespace knotwave::engine {

/// The name of a slot in any patch: "amp", "cutoff", "oscillator.1.level", "noise.gain",
/// "lfo.2.rate", "envelope.1.time", "free.3", "moved.1" (a number of a curve that a map moves).
/// What is counted is counted from 1, in the order of the patch's file. Empty: no such slot.
std::string slot_word(int slot);
/// The slot of such a name, or none. Each slot has one name, each name one slot.
std::optional<int> slot_of_word(std::string_view word);

struct TargetName {
  std::string word;
  int slot = 0;
};
/// What the patch's maps may write after `to`, and the numbers of curves they do move:
/// "filter.cutoff", "saw.level", "free.tension", "curve.fall.weight.2".
std::vector<TargetName> targets_of(const PatchSpec& patch);

/// The slot of a word of the patch, or of any patch's. Errors: unknown_name, with the nearest.
Result<int> find_slot(const PatchSpec& patch, std::string_view word);

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// The order envelopes, LFOs and maps are computed in. [control]
#pragma once
#include <span>
#include <vector>

#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {

/// The slots a map reads: free numbers that are its sources, numbers of its curve that others move.
std::vector<int> slots_read_by(const PatchProgram::MapPart& map);

struct Schedule {
  std::vector<PatchProgram::Step> steps;
  /// What waits for itself, and what lies between two of those: maps, envelopes, LFOs. Never maps
  /// or others that only wait for these.
  std::vector<PatchProgram::Step> stuck;
};

/// Every map after what it reads, everything a map moves after the map; among what could come next
/// maps come first, then envelopes, then LFOs, each by index.
Schedule make_schedule(std::span<const PatchProgram::MapPart> maps,
                       std::span<const PatchProgram::EnvelopePart> envelopes,
                       std::span<const PatchProgram::LfoPart> lfos);

}  // namespace knotwave::engine

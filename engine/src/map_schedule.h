// SPDX-License-Identifier: MIT
// The order envelopes, LFOs and maps are computed in. [control]
#pragma once
#include <span>
#include <vector>

#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {

struct Schedule {
  std::vector<PatchProgram::Step> steps;
  std::vector<PatchProgram::Step> stuck;  ///< what waits for itself: maps, envelopes, LFOs
};

/// Every map after what it reads, everything a map moves after the map; among what could come next
/// maps come first, then envelopes, then LFOs, each by index.
Schedule make_schedule(std::span<const PatchProgram::MapPart> maps,
                       std::span<const PatchProgram::EnvelopePart> envelopes,
                       std::span<const PatchProgram::LfoPart> lfos);

}  // namespace knotwave::engine

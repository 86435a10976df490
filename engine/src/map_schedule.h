// SPDX-License-Identifier: MIT
// The order envelopes, LFOs and maps are computed in. [control]
#pragma once
#include <span>
#include <vector>

#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {

/// Every map after what it reads, everything a map moves after the map; among what could come next
/// maps come first, then envelopes, then LFOs, each by index. Errors: cyclic_reference, with the
/// names of what cannot be computed.
Result<std::vector<PatchProgram::Step>> make_schedule(
    std::span<const PatchProgram::MapPart> maps,
    std::span<const PatchProgram::EnvelopePart> envelopes,
    std::span<const PatchProgram::LfoPart> lfos);

}  // namespace knotwave::engine

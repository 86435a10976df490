// SPDX-License-Identifier: MIT
// Programs and drum keys of a song that the bank has no patch for.
#pragma once
#include <string>

#include "knotwave/engine/engine.h"

#include "render_job.h"

namespace knotwave::render {

/// `3 notes are silent: the bank has no patch for program 77 of bank 0:0 (channel 1)`, with the
/// first few of them; empty when there are none.
std::string missing_patches(const engine::EngineCounters& counters);
/// The same of what a render would count: the song's messages are played and nothing is rendered.
std::string find_missing_patches(const RenderInput& input);

}  // namespace knotwave::render

// SPDX-License-Identifier: MIT
// What in a patch is right but can hardly be meant.
#pragma once
#include <string>
#include <vector>

#include "knotwave/engine/envelope_patch.h"
#include "knotwave/engine/patch.h"

namespace knotwave::bank_input {

/// `file.toml:30:1: warning: ...`, one for each map that moves a curve which nothing plays, or
/// a free number which no other map reads.
std::vector<std::string> patch_warnings(const engine::PatchSpec& patch);
/// The same of an envelope patch, whose outputs play curves and read free numbers as well; and one
/// for each output without `of` whose envelope or LFO goes beyond 0 to 1.
std::vector<std::string> patch_warnings(const engine::EnvelopePatchSpec& patch);

}  // namespace knotwave::bank_input

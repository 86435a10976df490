// SPDX-License-Identifier: MIT
// What in a patch is right but can hardly be meant.
#pragma once
#include <string>
#include <vector>

#include "knotwave/engine/patch.h"

namespace knotwave::bank_input {

/// `file.toml:30:1: warning: ...`, one for each map that moves a curve which nothing plays, or
/// a free number which no other map reads.
std::vector<std::string> patch_warnings(const engine::PatchSpec& patch);

}  // namespace knotwave::bank_input

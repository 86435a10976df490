// SPDX-License-Identifier: MIT
// Options that do not go together, or that would be for nothing.
#pragma once
#include <functional>
#include <string>

#include "options.h"

namespace knotwave::env {

/// Whether the command line has an option: "--bits".
using IsGiven = std::function<bool(const char*)>;

/// What is wrong with values that are each good in themselves; empty when nothing is. Puts together
/// what several options say.
std::string conflict(EnvOptions& options, const IsGiven& is_given);

}  // namespace knotwave::env

// SPDX-License-Identifier: MIT
// A dry run from files to files.
#pragma once
#include <string>

#include "env_input.h"

namespace knotwave::env {

/// Reads the song, plays it, writes what is asked for. Gives the line to print. Errors: those of
/// the files and of the run.
Result<std::string> run_offline(const EnvOptions& options, const EnvInput& input);

}  // namespace knotwave::env

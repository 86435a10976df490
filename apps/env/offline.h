// SPDX-License-Identifier: MIT
// A dry run from files to files.
#pragma once
#include <string>

#include "knotwave/io/midi_file.h"

#include "env_input.h"

namespace knotwave::env {

/// Reads the song, plays it, writes what is asked for. Gives the line to print. Errors: those of
/// the files and of the run.
Result<std::string> run_offline(const EnvOptions& options, const EnvInput& input);

/// The first of what is odd about a MIDI file, on standard error.
void say_warnings(const std::string& name, const io::Song& song);

}  // namespace knotwave::env

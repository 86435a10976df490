// SPDX-License-Identifier: MIT
// From options to a finished file: read, compile, render, report.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "knotwave/engine/bank_program.h"
#include "knotwave/io/midi_file.h"

#include "command_line/places.h"
#include "options.h"
#include "report.h"

namespace knotwave::render {

inline constexpr int kMidiChannels = 16;

/// All that was read, checked and compiled.
struct RenderInput {
  std::string score_name;
  std::vector<command_line::NamedFile> files;  ///< all that were read, those of a demo left out
  std::unique_ptr<const engine::BankProgram> bank;
  io::Song song;
  std::vector<std::string> warnings;  ///< each names its file
};

/// Reads the patch or bank with its sound files, and the score. Errors: theirs.
Result<RenderInput> read_input(const RenderOptions& options);

/// `song.mid: ok: 12 tracks, 3456 events, 61.200 s`
std::string check_line(const RenderOptions& options, const RenderInput& input);

/// Renders and writes every file. Errors: value_out_of_range (the song is too long), those of the
/// sound writer.
Result<RenderReport> render(const RenderOptions& options, const RenderInput& input);

}  // namespace knotwave::render

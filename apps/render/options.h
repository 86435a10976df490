// SPDX-License-Identifier: MIT
// What the command line of knotwave-render asks for.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "knotwave/curves/simd.h"
#include "knotwave/io/sound_file.h"

namespace knotwave::render {

struct RenderOptions {
  std::string patch;  ///< a patch or a bank; empty with a demo
  std::string score;  ///< a MIDI file; empty with a demo
  std::string demo;
  std::string journal;  ///< of a take, in place of patch and score
  std::string output;   ///< "-" is standard output
  bool check = false;
  double max_length_s = 3600;
  int rate_hz = 48000;
  int block_frames = 256;
  int threads = 1;
  std::uint64_t seed = 1;
  io::SampleFormat format = io::SampleFormat::pcm24;
  std::optional<double> tail_s;  ///< none: until all is silent
  std::string json;              ///< "-" is standard output
  std::string stems;             ///< a folder
  bool quiet = false;
  curves::SimdLevel simd = curves::SimdLevel::best;
};

/// A command line read: options, or an exit code when there is nothing (more) to do.
struct CommandLine {
  RenderOptions options;
  std::optional<int> exit_code;
};

/// Prints help, version and usage errors itself.
CommandLine read_command_line(int argc, char** argv);

}  // namespace knotwave::render

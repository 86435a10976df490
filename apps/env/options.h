// SPDX-License-Identifier: MIT
// What the command line of knotwave-env asks for.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "knotwave/io/osc_input.h"

namespace knotwave::env {

struct EnvOptions {
  std::vector<std::string> patches;
  bool list = false;
  std::string midi_api;
  std::vector<std::string> midi_in;   ///< parts of names; none: all
  std::vector<std::string> midi_out;  ///< part of a name, or NAME=PART for a port of the patches
  int control = -1;                   ///< --cc: of the first output; -1: as the patch says
  int channel = 0;                    ///< of every output; 0: as the patch says
  std::optional<io::OscPlace> osc;
  bool direct_current = false;  ///< --cv
  std::string calibration;
  std::string audio_api, audio_device;
  bool thru = false;
  std::string dry_run, output, plot;
  bool monitor = false, quiet = false;
  double latency_ms = 2;
  double bpm = 120;
  double tail_s = 2;
  double duration_s = 0;  ///< 0: until it is ended
  std::uint64_t seed = 1;
};

/// A command line read: options, or an exit code when there is nothing (more) to do.
struct CommandLine {
  EnvOptions options;
  std::optional<int> exit_code;
};

/// Prints help, version and usage errors itself.
CommandLine read_command_line(int argc, char** argv);

}  // namespace knotwave::env

// SPDX-License-Identifier: MIT
// What the command line of knotwave-synth asks for.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "knotwave/curves/simd.h"
#include "knotwave/io/osc_input.h"

namespace knotwave::synth {

struct SynthOptions {
  std::string patch;  ///< a patch or a bank; empty with a demo
  std::string demo;
  std::string song;  ///< a MIDI file; empty: none, but a demo has its own
  bool list_devices = false;
  std::string audio_api, audio_device;
  std::vector<int> channels = {1, 2};
  std::string midi_api;
  std::vector<std::string> midi_in;  ///< parts of names; none: all
  int rate_hz = 0;                   ///< 0: the device's own, as with the next two
  int block_frames = 0;
  double latency_ms = 0;
  int threads = 1;
  std::uint64_t seed = 1;
  double volume_db = 0;
  std::string record;
  std::string midi_learn;
  std::optional<io::OscPlace> osc;
  bool plain = false, json_status = false;
  double duration_s = 0;  ///< 0: until it is ended
  curves::SimdLevel simd = curves::SimdLevel::best;
};

/// A command line read: options, or an exit code when there is nothing (more) to do.
struct CommandLine {
  SynthOptions options;
  std::optional<int> exit_code;
};

/// Prints help, version and usage errors itself.
CommandLine read_command_line(int argc, char** argv);

}  // namespace knotwave::synth

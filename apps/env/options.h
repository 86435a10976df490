// SPDX-License-Identifier: MIT
// What the command line of knotwave-env asks for.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "knotwave/dsp/loudness.h"
#include "knotwave/engine/midi_value.h"
#include "knotwave/io/osc_input.h"

namespace knotwave::env {

/// --capture: what becomes a curve, and how near.
struct CaptureOptions {
  std::string word;             ///< as it was given; empty: nothing is captured
  bool is_sound = false;        ///< the level of a sound, else the MIDI value
  engine::MidiValueSpec value;  ///< with the bits asked for
  int bits = 0;                 ///< 0: not asked for
  dsp::LoudnessConfig::Measure measure = dsp::LoudnessConfig::Measure::rms;
  std::string from;      ///< a file; empty: MIDI inputs
  double tolerance = 0;  ///< steps, dB, or of full scale; 0: what is usual
  int points = 0;        ///< at most; 0: any number
  bool beats = false, whole = false;
  double ramp_s = 0.05;
  double window_s = 0.05, hop_s = 0.01;
  double floor_db = 0;  ///< below 0: a scale of decibels from there; 0: linear
};

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
  CaptureOptions capture;
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

// SPDX-License-Identifier: MIT
#include "conflict.h"

#include <vector>

#include "knotwave/base/file.h"

#include "command_line/places.h"

namespace knotwave::env {
namespace {

bool is_midi_file(const std::string& path) {
  for (const char* ending : {".mid", ".midi", ".rmi"}) {
    if (base::has_ending(path, ending)) return true;
  }
  return false;
}

std::string capture_file_conflict(const EnvOptions& o) {
  const CaptureOptions& c = o.capture;
  if (!o.output.empty() && !base::has_ending(o.output, ".toml")) {
    return "--output: '" + o.output + "' does not end in .toml, as a captured curve does";
  }
  if (!o.plot.empty() && !base::has_ending(o.plot, ".svg")) {
    return "--plot: '" + o.plot + "' does not end in .svg";
  }
  std::vector<command_line::NamedFile> inputs, outputs;
  if (!c.from.empty()) inputs.push_back({"--from", c.from});
  if (!o.output.empty()) outputs.push_back({"--output", o.output});
  if (!o.plot.empty()) outputs.push_back({"--plot", o.plot});
  return command_line::overlap(inputs, outputs);
}

/// Options that a thing has no use for, and what they are for.
struct Idle {
  const char* what_for;
  std::vector<const char*> options;
};

std::string first_given(const Idle& idle, const IsGiven& is_given) {
  for (const char* option : idle.options) {
    if (is_given(option)) return std::string(option) + " is for " + idle.what_for;
  }
  return {};
}

/// Of those that a capture has no use for.
std::string idle_option(const CaptureOptions& c, const IsGiven& is_given) {
  std::vector<Idle> all = {{"playing, not for --capture",
                            {"--thru", "--latency", "--seed", "--monitor", "--cc", "--osc", "--cv",
                             "--calibration", "--audio-api", "--audio-device", "--midi-out"}},
                           {"--dry-run", {"--tail"}}};
  if (c.is_sound) {
    all.push_back({"MIDI controllers and NRPN", {"--bits"}});
    all.push_back({"MIDI, not for loudness and peak", {"--ramp", "--whole", "--channel"}});
  } else {
    all.push_back({"loudness and peak", {"--window", "--hop", "--floor"}});
  }
  if (!c.from.empty()) {
    all.push_back({"what is live, not for --from", {"--midi-in", "--midi-api", "--duration"}});
  }
  for (const Idle& idle : all) {
    if (std::string fault = first_given(idle, is_given); !fault.empty()) return fault;
  }
  return {};
}

std::string capture_conflict(EnvOptions& o, const IsGiven& is_given) {
  CaptureOptions& c = o.capture;
  if (!o.patches.empty()) {
    return "'" + o.patches.front() +
           "' is not played while --capture records; a file to capture goes behind --from";
  }
  if (!o.dry_run.empty())
    return "--dry-run plays, --capture records: --from names what is captured";
  if (c.is_sound && c.from.empty()) {
    return "--capture " + c.word + " is of a sound file: name it with --from";
  }
  if (c.is_sound && is_midi_file(c.from)) {
    return "--capture " + c.word + " is of a sound, '" + c.from + "' is named as a MIDI file";
  }
  if (!c.is_sound && !c.from.empty() && !is_midi_file(c.from)) {
    return "--capture " + c.word +
           " is of MIDI: --from takes a .mid; loudness and peak are of sounds";
  }
  if (std::string fault = idle_option(c, is_given); !fault.empty()) return fault;
  if (c.is_sound && c.hop_s > c.window_s) return "--hop is longer than --window";
  if (c.is_sound) return capture_file_conflict(o);
  const auto value = engine::parse_midi_value(c.word, c.bits);
  if (!value) return "--bits: " + value.error().message;
  c.value = *value;
  return capture_file_conflict(o);
}

std::string dry_run_conflict(const EnvOptions& o) {
  if (o.dry_run.empty()) {
    if (!o.output.empty()) return "--output is for --dry-run: name a MIDI file to play";
    if (!o.plot.empty()) return "--plot is for --dry-run: name a MIDI file to play";
    return {};
  }
  if (!o.calibration.empty() && !base::has_ending(o.output, ".wav")) {
    return "--calibration is for control voltage: a dry run writes that to -o FILE.wav";
  }
  if (o.duration_s > 0) {
    return "--duration ends what is played with devices; --dry-run plays the song, and --tail "
           "seconds more";
  }
  if (!o.output.empty() && !base::has_ending(o.output, ".mid") &&
      !base::has_ending(o.output, ".csv") && !base::has_ending(o.output, ".wav")) {
    return "--output: '" + o.output + "' ends neither in .mid nor in .csv nor in .wav";
  }
  if (!o.plot.empty() && !base::has_ending(o.plot, ".svg")) {
    return "--plot: '" + o.plot + "' does not end in .svg";
  }
  std::vector<command_line::NamedFile> inputs = {{"--dry-run", o.dry_run}}, outputs;
  for (const std::string& patch : o.patches) inputs.push_back({"a patch,", patch});
  if (!o.calibration.empty()) inputs.push_back({"--calibration", o.calibration});
  if (!o.output.empty()) outputs.push_back({"--output", o.output});
  if (!o.plot.empty()) outputs.push_back({"--plot", o.plot});
  return command_line::overlap(inputs, outputs);
}

}  // namespace

std::string conflict(EnvOptions& o, const IsGiven& is_given) {
  if (o.list) return {};
  if (!o.capture.word.empty()) return capture_conflict(o, is_given);
  const Idle of_captures = {"--capture",
                            {"--from", "--bits", "--tolerance", "--points", "--beats", "--whole",
                             "--ramp", "--window", "--hop", "--floor"}};
  if (std::string fault = first_given(of_captures, is_given); !fault.empty()) return fault;
  if (o.patches.empty())
    return "there is no PATCH to play and nothing to --capture; --list shows MIDI inputs and "
           "outputs";
  for (const std::string& patch : o.patches) {
    if (is_midi_file(patch)) {
      return "'" + patch + "' is named as a MIDI file; those go behind --dry-run";
    }
  }
  if (o.dry_run.empty() && is_given("--tail")) return "--tail is for --dry-run";
  return dry_run_conflict(o);
}

}  // namespace knotwave::env

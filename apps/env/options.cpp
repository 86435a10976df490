// SPDX-License-Identifier: MIT
// The only file of knotwave-env that knows CLI11.
#include "options.h"

#include <CLI/CLI.hpp>

#include "knotwave/base/file.h"

#include "command_line/options.h"
#include "command_line/places.h"

namespace knotwave::env {
namespace {

constexpr const char* kAbout =
    "Plays curves into MIDI controllers, OSC and control voltage: notes, pedals and clocks\n"
    "come in, each value goes out when the curve crosses to it. Several PATCHes play side\n"
    "by side.";

constexpr const char* kMore =
    "Examples:\n"
    "  knotwave-env --list\n"
    "  knotwave-env swell.toml --midi-in Keystep --midi-out Minitaur\n"
    "  knotwave-env swell.toml --midi-out Minitaur --cc 74 --channel 3 --monitor\n"
    "  knotwave-env swell.toml --dry-run song.mid -o sent.mid --plot sent.svg\n"
    "\n"
    "Every destination goes to its rest value at the end, with Ctrl-C too.\n"
    "Exit codes: 0 done, 1 failure, 2 wrong usage, 75 try again, 130 ended by Ctrl-C.";

std::string read_osc(const std::string& text, std::optional<io::OscPlace>& osc) {
  auto place = io::parse_osc_place(text);
  if (!place) return place.error().message;
  osc = *place;
  return {};
}

void add_devices(CLI::App& app, EnvOptions& o) {
  using namespace command_line;
  add_flag(app, {"--list", "print MIDI inputs and outputs and sound devices, and stop", ""},
           o.list);
  add_text(app, {"--midi-api", "as --list names them; all if not given", "API"}, o.midi_api);
  add_texts(
      app,
      {"--midi-in", "part of a MIDI input's name; can be given again (all if not given)", "PORT"},
      o.midi_in);
  add_texts(app,
            {"--midi-out",
             "part of a MIDI output's name, for the first port of the patches; NAME=PORT for the "
             "port they call NAME",
             "PORT"},
            o.midi_out);
  add_number(app, {"--cc", "send the first output of each PATCH to this controller", ""}, o.control,
             0, 119);
  add_number(app, {"--channel", "of every output, instead of the patch's", ""}, o.channel, 1, 16);
  add_checked(app,
              {"--osc", "where OSC outputs go: a UDP port of this machine, or HOST:PORT", "PLACE"},
              [&o](const std::string& text) { return read_osc(text, o.osc); });
  add_flag(app,
           {"--cv",
            "control voltages go out as they are, with their direct current; without it "
            "loudspeakers are kept safe",
            ""},
           o.direct_current);
  add_text(app, {"--calibration", "volts of the audio interface (.toml)", "FILE"}, o.calibration);
  add_text(app,
           {"--audio-api", "for control voltage; jack, alsa, ..., as --list names them", "API"},
           o.audio_api);
  add_text(
      app,
      {"--audio-device", "for control voltage: number in the list, or part of a name", "DEVICE"},
      o.audio_device);
}

void add_playing(CLI::App& app, EnvOptions& o) {
  using namespace command_line;
  app.add_option("PATCH", o.patches, "envelope patches (.toml)")->type_name("");
  add_flag(app, {"--thru", "send on all that comes in, merged, to the first port", ""}, o.thru);
  add_number(app,
             {"--latency", "from what comes in to what goes out, in milliseconds", "MILLISECONDS"},
             o.latency_ms, 1.0, 1000.0);
  add_number(app, {"--bpm", "tempo until a clock or a score says another", ""}, o.bpm, 4.0, 1000.0);
  add_number(app, {"--seed", "seed of everything random", ""}, o.seed);
  add_number(app, {"--duration", "end by itself after this time", "SECONDS"}, o.duration_s, 0.001,
             1e9);
  add_flag(app, {"--monitor", "print every message that goes out", ""}, o.monitor);
  add_flag(app, {"--quiet", "no status lines", ""}, o.quiet);
}

void add_dry_run(CLI::App& app, EnvOptions& o) {
  using namespace command_line;
  add_text(app,
           {"--dry-run", "play this MIDI file instead of devices, as fast as can be", "IN.mid"},
           o.dry_run);
  add_text(app,
           {"-o,--output",
            "what --dry-run would send: as a .mid, one tick a sample of 1/48000 s; as a .csv; or "
            "the control voltages as a .wav",
            "FILE"},
           o.output);
  add_text(app, {"--plot", "draw what --dry-run would send, as steps over the curves", "FILE.svg"},
           o.plot);
  add_number(app, {"--tail", "how long --dry-run plays on behind the end of the song", "SECONDS"},
             o.tail_s, 0.0, 3600.0);
}

std::string dry_run_conflict(const EnvOptions& o) {
  if (o.dry_run.empty()) {
    if (!o.output.empty()) return "--output is for --dry-run: name a MIDI file to play";
    if (!o.plot.empty()) return "--plot is for --dry-run: name a MIDI file to play";
    return {};
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

/// What is wrong with values that are each good in themselves; empty when nothing is.
std::string conflict(const EnvOptions& o) {
  if (o.list) return {};
  if (o.patches.empty()) return "there is no PATCH to play; --list shows MIDI inputs and outputs";
  for (const std::string& patch : o.patches) {
    for (const char* ending : {".mid", ".midi", ".rmi"}) {
      if (base::has_ending(patch, ending)) {
        return "'" + patch + "' is named as a MIDI file; those go behind --dry-run";
      }
    }
  }
  return dry_run_conflict(o);
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  CommandLine line;
  EnvOptions& options = line.options;
  CLI::App app(kAbout, "knotwave-env");
  command_line::prepare(app, kMore);
  add_playing(app, options);
  add_devices(app, options);
  add_dry_run(app, options);
  line.exit_code =
      command_line::read_words(app, argc, argv, [&options] { return conflict(options); });
  return line;
}

}  // namespace knotwave::env

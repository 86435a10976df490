// SPDX-License-Identifier: MIT
// The only file of knotwave-env that knows CLI11.
#include "options.h"

#include <CLI/CLI.hpp>

#include "command_line/options.h"
#include "conflict.h"

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
    "  knotwave-env --capture cc1 --midi-in Keystep -o knob.toml\n"
    "  knotwave-env --capture loudness --from drums.wav -o drums.toml --plot drums.svg\n"
    "\n"
    "Every destination goes to its rest value at the end, with Ctrl-C too. Ctrl-C saves a\n"
    "capture, and that is no failure.\n"
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
      {"--midi-in",
       "part of a MIDI input's name; can be given again (if not given all but what knotwave-env "
       "sends)",
       "PORT"},
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
            "the control voltages as a .wav; what --capture makes, as a .toml",
            "FILE"},
           o.output);
  add_text(
      app,
      {"--plot", "draw what --dry-run would send, or --capture heard, over the curves", "FILE.svg"},
      o.plot);
  add_number(app, {"--tail", "how long --dry-run plays on behind the end of the song", "SECONDS"},
             o.tail_s, 0.0, 3600.0);
}

std::string read_word(const std::string& text, CaptureOptions& capture) {
  capture.word = text;
  capture.is_sound = text == "loudness" || text == "peak";
  if (text == "peak") capture.measure = dsp::LoudnessConfig::Measure::peak;
  if (capture.is_sound) return {};
  const auto value = engine::parse_midi_value(text);
  if (value) {
    capture.value = *value;
    return {};
  }
  return value.error().message + "; of a sound there are loudness and peak";
}

void add_capture(CLI::App& app, EnvOptions& o) {
  using namespace command_line;
  CaptureOptions& c = o.capture;
  add_checked(app,
              {"--capture",
               "record this into a curve of few points instead of playing: cc0 to cc119, nrpn0 to "
               "nrpn16383, bend, pressure or poly_pressure, from MIDI inputs until Ctrl-C or "
               "--duration, or --from a file; loudness or peak of a sound file",
               "VALUE"},
              [&c](const std::string& text) { return read_word(text, c); });
  add_text(app, {"--from", "capture from this .mid, or this sound", "FILE"}, c.from);
  add_choice(app, {"--bits", "of the controller or NRPN that is captured", ""}, {"7", "14"},
             [&c](std::size_t i) { c.bits = i == 0 ? 7 : 14; });
  add_number(app,
             {"--tolerance",
              "how far the curve may be from what was captured, in steps, or of sounds in dB with "
              "--floor, else of full scale; 0 takes half a step, 0.5 dB or 0.01",
              ""},
             c.tolerance, 0.0, 10000.0);
  add_number(app, {"--points", "refuse a captured curve of more points than this; 0 takes any", ""},
             c.points, 0, 4096);
  add_flag(app,
           {"--beats", "times of the captured curve are beats: of the .mid, else of --bpm", ""},
           c.beats);
  add_flag(
      app,
      {"--whole", "capture from the beginning to the end, not from the first move to the last", ""},
      c.whole);
  add_number(
      app,
      {"--ramp", "how long a captured value takes to one that is more than a step away", "SECONDS"},
      c.ramp_s, 0.0001, 10.0);
  add_number(app, {"--window", "what the loudness is taken over", "SECONDS"}, c.window_s, 0.0001,
             10.0);
  add_number(app, {"--hop", "from one loudness to the next, no longer than --window", "SECONDS"},
             c.hop_s, 0.0001, 10.0);
  add_number(
      app, {"--floor", "loudness as dB from here, which is 0, to 0 dB, which is 1; 0: linear", ""},
      c.floor_db, -200.0, 0.0);
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
  add_capture(app, options);
  const IsGiven is_given = [&app](const char* option) { return app.count(option) > 0; };
  line.exit_code =
      command_line::read_words(app, argc, argv, [&] { return conflict(options, is_given); });
  return line;
}

}  // namespace knotwave::env

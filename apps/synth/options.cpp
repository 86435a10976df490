// SPDX-License-Identifier: MIT
// The only file of knotwave-synth that knows CLI11.
#include "options.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>

#include "knotwave/base/file.h"

#include "command_line/options.h"
#include "demo/demo.h"

namespace knotwave::synth {
namespace {

constexpr const char* kAbout =
    "Plays a Knotwave patch or bank live, from MIDI, OSC and the computer's keyboard.\n"
    "A saved change of the patch is heard at once. Without PATCH it plays the demo\n"
    "first-light, whose patch is then yours to play.";

constexpr const char* kMore =
    "Examples:\n"
    "  knotwave-synth bell.toml\n"
    "  knotwave-synth --list-devices\n"
    "  knotwave-synth general-midi.toml --audio-api alsa --audio-device HDMI\n"
    "  knotwave-synth bell.toml --midi-in Keystep --midi-in nanoKONTROL --osc 9000\n"
    "  knotwave-synth bell.toml --record take.wav\n"
    "  knotwave-synth general-midi.toml --song prelude.mid\n"
    "\n"
    "On a terminal a page shows what happens, and ? lists the keys. docs/live.md\n"
    "tells the rest.\n"
    "Exit codes: 0 done, 1 failure, 2 wrong usage, 75 try again, 130 ended by Ctrl-C.";

constexpr const char* kSimdNames[] = {"best", "avx2", "baseline"};
constexpr curves::SimdLevel kSimdOf[] = {curves::SimdLevel::best, curves::SimdLevel::avx2,
                                         curves::SimdLevel::baseline};

std::string demo_names() {
  std::string names;
  for (const auto& name : demo::names_of_demos()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

std::optional<int> device_channel(std::string_view text) {
  const auto number = command_line::number_in(text);
  if (!number || *number != static_cast<int>(*number)) return std::nullopt;
  return *number >= 1 && *number <= 256 ? std::optional<int>(static_cast<int>(*number))
                                        : std::nullopt;
}

/// "1,2", or "3" for one device channel that gets both.
std::string read_channels(const std::string& text, std::vector<int>& channels) {
  const std::size_t comma = text.find(',');
  const auto first = device_channel(std::string_view(text).substr(0, comma));
  const auto second =
      comma == std::string::npos ? first : device_channel(std::string_view(text).substr(comma + 1));
  const bool is_pair = comma != std::string::npos;
  if (!first || !second || (is_pair && *first == *second)) {
    return "'" + text + "' is neither one channel of the device from 1 to 256 nor two different " +
           "ones, as in 1,2";
  }
  channels = is_pair ? std::vector{*first, *second} : std::vector{*first};
  return {};
}

std::string read_osc(const std::string& text, std::optional<io::OscPlace>& osc) {
  auto place = io::parse_osc_place(text);
  if (!place) return place.error().message;
  osc = *place;
  return {};
}

void add_devices(CLI::App& app, SynthOptions& o) {
  using namespace command_line;
  add_flag(app, {"--list-devices", "print sound devices and MIDI ports, and stop", ""},
           o.list_devices);
  add_text(app,
           {"--audio-api",
            "jack, alsa, ... as --list-devices names them, or none: no device, the clock alone "
            "(jack if not given and its server runs, else the system's own)",
            "API"},
           o.audio_api);
  add_text(app, {"--audio-device", "number in the list of devices, or part of a name", "DEVICE"},
           o.audio_device);
  add_checked(
      app, {"--channels", "channels of the device that are played to (1,2 if not given)", "LIST"},
      [&o](const std::string& text) { return read_channels(text, o.channels); });
  add_number(app, {"--rate", "samples a second; the device's own if not given", "HZ"}, o.rate_hz,
             8000, 768000);
  add_number(app, {"--block", "samples the device asks for at once; its own if not given", ""},
             o.block_frames, 16, 8192);
  add_number(app,
             {"--latency", "of the device, in milliseconds; the least it offers if not given",
              "MILLISECONDS"},
             o.latency_ms, 0.1, 2000.0);
  add_text(app, {"--midi-api", "as --list-devices names them; all if not given", "API"},
           o.midi_api);
  add_texts(
      app,
      {"--midi-in", "part of a MIDI input's name; can be given again (all if not given)", "PORT"},
      o.midi_in);
}

void add_playing(CLI::App& app, SynthOptions& o) {
  using namespace command_line;
  add_text(app, {"PATCH", "patch or bank to play (.toml)", ""}, o.patch);
  add_text(app, {"--demo", "play a built-in demo, its song and its patch: " + demo_names(), "NAME"},
           o.demo);
  add_text(app, {"--song", "play this MIDI file (.mid) with PATCH, once, from the start", "FILE"},
           o.song);
  add_number(app, {"--volume", "of everything, in dB", "DB"}, o.volume_db, -96.0, 24.0);
  add_number(app, {"--threads", "threads to render with; changes no sample", ""}, o.threads, 1, 64);
  add_number(app, {"--seed", "seed of everything random", ""}, o.seed);
  add_text(app,
           {"--record",
            "record what is heard into this .wav or .flac, with .journal and .mid beside it, in "
            "place of older ones once it is whole; needs no sound device",
            "FILE"},
           o.record);
  add_number(app, {"--duration", "end by itself after this time", "SECONDS"}, o.duration_s, 0.001,
             1e9);
}

void add_control(CLI::App& app, SynthOptions& o) {
  using namespace command_line;
  add_checked(app,
              {"--osc", "listen for OSC at this UDP port of this machine, or at HOST:PORT", "PORT"},
              [&o](const std::string& text) { return read_osc(text, o.osc); });
  add_text(app, {"--midi-learn", "which controller moves what, kept in this file", "FILE"},
           o.midi_learn);
  add_flag(app, {"--plain", "a line a second, where something changed, instead of the page", ""},
           o.plain);
  add_flag(app, {"--json-status", "one JSON object a second on standard output, and no page", ""},
           o.json_status);
  add_choice(
      app,
      {"--simd",
       "vector unit of the processor: the best it has, AVX2 and no wider, or what all of its "
       "kind have; changes no sample (best if not given)",
       ""},
      {std::begin(kSimdNames), std::end(kSimdNames)}, [&o](std::size_t i) { o.simd = kSimdOf[i]; });
}

/// A take has a FILE.mid beside it, which would take the song's place.
bool is_song_written_over(const SynthOptions& o) {
  namespace fs = std::filesystem;
  std::error_code failed;
  return !o.record.empty() && !o.song.empty() &&
         fs::equivalent(fs::path(o.record).replace_extension(".mid"), o.song, failed);
}

/// What is wrong with values that are each good in themselves; empty when nothing is.
std::string conflict(const SynthOptions& o) {
  if (!o.demo.empty() && !o.patch.empty()) {
    return "--demo plays its own patch; leave out '" + o.patch + "'";
  }
  if (!o.demo.empty() && !demo::is_demo(o.demo)) return demo::unknown_demo(o.demo).message;
  for (const char* ending : {".mid", ".midi", ".rmi"}) {
    if (base::has_ending(o.patch, ending)) {
      return "'" + o.patch + "' is named as a MIDI file; play it with a patch or a bank: PATCH " +
             "--song '" + o.patch + "'";
    }
  }
  if (!o.song.empty() && !o.demo.empty()) {
    return "--demo plays its own song; leave out --song '" + o.song + "'";
  }
  if (!o.song.empty() && o.patch.empty()) {
    return "--song needs a patch or a bank to play '" + o.song + "' with: PATCH --song FILE";
  }
  if (o.plain && o.json_status) return "--plain and --json-status are two kinds of output; choose";
  const bool is_sound = base::has_ending(o.record, ".wav") || base::has_ending(o.record, ".flac");
  if (!o.record.empty() && !is_sound) {
    return "--record: '" + o.record + "' ends neither in .wav nor in .flac";
  }
  if (is_song_written_over(o)) {
    return "--record '" + o.record + "' writes a .mid of its own over the song '" + o.song +
           "'; give the take another name";
  }
  if (o.audio_api == "none" && !o.audio_device.empty()) {
    return "--audio-api none has no devices; leave out --audio-device '" + o.audio_device + "'";
  }
  return {};
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  CommandLine line;
  SynthOptions& options = line.options;
  CLI::App app(kAbout, "knotwave-synth");
  command_line::prepare(app, kMore);
  add_playing(app, options);
  add_devices(app, options);
  add_control(app, options);
  line.exit_code =
      command_line::read_words(app, argc, argv, [&options] { return conflict(options); });
  if (options.patch.empty() && options.demo.empty()) options.demo = "first-light";
  return line;
}

}  // namespace knotwave::synth

// SPDX-License-Identifier: MIT
// The only file of knotwave-render that knows CLI11.
#include "options.h"

#include <array>
#include <cstdio>
#include <string_view>

#include <CLI/CLI.hpp>

#include "knotwave/base/suggest.h"

#include "demo.h"
#include "exit_codes.h"

namespace knotwave::render {
namespace {

constexpr const char* kAbout =
    "Plays a MIDI file with a Knotwave patch or bank and writes the sound to a file.\n"
    "The same input gives the same samples on every machine, for any --block and --threads;\n"
    "the last line printed holds their SHA-256.";

constexpr const char* kMore =
    "Examples:\n"
    "  knotwave-render bell.toml song.mid -o song.wav\n"
    "  knotwave-render general-midi.toml song.mid -o song.flac --bits 16 --stems stems\n"
    "  knotwave-render --demo first-light -o first-light.wav\n"
    "  knotwave-render --check bell.toml song.mid\n"
    "  knotwave-render bell.toml song.mid -o - | aplay -t raw -f FLOAT_LE -c 2 -r 48000\n"
    "\n"
    "An output file is complete or not there: it is written beside its name and renamed at the "
    "end.\n"
    "Exit codes: 0 done, 1 failure, 2 wrong usage, 75 try again (disk full, out of memory),\n"
    "130 interrupted.";

std::string demo_names() {
  std::string names;
  for (const auto& name : names_of_demos()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

std::string parse_tail(const std::string& text, std::optional<double>& tail_s) {
  if (text == "auto") return {};
  double seconds = 0;
  if (!CLI::detail::lexical_cast(text, seconds) || !(seconds >= 0) || seconds > 3600) {
    return "--tail: '" + text + "' is neither 'auto' nor a number of seconds from 0 to 3600";
  }
  tail_s = seconds;
  return {};
}

io::SampleFormat sample_format(const std::string& word) {
  return word == "16"   ? io::SampleFormat::pcm16
         : word == "24" ? io::SampleFormat::pcm24
                        : io::SampleFormat::float32;
}

void add_options(CLI::App& app, RenderOptions& o, std::string& tail) {
  app.add_option("PATCH", o.patch, "patch or bank to play (.toml)");
  app.add_option("SCORE", o.score, "MIDI file to play (.mid, .rmi)");
  app.add_option("-o,--output", o.output,
                 "file to write: .wav or .flac by its ending; - writes headerless 32-bit float "
                 "samples, interleaved, to standard output");
  app.add_option("--demo", o.demo, "play a built-in demo instead: " + demo_names())
      ->type_name("NAME");
  app.add_flag("--check", o.check, "read everything, render nothing");
  app.add_option_function<std::string>(
         "--bits", [&o](const std::string& word) { o.format = sample_format(word); },
         "sample format: 16, 24 (both dithered) or 32f; 24 by default")
      ->check(CLI::IsMember({"16", "24", "32f"}).description(""))
      ->type_name("16|24|32f");
  app.add_option("--rate", o.rate_hz, "samples a second, 8000 to 768000")
      ->check(CLI::Range(8000, 768000).description(""))
      ->capture_default_str();
  app.add_option("--tail", tail,
                 "seconds after the song's end, or auto: until silence, 30 s at most")
      ->type_name("auto|SECONDS")
      ->capture_default_str();
  app.add_option("--max-length", o.max_length_s, "a song of more seconds is refused")
      ->check(CLI::Range(0.0, 1e9).description(""))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "seed of everything random")->capture_default_str();
  app.add_option("--stems", o.stems, "also write one file for each MIDI channel used, into DIR")
      ->type_name("DIR");
  app.add_option("--json", o.json, "write the report as JSON to FILE, or to standard output (-)")
      ->type_name("FILE|-");
  app.add_option("--block", o.block_frames, "samples rendered at once; changes no sample")
      ->check(CLI::Range(1, 65536).description(""))
      ->capture_default_str();
  app.add_option("--threads", o.threads, "threads to render with; changes no sample")
      ->check(CLI::Range(1, 64).description(""))
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--simd", [&o](const std::string& level) { o.baseline_simd = level == "baseline"; },
         "processor instructions: best there are, or baseline; changes no sample")
      ->check(CLI::IsMember({"best", "baseline"}).description(""))
      ->type_name("best|baseline");
  app.add_flag("-q,--quiet", o.quiet, "no progress and no warnings");
}

/// What is wrong with options that are each good in themselves; empty when nothing is.
std::string conflict(const RenderOptions& o) {
  const bool has_files = !o.patch.empty() || !o.score.empty();
  if (!o.demo.empty() && has_files) return "--demo plays its own patch and score";
  if (!o.demo.empty() && !is_demo(o.demo)) return unknown_demo(o.demo).message;
  if (o.demo.empty() && (o.patch.empty() || o.score.empty())) {
    return "a PATCH and a SCORE are needed, or --demo NAME";
  }
  if (!o.check && o.output.empty()) return "where to? -o FILE.wav, -o FILE.flac, -o - or --check";
  if (o.output == "-" && o.json == "-") return "-o - and --json - cannot share standard output";
  return {};
}

constexpr auto kOptionNames = std::to_array<std::string_view>(
    {"--help", "--version", "--output", "--demo", "--check", "--bits", "--rate", "--tail",
     "--max-length", "--seed", "--stems", "--json", "--block", "--threads", "--simd", "--quiet"});

/// The first word that looks like an option and is none; empty when there is none.
std::string unknown_option(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    const std::string_view name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || name.size() == 2) continue;
    if (std::find(kOptionNames.begin(), kOptionNames.end(), name) == kOptionNames.end()) {
      return std::string(name);
    }
  }
  return {};
}

int usage_error(const std::string& message) {
  std::fprintf(stderr, "knotwave-render: %s\nTry 'knotwave-render --help'.\n", message.c_str());
  return kExitUsage;
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  CommandLine line;
  std::string tail = "auto";
  CLI::App app(kAbout, "knotwave-render");
  app.footer(kMore);
  app.set_version_flag("--version", std::string("knotwave-render ") + KNOTWAVE_VERSION);
  app.get_formatter()->column_width(26);
  add_options(app, line.options, tail);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {
    line.exit_code = app.exit(done);
    return line;
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_option(argc, argv);
    line.exit_code = usage_error(unknown.empty() ? error.what()
                                                 : "unknown option '" + unknown + "'" +
                                                       base::suggestion(unknown, kOptionNames));
    return line;
  }
  std::string problem = parse_tail(tail, line.options.tail_s);
  if (problem.empty()) problem = conflict(line.options);
  if (!problem.empty()) line.exit_code = usage_error(problem);
  return line;
}

}  // namespace knotwave::render

// SPDX-License-Identifier: MIT
// The only file of knotwave-render that knows CLI11.
#include "options.h"

#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "knotwave/base/file.h"

#include "command_line/options.h"
#include "demo/demo.h"

namespace knotwave::render {
namespace {

constexpr const char* kAbout =
    "Plays a MIDI file with a Knotwave patch or bank and writes the sound to a file.\n"
    "The same input gives the same samples on every machine, for any --block and\n"
    "--threads; the last line printed holds their SHA-256.";

constexpr const char* kMore =
    "Examples:\n"
    "  knotwave-render bell.toml song.mid -o song.wav\n"
    "  knotwave-render general-midi.toml song.mid -o song.flac --bits 16 --stems stems\n"
    "  knotwave-render --demo first-light -o first-light.wav\n"
    "  knotwave-render --check bell.toml song.mid\n"
    "  knotwave-render bell.toml song.mid -o - | aplay -t raw -f FLOAT_LE -c 2 -r 48000\n"
    "\n"
    "An output file is complete or not there: it is written beside its name and\n"
    "renamed at the end.\n"
    "Exit codes: 0 done, 1 failure, 2 wrong usage, 75 try again (disk full, out of\n"
    "memory), 130 interrupted.";

constexpr const char* kSampleFormats[] = {"16", "24", "32f"};
constexpr io::SampleFormat kFormatOf[] = {io::SampleFormat::pcm16, io::SampleFormat::pcm24,
                                          io::SampleFormat::float32};

constexpr const char* kSimdNames[] = {"best", "avx2", "baseline"};
constexpr curves::SimdLevel kSimdOf[] = {curves::SimdLevel::best, curves::SimdLevel::avx2,
                                         curves::SimdLevel::baseline};

std::string demo_names() {
  std::string names;
  for (const auto& name : demo::names_of_demos()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

std::string read_tail(const std::string& text, std::optional<double>& tail_s) {
  if (text == "auto") return {};
  const auto seconds = command_line::number_in(text);
  if (!seconds || *seconds < 0 || *seconds > 3600) {
    return "'" + text + "' is neither 'auto' nor a number of seconds from 0 to 3600";
  }
  tail_s = *seconds;
  return {};
}

void add_input_and_output(CLI::App& app, RenderOptions& o) {
  using namespace command_line;
  add_text(app, {"PATCH", "patch or bank to play (.toml)", ""}, o.patch);
  add_text(app, {"SCORE", "MIDI file to play (.mid, .rmi), or - for standard input", ""}, o.score);
  add_text(app,
           {"-o,--output",
            "file to write: .wav or .flac by its ending; - writes headerless 32-bit float samples, "
            "interleaved, to standard output",
            "FILE|-"},
           o.output);
  add_text(app, {"--demo", "play a built-in demo instead: " + demo_names(), "NAME"}, o.demo);
  add_text(app,
           {"--journal", "play a recorded take again, with its own rate and seed: the same samples",
            "FILE"},
           o.journal);
  add_flag(app, {"--check", "read everything, render nothing; no output with it", ""}, o.check);
  add_text(app,
           {"--stems", "also write one file for each MIDI channel used, into this folder", "DIR"},
           o.stems);
  add_text(app,
           {"--json", "write the report as JSON to a file, or to standard output (-)", "FILE|-"},
           o.json);
  add_flag(app, {"-q,--quiet", "no progress and no warnings", ""}, o.quiet);
}

void add_sound(CLI::App& app, RenderOptions& o) {
  using namespace command_line;
  add_choice(
      app,
      {"--bits", "sample format: 16 or 24 bits, dithered, or 32-bit float (24 if not given)", ""},
      {std::begin(kSampleFormats), std::end(kSampleFormats)},
      [&o](std::size_t i) { o.format = kFormatOf[i]; });
  add_number(app, {"--rate", "samples a second; FLAC holds 655350 at most", "HZ"}, o.rate_hz, 8000,
             768000);
  add_checked(app,
              {"--tail",
               "how long to go on after the song's end: 0 to 3600 seconds, or auto: until silence, "
               "30 s at most (auto if not given)",
               "auto|SECONDS"},
              [&o](const std::string& text) { return read_tail(text, o.tail_s); });
  add_number(app, {"--max-length", "a longer song is refused", "SECONDS"}, o.max_length_s, 0.0,
             1e9);
  add_number(app, {"--seed", "seed of everything random", ""}, o.seed);
}

void add_speed(CLI::App& app, RenderOptions& o) {
  using namespace command_line;
  add_number(app, {"--block", "samples rendered at once; changes no sample", ""}, o.block_frames, 1,
             65536);
  add_number(app, {"--threads", "threads to render with; changes no sample", ""}, o.threads, 1, 64);
  add_choice(
      app,
      {"--simd",
       "vector unit of the processor: the best it has, AVX2 and no wider, or what all of its "
       "kind have; changes no sample (best if not given)",
       ""},
      {std::begin(kSimdNames), std::end(kSimdNames)}, [&o](std::size_t i) { o.simd = kSimdOf[i]; });
}

bool is_midi_name(std::string_view name) {
  return base::has_ending(name, ".mid") || base::has_ending(name, ".midi") ||
         base::has_ending(name, ".rmi");
}

/// What is wrong beside --journal, which says all by itself; empty when nothing is.
std::string journal_conflict(const CLI::App& app, const RenderOptions& o) {
  if (!o.patch.empty()) return "--journal has its own patches; leave out '" + o.patch + "'";
  for (const char* option : {"--demo", "--check", "--stems", "--rate", "--seed", "--tail"}) {
    if (app.count(option) > 0) {
      return std::string("--journal plays the take as it was; leave out ") + option;
    }
  }
  return {};
}

/// What is wrong with PATCH and SCORE; empty when nothing is.
std::string input_conflict(const RenderOptions& o) {
  if (!o.demo.empty()) {
    if (!o.patch.empty()) {
      return "--demo plays its own patch and score; leave out '" + o.patch + "'";
    }
    return demo::is_demo(o.demo) ? "" : demo::unknown_demo(o.demo).message;
  }
  if (o.patch.empty()) return "a PATCH and a SCORE are needed, or --demo NAME, or --journal FILE";
  if (is_midi_name(o.patch)) {
    return "the patch comes before the score, but '" + o.patch + "' is named as a MIDI file";
  }
  if (o.score.empty()) return "after the patch '" + o.patch + "' a SCORE is needed (.mid, .rmi)";
  return {};
}

/// What is wrong with outputs beside --check, which makes none; empty when nothing is.
std::string check_conflict(const RenderOptions& o) {
  const std::pair<const char*, const std::string&> outputs[] = {
      {"--output", o.output}, {"--json", o.json}, {"--stems", o.stems}};
  for (const auto& [name, value] : outputs) {
    if (value.empty()) continue;
    return "--check renders nothing; leave out " + std::string(name) + " '" + value + "'";
  }
  return {};
}

/// What is wrong with where the sound shall go; empty when nothing is.
std::string output_conflict(const RenderOptions& o) {
  if (o.check) return check_conflict(o);
  if (o.output.empty()) return "where to? -o FILE.wav, -o FILE.flac, -o - or --check";
  if (o.output == "-") {
    return o.json == "-" ? "-o - and --json - cannot share standard output" : "";
  }
  const bool is_flac = base::has_ending(o.output, ".flac");
  if (!is_flac && !base::has_ending(o.output, ".wav")) {
    return "--output: '" + o.output + "' ends neither in .wav nor in .flac";
  }
  if (is_flac && o.format == io::SampleFormat::float32) {
    return "FLAC holds 16 or 24 bits, not 32-bit float: use --bits 24 or a name that ends in .wav";
  }
  if (is_flac && !io::flac_holds_rate(o.rate_hz)) {
    return io::kFlacRates + std::string(", not ") + std::to_string(o.rate_hz) +
           " Hz: use another --rate or a name that ends in .wav";
  }
  return {};
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  CommandLine line;
  RenderOptions& options = line.options;
  CLI::App app(kAbout, "knotwave-render");
  command_line::prepare(app, kMore);
  add_input_and_output(app, options);
  add_sound(app, options);
  add_speed(app, options);
  line.exit_code = command_line::read_words(app, argc, argv, [&app, &options] {
    std::string fault =
        options.journal.empty() ? input_conflict(options) : journal_conflict(app, options);
    return fault.empty() ? output_conflict(options) : fault;
  });
  return line;
}

}  // namespace knotwave::render

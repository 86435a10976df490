// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "demo.h"
#include "event_feed.h"
#include "patch_warnings.h"
#include "render_job.h"

namespace knotwave::render {
namespace {

constexpr const char* kStandardInput = "/dev/stdin";

std::string warning_text(const std::string& file, const std::string& what) {
  return file + ": warning: " + what;
}

std::string warning_text(const std::string& file, const io::SongWarning& warning) {
  return file + ": byte " + std::to_string(warning.offset) + ": warning: " + warning.message;
}

/// The engine knows cycles by their file, so a file is cut in one way only.
Error two_frames(const engine::PatchSpec& patch, const std::string& oscillator,
                 const engine::WaveCycles& known, int frame) {
  Error error = fail(ErrorCode::value_out_of_range,
                     "'" + known.file + "' is cut into cycles of " + std::to_string(known.frame) +
                         " frames elsewhere, and of " + std::to_string(frame) +
                         " here (wave_frame): use a copy of the file");
  const engine::Place place = patch.place_of("oscillators." + oscillator + ".wave_frame");
  error.source = patch.source_name;
  error.line = place.line;
  error.column = place.column;
  return error;
}

/// The cycles of every sound file the patches name, each read once.
Result<std::vector<engine::WaveCycles>> read_waves(const engine::BankSpec& spec,
                                                   std::vector<std::string>& warnings) {
  std::vector<engine::WaveCycles> waves;
  for (const engine::PatchSpec& patch : spec.patches) {
    for (const engine::OscillatorSpec& oscillator : patch.oscillators) {
      const std::string& file = oscillator.wave_file;
      const int frame = oscillator.wave_frame;
      if (file.empty()) continue;
      const auto known = std::find_if(waves.begin(), waves.end(),
                                      [&](const auto& wave) { return wave.file == file; });
      if (known != waves.end()) {
        if (frame > 0 && frame != known->frame)
          return two_frames(patch, oscillator.name, *known, frame);
        continue;
      }
      auto cycles = io::read_cycles(file, frame);
      if (!cycles) return std::move(cycles).error();
      for (const auto& warning : cycles->warnings) warnings.push_back(warning_text(file, warning));
      waves.push_back({file, cycles->frame, cycles->rows, std::move(cycles->samples)});
    }
  }
  return waves;
}

Result<void> read_bank(const std::string& path, RenderInput& input) {
  const auto spec = engine::read_bank(path);
  if (!spec) return spec.error();
  for (const auto& patch : spec->patches) {
    for (auto& warning : patch_warnings(patch)) input.warnings.push_back(std::move(warning));
  }
  const auto waves = read_waves(*spec, input.warnings);
  if (!waves) return waves.error();
  for (const auto& file : spec->files) input.files.push_back({"a file the patch names,", file});
  for (const auto& wave : *waves) input.files.push_back({"a sound the patch names,", wave.file});
  auto bank = engine::BankProgram::create(*spec, *waves);
  if (!bank) return std::move(bank).error();
  input.bank = std::move(bank).value();
  return {};
}

Result<void> read_score(const std::string& path, RenderInput& input) {
  auto song = io::read_midi_file(path);
  if (!song) {
    Error error = std::move(song).error();
    if (path == kStandardInput) error.source = input.score_name;
    return error;
  }
  input.song = std::move(song).value();
  const std::string& name = input.score_name;
  for (const auto& warning : input.song.warnings) {
    input.warnings.push_back(warning_text(name, warning));
  }
  if (input.song.warnings_left_out > 0) {
    input.warnings.push_back(warning_text(
        name, std::to_string(input.song.warnings_left_out) + " more warnings are left out"));
  }
  return {};
}

// The score first: it is read in an instant, compiling a bank may take a while.
Result<RenderInput> read_files(const std::string& patch, const std::string& score,
                               const std::string& score_name) {
  RenderInput input;
  input.score_name = score_name;
  if (auto good = read_score(score, input); !good) return good.error();
  if (auto good = read_bank(patch, input); !good) return good.error();
  return input;
}

}  // namespace

Result<RenderInput> read_input(const RenderOptions& options) {
  if (options.demo.empty()) {
    const bool is_piped = options.score == "-";
    auto input = read_files(options.patch, is_piped ? kStandardInput : options.score,
                            is_piped ? "standard input" : options.score);
    if (!input) return input;
    input->files.push_back({"the patch", options.patch});
    input->files.push_back({"the score", options.score});
    return input;
  }
  const auto demo = DemoFiles::unpack(options.demo);
  if (!demo) return demo.error();
  auto input = read_files(demo->patch(), demo->score(), options.demo);
  if (input) input->files.clear();  // they are gone
  return input;
}

std::string check_line(const RenderOptions& options, const RenderInput& input) {
  const EventFeed feed(input.song, options.rate_hz);
  const double seconds = static_cast<double>(feed.end().sample) / options.rate_hz;
  std::string line = input.score_name + ": ok: " + std::to_string(input.song.track_count) +
                     (input.song.track_count == 1 ? " track, " : " tracks, ") +
                     std::to_string(input.song.events.size()) +
                     (input.song.events.size() == 1 ? " event, " : " events, ") +
                     fixed(seconds, 3) + " s";
  if (seconds > options.max_length_s) line += "; --max-length would refuse to render it";
  return io::printable(line, 4096);
}

}  // namespace knotwave::render

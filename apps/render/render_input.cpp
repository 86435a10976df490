// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "bank_input/bank_input.h"
#include "command_line/output.h"
#include "demo/demo.h"
#include "render_job.h"
#include "song/event_feed.h"
#include "song/song_file.h"

namespace knotwave::render {
namespace {

constexpr const char* kStandardInput = "/dev/stdin";

Result<void> read_bank(const std::string& path, RenderInput& input) {
  auto bank = bank_input::read(path);
  if (!bank) return std::move(bank).error();
  input.bank = std::move(bank->program);
  for (auto& warning : bank->warnings) input.warnings.push_back(std::move(warning));
  for (const auto& file : bank->spec.files)
    input.files.push_back({"a file the patch names,", file});
  for (const auto& file : bank->sounds) input.files.push_back({"a sound the patch names,", file});
  return {};
}

Result<void> read_score(const std::string& path, RenderInput& input) {
  auto file = song::read(path, input.score_name);
  if (!file) return std::move(file).error();
  input.song = std::move(file->song);
  for (auto& warning : file->warnings) input.warnings.push_back(std::move(warning));
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
    if (is_piped && command_line::is_standard_input_closed()) {
      return fail(ErrorCode::io_failed,
                  "the score is -, standard input, but that is closed: name a MIDI file, or put "
                  "one in (knotwave-render PATCH - <SCORE.mid)");
    }
    auto input = read_files(options.patch, is_piped ? kStandardInput : options.score,
                            is_piped ? "standard input" : options.score);
    if (!input) return input;
    input->files.push_back({"the patch", options.patch});
    input->files.push_back({"the score", options.score});
    return input;
  }
  const auto demo = demo::DemoFiles::unpack(options.demo);
  if (!demo) return demo.error();
  auto input = read_files(demo->patch(), demo->score(), options.demo);
  if (input) input->files.clear();  // they are gone
  return input;
}

std::string check_line(const RenderOptions& options, const RenderInput& input) {
  const song::EventFeed feed(input.song, options.rate_hz);
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

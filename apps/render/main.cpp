// SPDX-License-Identifier: MIT
// knotwave-render: a patch and a score become a sound file. Signals, messages and exit codes.
#include <csignal>
#include <cstdio>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/simd.h"

#include "command_line/exit_codes.h"
#include "command_line/messages.h"
#include "command_line/output.h"
#include "missing_patches.h"
#include "options.h"
#include "output_places.h"
#include "progress.h"
#include "render_job.h"
#include "render_journal.h"

namespace {

using namespace knotwave;
using namespace knotwave::command_line;
using namespace knotwave::render;

constexpr std::size_t kWarningsShown = 20;

/// Leaves no unfinished file behind, whatever the program is doing just now.
extern "C" void stop_at_signal(int) {
  base::remove_unfinished_files();
  // The empty line keeps the progress bar readable where there is one.
  constexpr std::string_view kMessage =
      "\nknotwave-render: interrupted; no unfinished file is left\n";
  const std::string_view text = kMessage.substr(is_progress_drawn() ? 0 : 1);
  [[maybe_unused]] const auto count = ::write(STDERR_FILENO, text.data(), text.size());
  ::_exit(kExitInterrupted);
}

void set_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Who starts us with a signal ignored (nohup, a job in the background) wants it so.
    if (std::signal(signal, stop_at_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);  // the write fails then
}

int say(const Error& error) { return say_error("knotwave-render", error); }
int print(const std::string& text) { return command_line::print("knotwave-render", text); }

void say_warnings(const std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < warnings.size() && i < kWarningsShown; ++i) {
    std::fprintf(stderr, "%s\n", io::printable(warnings[i], 400).c_str());
  }
  if (warnings.size() > kWarningsShown) {
    std::fprintf(stderr, "and %zu more warnings; --json lists them\n",
                 warnings.size() - kWarningsShown);
  }
}

/// The file the JSON goes to, if it goes to one: opened before the long work, so that a place that
/// cannot be written is told at once.
Result<std::optional<base::AtomicFile>> open_json(const RenderOptions& options) {
  std::optional<base::AtomicFile> file;
  if (options.json.empty() || options.json == "-") return file;
  auto created = base::AtomicFile::create(options.json);
  if (!created) return created.error();
  file = std::move(created).value();
  return file;
}

/// The report goes where the samples and the JSON do not.
int say_report(const RenderOptions& options, const RenderReport& report,
               std::optional<base::AtomicFile>& json_file) {
  const bool is_stdout_taken = options.output == "-" || options.json == "-";
  const std::string line = report_line(report) + "\n";
  int code = kExitOk;
  if (is_stdout_taken) {
    std::fputs(line.c_str(), stderr);
  } else {
    code = print(line);
  }
  if (options.json.empty()) return code;
  const std::string json = report_json(report);
  if (!json_file) return print(json);
  if (auto good = json_file->write(std::as_bytes(std::span(json))); !good) return say(good.error());
  const auto good = json_file->commit();
  return good ? code : say(good.error());
}

int check(const RenderOptions& options, const RenderInput& input) {
  std::vector<std::string> warnings = input.warnings;
  if (const std::string what = find_missing_patches(input); !what.empty()) {
    warnings.push_back(input.score_name + ": warning: " + what);
  }
  if (!options.quiet) say_warnings(warnings);
  return print(check_line(options, input) + "\n");
}

int run_journal(const RenderOptions& options) {
  const std::string overlap = output_overlap(options, {});
  if (!overlap.empty()) return say_usage("knotwave-render", overlap);
  auto json_file = open_json(options);
  if (!json_file) return say(json_file.error());
  const auto report = render_journal(options);
  if (!report) return say(report.error());
  if (!options.quiet) say_warnings(report->warnings);
  return say_report(options, *report, *json_file);
}

int run(const RenderOptions& options) {
  if (const auto set = curves::set_simd_level(options.simd); !set) {
    return say(fail(set.error().code, "--simd: " + set.error().message));
  }
  if (!options.journal.empty()) return run_journal(options);
  const auto input = read_input(options);
  if (!input) return say(input.error());
  const std::string overlap = output_overlap(options, *input);
  if (!overlap.empty()) return say_usage("knotwave-render", overlap);
  if (options.check) return check(options, *input);
  auto json_file = open_json(options);
  if (!json_file) return say(json_file.error());
  const auto report = render::render(options, *input);
  if (!report) return say(report.error());
  if (!options.quiet) say_warnings(report->warnings);
  return say_report(options, *report, *json_file);
}

}  // namespace

int main(int argc, char** argv) {
  guard_standard_streams();
  set_signals();
  try {
    const CommandLine line = read_command_line(argc, argv);
    return line.exit_code ? *line.exit_code : run(line.options);
  } catch (const std::bad_alloc&) {
    base::remove_unfinished_files();
    std::fputs("knotwave-render: error: out of memory\n", stderr);
    return kExitTryAgain;
  }
}

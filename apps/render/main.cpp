// SPDX-License-Identifier: MIT
// knotwave-render: a patch and a score become a sound file. Signals, messages and exit codes.
#include <csignal>
#include <cstdio>
#include <new>

#include <unistd.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/curve_program.h"

#include "exit_codes.h"
#include "options.h"
#include "render_job.h"

namespace {

using namespace knotwave;
using namespace knotwave::render;

constexpr std::size_t kWarningsShown = 20;

/// Leaves no unfinished file behind, whatever the program is doing just now.
extern "C" void stop_at_signal(int) {
  base::remove_unfinished_files();
  constexpr char kMessage[] = "\nknotwave-render: interrupted; no unfinished file is left\n";
  [[maybe_unused]] const auto count = ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  ::_exit(kExitInterrupted);
}

void set_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, stop_at_signal);
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);  // the write fails then
}

int say(const Error& error) {
  const std::string prefix = error.source.empty() ? "knotwave-render: " : "";
  std::fprintf(stderr, "%s%s\n", prefix.c_str(), error.to_string().c_str());
  return exit_code_of(error.code);
}

void say_warnings(const std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < warnings.size() && i < kWarningsShown; ++i) {
    std::fprintf(stderr, "%s\n", io::printable(warnings[i], 400).c_str());
  }
  if (warnings.size() > kWarningsShown) {
    std::fprintf(stderr, "and %zu more warnings; --json lists them\n",
                 warnings.size() - kWarningsShown);
  }
}

/// The report goes where the samples and the JSON do not.
int say_report(const RenderOptions& options, const RenderReport& report) {
  const bool is_stdout_taken = options.output == "-" || options.json == "-";
  std::fprintf(is_stdout_taken ? stderr : stdout, "%s\n", report_line(report).c_str());
  if (options.json.empty()) return kExitOk;
  const std::string json = report_json(report);
  if (options.json == "-") return std::fputs(json.c_str(), stdout) < 0 ? kExitFailure : kExitOk;
  const auto written = base::write_file(options.json, json);
  return written ? kExitOk : say(written.error());
}

int run(const RenderOptions& options) {
  if (options.baseline_simd) curves::set_simd_level(curves::SimdLevel::baseline);
  const auto input = read_input(options);
  if (!input) return say(input.error());
  if (options.check) {
    if (!options.quiet) say_warnings(input->warnings);
    std::printf("%s\n", check_line(options, *input).c_str());
    return kExitOk;
  }
  const auto report = render::render(options, *input);
  if (!report) return say(report.error());
  if (!options.quiet) say_warnings(report->warnings);
  return say_report(options, *report);
}

}  // namespace

int main(int argc, char** argv) {
  set_signals();
  try {
    const CommandLine line = read_command_line(argc, argv);
    const int code = line.exit_code ? *line.exit_code : run(line.options);
    return std::fflush(stdout) == 0 ? code : kExitFailure;
  } catch (const std::bad_alloc&) {
    base::remove_unfinished_files();
    std::fputs("knotwave-render: error: out of memory\n", stderr);
    return kExitTryAgain;
  }
}

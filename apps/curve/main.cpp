// SPDX-License-Identifier: MIT
// knotwave-curve: checks, describes, evaluates, draws, edits and fits curves. Messages and exit
// codes.
#include <csignal>
#include <cstdio>
#include <new>

#include "knotwave/base/file.h"

#include "command_line/exit_codes.h"
#include "command_line/messages.h"
#include "command_line/output.h"
#include "curve_output.h"
#include "options.h"
#include "verbs.h"

namespace {

using namespace knotwave;
using namespace knotwave::command_line;
using namespace knotwave::curve_app;

int say(const Error& error) { return say_error("knotwave-curve", error); }

int print(const std::string& text) { return command_line::print("knotwave-curve", text); }

int print(const Result<std::string>& text) { return text ? print(*text) : say(text.error()); }

/// To the file, and the report to standard output; without a file to standard output, and the
/// report to standard error.
int deliver(const CurveOptions& options, const Result<Made>& made) {
  if (!made) return say(made.error());
  if (options.output.empty() || options.output == "-") {
    const int code = print(made->text);
    if (code == kExitOk) std::fputs(made->report.c_str(), stderr);
    return code;
  }
  const auto written = base::write_file(options.output, made->text);
  return written ? print(options.output + ": written\n" + made->report) : say(written.error());
}

Result<Made> make(const CurveOptions& options) {
  const std::string overlap = output_overlap(options);
  if (!overlap.empty()) return fail(ErrorCode::usage, overlap);
  switch (options.verb) {
    case Verb::split:
      return split_in_two(options);
    case Verb::insert_knot:
      return with_knots(options);
    case Verb::elevate:
      return elevated(options);
    case Verb::simplify:
      return simplified(options);
    case Verb::morph:
      return morphed(options);
    case Verb::iso:
      return iso_curves(options);
    case Verb::fit:
      return fitted(options);
    case Verb::import_svg:
      return imported(options);
    default:
      return exported(options);
  }
}

int run(const CurveOptions& options) {
  switch (options.verb) {
    case Verb::check: {
      bool failed = false;
      const int code = print(check_text(options, failed));
      return failed ? kExitFailure : code;
    }
    case Verb::info:
      return print(info_text(options));
    case Verb::eval:
      return print(eval_text(options));
    case Verb::plot:
      return print(plot_text_or_file(options));
    default:
      return deliver(options, make(options));
  }
}

}  // namespace

int main(int argc, char** argv) {
  guard_standard_streams();
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is a failed write
  try {
    const CommandLine line = read_command_line(argc, argv);
    return line.exit_code ? *line.exit_code : run(line.options);
  } catch (const std::bad_alloc&) {
    std::fputs("knotwave-curve: error: out of memory\n", stderr);
    return kExitTryAgain;
  }
}

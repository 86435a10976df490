// SPDX-License-Identifier: MIT
// knotwave-curve: checks, describes, evaluates and draws curves. Messages and exit codes.
#include <csignal>
#include <cstdio>
#include <new>

#include "command_line/exit_codes.h"
#include "command_line/messages.h"
#include "command_line/output.h"
#include "options.h"
#include "verbs.h"

namespace {

using namespace knotwave;
using namespace knotwave::command_line;
using namespace knotwave::curve_app;

int say(const Error& error) { return say_error("knotwave-curve", error); }

int print(const std::string& text) { return command_line::print("knotwave-curve", text); }

int print(const Result<std::string>& text) { return text ? print(*text) : say(text.error()); }

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
  }
  return kExitUsage;
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

// SPDX-License-Identifier: MIT
// knotwave-env: signals, messages and exit codes.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <unistd.h>

#include "knotwave/base/file.h"
#include "knotwave/io/audio_device.h"

#include "capture.h"
#include "command_line/exit_codes.h"
#include "command_line/messages.h"
#include "command_line/output.h"
#include "env_input.h"
#include "live.h"
#include "offline.h"
#include "options.h"

namespace {

using namespace knotwave;
using namespace knotwave::command_line;
using namespace knotwave::env;

constexpr const char* kProgram = "knotwave-env";

std::atomic<int> signals{0};
std::atomic<int> last_signal{0};
std::atomic<bool> is_live{false};

/// The first one brings everything to rest; who sends a second has no patience.
extern "C" void end_at_signal(int signal) {
  last_signal = signal;
  if (signals.fetch_add(1) == 0 && is_live) return;
  base::remove_unfinished_files();
  ::_exit(kExitInterrupted);
}

void set_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Who starts us with a signal ignored (nohup, a job in the background) wants it so.
    if (std::signal(signal, end_at_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);  // the write fails then
}

int say(const Error& error) { return say_error(kProgram, error); }

int play(const EnvOptions& options, const EnvInput& input) {
  is_live = true;
  auto live = Live::open(options, input);
  if (!live) return say(live.error());
  const Live::End end = (*live)->run(signals);
  if (end == Live::End::signal && last_signal == SIGINT) return kExitInterrupted;
  return kExitOk;
}

int capture(const EnvOptions& options) {
  is_live = options.capture.from.empty();
  const auto text = run_capture(options, signals);
  return text ? print(kProgram, *text) : say(text.error());
}

int run(const EnvOptions& options) {
  if (options.list) return print(kProgram, device_list());
  if (!options.capture.word.empty()) return capture(options);
  const auto input = read_input(options);
  if (!input) return say(input.error());
  for (const std::string& line : input->warnings) {
    if (!options.quiet) std::fprintf(stderr, "%s\n", io::printable(line, 4096).c_str());
  }
  if (options.dry_run.empty()) return play(options, *input);
  const auto lines = run_offline(options, *input);
  return lines ? print(kProgram, *lines) : say(lines.error());
}

/// Threads that hang in a library are left to the system.
[[noreturn]] void leave(int code) {
  std::fflush(nullptr);
  if (!io::AudioStream::is_poisoned()) std::exit(code);
  ::_exit(code);
}

}  // namespace

int main(int argc, char** argv) {
  guard_standard_streams();
  set_signals();
  try {
    const CommandLine line = read_command_line(argc, argv);
    leave(line.exit_code ? *line.exit_code : run(line.options));
  } catch (const std::bad_alloc&) {
    base::remove_unfinished_files();
    std::fprintf(stderr, "%s: out of memory\n", kProgram);
    return kExitTryAgain;
  }
}

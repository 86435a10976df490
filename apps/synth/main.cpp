// SPDX-License-Identifier: MIT
// knotwave-synth: signals, messages, exit codes, and a start anew where a device asks for it.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/simd.h"

#include "bank_loader.h"
#include "command_line/exit_codes.h"
#include "command_line/messages.h"
#include "command_line/output.h"
#include "demo/demo.h"
#include "device_list.h"
#include "options.h"
#include "stream_opener.h"
#include "synth.h"
#include "terminal.h"

namespace {

using namespace knotwave;
using namespace knotwave::command_line;
using namespace knotwave::synth;

constexpr const char* kProgram = "knotwave-synth";

std::atomic<int> signals{0};
std::atomic<int> last_signal{0};

/// The first one fades out; who sends a second has no patience.
extern "C" void end_at_signal(int signal) {
  last_signal = signal;
  if (signals.fetch_add(1) == 0) return;
  restore_terminal();
  base::remove_unfinished_files();
  ::_exit(kExitInterrupted);
}

/// A fault of ours: the terminal is put back, then what would have happened happens.
extern "C" void restore_and_die(int signal) {
  restore_terminal();
  base::remove_unfinished_files();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// Ctrl-Z: the shell gets its terminal as it was.
extern "C" void stop_for_now(int) {
  restore_terminal();
  std::raise(SIGSTOP);
  retake_terminal();
}

void set_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Who starts us with a signal ignored (nohup, a job in the background) wants it so.
    if (std::signal(signal, end_at_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGQUIT}) {
    std::signal(signal, restore_and_die);
  }
  if (std::signal(SIGTSTP, stop_for_now) == SIG_IGN) std::signal(SIGTSTP, SIG_IGN);
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);  // the write fails then
  // Pages written from the background wait for nobody.
  std::signal(SIGTTOU, SIG_IGN);
  std::atexit(restore_terminal);
}

/// Held back until the next program lets them through: none is lost between the two.
void hold_signals(int how) {
  sigset_t ends;
  ::sigemptyset(&ends);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&ends, signal);
  ::pthread_sigmask(how, &ends, nullptr);
}

int say(const Error& error) { return say_error(kProgram, error); }

/// What a service manager or a shell expects of an end that was asked for.
int exit_code_of_signal() { return last_signal == SIGINT ? kExitInterrupted : kExitOk; }

/// What is to be played: as the command line says, or as a program that was started anew did.
Result<Performance> performance(const SynthOptions& options, const Resume& resume,
                                const std::optional<demo::DemoFiles>& demo) {
  Performance performance;
  std::string path = demo ? demo->patch() : options.patch;
  if (demo && !resume.demo_file.empty()) path = demo->folder() + resume.demo_file;
  if (!resume.patch.empty()) path = resume.patch;
  auto bank = read_playable(path);
  if (!bank) return std::move(bank).error();
  performance.bank = *std::move(bank);
  if (demo && path == demo->patch()) performance.name = "demo " + options.demo;
  const std::string file = demo ? demo->score() : options.song;
  const bool is_song_over = !resume.is_first_start() && resume.song_s < 0;
  if (file.empty() || is_song_over) return performance;
  performance.song_name = demo ? options.demo : file;
  auto song = song::read(file, performance.song_name);
  if (!song) return std::move(song).error();
  performance.song = *std::move(song);
  return performance;
}

int play(const SynthOptions& options, char** argv) {
  const Resume resume = take_resume();
  std::optional<demo::DemoFiles> demo;
  if (!options.demo.empty()) {
    auto unpacked = demo::DemoFiles::unpack(options.demo);
    if (!unpacked) return say(unpacked.error());
    demo.emplace(std::move(unpacked).value());
  }
  auto asked = performance(options, resume, demo);
  if (!asked) return say(asked.error());
  auto synth = Synth::open(options, *std::move(asked), resume);
  if (!synth) return say(synth.error());
  const Synth::End end = (*synth)->run(signals);
  Resume next = (*synth)->resume();
  if (demo && next.patch.starts_with(demo->folder())) {
    next.demo_file = next.patch.substr(demo->folder().size());
    next.patch.clear();  // its files go with this process
  }
  const bool has_failed = (*synth)->has_failed();
  synth->reset();
  demo.reset();
  if (end == Synth::End::restart) {
    hold_signals(SIG_BLOCK);
    if (signals == 0) return say(restart_program(next, argv));
    return exit_code_of_signal();
  }
  if (end == Synth::End::signal) return exit_code_of_signal();
  return has_failed ? kExitFailure : kExitOk;
}

int run(const SynthOptions& options, char** argv) {
  if (const auto set = curves::set_simd_level(options.simd); !set) {
    return say(fail(set.error().code, "--simd: " + set.error().message));
  }
  if (options.list_devices) return print(kProgram, device_list());
  return play(options, argv);
}

/// Threads that hang in a library or in a pipe are left to the system.
[[noreturn]] void leave(int code) {
  std::fflush(nullptr);
  const bool is_any_left = StreamOpener::is_any_under_way() || BankLoader::is_any_under_way();
  if (!is_any_left && !io::AudioStream::is_poisoned()) std::exit(code);
  restore_terminal();
  ::_exit(code);
}

}  // namespace

int main(int argc, char** argv) {
  guard_standard_streams();
  set_signals();
  hold_signals(SIG_UNBLOCK);
  try {
    const CommandLine line = read_command_line(argc, argv);
    leave(line.exit_code ? *line.exit_code : run(line.options, argv));
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: out of memory\n", kProgram);
    return kExitTryAgain;
  } catch (const std::system_error& fault) {
    std::fprintf(stderr, "%s: the system starts no more threads: %s\n", kProgram,
                 fault.code().message().c_str());
    return kExitTryAgain;
  }
}

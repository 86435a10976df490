// SPDX-License-Identifier: MIT
#include "support/program.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace knotwave::support {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

[[noreturn]] void become(const std::vector<std::string>& argv, const ProgramOptions& options,
                         int out, int err) {
  // Whatever we were born with ourselves.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  if (options.is_in_background) std::signal(SIGINT, SIG_IGN);
  const int null = open("/dev/null", O_RDONLY);
  dup2(null, 0);
  dup2(out, 1);
  dup2(err, 2);
  for (int fd = 3; fd < 64; ++fd) close(fd);
  const auto set_limit = [](auto resource, long bytes) {
    const rlimit limit{rlim_t(bytes), rlim_t(bytes)};
    if (bytes >= 0) setrlimit(resource, &limit);
  };
  set_limit(RLIMIT_FSIZE, options.max_file_bytes);
  set_limit(RLIMIT_AS, options.max_address_bytes);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
  std::string program = argv[0];
  if (program.find('/') == std::string::npos) program = std::string(KNOTWAVE_BIN_DIR "/") + program;
  std::vector<char*> raw;
  for (const auto& word : argv) raw.push_back(const_cast<char*>(word.c_str()));
  raw.push_back(nullptr);
  execvp(program.c_str(), raw.data());
  _exit(127);
}

/// Reads what is there; false at the end of the stream.
bool drain(int fd, std::string& into, const ProgramOptions& options, bool is_output) {
  std::array<char, 65536> buffer;
  const ssize_t n = read(fd, buffer.data(), buffer.size());
  if (n <= 0) return false;
  if (is_output && options.on_output) {
    options.on_output(std::span<const char>(buffer.data(), static_cast<std::size_t>(n)));
  } else {
    into.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& argv, const ProgramOptions& options) {
  ProgramRun run;
  int out[2], err[2];
  if (pipe(out) != 0 || pipe(err) != 0) return run;
  const auto start = Clock::now();
  const pid_t child = fork();
  if (child == 0) become(argv, options, out[1], err[1]);
  close(out[1]);
  close(err[1]);

  bool interrupted = false, killed = false;
  pollfd fds[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  while (fds[0].fd >= 0 || fds[1].fd >= 0) {
    poll(fds, 2, 5);
    if (fds[0].revents != 0 && !drain(out[0], run.out, options, true)) fds[0].fd = -1;
    if (fds[1].revents != 0 && !drain(err[0], run.err, options, false)) fds[1].fd = -1;
    const double now = seconds_since(start);
    if (options.interrupt_after_s > 0 && !interrupted && now > options.interrupt_after_s) {
      kill(child, SIGINT);
      interrupted = true;
    }
    const double limit = options.kill_after_s > 0 ? options.kill_after_s : options.timeout_s;
    if (!killed && now > limit) {
      kill(child, SIGKILL);
      killed = true;
    }
  }
  close(out[0]);
  close(err[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  run.wall_s = seconds_since(start);
  const auto as_seconds = [](timeval t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  run.cpu_s = as_seconds(usage.ru_utime) + as_seconds(usage.ru_stime);
  run.max_rss_kib = usage.ru_maxrss;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
}

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "knotwave-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) std::abort();
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace knotwave::support

// SPDX-License-Identifier: MIT
#include "live/synth_process.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utmp.h>

namespace knotwave::synth {
namespace {

[[noreturn]] void become(const std::vector<std::string>& words, const std::string& folder) {
  for (int fd = 3; fd < 256; ++fd) ::close(fd);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  if (!folder.empty() && ::chdir(folder.c_str()) != 0) ::_exit(126);
  std::vector<char*> raw;
  for (const std::string& word : words) raw.push_back(const_cast<char*>(word.c_str()));
  raw.push_back(nullptr);
  ::execv(KNOTWAVE_BIN_DIR "/knotwave-synth", raw.data());
  ::_exit(127);
}

bool comes_true(double timeout_s, const auto& is_so) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace

SynthProcess::SynthProcess(std::vector<std::string> words, const Options& options) {
  words.insert(words.begin(), "knotwave-synth");
  int out[2] = {-1, -1}, err[2] = {-1, -1};
  if (options.has_terminal) {
    winsize size{30, 100, 0, 0};
    if (::openpty(&terminal_, &terminal_other_, nullptr, nullptr, &size) != 0) std::abort();
    // A server that is started meanwhile must not keep the terminal open.
    for (const int fd : {terminal_, terminal_other_}) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
  } else if (::pipe(out) != 0 || ::pipe(err) != 0) {
    std::abort();
  }
  process_ = ::fork();
  if (process_ == 0) {
    if (options.has_terminal) {
      ::login_tty(terminal_other_);
      ::setenv("TERM", "xterm", 1);
    } else {
      ::dup2(::open("/dev/null", O_RDONLY), 0);
      ::dup2(out[1], 1);
      ::dup2(err[1], 2);
    }
    if (options.is_stdin_closed) ::close(0);
    become(words, options.folder);
  }
  if (options.has_terminal) {
    listeners_.emplace_back([this] { listen(::dup(terminal_), out_); });
    return;
  }
  ::close(out[1]);
  ::close(err[1]);
  listeners_.emplace_back([this, fd = out[0]] { listen(fd, out_); });
  listeners_.emplace_back([this, fd = err[0]] { listen(fd, err_); });
}

SynthProcess::~SynthProcess() {
  if (exit_code(0) < 0) {
    ::kill(process_, SIGKILL);
    exit_code(10);
  }
  if (terminal_other_ >= 0) ::close(terminal_other_);
  for (std::thread& listener : listeners_) listener.join();
  if (terminal_ >= 0) ::close(terminal_);
}

void SynthProcess::listen(int descriptor, std::string& into) {
  std::array<char, 65536> bytes;
  for (;;) {
    const ssize_t count = ::read(descriptor, bytes.data(), bytes.size());
    if (count <= 0) break;
    const std::lock_guard lock(mutex_);
    into.append(bytes.data(), static_cast<std::size_t>(count));
  }
  ::close(descriptor);
}

std::string SynthProcess::out() const {
  const std::lock_guard lock(mutex_);
  return out_;
}

std::string SynthProcess::err() const {
  const std::lock_guard lock(mutex_);
  return err_;
}

bool SynthProcess::says(const std::string& text, double timeout_s) const {
  return comes_true(timeout_s, [&] {
    return out().find(text) != std::string::npos || err().find(text) != std::string::npos;
  });
}

std::string SynthProcess::field(const std::string& name) const {
  const std::string all = out();
  const std::size_t end = all.rfind('\n');
  if (end == std::string::npos) return {};
  const std::size_t before = end == 0 ? std::string::npos : all.rfind('\n', end - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const std::string line = all.substr(begin, end - begin), key = "\"" + name + "\": ";
  const std::size_t at = line.find(key);
  if (at == std::string::npos) return {};
  std::string value = line.substr(at + key.size());
  if (value.starts_with('"')) return value.substr(1, value.find('"', 1) - 1);
  return value.substr(0, value.find_first_of(",}"));
}

double SynthProcess::number(const std::string& name) const {
  const std::string value = field(name);
  return value.empty() || value == "null" ? -1e9 : std::atof(value.c_str());
}

void SynthProcess::type(const std::string& keys) {
  [[maybe_unused]] const auto count = ::write(terminal_, keys.data(), keys.size());
}

void SynthProcess::signal(int number) const { ::kill(process_, number); }

int SynthProcess::exit_code(double timeout_s) {
  comes_true(timeout_s, [&] {
    int status = 0;
    if (exit_code_ >= 0) return true;
    if (::waitpid(process_, &status, WNOHANG) != process_) return false;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return true;
  });
  if (exit_code_ >= 0 && terminal_ < 0) {  // all it said is there
    for (std::thread& listener : listeners_) listener.join();
    listeners_.clear();
  }
  return exit_code_;
}

}  // namespace knotwave::synth

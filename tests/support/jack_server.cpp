// SPDX-License-Identifier: MIT
#include "support/jack_server.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace knotwave::support {
namespace {

void find_only(const std::string& name) {
  setenv("JACK_DEFAULT_SERVER", name.c_str(), 1);
  setenv("JACK_NO_START_SERVER", "1", 1);
}

// The child must call nothing that allocates: another thread may hold the lock of malloc.
[[noreturn]] void become(std::vector<char*> argv, int log) {
  setsid();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execvp(argv[0], argv.data());
  _exit(127);
}

}  // namespace

JackServer::JackServer(int block_frames, int rate_hz)
    : block_frames_(block_frames),
      rate_hz_(rate_hz),
      name_("knotwave-test-" + std::to_string(getpid())) {
  find_only(name_);
  launch();
}

JackServer::~JackServer() {
  end(SIGTERM);
  unsetenv("JACK_DEFAULT_SERVER");
  // What a server leaves behind that was killed.
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    if (entry.path().filename().string().find(name_) != std::string::npos) {
      std::filesystem::remove_all(entry.path(), ignored);
    }
  }
}

void JackServer::launch() {
  const std::string rate = std::to_string(rate_hz_), block = std::to_string(block_frames_);
  std::vector<std::string> words = {"jackd", "-n", name_, "-r", "-S", "-d",
                                    "dummy", "-r", rate,  "-p", block};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int log =
      open(folder_.file("log").c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644);
  process_ = fork();
  if (process_ == 0) become(argv, log);
  close(log);
  runs_ = run_program({"/bin/sh", "-c", "exec jack_wait -w -t 10"}).exit_code == 0 &&
          waitpid(process_, nullptr, WNOHANG) == 0;
}

void JackServer::end(int signal) {
  if (process_ <= 0) return;
  ::kill(process_, SIGCONT);
  ::kill(process_, signal);
  waitpid(process_, nullptr, 0);
  process_ = -1;
  runs_ = false;
}

void JackServer::kill() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = -1;
  runs_ = false;
}

void JackServer::pause() { ::kill(process_, SIGSTOP); }
void JackServer::resume() { ::kill(process_, SIGCONT); }

bool JackServer::restart() {
  end(SIGKILL);
  launch();
  return runs_;
}

std::string JackServer::log() const {
  std::ostringstream text;
  text << std::ifstream(folder_.file("log")).rdbuf();
  return text.str();
}

NoJackServer::NoJackServer() { find_only("knotwave-test-none-" + std::to_string(getpid())); }

NoJackServer::~NoJackServer() { unsetenv("JACK_DEFAULT_SERVER"); }

}  // namespace knotwave::support

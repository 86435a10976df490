// SPDX-License-Identifier: MIT
#include "support/background_program.h"

#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace knotwave::support {
namespace {

// The child must call nothing that allocates: another thread may hold the lock of malloc.
[[noreturn]] void become(char* const* argv, int log) {
  setsid();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execvp(argv[0], argv);
  _exit(127);
}

}  // namespace

BackgroundProgram::BackgroundProgram(std::vector<std::string> argv, const std::string& log) {
  std::vector<char*> words;
  for (std::string& word : argv) words.push_back(word.data());
  words.push_back(nullptr);
  const int file = open(log.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644);
  process_ = fork();
  if (process_ == 0) become(words.data(), file);
  close(file);
}

BackgroundProgram::~BackgroundProgram() { end(SIGTERM); }

bool BackgroundProgram::runs() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
  return process_ > 0;
}

void BackgroundProgram::signal(int number) const {
  if (process_ > 0) kill(process_, number);
}

// A program that was stopped would not hear of it.
void BackgroundProgram::end(int number) {
  if (process_ <= 0) return;
  kill(process_, number);
  kill(process_, SIGCONT);
  waitpid(process_, nullptr, 0);
  process_ = -1;
}

SetVariable::SetVariable(std::string name, const std::string& value) : name_(std::move(name)) {
  const char* const before = std::getenv(name_.c_str());
  was_set_ = before != nullptr;
  if (was_set_) before_ = before;
  setenv(name_.c_str(), value.c_str(), 1);
}

SetVariable::~SetVariable() {
  if (was_set_) {
    setenv(name_.c_str(), before_.c_str(), 1);
  } else {
    unsetenv(name_.c_str());
  }
}

}  // namespace knotwave::support

// SPDX-License-Identifier: MIT
#include "support/jack_server.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <unistd.h>

namespace knotwave::support {

JackServer::JackServer(int block_frames, int rate_hz)
    : block_frames_(block_frames),
      rate_hz_(rate_hz),
      name_("knotwave-test-" + std::to_string(getpid())),
      found_by_("JACK_DEFAULT_SERVER", name_),
      not_started_("JACK_NO_START_SERVER", "1") {
  launch();
}

// JACK's registry has room for 8 servers of one machine, and one that was killed stays in it until
// one of its name ends well.
JackServer::~JackServer() {
  if (was_killed_ && !runs_) launch();
  program_.reset();
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    if (entry.path().filename().string().find(name_) != std::string::npos) {
      std::filesystem::remove_all(entry.path(), ignored);
    }
  }
}

// One that does not come up in time is given up: on a busy machine one has hung at its start.
void JackServer::launch() {
  const std::string rate = std::to_string(rate_hz_), block = std::to_string(block_frames_);
  const std::vector<std::string> words = {"jackd", "-n", name_, "-r", "-S", "-d",
                                          "dummy", "-r", rate,  "-p", block};
  for (int attempt = 0; attempt < 3 && !runs_; ++attempt) {
    if (program_) program_->end(SIGKILL);
    program_ = std::make_unique<BackgroundProgram>(words, folder_.file("log"));
    const int waited =
        run_program({"/bin/sh", "-c", "exec jack_wait -w -t 10"}, {.timeout_s = 20}).exit_code;
    runs_ = waited == 0 && program_->runs();
  }
}

void JackServer::kill() {
  program_->end(SIGKILL);
  runs_ = false;
  was_killed_ = true;
}

void JackServer::pause() { program_->signal(SIGSTOP); }
void JackServer::resume() { program_->signal(SIGCONT); }

bool JackServer::restart() {
  kill();
  launch();
  return runs_;
}

std::string JackServer::log() const {
  std::ostringstream text;
  text << std::ifstream(folder_.file("log")).rdbuf();
  return text.str();
}

NoJackServer::NoJackServer()
    : found_by_("JACK_DEFAULT_SERVER", "knotwave-test-none-" + std::to_string(getpid())),
      not_started_("JACK_NO_START_SERVER", "1") {}

}  // namespace knotwave::support

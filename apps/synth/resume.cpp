// SPDX-License-Identifier: MIT
#include "resume.h"

#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "held_state.h"

namespace knotwave::synth {
namespace {

constexpr const char* kPatch = "KNOTWAVE_SYNTH_RESUME_PATCH";
constexpr const char* kTakes = "KNOTWAVE_SYNTH_RESUME_TAKES";
constexpr const char* kApi = "KNOTWAVE_SYNTH_RESUME_API";
constexpr const char* kRate = "KNOTWAVE_SYNTH_RESUME_RATE";
constexpr const char* kHeld = "KNOTWAVE_SYNTH_RESUME_HELD";
constexpr std::size_t kMostBytes = 100'000;  ///< Linux takes 128 KiB a variable

std::string taken(const char* variable) {
  const char* value = std::getenv(variable);
  std::string text = value == nullptr ? "" : value;
  ::unsetenv(variable);
  return text;
}

}  // namespace

Resume take_resume() {
  Resume resume;
  resume.patch = taken(kPatch);
  resume.takes = std::atoi(taken(kTakes).c_str());
  resume.api = taken(kApi);
  resume.rate_hz = std::atof(taken(kRate).c_str());
  resume.held = messages_in(taken(kHeld));
  return resume;
}

Error restart_program(const Resume& resume, char** argv) {
  const std::string held = text_of(resume.held);
  ::setenv(kPatch, resume.patch.c_str(), 1);
  ::setenv(kTakes, std::to_string(resume.takes).c_str(), 1);
  ::setenv(kApi, resume.api.c_str(), 1);
  ::setenv(kRate, std::to_string(resume.rate_hz).c_str(), 1);
  ::setenv(kHeld, held.size() < kMostBytes ? held.c_str() : "", 1);
  // Sockets and pipes of the libraries below would stay open for good.
  const long most = ::sysconf(_SC_OPEN_MAX);
  for (int file = 3; file < (most > 0 && most < 4096 ? most : 4096); ++file) {
    if (const int flags = ::fcntl(file, F_GETFD); flags >= 0) {
      ::fcntl(file, F_SETFD, flags | FD_CLOEXEC);
    }
  }
  ::execv("/proc/self/exe", argv);
  return fail(ErrorCode::io_failed, "the program cannot be started anew (" +
                                        std::generic_category().message(errno) +
                                        "), which the sound device asks for");
}

}  // namespace knotwave::synth

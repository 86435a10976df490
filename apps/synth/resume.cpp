// SPDX-License-Identifier: MIT
#include "resume.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "knotwave/base/document.h"

#include "command_line/options.h"
#include "held_state.h"

namespace knotwave::synth {
namespace {

constexpr const char* kPatch = "KNOTWAVE_SYNTH_RESUME_PATCH";
constexpr const char* kDemoFile = "KNOTWAVE_SYNTH_RESUME_DEMO_FILE";
constexpr const char* kEntry = "KNOTWAVE_SYNTH_RESUME_ENTRY";
constexpr const char* kSong = "KNOTWAVE_SYNTH_RESUME_SONG";
constexpr const char* kTakes = "KNOTWAVE_SYNTH_RESUME_TAKES";
constexpr const char* kApi = "KNOTWAVE_SYNTH_RESUME_API";
constexpr const char* kRate = "KNOTWAVE_SYNTH_RESUME_RATE";
constexpr const char* kHeld = "KNOTWAVE_SYNTH_RESUME_HELD";
constexpr std::size_t kMostBytes = 100'000;  ///< Linux takes 128 KiB a variable

void leave(const char* variable, const std::string& value) { ::setenv(variable, value.c_str(), 1); }

std::string taken(const char* variable) {
  const char* value = std::getenv(variable);
  std::string text = value == nullptr ? "" : value;
  ::unsetenv(variable);
  return text;
}

double taken_number(const char* variable, double otherwise) {
  return command_line::number_in(taken(variable)).value_or(otherwise);
}

/// Not negative, whatever the environment says.
int taken_count(const char* variable) {
  return static_cast<int>(std::clamp(taken_number(variable, 0), 0.0, 1e6));
}

}  // namespace

Resume take_resume() {
  Resume resume;
  resume.patch = taken(kPatch);
  resume.demo_file = taken(kDemoFile);
  resume.program_entry = taken_count(kEntry);
  resume.song_s = taken_number(kSong, -1);
  resume.takes = taken_count(kTakes);
  resume.api = taken(kApi);
  resume.rate_hz = taken_number(kRate, 0);
  resume.held = messages_in(taken(kHeld));
  return resume;
}

void leave_resume(const Resume& resume) {
  const std::string held = text_of(resume.held);
  leave(kPatch, resume.patch);
  leave(kDemoFile, resume.demo_file);
  leave(kEntry, std::to_string(resume.program_entry));
  leave(kSong, base::number_text(resume.song_s));
  leave(kTakes, std::to_string(resume.takes));
  leave(kApi, resume.api);
  leave(kRate, base::number_text(resume.rate_hz));
  leave(kHeld, held.size() < kMostBytes ? held : "");
}

Error restart_program(const Resume& resume, char** argv) {
  leave_resume(resume);
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

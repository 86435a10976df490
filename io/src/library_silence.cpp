// SPDX-License-Identifier: MIT
#include "library_silence.h"

#include <cstdio>
#include <mutex>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#if KNOTWAVE_HAVE_JACK
#include <jack/jack.h>
#endif

namespace knotwave::io {
namespace {

using AlsaHandler = void (*)(const char* file, int line, const char* function, int error,
                             const char* format, ...);  // NOLINT(cert-dcl50-cpp): ALSA's type
void say_nothing(const char* /*file*/, int /*line*/, const char* /*function*/, int /*error*/,
                 const char* /*format*/, ...) {}  // NOLINT(cert-dcl50-cpp): ALSA's type

struct StandardError {
  std::mutex mutex;
  int users = 0, descriptor = -1;
};

StandardError& kept() {
  static StandardError standard_error;
  return standard_error;
}

}  // namespace

// PortAudio brings ALSA in where it uses it; we do not link it.
void silence_alsa() noexcept {
  using Setter = int (*)(AlsaHandler);
  if (auto* const found = dlsym(RTLD_DEFAULT, "snd_lib_error_set_handler")) {
    reinterpret_cast<Setter>(found)(&say_nothing);
  }
}

void silence_jack() noexcept {
#if KNOTWAVE_HAVE_JACK
  jack_set_error_function([](const char*) {});
  jack_set_info_function([](const char*) {});
#endif
}

// The first one keeps where standard error went, the last one gives it back.
SilentStandardError::SilentStandardError() noexcept {
  const std::lock_guard lock(kept().mutex);
  if (kept().users++ > 0) return;
  std::fflush(stderr);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  kept().descriptor = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  if (kept().descriptor >= 0) dup2(nowhere, STDERR_FILENO);
  close(nowhere);
}

SilentStandardError::~SilentStandardError() {
  const std::lock_guard lock(kept().mutex);
  if (--kept().users > 0 || kept().descriptor < 0) return;
  std::fflush(stderr);
  dup2(kept().descriptor, STDERR_FILENO);
  close(kept().descriptor);
  kept().descriptor = -1;
}

}  // namespace knotwave::io

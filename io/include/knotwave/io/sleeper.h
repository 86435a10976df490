// SPDX-License-Identifier: MIT
// How a thread sleeps until a time comes, or somebody has something for it.
#pragma once
#include <atomic>
#include <cstdint>

#include <semaphore.h>

#include "knotwave/base/rt.h"

namespace knotwave::io {

/// One thread sleeps, any may wake it. A wake that comes while it is awake ends its next sleep at
/// once, so nothing is missed between looking for work and going to sleep.
class Sleeper {
 public:
  Sleeper();
  ~Sleeper();
  Sleeper(const Sleeper&) = delete;
  Sleeper& operator=(const Sleeper&) = delete;

  /// Until `time_ns` by steady_clock_ns(), or a wake. Of the thread that sleeps.
  void sleep_until(std::int64_t time_ns);
  /// Never waits. A system call only where the thread is asleep and this is the first to wake it
  /// (sem_post, which POSIX allows in a signal handler). [any]
  void wake() noexcept;

 private:
  sem_t wakes_;
  std::atomic<bool> is_woken_{false};
};

/// Until `time_ns`, whoever calls.
void sleep_through(std::int64_t time_ns);

}  // namespace knotwave::io

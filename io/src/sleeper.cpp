// SPDX-License-Identifier: MIT
#include "knotwave/io/sleeper.h"

#include <cerrno>

#include <time.h>

namespace knotwave::io {
namespace {

timespec time_of(std::int64_t time_ns) {
  timespec time{};
  time.tv_sec = static_cast<time_t>(time_ns / 1'000'000'000);
  time.tv_nsec = static_cast<long>(time_ns % 1'000'000'000);
  return time;
}

}  // namespace

Sleeper::Sleeper() { ::sem_init(&wakes_, 0, 0); }
Sleeper::~Sleeper() { ::sem_destroy(&wakes_); }

void Sleeper::sleep_until(std::int64_t time_ns) {
  const timespec until = time_of(time_ns);
  while (::sem_clockwait(&wakes_, CLOCK_MONOTONIC, &until) != 0 && errno == EINTR) {
  }
  is_woken_.exchange(false, std::memory_order_acq_rel);
}

void Sleeper::wake() noexcept {
  if (!is_woken_.exchange(true, std::memory_order_acq_rel)) ::sem_post(&wakes_);
}

void sleep_through(std::int64_t time_ns) {
  const timespec until = time_of(time_ns);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// Waiting for a number to change, and nothing else: std::atomic's wait() first yields to the system
// scheduler a few times, and each time is a system call of its own.
#pragma once
#include <atomic>
#include <climits>
#include <cstdint>

#if defined(__linux__)
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace knotwave::engine {

/// Returns once it is not `old`: at once, or after futex waits.
inline std::uint32_t wait_while(std::atomic<std::uint32_t>& number, std::uint32_t old) noexcept {
  for (;;) {
    const std::uint32_t now = number.load(std::memory_order_acquire);
    if (now != old) return now;
#if defined(__linux__)
    static_assert(sizeof number == sizeof(std::uint32_t));
    ::syscall(SYS_futex, &number, FUTEX_WAIT_PRIVATE, old, nullptr, nullptr, 0);
#else
    number.wait(old, std::memory_order_acquire);
#endif
  }
}

/// Whoever waits for it looks again: one futex wake.
inline void wake_all(std::atomic<std::uint32_t>& number) noexcept {
#if defined(__linux__)
  ::syscall(SYS_futex, &number, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
#else
  number.notify_all();
#endif
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Runs a piece of audio work as the audio thread would and finds what it must not do:
//   1. the RealtimeSanitizer runtime stops the program at malloc, free, locks, files, sleeps,
//   throw;
//   2. a seccomp filter on the thread catches every system call the sanitizer does not know;
//   3. getrusage counts voluntary context switches and page faults.
// See docs/realtime-rules.md. Source of the sanitizer's interface: LLVM compiler-rt,
// rtsan_interface.h.
#pragma once
#include <functional>
#include <string>

namespace knotwave::rt {

struct GateReport {
  bool sanitized = false;    ///< the sanitizer's runtime is linked
  bool filtered = false;     ///< the filter was installed
  int system_calls = 0;      ///< calls the filter refused
  int first_call = -1;       ///< number of the first of them
  long voluntary_waits = 0;  ///< voluntary context switches
  long page_faults = 0;      ///< minor and major

  /// Empty when nothing was found, else one line.
  std::string findings() const;
};

/// Calls `prepare` and then `work` on a thread of its own; only `work` is inside the gate. A hit of
/// the sanitizer prints a stack and ends the program. Not reentrant.
GateReport run_in_gate(
    const std::function<void()>& work, const std::function<void()>& prepare = [] {});

}  // namespace knotwave::rt

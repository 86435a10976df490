// SPDX-License-Identifier: MIT
// Runs a piece of audio work as the audio thread would and finds what it must not do. Two kinds of
// run, since the sanitizer's report needs the system calls the filter refuses:
//   sanitizer: the RealtimeSanitizer runtime ends the program at malloc, free, locks, files, sleeps
//              and throw;
//   system:    a seccomp filter on the thread refuses and counts every system call, and getrusage
//              counts voluntary waits and page faults;
//   parallel:  the same, but futexes are listed, and so are the waits for them: what an engine of
//              several threads may use.
// See docs/realtime-rules.md. Source of the sanitizer's interface: LLVM compiler-rt,
// rtsan_interface.h.
#pragma once
#include <functional>
#include <string>

namespace knotwave::rt {

enum class Gate { sanitizer, system, parallel };

struct GateReport {
  bool watched = false;      ///< the sanitizer's runtime is linked, or the filter was installed
  int system_calls = 0;      ///< calls the filter refused
  int first_call = -1;       ///< number of the first of them
  long voluntary_waits = 0;  ///< voluntary context switches
  long page_faults = 0;      ///< minor and major

  /// Empty when nothing was found, else one line.
  std::string findings() const;
};

/// From here on this thread is filtered as in Gate::parallel, for good, and its refused calls are
/// counted by the run_in_gate() under way. False: no filter was installed.
bool join_parallel_gate();

/// Calls `prepare` and then `work` on a thread of its own; only `work` is inside the gate. What
/// work() touches first costs a page fault: let prepare() touch it. Not reentrant.
GateReport run_in_gate(
    Gate gate, const std::function<void()>& work, const std::function<void()>& prepare = [] {});

}  // namespace knotwave::rt

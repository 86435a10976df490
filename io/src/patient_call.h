// SPDX-License-Identifier: MIT
// Calls into libraries that may never return. Each runs on a thread of its own; where it takes too
// long the thread is left behind, and the program goes on, and ends, without it.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace knotwave::io {

/// One library, one call at a time.
class PatientCall {
 public:
  enum class Outcome { done, hangs, refused };

  /// Waits for work() for `limit` at most. hangs: work() still runs, and what it uses must belong
  /// to it. refused: an earlier one still does, or there is no thread to be had. [control]
  Outcome run(std::chrono::milliseconds limit, std::function<void()> work);
  /// Some call has outlived its limit and not come back. [any]
  bool is_stuck() noexcept;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_busy_ = false, is_stuck_ = false;
};

/// Never destroyed: a thread that was left behind may still look at them while the program ends.
PatientCall& jack_calls();
PatientCall& portaudio_calls();

}  // namespace knotwave::io

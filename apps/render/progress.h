// SPDX-License-Identifier: MIT
// A bar with the time left, on a terminal; nothing anywhere else.
#pragma once
#include <chrono>
#include <string>

namespace knotwave::render {

/// `[=====>     ]  45 %  13.5 of 30.0 s  41.2x  0:00 left`, without line end.
std::string progress_line(double done_s, double total_s, double elapsed_s);

/// Whether a bar stands on the line just now. Async-signal-safe: for signal handlers.
bool is_progress_drawn() noexcept;

class Progress {
 public:
  /// Draws on standard error if that is a terminal and `is_wanted`.
  explicit Progress(bool is_wanted);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Wipes the line.
  ~Progress();

  /// At most ten times a second.
  void show(double done_s, double total_s);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_on_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
};

}  // namespace knotwave::render

// SPDX-License-Identifier: MIT
#include "progress.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace knotwave::render {
namespace {

constexpr int kBarCells = 30;
constexpr double kLongestLeftSeconds = 99 * 3600;

std::atomic<bool> is_drawn{false};  ///< of the one bar a program has
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler reads it");

std::string bar(double share) {
  const int cells = static_cast<int>(share * kBarCells);
  std::string text(static_cast<std::size_t>(cells), '=');
  if (cells < kBarCells) text += '>';
  text.resize(kBarCells, ' ');
  return text;
}

}  // namespace

std::string progress_line(double done_s, double total_s, double elapsed_s) {
  const double share = total_s > 0 ? std::clamp(done_s / total_s, 0.0, 1.0) : 1;
  const double factor = elapsed_s > 0 ? done_s / elapsed_s : 0;
  const double left_s = share > 0 ? std::min(elapsed_s * (1 - share) / share, kLongestLeftSeconds)
                                  : kLongestLeftSeconds;
  const int whole_left = static_cast<int>(std::ceil(left_s));
  char text[160];
  std::snprintf(text, sizeof text, "[%s] %3d %%  %.1f of %.1f s  %.1fx  %d:%02d left",
                bar(share).c_str(), static_cast<int>(share * 100), done_s, total_s, factor,
                whole_left / 60, whole_left % 60);
  return text;
}

Progress::Progress(bool is_wanted) : is_on_(is_wanted && ::isatty(STDERR_FILENO) == 1) {}

bool is_progress_drawn() noexcept { return is_drawn.load(std::memory_order_relaxed); }

Progress::~Progress() {
  if (is_drawn.exchange(false)) std::fputs("\r\x1b[K", stderr);
}

void Progress::show(double done_s, double total_s) {
  const Clock::time_point now = Clock::now();
  if (!is_on_ || now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r%s\x1b[K", progress_line(done_s, total_s, elapsed_s).c_str());
  std::fflush(stderr);
  is_drawn.store(true, std::memory_order_relaxed);
}

}  // namespace knotwave::render

// SPDX-License-Identifier: MIT
// Renders through knotwave-render to a pipe and measures on the way: peak and loudness by ITU-R
// BS.1770 (libebur128). Nothing is kept, so that a song may be long.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include <ebur128.h>

#include "support/program.h"

namespace knotwave::render {

inline constexpr unsigned kMeterRateHz = 48000;

struct Measure {
  int exit_code = -1;
  std::string err;
  std::size_t frames = 0;
  bool finite = true;
  double peak = 0;
  double end_peak = 0;  ///< of the last millisecond
  double loudness_lufs = -HUGE_VAL;
  double cpu_s = 0;

  double peak_dbfs() const { return 20 * std::log10(peak); }
  double seconds() const { return static_cast<double>(frames) / kMeterRateHz; }
};

class LoudnessMeter {
 public:
  LoudnessMeter() : state_(ebur128_init(2, kMeterRateHz, EBUR128_MODE_I)) {}
  ~LoudnessMeter() { ebur128_destroy(&state_); }
  LoudnessMeter(const LoudnessMeter&) = delete;
  LoudnessMeter& operator=(const LoudnessMeter&) = delete;

  void add(std::span<const char> bytes, Measure& m) {
    pending_.insert(pending_.end(), bytes.begin(), bytes.end());
    const std::size_t frames = pending_.size() / 8;
    samples_.resize(2 * frames);
    std::memcpy(samples_.data(), pending_.data(), frames * 8);
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(frames * 8));
    ebur128_add_frames_float(state_, samples_.data(), frames);
    for (const float x : samples_) {
      m.finite = m.finite && std::isfinite(x);
      m.peak = std::max(m.peak, static_cast<double>(std::abs(x)));
      tail_[tail_at_++ % std::size(tail_)] = x;
    }
    m.frames += frames;
  }

  /// As new: what follows is measured by itself.
  void restart() {
    ebur128_destroy(&state_);
    state_ = ebur128_init(2, kMeterRateHz, EBUR128_MODE_I);
    std::fill(std::begin(tail_), std::end(tail_), 0.0f);
  }

  void finish(Measure& m) {
    ebur128_loudness_global(state_, &m.loudness_lufs);
    for (const float x : tail_) m.end_peak = std::max(m.end_peak, double(std::abs(x)));
  }

 private:
  ebur128_state* state_;
  std::vector<char> pending_;
  std::vector<float> samples_;
  float tail_[2 * kMeterRateHz / 1000] = {};
  std::size_t tail_at_ = 0;
};

/// `patch` may be a bank.
inline Measure measure(const std::string& patch, const std::string& song) {
  Measure m;
  LoudnessMeter meter;
  support::ProgramOptions options;
  options.timeout_s = 600;
  options.on_output = [&](std::span<const char> bytes) { meter.add(bytes, m); };
  const auto run =
      support::run_program({"knotwave-render", patch, song, "-o", "-", "--quiet"}, options);
  meter.finish(m);
  m.exit_code = run.exit_code;
  m.err = run.err;
  m.cpu_s = run.cpu_s;
  return m;
}

}  // namespace knotwave::render

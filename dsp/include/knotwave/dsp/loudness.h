// SPDX-License-Identifier: MIT
// The level of a sound over time: for curves that follow it. [control]
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::dsp {

struct LoudnessConfig {
  enum class Measure {
    rms,   ///< root of the mean square over the frames of a window and all channels
    peak,  ///< largest magnitude of any channel
  };
  Measure measure = Measure::rms;
  int rate_hz = 48000;  ///< 1..768000
  int channels = 1;     ///< 1..64
  /// Both are rounded to whole frames, 1 at least. A window is no shorter than a hop, so that every
  /// frame counts.
  double window_s = 0.05;
  double hop_s = 0.01;
};

/// Levels at 0, 1, 2 ... hops, and at the end of the sound: each is that of the frames from half a
/// window before (rounded down to a frame) to one window after there; frames before the sound and
/// behind it do not exist and do not count. A full-scale sine has rms sqrt(1/2), the same in one
/// channel and in all. Doubles in a fixed order, the same for any split of the sound over add(); no
/// libm.
class LoudnessMeter {
 public:
  /// Errors: value_out_of_range (the above; a window beyond kMostWindowFrames).
  static Result<LoudnessMeter> create(const LoudnessConfig& config);

  /// Whole frames, interleaved. A sample that is not finite counts as 0. O(samples window / hop).
  void add(std::span<const float> interleaved);
  /// No more frames: the levels to the end.
  void finish();

  struct Level {
    std::int64_t frame = 0;  ///< at which it stands
    double level = 0;        ///< linear, 1 is full scale
  };
  const std::vector<Level>& levels() const { return levels_; }
  std::int64_t frames() const { return count_; }

 private:
  LoudnessMeter(const LoudnessConfig& config, std::int64_t window, std::int64_t hop)
      : config_(config), window_(window), hop_(hop) {}
  double strength_of(const float* frame) const;
  double level_at(std::int64_t frame) const;
  void forget_old();

  LoudnessConfig config_;
  std::int64_t window_, hop_;
  std::vector<double> strengths_;  ///< of frames from first_ on: mean square or magnitude
  std::int64_t first_ = 0, count_ = 0, next_ = 0;
  std::vector<Level> levels_;
};

inline constexpr std::int64_t kMostWindowFrames = std::int64_t{1} << 24;

/// A level on a scale of decibels: floor_db (below 0) and less is 0, 0 dB is 1, more is above 1.
double level_on_db_scale(double level, double floor_db);

}  // namespace knotwave::dsp

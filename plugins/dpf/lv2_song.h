// SPDX-License-Identifier: MIT
// The song as LV2 tells it: in bars and beats, and only where something changes. All [audio].
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "dpf_beyond.h"

namespace knotwave::plugins {

/// What was told stays, and the place runs on by the tempo. Times are samples of the block.
class Lv2Song {
 public:
  void reset(double rate_hz) KNOTWAVE_RT {
    *this = {};
    rate_hz_ = rate_hz;
  }
  bool is_known() const KNOTWAVE_RT { return is_known_; }
  /// Where the block began.
  const Transport& begin() const KNOTWAVE_RT { return begin_; }

  /// The place is that of the bar; of a host that has none, that of the running beat; or that in
  /// the bar alone. A beat is a quarter note where nothing else is told.
  Transport hear(const BarsAndBeats& told, std::int64_t sample) KNOTWAVE_RT {
    run_until(sample);
    is_known_ = true;
    const auto keep = [](double& kept, double heard) {
      if (std::isfinite(heard)) kept = heard;
    };
    keep(bar_, told.bar);
    if (told.beat_unit > 0) keep(beat_unit_, told.beat_unit);
    if (told.beats_per_bar > 0) keep(beats_per_bar_, told.beats_per_bar);
    keep(speed_, told.speed);
    if (told.beats_per_minute > 0) keep(beats_per_minute_, told.beats_per_minute);
    const double in_bars = bar_ * beats_per_bar_ + told.bar_beat;
    const double beats = std::isfinite(in_bars)     ? in_bars
                         : std::isfinite(told.beat) ? told.beat
                                                    : told.bar_beat;
    if (std::isfinite(beats)) {
      now_.quarters = beats * 4 / beat_unit_;
      now_.has_position = std::isfinite(now_.quarters);
    }
    now_.is_playing = speed_ > 0;
    now_.beats_per_minute = beats_per_minute_ * (speed_ == 0 ? 1 : std::abs(speed_));
    return now_;
  }
  void end_block(std::size_t frames) KNOTWAVE_RT {
    run_until(static_cast<std::int64_t>(frames));
    sample_ = 0;
    begin_ = now_;
  }

 private:
  void run_until(std::int64_t sample) KNOTWAVE_RT {
    if (now_.is_playing) {
      now_.quarters +=
          static_cast<double>(sample - sample_) * now_.beats_per_minute / (60 * rate_hz_);
    }
    sample_ = sample;
  }

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double rate_hz_ = 48000;
  double bar_ = kUnknown, beats_per_bar_ = kUnknown;
  double beat_unit_ = 4, beats_per_minute_ = 0, speed_ = 0;
  bool is_known_ = false;
  Transport begin_, now_;
  std::int64_t sample_ = 0;  ///< of now_
};

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
// The song position in quarter notes at a sample, and how many were played. All [audio].
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "knotwave/base/time.h"

namespace knotwave::engine {

/// `samples` after `from`, floored to 2^-32 sample; never before it, and 2^40 samples at most.
inline base::SampleTime time_after(base::SampleTime from, double samples) KNOTWAVE_RT {
  const double wait = samples > 0 ? std::min(samples, 0x1p40) : 0.0;
  const double whole = std::floor(wait);
  const std::uint64_t fraction =
      std::uint64_t{from.fraction} + static_cast<std::uint64_t>((wait - whole) * 0x1p32);
  return {
      from.sample + static_cast<std::int64_t>(whole) + static_cast<std::int64_t>(fraction >> 32),
      static_cast<std::uint32_t>(fraction)};
}

/// Both are functions of the sample since the last change of tempo or position; only changes are
/// summed. What is played only counts on; the position is moved, too.
class TempoClock {
 public:
  void reset(double rate_hz) KNOTWAVE_RT {
    *this = {};
    rate_hz_ = rate_hz;
  }
  /// A new tempo from `time` on; 0 microseconds is ignored.
  void set_tempo(base::SampleTime time, std::uint32_t microseconds_per_quarter) KNOTWAVE_RT {
    if (microseconds_per_quarter == 0) return;
    rebase(time, beats_at(time));
    microseconds_ = microseconds_per_quarter;
  }
  /// The song is somewhere else from `time` on.
  void set_position(base::SampleTime time, double beats) KNOTWAVE_RT {
    rebase(time, beats);
    ++moves_;
  }
  /// How often it was moved: another number, another song.
  std::uint32_t moves() const KNOTWAVE_RT { return moves_; }
  /// When the song comes to `beats` while the tempo stays; not before the last change.
  base::SampleTime time_at(double beats) const KNOTWAVE_RT {
    return time_after(origin_, (beats - origin_beats_) * (microseconds_ * rate_hz_ / 1e6));
  }
  double beats_at(base::SampleTime time) const KNOTWAVE_RT {
    return origin_beats_ + beats_since_origin(time);
  }
  double beats_at(std::int64_t sample) const KNOTWAVE_RT {
    return origin_beats_ + base::samples_since(origin_, sample) * beats_per_sample();
  }
  /// Quarter notes since engine time 0, wherever the song was moved.
  double played_at(std::int64_t sample) const KNOTWAVE_RT {
    return origin_played_ + base::samples_since(origin_, sample) * beats_per_sample();
  }
  double seconds_per_quarter() const KNOTWAVE_RT { return microseconds_ * 1e-6; }

 private:
  void rebase(base::SampleTime time, double beats) KNOTWAVE_RT {
    origin_played_ += beats_since_origin(time);
    origin_beats_ = beats;
    origin_ = time;
  }
  double beats_since_origin(base::SampleTime time) const KNOTWAVE_RT {
    return (base::samples_since(origin_, time.sample) +
            static_cast<double>(time.fraction) * 0x1p-32) *
           beats_per_sample();
  }
  double beats_per_sample() const KNOTWAVE_RT { return 1e6 / (microseconds_ * rate_hz_); }

  double rate_hz_ = 48000;
  base::SampleTime origin_;
  double origin_beats_ = 0, origin_played_ = 0;
  std::uint32_t moves_ = 0;
  double microseconds_ = 500000;
};

}  // namespace knotwave::engine

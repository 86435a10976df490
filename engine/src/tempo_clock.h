// SPDX-License-Identifier: MIT
// The song position in quarter notes at a sample. All [audio].
#pragma once
#include <cstdint>

#include "knotwave/base/time.h"

namespace knotwave::engine {

/// Position is a function of the sample since the last tempo change; only changes are summed.
class TempoClock {
 public:
  void reset(double rate_hz) KNOTWAVE_RT {
    *this = {};
    rate_hz_ = rate_hz;
  }
  /// A new tempo from `time` on; 0 microseconds is ignored.
  void set_tempo(base::SampleTime time, std::uint32_t microseconds_per_quarter) KNOTWAVE_RT {
    if (microseconds_per_quarter == 0) return;
    origin_beats_ +=
        (base::samples_since(origin_, time.sample) + static_cast<double>(time.fraction) * 0x1p-32) *
        beats_per_sample();
    origin_ = time;
    microseconds_ = microseconds_per_quarter;
  }
  double beats_at(std::int64_t sample) const KNOTWAVE_RT {
    return origin_beats_ + base::samples_since(origin_, sample) * beats_per_sample();
  }
  double seconds_per_quarter() const KNOTWAVE_RT { return microseconds_ * 1e-6; }

 private:
  double beats_per_sample() const KNOTWAVE_RT { return 1e6 / (microseconds_ * rate_hz_); }

  double rate_hz_ = 48000;
  base::SampleTime origin_;
  double origin_beats_ = 0;
  double microseconds_ = 500000;
};

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// The gate of a clock division: every so many beats it opens, and for a share of them it stays
// open. Knows the song position from the tempo clock alone. A copy looks ahead. All [audio].
#pragma once
#include <cmath>
#include <cstdint>

#include "knotwave/engine/envelope_patch.h"

#include "tempo_clock.h"

namespace knotwave::engine {

class ClockGate {
 public:
  struct Edge {
    base::SampleTime time;
    bool opens = true;
  };

  explicit ClockGate(const TriggerSpec& trigger)
      : beats_(trigger.beats), offset_(trigger.offset_beats), share_(trigger.gate_share) {}

  /// The song is at `position` now: the next edge is the first opening there or after.
  void seek(double position) KNOTWAVE_RT {
    const double divisions = std::floor((position - offset_) / beats_) - 1;
    next_ = divisions > 0 ? static_cast<std::int64_t>(divisions) : 0;
    while (opening(next_) < position) ++next_;  // three times at most
    closes_ = false;
  }
  /// What comes next while the tempo stays as it is.
  Edge next(const TempoClock& tempo) const KNOTWAVE_RT {
    if (closes_) return {tempo.time_at(opening(next_ - 1) + share_ * beats_), false};
    return {tempo.time_at(opening(next_)), true};
  }
  /// The next edge has been taken; of openings that fall onto one sample the last is the next.
  void pass(const TempoClock& tempo, std::int64_t sample) KNOTWAVE_RT {
    if (closes_) {
      closes_ = false;
      return;
    }
    closes_ = share_ < 1;
    ++next_;
    if (base::first_sample(tempo.time_at(opening(next_))) > sample) return;
    seek(tempo.beats_at(sample));
  }

 private:
  double opening(std::int64_t index) const KNOTWAVE_RT {
    return offset_ + static_cast<double>(index) * beats_;
  }

  double beats_, offset_, share_;
  std::int64_t next_ = 0;  ///< the opening that comes next
  bool closes_ = false;    ///< the one before it has not closed yet
};

}  // namespace knotwave::engine

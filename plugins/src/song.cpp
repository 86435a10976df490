// SPDX-License-Identifier: MIT
#include "knotwave/plugins/song.h"

#include <cmath>

namespace knotwave::plugins {
namespace {

constexpr double kJumpQuarters = 1e-3;

}  // namespace

void Song::reset(double rate_hz) KNOTWAVE_RT {
  *this = {};
  rate_hz_ = rate_hz;
  quarters_per_sample_ = bpm_ / (60 * rate_hz_);
}

bool Song::follow(const Transport& transport, std::int64_t sample) KNOTWAVE_RT {
  const double bpm = transport.beats_per_minute;
  if (bpm >= kLeastBpm && bpm <= kMostBpm && bpm != bpm_) {
    quarters_ = quarters_at(sample);
    since_ = sample;
    bpm_ = bpm;
    quarters_per_sample_ = bpm_ / (60 * rate_hz_);
  }
  const double told = transport.quarters;
  if (!transport.is_playing || !transport.has_position || !(std::abs(told) <= kMostQuarters)) {
    return false;
  }
  if (std::abs(told - quarters_at(sample)) <= kJumpQuarters) return false;
  quarters_ = told;
  since_ = sample;
  return true;
}

}  // namespace knotwave::plugins

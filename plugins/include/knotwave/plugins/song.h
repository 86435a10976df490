// SPDX-License-Identifier: MIT
// Where the host's song is at every sample, whatever the size of its blocks.
#pragma once
#include <cstdint>

#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

/// Runs by the tempo from the last place it was told; a host that says the same in other words (by
/// less than 1/1000 of a quarter note) changes nothing, so neither do its blocks. Where the host
/// stands still, or tells no place, it runs on as it did: what plays by the song never stands.
/// Begins at 0, with 120 quarter notes a minute. All [audio].
class Song {
 public:
  static constexpr double kLeastBpm = 1, kMostBpm = 1000;
  static constexpr double kMostQuarters = 1e9;

  void reset(double rate_hz) KNOTWAVE_RT;
  /// What the host says at `sample`, no earlier than the last time. True: the place jumped.
  bool follow(const Transport& transport, std::int64_t sample) KNOTWAVE_RT;
  /// Quarter notes since the song's start.
  double quarters_at(std::int64_t sample) const KNOTWAVE_RT {
    return quarters_ + static_cast<double>(sample - since_) * quarters_per_sample_;
  }

 private:
  double rate_hz_ = 48000;
  double quarters_ = 0;  ///< at sample since_
  std::int64_t since_ = 0;
  double bpm_ = 120;
  double quarters_per_sample_ = 0;
};

}  // namespace knotwave::plugins

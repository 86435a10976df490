// SPDX-License-Identifier: MIT
// What is new in what a host says of its song: tempo, start, jump, stop. All [audio].
#pragma once
#include <cmath>
#include <cstdint>

#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

class HostSong {
 public:
  struct News {
    bool tempo = false;  ///< microseconds() is another
    bool place = false;  ///< it runs, from where one said
    bool stopped = false;
  };
  void reset(double rate_hz) KNOTWAVE_RT {
    *this = {};
    rate_hz_ = rate_hz;
  }
  bool is_playing() const KNOTWAVE_RT { return is_playing_; }
  std::uint32_t microseconds() const KNOTWAVE_RT { return microseconds_; }
  /// What is known was forgotten by the one who is told: all is new again.
  void tell_again() KNOTWAVE_RT { is_known_ = false; }

  /// `sample` since the last reset. A host that tells no place changes the tempo alone.
  News follow(const Transport& host, std::int64_t sample) KNOTWAVE_RT {
    constexpr double kLeastBpm = 1, kMostBpm = 1000, kMostQuarters = 1e6, kJumpQuarters = 1e-3;
    News news;
    const double expected =
        quarters_ + static_cast<double>(sample - since_) / (microseconds_ * 1e-6 * rate_hz_);
    if (host.beats_per_minute >= kLeastBpm && host.beats_per_minute <= kMostBpm) {
      const auto told = static_cast<std::uint32_t>(std::floor(6e7 / host.beats_per_minute + 0.5));
      news.tempo = told != microseconds_ || !is_known_;
      if (news.tempo) {
        quarters_ = expected;
        since_ = sample;
        microseconds_ = told;
      }
    }
    const bool has_place = host.has_position && std::abs(host.quarters) <= kMostQuarters;
    if (has_place) {
      const bool was_playing = is_playing_ && is_known_;
      const bool was_stopped = !is_playing_ && is_known_ && is_placed_;
      is_playing_ = host.is_playing;
      is_placed_ = true;
      news.stopped = !is_playing_ && !was_stopped;
      news.place =
          is_playing_ && (!was_playing || std::abs(host.quarters - expected) > kJumpQuarters);
      if (news.place) {
        quarters_ = host.quarters;
        since_ = sample;
      }
    }
    is_known_ = true;
    return news;
  }

 private:
  double rate_hz_ = 48000;
  double quarters_ = 0;  ///< at sample since_
  std::int64_t since_ = 0;
  std::uint32_t microseconds_ = 500000;
  bool is_known_ = false, is_placed_ = false, is_playing_ = false;
};

}  // namespace knotwave::plugins

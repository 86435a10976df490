// SPDX-License-Identifier: MIT
#include "knotwave/base/rt.h"
#include "knotwave/io/midi_file.h"

namespace knotwave::io {
namespace {

using Wide = unsigned __int128;
constexpr std::int64_t kLastSample = std::int64_t{1} << 62;

/// numerator / denominator in whole samples and 2^-32 parts, both floored; denominator < 2^64.
base::SampleTime divide(Wide numerator, std::uint64_t denominator) {
  const Wide whole = numerator / denominator;
  if (whole >= static_cast<Wide>(kLastSample)) return {kLastSample, 0};
  const Wide rest = numerator % denominator;
  return {static_cast<std::int64_t>(whole), static_cast<std::uint32_t>((rest << 32) / denominator)};
}

}  // namespace

// With ticks a quarter note, a tick is rate * us / (10^6 * ticks) samples: the denominator is the
// same for the whole song, so the sum over the tempo map is one exact integer. It has at most
// 20 + 24 + 64 bits. With SMPTE time, tempo does not count; 29 stands for 30000/1001 frames.
TickClock::TickClock(const Song& song, std::uint32_t rate_hz) : song_(&song), rate_hz_(rate_hz) {
  KNOTWAVE_ASSERT(rate_hz >= 1 && rate_hz <= 768000);
  const TimeBase& base = song.time_base;
  if (base.smpte_fps > 0) {
    const bool is_drop = base.smpte_fps == 29;
    const auto frames_per_s = static_cast<std::uint64_t>(is_drop ? 30000 : base.smpte_fps);
    denominator_ = frames_per_s * static_cast<std::uint64_t>(base.ticks_per_frame);
    smpte_per_tick_ = std::uint64_t{rate_hz} * (is_drop ? 1001 : 1);
  } else {
    denominator_ = std::uint64_t{1'000'000} * static_cast<std::uint64_t>(base.ticks_per_quarter);
  }
  start_over();
}

void TickClock::start_over() {
  next_tempo_ = 0;
  segment_tick_ = 0;
  segment_numerator_ = 0;
  per_tick_ = smpte_per_tick_ != 0
                  ? smpte_per_tick_
                  : std::uint64_t{rate_hz_} * TempoChange{}.microseconds_per_quarter;
}

base::SampleTime TickClock::at(std::uint64_t tick) {
  if (tick < segment_tick_) start_over();
  if (smpte_per_tick_ == 0) {
    const auto& tempos = song_->tempos;
    for (; next_tempo_ < tempos.size() && tempos[next_tempo_].tick <= tick; ++next_tempo_) {
      const TempoChange& tempo = tempos[next_tempo_];
      segment_numerator_ += static_cast<Wide>(tempo.tick - segment_tick_) * per_tick_;
      segment_tick_ = tempo.tick;
      per_tick_ = std::uint64_t{rate_hz_} * tempo.microseconds_per_quarter;
    }
  }
  return divide(segment_numerator_ + static_cast<Wide>(tick - segment_tick_) * per_tick_,
                denominator_);
}

}  // namespace knotwave::io

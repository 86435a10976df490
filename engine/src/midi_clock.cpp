// SPDX-License-Identifier: MIT
#include "knotwave/engine/midi_clock.h"

#include <algorithm>
#include <cmath>

namespace knotwave::engine {
namespace {

using base::SampleTime;

constexpr double kClocksPerQuarter = kSongClocksPerQuarter;
constexpr double kShortestS = 0.0025, kLongestS = 0.25;  // 1000 and 10 quarters a minute
constexpr double kPauseS = 1;
constexpr double kPi = 3.14159265358979323846;
constexpr double kSqrt2 = 1.41421356237309504880;
constexpr double kBandwidthHz = 0.25;
constexpr double kWidest = 0.35;
constexpr int kReopened = 12;     // clocks: w is then 0.12
constexpr int kHalfQuarter = 12;  // clocks, before a first tempo is told and errors are measured
constexpr double kCatchUpClocks = 96;  // until e times less is missing
constexpr double kLeastS = 1e-4;       // jitter below this is not told from none
constexpr double kMostApart = 0.25;    // clocks, of a song's first one and the loop

double between(SampleTime from, SampleTime to) KNOTWAVE_RT {
  const double fractions = static_cast<double>(to.fraction) - static_cast<double>(from.fraction);
  return static_cast<double>(to.sample - from.sample) + fractions * 0x1p-32;
}

/// time + samples, floored to 2^-32 sample.
SampleTime later(SampleTime time, double samples) KNOTWAVE_RT {
  const double whole = std::floor(samples);
  const auto fraction = static_cast<std::uint64_t>((samples - whole) * 0x1p32) + time.fraction;
  return {
      time.sample + static_cast<std::int64_t>(whole) + static_cast<std::int64_t>(fraction >> 32),
      static_cast<std::uint32_t>(fraction)};
}

/// The mean of the intervals near their median, if most are; else 0.
double usual(std::array<double, MidiClock::kDoubtedClocks> intervals) KNOTWAVE_RT {
  std::sort(intervals.begin(), intervals.end());
  const double median = intervals[intervals.size() / 2];
  double sum = 0;
  int count = 0;
  for (const double interval : intervals) {
    if (std::abs(interval - median) > 0.15 * median) continue;
    sum += interval;
    ++count;
  }
  return 4 * count >= 3 * MidiClock::kDoubtedClocks ? sum / count : 0;
}

}  // namespace

void MidiClock::reset(double rate_hz) {
  *this = {};
  rate_hz_ = rate_hz;
}

MidiClock::News MidiClock::handle(const base::MidiEvent& event) KNOTWAVE_RT {
  switch (event.bytes[0]) {
    case 0xF2:
      position_ = 6 * std::int64_t{(event.bytes[1] & 127) | (event.bytes[2] & 127) << 7};
      awaits_clock_ = must_place_ = true;
      return {};
    case 0xF8:
      return clock(event.time);
    case 0xFA:
      position_ = 0;
      is_running_ = awaits_clock_ = must_place_ = true;
      return {};
    case 0xFB:
      awaits_clock_ = awaits_clock_ || !is_running_;
      must_place_ = must_place_ || !is_running_;
      is_running_ = true;
      return {};
    case 0xFC:
      is_running_ = false;
      return {};
    default:
      return {};
  }
}

void MidiClock::tell_again() KNOTWAVE_RT { must_tell_ = must_place_ = true; }

MidiClock::News MidiClock::clock(SampleTime time) KNOTWAVE_RT {
  ++clocks_;
  News news;
  const double interval = between(last_, time);
  const bool is_new =
      stage_ == Stage::none || interval > kPauseS * rate_hz_ || interval < -0.01 * rate_hz_;
  if (is_new) {
    begin(time);
    must_place_ = must_place_ || is_running_;
  } else if (stage_ == Stage::locked) {
    const bool counts = take(time, is_running_ && awaits_clock_);
    last_ = time;
    if (!counts) return news;
    news.position = place(time);
    const bool was_together = is_together_;
    news.tempo = decide(time);
    must_place_ = must_place_ || (news.tempo && !was_together);
  } else {
    play(1);
    last_ = time;
    if (interval >= kShortestS * rate_hz_ && interval <= kLongestS * rate_hz_) lock(time, interval);
  }
  if (must_tell_ && has_tempo_) {
    news.tempo = true;
    event_time_ = time;
  }
  must_tell_ = false;
  news.position = place(time) || news.position;
  return news;
}

/// Where the song is new, the clock that came says it.
bool MidiClock::place(SampleTime time) KNOTWAVE_RT {
  if (!must_place_ || !is_running_) return false;
  must_place_ = false;
  placed_ = position_ - 1;
  place_time_ = time;
  tempo_clocks_ = static_cast<double>(loop_clocks_);
  tempo_begin_ = time;
  return true;
}

void MidiClock::begin(SampleTime time) KNOTWAVE_RT {
  if (stage_ != Stage::none) ++restarts_;
  stage_ = Stage::one;
  last_ = now_ = time;
  play(1);
}

void MidiClock::lock(SampleTime time, double period) KNOTWAVE_RT {
  stage_ = Stage::locked;
  now_ = time;
  period_ = std::clamp(period, kShortestS * rate_hz_, kLongestS * rate_hz_);
  next_ = later(time, period_);
  age_ = 0;
  mean_error_ = 0;
  doubt_ = {};
  is_catching_up_ = false;
  is_together_ = false;
}

/// True if the loop took it. A song may begin between two clocks or in a pause: the loop goes on
/// from there.
bool MidiClock::take(SampleTime time, bool begins) KNOTWAVE_RT {
  double error = between(next_, time);
  if (begins && std::abs(error) > kMostApart * period_) {
    next_ = time;
    error = 0;
    doubt_ = {};
  }
  std::int64_t assumed = 1;
  const bool fits = std::abs(error) <= 0.5 * period_;
  if (!fits && error < 0) {
    ++surplus_;
    assumed = 0;
  } else if (!fits) {
    const double lost = std::floor(error / period_ + 0.5);
    next_ = later(next_, lost * period_);
    error -= lost * period_;
    assumed += static_cast<std::int64_t>(lost);
    missing_ += assumed - 1;
  }
  if (assumed > 0) {
    loop_clocks_ += assumed;
    follow(error);
  }
  play(assumed);
  doubt(time, assumed, fits);
  return assumed > 0;
}

void MidiClock::follow(double error) KNOTWAVE_RT {
  const double w = omega();
  now_ = next_;
  next_ = later(next_, period_ + kSqrt2 * w * error);
  period_ = std::clamp(period_ + w * w * error, kShortestS * rate_hz_, kLongestS * rate_hz_);
  age_ = std::min(age_ + 1, 1 << 20);
  if (age_ <= kHalfQuarter) return;
  const double from_mean = error - mean_error_;
  squares_ = std::min(squares_ + 1, 96);
  mean_square_ += (from_mean * from_mean - mean_square_) / squares_;
  mean_error_ += from_mean / 8;
  // Five times what the mean of 8 clocks strays by itself: the tempo moves.
  if (std::abs(mean_error_) > 1.25 * std::max(jitter(), kLeastS * rate_hz_)) {
    age_ = kReopened;
    mean_error_ = 0;
  }
}

/// A tempo that jumps looks like clocks too many or too few, but most intervals are then as new.
void MidiClock::doubt(SampleTime time, std::int64_t assumed, bool fits) KNOTWAVE_RT {
  if (doubt_.came == 0 && fits) return;
  doubt_.intervals[static_cast<std::size_t>(doubt_.came++)] = between(last_, time);
  doubt_.assumed += assumed;
  if (doubt_.came < kDoubtedClocks) return;
  const Doubt seen = doubt_;
  doubt_ = {};
  const double period = usual(seen.intervals);
  // Clocks that waited somewhere come all at once: that is no tempo.
  if (period < kShortestS * rate_hz_ || std::abs(period / period_ - 1) < 0.05) return;
  ++restarts_;
  const std::int64_t mistaken = seen.came - seen.assumed;
  if (mistaken < 0) missing_ += mistaken;
  if (mistaken > 0) surplus_ -= mistaken;
  play(mistaken);
  lock(time, period);
}

void MidiClock::play(std::int64_t clocks) KNOTWAVE_RT {
  if (!is_running_ || clocks == 0) return;
  position_ += clocks;
  awaits_clock_ = false;
}

bool MidiClock::decide(SampleTime time) KNOTWAVE_RT {
  if (age_ < kHalfQuarter) return false;
  const double w = omega();
  double target = period_;
  if (!is_together_) {
    tempo_clocks_ = static_cast<double>(loop_clocks_);
    tempo_begin_ = now_;
    is_together_ = true;
  }
  if (has_tempo_) {
    const double behind = static_cast<double>(loop_clocks_) - handed_out(now_);
    const double away = std::abs(behind) * period_;
    const double noise = 3 * jitter() * std::sqrt(1.06 * w);  // of now_
    const bool was_catching_up = is_catching_up_;
    is_catching_up_ =
        was_catching_up ? away > 0.0003 * rate_hz_ + noise / 3 : away > 0.002 * rate_hz_ + noise;
    if (is_catching_up_) target /= 1 + std::clamp(behind / kCatchUpClocks, -0.02, 0.02);
    const double stray = 3 * jitter() * w * std::sqrt(w) / 1.68 / period_;
    const bool matters = std::abs(target / tempo_period_ - 1) > 0.001 + stray;
    if (!matters && is_catching_up_ == was_catching_up) return false;
  }
  if (has_tempo_) tempo_clocks_ = handed_out(now_);
  tempo_begin_ = now_;
  const double per_period_us = 1e6 * kClocksPerQuarter / rate_hz_;
  microseconds_ = static_cast<std::uint32_t>(std::floor(target * per_period_us + 0.5));
  tempo_period_ = microseconds_ / per_period_us;
  event_time_ = time;
  has_tempo_ = true;
  return true;
}

double MidiClock::handed_out(SampleTime time) const KNOTWAVE_RT {
  return tempo_clocks_ + between(tempo_begin_, time) / tempo_period_;
}

double MidiClock::omega() const KNOTWAVE_RT {
  const double narrow = 2 * kPi * kBandwidthHz * period_ / rate_hz_;
  return std::min(kWidest, std::max(narrow, kWidest / (1 + age_ / 6.0)));
}

double MidiClock::jitter() const KNOTWAVE_RT { return std::sqrt(mean_square_); }

Event MidiClock::tempo_event() const KNOTWAVE_RT {
  Event event;
  event.kind = Event::Kind::tempo;
  event.midi.time = event_time_;
  event.microseconds_per_quarter = microseconds_;
  return event;
}

Event MidiClock::position_event() const KNOTWAVE_RT {
  Event event;
  event.kind = Event::Kind::position;
  event.midi.time = place_time_;
  event.song_clocks = placed_;
  return event;
}

bool MidiClock::is_present(SampleTime now) const KNOTWAVE_RT {
  return stage_ != Stage::none && between(last_, now) <= kPauseS * rate_hz_;
}

double MidiClock::quarters_at(SampleTime now) const KNOTWAVE_RT {
  auto clocks = static_cast<double>(position_);
  if (is_running_ && !awaits_clock_) {
    const bool has_loop = stage_ == Stage::locked;
    clocks += has_loop ? std::clamp(between(now_, now) / period_, 0.0, 1.0) - 1 : -1.0;
  }
  return clocks / kClocksPerQuarter;
}

MidiClockStatus MidiClock::status() const KNOTWAVE_RT {
  MidiClockStatus status;
  if (stage_ == Stage::locked) status.bpm = 60 * rate_hz_ / (period_ * kClocksPerQuarter);
  status.jitter_ms = 1e3 * jitter() / rate_hz_;
  status.is_running = is_running_;
  status.position_clocks = position_;
  status.clocks = clocks_;
  status.missing = missing_;
  status.surplus = surplus_;
  status.restarts = restarts_;
  return status;
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "live_clock.h"

#include <algorithm>
#include <cmath>

namespace knotwave::engine {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kSqrt2 = 1.41421356237310;
/// Of the loop once it has settled. It begins wide and narrows as an average over time does.
constexpr double kBandwidthHz = 0.1;
constexpr double kFirstBandwidthSeconds = 0.5;  ///< bandwidth x time while it narrows
constexpr double kMostOmega = 0.5;              ///< the loop is stable up to about 1
/// A crystal is right to 1e-4; what seems further off is jitter.
constexpr double kMostDrift = 0.01;
constexpr double kLostSeconds = 0.1;  ///< off by more, and by two blocks: another time has begun
constexpr double kWindowSeconds = 4;
constexpr double kMarginStepSeconds = 0.0005;

}  // namespace

LiveClock::LiveClock(double rate_hz) KNOTWAVE_RT : rate_hz_(rate_hz),
                                                   usual_ns_per_frame_(1e9 / rate_hz),
                                                   ns_per_frame_(usual_ns_per_frame_) {}

double LiveClock::since_origin(std::int64_t time_ns) const KNOTWAVE_RT {
  // No time whatever overflows; a nanosecond is a fraction of a sample even a century after boot.
  return static_cast<double>(time_ns) - static_cast<double>(origin_ns_);
}

void LiveClock::restart(std::int64_t time_ns) KNOTWAVE_RT {
  runs_ = true;
  origin_ns_ = time_ns;
  start_ns_ = next_ns_ = 0;
  ns_per_frame_ = usual_ns_per_frame_;
  elapsed_s_ = 0;
}

void LiveClock::begin_block(std::int64_t time_ns, std::int64_t now,
                            std::size_t frames) KNOTWAVE_RT {
  const double most_ns = kLostSeconds * 1e9 + 2 * frames_ * ns_per_frame_;
  if (!runs_ || std::abs(since_origin(time_ns) - next_ns_) > most_ns) restart(time_ns);
  now_ = now;
  frames_ = static_cast<double>(frames);
  start_ns_ = next_ns_;
  follow(since_origin(time_ns) - start_ns_);
  window_s_ += frames_ / rate_hz_;
  if (window_s_ >= kWindowSeconds) {
    block_frames_.turn();
    early_frames_.turn();
    window_s_ = 0;
  }
  block_frames_.add(frames_);
  const double step = kMarginStepSeconds * rate_hz_;
  const double steps = std::max(std::ceil(early_frames_.value() / step), 1.0);
  latency_frames_ = block_frames_.value() + std::ceil(steps * step);
}

// Error: how much later than predicted the block was asked for.
void LiveClock::follow(double error_ns) KNOTWAVE_RT {
  const double period_s = frames_ / rate_hz_;
  elapsed_s_ += period_s;
  const double bandwidth_hz = std::max(kBandwidthHz, kFirstBandwidthSeconds / elapsed_s_);
  const double omega = std::min(2 * kPi * bandwidth_hz * period_s, kMostOmega);
  const double usual = usual_ns_per_frame_;
  early_frames_.add(-(1 - kSqrt2 * omega) * error_ns / ns_per_frame_);
  next_ns_ = start_ns_ + kSqrt2 * omega * error_ns + frames_ * ns_per_frame_;
  ns_per_frame_ = std::clamp(ns_per_frame_ + omega * omega * error_ns / frames_,
                             usual * (1 - kMostDrift), usual * (1 + kMostDrift));
}

std::int64_t LiveClock::sample_of(std::int64_t time_ns) const KNOTWAVE_RT {
  const double ahead = (since_origin(time_ns) - start_ns_) / ns_per_frame_ + latency_frames_;
  const double within = std::clamp(ahead, -1e15, frames_ + latency_frames_);
  return now_ + static_cast<std::int64_t>(std::floor(within + 0.5));
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "knotwave/dsp/loudness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"

namespace knotwave::dsp {
namespace {

constexpr int kMostRate = 768000;
constexpr int kMostChannels = 64;
constexpr std::size_t kLanes = 8;

Error out_of_range(const std::string& what, double value, const std::string& range) {
  return fail(ErrorCode::value_out_of_range,
              what + " of " + base::number_text(value) + " is outside " + range);
}

double sum_of(std::span<const double> values) {
  std::array<double, kLanes> lanes{};
  for (std::size_t i = 0; i < values.size(); ++i) lanes[i % kLanes] += values[i];
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
         ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

std::int64_t frames_in(double seconds, int rate_hz) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor(seconds * rate_hz + 0.5)));
}

}  // namespace

Result<LoudnessMeter> LoudnessMeter::create(const LoudnessConfig& config) {
  if (config.rate_hz < 1 || config.rate_hz > kMostRate)
    return out_of_range("a rate", config.rate_hz, "1..768000 Hz");
  if (config.channels < 1 || config.channels > kMostChannels)
    return out_of_range("a number of channels", config.channels, "1..64");
  const double most_s = static_cast<double>(kMostWindowFrames) / config.rate_hz;
  if (!(config.window_s > 0 && config.window_s <= most_s))
    return out_of_range("a window", config.window_s, "0.." + base::number_text(most_s) + " s");
  if (!(config.hop_s > 0 && config.hop_s <= config.window_s)) {
    return out_of_range("a hop", config.hop_s,
                        "0.." + base::number_text(config.window_s) +
                            " s: beyond the window there would be frames that do not count");
  }
  return LoudnessMeter(config, frames_in(config.window_s, config.rate_hz),
                       frames_in(config.hop_s, config.rate_hz));
}

double LoudnessMeter::strength_of(const float* frame) const {
  double sum = 0, largest = 0;
  for (int c = 0; c < config_.channels; ++c) {
    const double x = std::isfinite(frame[c]) ? static_cast<double>(frame[c]) : 0.0;
    sum += x * x;
    largest = std::max(largest, std::abs(x));
  }
  return config_.measure == LoudnessConfig::Measure::peak ? largest : sum / config_.channels;
}

void LoudnessMeter::add(std::span<const float> interleaved) {
  const auto channels = static_cast<std::size_t>(config_.channels);
  for (std::size_t i = 0; i + channels <= interleaved.size(); i += channels) {
    strengths_.push_back(strength_of(interleaved.data() + i));
    ++count_;
    if (count_ < next_ - window_ / 2 + window_) continue;
    levels_.push_back({next_, level_at(next_)});
    next_ += hop_;
    forget_old();
  }
}

void LoudnessMeter::finish() {
  for (; next_ < count_; next_ += hop_) levels_.push_back({next_, level_at(next_)});
  if (count_ > 0) levels_.push_back({count_, level_at(count_)});
}

double LoudnessMeter::level_at(std::int64_t frame) const {
  const std::int64_t from = std::clamp<std::int64_t>(frame - window_ / 2, 0, count_ - 1);
  const std::int64_t to = std::min(frame - window_ / 2 + window_, count_);
  const auto size = static_cast<std::size_t>(to - from);
  const auto window = std::span(strengths_).subspan(static_cast<std::size_t>(from - first_), size);
  if (config_.measure == LoudnessConfig::Measure::peak) {
    return *std::max_element(window.begin(), window.end());
  }
  return std::sqrt(sum_of(window) / static_cast<double>(size));
}

// Frames before all windows to come, that of the end too; seldom, so that a frame costs few moves.
void LoudnessMeter::forget_old() {
  const std::int64_t begin = std::min(next_, count_ - 1) - window_ / 2;
  const std::int64_t old = std::min(begin - first_, static_cast<std::int64_t>(strengths_.size()));
  if (old < std::max<std::int64_t>(window_, 4096)) return;
  strengths_.erase(strengths_.begin(), strengths_.begin() + old);
  first_ += old;
}

double level_on_db_scale(double level, double floor_db) {
  const double db = base::gain_to_db(level);
  return db > floor_db ? 1 - db / floor_db : 0;
}

}  // namespace knotwave::dsp

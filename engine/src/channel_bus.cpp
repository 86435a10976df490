// SPDX-License-Identifier: MIT
#include "channel_bus.h"

#include <algorithm>

#include "knotwave/dsp/crossfade.h"

namespace knotwave::engine {
namespace {

constexpr double kSqrt2 = 0x1.6a09e667f3bcdp+0;  // the centre is neither louder nor softer

}  // namespace

void ChannelBus::prepare(double rate_hz, std::size_t frames) {
  glide_samples_ = static_cast<int>(kBusGlideSeconds * rate_hz + 0.5);
  for (auto* buffer : {&left_, &right_, &left_gain_, &right_gain_}) buffer->resize(frames);
  gains_.resize(frames);
  places_.resize(frames);
}

void ChannelBus::reset(const ChannelState& channel, double master_gain) KNOTWAVE_RT {
  gain_.reset(channel.volume_gain() * master_gain, glide_samples_);
  pan_.reset(channel.pan_position(), glide_samples_);
}

void ChannelBus::follow(const ChannelState& channel, double master_gain, std::int64_t sample,
                        bool is_silent) KNOTWAVE_RT {
  if (is_silent) {
    reset(channel, master_gain);
    return;
  }
  gain_.set_target(channel.volume_gain() * master_gain, sample);
  pan_.set_target(channel.pan_position(), sample);
}

void ChannelBus::clear(std::size_t from, std::size_t until) KNOTWAVE_RT {
  for (auto* side : {&left_, &right_}) {
    const std::span<float> places = std::span(*side).first(until).subspan(from);
    std::fill(places.begin(), places.end(), 0.0F);
  }
}

void ChannelBus::add(std::size_t at, std::span<const float> left,
                     std::span<const float> right) KNOTWAVE_RT {
  for (std::size_t i = 0; i < left.size(); ++i) left_[at + i] += left[i];
  for (std::size_t i = 0; i < right.size(); ++i) right_[at + i] += right[i];
}

void ChannelBus::finish(std::int64_t first, std::size_t at, std::size_t n) KNOTWAVE_RT {
  gain_.render(first, std::span(gains_).first(n));
  pan_.render(first, std::span(places_).first(n));
  dsp::equal_power(std::span<const double>(places_).first(n), std::span(left_gain_).first(n),
                   std::span(right_gain_).first(n));
  for (std::size_t i = 0; i < n; ++i) {
    const double both = gains_[i] * kSqrt2;
    left_[at + i] *= static_cast<float>(both * static_cast<double>(left_gain_[i]));
    right_[at + i] *= static_cast<float>(both * static_cast<double>(right_gain_[i]));
  }
}

}  // namespace knotwave::engine

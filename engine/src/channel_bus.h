// SPDX-License-Identifier: MIT
// Where the voices of one channel meet: channel volume, expression and pan.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/dsp/smoother.h"
#include "knotwave/engine/channel_state.h"

namespace knotwave::engine {

inline constexpr double kBusGlideSeconds = 0.010;

class ChannelBus {
 public:
  /// [control] `frames` is the longest segment.
  void prepare(double rate_hz, std::size_t frames);
  /// At rest at the channel's values. [audio]
  void reset(const ChannelState& channel, double master_gain) KNOTWAVE_RT;
  /// Glides to the channel's values from `sample` on; at once when nothing sounds on it. [audio]
  void follow(const ChannelState& channel, double master_gain, std::int64_t sample,
              bool is_silent) KNOTWAVE_RT;
  /// Places from..until-1 are silent. [audio], and so is all below.
  void clear(std::size_t from, std::size_t until) KNOTWAVE_RT;
  /// Onto the places from `at` on.
  void add(std::size_t at, std::span<const float> left, std::span<const float> right) KNOTWAVE_RT;
  /// Volume and pan onto what was mixed at places at..at+n-1, which are samples first..
  void finish(std::int64_t first, std::size_t at, std::size_t n) KNOTWAVE_RT;
  struct Sides {
    std::span<const float> left, right;
  };
  Sides sides(std::size_t n) const KNOTWAVE_RT {
    return {std::span(left_).first(n), std::span(right_).first(n)};
  }

 private:
  int glide_samples_ = 1;
  dsp::Smoother gain_, pan_;
  std::vector<float> left_, right_, left_gain_, right_gain_;
  std::vector<double> gains_, places_;
};

}  // namespace knotwave::engine

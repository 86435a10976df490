// SPDX-License-Identifier: MIT
// Numbers a player adds to the slots of a channel's voices by hand: set_target events. All [audio]
// but the constructor.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/dsp/smoother.h"
#include "knotwave/engine/map_slots.h"

namespace knotwave::engine {

/// A number glides to a new value in so long, on the absolute sample index.
inline constexpr double kTargetGlideSeconds = 0.005;
inline constexpr double kMostTarget = 1e6;  ///< either way

class ChannelTargets {
 public:
  ChannelTargets() : numbers_(kSlotCount) {}

  /// None is set.
  void reset(double rate_hz) KNOTWAVE_RT;
  /// From the event's sample on. NaN is ignored.
  void set(int slot, double number, std::int64_t sample) KNOTWAVE_RT;
  /// All glide to 0.
  void go_back(std::int64_t sample) KNOTWAVE_RT;
  /// Those that rest at 0 are set no more. Called at events only, so that it happens at a sample
  /// and not at a block.
  void forget_rested(std::int64_t sample) KNOTWAVE_RT;

  bool is_empty() const KNOTWAVE_RT { return count_ == 0; }
  bool is_set(int slot) const KNOTWAVE_RT { return is_set_[static_cast<std::size_t>(slot)]; }
  /// In the order in which they were set.
  std::span<const std::uint8_t> slots() const KNOTWAVE_RT {
    return std::span(slots_).first(count_);
  }
  const dsp::Smoother& number(int slot) const KNOTWAVE_RT {
    return numbers_[static_cast<std::size_t>(slot)];
  }

 private:
  static_assert(kSlotCount <= 256);
  std::vector<dsp::Smoother> numbers_;  ///< [kSlotCount]
  std::array<bool, kSlotCount> is_set_{};
  std::array<std::uint8_t, kSlotCount> slots_{};
  std::size_t count_ = 0;
  int glide_samples_ = 1;
};

}  // namespace knotwave::engine

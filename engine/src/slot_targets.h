// SPDX-License-Identifier: MIT
// Numbers a player adds to slots by hand, those of a channel's voices or of one note: set_target
// and set_note events. All [audio] but the constructor.
#pragma once
#include <algorithm>
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

class SlotTargets {
 public:
  /// Room for so many slots at once.
  explicit SlotTargets(int most = kSlotCount) : numbers_(static_cast<std::size_t>(most)) {}

  /// None is set.
  void reset(double rate_hz) KNOTWAVE_RT;
  /// From the event's sample on; false: there is no room. `glides`: not at once. NaN is ignored.
  bool set(int slot, double number, std::int64_t sample, bool glides = true) KNOTWAVE_RT;
  /// All glide to 0.
  void go_back(std::int64_t sample) KNOTWAVE_RT;
  /// Those that rest at 0 are set no more. Called at events only, so that it happens at a sample
  /// and not at a block.
  void forget_rested(std::int64_t sample) KNOTWAVE_RT;

  bool is_empty() const KNOTWAVE_RT { return count_ == 0; }
  bool is_still(std::int64_t first) const KNOTWAVE_RT {
    return std::all_of(numbers_.begin(), numbers_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [first](const dsp::Smoother& number) { return number.is_still(first); });
  }
  bool is_set(int slot) const KNOTWAVE_RT { return place_[static_cast<std::size_t>(slot)] != 0; }
  /// In the order in which they were set.
  std::span<const std::uint8_t> slots() const KNOTWAVE_RT {
    return std::span(slots_).first(count_);
  }
  /// Of slots()[place].
  const dsp::Smoother& number(std::size_t place) const KNOTWAVE_RT { return numbers_[place]; }

 private:
  static_assert(kSlotCount <= 255);
  std::vector<dsp::Smoother> numbers_;  ///< [most]
  std::array<std::uint8_t, kSlotCount> slots_{};
  std::array<std::uint8_t, kSlotCount> place_{};  ///< of each slot in slots_, from 1; 0: not set
  std::size_t count_ = 0;
  int glide_samples_ = 1;
};

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Depths and offsets a player gives the outputs of an envelope patch by hand: set_target events.
// All [audio].
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "knotwave/dsp/smoother.h"
#include "knotwave/engine/envelope_patch.h"
#include "knotwave/engine/envelope_player.h"

#include "slot_targets.h"

namespace knotwave::engine {

class OutputTrims {
 public:
  void reset(double rate_hz) KNOTWAVE_RT {
    is_set_.fill(false);
    any_is_set_ = false;
    glide_samples_ = static_cast<int>(std::clamp(kTargetGlideSeconds * rate_hz + 0.5, 1.0, 1e8));
  }
  static bool has(int slot) KNOTWAVE_RT {
    return slot >= kSlotOutputDepth && slot < kSlotOutputDepth + static_cast<int>(kCount);
  }
  /// From the event's sample on. NaN is ignored.
  void set(int slot, double number, std::int64_t sample) KNOTWAVE_RT {
    if (number != number) return;
    const auto i = static_cast<std::size_t>(slot - kSlotOutputDepth);
    if (!is_set_[i]) {
      if (number == 0) return;
      is_set_[i] = any_is_set_ = true;
      numbers_[i].reset(0, glide_samples_);
    }
    numbers_[i].set_target(std::clamp(number, -kMostTarget, kMostTarget), sample);
  }
  void go_back(std::int64_t sample) KNOTWAVE_RT {
    for (std::size_t i = 0; i < kCount; ++i) {
      if (is_set_[i]) numbers_[i].set_target(0, sample);
    }
  }

  bool is_empty() const KNOTWAVE_RT { return !any_is_set_; }
  bool is_still(std::int64_t first) const KNOTWAVE_RT {
    for (std::size_t i = 0; any_is_set_ && i < kCount; ++i) {
      if (is_set_[i] && !numbers_[i].is_still(first)) return false;
    }
    return true;
  }
  /// The numbers of an output at samples first.. become what depth and offset make of them.
  void apply(std::size_t output, const OutputSpec& spec, std::int64_t first,
             std::span<double> values) const KNOTWAVE_RT {
    const std::size_t depth = output, offset = kMaxOutputs + output;
    if (!is_set_[depth] && !is_set_[offset]) return;
    const double span = std::abs(spec.high - spec.low);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::int64_t sample = first + static_cast<std::int64_t>(i);
      const double deeper = is_set_[depth] ? numbers_[depth].value_at(sample) : 0;
      const double shift = is_set_[offset] ? numbers_[offset].value_at(sample) : 0;
      values[i] += deeper * (values[i] - spec.rest) + shift * span;
    }
  }

 private:
  static constexpr std::size_t kCount = 2 * std::size_t{kMaxOutputs};
  std::array<dsp::Smoother, kCount> numbers_;
  std::array<bool, kCount> is_set_{};
  bool any_is_set_ = false;
  int glide_samples_ = 1;
};

}  // namespace knotwave::engine

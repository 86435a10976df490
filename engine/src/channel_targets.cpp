// SPDX-License-Identifier: MIT
#include "channel_targets.h"

#include <algorithm>

namespace knotwave::engine {

void ChannelTargets::reset(double rate_hz) KNOTWAVE_RT {
  is_set_.fill(false);
  count_ = 0;
  glide_samples_ = static_cast<int>(std::clamp(kTargetGlideSeconds * rate_hz + 0.5, 1.0, 1e8));
}

void ChannelTargets::set(int slot, double number, std::int64_t sample) KNOTWAVE_RT {
  if (number != number) return;
  const auto i = static_cast<std::size_t>(slot);
  if (!is_set_[i]) {
    if (number == 0) return;
    is_set_[i] = true;
    slots_[count_++] = static_cast<std::uint8_t>(slot);
    numbers_[i].reset(0, glide_samples_);
  }
  numbers_[i].set_target(std::clamp(number, -kMostTarget, kMostTarget), sample);
}

void ChannelTargets::go_back(std::int64_t sample) KNOTWAVE_RT {
  for (const std::uint8_t slot : slots()) numbers_[slot].set_target(0, sample);
}

void ChannelTargets::forget_rested(std::int64_t sample) KNOTWAVE_RT {
  std::size_t kept = 0;
  for (const std::uint8_t slot : slots()) {
    is_set_[slot] = numbers_[slot].target() != 0 || !numbers_[slot].is_still(sample);
    if (is_set_[slot]) slots_[kept++] = slot;
  }
  count_ = kept;
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "slot_targets.h"

#include <algorithm>

namespace knotwave::engine {

void SlotTargets::reset(double rate_hz) KNOTWAVE_RT {
  place_.fill(0);
  count_ = 0;
  glide_samples_ = static_cast<int>(std::clamp(kTargetGlideSeconds * rate_hz + 0.5, 1.0, 1e8));
}

bool SlotTargets::set(int slot, double number, std::int64_t sample, bool glides) KNOTWAVE_RT {
  if (number != number) return true;
  const double held = std::clamp(number, -kMostTarget, kMostTarget);
  std::uint8_t& place = place_[static_cast<std::size_t>(slot)];
  if (place == 0) {
    if (number == 0) return true;
    if (count_ == numbers_.size()) return false;
    numbers_[count_].reset(0, glide_samples_);
    slots_[count_] = static_cast<std::uint8_t>(slot);
    place = static_cast<std::uint8_t>(++count_);
  }
  dsp::Smoother& smoother = numbers_[place - 1U];
  if (glides) {
    smoother.set_target(held, sample);
  } else {
    smoother.reset(held, glide_samples_);
  }
  return true;
}

void SlotTargets::go_back(std::int64_t sample) KNOTWAVE_RT {
  for (std::size_t i = 0; i < count_; ++i) numbers_[i].set_target(0, sample);
}

void SlotTargets::forget_rested(std::int64_t sample) KNOTWAVE_RT {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const std::uint8_t slot = slots_[i];
    if (numbers_[i].target() == 0 && numbers_[i].is_still(sample)) {
      place_[slot] = 0;
      continue;
    }
    if (kept != i) numbers_[kept] = numbers_[i];
    slots_[kept++] = slot;
    place_[slot] = static_cast<std::uint8_t>(kept);
  }
  count_ = kept;
}

}  // namespace knotwave::engine

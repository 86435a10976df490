// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>

#include "knotwave/base/fp_state.h"

namespace knotwave::plugins {

inline constexpr float kLargestInput = 1e6F;

/// What a host gives, fit to be heard: NaN is 0, below 1e-20 is 0, beyond 1e6 is 1e6. [audio]
inline float conditioned(float x) KNOTWAVE_RT {
  if (x != x) return 0;
  return base::snap_to_zero(std::clamp(x, -kLargestInput, kLargestInput));
}

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
// What a shaper takes in.
#pragma once
#include <algorithm>

#include "knotwave/base/fp_state.h"

namespace knotwave::dsp {

inline constexpr double kLargestShaperInput = 1e6;

/// NaN is 0, below 1e-20 is 0, beyond 1e6 is 1e6.
inline double shaper_input(double x) KNOTWAVE_RT {
  if (x != x) return 0;
  return base::snap_to_zero(std::clamp(x, -kLargestShaperInput, kLargestShaperInput));
}

}  // namespace knotwave::dsp

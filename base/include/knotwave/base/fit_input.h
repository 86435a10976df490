// SPDX-License-Identifier: MIT
// Whatever comes in from outside, fit to be worked with.
#pragma once
#include <algorithm>
#include <cmath>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// +120 dB.
template <class Float>
inline constexpr Float kLargestInput = Float(1e6);

/// NaN is 0, below 1e-20 is 0, beyond 1e6 is 1e6. [audio] No branches: a loop of it is vectors.
template <class Float>
inline Float fit_input(Float x) KNOTWAVE_RT {
  const Float number = std::abs(x) >= Float(1e-20) ? x : Float(0);
  return std::copysign(std::min(std::abs(number), kLargestInput<Float>), number);
}

}  // namespace knotwave::base

// SPDX-License-Identifier: MIT
// An audio block is a map grid: a start, a step, a count.
#pragma once
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::curves {

/// n steps from u1 to u2; node i is u1 + i * ((u2 - u1) / n), and i = n is exactly u2 (the one
/// numeric promise of glMapGrid). [any]
struct MapGrid {
  double u1 = 0;
  double u2 = 1;
  std::int64_t n = 1;

  constexpr double at(std::int64_t i) const KNOTWAVE_RT {
    return i == n ? u2 : u1 + static_cast<double>(i) * ((u2 - u1) / static_cast<double>(n));
  }
};

/// Part of an endless grid: node i is origin + (first + i) * step, i = 0..count-1, one rounding
/// for the product and one for the sum, so any split into blocks gives the same nodes. [any]
struct GridRun {
  double origin = 0;
  double step = 0;
  std::int64_t first = 0;

  constexpr double at(std::int64_t i) const KNOTWAVE_RT {
    return origin + static_cast<double>(first + i) * step;
  }
};

}  // namespace knotwave::curves

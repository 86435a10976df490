// SPDX-License-Identifier: MIT
// The doubles beside a finite one. Private to curves.
#pragma once
#include <bit>
#include <cstdint>

namespace knotwave::curves {

inline double next_up(double x) {
  if (x == 0) return std::bit_cast<double>(std::uint64_t{1});
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return std::bit_cast<double>(x > 0 ? bits + 1 : bits - 1);
}
inline double next_down(double x) { return -next_up(-x); }

}  // namespace knotwave::curves

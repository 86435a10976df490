// SPDX-License-Identifier: MIT
// A vector unit chosen for the length of a test.
#pragma once
#include <gtest/gtest.h>

#include "knotwave/curves/simd.h"

namespace knotwave::support {

/// The best one again at its end.
class SimdGuard {
 public:
  explicit SimdGuard(curves::SimdLevel level) {
    const auto set = curves::set_simd_level(level);
    EXPECT_TRUE(set) << set.error().message;
  }
  ~SimdGuard() {
    const auto set = curves::set_simd_level(curves::SimdLevel::best);
    EXPECT_TRUE(set);
  }
  SimdGuard(const SimdGuard&) = delete;
  SimdGuard& operator=(const SimdGuard&) = delete;
};

}  // namespace knotwave::support

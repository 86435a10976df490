// SPDX-License-Identifier: MIT
#include "knotwave/base/fp_state.h"

#include <cfenv>
#include <cfloat>
#include <limits>

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

/// The product as the processor makes it now.
double product(double a, double b) {
  volatile double x = a;
  volatile double y = b;
  return x * y;
}

#if defined(__SSE2__) || defined(__aarch64__)
TEST(FpStateGuard, FlushesOrKeepsDenormalsAsAsked) {
  {
    const FpStateGuard guard(FpStateGuard::Denormals::flushed);
    EXPECT_TRUE(product(DBL_MIN, 0.5) == 0);
    EXPECT_TRUE(product(std::numeric_limits<double>::denorm_min(), 0x1p60) == 0);
  }
  const FpStateGuard guard(FpStateGuard::Denormals::kept);
  EXPECT_TRUE(product(DBL_MIN, 0.5) == 0x1p-1023);
}

TEST(FpStateGuard, GuardsNest) {
  const FpStateGuard outer(FpStateGuard::Denormals::flushed);
  {
    const FpStateGuard inner(FpStateGuard::Denormals::kept);
    EXPECT_TRUE(product(DBL_MIN, 0.5) == 0x1p-1023);
  }
  EXPECT_TRUE(product(DBL_MIN, 0.5) == 0);
}
#endif

/// 1 + 2^-60 as the processor rounds it now: above 1 only when rounding upward.
bool rounds_upward() {
  volatile double one = 1;
  volatile double little = 0x1p-60;
  return one + little > 1;
}

TEST(FpStateGuard, RoundsToNearestAndRestoresTheModeBefore) {
  std::fesetround(FE_UPWARD);
  const bool before = rounds_upward();
  bool inside = true;
  {
    const FpStateGuard guard;
    inside = rounds_upward();
  }
  const bool after = rounds_upward();
  std::fesetround(FE_TONEAREST);
  EXPECT_TRUE(before);
  EXPECT_FALSE(inside);
  EXPECT_TRUE(after);
}

TEST(SnapToZero, CutsBelow1e20AndPassesTheRest) {
  EXPECT_EQ(snap_to_zero(0.9e-20), 0);
  EXPECT_EQ(snap_to_zero(-0.9e-20f), 0);
  EXPECT_EQ(snap_to_zero(1e-20), 1e-20);
  EXPECT_EQ(snap_to_zero(-1e-20), -1e-20);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(snap_to_zero(nan) != snap_to_zero(nan));
}

}  // namespace
}  // namespace knotwave::base

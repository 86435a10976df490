// SPDX-License-Identifier: MIT
#include "knotwave/base/time.h"

#include <gtest/gtest.h>

TEST(SampleTime, FirstSampleIsTheNextWholeOne) {
  EXPECT_EQ(knotwave::base::first_sample({7, 0}), 7);
  EXPECT_EQ(knotwave::base::first_sample({7, 1}), 8);
}

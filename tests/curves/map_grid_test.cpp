// SPDX-License-Identifier: MIT
#include "knotwave/curves/map_grid.h"

#include <gtest/gtest.h>

TEST(MapGrid, EndsAreExact) {
  const knotwave::curves::MapGrid grid{0.1, 0.7, 3};
  EXPECT_EQ(grid.at(0), 0.1);
  EXPECT_EQ(grid.at(3), 0.7);
}

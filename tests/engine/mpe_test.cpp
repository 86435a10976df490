// SPDX-License-Identifier: MIT
#include "knotwave/engine/mpe.h"

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

TEST(MpeZones, WithoutZonesEveryChannelSpeaksForItself) {
  const MpeZones zones;
  for (int c = 0; c < 16; ++c) {
    EXPECT_EQ(zones.master_of(c), c);
    EXPECT_FALSE(zones.is_member(c));
  }
}

TEST(MpeZones, TheLowerZoneGrowsUpwardsAndTheUpperOneDownwards) {
  MpeZones zones;
  EXPECT_TRUE(zones.configure(kLowerMaster, 5));
  EXPECT_TRUE(zones.configure(kUpperMaster, 4));
  EXPECT_EQ(zones.master_of(1), kLowerMaster);
  EXPECT_EQ(zones.master_of(5), kLowerMaster);
  EXPECT_EQ(zones.master_of(6), 6);
  EXPECT_EQ(zones.master_of(10), 10);
  EXPECT_EQ(zones.master_of(11), kUpperMaster);
  EXPECT_EQ(zones.master_of(14), kUpperMaster);
  EXPECT_FALSE(zones.is_member(0));
  EXPECT_FALSE(zones.is_member(15));
}

TEST(MpeZones, TheNewerZoneTakesChannelsFromTheOlder) {
  MpeZones zones;
  zones.configure(kLowerMaster, 10);
  zones.configure(kUpperMaster, 7);
  EXPECT_EQ(zones.lower_members(), 7);
  EXPECT_EQ(zones.upper_members(), 7);
  zones.configure(kLowerMaster, 15);
  EXPECT_EQ(zones.upper_members(), 0);
  EXPECT_EQ(zones.master_of(15), kLowerMaster);
  for (int lower = 0; lower <= 15; ++lower) {
    for (int upper = 0; upper <= 15; ++upper) {
      zones.configure(kLowerMaster, lower);
      zones.configure(kUpperMaster, upper);
      EXPECT_TRUE(zones.lower_members() == 0 || zones.upper_members() == 0 ||
                  zones.lower_members() + zones.upper_members() <= 14);
    }
  }
}

TEST(MpeZones, ZeroMembersClosesAZoneAndOtherChannelsAreNoMasters) {
  MpeZones zones;
  zones.configure(kLowerMaster, 3);
  EXPECT_FALSE(zones.configure(4, 3));
  zones.configure(kLowerMaster, 0);
  EXPECT_FALSE(zones.is_member(1));
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "voice_slots.h"

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

VoiceSlot sounding(int key, std::uint64_t age) {
  VoiceSlot slot;
  slot.state = VoiceSlot::State::sounding;
  slot.key = key;
  slot.key_down = true;
  slot.age = age;
  return slot;
}

TEST(VoiceSlots, AsManyVoicesMayFadeAsMaySound) {
  const VoiceSlots slots(3);
  EXPECT_EQ(slots.all().size(), 6U);
  EXPECT_EQ(slots.free_place(), 0);
  EXPECT_EQ(slots.victim(0, nullptr), -1);
}

TEST(VoiceSlots, TheLowestFreePlaceIsTaken) {
  VoiceSlots slots(2);
  for (int i = 0; i < 4; ++i) slots.at(i) = sounding(60, 0);
  EXPECT_EQ(slots.free_place(), -1);
  slots.at(2).state = VoiceSlot::State::free;
  EXPECT_EQ(slots.free_place(), 2);
  slots.at(1).state = VoiceSlot::State::free;
  EXPECT_EQ(slots.free_place(), 1);
}

TEST(VoiceSlots, ReleasedVoicesAreStolenFirstAndTheQuietestOfThem) {
  VoiceSlots slots(4);
  slots.at(0) = sounding(60, 1);
  slots.at(1) = sounding(61, 2);
  slots.at(1).key_down = false;
  slots.at(1).level = 0.5;
  slots.at(2) = sounding(62, 3);
  slots.at(2).key_down = false;
  slots.at(2).level = 0.1;
  slots.at(3) = sounding(63, 0);
  EXPECT_EQ(slots.victim(0, nullptr), 2);
  slots.at(2).state = VoiceSlot::State::fading;
  EXPECT_EQ(slots.victim(0, nullptr), 1);
}

TEST(VoiceSlots, PedalHeldVoicesGoBeforeThoseOfKeysAndTheOldestFirst) {
  VoiceSlots slots(4);
  slots.at(0) = sounding(60, 1);
  slots.at(1) = sounding(61, 5);
  slots.at(1).key_down = false;
  slots.at(1).pedal_held = true;
  slots.at(2) = sounding(62, 4);
  slots.at(2).key_down = false;
  slots.at(2).pedal_held = true;
  EXPECT_EQ(slots.victim(0, nullptr), 2);
  slots.at(1).state = slots.at(2).state = VoiceSlot::State::free;
  slots.at(3) = sounding(64, 0);
  EXPECT_EQ(slots.victim(0, nullptr), 3);
}

TEST(VoiceSlots, APatchStealsOnlyItsOwnVoicesOnItsOwnBus) {
  int one = 0, two = 0;
  const auto* patch_one = reinterpret_cast<const PatchProgram*>(&one);
  const auto* patch_two = reinterpret_cast<const PatchProgram*>(&two);
  VoiceSlots slots(4);
  slots.at(0) = sounding(60, 0);
  slots.at(0).patch = patch_one;
  slots.at(1) = sounding(60, 1);
  slots.at(1).patch = patch_two;
  slots.at(2) = sounding(60, 2);
  slots.at(2).patch = patch_two;
  slots.at(2).bus = 5;
  EXPECT_EQ(slots.victim(0, patch_two), 1);
  EXPECT_EQ(slots.victim(5, patch_two), 2);
  EXPECT_EQ(slots.victim(5, patch_one), -1);
  EXPECT_EQ(slots.sounding_count(0, patch_two), 1);
  EXPECT_EQ(slots.sounding_count(), 3);
}

TEST(VoiceSlots, ANoteOffBelongsToTheOldestNoteOnOfItsKey) {
  VoiceSlots slots(4);
  slots.at(0) = sounding(60, 7);
  slots.at(1) = sounding(60, 3);
  slots.at(2) = sounding(61, 1);
  EXPECT_EQ(slots.oldest_down(0, 60), 1);
  slots.at(1).key_down = false;
  EXPECT_EQ(slots.oldest_down(0, 60), 0);
  slots.at(0).is_mono = true;
  EXPECT_EQ(slots.oldest_down(0, 60), -1);
  EXPECT_EQ(slots.oldest_down(1, 61), -1);
}

TEST(VoiceSlots, ABankIsPlayedUntilItsLastVoiceHasFaded) {
  int bank = 0;
  const auto* program = reinterpret_cast<const BankProgram*>(&bank);
  VoiceSlots slots(2);
  EXPECT_FALSE(slots.is_playing(program));
  slots.at(1) = sounding(60, 0);
  slots.at(1).bank = program;
  slots.at(1).state = VoiceSlot::State::fading;
  EXPECT_TRUE(slots.is_playing(program));
  EXPECT_EQ(slots.sounding_buses(), 1u);
  slots.clear();
  EXPECT_FALSE(slots.is_playing(program));
  EXPECT_EQ(slots.sounding_buses(), 0u);
}

}  // namespace
}  // namespace knotwave::engine

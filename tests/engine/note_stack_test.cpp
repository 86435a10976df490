// SPDX-License-Identifier: MIT
#include "knotwave/engine/note_stack.h"

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

int sounding(const NoteStack& stack, NotePriority priority) {
  const NoteStack::Entry* entry = stack.choose(priority);
  return entry == nullptr ? -1 : entry->key;
}

TEST(NoteStack, PriorityChoosesLastLowestOrHighest) {
  NoteStack stack;
  for (const int key : {60, 50, 70, 64}) stack.press(key, 100);
  EXPECT_EQ(sounding(stack, NotePriority::last), 64);
  EXPECT_EQ(sounding(stack, NotePriority::low), 50);
  EXPECT_EQ(sounding(stack, NotePriority::high), 70);
}

TEST(NoteStack, LiftingFallsBackToTheKeyPressedBefore) {
  NoteStack stack;
  stack.press(60, 1);
  stack.press(62, 2);
  stack.press(64, 3);
  EXPECT_TRUE(stack.lift(62, false));
  EXPECT_EQ(sounding(stack, NotePriority::last), 64);
  stack.lift(64, false);
  EXPECT_EQ(sounding(stack, NotePriority::last), 60);
  stack.lift(60, false);
  EXPECT_TRUE(stack.is_empty());
}

TEST(NoteStack, AKeyPressedAgainIsOneEntryAtTheNewestPlace) {
  NoteStack stack;
  stack.press(60, 1);
  stack.press(62, 2);
  stack.press(60, 9);
  EXPECT_EQ(stack.size(), 2);
  EXPECT_EQ(sounding(stack, NotePriority::last), 60);
  EXPECT_EQ(stack.choose(NotePriority::last)->velocity, 9);
  stack.lift(60, false);
  EXPECT_EQ(sounding(stack, NotePriority::last), 62);
}

TEST(NoteStack, LiftingAKeyThatIsNotDownDoesNothing) {
  NoteStack stack;
  EXPECT_FALSE(stack.lift(60, false));
  stack.press(60, 1);
  EXPECT_TRUE(stack.lift(60, true));
  EXPECT_FALSE(stack.lift(60, true));
  EXPECT_EQ(stack.size(), 1);
}

TEST(NoteStack, KeysThatAreDownGoBeforeThoseThePedalHolds) {
  NoteStack stack;
  stack.press(60, 1);
  stack.press(62, 1);
  stack.lift(62, true);
  EXPECT_EQ(sounding(stack, NotePriority::last), 60);
  stack.lift(60, true);
  EXPECT_EQ(sounding(stack, NotePriority::last), 62);
  stack.drop_sustain();
  EXPECT_TRUE(stack.is_empty());
}

TEST(NoteStack, SustainReleasedWhileAKeyIsDownKeepsThatKeyOnly) {
  NoteStack stack;
  stack.press(60, 1);
  stack.press(62, 1);
  stack.lift(60, true);
  stack.drop_sustain();
  EXPECT_EQ(stack.size(), 1);
  EXPECT_EQ(sounding(stack, NotePriority::last), 62);
}

TEST(NoteStack, SostenutoHoldsOnlyTheKeysThatWereDown) {
  NoteStack stack;
  stack.press(60, 1);
  stack.catch_sostenuto();
  stack.press(62, 1);
  stack.lift(60, false);
  stack.lift(62, false);
  EXPECT_EQ(stack.size(), 1);
  EXPECT_EQ(sounding(stack, NotePriority::last), 60);
  stack.drop_sostenuto(true);  // sustain has it now
  EXPECT_EQ(stack.size(), 1);
  stack.drop_sustain();
  EXPECT_TRUE(stack.is_empty());
}

TEST(NoteStack, AllKeysAtOnceFit) {
  NoteStack stack;
  for (int round = 0; round < 3; ++round) {
    for (int key = 0; key < 128; ++key) stack.press(key, 1);
  }
  EXPECT_EQ(stack.size(), 128);
  stack.lift_all(false);
  EXPECT_TRUE(stack.is_empty());
}

}  // namespace
}  // namespace knotwave::engine

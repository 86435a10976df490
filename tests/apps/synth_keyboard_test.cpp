// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "keyboard.h"

namespace knotwave::synth {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Kind = KeyAction::Kind;
constexpr std::int64_t kMs = 1'000'000;

KeyAction on(int key) { return {Kind::note_on, key}; }
KeyAction off(int key) { return {Kind::note_off, key}; }

TEST(Keyboard, LettersAreAPianoFromMiddleC) {
  Keyboard keyboard;
  const std::string keys = "awsedftgyhujkolp;'";
  for (std::size_t i = 0; i < keys.size(); ++i) {
    EXPECT_THAT(keyboard.type(keys.substr(i, 1), 1), ElementsAre(on(60 + static_cast<int>(i))));
  }
}

TEST(Keyboard, ANoteLastsAsLongAsItsKeyRepeatsAndTheHoldTime) {
  Keyboard keyboard;
  EXPECT_THAT(keyboard.type("a", 10 * kMs), ElementsAre(on(60)));
  EXPECT_EQ(keyboard.next_end_ns(), 310 * kMs);
  for (int i = 1; i <= 10; ++i) {
    EXPECT_THAT(keyboard.expire(10 * kMs + i * 100 * kMs), IsEmpty()) << i;
    EXPECT_THAT(keyboard.type("a", 10 * kMs + i * 100 * kMs), IsEmpty()) << "a repeat";
  }
  EXPECT_THAT(keyboard.expire(1309 * kMs), IsEmpty());
  EXPECT_THAT(keyboard.expire(1310 * kMs), ElementsAre(off(60)));
  EXPECT_EQ(keyboard.next_end_ns(), -1);
  EXPECT_THAT(keyboard.type("a", 1400 * kMs), ElementsAre(on(60))) << "struck again";
}

TEST(Keyboard, NotesEndAtTheKeyTheyBeganWithWhenTheOctaveMoves) {
  Keyboard keyboard;
  keyboard.type("a", 1);
  EXPECT_THAT(keyboard.type("+", 2), ElementsAre(KeyAction{Kind::octave, 5}));
  EXPECT_THAT(keyboard.type("a", 3), ElementsAre(on(72)));
  EXPECT_THAT(keyboard.expire(1000 * kMs), ElementsAre(off(60), off(72)));
}

TEST(Keyboard, NoNoteLeavesTheRangeOfMidi) {
  Keyboard keyboard;
  for (int i = 0; i < 20; ++i) keyboard.type("+", 1);
  EXPECT_EQ(keyboard.octave(), 9);
  EXPECT_THAT(keyboard.type("g", 1), ElementsAre(on(127)));
  EXPECT_THAT(keyboard.type("h", 1), IsEmpty());
  for (int i = 0; i < 20; ++i) keyboard.type("-", 1);
  EXPECT_THAT(keyboard.type("a", 1), ElementsAre(on(0)));
}

TEST(Keyboard, CommandsAreKnownAndOtherKeysMeanNothing) {
  Keyboard keyboard;
  EXPECT_THAT(keyboard.type("r\t?q ", 1),
              ElementsAre(KeyAction{Kind::record}, KeyAction{Kind::next_patch},
                          KeyAction{Kind::help}, KeyAction{Kind::quit}, KeyAction{Kind::panic}));
  EXPECT_THAT(keyboard.type("zx1A\n\x7f", 1), IsEmpty());
}

TEST(Keyboard, AfterPanicNoNoteOffIsLeft) {
  Keyboard keyboard;
  keyboard.type("asd ", 1);
  EXPECT_THAT(keyboard.expire(1000 * kMs), IsEmpty());
}

TEST(Keyboard, SequencesOfATerminalPlayNothing) {
  Keyboard keyboard;
  EXPECT_THAT(keyboard.type("\x1b[A\x1b[1;5D\x1bOP\x1b[15~", 1), IsEmpty());
  EXPECT_THAT(keyboard.type("\x1b", 1), IsEmpty());
  EXPECT_THAT(keyboard.type("d", 1), ElementsAre(on(64))) << "after Escape by itself";
}

}  // namespace
}  // namespace knotwave::synth

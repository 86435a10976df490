// SPDX-License-Identifier: MIT
// Numbers a player adds to the slots of voices. That blocks and threads do not matter is shown in
// determinism_test.cpp.
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "knotwave/engine/target_words.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

Event target(std::int64_t sample, int channel, int slot, double number) {
  Event event = of_kind(sample, Event::Kind::set_target);
  event.midi.bytes[0] = static_cast<std::uint8_t>(channel);
  event.slot = static_cast<std::uint16_t>(slot);
  event.number = number;
  return event;
}

Sound rendered(std::string_view patch, const std::vector<Event>& events, std::size_t frames,
               std::size_t block = 256) {
  const auto bank = bank_from(patch);
  return play(*engine_for(*bank), events, frames, block);
}

constexpr std::int64_t kSet = 9600;
constexpr std::size_t kGlide = 240;  // 5 ms
constexpr std::size_t kFrames = 24000;

TEST(SetTarget, MovesTheLoudnessOfASoundingNoteIn5MsAndThenExactly) {
  const Sound plain = rendered(kPlain, {on(0, 0, 60)}, kFrames);
  const Sound set = rendered(kPlain, {on(0, 0, 60), target(kSet, 0, kSlotAmp, -20)}, kFrames);
  for (std::size_t i = 0; i <= kSet; ++i) ASSERT_EQ(plain.left[i], set.left[i]) << i;
  for (std::size_t i = kSet + 1; i < kSet + kGlide; ++i) {
    ASSERT_LE(std::abs(set.left[i]), std::abs(plain.left[i])) << i;
    ASSERT_GE(std::abs(set.left[i]), std::abs(plain.left[i]) * 0.0999F) << i;
  }
  for (std::size_t i = kSet + kGlide; i < kFrames; ++i) {
    ASSERT_NEAR(set.left[i], plain.left[i] * 0.1F, 1e-8) << i;
  }
}

TEST(SetTarget, HoldsForLaterNotesOfItsChannelAndForNoOther) {
  const auto level = [](int channel, int set_on) {
    return peak(
        rendered(kPlain, {target(0, set_on, kSlotAmp, -40), on(4800, channel, 60)}, kFrames).left);
  };
  EXPECT_NEAR(level(0, 1) / level(0, 0), 100, 1e-3);
  EXPECT_EQ(level(0, 1), level(3, 1));
}

TEST(SetTarget, MovesThePitchBySemitones) {
  const Sound set = rendered(kPlain, {on(0, 0, 69), target(0, 0, kSlotPitch, 7)}, kFrames);
  EXPECT_NEAR(frequency_hz(set.left, 2400, kFrames), 440 * std::exp2(7 / 12.0), 0.01);
}

TEST(SetTarget, PansASourceOfAPatchThatWasCompiledInMono) {
  const int slot = kSlotSourcePan;
  const Sound plain = rendered(kPlain, {on(0, 0, 60)}, kFrames);
  const Sound set = rendered(kPlain, {on(0, 0, 60), target(kSet, 0, slot, -0.5)}, kFrames);
  EXPECT_GT(peak(set.left, kSet + kGlide), 1.4 * peak(plain.left, kSet));
  EXPECT_LT(peak(set.right, kSet + kGlide), 1e-6);
  const float step = std::abs(set.right[kSet + 1] - set.right[kSet]);
  const float usual = std::abs(plain.right[kSet + 1] - plain.right[kSet]);
  EXPECT_NEAR(step, usual, 1e-5);
}

TEST(SetTarget, MovesPhasesAndLfoSpeedsThatNoMapMoves) {
  constexpr std::string_view kVibrato = R"(
[lfos.slow]
curve = "wobble"
rate_hz = 4
[curves.wobble]
degree = 2
periodic = true
points = [0, 1, 0, -1]
[[maps]]
from = "slow"
to = "pitch"
)";
  const std::string patch = std::string(kPlain) + std::string(kVibrato);
  const Sound plain = rendered(patch, {on(0, 0, 60)}, kFrames);
  const Sound faster = rendered(patch, {on(0, 0, 60), target(kSet, 0, kSlotLfoRate, 1)}, kFrames);
  const Sound shifted =
      rendered(kPlain, {on(0, 0, 60), target(kSet, 0, kSlotSourcePhase, 0.5)}, kFrames);
  const Sound still = rendered(kPlain, {on(0, 0, 60)}, kFrames);
  EXPECT_FALSE(plain == faster);
  for (std::size_t i = kSet + kGlide; i < kFrames; ++i) {
    ASSERT_NEAR(shifted.left[i], -still.left[i], 1e-6) << i;
  }
}

TEST(SetTarget, EverySlotTakesAllBackAndLaterNotesAreThoseOfAnEngineThatHeardNone) {
  std::vector<Event> events;
  for (int slot = 0; slot < kSlotCount; ++slot) events.push_back(target(slot, 0, slot, 0.3));
  events.push_back(target(1000, 0, Event::kEverySlot, 5));
  events.push_back(on(4800, 0, 60));
  EXPECT_EQ(rendered(kRich, events, kFrames), rendered(kRich, {on(4800, 0, 60)}, kFrames));
}

TEST(SetTarget, ASystemResetTakesAllBack) {
  const std::vector<Event> events = {target(0, 2, kSlotAmp, -40), midi(100, 0xFF, 0, 0),
                                     on(4800, 2, 60)};
  EXPECT_EQ(rendered(kPlain, events, kFrames), rendered(kPlain, {on(4800, 2, 60)}, kFrames));
}

Event everywhere(std::int64_t sample, int slot, double number) {
  Event event = target(sample, 9, slot, number);
  event.every_channel = true;
  return event;
}

TEST(SetTarget, OfEveryChannelMovesAllAndAddsToThoseOfAChannel) {
  const std::vector<Event> notes = {on(4800, 0, 60), on(9600, 7, 67)};
  const auto with = [&](std::vector<Event> before) {
    before.insert(before.end(), notes.begin(), notes.end());
    return rendered(kPlain, before, kFrames);
  };
  const Sound by_one = with({everywhere(0, kSlotAmp, -6)});
  EXPECT_EQ(by_one, with({target(0, 0, kSlotAmp, -6), target(0, 7, kSlotAmp, -6)}));
  EXPECT_EQ(
      with({everywhere(0, kSlotAmp, -6), target(0, 0, kSlotAmp, -6), target(0, 7, kSlotAmp, -6)}),
      with({target(0, 0, kSlotAmp, -12), target(0, 7, kSlotAmp, -12)}));
}

TEST(SetTarget, OfEveryChannelOutlivesAReset) {
  const std::vector<Event> reset = {everywhere(0, kSlotAmp, -6), midi(100, 0xFF, 0, 0),
                                    on(4800, 2, 60)};
  EXPECT_EQ(rendered(kPlain, reset, kFrames),
            rendered(kPlain, {everywhere(0, kSlotAmp, -6), on(4800, 2, 60)}, kFrames));
}

TEST(SetTarget, OfEveryChannelCountsOnceInAZoneOfMpe) {
  const auto level = [](const Event& event) {
    return peak(rendered(kPlain,
                         {control(0, 0, 101, 0), control(0, 0, 100, 6), control(0, 0, 6, 5), event,
                          on(4800, 2, 60)},
                         kFrames)
                    .left);
  };
  EXPECT_EQ(level(everywhere(0, kSlotAmp, -20)), level(target(0, 2, kSlotAmp, -20)));
}

TEST(SetTarget, OfEveryChannelIsTakenBackByItself) {
  const std::vector<Event> events = {everywhere(0, kSlotAmp, -20), target(0, 2, kSlotAmp, -6),
                                     everywhere(1000, Event::kEverySlot, 0), on(4800, 2, 60)};
  EXPECT_EQ(rendered(kPlain, events, kFrames),
            rendered(kPlain, {target(0, 2, kSlotAmp, -6), on(4800, 2, 60)}, kFrames));
}

TEST(SetTarget, OfAZonesMasterMovesTheNotesOfItsMembers) {
  const auto level = [](int channel, double db) {
    return peak(rendered(kPlain,
                         {control(0, 0, 101, 0), control(0, 0, 100, 6), control(0, 0, 6, 5),
                          target(0, channel, kSlotAmp, db), on(4800, 2, 60)},
                         kFrames)
                    .left);
  };
  EXPECT_NEAR(level(0, -20) / level(0, 0), 0.1, 1e-6);
  EXPECT_EQ(level(2, -20), level(0, -20));
  EXPECT_EQ(level(1, -20), level(0, 0));
}

TEST(SetTarget, KeepsTheMovedNumberOfACurveWithinItsRange) {
  constexpr std::string_view kMoved = R"(
[curves.bow]
degree = 2
points = [0, 0.5, 1]
[[maps]]
from = "key"
to = "pitch"
curve = "bow"
depth = 12
[[maps]]
from = "velocity"
to = "curve.bow.point.1"
low = 0
high = 1
)";
  const std::string patch = std::string(kPlain) + std::string(kMoved);
  const auto spec = parse_patch(patch, "scene.toml");
  ASSERT_TRUE(spec) << spec.error().to_string();
  const auto slot = find_slot(*spec, "curve.bow.point.1");
  ASSERT_TRUE(slot) << slot.error().to_string();
  const auto pitch = [&](double number) {
    const Sound sound = rendered(patch, {target(0, 0, *slot, number), on(480, 0, 64, 64)}, kFrames);
    return frequency_hz(sound.left, 4800, kFrames);
  };
  EXPECT_GT(pitch(0.6), 1.1 * pitch(0));
  EXPECT_EQ(pitch(0.6), pitch(500));
  EXPECT_EQ(pitch(-0.6), pitch(-1e300));
}

TEST(SetTarget, WhateverTheNumberIsTheSamplesAreFinite) {
  for (const double number :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(), 1e300, -1e300}) {
    std::vector<Event> events{on(0, 0, 60)};
    for (int slot = 0; slot < kSlotCount; ++slot) {
      events.push_back(target(100 * slot, 0, slot, number));
      events.push_back(on(100 * slot, 0, 36 + slot % 60));
    }
    const Sound sound = rendered(kRich, events, kFrames);
    for (std::size_t i = 0; i < kFrames; ++i) {
      ASSERT_TRUE(std::isfinite(sound.left[i]) && std::isfinite(sound.right[i])) << number << i;
    }
  }
}

TEST(SetTarget, OfASlotThatIsNoneIsCounted) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  play(*engine, {target(0, 0, kSlotCount, 1), target(0, 0, 0xFFFE, 1)}, 256);
  EXPECT_EQ(engine->counters().events_unknown, 2);
}

TEST(TargetWords, EverySlotHasOneNameAndEveryNameOneSlot) {
  std::set<std::string> words;
  for (int slot = 0; slot < kSlotCount; ++slot) {
    const std::string word = slot_word(slot);
    ASSERT_FALSE(word.empty()) << slot;
    EXPECT_TRUE(words.insert(word).second) << word;
    EXPECT_EQ(slot_of_word(word), slot) << word;
  }
  EXPECT_EQ(slot_word(-1), "");
  EXPECT_EQ(slot_word(kSlotCount), "");
  EXPECT_EQ(slot_of_word("oscillator.1.level"), kSlotSourceLevel);
  for (const char* word : {"", "oscillator..level", "oscillator.0.level", "oscillator.01.level",
                           "oscillator.5.level", "oscillator.1", "free.17", "free.", "lfo.+1.rate",
                           "amp.1", "oscillator.99999999999.level"}) {
    EXPECT_FALSE(slot_of_word(word)) << word;
  }
}

TEST(TargetWords, APatchNamesItsOwnAndTheOthersAreSuggested) {
  const auto spec = parse_patch(kRich, "rich.toml");
  ASSERT_TRUE(spec);
  std::set<std::string> words;
  for (const TargetName& name : targets_of(*spec)) {
    EXPECT_TRUE(words.insert(name.word).second) << name.word;
    EXPECT_EQ(*find_slot(*spec, name.word), name.slot);
  }
  EXPECT_EQ(*find_slot(*spec, "b.level"), kSlotSourceLevel + 1);
  EXPECT_EQ(*find_slot(*spec, "filter.cutoff"), kSlotCutoff);
  EXPECT_EQ(*find_slot(*spec, "cutoff"), kSlotCutoff);
  EXPECT_EQ(*find_slot(*spec, "oscillator.2.level"), kSlotSourceLevel + 1);
  const auto wrong = find_slot(*spec, "filter.cutof");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::unknown_name);
  EXPECT_EQ(wrong.error().message,
            "there is no target 'filter.cutof' in patch 'Rich'; did you mean 'filter.cutoff'?");
}

}  // namespace
}  // namespace knotwave::engine

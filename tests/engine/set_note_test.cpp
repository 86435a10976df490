// SPDX-License-Identifier: MIT
// What a player says of one note reaches that note alone, by its number or its key, and numbered
// notes are told when they end. That blocks and threads do not matter is shown in
// determinism_test.cpp.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/engine/map_slots.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

Event numbered(Event event, std::int32_t note) {
  event.note = note;
  return event;
}
Event say(std::int64_t sample, std::int32_t note, int slot, double number) {
  Event event = of_kind(sample, Event::Kind::set_note);
  event.note = note;
  event.slot = static_cast<std::uint16_t>(slot);
  event.number = number;
  return event;
}
Event say_of_key(std::int64_t sample, int channel, int key, int slot, double number) {
  Event event = say(sample, Event::kNoNote, slot, number);
  event.midi.bytes[0] = static_cast<std::uint8_t>(channel);
  event.midi.bytes[1] = static_cast<std::uint8_t>(key);
  return event;
}

Sound rendered(std::string_view patch, const std::vector<Event>& events, std::size_t frames) {
  const auto bank = bank_from(patch);
  return play(*engine_for(*bank), events, frames, 256);
}

constexpr std::size_t kFrames = 24000;
constexpr std::int64_t kSaid = 9600;
constexpr std::size_t kGlide = 240;  // 5 ms

/// The two notes without each other: the engine adds voices.
Sound sum(const Sound& a, const Sound& b) {
  Sound out = a;
  for (std::size_t i = 0; i < a.left.size(); ++i) {
    out.left[i] += b.left[i];
    out.right[i] += b.right[i];
  }
  return out;
}

void expect_near(const Sound& found, const Sound& expected, std::size_t from = 0) {
  for (std::size_t i = from; i < expected.left.size(); ++i) {
    ASSERT_NEAR(found.left[i], expected.left[i], 1e-7) << i;
    ASSERT_NEAR(found.right[i], expected.right[i], 1e-7) << i;
  }
}

TEST(SetNote, MovesTheNoteOfItsNumberAndNoOtherOfItsKey) {
  const Event first = numbered(on(0, 0, 60), 5), second = numbered(on(0, 0, 60, 50), 6);
  const Sound both = rendered(kPlain, {first, second, say(kSaid, 6, kSlotAmp, -200)}, kFrames);
  const Sound alone = rendered(kPlain, {first}, kFrames);
  expect_near(both, alone, kSaid + kGlide);
  EXPECT_GT(std::abs(both.left[kSaid - 5] - alone.left[kSaid - 5]), 1e-3F);
}

TEST(SetNote, MovesTheNotesOfAKeyOfAChannel) {
  const std::vector<Event> notes = {on(0, 2, 60), on(0, 2, 67), on(0, 3, 60)};
  std::vector<Event> events = notes;
  events.push_back(say_of_key(kSaid, 2, 60, kSlotAmp, -200));
  const Sound rest =
      sum(rendered(kPlain, {notes[1]}, kFrames), rendered(kPlain, {notes[2]}, kFrames));
  expect_near(rendered(kPlain, events, kFrames), rest, kSaid + kGlide);
  events.back().midi.bytes[1] = Event::kEveryKey;
  expect_near(rendered(kPlain, events, kFrames), rendered(kPlain, {notes[2]}, kFrames),
              kSaid + kGlide);
  events.back().every_channel = true;
  EXPECT_LT(peak(rendered(kPlain, events, kFrames).left, kSaid + kGlide), 1e-7);
}

TEST(SetNote, HoldsFromTheFirstSampleWhereTheNoteBeginsWithIt) {
  const Sound at_once =
      rendered(kPlain, {on(0, 0, 60), say_of_key(0, 0, 60, kSlotPitch, 9)}, kFrames);
  const Sound higher = rendered(kPlain, {on(0, 0, 69)}, kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) ASSERT_EQ(at_once.left[i], higher.left[i]) << i;
}

TEST(SetNote, EndsWithItsNote) {
  const Sound next = rendered(
      kPlain,
      {on(0, 0, 60), say_of_key(100, 0, 60, kSlotAmp, -30), off(4800, 0, 60), on(14400, 0, 60)},
      kFrames);
  const Sound plain = rendered(kPlain, {on(0, 0, 60), off(4800, 0, 60), on(14400, 0, 60)}, kFrames);
  EXPECT_EQ(peak(next.left, 16000), peak(plain.left, 16000));
}

TEST(SetNote, ModulationAndExpressionOfOneSlotAddUp) {
  Event bend = say_of_key(0, 0, 60, kSlotPitch, 4);
  bend.is_expression = true;
  const Sound set =
      rendered(kPlain, {on(0, 0, 60), say_of_key(0, 0, 60, kSlotPitch, 5), bend}, kFrames);
  EXPECT_NEAR(frequency_hz(set.left, 2400, kFrames), 440, 0.01);
}

TEST(SetNote, GivesANoteItsOwnPressureAndTimbre) {
  constexpr std::string_view kSources = R"(
[[maps]]
from = "timbre"
to = "amp"
depth = -12
[[maps]]
from = "pressure"
to = "amp"
depth = -6
)";
  const std::string patch = std::string(kPlain) + std::string(kSources);
  const auto level = [&](std::vector<Event> events) {
    events.insert(events.begin(), on(0, 0, 60));
    return dbfs(peak(rendered(patch, events, kFrames).left, 18000));
  };
  const double plain = level({say_of_key(9, 0, 60, Event::kNoteTimbre, 0)});
  EXPECT_NEAR(level({say_of_key(9, 0, 60, Event::kNoteTimbre, 1)}) - plain, -12, 0.01);
  EXPECT_NEAR(level({say_of_key(9, 0, 60, Event::kNotePressure, 0.5)}) - level({}), -3, 0.01);
  EXPECT_NEAR(level({control(5, 0, 74, 127), say_of_key(9, 0, 60, Event::kNoteTimbre, 0)}) - plain,
              0, 0.01);
  const double untold = level({});
  EXPECT_EQ(level({say_of_key(9, 0, 61, Event::kNoteTimbre, 1)}), untold);
  EXPECT_EQ(level({say_of_key(9, 0, 60, Event::kNotePressure, std::nan(""))}), untold);
  EXPECT_NEAR(level({say_of_key(9, 0, 60, Event::kNotePressure, 1e300)}) - untold, -6, 0.01);
}

TEST(SetNote, RefusesSlotsThatAreNotThere) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  play(*engine,
       {on(0, 0, 60), say_of_key(5, 0, 60, kSlotCount, 1),
        say_of_key(5, 0, 60, Event::kEverySlot, 1)},
       100, 100);
  EXPECT_EQ(engine->counters().events_unknown, 2);
}

TEST(SetNote, HasRoomForSixteenSlotsOfANoteAndCountsWhatIsMore) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  std::vector<Event> events{on(0, 0, 60)};
  for (int i = 0; i < 20; ++i) events.push_back(say_of_key(5, 0, 60, i, 0.25));
  play(*engine, events, 100, 100);
  EXPECT_EQ(engine->counters().events_unknown, 4);
}

TEST(SetNote, ANoteOffOfANumberEndsThatNote) {
  const Event first = numbered(on(0, 0, 60), 5), second = numbered(on(0, 0, 60, 50), 6);
  const std::vector<Event> events = {first, second, numbered(off(kSaid, 0, 60), 6)};
  const Sound both = rendered(kPlain, events, 96000);
  const Sound alone = rendered(kPlain, {first}, 96000);
  expect_near(both, alone, 90000);
  // One without a number ends the oldest, a number that nobody has only notes without one.
  const Sound other = rendered(kPlain, {first, second, off(kSaid, 0, 60)}, 96000);
  expect_near(other, rendered(kPlain, {second}, 96000), 90000);
  const Sound none = rendered(kPlain, {first, numbered(off(kSaid, 0, 60), 99)}, 96000);
  expect_near(none, alone);
  const Sound plain = rendered(kPlain, {on(0, 0, 60), numbered(off(kSaid, 0, 60), 99)}, 96000);
  EXPECT_LT(peak(plain.left, 90000), 1e-6);
}

TEST(SetNote, TellsOnceWhenANumberedNoteIsHeardNoMore) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank, {.max_voices = 2});
  std::vector<float> left(4800), right(4800);
  const auto ended = [&](std::vector<Event> events) {
    std::vector<std::int32_t> all;
    engine->process(events, left, right);
    for (int i = 0; i < 40; ++i) {
      for (const EndedNote& note : engine->ended_notes()) all.push_back(note.note);
      engine->process({}, left, right);
    }
    return all;
  };
  EXPECT_TRUE(ended({numbered(on(0, 0, 60), 7), numbered(on(0, 0, 64), 8)}).empty());
  const auto at = [&](Event event) {
    event.midi.time.sample = engine->now();
    return event;
  };
  EXPECT_EQ(ended({at(numbered(off(0, 0, 60), 7))}), std::vector<std::int32_t>{7});
  // A third voice steals one.
  EXPECT_TRUE(ended({at(numbered(on(0, 0, 62), 9))}).empty());
  EXPECT_EQ(ended({at(numbered(on(0, 0, 65), 10))}), std::vector<std::int32_t>{8});
}

TEST(SetNote, FollowsANoteToANewBank) {
  const auto bank = bank_from(kPlain), other = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  Event install = of_kind(6000, Event::Kind::install_bank);
  install.bank = other.get();
  const Sound set = play(*engine,
                         {numbered(on(0, 0, 60), 3), say(3000, 3, kSlotAmp, -20), install,
                          say(18000, 3, kSlotAmp, -200)},
                         kFrames, 256);
  const Sound plain = rendered(kPlain, {on(0, 0, 60)}, kFrames);
  EXPECT_NEAR(peak(set.left, 12000, 18000) / peak(plain.left, 12000, 18000), 0.1, 0.01);
  EXPECT_LT(peak(set.left, 18000 + kGlide + 5), 1e-7);
  EXPECT_TRUE(engine->ended_notes().empty());
}

TEST(SetNote, AMonoVoiceGoesOnWithoutWhatWasSaidOfTheNoteBefore) {
  const std::string mono = with(kPlain, "mode = \"mono\"");
  const auto bank = bank_from(mono);
  const auto engine = engine_for(*bank);
  const Sound set = play(*engine,
                         {numbered(on(0, 0, 60), 3), say(3000, 3, kSlotPitch, 12),
                          numbered(on(9000, 0, 69), 4), numbered(off(9000, 0, 60), 3)},
                         kFrames, 64);
  EXPECT_NEAR(frequency_hz(set.left, 12000, kFrames), 440, 0.05);
}

}  // namespace
}  // namespace knotwave::engine

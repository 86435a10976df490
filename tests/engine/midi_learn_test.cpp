// SPDX-License-Identifier: MIT
#include "knotwave/engine/midi_learn.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "support/allocation_count.h"
#include "support/broken.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using PickUp = MidiLearn::PickUp;

struct Change {
  int channel, controller, value;
  friend bool operator==(const Change&, const Change&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Change& change) {
    return out << "{" << change.channel << ", " << change.controller << ", " << change.value << "}";
  }
};

base::MidiEvent event_of(int status, int data1, int data2) {
  base::MidiEvent event;
  event.time = {77, 5};
  event.port = 3;
  event.bytes[0] = static_cast<std::uint8_t>(status);
  event.bytes[1] = static_cast<std::uint8_t>(data1);
  event.bytes[2] = static_cast<std::uint8_t>(data2);
  return event;
}

/// What a control change becomes; its time and port must stay.
std::vector<Change> turn(MidiLearn& learn, int channel, int controller, int value) {
  const auto out = learn.translate(event_of(0xB0 | channel, controller, value));
  std::vector<Change> changes;
  for (int i = 0; i < out.count; ++i) {
    const base::MidiEvent& event = out.messages[static_cast<std::size_t>(i)];
    EXPECT_EQ(event.status(), base::MidiStatus::control_change);
    EXPECT_EQ(event.time, (base::SampleTime{77, 5}));
    EXPECT_EQ(event.port, 3);
    changes.push_back({event.channel(), event.bytes[1], event.bytes[2]});
  }
  return changes;
}

MidiLearn with(std::vector<LearnedKnob> knobs) {
  auto learn = MidiLearn::create({"", std::move(knobs)});
  EXPECT_TRUE(learn.has_value());
  return *learn;
}

TEST(MidiLearn, WhatWasNotLearntGoesThroughAsItIs) {
  MidiLearn learn = with({{.from = 21, .to = 74}});
  for (int status = 0x80; status <= 0xFF; ++status) {
    if (status >= 0xB0 && status <= 0xBF) continue;
    const auto out = learn.translate(event_of(status, 21, 5));
    ASSERT_EQ(out.count, 1);
    EXPECT_EQ(out.messages[0].bytes[0], status);
    EXPECT_EQ(out.messages[0].bytes[1], 21);
    EXPECT_EQ(out.messages[0].bytes[2], 5);
  }
  for (int controller = 0; controller < 128; ++controller) {
    if (controller == 21 || controller == 53) continue;  // the knob and its fine half
    EXPECT_THAT(turn(learn, 2, controller, 9), ElementsAre(Change{2, controller, 9}));
  }
}

TEST(MidiLearn, AKnobStandsForAControllerOnItsChannelOrAnother) {
  MidiLearn learn =
      with({{.from = 21, .to = 74}, {.from_channel = 5, .from = 22, .to_channel = 1, .to = 71}});
  EXPECT_THAT(turn(learn, 2, 21, 50), ElementsAre(Change{2, 74, 50}));
  EXPECT_THAT(turn(learn, 4, 22, 51), ElementsAre(Change{0, 71, 51}));
  EXPECT_THAT(turn(learn, 3, 22, 52), ElementsAre(Change{3, 22, 52}));  // another channel's
}

TEST(MidiLearn, TheKnobOfAChannelGoesBeforeTheOneOfAny) {
  MidiLearn learn = with({{.from = 21, .to = 74}, {.from_channel = 3, .from = 21, .to = 71}});
  EXPECT_THAT(turn(learn, 2, 21, 50), ElementsAre(Change{2, 71, 50}));
  EXPECT_THAT(turn(learn, 1, 21, 50), ElementsAre(Change{1, 74, 50}));
}

TEST(MidiLearn, PairsOf14BitsStayPairs) {
  MidiLearn learn = with({{.from = 3, .to = 16},
                          {.from = 4, .to = 74},
                          {.from = 41, .to = 75},
                          {.from = 9, .to = 17}});
  EXPECT_THAT(turn(learn, 0, 3, 50), ElementsAre(Change{0, 16, 50}));
  EXPECT_THAT(turn(learn, 0, 35, 7), ElementsAre(Change{0, 48, 7}));
  EXPECT_EQ(learn.knob(0).in_force, 50 * 128 + 7);
  EXPECT_THAT(turn(learn, 0, 4, 60), ElementsAre(Change{0, 74, 60}));
  EXPECT_THAT(turn(learn, 0, 36, 7), ElementsAre());  // 74 has no fine half
  EXPECT_THAT(turn(learn, 0, 9, 60), ElementsAre(Change{0, 17, 60}));
  EXPECT_THAT(turn(learn, 0, 41, 7), ElementsAre(Change{0, 75, 7}));  // learnt itself
}

TEST(MidiLearn, AKnobThatJumpedAwayIsLeftOutUntilItMeetsTheValue) {
  MidiLearn learn = with({{.from = 21, .to = 74}});
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::unknown);
  EXPECT_THAT(turn(learn, 0, 21, 20), ElementsAre(Change{0, 74, 20}));
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::held);
  learn.set_in_force(0, 74, 100 * 128);
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::too_low);
  EXPECT_EQ(learn.knob(0).in_force, 100 * 128);
  EXPECT_THAT(turn(learn, 0, 21, 30), ElementsAre());
  EXPECT_THAT(turn(learn, 0, 21, 98), ElementsAre());
  EXPECT_THAT(turn(learn, 0, 21, 99), ElementsAre(Change{0, 74, 99}));  // a step away
  EXPECT_THAT(turn(learn, 0, 21, 60), ElementsAre(Change{0, 74, 60}));
  learn.set_in_force(0, 74, 10 * 128);
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::too_high);
  EXPECT_THAT(turn(learn, 0, 21, 40), ElementsAre());
  EXPECT_THAT(turn(learn, 0, 21, 2), ElementsAre(Change{0, 74, 2}));  // it crossed it
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::held);
}

TEST(MidiLearn, AMessageForTheControllerItselfMakesTheKnobMeetItAnew) {
  MidiLearn learn = with({{.from = 21, .to = 74}});
  turn(learn, 0, 21, 20);
  EXPECT_THAT(turn(learn, 0, 74, 90), ElementsAre(Change{0, 74, 90}));
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::too_low);
  EXPECT_THAT(turn(learn, 0, 21, 21), ElementsAre());
  EXPECT_THAT(turn(learn, 1, 74, 3), ElementsAre(Change{1, 74, 3}));
}

TEST(MidiLearn, AKnobThatJumpsAlwaysSpeaks) {
  MidiLearn learn = with({{.from = 21, .to = 74, .is_soft = false}});
  turn(learn, 0, 21, 20);
  learn.set_in_force(0, 74, 100 * 128);
  EXPECT_THAT(turn(learn, 0, 21, 30), ElementsAre(Change{0, 74, 30}));
}

TEST(MidiLearn, AKnobMayBeHeldByItsFineHalf) {
  MidiLearn learn = with({{.from = 3, .to = 16}});
  turn(learn, 0, 3, 10);
  learn.set_in_force(0, 16, 20 * 128 + 127);
  EXPECT_THAT(turn(learn, 0, 3, 19), ElementsAre());
  EXPECT_THAT(turn(learn, 0, 35, 127), ElementsAre(Change{0, 16, 19}, Change{0, 48, 127}));
}

TEST(MidiLearn, ControllersThatGoBackHaveToBeMet) {
  MidiLearn learn = with({{.from = 21, .to = 11}, {.from = 22, .to = 74}, {.from = 23, .to = 75}});
  turn(learn, 0, 21, 20);
  turn(learn, 0, 22, 20);
  learn.translate(event_of(0xB0, 121, 0));
  EXPECT_EQ(learn.knob(0).pick_up, PickUp::too_low);  // expression is full again
  EXPECT_EQ(learn.knob(1).pick_up, PickUp::held);     // sound controllers stay
  learn.controllers_went_back();
  EXPECT_EQ(learn.knob(1).in_force, 64 * 128);
  EXPECT_EQ(learn.knob(1).pick_up, PickUp::too_low);
  EXPECT_THAT(turn(learn, 0, 23, 90), ElementsAre(Change{0, 75, 90}));  // never heard: unknown
}

TEST(MidiLearn, TheNextControllerThatMovesIsLearnt) {
  MidiLearn learn = with({});
  EXPECT_TRUE(learn.learn(74));
  EXPECT_TRUE(learn.is_learning());
  EXPECT_THAT(turn(learn, 0, 20, 64), ElementsAre());
  EXPECT_THAT(turn(learn, 0, 20, 64), ElementsAre());                     // it repeats itself
  EXPECT_THAT(turn(learn, 0, 64, 127), ElementsAre(Change{0, 64, 127}));  // a pedal
  EXPECT_THAT(turn(learn, 0, 64, 0), ElementsAre(Change{0, 64, 0}));
  EXPECT_THAT(turn(learn, 2, 21, 30), ElementsAre());
  EXPECT_TRUE(learn.is_learning());
  EXPECT_THAT(turn(learn, 2, 21, 31), ElementsAre());
  EXPECT_FALSE(learn.is_learning());
  EXPECT_TRUE(learn.has_changed());
  EXPECT_THAT(learn.spec().knobs,
              ElementsAre(LearnedKnob{.from_channel = 3, .from = 21, .to = 74}));
  EXPECT_FALSE(learn.has_changed());
  EXPECT_THAT(turn(learn, 2, 21, 32), ElementsAre(Change{2, 74, 32}));
}

TEST(MidiLearn, AKnobIsLearntWithItsFineHalf) {
  MidiLearn learn = with({});
  learn.learn(16);
  for (const int fine : {1, 2}) {
    turn(learn, 0, 3, 40);
    turn(learn, 0, 35, fine);
  }
  EXPECT_THAT(learn.spec().knobs, ElementsAre(LearnedKnob{.from_channel = 1, .from = 3, .to = 16}));
}

TEST(MidiLearn, LearningAnewForgetsWhatTheKnobAndTheControllerHadBefore) {
  MidiLearn learn = with({{.from = 21, .to = 74}, {.from = 22, .to = 71}, {.from = 23, .to = 72}});
  learn.learn(71);
  turn(learn, 0, 21, 1);
  turn(learn, 0, 21, 2);
  EXPECT_THAT(learn.spec().knobs,
              ElementsAre(LearnedKnob{.from = 23, .to = 72},
                          LearnedKnob{.from_channel = 1, .from = 21, .to = 71}));
  EXPECT_TRUE(learn.forget(72));
  EXPECT_FALSE(learn.forget(72));
  EXPECT_EQ(learn.size(), 1);
}

TEST(MidiLearn, LearningCanBeCancelledAndIsRefusedForWhatNoKnobCanBe) {
  MidiLearn learn = with({});
  for (const int controller : {-1, 0, 6, 32, 38, 96, 98, 101, 120, 123, 127, 128}) {
    EXPECT_FALSE(learn.learn(controller)) << controller;
  }
  EXPECT_FALSE(learn.learn(74, 17));
  EXPECT_TRUE(learn.learn(74, 16));
  learn.cancel();
  EXPECT_THAT(turn(learn, 0, 21, 1), ElementsAre(Change{0, 21, 1}));
  EXPECT_THAT(turn(learn, 0, 21, 2), ElementsAre(Change{0, 21, 2}));
  std::vector<LearnedKnob> many;
  for (int i = 0; i < kMaxLearnedKnobs; ++i) {
    many.push_back({.from_channel = 1 + i % 16,
                    .from = 70 + i / 16,
                    .to_channel = 1 + i % 16,
                    .to = 102 + i / 16});
  }
  EXPECT_FALSE(with(many).learn(74));
}

class Random {
 public:
  explicit Random(std::uint32_t purpose) : stream_{support::test_seed(), 0, purpose} {}
  int below(int n) { return static_cast<int>(stream_.bits(next_++) % static_cast<unsigned>(n)); }

 private:
  base::RandomStream stream_;
  std::uint64_t next_ = 0;
};

TEST(MidiLearn, TheValueInForceMovesByItsOwnMessagesOrByAKnobThatMetIt) {
  Random random(1);
  for (int trial = 0; trial < support::test_count(300); ++trial) {
    MidiLearn learn = with({{.from = 21, .to = 74}});
    int in_force = -1, before = -1;
    bool is_held = false;
    for (int i = 0; i < 300; ++i) {
      const int value = random.below(3) == 0 || before < 0
                            ? random.below(128)
                            : std::clamp(before + random.below(9) - 4, 0, 127);
      if (random.below(10) == 0) {  // from elsewhere
        EXPECT_THAT(turn(learn, 0, 74, value), ElementsAre(Change{0, 74, value}));
        in_force = value;
        is_held = before >= 0 && std::abs(before - value) <= 1;
        continue;
      }
      // The rule once more, in words of its own: the way of the knob covers the value or ends
      // beside it.
      const int low = std::min(before, value), high = std::max(before, value);
      const bool meets = in_force < 0 || std::abs(value - in_force) <= 1 ||
                         (before >= 0 && low <= in_force && in_force <= high);
      const auto out = turn(learn, 0, 21, value);
      if (is_held || meets) {
        ASSERT_THAT(out, ElementsAre(Change{0, 74, value})) << "trial " << trial << ", " << i;
        in_force = value;
        is_held = true;
        ASSERT_EQ(learn.knob(0).pick_up, PickUp::held);
      } else {
        ASSERT_THAT(out, ElementsAre()) << "trial " << trial << ", " << i;
        ASSERT_EQ(learn.knob(0).pick_up, value < in_force ? PickUp::too_low : PickUp::too_high);
      }
      before = value;
      ASSERT_EQ(learn.knob(0).position, value * 128);
    }
  }
}

LearnSpec random_spec(Random& random) {
  LearnSpec spec;
  constexpr const char* kAbouts[] = {"", "my desk", "a \"b\" \\ c\t\x01\x7F", "Klangkörper"};
  spec.about = kAbouts[random.below(4)];
  const int count = random.below(40);
  for (int i = 0; i < count; ++i) {
    const LearnedKnob knob = {random.below(17), random.below(120), random.below(17),
                              random.below(120), random.below(2) == 0};
    spec.knobs.push_back(knob);
    if (!MidiLearn::create(spec)) spec.knobs.pop_back();
  }
  return spec;
}

TEST(MidiLearn, WhatIsWrittenReadsBack) {
  Random random(2);
  for (int trial = 0; trial < support::test_count(500); ++trial) {
    const LearnSpec spec = random_spec(random);
    const std::string text = write_midi_learn(spec);
    const auto again = parse_midi_learn(text, "again.toml");
    ASSERT_TRUE(again.has_value()) << again.error().to_string() << "\n" << text;
    ASSERT_EQ(*again, spec) << text;
    ASSERT_EQ(write_midi_learn(*again), text);
  }
}

TEST(MidiLearn, AnyMessagesGiveWholeOnesAndAllocateNothing) {
  Random random(3);
  for (int trial = 0; trial < support::test_count(100); ++trial) {
    MidiLearn learn = with(random_spec(random).knobs);
    for (int i = 0; i < 500; ++i) {
      const auto event =
          event_of(random.below(3) > 0 ? 0xB0 | random.below(16) : 0x80 + random.below(128),
                   random.below(256), random.below(256));
      MidiLearn::Out out;
      const auto allocations = support::allocations_in([&] {
        if (random.below(50) == 0) learn.learn(random.below(130), random.below(18));
        if (random.below(90) == 0) learn.controllers_went_back();
        if (random.below(20) == 0) {
          learn.set_in_force(random.below(18) - 1, random.below(130), random.below(20000) - 100);
        }
        out = learn.translate(event);
      });
      ASSERT_EQ(allocations, 0);
      ASSERT_GE(out.count, 0);
      ASSERT_LE(out.count, 2);
      for (int k = 0; k < out.count; ++k)
        ASSERT_GE(out.messages[static_cast<std::size_t>(k)].bytes[0], 0x80);
    }
    ASSERT_TRUE(MidiLearn::create(learn.spec()).has_value());
  }
}

TEST(MidiLearnFile, IsReadWithAllItsKeys) {
  const auto spec = parse_midi_learn(R"(format = 1
kind = "midi-learn"
about = "the desk"

[[knobs]]
from = 21
to = 74

[[knobs]]
from = 22
from_channel = 16
to = 1
to_channel = 2
takeover = "jump"
)",
                                     "desk.toml");
  ASSERT_TRUE(spec.has_value()) << spec.error().to_string();
  EXPECT_EQ(spec->about, "the desk");
  EXPECT_THAT(spec->knobs,
              ElementsAre(LearnedKnob{.from = 21, .to = 74}, LearnedKnob{16, 22, 2, 1, false}));
  EXPECT_TRUE(parse_midi_learn("format = 1\nkind = \"midi-learn\"\n", "empty.toml").has_value());
}

TEST(MidiLearnFile, EveryBrokenOneIsRefusedWithItsPlace) {
  const auto files = support::broken_files("learn_");
  EXPECT_GE(files.size(), 8u);
  for (const auto& file : files) {
    const auto spec = read_midi_learn(file.path);
    ASSERT_FALSE(spec.has_value()) << file.name;
    EXPECT_EQ(to_string(spec.error().code), file.code) << file.name;
    EXPECT_EQ(support::broken_report(file, spec.error()), file.report);
  }
}

TEST(MidiLearnFile, TooManyKnobsAreRefused) {
  std::string text = "format = 1\nkind = \"midi-learn\"\n";
  for (int i = 0; i <= kMaxLearnedKnobs; ++i) text += "[[knobs]]\nfrom = 21\nto = 74\n";
  const auto spec = parse_midi_learn(text, "many.toml");
  ASSERT_FALSE(spec.has_value());
  EXPECT_THAT(spec.error().to_string(), HasSubstr("there are 129 knobs; 128 are the most"));
}

}  // namespace
}  // namespace knotwave::engine

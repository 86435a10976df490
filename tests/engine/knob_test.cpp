// SPDX-License-Identifier: MIT
// MIDI values, what a knob did, and its way.
#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/engine/knob_line.h"
#include "knotwave/engine/knob_recorder.h"

#include "support/seed.h"

namespace knotwave::engine {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::uint8_t[3];

base::MidiEvent event_at(std::int64_t sample, int status, int one, int two, int port = 0) {
  base::MidiEvent event;
  event.time = {sample, 0};
  event.bytes[0] = static_cast<std::uint8_t>(status);
  event.bytes[1] = static_cast<std::uint8_t>(one);
  event.bytes[2] = static_cast<std::uint8_t>(two);
  event.port = static_cast<std::uint8_t>(port);
  return event;
}

TEST(MidiValue, IsCalledAsInPatches) {
  EXPECT_EQ(*parse_midi_value("cc1"), (MidiValueSpec{OutputKind::control, 1, 7}));
  EXPECT_EQ(*parse_midi_value("cc1", 14), (MidiValueSpec{OutputKind::control, 1, 14}));
  EXPECT_EQ(*parse_midi_value("nrpn200", 14), (MidiValueSpec{OutputKind::nrpn, 200, 14}));
  EXPECT_EQ(*parse_midi_value("bend"), (MidiValueSpec{OutputKind::pitch_bend, 0, 14}));
  EXPECT_EQ(*parse_midi_value("pressure"), (MidiValueSpec{OutputKind::channel_pressure, 0, 7}));
  EXPECT_THAT(parse_midi_value("cc120").error().message, HasSubstr("cc0 to cc119"));
  EXPECT_THAT(parse_midi_value("cc64", 14).error().message, HasSubstr("cc64 has 7 bits"));
  EXPECT_THAT(parse_midi_value("bend", 7).error().message, HasSubstr("bend has 14 bits"));
  EXPECT_THAT(parse_midi_value("aftertouch").error().message, HasSubstr("'pressure'"));
  EXPECT_THAT(midi_value_text(*parse_midi_value("cc1", 14)), "cc1 (14 bit)");
}

TEST(MidiValue, TakesHalvesAsTheMidiSpecificationSays) {
  MidiValue value({OutputKind::control, 1, 14});
  EXPECT_TRUE(value.hear(Bytes{0xB0, 33, 5}));
  EXPECT_EQ(value.step(), 5);
  EXPECT_FALSE(value.completes());
  EXPECT_TRUE(value.hear(Bytes{0xB0, 1, 64}));
  EXPECT_EQ(value.step(), 64 << 7);
  EXPECT_TRUE(value.hear(Bytes{0xB0, 33, 7}));
  EXPECT_EQ(value.step(), 64 << 7 | 7);
  EXPECT_TRUE(value.completes());
  EXPECT_TRUE(value.hear(Bytes{0xB0, 33, 8}));
  EXPECT_FALSE(value.completes());
  EXPECT_FALSE(value.hear(Bytes{0xB0, 2, 8}));
  EXPECT_FALSE(value.hear(Bytes{0xE0, 2, 8}));
}

TEST(MidiValue, OfAParameterIsToldWhileItIsSelected) {
  MidiValue value({OutputKind::nrpn, 130, 14});
  EXPECT_FALSE(value.hear(Bytes{0xB0, 6, 1}));
  value.hear(Bytes{0xB0, 99, 1});
  value.hear(Bytes{0xB0, 98, 2});
  EXPECT_TRUE(value.hear(Bytes{0xB0, 6, 1}));
  EXPECT_TRUE(value.hear(Bytes{0xB0, 38, 9}));
  EXPECT_EQ(value.step(), 137);
  value.hear(Bytes{0xB0, 98, 3});
  EXPECT_FALSE(value.hear(Bytes{0xB0, 6, 1}));
  value.hear(Bytes{0xB0, 98, 2});
  value.hear(Bytes{0xB0, 101, 127});
  EXPECT_FALSE(value.hear(Bytes{0xB0, 6, 1}));
}

TEST(KnobRecorder, KeepsChangesOfTheFirstChannelAndPort) {
  KnobRecorder recorder({OutputKind::control, 1, 7});
  recorder.hear(event_at(10, 0xB2, 7, 1));
  EXPECT_EQ(recorder.channel(), 0);
  for (const auto& [sample, value] : {std::pair(20, 5), {30, 5}, {40, 6}, {50, 7}, {50, 8}}) {
    recorder.hear(event_at(sample, 0xB2, 1, value));
  }
  recorder.hear(event_at(60, 0xB3, 1, 90));
  recorder.hear(event_at(60, 0xB2, 1, 90, 1));
  EXPECT_EQ(recorder.channel(), 3);
  EXPECT_EQ(recorder.heard(), 5);
  EXPECT_EQ(recorder.elsewhere(), 2);
  EXPECT_THAT(recorder.moves(),
              ElementsAre(KnobMove{{20, 0}, {30, 0}, 5}, KnobMove{{40, 0}, {40, 0}, 6},
                          KnobMove{{50, 0}, {50, 0}, 8}));
}

TEST(KnobRecorder, TakesBothHalvesOfAValueForOne) {
  KnobRecorder recorder({OutputKind::control, 1, 14});
  recorder.hear(event_at(100, 0xB0, 1, 64));
  recorder.hear(event_at(130, 0xB0, 33, 3));
  recorder.hear(event_at(200, 0xB0, 1, 65));
  recorder.hear(event_at(230, 0xB0, 33, 4));
  recorder.hear(event_at(260, 0xB0, 33, 5));  // by itself
  recorder.hear(event_at(300, 0xB0, 1, 66));
  recorder.hear(event_at(300 + 481, 0xB0, 33, 6));  // too late
  const auto step = [](int high, int low) { return high << 7 | low; };
  EXPECT_THAT(recorder.moves(), ElementsAre(KnobMove{{130, 0}, {130, 0}, step(64, 3)},
                                            KnobMove{{230, 0}, {230, 0}, step(65, 4)},
                                            KnobMove{{260, 0}, {260, 0}, step(65, 5)},
                                            KnobMove{{300, 0}, {300, 0}, step(66, 0)},
                                            KnobMove{{781, 0}, {781, 0}, step(66, 6)}));
}

TEST(KnobRecorder, OfTooManyMovesCountsWhatItLeavesOut) {
  KnobRecorder recorder({OutputKind::pitch_bend, 0, 14});
  const auto most = static_cast<std::int64_t>(kMostKnobMoves);
  for (std::int64_t i = 0; i < most + 7; ++i) {
    recorder.hear(event_at(i, 0xE0, static_cast<int>(i & 127), 64));
  }
  EXPECT_EQ(recorder.moves().size(), kMostKnobMoves);
  EXPECT_EQ(recorder.dropped(), 7);
}

double line_at(const TimedLine& line, double time) {
  const auto next = std::upper_bound(line.times.begin(), line.times.end(), time);
  const auto i = static_cast<std::size_t>(next - line.times.begin());
  if (i == 0) return line.values.front();
  if (i == line.times.size()) return line.values.back();
  const double along = (time - line.times[i - 1]) / (line.times[i] - line.times[i - 1]);
  return line.values[i - 1] + along * (line.values[i] - line.values[i - 1]);
}

/// Each told once.
std::vector<TimedStep> told(std::initializer_list<std::pair<double, int>> all) {
  std::vector<TimedStep> steps;
  for (const auto& [time, step] : all) steps.push_back({time, time, step});
  return steps;
}

TEST(KnobLine, OfASlowTurnIsStraightThroughTheMiddlesBetweenSteps) {
  const auto line = knob_line(told({{1, 10}, {2, 11}, {3, 12}, {4, 13}}), {});
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(line->times, ElementsAre(1.95, 2, 3, 4, 4.05));
  EXPECT_THAT(line->values, ElementsAre(10, 10.5, 11.5, 12.5, 13));
}

TEST(KnobLine, OfAButtonWaitsAndThenComesInTime) {
  const auto line = knob_line(told({{0, 0}, {2, 127}, {2.01, 0}}), {.begin = 0, .end = 3});
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(line->times, ElementsAre(0, 1.95, 2, 2.01, 3));
  EXPECT_THAT(line->values, ElementsAre(0, 0, 127, 0, 0));
}

TEST(KnobLine, StaysAsLongAsTheValueIsToldAgain) {
  const std::vector<TimedStep> steps = {{1, 1.99, 0}, {2, 2, 127}};
  const auto line = knob_line(steps, {.begin = 0});
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(line->times, ElementsAre(0, 1.99, 2));
  EXPECT_THAT(line->values, ElementsAre(0, 0, 127));
}

TEST(KnobLine, ReachesTheStopsOfTheKnob) {
  const auto line = knob_line(told({{0, 125}, {0.01, 126}, {0.02, 127}, {0.03, 126}}), {});
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(*std::max_element(line->values.begin(), line->values.end()), 127);
}

TEST(KnobLine, NeedsAMove) {
  EXPECT_FALSE(knob_line(told({{1, 10}}), {}).has_value());
  EXPECT_FALSE(knob_line({}, {.begin = 0, .end = 1}).has_value());
  const auto line = knob_line(told({{1, 10}}), {.begin = 0, .end = 3});
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(line->times, ElementsAre(0, 1, 3));
  EXPECT_THAT(line->values, ElementsAre(10, 10, 10));
}

/// A knob turned, jumping and at rest; some values are told again.
std::vector<TimedStep> random_steps(std::mt19937_64& random) {
  const auto whole = [&random](int low, int high) {
    return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<TimedStep> steps = {{0, 0, whole(0, 127)}};
  for (int i = 0, count = whole(1, 60); i < count; ++i) {
    const int size = whole(0, 3) == 0 ? whole(2, 40) : 1;
    const int to = std::clamp(steps.back().step + (whole(0, 1) == 0 ? size : -size), 0, 127);
    const double time = steps.back().last_told + whole(1, 200) * 1e-3;
    if (to == steps.back().step) {
      steps.back().last_told = time;
    } else {
      steps.push_back({time, time, to});
    }
  }
  return steps;
}

TEST(KnobLine, IsWithinHalfAStepOfWhatWasToldButOnRamps) {
  std::mt19937_64 random(support::test_seed());
  for (int run = 0; run < support::test_count(300); ++run) {
    const KnobLineConfig config{.ramp = 0.001 + static_cast<double>(random() % 100) * 1e-3};
    const std::vector<TimedStep> steps = random_steps(random);
    if (steps.size() < 2) continue;
    const auto line = knob_line(steps, config);
    ASSERT_TRUE(line.has_value());
    EXPECT_EQ(line->values.front(), steps.front().step);
    EXPECT_EQ(line->values.back(), steps.back().step);
    const auto same =
        std::adjacent_find(line->times.begin(), line->times.end(), std::greater_equal<>());
    EXPECT_EQ(same, line->times.end());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      double until = steps[i].last_told;
      if (i + 1 < steps.size()) {
        const bool is_jump = std::abs(steps[i + 1].step - steps[i].step) > 1;
        until = std::max(until, steps[i + 1].time - (is_jump ? config.ramp : 1e-9));
      }
      for (double time = steps[i].time; time <= until; time += 1e-3) {
        EXPECT_LE(std::abs(line_at(*line, time) - steps[i].step), 0.5 + 1e-9);
      }
      EXPECT_LE(std::abs(line_at(*line, until) - steps[i].step), 0.5 + 1e-9);
    }
  }
}

}  // namespace
}  // namespace knotwave::engine

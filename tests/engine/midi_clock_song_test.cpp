// SPDX-License-Identifier: MIT
// Start, stop, continue and song position of a MIDI clock: where the song is told to be.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "clock_cable.h"
#include "tempo_clock.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

TEST(MidiClock, TheSongBeginsAtTheFirstClockBehindStart) {
  for (const double bpm : {40.0, 120.0, 250.0}) {
    Cable cable;
    cable.run(10, bpm);
    EXPECT_TRUE(cable.positions.empty());
    cable.send(cable.due_s - 0.5 / bpm, 0xFA);
    EXPECT_TRUE(cable.positions.empty());
    const double first_s = cable.due_s;
    cable.run(20, bpm);
    EXPECT_EQ(cable.positions, (std::vector<Cable::Position>{{first_s, 0}})) << bpm;
    EXPECT_EQ(cable.tempos.size(), 1u);
  }
}

TEST(MidiClock, ContinueGoesOnWhereTheSongStoppedOrWherePointed) {
  Cable cable;
  cable.run(2, 120);
  cable.send(2, 0xFA);
  cable.run(5, 120);
  cable.send(5, 0xFC);
  const std::int64_t stopped = cable.clock.status().position_clocks;
  cable.run(7, 120);
  cable.send(7, 0xF2, 1, 1);  // pointed twice, the last counts
  cable.send(7, 0xF2, 2, 1);
  cable.run(8, 120);
  ASSERT_EQ(cable.positions.size(), 1u);  // of start: a song that stands still is nowhere new
  cable.send(8, 0xFB);
  const double pointed_s = cable.due_s;
  cable.run(9, 120);
  cable.send(9, 0xFC);
  const std::int64_t again = cable.clock.status().position_clocks;
  EXPECT_NEAR(static_cast<double>(again), 6 * 130 + 48, 1);
  cable.run(10, 120);
  cable.send(10, 0xFB);
  const double continued_s = cable.due_s;
  cable.send(10, 0xFB);  // it runs: nothing new
  cable.run(11, 120);
  EXPECT_GT(stopped, 0);
  const std::vector<Cable::Position> expected = {
      cable.positions[0], {pointed_s, std::int64_t{780}}, {continued_s, again}};
  EXPECT_EQ(cable.positions, expected);
  cable.send(11, 0xF2, 4, 0);  // of a song that runs
  const double moved_s = cable.due_s;
  cable.run(12, 120);
  EXPECT_EQ(cable.positions.back(), (Cable::Position{moved_s, 24}));
  EXPECT_EQ(cable.positions.size(), 4u);
}

TEST(MidiClock, ASongThatBeginsBetweenTwoClocksOrInAPauseBeginsAtItsOwnFirstClock) {
  for (const double late : {0.1, 0.3, 0.5, 0.7, 0.9, 3.2, 10.0, 40.4}) {  // in clocks
    Cable cable;
    cable.run(10, 120);
    const double first_s = cable.due_s + (late - 1) / 48;
    cable.send(first_s, 0xFA);
    cable.due_s = first_s;
    const std::int64_t before = cable.sent;
    cable.run(20, 120);
    EXPECT_EQ(cable.positions, (std::vector<Cable::Position>{{first_s, 0}})) << late;
    EXPECT_EQ(cable.clock.status().position_clocks, cable.sent - before) << late;
    EXPECT_EQ(cable.clock.status().restarts, 0) << late;
    for (const Cable::Tempo& tempo : cable.tempos) EXPECT_NEAR(tempo.bpm, 120, 1.3) << late;
  }
}

TEST(MidiClock, WhereATempoHadToBeLearntThePositionIsToldWithIt) {
  Cable cable;
  cable.send(0.05, 0xFA);
  cable.run(3, 90);
  ASSERT_EQ(cable.positions.size(), 2u);
  EXPECT_EQ(cable.positions[0], (Cable::Position{0.1, 0}));
  ASSERT_EQ(cable.tempos.size(), 1u);
  EXPECT_EQ(cable.positions[1].time_s, cable.tempos[0].time_s);
  EXPECT_NEAR(static_cast<double>(cable.positions[1].clocks),
              (cable.positions[1].time_s - 0.1) * 36, 1e-9);
  cable.due_s += 1.5;  // a song that runs on without clocks is where the next one is
  const std::int64_t sent = cable.sent;
  const double after_s = cable.due_s;
  cable.run(8, 90);
  ASSERT_EQ(cable.positions.size(), 3u);
  EXPECT_EQ(cable.positions[2], (Cable::Position{after_s, sent}));
  cable.run(12, 180);  // a jump
  ASSERT_EQ(cable.positions.size(), 4u);
  EXPECT_EQ(cable.positions[3].time_s, cable.tempos.back().time_s);
}

TEST(MidiClock, ToldAgainItGivesTempoAndPositionAtTheNextClock) {
  Cable cable;
  cable.send(0.05, 0xFA);
  cable.run(5, 120);
  cable.positions.clear();
  cable.tempos.clear();
  cable.clock.tell_again();
  const double next_s = cable.due_s;
  const std::int64_t sent = cable.sent;
  cable.run(6, 120);
  EXPECT_EQ(cable.positions, (std::vector<Cable::Position>{{next_s, sent}}));
  ASSERT_EQ(cable.tempos.size(), 1u);
  EXPECT_EQ(cable.tempos[0].time_s, next_s);
}

/// Where an engine takes the song to be, of the tempos and positions it was told.
class Told {
 public:
  Told() { tempo_.reset(kRate); }
  void hear(const base::MidiEvent& event) {
    const auto news = clock.handle(event);
    if (news.tempo) {
      tempo_.set_tempo(event.time, clock.tempo_event().microseconds_per_quarter);
    }
    if (!news.position) return;
    tempo_.set_position(event.time, static_cast<double>(clock.position_event().song_clocks) / 24);
  }
  double clocks_at(double time_s) const { return 24 * tempo_.beats_at(at(time_s)); }

  MidiClock clock;

 private:
  TempoClock tempo_;
};

TEST(MidiClock, WithAMillisecondOfJitterTheEngineStaysWithinFourMillisecondsOfTheSong) {
  const base::RandomStream random{support::test_seed(), 3, 0};
  for (const double bpm : {60.0, 133.0, 180.0}) {
    Told told;
    told.clock.reset(kRate);
    double worst_s = 0;
    const double clock_s = 60 / (24 * bpm);
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(300 / clock_s); ++i) {
      const double due_s = 1 + static_cast<double>(i) * clock_s;
      base::MidiEvent event;
      if (i == 100) {
        event.time = at(due_s - clock_s / 2);
        event.bytes[0] = 0xFA;
        told.hear(event);
      }
      const double radius = std::sqrt(-2 * std::log(1 - random.unit(2 * i)));
      event.time =
          at(due_s + 1e-3 * radius * std::cos(2 * std::numbers::pi * random.unit(2 * i + 1)));
      event.bytes[0] = 0xF8;
      told.hear(event);
      if (i < 400) continue;
      const double error = told.clocks_at(due_s) - static_cast<double>(i - 100);
      worst_s = std::max(worst_s, std::abs(error) * clock_s);
    }
    EXPECT_LT(worst_s, 0.004) << bpm;
  }
}

}  // namespace
}  // namespace knotwave::engine

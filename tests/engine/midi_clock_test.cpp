// SPDX-License-Identifier: MIT
// MIDI clocks of a virtual cable: steady, unsteady, moving, broken off.
#include "knotwave/engine/midi_clock.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "clock_cable.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// Clocks that an engine playing `tempos` has gone through at a time, from the first on.
double clocks_played(const std::vector<Cable::Tempo>& tempos, double time_s) {
  double clocks = 0;
  for (std::size_t i = 0; i < tempos.size() && tempos[i].time_s < time_s; ++i) {
    const double end_s = i + 1 < tempos.size() ? std::min(tempos[i + 1].time_s, time_s) : time_s;
    clocks += (end_s - tempos[i].time_s) * 24 * tempos[i].bpm / 60;
  }
  return clocks;
}

TEST(MidiClock, ASteadyClockGivesItsTempoOnceAndNoJitter) {
  for (const double bpm : {20.0, 61.7, 120.0, 174.0, 300.0, 900.0}) {
    Cable cable;
    cable.run(20, bpm);
    ASSERT_EQ(cable.tempos.size(), 1u) << bpm;
    EXPECT_NEAR(cable.tempos[0].bpm / bpm, 1, 1e-5);  // microseconds are whole
    EXPECT_LT(cable.tempos[0].time_s, 0.1 + 14 * 60 / (24 * bpm));
    EXPECT_NEAR(cable.clock.status().bpm / bpm, 1, 1e-7);
    EXPECT_LT(cable.clock.status().jitter_ms, 1e-4);
    EXPECT_EQ(cable.clock.status().clocks, cable.sent);
  }
}

TEST(MidiClock, WithOneMillisecondOfJitterTheTempoStaysWithinFifteenHundredthsOfAPercent) {
  for (const double bpm : {60.0, 120.0, 180.0}) {
    Cable cable;
    double worst = 0, square = 0;
    int count = 0;
    cable.watch = [&](double time_s) {
      if (time_s < 4) return;
      const double error = cable.clock.status().bpm - bpm;
      worst = std::max(worst, std::abs(error));
      square += error * error;
      ++count;
    };
    cable.run(300, bpm, 1e-3);
    EXPECT_LT(worst / bpm, 1.5e-3) << bpm;
    EXPECT_LT(std::sqrt(square / count) / bpm, 3e-4) << bpm;
    EXPECT_NEAR(cable.clock.status().jitter_ms, 1, 0.25) << bpm;  // 96 values: 7 % rms
    EXPECT_EQ(cable.clock.status().missing, 0);
    EXPECT_EQ(cable.clock.status().surplus, 0);
    for (const Cable::Tempo& tempo : cable.tempos) {
      if (tempo.time_s < 6) continue;
      EXPECT_NEAR(tempo.bpm / bpm, 1, 0.006);
    }
    EXPECT_LE(cable.tempos.size(), 60u) << bpm;
  }
}

TEST(MidiClock, TheJitterIsRightOnAverage) {
  for (const double jitter_ms : {0.1, 0.5, 1.0, 2.0}) {
    Cable cable;
    double square = 0;
    int count = 0;
    cable.watch = [&](double time_s) {
      if (time_s < 8) return;
      const double told = cable.clock.status().jitter_ms;
      square += told * told;
      ++count;
    };
    cable.run(400, 120, jitter_ms * 1e-3);
    EXPECT_NEAR(std::sqrt(square / count) / jitter_ms, 1, 0.1) << jitter_ms;
  }
}

TEST(MidiClock, WhatWasHandedOutDoesNotRunAwayFromTheClock) {
  for (const double noise_s : {0.0, 1e-3}) {
    Cable cable;
    double first = -1, worst_ms = 0;
    cable.watch = [&](double time_s) {
      if (time_s < 5 || cable.tempos.empty()) return;
      const double ahead = clocks_played(cable.tempos, time_s) - static_cast<double>(cable.sent);
      if (first == -1) first = ahead;
      worst_ms = std::max(worst_ms, std::abs(ahead - first) * 60e3 / (24 * 120));
    };
    // Each step is too small to be told by itself, but 0.09 % are 50 ms a minute.
    cable.run(
        300, [](double time_s) { return 120 * (1 + 0.0009 * std::floor(time_s / 60)); }, noise_s);
    EXPECT_LT(worst_ms, 6) << noise_s;
  }
}

TEST(MidiClock, ARampIsFollowed) {
  for (const double noise_s : {0.0, 1e-3}) {
    Cable cable;
    const auto bpm = [](double time_s) {
      return 120 + 20 * std::clamp((time_s - 5) / 10, 0.0, 1.0);
    };
    double worst = 0, after = 0;
    cable.watch = [&](double time_s) {
      if (cable.tempos.empty() || time_s < 4) return;
      const double error = std::abs(cable.tempos.back().bpm / bpm(time_s) - 1);
      worst = std::max(worst, error);
      if (time_s > 20) after = std::max(after, error);
    };
    cable.run(30, bpm, noise_s);
    EXPECT_LT(worst, 0.03) << noise_s;
    EXPECT_LT(after, 0.006) << noise_s;
    EXPECT_EQ(cable.clock.status().restarts, 0);
    EXPECT_EQ(cable.clock.status().missing, 0);
    EXPECT_LT(cable.clock.status().jitter_ms, 1.3);
  }
}

TEST(MidiClock, AJumpIsFollowedWithinFourQuarters) {
  for (const double target : {30.0, 60.0, 80.0, 90.0, 100.0, 105.0, 110.0, 130.0, 135.0, 140.0,
                              150.0, 160.0, 180.0, 240.0, 400.0}) {
    Cable cable;
    cable.run(10, 120, 2e-4);
    const double jump_s = cable.due_s;
    const std::int64_t before = cable.sent;
    cable.run(jump_s + 20, target, 2e-4);
    EXPECT_NEAR(cable.clock.status().bpm / target, 1, 2e-3) << target;
    EXPECT_NEAR(cable.tempos.back().bpm / target, 1, 5e-3) << target;
    double near_s = -1;
    for (const Cable::Tempo& tempo : cable.tempos) {
      if (tempo.time_s < jump_s) continue;
      const bool is_near = std::abs(tempo.bpm / target - 1) < 0.03;
      if (is_near && near_s < 0) near_s = tempo.time_s;
      if (!is_near) near_s = -1;
    }
    EXPECT_GT(near_s, 0) << target;
    EXPECT_LT((near_s - jump_s) * target / 60, 4.0) << target;
    EXPECT_EQ(cable.clock.status().clocks, cable.sent);
    EXPECT_GT(cable.sent, before);
  }
}

TEST(MidiClock, PositionCountsEveryClockAcrossAJump) {
  for (const double target : {60.0, 90.0, 100.0, 110.0, 140.0, 150.0, 180.0, 240.0}) {
    Cable cable;
    cable.send(0.05, 0xFA);
    cable.run(10, 120);
    cable.run(cable.due_s + 20, target);
    EXPECT_EQ(cable.clock.status().position_clocks, cable.sent) << target;
  }
}

TEST(MidiClock, StopContinueAndSongPosition) {
  Cable cable;
  EXPECT_FALSE(cable.clock.status().is_running);
  cable.run(2, 120);
  EXPECT_EQ(cable.clock.status().position_clocks, 0);  // no song yet
  cable.send(2, 0xFA);
  EXPECT_TRUE(cable.clock.status().is_running);
  EXPECT_EQ(cable.clock.quarters_at(at(2)), 0);
  const std::int64_t before = cable.sent;
  const double first_s = cable.due_s;
  cable.run(5, 120);
  EXPECT_EQ(cable.clock.status().position_clocks, cable.sent - before);
  const double now_s = cable.due_s - 0.005;
  EXPECT_NEAR(cable.clock.quarters_at(at(now_s)), (now_s - first_s) * 2, 1e-4);
  EXPECT_NEAR(cable.clock.quarters_at(at(now_s + 10)), (cable.due_s - first_s) * 2, 1e-4);

  cable.send(cable.due_s - 0.001, 0xFC);
  const std::int64_t stopped = cable.clock.status().position_clocks;
  cable.run(7, 120);  // clocks go on, the song does not
  EXPECT_EQ(cable.clock.status().position_clocks, stopped);
  EXPECT_EQ(cable.clock.quarters_at(at(7)), static_cast<double>(stopped) / 24);
  cable.send(7, 0xFB);
  const std::int64_t again = cable.sent;
  cable.run(8, 120);
  EXPECT_EQ(cable.clock.status().position_clocks, stopped + cable.sent - again);
  cable.send(8, 0xFC);
  cable.send(8, 0xF2, 16, 2);
  EXPECT_EQ(cable.clock.status().position_clocks, 6 * (16 + 2 * 128));
  EXPECT_EQ(cable.clock.quarters_at(at(8)), 68);
  cable.send(8, 0xFB);
  cable.run(8.01, 120);
  EXPECT_EQ(cable.tempos.size(), 1u);
}

TEST(MidiClock, APauseOfMoreThanASecondKeepsTheTempoAndBeginsAgain) {
  Cable cable;
  cable.run(5, 120);
  EXPECT_TRUE(cable.clock.is_present(at(5.9)));
  EXPECT_FALSE(cable.clock.is_present(at(6.1)));
  cable.due_s = 9;
  cable.run(9.2, 120);
  EXPECT_EQ(cable.clock.status().restarts, 1);
  EXPECT_TRUE(cable.clock.is_present(at(9.3)));
  cable.run(12, 120);
  EXPECT_EQ(cable.tempos.size(), 1u);  // the same as before the pause
  cable.due_s = 20;
  cable.run(22, 90);
  ASSERT_EQ(cable.tempos.size(), 2u);
  EXPECT_NEAR(cable.tempos[1].bpm, 90, 0.01);
  EXPECT_LT(cable.tempos[1].time_s, 20.5);
  EXPECT_EQ(cable.clock.status().missing, 0);
}

TEST(MidiClock, ClocksThatAreLostAreCountedAndMoveNothing) {
  Cable cable;
  cable.send(0.05, 0xFA);
  for (int i = 0; i < 2000; ++i) {
    if (i > 100 && i % 97 < i / 700) continue;  // one or two in a row
    cable.send(0.1 + i / 48.0, 0xF8);
  }
  EXPECT_EQ(cable.tempos.size(), 1u);
  EXPECT_EQ(cable.clock.status().position_clocks, 2000);
  EXPECT_EQ(cable.clock.status().position_clocks,
            cable.clock.status().clocks + cable.clock.status().missing);
  EXPECT_EQ(cable.clock.status().surplus, 0);
}

TEST(MidiClock, ClocksThatAreHeldUpAndComeAtOnceAreNotLost) {
  Cable cable;
  cable.send(0.05, 0xFA);
  for (int i = 0; i < 2000; ++i) {
    const int group = i > 100 && i % 200 < 4 ? i - i % 200 + 3 : i;  // four come with the last
    cable.send(0.1 + group / 48.0 + (i % 4) * 1e-4, 0xF8);
  }
  EXPECT_EQ(cable.clock.status().position_clocks, 2000);
  EXPECT_EQ(cable.clock.status().surplus, cable.clock.status().missing);
  for (const Cable::Tempo& tempo : cable.tempos) EXPECT_NEAR(tempo.bpm, 120, 1);
  EXPECT_EQ(cable.clock.status().restarts, 0);
}

TEST(MidiClock, ClocksOfAStoppedProcessThatComeAllAtOnceAreNoTempo) {
  for (const int held : {12, 24, 43, 48, 240}) {
    Cable cable;  // its time stood still with the process
    cable.send(0.05, 0xFA);
    for (int i = 0; i < 500; ++i) cable.send(0.1 + i / 48.0, 0xF8);
    const double end_s = 0.1 + 499 / 48.0;
    for (int i = 0; i < held; ++i) cable.send(end_s + 0.01 + i * 60e-6, 0xF8);
    for (int i = 1; i < 500; ++i) cable.send(end_s + 0.025 + i / 48.0, 0xF8);
    for (const Cable::Tempo& tempo : cable.tempos) EXPECT_NEAR(tempo.bpm, 120, 4) << held;
    EXPECT_NEAR(cable.tempos.back().bpm, 120, 0.5) << held;
  }
}

TEST(MidiClock, StampsQuantisedToBlocksGiveASteadyTempo) {
  Cable cable;  // as RtMidi stamps under JACK: 1024 frames are 21 ms, a whole clock
  for (int i = 0; i < 48 * 120; ++i) {
    const double block_s = 512 / kRate;
    cable.send(std::ceil((0.1 + i / 48.0) / block_s) * block_s, 0xF8);
  }
  EXPECT_NEAR(cable.clock.status().bpm, 120, 0.5);
  EXPECT_NEAR(cable.tempos.back().bpm, 120, 2.5);
  EXPECT_LT(cable.tempos.size(), 100u);
  EXPECT_EQ(cable.clock.status().restarts, 0);
}

TEST(MidiClock, TheSameClocksLaterGiveTheSameTempos) {
  const auto run = [](std::int64_t offset) {
    MidiClock clock;
    clock.reset(kRate);
    const base::RandomStream random{support::test_seed(), 1, 0};
    std::vector<std::uint32_t> tempos;
    for (int i = 0; i < 5000; ++i) {
      base::MidiEvent event;
      const auto noise = static_cast<std::int64_t>(random.bits(static_cast<std::uint64_t>(i)) % 96);
      event.time = {offset + i * std::int64_t{1000} + noise, 12345};
      event.bytes[0] = 0xF8;
      if (clock.handle(event).tempo) tempos.push_back(clock.tempo_event().microseconds_per_quarter);
    }
    return tempos;
  };
  const auto now = run(0);
  EXPECT_FALSE(now.empty());
  EXPECT_EQ(now, run(std::int64_t{1} << 50));
}

TEST(MidiClock, AnyMessagesAtAnyTimesGiveATempoInItsRange) {
  const base::RandomStream random{support::test_seed(), 2, 0};
  std::uint64_t next = 0;
  for (int trial = 0; trial < support::test_count(300); ++trial) {
    MidiClock clock;
    clock.reset(kRate);
    double time_s = 1;
    const double scale = std::pow(10, -4 + 5 * random.unit(next++));
    std::int64_t allocations = 0;
    for (int i = 0; i < 400; ++i) {
      base::MidiEvent event;
      time_s += scale * random.unit(next++);
      time_s -= 0.02 * scale * random.unit(next++);
      event.time = at(time_s);
      const std::uint64_t kind = random.bits(next++) % 40;
      constexpr std::uint8_t kOthers[] = {0xFA, 0xFB, 0xFC, 0xF2, 0xFE, 0x90};
      event.bytes[0] = kind < 6 ? kOthers[kind] : std::uint8_t{0xF8};
      event.bytes[1] = static_cast<std::uint8_t>(random.bits(next++) & 127);
      bool has_tempo = false;
      allocations += support::allocations_in([&] { has_tempo = clock.handle(event).tempo; });
      if (has_tempo) {
        ASSERT_GE(clock.tempo_event().microseconds_per_quarter, 58800u);
        ASSERT_LE(clock.tempo_event().microseconds_per_quarter, 6130000u);
      }
      const MidiClockStatus status = clock.status();
      ASSERT_TRUE(status.bpm == 0 || (status.bpm > 9.99 && status.bpm < 1000.01)) << status.bpm;
      ASSERT_TRUE(std::isfinite(status.jitter_ms));
      ASSERT_TRUE(std::isfinite(clock.quarters_at(event.time)));
    }
    EXPECT_EQ(allocations, 0);
  }
}

}  // namespace
}  // namespace knotwave::engine

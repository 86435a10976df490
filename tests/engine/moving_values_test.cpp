// SPDX-License-Identifier: MIT
// Fade, tempo clock and signals: what moves while a voice sounds.
#include <gtest/gtest.h>

#include "chunk_signal.h"
#include "fade.h"
#include "tempo_clock.h"

namespace knotwave::engine {
namespace {

TEST(Fade, GoesFromOneToExactlyZeroAndBack) {
  Fade fade;
  EXPECT_EQ(fade.at(0), 1.0);
  EXPECT_FALSE(fade.is_moving(0));
  fade.begin_out(100, 240);
  EXPECT_EQ(fade.at(100), 1.0);
  EXPECT_EQ(fade.at(220), 0.5);
  EXPECT_EQ(fade.at(340), 0.0);
  EXPECT_FALSE(fade.is_over(339));
  EXPECT_TRUE(fade.is_over(340));
  fade.reset();
  fade.begin_in(0, 4);
  EXPECT_EQ(fade.at(0), 0.0);
  EXPECT_EQ(fade.at(4), 1.0);
  EXPECT_FALSE(fade.is_over(1000));
  EXPECT_FALSE(fade.is_moving(4));
}

TEST(Fade, InAndOutOfTheSameLengthAddUpToOne) {
  Fade in, out;
  in.begin_in(7, 960);
  out.begin_out(7, 960);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(in.at(i) + out.at(i), 1, 1e-15);
}

TEST(Fade, OutWhileStillComingInIsContinuous) {
  Fade fade;
  fade.begin_in(0, 960);
  const double before = fade.at(480);
  fade.begin_out(480, 240);
  EXPECT_EQ(fade.at(480), before);
  EXPECT_EQ(fade.at(720), 0.0);
  fade.begin_out(600, 960);  // later than the end it already has
  EXPECT_TRUE(fade.is_over(720));
}

TEST(TempoClock, CountsQuarterNotesAcrossTempoChanges) {
  TempoClock clock;
  clock.reset(48000);
  EXPECT_NEAR(clock.beats_at(48000), 2, 1e-12);  // 120 a minute until told otherwise
  clock.set_tempo({48000, 0}, 1000000);
  EXPECT_NEAR(clock.beats_at(96000), 3, 1e-12);
  EXPECT_EQ(clock.seconds_per_quarter(), 1.0);
  clock.set_tempo({96000, 0x80000000}, 250000);
  EXPECT_NEAR(clock.beats_at(96000 + 12000), 4, 1e-4);
  clock.set_tempo({200000, 0}, 0);
  EXPECT_EQ(clock.seconds_per_quarter(), 0.25);
}

TEST(Signal, AConstantAndAMovingValueGiveTheSameBits) {
  ChunkBuffer a{}, b{}, buffer{};
  a.fill(0.1);
  b.fill(0.7);
  const Signal constant{0.1, nullptr}, moving{0, a.data()};
  const Signal other{0.7, nullptr}, other_moving{0, b.data()};
  const double expected = sum(constant, other, kChunk, buffer).constant;
  for (const Signal& x : {constant, moving}) {
    for (const Signal& y : {other, other_moving}) {
      ChunkBuffer out{};
      EXPECT_EQ(sum(x, y, kChunk, out).at(kChunk - 1), expected);
    }
  }
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Free numbers: what maps add up to, for other maps to read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/engine/patch_program.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

constexpr std::string_view kCurves = R"(
[curves.straight]
degree = 1
points = [0, 1]
[curves.late]
degree = 2
points = [0, 0, 1]
[curves.weighted]
degree = 2
points = [0, 0.4, 1]
weights = [1, 3, 1]
[lfos.wave]
curve = "sine"
rate_hz = 7
[surfaces.product]
degree_u = 1
degree_v = 1
points = [[0, 0], [0, 1]]
)";

std::string map_of(std::string_view from, std::string_view to, double depth,
                   std::string_view more = "") {
  return "[[maps]]\nfrom = " + std::string(from) + "\nto = '" + std::string(to) +
         "'\ndepth = " + std::to_string(depth) + "\n" + std::string(more) + "\n";
}

std::string patch_with(const std::string& maps) {
  return std::string(kPlain) + std::string(kCurves) + maps;
}

const std::vector<Event> kPlayed = {control(0, 0, 1, 20), on(0, 0, 57, 127),
                                    control(1001, 0, 1, 127), midi(1500, 0xD0, 90, 0),
                                    control(2000, 0, 1, 64)};

Sound sound_of(const std::string& maps, std::size_t block = 256) {
  const auto bank = bank_from(patch_with(maps));
  return play(*engine_for(*bank), kPlayed, 6000, block);
}

std::unique_ptr<const PatchProgram> program_of(const std::string& maps) {
  return program_from(patch_with(maps));
}

std::string read_error(const std::string& maps) {
  const auto patch = parse_patch(patch_with(maps), "p.toml");
  EXPECT_FALSE(patch);
  return patch ? "" : patch.error().to_string();
}

TEST(FreeNumbers, AMapThroughOneSoundsLikeTheMapItself) {
  const Sound straight = sound_of(map_of("'mod'", "pitch", 12));
  EXPECT_FALSE(straight == sound_of(""));
  EXPECT_TRUE(sound_of(map_of("'mod'", "free.x", 1) + map_of("'free.x'", "pitch", 12)) == straight);
  // Also where the map that reads comes first in the file.
  EXPECT_TRUE(sound_of(map_of("'free.x'", "pitch", 12) + map_of("'mod'", "free.x", 1)) == straight);
}

TEST(FreeNumbers, MapsOntoOneAddUpAndManyReadItThroughCurvesOfTheirOwn) {
  const std::string writers = map_of("'velocity'", "free.x", 0.25) +
                              map_of("'key'", "free.x", 0.5) + map_of("'constant'", "free.x", 0.1);
  const double sum = 0.25 + 0.5 * 57 / 127 + 0.1;
  const auto expected = [&](double pitch, double gain) {
    return sound_of(map_of("'constant'", "pitch", pitch) + map_of("'constant'", "gain", gain));
  };
  const Sound sound = sound_of(writers + map_of("'free.x'", "pitch", 12) +
                               map_of("'free.x'", "gain", 2, "curve = 'late'"));
  const Sound wanted = expected(12 * sum, 2 * sum * sum);
  for (std::size_t i = 0; i < sound.left.size(); ++i) {
    ASSERT_NEAR(sound.left[i], wanted.left[i], 1e-5) << i;
  }
}

TEST(FreeNumbers, OneMayMoveAnotherAndASurfaceTakesTwo) {
  const std::string maps = map_of("'free.y'", "pitch", 12) + map_of("'free.x'", "free.y", 0.5) +
                           map_of("'mod'", "free.x", 2);
  EXPECT_TRUE(sound_of(maps) == sound_of(map_of("'mod'", "pitch", 12)));
  const std::string product = map_of("['free.x', 'free.y']", "pitch", 12, "surface = 'product'");
  EXPECT_TRUE(
      sound_of(map_of("'mod'", "free.x", 1) + map_of("'velocity'", "free.y", 1) + product) ==
      sound_of(map_of("['mod', 'velocity']", "pitch", 12, "surface = 'product'")));
}

TEST(FreeNumbers, TheSmoothingIsThatOfTheMapThatHearsThePlayer) {
  const Sound slow = sound_of(map_of("'mod'", "pitch", 12, "smooth_s = 0.05"));
  EXPECT_FALSE(slow == sound_of(map_of("'mod'", "pitch", 12)));
  EXPECT_TRUE(sound_of(map_of("'mod'", "free.x", 1, "smooth_s = 0.05") +
                       map_of("'free.x'", "pitch", 12, "smooth_s = 3")) == slow);
}

TEST(FreeNumbers, ARationalMapOverridesThePlainOnesOntoTheSameOne) {
  const std::string reader = map_of("'free.x'", "pitch", 12);
  const std::string weighted = map_of("'velocity'", "free.x", 1, "curve = 'weighted'");
  const std::string plain = map_of("'mod'", "free.x", 1);
  EXPECT_TRUE(sound_of(plain + weighted + reader) == sound_of(weighted + reader));
  EXPECT_EQ(program_of(plain + weighted + reader)->maps().size(), 2u);
  EXPECT_EQ(program_of(map_of("'mod'", "free.y", 1) + weighted + reader)->maps().size(), 3u);
}

TEST(FreeNumbers, WhatNoMapMovesIsZeroAndMapsThatAreOffAreNotCompiledIn) {
  const std::string off = map_of("'mod'", "free.x", 1, "enabled = false");
  const std::string reader = map_of("'free.x'", "pitch", 12);
  EXPECT_EQ(program_of(off + reader)->maps().size(), 1u);
  EXPECT_EQ(program_of(off + reader)->schedule().size(),
            program_of(reader + off)->schedule().size());
  EXPECT_TRUE(sound_of(off + reader) == sound_of(""));
  // A circle that is cut by a map that is off is none.
  EXPECT_TRUE(sound_of(map_of("'free.x'", "free.x", 1, "enabled = false") + reader +
                       map_of("'mod'", "free.x", 1)) == sound_of(map_of("'mod'", "pitch", 12)));
}

TEST(FreeNumbers, TheLengthOfABlockIsNotHeard) {
  const std::string maps =
      map_of("'wave'", "free.x", 0.3) + map_of("'mod'", "free.x", 1) +
      map_of("'amp'", "free.y", 1, "curve = 'late'") + map_of("'pressure'", "free.y", -2) +
      map_of("'free.x'", "pitch", 7) + map_of("'free.x'", "lfo.slow.rate", 3) +
      map_of("'free.x'", "a.phase", 0.2, "curve = 'late'") +
      map_of("['free.x', 'free.y']", "gain", 0.5, "surface = 'product'") +
      map_of("'slow'", "amp", 6) + "[[maps]]\nfrom = 'free.y'\nto = 'curve.late.point.1'\n" +
      "low = -0.5\nhigh = 0.5\n[lfos.slow]\ncurve = 'triangle'\n";
  // free.y hangs on 'late', so its point cannot hang on free.y.
  EXPECT_FALSE(PatchProgram::create(*parse_patch(patch_with(maps), "p.toml")));
  std::string sound = maps;
  sound.replace(sound.find("curve = 'late'"), 14, "curve = 'straight'");
  const Sound whole = sound_of(sound, 6000);
  EXPECT_GT(peak(whole.left), 0.01);
  for (std::size_t block = 1; block < 70; block += block < 20 ? 1 : 7) {
    ASSERT_TRUE(sound_of(sound, block) == whole) << block;
  }
}

TEST(FreeNumbers, AnEnvelopesTimeReadsThemWhenTheNoteStarts) {
  const std::string time = "envelope.amp.time";
  const Sound straight = sound_of(map_of("'mod'", time, 3) + map_of("'velocity'", time, 1));
  EXPECT_FALSE(straight == sound_of(""));
  EXPECT_TRUE(sound_of(map_of("'free.x'", time, 1) + map_of("'mod'", "free.x", 3) +
                       map_of("'velocity'", "free.x", 1)) == straight);
}

// 2^15 ways from the first to the last: each map is worked out once all the same.
TEST(FreeNumbers, ALongLadderOfThemIsWorkedOutOnce) {
  std::string maps = map_of("'constant'", "free.n0", 0.015625);
  for (int i = 0; i < 15; ++i) {
    const std::string from = "'free.n" + std::to_string(i) + "'";
    const std::string to = "free.n" + std::to_string(i + 1);
    maps += map_of(from, to, 1) + map_of(from, to, 1);
  }
  const std::string last = map_of("'free.n15'", "envelope.amp.time", 0.015625);
  EXPECT_EQ(program_of(maps + last)->note_on_maps().size(), 32u);
  EXPECT_TRUE(sound_of(maps + last) == sound_of(map_of("'constant'", "envelope.amp.time", 8)));
}

TEST(FreeNumbers, AtMostAMillionIsRead) {
  const std::string huge = map_of("'constant'", "free.x", 1000) +
                           map_of("'free.x'", "free.y", 1000) + map_of("'free.y'", "free.z", 1000);
  const std::string reader = map_of("'free.z'", "pitch", 0.00001);
  EXPECT_TRUE(sound_of(huge + reader) == sound_of(map_of("'constant'", "pitch", 10)));
}

TEST(FreeNumbers, VelocityThatReachesTheLoudnessThroughOneReplacesTheBuiltInLaw) {
  const std::string velocity = map_of("'velocity'", "free.x", 1);
  EXPECT_FALSE(program_of(velocity + map_of("'free.x'", "amp", 6))->uses_velocity_law());
  EXPECT_TRUE(program_of(velocity + map_of("'free.x'", "pitch", 6))->uses_velocity_law());
  EXPECT_TRUE(program_of(velocity + map_of("'mod'", "amp", 6))->uses_velocity_law());
}

TEST(FreeNumbers, AreThereOnlyIfAMapMovesThem) {
  EXPECT_THAT(read_error(map_of("'mod'", "free.wheel", 1) + map_of("'free.whell'", "pitch", 1)),
              testing::AllOf(testing::StartsWith("p.toml:40:8: error: map 2: "),
                             testing::HasSubstr("'free.whell'"),
                             testing::HasSubstr("did you mean 'free.wheel'?")));
  EXPECT_THAT(read_error(map_of("'free.wheel'", "pitch", 1)),
              testing::HasSubstr("a free number is there once a map has it as its target"));
}

TEST(FreeNumbers, AreSixteenAtMostWithNamesAsAllHave) {
  EXPECT_THAT(read_error(map_of("'mod'", "free.my wheel", 1)),
              testing::HasSubstr("p.toml:36:6: error: 'free.my wheel': a name is"));
  EXPECT_THAT(read_error(map_of("'mod'", "free.", 1)), testing::HasSubstr("a name is"));
  std::string maps;
  for (int i = 0; i < 17; ++i) maps += map_of("'mod'", "free.n" + std::to_string(i), 1);
  EXPECT_THAT(read_error(maps), testing::HasSubstr("'free.n16' is one more than the 16"));
  EXPECT_THAT(read_error("[oscillators.free]\nwave = 'sine'\n"), testing::HasSubstr("'free'"));
}

}  // namespace
}  // namespace knotwave::engine

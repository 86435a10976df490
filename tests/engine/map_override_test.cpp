// SPDX-License-Identifier: MIT
// Maps onto one target: plain ones add up, a rational one takes their place.
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
[curves.weighted]
degree = 2
points = [0, 0.4, 1]
weights = [1, 3, 1]
[curves.evenly]
degree = 2
points = [0, 0.4, 1]
weights = [3, 3, 3]
[curves.moved]
degree = 2
points = [0, 0.4, 1]
[surfaces.weighted_row]
degree_u = 1
degree_v = 1
points = [[0, 1], [0, 1]]
weights = [[1, 2], [1, 3]]
)";

std::string map_of(std::string_view from, std::string_view curve, std::string_view to, int depth,
                   std::string_view more = "") {
  return "[[maps]]\nfrom = " + std::string(from) + "\n" + std::string(curve) + "\nto = '" +
         std::string(to) + "'\ndepth = " + std::to_string(depth) + "\n" + std::string(more) + "\n";
}
const std::string plain_map = map_of("'velocity'", "", "pitch", 5);
const std::string weighted_map = map_of("'velocity'", "curve = 'weighted'", "pitch", 12);

std::string patch_with(const std::string& maps) {
  return std::string(kPlain) + std::string(kCurves) + maps;
}

Sound sound_of(const std::string& maps, std::size_t block = 256) {
  const auto bank = bank_from(patch_with(maps));
  return play(*engine_for(*bank), {on(0, 0, 57, 127)}, 24000, block);
}
double pitch_of(const Sound& sound) { return frequency_hz(sound.left, 4000, 24000); }

std::unique_ptr<const PatchProgram> program_of(const std::string& maps) {
  return program_from(patch_with(maps));
}

TEST(MapOverride, ARationalMapTakesThePlaceOfPlainOnesOntoTheSameTarget) {
  const Sound alone = sound_of(weighted_map);
  EXPECT_NEAR(pitch_of(alone), 440, 0.01);
  EXPECT_TRUE(sound_of(plain_map + weighted_map) == alone);
  EXPECT_TRUE(sound_of(weighted_map + plain_map + plain_map) == alone);
}

TEST(MapOverride, PlainMapsAddUpAndSoDoRationalOnes) {
  const std::string octave = map_of("'constant'", "curve = 'straight'", "pitch", 7);
  EXPECT_NEAR(pitch_of(sound_of(plain_map + octave)), 440, 0.01);
  EXPECT_NEAR(pitch_of(sound_of(weighted_map + weighted_map + plain_map)), 880, 0.02);
}

TEST(MapOverride, OtherTargetsKeepTheirPlainMaps) {
  const std::string of_oscillator = map_of("'constant'", "", "a.pitch", 12);
  EXPECT_NEAR(pitch_of(sound_of(of_oscillator + weighted_map)), 880, 0.02);
}

TEST(MapOverride, ARationalMapThatIsOffOverridesNothing) {
  const std::string off_map =
      map_of("'velocity'", "curve = 'weighted'", "pitch", 12, "enabled = false");
  EXPECT_TRUE(sound_of(plain_map + off_map) == sound_of(plain_map));
}

TEST(MapOverride, WeightsThatAreAllTheSameMakeNoRationalMap) {
  const std::string even = map_of("'velocity'", "curve = 'evenly'", "pitch", 7);
  EXPECT_NEAR(pitch_of(sound_of(plain_map + even)), 440, 0.01);
}

TEST(MapOverride, AMovedWeightOrAWeightedSurfaceMakesARationalMap) {
  const std::string through_moved = map_of("'velocity'", "curve = 'moved'", "pitch", 12);
  const std::string mover =
      "[[maps]]\nfrom = 'mod'\nto = 'curve.moved.weight.1'\nlow = 0.5\nhigh = 4\n";
  EXPECT_NEAR(pitch_of(sound_of(plain_map + through_moved)), 440 * std::exp2(5.0 / 12), 0.02);
  EXPECT_NEAR(pitch_of(sound_of(plain_map + through_moved + mover)), 440, 0.01);
  const std::string surface =
      map_of("['velocity', 'key']", "surface = 'weighted_row'", "pitch", 12);
  EXPECT_NEAR(pitch_of(sound_of(plain_map + surface)), 440, 0.01);
}

TEST(MapOverride, OverriddenMapsAreNotCompiledInAndTheReportSaysSo) {
  const auto program = program_of(plain_map + weighted_map + plain_map);
  EXPECT_EQ(program->maps().size(), 1u);
  EXPECT_EQ(program->schedule().size(), program_of(weighted_map)->schedule().size());
  EXPECT_THAT(program->report(),
              testing::Contains("map 3 is overridden: map 2 moves the same target by a rational "
                                "curve or surface"));
}

TEST(MapOverride, AnOverriddenMapFromVelocityLeavesTheBuiltInLawOn) {
  const std::string plain = map_of("'velocity'", "", "amp", 20);
  const std::string weighted = map_of("'mod'", "curve = 'weighted'", "amp", 20);
  EXPECT_FALSE(program_of(plain)->uses_velocity_law());
  EXPECT_TRUE(program_of(plain + weighted)->uses_velocity_law());
}

TEST(MapOverride, TheLengthOfABlockIsNotHeard) {
  const std::string maps = map_of("'mod'", "curve = 'weighted'", "pitch", 12) + plain_map;
  const auto bank = bank_from(patch_with(maps));
  const std::vector<Event> events = {on(0, 0, 57), control(1001, 0, 1, 127)};
  const Sound whole = play(*engine_for(*bank), events, 3000, 3000);
  for (const std::size_t block : {1u, 7u, 64u, 257u}) {
    EXPECT_TRUE(play(*engine_for(*bank), events, 3000, block) == whole) << block;
  }
}

}  // namespace
}  // namespace knotwave::engine

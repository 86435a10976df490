// SPDX-License-Identifier: MIT
// A map may move a number of any curve, whatever the curve is for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/engine/patch_program.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

struct Role {
  const char* name;
  const char* lines;   ///< before the tables
  const char* tables;  ///< of a patch in which the curve 'shape' has the role
};

std::ostream& operator<<(std::ostream& out, const Role& role) { return out << role.name; }

constexpr Role kRoles[] = {
    {"Lfo", "",
     "[lfos.wow]\ncurve = 'shape'\nrate_hz = 40\n"
     "[[maps]]\nfrom = 'wow'\nto = 'amp'\ndepth = -20\n"},
    {"Shaper", "", "[shaper]\ncurve = 'shape'\ndrive_db = 3\n"},
    {"Glide", "glide_s = 0.2\nglide_curve = 'shape'", ""},
    {"Law", "",
     "[oscillators.b]\nwave = 'triangle'\n[crossfade]\nbetween = ['a', 'b']\n"
     "law = 'shape'\nposition = 0.4\n"},
    {"Map", "", "[[maps]]\nfrom = 'key'\ncurve = 'shape'\nto = 'pitch'\ndepth = 3\n"},
    {"Envelope", "",
     "[envelopes.fall]\ncurve = 'shape'\nseconds = 0.3\n"
     "[[maps]]\nfrom = 'fall'\nto = 'amp'\ndepth = -20\n"},
    {"EnvelopeTime", "",
     "[envelopes.fall]\ncurve = 'gate'\nseconds = 0.3\n"
     "[[maps]]\nfrom = 'fall'\nto = 'amp'\ndepth = -20\n"
     "[[maps]]\nfrom = 'key'\ncurve = 'shape'\nto = 'envelope.fall.time'\n"},
};

std::string patch_with(const Role& role, const std::string& weights, const std::string& points,
                       const std::string& maps) {
  return with(kPlain, role.lines) + "[curves.shape]\ndegree = 3\npoints = " + points +
         "\nweights = " + weights + "\n" + role.tables + maps;
}
const std::string rest_points = "[0, 0.1, 0.9, 1]", rest_weights = "[1, 1, 2, 1]";
const std::string both_move =
    "[[maps]]\nfrom = 'mod'\nto = 'curve.shape.weight.1'\nlow = 0.5\nhigh = 4\nsmooth_s = 0.01\n"
    "[[maps]]\nfrom = 'cc20'\nto = 'curve.shape.point.2'\nlow = -0.5\nhigh = 0.9\n";

std::vector<Event> two_notes(std::vector<Event> events) {
  for (const Event& event : {on(0, 0, 57), off(4000, 0, 57), on(5000, 0, 64)}) {
    events.push_back(event);
  }
  return events;
}

Sound sound_of(const std::string& patch, const std::vector<Event>& events,
               std::size_t block = 256) {
  const auto bank = bank_from(patch);
  return play(*engine_for(*bank), events, 14000, block);
}

double most_apart(const Sound& a, const Sound& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.left.size(); ++i) {
    most =
        std::max(most, std::abs(static_cast<double>(a.left[i]) - static_cast<double>(b.left[i])));
  }
  return most;
}

class MovedRole : public testing::TestWithParam<Role> {};

TEST_P(MovedRole, ANumberThatStandsStillIsThatNumberWrittenInTheFile) {
  const Role& role = GetParam();
  const std::vector<Event> at_end = {control(0, 0, 1, 127), control(0, 0, 20, 0)};
  const Sound moved =
      sound_of(patch_with(role, rest_weights, rest_points, both_move), two_notes(at_end));
  const Sound written =
      sound_of(patch_with(role, "[1, 4, 2, 1]", "[0, 0.1, -0.5, 1]", ""), two_notes({}));
  const Sound other = sound_of(patch_with(role, rest_weights, rest_points, ""), two_notes({}));
  EXPECT_LE(most_apart(moved, written), 2e-6);
  EXPECT_GT(most_apart(moved, other), 1e-3);
}

TEST_P(MovedRole, MovingItWhileItSoundsIsHeardAndNoBlockLengthIs) {
  const std::string patch = patch_with(GetParam(), rest_weights, rest_points, both_move);
  std::vector<Event> events = two_notes({control(0, 0, 1, 18), control(0, 0, 20, 127)});
  const Sound still = sound_of(patch, events);
  events.push_back(control(5000, 0, 1, 127));
  events.push_back(control(5600, 0, 20, 0));
  events.push_back(on(7003, 0, 45));
  const Sound whole = sound_of(patch, events, 14000);
  EXPECT_GT(most_apart(whole, still), 1e-3);
  for (const std::size_t block : {1u, 7u, 64u, 257u}) {
    EXPECT_TRUE(sound_of(patch, events, block) == whole) << block;
  }
}

INSTANTIATE_TEST_SUITE_P(Roles, MovedRole, testing::ValuesIn(kRoles),
                         [](const auto& role) { return std::string(role.param.name); });

// Two knots, which two controllers move.
std::string knot_patch(const Role& role, const std::string& knots, const std::string& maps) {
  return with(kPlain, role.lines) + "[curves.shape]\ndegree = 3\n" +
         "points = [0, 0.9, 0.1, 0.7, 0.3, 1]\nweights = [1, 1, 2, 1, 0.5, 1]\nknots = " + knots +
         "\n" + role.tables + maps;
}
const std::string rest_knots = "[0,0,0,0, 0.3,0.6, 1,1,1,1]";
const std::string knots_move =
    "[[maps]]\nfrom = 'mod'\nto = 'curve.shape.knot.4'\nlow = 0.1\nhigh = 0.5\nsmooth_s = 0.01\n"
    "[[maps]]\nfrom = 'cc20'\nto = 'curve.shape.knot.5'\nlow = 0.55\nhigh = 0.9\n";

class MovedKnot : public testing::TestWithParam<Role> {};

TEST_P(MovedKnot, ThatStandsStillIsThatKnotWrittenInTheFile) {
  const Role& role = GetParam();
  const std::vector<Event> at_end = {control(0, 0, 1, 0), control(0, 0, 20, 127)};
  const Sound moved = sound_of(knot_patch(role, rest_knots, knots_move), two_notes(at_end));
  const Sound written =
      sound_of(knot_patch(role, "[0,0,0,0, 0.1,0.9, 1,1,1,1]", ""), two_notes({}));
  const Sound other = sound_of(knot_patch(role, rest_knots, ""), two_notes({}));
  EXPECT_LE(most_apart(moved, written), 2e-6);
  EXPECT_GT(most_apart(moved, other), 5e-4);
}

TEST_P(MovedKnot, MovingWhileItSoundsIsHeardAndNoBlockLengthIs) {
  const std::string patch = knot_patch(GetParam(), rest_knots, knots_move);
  std::vector<Event> events = two_notes({control(0, 0, 1, 18), control(0, 0, 20, 127)});
  const Sound still = sound_of(patch, events);
  events.push_back(control(5000, 0, 1, 127));
  events.push_back(control(5600, 0, 20, 0));
  events.push_back(on(7003, 0, 45));
  const Sound whole = sound_of(patch, events, 14000);
  EXPECT_GT(most_apart(whole, still), 1e-3);
  for (const std::size_t block : {1u, 7u, 64u, 257u}) {
    EXPECT_TRUE(sound_of(patch, events, block) == whole) << block;
  }
}

std::vector<Role> roles_of_moved_knots() {
  std::vector<Role> roles(std::begin(kRoles), std::end(kRoles));
  std::erase_if(roles, [](const Role& role) { return std::string_view(role.name) == "Shaper"; });
  return roles;
}
INSTANTIATE_TEST_SUITE_P(Roles, MovedKnot, testing::ValuesIn(roles_of_moved_knots()),
                         [](const auto& role) { return std::string(role.param.name); });

TEST(MovedKnotOfAWaveform, IsASurfaceOverItsRange) {
  const std::string wave = std::string(kPlain) +
                           "[oscillators.b]\nwave = 'drawn'\n[curves.drawn]\ndegree = 3\n" +
                           "periodic = true\npoints = [0, 1, -0.3, 0.2, -1, 0.4]\nknots = [0,1,2,";
  const std::string map =
      "[[maps]]\nfrom = 'mod'\nto = 'curve.drawn.knot.3'\nlow = 2.5\nhigh = 3.5\n";
  const std::vector<Event> half = {control(0, 0, 1, 64), control(0, 0, 33, 0), on(0, 0, 57)};
  const Sound moved = sound_of(wave + "3,4,5,6]\n" + map, half);
  const Sound written =
      sound_of(wave + std::to_string(2.5 + 64 * 128 / 16383.0) + ",4,5,6]\n", half);
  EXPECT_LE(most_apart(moved, written), 1e-5);
  EXPECT_GT(most_apart(moved, sound_of(wave + "2.5,4,5,6]\n", half)), 1e-3);
}

std::string error_of(const std::string& text) {
  const auto patch = parse_patch(text, "scene.toml");
  if (!patch) return patch.error().to_string();
  const auto program = PatchProgram::create(*patch);
  return program ? "no error" : program.error().to_string();
}

TEST(MovedRoles, ACurveWithATimeCoordinateIsRefusedWithWhatToDo) {
  const std::string text = std::string(kPlain) +
                           "[curves.timed]\ndegree = 1\npoints = [[0, 0], [1, 1]]\n"
                           "[lfos.wow]\ncurve = 'timed'\n"
                           "[[maps]]\nfrom = 'mod'\nto = 'curve.timed.point.1.y'\nlow = 0\n"
                           "high = 1\n";
  EXPECT_THAT(error_of(text),
              testing::HasSubstr("map 1: it moves a number of curve 'timed' (lfo 'wow')"));
  EXPECT_THAT(error_of(text), testing::HasSubstr("A curve of one coordinate"));
}

TEST(MovedRoles, AnLfoThatMovesItsOwnCurveIsRefusedByName) {
  const std::string text = std::string(kPlain) +
                           "[curves.shape]\ndegree = 2\npoints = [0, 1, 0]\n"
                           "[lfos.wow]\ncurve = 'shape'\n"
                           "[[maps]]\nfrom = 'wow'\nto = 'curve.shape.weight.1'\nlow = 0.5\n"
                           "high = 4\n";
  EXPECT_THAT(error_of(text), testing::HasSubstr("depend on themselves: lfo 'wow'"));
}

TEST(MovedRoles, AnEnvelopesTimeFollowsNoCurveThatAnLfoMoves) {
  const std::string text = std::string(kPlain) +
                           "[curves.shape]\ndegree = 2\npoints = [0, 1, 0]\n"
                           "[lfos.wow]\ncurve = 'sine'\n"
                           "[[maps]]\nfrom = 'key'\ncurve = 'shape'\nto = 'envelope.amp.time'\n"
                           "[[maps]]\nfrom = 'wow'\nto = 'curve.shape.weight.1'\nlow = 0.5\n"
                           "high = 4\n";
  EXPECT_THAT(error_of(text), testing::HasSubstr("read once, when a note starts"));
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// What is found only when a patch is compiled is told at its line and column too.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {
namespace {

namespace fs = std::filesystem;

// Seventeen lines; what a test adds begins on line 18.
constexpr std::string_view kHead = R"(format = 1
kind = "patch"
[curves.ring]
degree = 2
points = [1, 0.5, 0]
weights = [1, 5, 1]
[curves.upright]
degree = 1
points = [[0.5, 0], [0.5, 1]]
[curves.timed]
degree = 2
points = [[-1, 0], [0, 0.5], [1, 1]]
weights = [1, 2, 1]
[oscillators.a]
wave = "ring"
[envelopes.amp]
curve = "ring"
)";

Error error_of(const std::string& text) {
  auto spec = parse_patch(text, "p.toml");
  EXPECT_TRUE(spec) << "found by the reader: " << spec.error().to_string();
  if (!spec) return {};
  const auto program = PatchProgram::create(*spec);
  EXPECT_FALSE(program);
  return program ? Error{} : program.error();
}

struct Fault {
  const char* name;
  const char* tables;
  ErrorCode code;
  const char* report;  ///< how Error::to_string() begins
};
std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

// An even number of points between -1 and 1.
std::string many_points() {
  std::string points = "[curves.many]\ndegree = 3\npoints = [-1";
  for (int i = 0; i < 60; ++i) points += i % 2 == 0 ? ", 1" : ", -1";
  return points + "]\n";
}

constexpr Fault kFaults[] = {
    {"AnEnvelopeWhoseTimeStandsStill", "[envelopes.b]\nseconds = 2\ncurve = 'upright'\n",
     ErrorCode::empty_domain, "p.toml:20:9: error: envelope 'b': "},
    {"AnLfoWhoseTimeStandsStill", "[lfos.w]\ncurve = 'upright'\n", ErrorCode::empty_domain,
     "p.toml:19:9: error: lfo 'w': "},
    {"AMapThroughATimeThatStandsStill",
     "[[maps]]\nfrom = 'mod'\nto = 'amp'\n[[maps]]\nfrom = 'mod'\ncurve = 'upright'\nto = 'amp'\n",
     ErrorCode::empty_domain, "p.toml:23:9: error: map 2: "},
    {"AShaperWhoseInputStandsStill", "[shaper]\ncurve = 'upright'\n", ErrorCode::empty_domain,
     "p.toml:19:9: error: shaper: curve 'upright'"},
    {"AShaperWhoseWeightMovesTooFar",
     "[shaper]\ncurve = 'many'\n[[maps]]\nfrom = 'mod'\nto = 'curve.many.weight.30'\n"
     "low = 0.000001\nhigh = 1000000\n",
     ErrorCode::error_bound_missed, "p.toml:19:9: error: shaper: curve 'many' "},
    {"ARangeAboveTheWrittenWeight",
     "[[maps]]\nfrom = 'mod'\nto = 'curve.ring.weight.1'\nlow = 6\nhigh = 9\n",
     ErrorCode::value_out_of_range,
     "p.toml:21:7: error: map 1: low (6) to high (9) leaves out 5, which weight 1 of curve 'ring' "
     "has in the file"},
    {"ARangeBelowTheWrittenWeight",
     "[[maps]]\nfrom = 'mod'\nto = 'curve.ring.weight.1'\nlow = 1\nhigh = 4.5\n",
     ErrorCode::value_out_of_range, "p.toml:22:8: error: map 1: low (1) to high (4.5) leaves out"},
    {"ARangeThatLeavesOutThePoint",
     "[[maps]]\nfrom = 'mod'\nto = 'curve.timed.point.1.y'\nlow = 1\nhigh = 4\n",
     ErrorCode::value_out_of_range,
     "p.toml:21:7: error: map 1: low (1) to high (4) leaves out 0.5, which point 1 of curve "
     "'timed'"},
    {"AKnotThatWouldReachItsNeighbour",
     "[curves.knotty]\ndegree = 2\npoints = [0, 1, 0, 1, 0]\n[[maps]]\nfrom = 'mod'\n"
     "to = 'curve.knotty.knot.3'\nlow = 0.1\nhigh = 0.7\n",
     ErrorCode::value_out_of_range,
     "p.toml:24:7: error: map 1: curve 'knotty': control 0 (knot 3): its range 0.1..0.7 does not"},
    {"AKnotThatWouldReachAMovedNeighbour",
     "[curves.knotty]\ndegree = 2\npoints = [0, 1, 0, 1, 0]\n[[maps]]\nfrom = 'mod'\n"
     "to = 'curve.knotty.knot.3'\nlow = 0.1\nhigh = 0.6\n[[maps]]\nfrom = 'mod'\n"
     "to = 'curve.knotty.knot.4'\nlow = 0.5\nhigh = 0.8\n",
     ErrorCode::value_out_of_range,
     "p.toml:29:7: error: map 2: curve 'knotty': control 0 (knot 4): its range 0.5..0.8 does not"},
    {"AKnotOfAShaper",
     "[curves.knotty]\ndegree = 2\npoints = [0, 1, 0, 1, 0]\n[shaper]\ncurve = 'knotty'\n"
     "[[maps]]\nfrom = 'mod'\nto = 'curve.knotty.knot.3'\nlow = 0.1\nhigh = 0.5\n",
     ErrorCode::unsupported, "p.toml:22:9: error: shaper: curve 'knotty': knot 3 of it moves; a"},
    {"TwoNumbersOfAWaveform",
     "[[maps]]\nfrom = 'mod'\nto = 'curve.ring.weight.1'\nlow = 1\nhigh = 9\n"
     "[[maps]]\nfrom = 'mod'\nto = 'curve.ring.point.2'\nlow = 0\nhigh = 1\n",
     ErrorCode::unsupported, "p.toml:25:6: error: oscillator 'a': 2 numbers of the waveform"},
    {"AnLfoThatMovesItself",
     "[lfos.w]\ncurve = 'ring'\n[[maps]]\nfrom = 'w'\nto = 'amp'\n"
     "[[maps]]\nfrom = 'w'\nto = 'lfo.w.rate'\n",
     ErrorCode::cyclic_reference,
     "p.toml:25:6: error: maps make these depend on themselves: lfo 'w'"},
    {"FreeNumbersThatMoveEachOther",
     "[[maps]]\nfrom = 'free.x'\nto = 'free.y'\n[[maps]]\nfrom = 'free.y'\nto = 'free.x'\n"
     "[[maps]]\nfrom = 'free.x'\nto = 'free.z'\n[[maps]]\nfrom = 'mod'\nto = 'free.x'\n",
     ErrorCode::cyclic_reference,
     "p.toml:20:6: error: maps make these depend on themselves: free.y, free.x"},
    {"AFreeNumberThatMovesItself", "[[maps]]\nfrom = 'free.x'\nto = 'free.x'\n",
     ErrorCode::cyclic_reference,
     "p.toml:20:6: error: maps make these depend on themselves: free.x"},
    {"AnLfoThatMovesItselfThroughAFreeNumber",
     "[lfos.w]\ncurve = 'ring'\n[[maps]]\nfrom = 'w'\nto = 'free.x'\n"
     "[[maps]]\nfrom = 'free.x'\nto = 'lfo.w.rate'\n",
     ErrorCode::cyclic_reference,
     "p.toml:22:6: error: maps make these depend on themselves: free.x, lfo 'w'"},
    {"AnEnvelopesTimeFromAnLfoThroughAFreeNumber",
     "[lfos.w]\ncurve = 'ring'\n[[maps]]\nfrom = 'free.x'\nto = 'envelope.amp.time'\n"
     "[[maps]]\nfrom = 'w'\nto = 'free.x'\n",
     ErrorCode::unsupported, "p.toml:24:8: error: map 2: an envelope's time is read once"},
    {"AnEnvelopesTimeFromAnLfo",
     "[lfos.w]\ncurve = 'ring'\n[[maps]]\nfrom = 'w'\nto = 'envelope.amp.time'\n",
     ErrorCode::unsupported, "p.toml:21:8: error: map 1: an envelope's time is read once"},
    {"ANumberOfACurveOverTime",
     "[lfos.w]\ncurve = 'timed'\n[[maps]]\nfrom = 'mod'\nto = 'curve.timed.point.1.y'\n"
     "low = 0\nhigh = 1\n",
     ErrorCode::unsupported,
     "p.toml:22:6: error: map 1: it moves a number of curve 'timed' (lfo 'w')"},
    {"CyclesNobodyRead",
     "[oscillators.b]\nlevel_db = -6\nwave_file = '" KNOTWAVE_SOURCE_DIR "/README.md'\n",
     ErrorCode::file_not_found, "p.toml:20:13: error: oscillator 'b': the cycles of "},
};

class CompileFault : public testing::TestWithParam<Fault> {};

TEST_P(CompileFault, IsToldWhereItIsWritten) {
  const Fault& fault = GetParam();
  std::string tables = fault.tables;
  if (tables.find("'many'") != std::string::npos) tables += many_points();
  const Error error = error_of(std::string(kHead) + tables);
  EXPECT_EQ(error.code, fault.code);
  EXPECT_THAT(error.to_string(), testing::StartsWith(fault.report));
}

INSTANTIATE_TEST_SUITE_P(Faults, CompileFault, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return std::string(fault.param.name); });

TEST(CompileFaults, AGlideIsToldAtItsKey) {
  std::string text(kHead);
  text.insert(text.find("[curves.ring]"), "glide_s = 1\nglide_curve = 'upright'\n");
  EXPECT_THAT(error_of(text).to_string(), testing::StartsWith("p.toml:4:15: error: glide: "));
}

TEST(CompileFaults, TheNameOfThePatchIsInTheMessageAndInlineTablesHavePlacesToo) {
  std::string text(kHead);
  text.insert(text.find("[curves.ring]"), "name = 'Bell'\nlfos = {w = {curve = 'upright'}}\n");
  EXPECT_THAT(error_of(text).to_string(),
              testing::StartsWith("p.toml:4:22: error: patch 'Bell': lfo 'w': "));
}

TEST(CompileFaults, ASpecOfNoFileHasNoPlace) {
  auto spec = parse_patch(kHead, "p.toml");
  ASSERT_TRUE(spec);
  spec->places.clear();
  spec->envelopes[0].curve = "upright";
  const auto program = PatchProgram::create(*spec);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().line, 0);
  EXPECT_THAT(program.error().to_string(), testing::StartsWith("p.toml: error: envelope 'amp': "));
}

TEST(CompileFaults, PlacesFallBackToTheTableAndTheFile) {
  const auto spec =
      parse_patch(std::string(kHead) + "[[maps]]\nfrom = 'mod'\nto = 'amp'\n", "p.toml");
  ASSERT_TRUE(spec);
  const auto line = [&](std::string_view path) { return spec->place_of(path).line; };
  EXPECT_EQ(line("envelopes.amp.curve"), 17);
  EXPECT_EQ(line("envelopes.amp.sustain_at"), line("envelopes.amp"));
  EXPECT_EQ(line("maps.0.to"), 20);
  EXPECT_EQ(line("maps.0.curve"), 18);
  EXPECT_EQ(line("shaper.curve"), 1);
}

TEST(ReadFaults, AReleaseBeforeTheSustainIsToldAtTheRelease) {
  const auto spec =
      parse_patch(std::string(kHead) + "sustain_at = 0.5\nrelease_at = 0.25\n", "p.toml");
  ASSERT_FALSE(spec);
  EXPECT_EQ(spec.error().to_string(),
            "p.toml:19:14: error: envelope 'amp': release_at (0.25) is before sustain_at (0.5)");
}

class FaultFolder : public testing::Test {
 protected:
  FaultFolder()
      : path_(fs::temp_directory_path() / ("knotwave_fault_test_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~FaultFolder() override {
    std::error_code failed;
    fs::remove_all(path_, failed);
  }
  std::string write(const std::string& name, std::string_view text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }

 private:
  fs::path path_;
};

TEST_F(FaultFolder, APatchOfABankIsToldInItsOwnFile) {
  const std::string patch = write("p.toml", std::string(kHead) + "[lfos.w]\ncurve = 'upright'\n");
  const auto spec = read_bank(
      write("b.toml", "format = 1\nkind = 'bank'\n[[programs]]\nprogram = 3\npatch = 'p.toml'\n"));
  ASSERT_TRUE(spec) << spec.error().to_string();
  const auto bank = BankProgram::create(*spec);
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::StartsWith(patch + ":19:9: error: lfo 'w': "));
}

TEST_F(FaultFolder, ATuningThatLeavesTheRangeIsToldInItsOwnFile) {
  const std::string scale =
      write("big.scl", "! too far\nlarge steps\n1\n! eight octaves\n 9600.\n");
  const auto spec = read_bank(write("p.toml", "tuning = 'big.scl'\n" + std::string(kHead)));
  ASSERT_FALSE(spec);
  EXPECT_THAT(spec.error().to_string(), testing::StartsWith(scale + ":5:2: error: note "));
}

}  // namespace
}  // namespace knotwave::engine

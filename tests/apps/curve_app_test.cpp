// SPDX-License-Identifier: MIT
// knotwave-curve as a user runs it.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/curve_file.h"

#include "support/program.h"

namespace {

using namespace knotwave;
using support::ProgramRun;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kCurves = R"(format = 1
kind = "curve"

[curves.ramp]
degree = 1
points = [0, 1]

[curves.arc]
degree  = 2
points  = [[1, 0], [1, 1], [0, 1]]
weights = [1, 1, 2]

[curves.wave]
degree   = 3
periodic = true
points   = [0, 1, 0, -1]

[surfaces.sheet]
degree_u = 1
degree_v = 1
points   = [[0, 1], [2, 7]]
)";

class CurveApp : public testing::Test {
 protected:
  void SetUp() override {
    file_ = folder_.file("shapes.toml");
    ASSERT_TRUE(base::write_file(file_, kCurves));
  }
  ProgramRun run(std::vector<std::string> words) {
    words.insert(words.begin(), "knotwave-curve");
    return support::run_program(words);
  }
  support::ScratchFolder folder_;
  std::string file_;
};

TEST_F(CurveApp, SaysItsVersionAndItsHelp) {
  EXPECT_THAT(run({"--version"}).out, StartsWith("knotwave-curve "));
  for (const char* word : {"check", "info", "eval", "plot"}) {
    EXPECT_THAT(run({"--help"}).out, HasSubstr(word));
    const ProgramRun help = run({word, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("FILE"));
  }
}

TEST_F(CurveApp, TheHelpOfEvalShowsWhatItPrints) {
  std::string help = run({"eval", "--help"}).out;
  const auto same = [](char a, char b) { return a == ' ' && b == ' '; };
  help.erase(std::unique(help.begin(), help.end(), same), help.end());
  std::string printed = run({"eval", KNOTWAVE_SOURCE_DIR "/examples/curves/decay.toml#decay60",
                             "--at", "0,0.25,1", "--derivatives", "1"})
                            .out;
  EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 3);
  std::replace(printed.begin(), printed.end(), '\t', ' ');
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);)
    EXPECT_THAT(help, HasSubstr(" " + line + "\n"));
  EXPECT_THAT(help, HasSubstr("decay.toml#decay60 --at 0,0.25,1 --derivatives 1\n"));
}

TEST_F(CurveApp, ChecksEveryKindOfFileThatIsShipped) {
  std::vector<std::string> files = {"check"};
  const std::string examples = KNOTWAVE_SOURCE_DIR "/examples";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(examples)) {
    const bool is_of_plugins = entry.path().parent_path().filename() == "plugins";  // their own
    if (entry.path().extension() != ".toml" || is_of_plugins) continue;
    files.push_back(entry.path().string());
  }
  ASSERT_GT(files.size(), 70u);
  const ProgramRun checked = run(files);
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  for (std::size_t i = 1; i < files.size(); ++i) {
    EXPECT_THAT(checked.out, HasSubstr(files[i] + ": ok: "));
  }
}

TEST_F(CurveApp, ChecksMidiLearnFiles) {
  const std::string path = folder_.file("desk.toml");
  ASSERT_TRUE(base::write_file(path,
                               "format = 1\nkind = \"midi-learn\"\n[[knobs]]\nfrom = 21\n"
                               "to = 74\n"));
  EXPECT_EQ(run({"check", path}).out, path + ": ok: MIDI learn file, 1 knob\n");
  EXPECT_THAT(run({"info", path}).err, HasSubstr("a MIDI learn file holds no curves"));
  ASSERT_TRUE(base::write_file(path, "format = 1\nkind = \"midi-learn\"\nknob = 3\n"));
  const ProgramRun wrong = run({"check", path});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr(path + ":3:1: error: MIDI learn file: unknown key 'knob'"));
}

TEST_F(CurveApp, ChecksCalibrations) {
  const std::string path = folder_.file("es9.toml");
  const std::string head = "format = 1\nkind = \"calibration\"\n";
  ASSERT_TRUE(base::write_file(path, head + "[[channels]]\nvolts_full_scale = 10.1\n"
                                            "[[channels]]\noffset_v = 0.2\n"));
  EXPECT_EQ(run({"check", path}).out, path + ": ok: calibration, 2 channels\n");
  EXPECT_THAT(run({"info", path}).err, HasSubstr("a calibration holds no curves"));
  ASSERT_TRUE(base::write_file(path, head + "[[channels]]\nvolts_full_scale = 0\n"));
  const ProgramRun wrong = run({"check", path});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr(path + ":4:20: error: channel 1: volts_full_scale"));
}

TEST_F(CurveApp, CheckNamesThePlaceOfAFaultAndGoesOn) {
  const std::string bad = folder_.file("bad.toml");
  ASSERT_TRUE(base::write_file(bad,
                               "format = 1\nkind = \"curve\"\n[curves.x]\ndegree = 1\n"
                               "points = [0, 1, 2]\nknots = [0, 0, 0.5, 0.4, 1]\n"));
  const ProgramRun checked = run({"check", bad, file_});
  EXPECT_EQ(checked.exit_code, 1);
  EXPECT_EQ(checked.err, bad + ":6:21: error: curve 'x': knot 3 (0.4) is below knot 2 (0.5)\n");
  EXPECT_EQ(checked.out, file_ + ": ok: curve file, 3 curves, 1 surface\n");
  EXPECT_EQ(run({"check", folder_.file("none.toml")}).exit_code, 1);
}

TEST_F(CurveApp, CheckCompilesWhatItCallsOk) {
  const auto checked = [&](const std::string& curve, const std::string& more = "") {
    const std::string path = folder_.file("p.toml");
    EXPECT_TRUE(base::write_file(path,
                                 "format = 1\nkind = 'patch'\n[oscillators.a]\nwave = 'sine'\n"
                                 "[envelopes.amp]\ncurve = 'c'\n[curves.c]\n" +
                                     curve + more));
    const ProgramRun done = run({"check", path});
    EXPECT_EQ(done.exit_code, done.err.empty() ? 0 : 1);
    return done.err.substr(std::min(path.size() + 1, done.err.size()));
  };
  const std::string arch = "degree = 2\npoints = [0, 1, 0]\nweights = [1, 5, 1]\n";
  EXPECT_EQ(checked(arch), "");
  EXPECT_EQ(checked("degree = 8\npoints = [0, 1, 1, 1, 1, 1, 1, 1, 0]\n"), "");
  EXPECT_THAT(checked("degree = 1\npoints = [0, 1, 1, 0]\nknots = [0, 0, 1e-300, 0.5, 1, 1]\n"),
              StartsWith("10:16: error: curve 'c': knot 2 (1e-300) is above knot 1 (0) by less"));
  EXPECT_THAT(
      checked(arch, "[[maps]]\nfrom = 'mod'\nto = 'curve.c.weight.1'\nlow = 6\nhigh = 10\n"),
      StartsWith("14:7: error: map 1: low (6) to high (10) leaves out 5"));
}

TEST_F(CurveApp, EvalPrintsTabsAnd17Digits) {
  EXPECT_EQ(run({"eval", file_ + "#arc", "--at", "0,0.5,1"}).out,
            "0\t1\t0\n"
            "0.5\t0.59999999999999998\t0.80000000000000004\n"
            "1\t0\t1\n");
  EXPECT_EQ(run({"eval", file_ + "#arc", "--at", "0", "--derivatives", "2"}).out,
            "0\t1\t0\t0\t2\t-4\t0\n");
  EXPECT_EQ(run({"eval", file_ + "#sheet", "--at", "0.5:0.5,1:1"}).out, "0.5\t0.5\t2.5\n1\t1\t7\n");
  EXPECT_EQ(run({"eval", file_ + "#sheet", "--at", "0.5:0.5", "--derivatives", "2"}).out,
            "0.5\t0.5\t2.5\t3\t4\t0\t4\t0\n");
}

TEST_F(CurveApp, EvalGridHasNPlusOneRowsWithExactEnds) {
  const ProgramRun grid = run({"eval", file_ + "#ramp", "--grid", "7"});
  std::istringstream lines(grid.out);
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  ASSERT_EQ(rows.size(), 8u);
  EXPECT_EQ(rows.front(), "0\t0");
  EXPECT_EQ(rows.back(), "1\t1");
}

// What eval prints, read back, is what the library computes.
TEST_F(CurveApp, EvalReadsBackToTheSameDoubles) {
  const auto set = curves::parse_curves(kCurves, "text");
  ASSERT_TRUE(set);
  const auto* wave = set->find_curve("wave");
  std::istringstream numbers(run({"eval", file_ + "#wave", "--grid", "100"}).out);
  int rows = 0;
  for (double u = 0, value = 0; numbers >> u >> value; ++rows) {
    double expected;
    wave->evaluate(u, std::span(&expected, 1));
    EXPECT_EQ(value, expected);
  }
  EXPECT_EQ(rows, 101);
}

TEST_F(CurveApp, JsonIsReadByAnotherReader) {
  const std::string reader =
      "import json, subprocess, sys\n"
      "d = json.loads(subprocess.check_output([sys.argv[1], 'eval', sys.argv[2] + '#arc', '--at',"
      " '0', '--derivatives', '1', '--json']))\n"
      "assert d == {'name': 'arc', 'rows': [{'u': 0, 'value': [1, 0], 'derivatives': [[0, 2]]}]}, "
      "d\n"
      "d = json.loads(subprocess.check_output([sys.argv[1], 'info', sys.argv[2], '--json']))\n"
      "assert [x.get('curve', x.get('surface')) for x in d] == ['ramp', 'arc', 'wave', 'sheet'], "
      "d\n"
      "assert d[1]['rational'] is True and d[1]['weights'] == [1, 2], d\n";
  const ProgramRun read = support::run_program(
      {"/usr/bin/python3", "-c", reader, KNOTWAVE_BIN_DIR "/knotwave-curve", file_});
  EXPECT_EQ(read.exit_code, 0) << read.err;
}

// A slope there is beyond all doubles, and JSON has no word for that: it is the largest double.
TEST_F(CurveApp, JsonOfTheSteepestShapesIsReadByAStrictReader) {
  const std::string steep = folder_.file("steep.toml");
  ASSERT_TRUE(base::write_file(steep, R"(format = 1
kind = "curve"
[curves.line]
degree = 1
points = [-1e6, 1e6, 0]
knots = [0, 0, 1e-280, 1, 1]
[curves.bell]
degree = 2
points = [0, 1e6, -1e6, 0]
weights = [1e-6, 1e6, 1e-6, 1e6]
knots = [0, 0, 0, 1e-280, 1, 1, 1]
[surfaces.cliff]
degree_u = 2
degree_v = 1
points = [[0, 1e6, -1e6, 0], [1e6, 0, 0, -1e6]]
weights = [[1e-6, 1e6, 1e-6, 1e6], [1, 1, 1e-6, 1]]
knots_u = [0, 0, 0, 1e-280, 1, 1, 1]
knots_v = [0, 0, 1e-280, 1e-280]
)"));
  const std::string reader =
      "import json, subprocess, sys\n"
      "def refuse(word): raise ValueError(word + ' is no JSON')\n"
      "def numbers(x):\n"
      "  for y in x: yield from numbers(y) if isinstance(y, list) else [y]\n"
      "for name, at, order in (('line', '0,5e-281,1', 15), ('bell', '0,5e-281,1e-280,1', 15),\n"
      "                        ('cliff', '0:0,5e-281:5e-281,1:1e-280', 15)):\n"
      "  d = json.loads(subprocess.check_output([sys.argv[1], 'eval', sys.argv[2] + '#' + name,\n"
      "    '--at', at, '--derivatives', str(order), '--json']), parse_constant=refuse)\n"
      "  for row in d['rows']:\n"
      "    for x in numbers(row['value'] + row['derivatives']):\n"
      "      assert abs(x) < float('inf'), row\n"
      "json.loads(subprocess.check_output([sys.argv[1], 'info', sys.argv[2], '--json']),\n"
      "           parse_constant=refuse)\n";
  const ProgramRun read = support::run_program(
      {"/usr/bin/python3", "-c", reader, KNOTWAVE_BIN_DIR "/knotwave-curve", steep});
  EXPECT_EQ(read.exit_code, 0) << read.err;
}

TEST_F(CurveApp, InfoTellsWhatACurveIs) {
  const std::string arc = run({"info", file_ + "#arc"}).out;
  EXPECT_THAT(arc, HasSubstr("degree         2\n"));
  EXPECT_THAT(arc, HasSubstr("weights        1 .. 2\n"));
  EXPECT_THAT(arc, HasSubstr("knots          0 x3, 1 x3\n"));
  EXPECT_THAT(arc, HasSubstr("function of x  no\n"));
  EXPECT_THAT(arc, HasSubstr("smoothness     one rational piece\n"));
  EXPECT_THAT(run({"info", file_ + "#ramp"}).out, HasSubstr("one polynomial piece\n"));
  EXPECT_THAT(run({"info", file_ + "#wave"}).out, HasSubstr("smoothness   C2\n"));
}

// docs/curves.md, Periodic curves: the first point of a cubic pulls one span before the seam.
TEST_F(CurveApp, APeriodicCubicIsHighestWhereItsHighestPointPulls) {
  const auto wave = *curves::parse_curves(kCurves, "text")->find_curve("wave");
  EXPECT_EQ(greville_abscissae(wave)[0], -0.25);
  EXPECT_EQ(greville_abscissae(wave)[1], 0);
  EXPECT_EQ(run({"eval", file_ + "#wave", "--at", "0,0.25,0.5,0.75"}).out,
            "0\t0.66666666666666663\n0.25\t0\n0.5\t-0.66666666666666663\n0.75\t0\n");
}

TEST_F(CurveApp, AFileWhoseNameHoldsTheMarkIsOpened) {
  const std::string odd = folder_.file("a#arc");
  ASSERT_TRUE(base::write_file(odd, kCurves));
  EXPECT_EQ(run({"eval", odd + "#arc", "--at", "1"}).out, "1\t0\t1\n");
  EXPECT_THAT(run({"info", odd}).out, HasSubstr("surface          sheet\n"));
}

// What README.md says of its bell.
TEST_F(CurveApp, TheBellOfTheReadmeGrowsAsItSays) {
  const auto readme = base::read_file(KNOTWAVE_SOURCE_DIR "/README.md", 1 << 20);
  const auto tell = [this](const std::string& weight) {
    const std::string bell = folder_.file("bell.toml");
    EXPECT_TRUE(base::write_file(bell,
                                 "format = 1\nkind = \"curve\"\n[curves.bell]\ndegree = 3\n"
                                 "points = [0, 0, 1, 0, 0]\nweights = [1, 1, " +
                                     weight + ", 1, 1]\n"));
    std::istringstream table(run({"eval", bell, "--grid", "4000"}).out);
    std::vector<double> values;
    for (double u = 0, value = 0; table >> u >> value;) values.push_back(value);
    const double height = *std::max_element(values.begin(), values.end());
    const auto above = std::count_if(values.begin(), values.end(),
                                     [height](double value) { return value >= height / 2; });
    char text[40];
    std::snprintf(text, sizeof text, "%.2f %.2f", height, double(above) / 4000);
    return std::string(text);
  };
  EXPECT_EQ(tell("4"), "0.80 0.65");
  EXPECT_EQ(tell("64"), "0.98 0.90");
  EXPECT_THAT(*readme, HasSubstr("weights = [1, 1, 4, 1, 1]"));
  EXPECT_THAT(*readme, HasSubstr("from 4 to 64: the bell grows from 0.80 high to 0.98, and at half "
                                 "its height from 0.65 wide\nto 0.90."));
}

TEST_F(CurveApp, PlotWritesTheFileItsEndingAsksForOrText) {
  const std::string svg = folder_.file("a.svg"), png = folder_.file("a.png");
  EXPECT_EQ(run({"plot", file_ + "#arc", "-o", svg}).exit_code, 0);
  EXPECT_THAT(*base::read_file(svg, 1 << 24), StartsWith("<svg "));
  EXPECT_EQ(run({"plot", file_ + "#sheet", "-o", png, "--size", "400x300"}).out,
            png + ": sheet, 400 x 300\n");
  EXPECT_THAT(*base::read_file(png, 1 << 24), StartsWith("\x89PNG"));
  ASSERT_EQ(run({"plot", file_ + "#arc", "-o", folder_.file("b.SVG")}).exit_code, 0);
  EXPECT_EQ(*base::read_file(folder_.file("b.SVG"), 1 << 24), *base::read_file(svg, 1 << 24));
  EXPECT_THAT(run({"plot", file_ + "#wave"}).out,
              StartsWith("wave  degree 3, 4 points, periodic\n"));
}

// tools/make_curve_pictures.py draws them; docs/curves.md shows them.
TEST_F(CurveApp, PicturesOfTheDocumentationAreWhatItDraws) {
  const std::string folder = KNOTWAVE_SOURCE_DIR "/docs/pictures/";
  const auto set = curves::read_curves(folder + "curves.toml");
  ASSERT_TRUE(set) << set.error().to_string();
  ASSERT_GE(set->names().size(), 8u);
  for (const auto name : set->names()) {
    const std::string picture = std::string(name) + ".svg", drawn = folder_.file(picture);
    ASSERT_EQ(run({"plot", folder + "curves.toml#" + std::string(name), "-o", drawn}).exit_code, 0);
    const auto committed = base::read_file(folder + picture, 1 << 24);
    ASSERT_TRUE(committed) << committed.error().message;
    EXPECT_TRUE(*committed == *base::read_file(drawn, 1 << 24)) << picture;
  }
}

TEST_F(CurveApp, AQuestionTheFileCannotAnswerEndsWith2) {
  const auto says = [&](std::vector<std::string> words, const std::string& message) {
    const ProgramRun wrong = run(words);
    EXPECT_EQ(wrong.exit_code, 2) << message;
    EXPECT_EQ(wrong.out, "");
    EXPECT_THAT(wrong.err, HasSubstr(message));
  };
  says({"eval", file_ + "#arc", "--at", "0:1"}, "--at u:v is for surfaces");
  says({"eval", file_ + "#sheet", "--at", "0"}, "a surface takes --at u:v");
  says({"eval", file_, "--at", "0"}, "which one? add #NAME; there are ramp, arc, wave, sheet");
}

TEST_F(CurveApp, FailuresEndWith1AndNameTheFile) {
  const auto says = [&](std::vector<std::string> words, const std::string& message) {
    const ProgramRun failed = run(words);
    EXPECT_EQ(failed.exit_code, 1) << message;
    EXPECT_EQ(failed.out, "");
    EXPECT_EQ(failed.err, message + "\n");
  };
  says({"eval", file_ + "#ark", "--at", "0"},
       file_ + ": error: there is no 'ark'; did you mean 'arc'?");
  const std::string decays = KNOTWAVE_SOURCE_DIR "/examples/curves/decay.toml";
  says({"info", decays + "#deca"},
       decays +
           ": error: there is no 'deca'; did you mean 'decay60', 'decay60_light' or "
           "'decay60_unweighted'?");
  says({"check", file_ + "#arc"},
       file_ + "#arc: error: no such file; check reads whole files: leave out '#arc'");
  says({"eval", file_ + "#nothing", "--at", "0"},
       file_ + ": error: there is no 'nothing'; there are ramp, arc, wave, sheet");
  says({"eval", file_ + "#arc", "--at", "1.5"}, file_ + "#arc: error: u = 1.5 is outside 0..1");
  says({"eval", file_ + "#sheet", "--at", "0:2"}, file_ + "#sheet: error: v = 2 is outside 0..1");
  EXPECT_EQ(run({"plot", file_ + "#arc", "-o", folder_.file("none/a.svg")}).exit_code, 1);
}

}  // namespace

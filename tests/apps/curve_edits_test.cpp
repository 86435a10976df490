// SPDX-License-Identifier: MIT
// The commands of knotwave-curve that make curves of curves, as a user runs them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/io/sound_file.h"

#include "support/program.h"

namespace {

using namespace knotwave;
using curves::CurveSet;
using curves::NurbsCurve;
using support::ProgramRun;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kShapes = R"(format = 1
kind = "curve"

[curves.ramp]
degree = 1
points = [0, 1]

[curves.line]
degree  = 3
points  = [0.1, 0.9, -0.7, 0.3, 1.1, -0.2, 0.6, 0.5]
knots   = [0, 0, 0, 0, 0.2, 0.3, 0.3, 0.7, 1, 1, 1, 1]

[curves.steps]
degree = 2
points = [0, 1, 0.5, -1, 0.25, 0]
knots  = [0, 0, 0, 0.4, 0.4, 0.4, 1, 1, 1]
jumps  = [0.4]

[curves.arc]
degree  = 2
points  = [[1, 0], [1, 1], [0, 1]]
weights = [1, 1, 2]

[curves.wave]
degree   = 3
periodic = true
points   = [0, 1, 0.3, -1, 0.1, 0.2]

[surfaces.sheet]
degree_u = 2
degree_v = 1
points   = [[0, 1, 3], [2, 7, 1], [0.5, 1, 0]]
weights  = [[1, 2, 1], [1, 1, 3], [1, 1, 1]]
)";

double largest_coordinate(std::span<const double> points) {
  double largest = 0;
  for (const double x : points) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Largest distance of both over the domain of `part`, and at its knots from both sides.
double distance(const NurbsCurve& whole, const NurbsCurve& part) {
  double most = 0;
  const auto look = [&](double u, curves::Side side) {
    double a[curves::kMaxDim], b[curves::kMaxDim], square = 0;
    whole.evaluate(u, side, a);
    part.evaluate(u, side, b);
    for (int c = 0; c < whole.dim(); ++c) square += (a[c] - b[c]) * (a[c] - b[c]);
    most = std::max(most, std::sqrt(square));
  };
  for (int i = 0; i <= 2000; ++i) {
    look(part.u_min() + (part.u_max() - part.u_min()) * i / 2000.0,
         i == 0 ? curves::Side::right : curves::Side::left);
  }
  for (const double knot : part.knots()) {
    if (!(knot > part.u_min() && knot < part.u_max())) continue;
    look(knot, curves::Side::left);
    look(knot, curves::Side::right);
  }
  return most;
}

class CurveEdits : public testing::Test {
 protected:
  void SetUp() override {
    file_ = folder_.file("shapes.toml");
    ASSERT_TRUE(base::write_file(file_, kShapes));
    shapes_ = *curves::parse_curves(kShapes, "text");
  }
  ProgramRun run(std::vector<std::string> words) {
    words.insert(words.begin(), "knotwave-curve");
    return support::run_program(words);
  }
  /// What the command writes to a file, read again.
  CurveSet made(std::vector<std::string> words) {
    const std::string output = folder_.file("made.toml");
    words.insert(words.end(), {"-o", output});
    const ProgramRun done = run(words);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(done.err, "");
    EXPECT_THAT(done.out, StartsWith(output + ": written\n"));
    report_ = done.out.substr(done.out.find('\n') + 1);
    auto set = curves::read_curves(output);
    EXPECT_TRUE(set) << set.error().to_string();
    return *std::move(set);
  }
  const NurbsCurve& shape(const std::string& name) { return *shapes_.find_curve(name); }
  /// Values of the curve that was given and of what was made agree within 4 ulp of max|P|.
  void expect_same(const std::string& name, const NurbsCurve& after) {
    const double bound = 4 * 0x1p-53 * 2 * largest_coordinate(shape(name).points());
    EXPECT_LE(distance(shape(name), after), bound) << name;
  }

  support::ScratchFolder folder_;
  std::string file_, report_;
  CurveSet shapes_;
};

TEST_F(CurveEdits, SplitKeepsEveryValueAndCutsTheDomain) {
  for (const char* name : {"line", "steps", "arc", "wave"}) {
    const auto set = made({"split", file_ + "#" + name, "--at", "0.4"});
    ASSERT_EQ(set.curves.size(), 2u);
    EXPECT_EQ(set.curves[0].name(), std::string(name) + "_left");
    EXPECT_EQ(set.curves[1].name(), std::string(name) + "_right");
    EXPECT_EQ(set.curves[0].u_max(), 0.4);
    EXPECT_EQ(set.curves[1].u_min(), 0.4);
    expect_same(name, set.curves[0]);
    expect_same(name, set.curves[1]);
  }
  EXPECT_THAT(report_, HasSubstr("wave_left: degree 3, "));
  EXPECT_EQ(made({"split", file_ + "#arc", "--at", "0.5", "--name", "q"}).names()[1], "q_right");
}

TEST_F(CurveEdits, InsertedKnotsAreThereAndChangeNothing) {
  for (const char* name : {"line", "steps", "arc", "wave"}) {
    const auto set = made({"insert-knot", file_ + "#" + name, "--at", "0.6,0.15", "--times", "2"});
    const auto knots = set.curves.front().knots();
    EXPECT_EQ(std::count(knots.begin(), knots.end(), 0.6), 2) << name;
    EXPECT_EQ(std::count(knots.begin(), knots.end(), 0.15), 2) << name;
    EXPECT_EQ(set.curves.front().name(), name);
    expect_same(name, set.curves.front());
  }
}

TEST_F(CurveEdits, AHigherDegreeIsTheSameCurve) {
  for (const char* name : {"ramp", "line", "steps", "arc", "wave"}) {
    const auto set = made({"elevate", file_ + "#" + name, "--times", "3"});
    EXPECT_EQ(set.curves.front().degree(), shape(name).degree() + 3);
    EXPECT_EQ(set.curves.front().is_periodic(), shape(name).is_periodic());
    expect_same(name, set.curves.front());
  }
}

TEST_F(CurveEdits, SurfacesAreEditedAlongADirection) {
  const auto* sheet = shapes_.find_surface("sheet");
  const auto expect_same_sheet = [&](const curves::NurbsSurface& after) {
    for (int i = 0; i <= 100; ++i) {
      for (int j = 0; j <= 100; ++j) {
        const double u = after.u_min() + (after.u_max() - after.u_min()) * i / 100.0;
        const double v = after.v_min() + (after.v_max() - after.v_min()) * j / 100.0;
        double a, b;
        sheet->evaluate(u, v, {&a, 1});
        after.evaluate(u, v, {&b, 1});
        ASSERT_NEAR(a, b, 4 * 0x1p-50) << u << " " << v;  // ulp(7) = 2^-50
      }
    }
  };
  for (const char* direction : {"u", "v"}) {
    const auto halves = made({"split", file_ + "#sheet", "--at", "0.25", "--direction", direction});
    ASSERT_EQ(halves.surfaces.size(), 2u);
    EXPECT_EQ(halves.surfaces[0].name(), "sheet_low");
    expect_same_sheet(halves.surfaces[0]);
    expect_same_sheet(halves.surfaces[1]);
    expect_same_sheet(
        made({"insert-knot", file_ + "#sheet", "--at", "0.25", "--direction", direction})
            .surfaces[0]);
    const auto raised = made({"elevate", file_ + "#sheet", "--direction", direction});
    EXPECT_EQ(raised.surfaces[0].degree_u() + raised.surfaces[0].degree_v(), 4);
    expect_same_sheet(raised.surfaces[0]);
  }
}

TEST_F(CurveEdits, IsoCurvesLieOnTheSurface) {
  const auto* sheet = shapes_.find_surface("sheet");
  const auto rows = made({"iso", file_ + "#sheet", "--v", "0,0.3,1"});
  EXPECT_THAT(rows.names(), ElementsAre("sheet_1", "sheet_2", "sheet_3"));
  const auto column = made({"iso", file_ + "#sheet", "--u", "0.7"});
  EXPECT_THAT(column.names(), ElementsAre("sheet"));
  for (int i = 0; i <= 50; ++i) {
    double on_sheet, on_curve;
    sheet->evaluate(i / 50.0, 0.3, {&on_sheet, 1});
    rows.curves[1].evaluate(i / 50.0, {&on_curve, 1});
    EXPECT_NEAR(on_sheet, on_curve, 4 * 0x1p-50);
    sheet->evaluate(0.7, i / 50.0, {&on_sheet, 1});
    column.curves[0].evaluate(i / 50.0, {&on_curve, 1});
    EXPECT_NEAR(on_sheet, on_curve, 4 * 0x1p-50);
  }
}

TEST_F(CurveEdits, SimplifyStaysWithinWhatItSaysAndWhatWasAsked) {
  const std::string reed = KNOTWAVE_SOURCE_DIR "/examples/curves/waves.toml#reed";
  const auto whole =
      *curves::read_curves(KNOTWAVE_SOURCE_DIR "/examples/curves/waves.toml")->find_curve("reed");
  std::size_t last = whole.points().size();
  for (const double within_db : {-60.0, -40.0, -20.0, -10.0}) {
    const auto thin =
        made({"simplify", reed, "--within", std::to_string(within_db)}).curves.front();
    std::smatch said;
    ASSERT_TRUE(
        std::regex_search(report_, said, std::regex("farther off than (\\S+) \\((\\S+) dB")))
        << report_;
    // Printed with 3 digits, and both values are rounded here.
    EXPECT_LE(distance(whole, thin), std::stod(said[1]) * 1.005 + 0x1p-52);
    EXPECT_LE(std::stod(said[2]), within_db);
    EXPECT_LE(thin.points().size(), last);
    last = thin.points().size();
  }
  EXPECT_LT(last, whole.points().size());
}

TEST_F(CurveEdits, SimplifyUndoesInsertAndElevate) {
  const std::string finer = folder_.file("finer.toml");
  ASSERT_EQ(run({"insert-knot", file_ + "#line", "--at", "0.1,0.55", "-o", finer}).exit_code, 0);
  EXPECT_EQ(run({"elevate", finer, "-o", folder_.file("higher.toml")}).exit_code, 0);
  const auto back =
      made({"simplify", folder_.file("higher.toml"), "--degree", "3", "--within", "-240"});
  EXPECT_THAT(report_, HasSubstr("16 points before; nowhere farther off than "));
  EXPECT_TRUE(std::ranges::equal(back.curves.front().knots(), shape("line").knots()));
  EXPECT_LE(distance(shape("line"), back.curves.front()), 1e-14);
}

TEST_F(CurveEdits, MorphEndsEqualItsInputsAndItsMiddleIsTheirMean) {
  const std::string one = file_ + "#line", two = file_ + "#wave";
  const auto at = [&](const char* amount) {
    return made({"morph", one, two, "--amount", amount, "--name", "m"}).curves.front();
  };
  expect_same("line", at("0"));
  expect_same("wave", at("1"));
  const auto half = at("0.5");
  EXPECT_EQ(half.name(), "m");
  for (int i = 0; i <= 100; ++i) {
    double a, b, mean;
    shape("line").evaluate(i / 100.0, curves::Side::left, {&a, 1});
    shape("wave").evaluate(i / 100.0, curves::Side::left, {&b, 1});
    half.evaluate(i / 100.0, curves::Side::left, {&mean, 1});
    EXPECT_NEAR(mean, (a + b) / 2, 1e-15);
  }
}

TEST_F(CurveEdits, TheHelpOfMorphShowsThatTwoFilesAreNeeded) {
  EXPECT_THAT(run({"morph", "--help"}).out, HasSubstr(" FILE FILE\n"));
  EXPECT_THAT(run({"morph", "--help"}).out, Not(HasSubstr("FILE(")));
}

TEST_F(CurveEdits, WithoutAFileTheCurveGoesToStandardOutputAndTheReportBeside) {
  const ProgramRun plain = run({"elevate", file_ + "#ramp"});
  EXPECT_EQ(plain.out,
            "format = 1\nkind = \"curve\"\n\n[curves.ramp]\ndegree = 2\n"
            "points = [0, 0.5, 1]\n");
  EXPECT_EQ(plain.err, "ramp: degree 2, 3 points, u 0 to 1\n");
  EXPECT_EQ(run({"elevate", file_ + "#ramp", "-o", "-"}).out, plain.out);
  const ProgramRun full = support::run_program(
      {"/bin/sh", "-c", "exec " KNOTWAVE_BIN_DIR "/knotwave-curve elevate \"$0\" >/dev/full",
       file_ + "#ramp"});
  EXPECT_EQ(full.exit_code, 75);
  EXPECT_EQ(full.err,
            "knotwave-curve: error: cannot write to standard output: No space left on device\n");
}

TEST_F(CurveEdits, UsageErrorsEndWith2AndWriteNothing) {
  const auto says = [&](std::vector<std::string> words, const std::string& message) {
    const ProgramRun wrong = run(words);
    EXPECT_EQ(wrong.exit_code, 2) << message;
    EXPECT_EQ(wrong.out, "");
    EXPECT_THAT(wrong.err, HasSubstr(message));
    EXPECT_EQ(*base::read_file(file_, 1 << 20), kShapes);
  };
  const std::string line = file_ + "#line", sheet = file_ + "#sheet";
  says({"split", line}, "where? one place is needed: --at U");
  says({"split", line, "--at", "0.1,0.2"}, "where? one place is needed: --at U");
  says({"split", line, "--at", "x"}, "--at: 'x' is not a number");
  says({"insert-knot", line}, "where? --at U,U,...");
  says({"split", sheet, "--at", "0.5"}, "a surface takes --direction u or --direction v");
  says({"split", line, "--at", "0.5", "--direction", "u"}, "--direction is for surfaces");
  says({"split", line, "--at", "0.5", "--direction", "w"}, "'w' is not u or v");
  says({"simplify", sheet}, "simplify is for curves");
  says({"simplify", line, "--within", "6"}, "--within: '6' is not a number from -240 to 0");
  says({"simplify", line, "--degree", "4"}, "--degree 4 is above the degree of the curve, 3");
  says({"simplify", line, "--amount", "1"}, "--amount is an option of 'morph', not of 'simplify'");
  says({"morph", line}, "two curves are needed");
  says({"morph", line, line}, "how far? --amount 0 (the first) to 1 (the second)");
  says({"iso", line, "--v", "0"}, "iso is for surfaces");
  says({"iso", sheet}, "where? --u LIST or --v LIST");
  says({"iso", sheet, "--v", "0", "--u", "0"}, "--u and --v exclude each other");
  says({"elevate", line, "--name", "a b"}, "--name: 'a b' is not 1 to 64 letters");
  says({"split", line, "--at", "0.5", "--name", std::string(62, 'x')}, "gives a shorter one");
  says({"elevate", line, "-o", "x.svg"}, "--output: 'x.svg' does not end in .toml");
  says({"elevate", line, "-o", file_}, "would overwrite the file that is read");
  says({"elevate", line, "-o", folder_.path() + "/./shapes.toml"}, "would overwrite");
  says({"elevat", line}, "unknown command 'elevat'; did you mean 'elevate'?");
  says({"split", line, "--att", "0.5"}, "unknown option '--att'; did you mean '--at'?");
}

TEST_F(CurveEdits, FailuresEndWith1NameTheCurveAndLeaveAnOldFile) {
  const std::string old = folder_.file("old.toml");
  ASSERT_TRUE(base::write_file(old, "as it was"));
  const auto says = [&](std::vector<std::string> words, const std::string& message) {
    words.insert(words.end(), {"-o", old});
    const ProgramRun failed = run(words);
    EXPECT_EQ(failed.exit_code, 1) << message;
    EXPECT_EQ(failed.out, "");
    EXPECT_THAT(failed.err, HasSubstr(message));
    EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
    EXPECT_EQ(*base::read_file(old, 100), "as it was");
  };
  const std::string line = file_ + "#line";
  says({"split", line, "--at", "1"}, line + ": error: curve 'line': u = 1 is not strictly inside");
  says({"insert-knot", line, "--at", "0.3", "--times", "2"}, line + ": error: curve 'line'");
  says({"elevate", line, "--times", "14"}, line + ": error: curve 'line'");
  says({"simplify", line, "--degree", "1"},
       line + ": error: curve 'line': at degree 2 it is up to");
  says({"morph", line, file_ + "#arc", "--amount", "0.5"}, "1 and 2 coordinates");
  says({"iso", file_ + "#sheet", "--v", "2"}, file_ + "#sheet: error: v = 2 is outside 0..1");
  says({"split", file_ + "#lin", "--at", "0.5"}, "there is no 'lin'; did you mean 'line'?");
  EXPECT_EQ(run({"elevate", line, "-o", folder_.file("none/a.toml")}).exit_code, 1);
}

TEST_F(CurveEdits, EveryExampleOfTheHelpWorks) {
  std::filesystem::create_directory_symlink(KNOTWAVE_SOURCE_DIR "/examples",
                                            folder_.file("examples"));
  ASSERT_TRUE(base::write_file(folder_.file("fader.csv"), "s,level\n0,0\n0.5,1\n1,0.25\n2,0\n"));
  ASSERT_TRUE(base::write_file(folder_.file("drawing.svg"),
                               "<svg><path id='attack' d='M 0,0 C 1,-2 3,-4 9,-5'/></svg>"));
  auto sound = io::SoundWriter::create({folder_.file("cycle.wav"), 48000, 1});
  const std::vector<float> samples(100, 0.5F);
  ASSERT_TRUE(sound && sound->write(samples) && sound->finish());
  int examples = 0;
  for (const char* verb :
       {"split", "insert-knot", "elevate", "simplify", "morph", "iso", "fit", "import", "export"}) {
    const std::string help =
        std::regex_replace(run({verb, "--help"}).out, std::regex("\\\\\n *"), "");
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(std::min(line.size(), line.find("waves.toml#reed --amount")), 80u) << line;
      if (!line.starts_with("  knotwave-curve ")) continue;
      std::istringstream words(line);
      const std::vector<std::string> argv{std::istream_iterator<std::string>(words), {}};
      support::ProgramOptions options;
      options.folder = folder_.path();
      const ProgramRun done = support::run_program(argv, options);
      EXPECT_EQ(done.exit_code, 0) << line << "\n" << done.err;
      ++examples;
    }
  }
  EXPECT_EQ(examples, 11);
}

}  // namespace

// SPDX-License-Identifier: MIT
// knotwave-curve fit, import and export, as a user runs them.
#include <algorithm>
#include <cmath>
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
using curves::NurbsCurve;
using support::ProgramRun;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class CurveExchange : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    EXPECT_TRUE(base::write_file(folder_.file(name), text));
    return folder_.file(name);
  }
  ProgramRun run(std::vector<std::string> words) {
    words.insert(words.begin(), "knotwave-curve");
    return support::run_program(words);
  }
  /// What the command prints, read as a curve file.
  curves::CurveSet made(std::vector<std::string> words) {
    const ProgramRun done = run(words);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    report_ = done.err;
    auto set = curves::parse_curves(done.out, "standard output");
    EXPECT_TRUE(set) << set.error().to_string();
    return *std::move(set);
  }
  void expect_failure(std::vector<std::string> words, const std::string& message) {
    const ProgramRun failed = run(words);
    EXPECT_EQ(failed.exit_code, 1) << message;
    EXPECT_EQ(failed.out, "");
    EXPECT_THAT(failed.err, HasSubstr(message));
  }
  support::ScratchFolder folder_;
  std::string report_;
};

double value_at(const NurbsCurve& curve, double u) {
  double value;
  curve.evaluate(u, {&value, 1});
  return value;
}

// The straight lines between the data are the oracle: the bound holds on them, not only at data.
TEST_F(CurveExchange, AFitStaysWithinItsBoundBetweenTheDataToo) {
  std::ostringstream table;
  table << "# a fader\ntime,level\n";
  std::vector<double> times, levels;
  for (int i = 0; i <= 400; ++i) {
    times.push_back(i * 0.005 + (i % 3) * 0.001);
    levels.push_back(std::floor(1000 * std::sin(i * 0.02) * std::exp(-i * 0.004)) / 1000);
    table << times.back() << "," << levels.back() << "\n";
  }
  const std::string data = write("fader.csv", table.str());
  std::size_t last = 1000;
  for (const double within_db : {-60.0, -40.0, -20.0}) {
    const auto fit = made({"fit", data, "--within", std::to_string(within_db)}).curves.front();
    EXPECT_EQ(fit.name(), "fader");
    EXPECT_EQ(fit.u_min(), times.front());
    EXPECT_EQ(fit.u_max(), times.back());
    EXPECT_EQ(value_at(fit, fit.u_max()), levels.back());
    EXPECT_LT(fit.points().size(), last);
    last = fit.points().size();
    const double largest = *std::max_element(levels.begin(), levels.end());
    const double bound = std::pow(10, within_db / 20) * largest;
    double most = 0;
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      for (const double x : {0.0, 0.21, 0.5, 0.83}) {
        const double u = times[i] + x * (times[i + 1] - times[i]);
        most = std::max(most,
                        std::abs(value_at(fit, u) - (levels[i] + x * (levels[i + 1] - levels[i]))));
      }
    }
    EXPECT_LE(most, bound * (1 + 1e-12)) << within_db;
    EXPECT_THAT(report_, HasSubstr("401 data; between them too within "));
  }
}

TEST_F(CurveExchange, AFitWithSoManyPointsSaysHowNearItIs) {
  const std::string data = write("d.txt", "0 0\n1 1\n2 0\n3 1\n4 0\n");
  const auto exact = made({"fit", data, "--points", "5", "--name", "zig"}).curves.front();
  EXPECT_EQ(exact.points().size(), 5u);
  for (int i = 0; i <= 4; ++i) EXPECT_NEAR(value_at(exact, i), i % 2, 4e-16);
  EXPECT_EQ(made({"fit", data, "--points", "4", "--degree", "1"}).curves[0].degree(), 1);
  EXPECT_THAT(report_, HasSubstr("5 data; at them within "));
  const ProgramRun both = run({"fit", data, "--points", "4", "--within", "-3"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.err, HasSubstr("--within and --points exclude each other"));
}

TEST_F(CurveExchange, TablesAreReadAsPeopleWriteThem) {
  const auto points = [&](const std::string& text, const char* degree = "1") {
    const auto fit =
        made({"fit", write("t.csv", text), "--degree", degree, "--points", "2"}).curves[0];
    return std::vector<double>(fit.points().begin(), fit.points().end());
  };
  EXPECT_THAT(points("1,2\n3,4\n"), ElementsAre(2, 4));
  EXPECT_THAT(points("\xEF\xBB\xBFt; x; y\r\n0; 1; 2\r\n\r\n1; 3; 4\r\n"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(points("0\t5\n1\t6"), ElementsAre(5, 6));
  EXPECT_THAT(points("  0   5\n 1   -6e-1 \n"), ElementsAre(5, -0.6));
  EXPECT_THAT(points("7\n# a note\n9\n"), ElementsAre(7, 9));
}

// docs/curves.md, From the command line: of a curve and without derivatives.
TEST_F(CurveExchange, ATableOfEvalIsACurveAgain) {
  const std::string decay = KNOTWAVE_SOURCE_DIR "/examples/curves/decay.toml#decay60";
  const std::string table = write("d.tsv", run({"eval", decay, "--grid", "200"}).out);
  const auto fit = made({"fit", table, "--within", "-60"}).curves.front();
  const auto whole = *curves::read_curves(KNOTWAVE_SOURCE_DIR "/examples/curves/decay.toml")
                          ->find_curve("decay60");
  for (int i = 0; i <= 200; ++i) {
    EXPECT_NEAR(value_at(fit, i / 200.0), value_at(whole, i / 200.0), 1e-3 + 1e-12);
  }
}

TEST_F(CurveExchange, ATableOfEvalWithDerivativesIsAnotherCurveOrRefused) {
  const std::string curve = write("orbit.toml",
                                  "format = 1\nkind = \"curve\"\n[curves.orbit]\n"
                                  "degree = 3\npoints = [[0, 0], [1, 2], [2, -1], [3, 0]]\n");
  const auto table = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"eval", curve, "--grid", "8"};
    words.insert(words.end(), more.begin(), more.end());
    return write("t.tsv", run(words).out);
  };
  EXPECT_EQ(made({"fit", table({})}).curves.front().dim(), 2);
  const std::string with_slopes = table({"--derivatives", "1"});
  EXPECT_EQ(made({"fit", with_slopes}).curves.front().dim(), 4) << "a column is a coordinate";
  const std::string wide = table({"--derivatives", "2"});
  expect_failure({"fit", wide}, wide + ":1: error: 7 columns; a time and 1 to 4 values are read");
  EXPECT_THAT(run({"fit", "--help"}).out, HasSubstr("leave out --derivatives"));
}

TEST_F(CurveExchange, ASoundIsFittedOverSeconds) {
  const std::string path = folder_.file("cycle.wav");
  auto sound = io::SoundWriter::create({path, 1000, 2, io::SampleFormat::float32});
  std::vector<float> samples;
  for (int i = 0; i <= 100; ++i) {
    samples.push_back(float(std::sin(i * 0.0628)));
    samples.push_back(0.25F);
  }
  ASSERT_TRUE(sound && sound->write(samples) && sound->finish());
  const auto fit = made({"fit", path, "--points", "12"}).curves.front();
  EXPECT_EQ(fit.dim(), 2);
  EXPECT_EQ(fit.u_max(), 0.1);
  double place[2];
  fit.evaluate(0.025, place);
  EXPECT_NEAR(place[0], 1, 0.001);
  EXPECT_NEAR(place[1], 0.25, 1e-15);
  const auto near = made({"fit", path, "--within", "-40"}).curves.front();
  EXPECT_LT(near.point_count(), 12);
  near.evaluate(0.025, place);
  EXPECT_NEAR(place[0], 1, 0.01);
  EXPECT_NEAR(place[1], 0.25, 0.01);
}

TEST_F(CurveExchange, FaultsOfTablesSayWhere) {
  const auto fails = [&](const std::string& text, const std::string& message) {
    const std::string path = write("bad.csv", text);
    expect_failure({"fit", path}, path + message);
  };
  fails("t,x\n0,1\n1,two\n", ":3:3: error: 'two' is not a number (1.5, 2e-3)");
  fails("0;1,5\n1;2\n", ":1:3: error: '1,5' is not a number");
  fails("0,1\n1\n", ":2: error: 1 columns, but 2 in the rows before");
  fails("0,1,2,3,4,5\n", ":1: error: 6 columns; a time and 1 to 4 values are read");
  fails("t,x\n", ": error: no row of numbers");
  fails("0,1\n0,2\n", ": error: ");
  fails("0,1\n1,inf\n", ":2:3: error: 'inf' is not a number");
  fails("0,1,0\n1,2,1e7\n", ":2:5: error: datum 1 (1e+07) is outside -1e+06..1e+06");
  expect_failure({"fit", folder_.file("none.csv")}, "no such file");
  std::string many;
  for (int i = 0; i <= 1 << 18; ++i) many += "1\n";
  fails(many, ": error: 262145 data; a fit takes at most 262144");
}

constexpr const char* kDrawing = R"svg(<?xml version="1.0"?>
<!DOCTYPE svg [ <!ENTITY x "<path d='M 0 0 L 9 9'/>"> ]>
<!-- <path id="not" d="M 0 0 L 1 1"/> -->
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 50">
  <style><![CDATA[ path > a { } ]]></style>
  <g id="moved" transform="scale(2)">
    <path id="attack" style='fill:none' d="M 0,50&#10;C 0,10 20,0 40,0"/>
  </g>
  <svg:path d="M 10 50 L 30 20 Z M 0 0 H 5"></svg:path>
  <path id="a b" d='M 1 1 V 3'/>
</svg>
)svg";

TEST_F(CurveExchange, PathsOfADrawingAreCurves) {
  const std::string drawing = write("drawing.svg", kDrawing);
  const auto set = made({"import", drawing});
  EXPECT_THAT(set.names(), ElementsAre("attack", "path_2_1", "path_2_2", "path_3"));
  EXPECT_THAT(report_,
              HasSubstr(drawing + ":7: warning: the transform of 'attack' is not applied"));
  const auto& attack = set.curves[0];
  EXPECT_THAT(std::vector<double>(attack.points().begin(), attack.points().end()),
              ElementsAre(0, -50, 0, -10, 20, 0, 40, 0));
  EXPECT_THAT(made({"import", drawing, "--down"}).curves[0].points()[1], 50);
  const auto one = made({"import", drawing, "--path", "a b", "--name", "up"});
  EXPECT_THAT(one.names(), ElementsAre("up"));
  EXPECT_EQ(report_, "up: degree 1, 2 points, u 0 to 1\n");
}

TEST_F(CurveExchange, ADrawnLineFillsTheUnitSquareWhenAsked) {
  const auto set = made({"import", write("d.txt", "M 10,50 C 10,10 20,0 50,0"), "--unit-square"});
  EXPECT_THAT(std::vector<double>(set.curves[0].points().begin(), set.curves[0].points().end()),
              ElementsAre(0, 0, 0, 0.8, 0.25, 1, 1, 1));
}

// From Inkscape to the ear: a line drawn on a page 200 wide is the loudness of a note over 2 s.
TEST_F(CurveExchange, ADrawnLinePlays) {
  const std::string drawing = write("page.svg",
                                    "<svg><path id='rise' d='M 20,140 C 20,40 120,140 220,20'/>"
                                    "</svg>");
  const std::string curve = folder_.file("rise.toml"), sound = folder_.file("rise.wav");
  ASSERT_EQ(run({"import", drawing, "--unit-square", "-o", curve}).exit_code, 0);
  const std::string patch = write("patch.toml",
                                  "format = 1\nkind = 'patch'\ngain_db = 6\n"
                                  "[curves.rise]\ncurve_file = 'rise.toml'\n"
                                  "[oscillators.a]\nwave = 'sine'\n"
                                  "[envelopes.amp]\ncurve = 'rise'\nseconds = 2\n");
  const ProgramRun played = support::run_program(
      {"knotwave-render", patch, KNOTWAVE_SOURCE_DIR "/examples/musicians/one-note.mid", "-o",
       sound, "--bits", "32f"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const auto read = *io::read_sound(sound);
  const auto rms = [&](double at_s) {  // of eight periods of 220 Hz, of the left channel
    const int count = 48000 * 4 / 110, first = int(at_s * 48000) - count / 2;
    double sum = 0;
    for (int i = first; i < first + count; ++i) {
      sum += double(read.samples[std::size_t(2 * i)]) * read.samples[std::size_t(2 * i)];
    }
    return std::sqrt(sum / count);
  };
  const auto rise = curves::read_curves(curve)->curves.front();
  const auto drawn_at = [&](double x) {
    double low = 0, high = 1, place[2];
    for (int i = 0; i < 60; ++i) {
      rise.evaluate((low + high) / 2, place);
      (place[0] < x ? low : high) = (low + high) / 2;
    }
    return place[1];
  };
  for (const double x : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    EXPECT_NEAR(rms(2 * x) / rms(1.8), drawn_at(x) / drawn_at(0.9), 0.002) << x;
  }
}

TEST_F(CurveExchange, WhatIsExportedIsImportedWithinTheErrorSaid) {
  const std::string arc = KNOTWAVE_SOURCE_DIR "/examples/curves/arc.toml#arc";
  const auto whole =
      *curves::read_curves(KNOTWAVE_SOURCE_DIR "/examples/curves/arc.toml")->find_curve("arc");
  const std::string svg = folder_.file("arc.svg");
  const ProgramRun done = run({"export", arc, "--within", "-100", "-o", svg});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  std::smatch said;
  ASSERT_TRUE(
      std::regex_search(done.out, said, std::regex("arc: nowhere farther off than (\\S+) ")));
  EXPECT_LE(std::stod(said[1]), 1e-5);
  const auto back = made({"import", svg});
  EXPECT_THAT(back.names(), ElementsAre("arc"));
  // Radius 1, wherever the path is; its pace is another one.
  for (int i = 0; i <= 1000; ++i) {
    double place[2];
    back.curves[0].evaluate(back.curves[0].u_max() * i / 1000, place);
    EXPECT_NEAR(std::hypot(place[0], place[1]), 1, std::stod(said[1]) * 1.01);
  }
  EXPECT_THAT(*base::read_file(svg, 1 << 20), StartsWith("<svg xmlns="));
  EXPECT_EQ(run({"export", arc}).out.substr(0, 4), "<svg");
  const ProgramRun wrong = run({"export", arc, "-o", "a.toml"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--output: 'a.toml' does not end in .svg"));
}

TEST_F(CurveExchange, FaultsOfDrawingsSayWhere) {
  const auto fails = [&](const std::string& text, const std::string& message,
                         std::vector<std::string> more = {}) {
    const std::string path = write("bad.svg", text);
    more.insert(more.begin(), {"import", path});
    expect_failure(more, path + message);
  };
  fails("<svg>\n<path id='p' d='M 0 0 L x'/>\n</svg>",
        ":2: error: p: path data: a number is expected");
  fails("<svg>\n<path d='M 0 0 L 1 1", ":2: error: this tag is not well formed");
  fails("<svg>\n<path d=M0,0/>\n</svg>", ":2: error: this tag is not well formed");
  fails("<svg>\n<!-- <path", ":2: error: what begins here has no end: '-->' is missing");
  fails("<svg></svg>", ": error: there is no path in this drawing");
  fails(kDrawing, ": error: there is no path 'atack'; did you mean 'attack'?", {"--path", "atack"});
  fails(kDrawing, ": error: there is no path 'zz'; there are attack, a b", {"--path", "zz"});
  std::string many = "<svg>";
  for (int i = 0; i <= 4096; ++i) many += "<path id='p' d='M 0 0 L 1 1'/>";
  fails(many, ": error: more than 4096 curves; --path takes one path");
  fails("<svg><path d='M 0 0'/></svg>", ":1: error: path_1: path data: nothing is drawn");
  fails("", ":1: error: path_1: path data: nothing is drawn");
}

// Every cut and every changed byte of a drawing gives an answer, never a hang or a crash.
TEST_F(CurveExchange, ABrokenDrawingIsRefusedOrRead) {
  const std::string whole = kDrawing;
  for (std::size_t at = 0; at < whole.size(); at += 31) {
    std::string changed = whole;
    changed[at] = at % 2 == 0 ? '<' : '"';
    for (const std::string& text : {whole.substr(0, at), changed}) {
      const ProgramRun done = run({"import", write("b.svg", text)});
      EXPECT_TRUE(done.exit_code == 0 || done.exit_code == 1) << done.exit_code << "\n" << text;
    }
  }
}

}  // namespace

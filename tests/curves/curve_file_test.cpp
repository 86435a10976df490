// SPDX-License-Identifier: MIT
#include "knotwave/curves/curve_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/broken.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {

namespace fs = std::filesystem;

std::string curve_text(const std::string& body) {
  return "format = 1\nkind = \"curve\"\n[curves.bell]\n" + body;
}

std::string error_of(const std::string& text) {
  const auto set = parse_curves(text, "x.toml");
  return set ? "no error" : set.error().to_string();
}

std::vector<std::string> example_files() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/curves")) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expect_reads_back_equal(const CurveSet& set) {
  const std::string text = write_curves(set);
  const auto again = parse_curves(text, "written.toml");
  ASSERT_TRUE(again) << again.error().to_string() << "\n" << text;
  EXPECT_EQ(again->curves, set.curves) << text;
  EXPECT_EQ(again->surfaces, set.surfaces) << text;
  EXPECT_EQ(write_curves(*again), text);
}

// Any numbers a curve may have: awkward decimals, both signs, all magnitudes.
class RandomSpecs {
 public:
  explicit RandomSpecs(std::uint64_t seed) : engine_(seed) {}

  CurveSpec curve() {
    CurveSpec spec;
    spec.name = "c" + std::to_string(engine_() % 1000);
    spec.degree = integer(1, kMaxDegree);
    spec.dim = integer(1, kMaxDim);
    spec.periodic = integer(0, 3) == 0;
    const int count = spec.degree + 1 + integer(0, 12);
    spec.points = numbers(count * spec.dim);
    if (integer(0, 1) == 1) spec.weights = weights(count);
    if (integer(0, 1) == 1) {
      spec.knots = spec.periodic ? rising(count + 1) : clamped(spec.degree, count);
    }
    return spec;
  }
  SurfaceSpec surface() {
    SurfaceSpec spec;
    spec.name = "s" + std::to_string(engine_() % 1000);
    spec.degree_u = integer(1, 5);
    spec.degree_v = integer(1, 5);
    spec.dim = integer(1, kMaxDim);
    spec.periodic_u = integer(0, 1) == 1;
    spec.count_u = spec.degree_u + 1 + integer(0, 6);
    spec.count_v = spec.degree_v + 1 + integer(0, 3);
    spec.points = numbers(spec.count_u * spec.count_v * spec.dim);
    if (integer(0, 1) == 1) spec.weights = weights(spec.count_u * spec.count_v);
    if (integer(0, 1) == 1) spec.knots_v = clamped(spec.degree_v, spec.count_v);
    return spec;
  }

 private:
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % (static_cast<std::uint64_t>(high - low) + 1));
  }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  std::vector<double> numbers(int count) {
    std::vector<double> out;
    for (int i = 0; i < count; ++i) {
      const double x = (unit() - 0.5) * std::ldexp(1.0, integer(-30, 20));
      out.push_back(integer(0, 9) == 0 ? -0.0 : integer(0, 9) == 0 ? integer(-5, 5) : x);
    }
    return out;
  }
  std::vector<double> weights(int count) {
    std::vector<double> out(static_cast<std::size_t>(count));
    for (double& weight : out) weight = unit() + 0.01;
    return out;
  }
  std::vector<double> rising(int count) {
    std::vector<double> out{unit() - 0.5};
    while (static_cast<int>(out.size()) < count) out.push_back(out.back() + unit() + 1e-3);
    return out;
  }
  std::vector<double> clamped(int degree, int count) {
    const std::vector<double> inner = rising(count - degree + 1);
    std::vector<double> out(static_cast<std::size_t>(degree), inner.front());
    out.insert(out.end(), inner.begin(), inner.end());
    out.insert(out.end(), static_cast<std::size_t>(degree), inner.back());
    return out;
  }
  std::mt19937_64 engine_;
};

TEST(CurveFile, AMisspeltFirstKeyIsNamedWithTheRightOne) {
  EXPECT_EQ(error_of("# hill\nfrmat = 1\nkind = \"curve\"\n"),
            "x.toml:2:1: error: unknown key 'frmat'; did you mean 'format'?");
  EXPECT_EQ(error_of("format = 1\nkin = \"curve\"\n"),
            "x.toml:2:1: error: unknown key 'kin'; did you mean 'kind'?");
}

TEST(CurveFile, EachBrokenFileIsReportedAtItsFault) {
  const auto files = support::broken_files("curve_");
  EXPECT_GE(files.size(), 50u);
  for (const auto& file : files) {
    const auto set = read_curves(file.path);
    ASSERT_FALSE(set) << file.name;
    EXPECT_EQ(support::broken_report(file, set.error()), file.report);
    EXPECT_EQ(std::string(to_string(set.error().code)), file.code) << file.name;
    EXPECT_GE(set.error().line, 1) << file.name;
    EXPECT_GE(set.error().column, 1) << file.name;
  }
}

TEST(CurveFile, FilesBeyondTheLimitsAreReported) {
  const std::string brackets = curve_text("degree = 1\npoints = ");
  EXPECT_EQ(error_of(brackets + std::string((1 << 20) - brackets.size(), '[')),
            "x.toml:5:42: error: nested deeper than 32 levels");
  EXPECT_THAT(error_of(std::string((1 << 20) + 1, '#')),
              testing::HasSubstr("x.toml: error: the file has 1048577 bytes"));
  std::string points = "0";
  for (int i = 1; i <= kMaxPoints; ++i) points += ", 0";
  EXPECT_EQ(error_of(curve_text("degree = 1\npoints = [" + points + "]\n")),
            "x.toml:5:10: error: curve 'bell': 4097 points, at most 4096 are possible");
}

TEST(CurveFile, TheGreatestCurveThatIsAllowedReads) {
  std::string points = "0";
  for (int i = 1; i < kMaxPoints; ++i) points += ", 0";
  EXPECT_EQ(error_of(curve_text("degree = 15\npoints = [" + points + "]\n")), "no error");
}

TEST(CurveFile, AByteOrderMarkAndWindowsLineEndsAreAccepted) {
  const auto set = parse_curves(
      "\xEF\xBB\xBF"
      "format = 1\r\nkind = \"curve\"\r\n[curves.bell]\r\ndegree = 1\r\npoints = [0, 1]\r\n",
      "x.toml");
  ASSERT_TRUE(set) << set.error().to_string();
  EXPECT_EQ(set->curves.size(), 1u);
}

TEST(CurveFile, AMissingFileIsReportedByName) {
  const auto set = read_curves("/no/such/curve.toml");
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, ErrorCode::file_not_found);
  EXPECT_THAT(set.error().to_string(), testing::StartsWith("/no/such/curve.toml: error: "));
}

TEST(CurveFile, WhatIsWrittenReachesTheCurve) {
  const auto set = parse_curves(
      curve_text("degree = 2\npoints = [[0, 0], [1, 2], [2, 0], [3, 1], [4, 4], [5, 5]]\n"
                 "weights = [1, 2, 1, 0.5, 1, 1]\nknots = [0, 0, 0, 1, 1, 1, 2, 2, 2]\n"
                 "jumps = [1]\n"
                 "[curves.ring]\ndegree = 3\nperiodic = true\npoints = [0, 1, 0, -1]\n"
                 "[surfaces.hill]\ndegree_u = 1\ndegree_v = 2\nperiodic_u = true\n"
                 "points = [[0, 1, 2], [3, 4, 5], [6, 7, 8]]\n"
                 "weights = [[1, 1, 1], [1, 2, 1], [1, 1, 1]]\nknots_v = [0, 0, 0, 4, 4, 4]\n"),
      "x.toml");
  ASSERT_TRUE(set) << set.error().to_string();
  ASSERT_EQ(set->names(), (std::vector<std::string_view>{"bell", "ring", "hill"}));
  const NurbsCurve& bell = *set->find_curve("bell");
  EXPECT_EQ(bell.degree(), 2);
  EXPECT_EQ(bell.dim(), 2);
  EXPECT_EQ(bell.point_count(), 6);
  EXPECT_EQ(bell.weights()[1], 2);
  EXPECT_EQ(bell.u_max(), 2);
  EXPECT_EQ(bell.jumps().size(), 1u);
  EXPECT_TRUE(set->find_curve("ring")->is_periodic());
  const NurbsSurface& hill = *set->find_surface("hill");
  EXPECT_EQ(hill.degree_v(), 2);
  EXPECT_TRUE(hill.is_periodic_u());
  EXPECT_EQ(hill.v_max(), 4);
  EXPECT_TRUE(hill.is_rational());
  EXPECT_EQ(set->find_curve("hill"), nullptr);
  EXPECT_EQ(set->find_surface("bell"), nullptr);
}

TEST(CurveFile, EveryExampleReadsAndIsWrittenBackEqual) {
  const auto files = example_files();
  EXPECT_GE(files.size(), 10u);
  for (const std::string& file : files) {
    const auto set = read_curves(file);
    ASSERT_TRUE(set) << set.error().to_string();
    SCOPED_TRACE(file);
    expect_reads_back_equal(*set);
  }
}

NurbsCurve example(const std::string& file, const std::string& name) {
  const auto set = read_curves(KNOTWAVE_SOURCE_DIR "/examples/curves/" + file);
  return *set.value().find_curve(name);
}

double at(const NurbsCurve& curve, double u) {
  double value[kMaxDim] = {};
  curve.evaluate(u, value);
  return value[0];
}

// Largest distance in dB to the line from 0 to -60 dB.
double decay_error_db(const NurbsCurve& curve) {
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double u = i / 1000.0;
    worst = std::max(worst, std::abs(20 * std::log10(at(curve, u)) + 60 * u));
  }
  return worst;
}

TEST(CurveFile, ExampleCurvesAreWhatTheirCommentsSay) {
  EXPECT_LE(decay_error_db(example("decay.toml", "decay60")), 0.001);
  EXPECT_LE(decay_error_db(example("decay.toml", "decay60_light")), 0.009);
  EXPECT_GT(decay_error_db(example("decay.toml", "decay60_unweighted")), 1);
  const NurbsCurve arc = example("arc.toml", "arc");
  const NurbsCurve circle = example("arc.toml", "circle");
  const NurbsCurve hurry = example("bend.toml", "hurry");
  const NurbsCurve wait = example("bend.toml", "wait");
  const NurbsCurve round = example("shapers.toml", "round");
  const NurbsCurve fifth = example("shapers.toml", "fifth");
  for (int i = 0; i <= 1000; ++i) {
    const double u = i / 1000.0;
    for (const NurbsCurve* curve : {&arc, &circle}) {
      double place[2];
      curve->evaluate(u, place);
      EXPECT_NEAR(std::hypot(place[0], place[1]), 1, 4e-16);
    }
    EXPECT_NEAR(at(wait, at(hurry, u)), u, 4e-16);
    const double x = 2 * u - 1;
    EXPECT_NEAR(at(round, x), (3 * x - x * x * x) / 2, 1e-15);
    EXPECT_NEAR(at(fifth, x), std::cos(5 * std::acos(x)), 2e-14);
  }
}

TEST(CurveFile, RandomCurvesAndSurfacesAreWrittenBackEqual) {
  RandomSpecs random(support::test_seed());
  const int count = support::test_count(300);
  for (int i = 0; i < count; ++i) {
    CurveSet set;
    auto curve = NurbsCurve::create(random.curve());
    ASSERT_TRUE(curve) << curve.error().to_string();
    set.curves.push_back(std::move(*curve));
    auto surface = NurbsSurface::create(random.surface());
    ASSERT_TRUE(surface) << surface.error().to_string();
    set.surfaces.push_back(std::move(*surface));
    expect_reads_back_equal(set);
    if (HasFailure()) return;
  }
}

TEST(CurveFile, WrittenLinesStayWithinAHundredColumns) {
  RandomSpecs random(support::test_seed());
  for (int i = 0; i < 50; ++i) {
    CurveSet set;
    set.curves.push_back(NurbsCurve::create(random.curve()).value());
    const std::string text = write_curves(set);
    std::size_t start = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos;
         end = text.find('\n', start)) {
      EXPECT_LE(end - start, 110u) << text.substr(start, end - start);
      start = end + 1;
    }
  }
}

TEST(CurveFile, NamesAreBareKeys) {
  EXPECT_TRUE(is_valid_name("decay60"));
  EXPECT_TRUE(is_valid_name("a-b_C"));
  EXPECT_TRUE(is_valid_name(std::string(64, 'x')));
  EXPECT_FALSE(is_valid_name(std::string(65, 'x')));
  EXPECT_FALSE(is_valid_name(""));
  EXPECT_FALSE(is_valid_name("a.b"));
  EXPECT_FALSE(is_valid_name("a#b"));
  EXPECT_FALSE(is_valid_name("caf\xc3\xa9"));
}

}  // namespace
}  // namespace knotwave::curves

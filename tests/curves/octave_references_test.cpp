// SPDX-License-Identifier: MIT
// Edits against those of the Octave NURBS toolbox (tools/make_octave_references.m): the same knots,
// and the same control points and weights up to its rounding. Surfaces: the same values.
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"
#include "knotwave/curves/surface_shapes.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using testing::DoubleNear;
using testing::Pointwise;

constexpr double kItsRounding = 1e-13;  // weights and coordinates are near 1

std::vector<double> numbers_after(std::istream& file, const std::string& expected) {
  std::string line, what;
  std::getline(file, line);
  std::istringstream words(line);
  words >> what;
  EXPECT_EQ(what, expected);
  std::vector<double> numbers;
  for (std::string word; words >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

NurbsCurve next_curve(std::istream& file, int degree) {
  CurveSpec spec;
  spec.degree = degree;
  spec.dim = 2;
  spec.knots = numbers_after(file, "knots");
  const std::vector<double> x = numbers_after(file, "x"), y = numbers_after(file, "y");
  for (std::size_t i = 0; i < x.size(); ++i) {
    spec.points.push_back(x[i]);
    spec.points.push_back(y[i]);
  }
  spec.weights = numbers_after(file, "weights");
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

void expect_same(const Result<NurbsCurve>& ours, const NurbsCurve& theirs) {
  ASSERT_TRUE(ours) << ours.error().message;
  EXPECT_THAT(ours->knots(), Pointwise(DoubleNear(1e-15), theirs.knots()));
  EXPECT_THAT(ours->points(), Pointwise(DoubleNear(kItsRounding), theirs.points()));
  EXPECT_THAT(ours->weights(), Pointwise(DoubleNear(kItsRounding), theirs.weights()));
}

TEST(OctaveReferences, EditsGiveTheSameControlPoints) {
  std::ifstream file(KNOTWAVE_SOURCE_DIR "/tests/golden/curves/octave_nurbs.txt");
  ASSERT_TRUE(file);
  int edits = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what, name;
    words >> what >> name;
    if (what != "edit") continue;
    std::vector<double> with;
    for (double number = 0; words >> number;) with.push_back(number);
    const int degree = static_cast<int>(numbers_after(file, "degree").at(0));
    const bool raises = name == "elevate_degree";
    const NurbsCurve before = next_curve(file, degree);
    const NurbsCurve after = next_curve(file, raises ? degree + static_cast<int>(with[0]) : degree);
    SCOPED_TRACE(line + " of degree " + std::to_string(degree));
    ++edits;
    if (name == "refine") expect_same(refine(before, with), after);
    if (raises) expect_same(elevate_degree(before, static_cast<int>(with[0])), after);
    if (name == "reverse") expect_same(reverse(before), after);
    // And theirs back: what they raised once, we reduce.
    if (raises && with[0] == 1) {
      const auto back = reduce_degree(after, kItsRounding);
      ASSERT_TRUE(back) << back.error().message;
      expect_same(back->curve, before);
    }
  }
  EXPECT_EQ(edits, 18);
}

Result<curves::NurbsSurface> shape_of(const std::string& name, const std::vector<double>& with,
                                      const std::vector<NurbsCurve>& of) {
  if (name == "ruled") return ruled(of.at(0), of.at(1));
  if (name == "revolved") return revolved(of.at(0), with.at(0));
  return coons(of.at(0), of.at(1), of.at(2), of.at(3));
}

TEST(OctaveReferences, SurfacesHaveTheSameValues) {
  std::ifstream file(KNOTWAVE_SOURCE_DIR "/tests/golden/curves/octave_nurbs.txt");
  ASSERT_TRUE(file);
  int shapes = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what, name;
    words >> what >> name;
    if (what != "shape") continue;
    SCOPED_TRACE(line);
    std::vector<double> with;
    for (double number = 0; words >> number;) with.push_back(number);
    std::vector<NurbsCurve> operands;
    const int count = name == "revolved" ? 1 : name == "ruled" ? 2 : 4;
    for (int i = 0; i < count; ++i) {
      const int degree = static_cast<int>(numbers_after(file, "degree").at(0));
      operands.push_back(next_curve(file, degree));
    }
    const auto ours = shape_of(name, with, operands);
    ASSERT_TRUE(ours) << ours.error().message;
    for (int i = 0; i < 25; ++i) {
      const std::vector<double> at = numbers_after(file, "at");
      double value[3] = {0, 0, 0};
      ours->evaluate(at.at(0), at.at(1), value);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(value[c], at.at(c + 2), kItsRounding);
    }
    ++shapes;
  }
  EXPECT_EQ(shapes, 6);
}

// The toolbox's nrbdegelev does not: its curves move by up to 0.08.
TEST(OctaveReferences, ElevationKeepsDoubleKnotsWhereTheToolboxMovesTheCurve) {
  for (int p = 4; p <= 8; ++p) {
    CurveSpec spec;
    spec.degree = p;
    spec.knots = {0.25, 0.4, 0.4, 0.75};
    spec.knots.insert(spec.knots.begin(), std::size_t(p + 1), 0.0);
    spec.knots.insert(spec.knots.end(), std::size_t(p + 1), 1.0);
    for (int i = 1; i <= p + 5; ++i) spec.points.push_back(7 * i % 11 / 8.0 - 0.5);
    const NurbsCurve before = *NurbsCurve::create(spec);
    for (int times = 1; times <= 4; ++times) {
      const auto after = elevate_degree(before, times);
      ASSERT_TRUE(after) << after.error().message;
      for (int i = 0; i <= 100; ++i) {
        double a, b;
        before.evaluate(i / 100.0, std::span(&a, 1));
        after->evaluate(i / 100.0, std::span(&b, 1));
        EXPECT_NEAR(a, b, 4e-16) << p << " " << times;
      }
    }
  }
}

}  // namespace
}  // namespace knotwave::test

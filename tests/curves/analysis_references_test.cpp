// SPDX-License-Identifier: MIT
// Ranges, roots, nearest places, areas and lengths against figures of 30 digits
// (tools/make_analysis_references.py).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/curves/analysis.h"
#include "knotwave/curves/calculus.h"

#include "random_curve.h"
#include "reference_records.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using Numbers = std::vector<double>;

// Each gives the largest error in units of what is promised.
double range_error(const NurbsCurve& curve, const Numbers& exact) {
  const auto range = value_range(curve);
  return std::max(std::abs(range.low.value - exact[0]), std::abs(range.high.value - exact[1])) /
         ulp_of(largest_coordinate(curve));
}

double variation_error(const NurbsCurve& curve, const Numbers& exact) {
  return std::abs(total_variation(curve) - exact[0]) / ulp_of(exact[0]);
}

double roots_error(const NurbsCurve& curve, const Numbers& exact) {
  const Numbers found = parameters_at(curve, exact[0]);
  EXPECT_EQ(found.size() + 1, exact.size());
  double worst = 0;
  for (std::size_t i = 0; i < std::min(found.size(), exact.size() - 1); ++i) {
    worst = std::max(worst, std::abs(found[i] - exact[i + 1]) / (4 * ulp_of(curve.u_max())));
  }
  return worst;
}

double nearest_error(const NurbsCurve& curve, const Numbers& exact) {
  const auto dim = static_cast<std::size_t>(curve.dim());
  const auto best = closest_point(curve, std::span(exact).first(dim));
  EXPECT_TRUE(best);
  const double far = std::abs(best->distance - exact[dim]) / (4 * ulp_of(exact[dim] + 2));
  if (exact[dim] < 1e-15) return far;  // on the curve, maybe in several places
  return std::max(far, std::abs(best->u - exact[dim + 1]) / 0x1p-48);
}

double area_error(const NurbsCurve& curve, const Numbers& exact) {
  const auto area = integral(curve, exact[0], exact[1]);
  EXPECT_TRUE(area);
  const double scale = largest_coordinate(curve) * (exact[1] - exact[0]);
  return std::abs(*area - exact[2]) / (curve.is_rational() ? 0x1p-50 * scale : ulp_of(scale));
}

double length_error(const NurbsCurve& curve, const Numbers& exact) {
  const auto length = arc_length(curve, exact[0], exact[1]);
  EXPECT_TRUE(length);
  return std::abs(*length - exact[2]) / (0x1p-50 * polygon_length(curve));
}

using Judge = double (*)(const NurbsCurve&, const Numbers&);
const std::map<std::string, Judge> kJudges = {
    {"range", range_error},     {"variation", variation_error}, {"roots", roots_error},
    {"nearest", nearest_error}, {"area", area_error},           {"length", length_error}};

struct Score {
  int count = 0;
  double worst = 0;
};

TEST(AnalysisReferences, AllFiguresAreAsGoodAsPromised) {
  std::ifstream file(KNOTWAVE_SOURCE_DIR "/tests/golden/curves/analysis.txt");
  ASSERT_TRUE(file);
  std::map<std::string, Score> scores;
  CurveSpec spec;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    read_curve_record(what, words, spec);
    const auto judge = kJudges.find(what);
    if (judge == kJudges.end()) continue;
    const auto curve = NurbsCurve::create(spec);
    ASSERT_TRUE(curve) << curve.error().message;
    Score& score = scores[what];
    const double error = judge->second(*curve, hex_numbers(words));
    EXPECT_LE(error, 1) << line << " degree " << spec.degree;
    score.worst = std::max(score.worst, error);
    ++score.count;
  }
  EXPECT_EQ(scores.size(), kJudges.size());
  for (const auto& [name, score] : scores) {
    std::printf("%s: %d figures, worst %.3f of what is promised\n", name.c_str(), score.count,
                score.worst);
    EXPECT_GE(score.count, 30) << name;
  }
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Values and derivatives against exact rationals (tools/make_curve_references.py).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/curves/nurbs_curve.h"

#include "random_curve.h"
#include "reference_records.h"
#include "support/program.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

// The error a derivative of order k may have: 1 ulp of its own, and where terms cancel 2^-90 of
// what they may be: |P| (2p / shortest span)^k with weights 1.
double allowed_error(const NurbsCurve& curve, int order, double exact) {
  double span = curve.u_max() - curve.u_min();
  double least = curve.weights()[0], most = curve.weights()[0];
  for (std::size_t i = 0; i + 1 < curve.knots().size(); ++i) {
    const double width = curve.knots()[i + 1] - curve.knots()[i];
    if (width > 0) span = std::min(span, width);
  }
  for (const double w : curve.weights()) {
    least = std::min(least, w);
    most = std::max(most, w);
  }
  const double scale =
      largest_coordinate(curve) * std::pow(2.0 * curve.degree() / span * (most / least), order);
  return ulp_of(exact) + 0x1p-90 * scale;
}

TEST(CurveReferences, ValuesAndDerivativesAgreeWithExactRationals) {
  std::ifstream file(KNOTWAVE_SOURCE_DIR "/tests/golden/curves/references.txt");
  ASSERT_TRUE(file);
  CurveSpec spec;
  int curves_read = 0, places = 0;
  double worst_value_ulp = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    read_curve_record(what, words, spec);
    curves_read += what == "curve";
    if (what != "at") continue;
    std::string u_text, side;
    words >> u_text >> side;
    const double u = std::strtod(u_text.c_str(), nullptr);
    const std::vector<double> exact = hex_numbers(words);
    const int order = static_cast<int>(exact.size()) / spec.dim - 1;
    const auto curve = NurbsCurve::create(spec);
    ASSERT_TRUE(curve) << curve.error().message;
    std::vector<double> out(exact.size());
    curve->derivatives(u, order, side == "L" ? Side::left : Side::right, out);
    ++places;
    for (int i = 0; i < static_cast<int>(exact.size()); ++i) {
      const double error = std::abs(out[std::size_t(i)] - exact[std::size_t(i)]);
      if (i < spec.dim) {
        const double ulp = ulp_of(largest_coordinate(*curve));
        worst_value_ulp = std::max(worst_value_ulp, error / ulp);
        EXPECT_LE(error, 4 * ulp) << line;
      } else {
        EXPECT_LE(error, allowed_error(*curve, i / spec.dim, exact[std::size_t(i)]))
            << "derivative " << i / spec.dim << " is " << out[std::size_t(i)] << ", exactly "
            << exact[std::size_t(i)] << " of curve " << curves_read << " at " << u << side;
      }
    }
  }
  EXPECT_EQ(curves_read, 60);
  EXPECT_GT(places, 200);
  std::printf("%d curves, %d places, worst value error %.3f ulp of max|P|\n", curves_read, places,
              worst_value_ulp);
}

TEST(CurveReferences, FileIsWhatItsGeneratorWrites) {
  const auto run = support::run_program(
      {"/usr/bin/python3", KNOTWAVE_SOURCE_DIR "/tools/make_curve_references.py", "--check"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

}  // namespace
}  // namespace knotwave::test

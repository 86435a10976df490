// SPDX-License-Identifier: MIT
// Surfaces against exact rationals (tools/make_surface_references.py): partial derivatives from
// both sides of knots, edits, and surfaces made from curves.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/base/index.h"
#include "knotwave/curves/surface_algorithms.h"
#include "knotwave/curves/surface_shapes.h"

#include "random_curve.h"
#include "reference_records.h"
#include "support/program.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::Direction;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::Side;
using curves::SurfaceSpec;

using base::index_of;

double largest_of(std::span<const double> points) {
  double largest = 0;
  for (const double x : points) largest = std::max(largest, std::abs(x));
  return largest;
}

struct Case {
  std::string name;
  std::vector<double> with;
  std::vector<SurfaceSpec> surfaces;
  std::vector<CurveSpec> curves;

  Direction direction() const { return with.at(0) == 0 ? Direction::u : Direction::v; }
  NurbsSurface surface() const { return *NurbsSurface::create(surfaces.at(0)); }
  std::vector<NurbsCurve> operands() const {
    std::vector<NurbsCurve> all;
    for (const CurveSpec& spec : curves) all.push_back(*NurbsCurve::create(spec));
    return all;
  }
};

Result<NurbsSurface> there_and_back(const Case& made) {
  const NurbsSurface before = made.surface();
  const double tolerance = 16 * ulp_of(largest_of(before.points()));
  const bool knots = made.name == "insert_and_remove";
  const auto finer =
      knots ? insert_knot(before, made.direction(), made.with[1], static_cast<int>(made.with[2]))
            : elevate_degree(before, made.direction());
  if (!finer) return finer.error();
  const auto back = knots ? remove_knot(*finer, made.direction(), made.with[1],
                                        static_cast<int>(made.with[2]), tolerance)
                          : reduce_degree(*finer, made.direction(), tolerance);
  if (!back) return back.error();
  EXPECT_EQ(back->removed, knots ? made.with[2] : 1);
  return back->surface;
}

Result<NurbsSurface> carry_out(const Case& made) {
  const std::vector<double>& with = made.with;
  if (made.name == "insert_and_remove" || made.name == "elevate_and_reduce") {
    return there_and_back(made);
  }
  if (made.name == "refine") {
    return refine(made.surface(), made.direction(), std::span(with).subspan(1));
  }
  if (made.name == "elevate_degree") {
    return elevate_degree(made.surface(), made.direction(), static_cast<int>(with[1]));
  }
  if (made.name == "sub_surface") {
    return sub_surface(made.surface(), made.direction(), with[1], with[2]);
  }
  if (made.name == "reverse") return reverse(made.surface(), made.direction());
  if (made.name == "reparametrize") {
    return reparametrize(made.surface(), made.direction(), with[1], with[2]);
  }
  if (made.name == "transpose") return transpose(made.surface());
  if (made.name == "bilinear") {
    return curves::bilinear(std::span(with).subspan(1), static_cast<int>(with[0]));
  }
  const std::vector<NurbsCurve> operands = made.operands();
  if (made.name == "ruled") return ruled(operands.at(0), operands.at(1));
  if (made.name == "coons") {
    return coons(operands.at(0), operands.at(1), operands.at(2), operands.at(3));
  }
  if (made.name == "lofted") {
    return lofted(operands, static_cast<int>(with[0]), std::span(with).subspan(1));
  }
  return fail(ErrorCode::unknown_name, "nothing is called " + made.name);
}

struct Place {
  double u = 0, v = 0;
  Side side_u = Side::right, side_v = Side::right;
  std::vector<double> exact;

  explicit Place(std::istream& words) {
    std::string u_text, u_side, v_text, v_side;
    words >> u_text >> u_side >> v_text >> v_side;
    u = std::strtod(u_text.c_str(), nullptr);
    v = std::strtod(v_text.c_str(), nullptr);
    side_u = u_side == "L" ? Side::left : Side::right;
    side_v = v_side == "L" ? Side::left : Side::right;
    exact = hex_numbers(words);
  }
};

// What of a case is worth at a place, and the ulp its errors count in.
struct Subject {
  std::function<void(const Place&, std::span<double>)> evaluate;
  double ulp = 1;
};

Subject subject_of(const Case& made) {
  if (made.name == "iso_curve") {
    const NurbsSurface surface = made.surface();
    const bool runs_along_v = made.direction() == Direction::u;
    const NurbsCurve curve =
        runs_along_v ? surface.iso_curve_at_u(made.with[1]) : surface.iso_curve_at_v(made.with[1]);
    return {[curve, runs_along_v](const Place& at, std::span<double> out) {
              curve.evaluate(runs_along_v ? at.v : at.u, out);
            },
            ulp_of(largest_of(surface.points()))};
  }
  const auto result = carry_out(made);
  EXPECT_TRUE(result) << made.name << ": " << (result ? "" : result.error().message);
  if (!result) return {};
  const double ulp = ulp_of(largest_of(result->points()));
  return {[surface = *result](const Place& at, std::span<double> out) {
            surface.evaluate(at.u, at.v, out);
          },
          ulp};
}

// Reads the file and calls back for each place of the cases that `wanted` has.
void for_each_place(const std::function<bool(const std::string&)>& wanted,
                    const std::function<void(const Case&, bool is_first, const Place&)>& look) {
  std::ifstream file(KNOTWAVE_SOURCE_DIR "/tests/golden/curves/surfaces.txt");
  ASSERT_TRUE(file);
  Case made;
  bool has_operands = false, is_first = true;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    if (what == "make") {
      words >> made.name;
      made.with = hex_numbers(words);
      has_operands = false;
      is_first = true;
    }
    if ((what == "surface" || what == "curve") && !has_operands) {
      made.surfaces.clear();
      made.curves.clear();
      has_operands = true;
    }
    if (what == "surface") {
      SurfaceSpec& spec = made.surfaces.emplace_back();
      words >> spec.degree_u >> spec.degree_v >> spec.dim >> spec.count_u >> spec.count_v >>
          spec.periodic_u;
    }
    if (what == "curve") made.curves.emplace_back();
    if (!made.curves.empty()) read_curve_record(what, words, made.curves.back());
    if (made.curves.empty() && !made.surfaces.empty()) {
      SurfaceSpec& spec = made.surfaces.back();
      if (what == "knots_u") spec.knots_u = hex_numbers(words);
      if (what == "knots_v") spec.knots_v = hex_numbers(words);
      if (what == "points") spec.points = hex_numbers(words);
      if (what == "weights") spec.weights = hex_numbers(words);
    }
    if (what != "at" || !wanted(made.name)) continue;
    look(made, is_first, Place(words));
    is_first = false;
  }
}

TEST(SurfaceReferences, EverySurfaceIsWithin4UlpOfExactRationals) {
  struct Score {
    int places = 0;
    double worst_ulp = 0;
  };
  std::map<std::string, Score> scores;
  Subject subject;
  for_each_place(
      [](const std::string& name) { return name != "partials"; },
      [&](const Case& made, bool is_first, const Place& at) {
        if (is_first) subject = subject_of(made);
        if (!subject.evaluate) return;
        SCOPED_TRACE(made.name + " at " + std::to_string(at.u) + ", " + std::to_string(at.v));
        double out[curves::kMaxDim];
        subject.evaluate(at, out);
        Score& score = scores[made.name];
        ++score.places;
        for (std::size_t c = 0; c < at.exact.size(); ++c) {
          const double error = std::abs(out[c] - at.exact[c]) / subject.ulp;
          score.worst_ulp = std::max(score.worst_ulp, error);
          EXPECT_LE(error, 4) << out[c] << ", exactly " << at.exact[c];
        }
      });
  for (const auto& [name, score] : scores) {
    std::printf("%s: %d places, worst %.2f ulp of max|P|\n", name.c_str(), score.places,
                score.worst_ulp);
    EXPECT_GT(score.places, 60) << name;
  }
  EXPECT_EQ(scores.size(), 13u);
}

// Each counts in ulp of the largest partial of its order there: what a direction of the derivative
// may be worth.
TEST(SurfaceReferences, PartialDerivativesAreExactToTheirLastBitsOnBothSidesOfKnots) {
  int places = 0;
  double worst = 0;
  for_each_place([](const std::string& name) { return name == "partials"; },
                 [&](const Case& made, bool, const Place& at) {
                   const NurbsSurface surface = made.surface();
                   const int order = 3, dim = surface.dim();
                   std::vector<double> all(index_of(16 * dim));
                   surface.derivatives(at.u, at.side_u, at.v, at.side_v, order, all);
                   auto exact = at.exact.begin();
                   std::vector<double> largest(4, largest_of(surface.points())), errors(4, 0.0);
                   for (int k = 0; k <= order; ++k) {
                     for (int l = 0; k + l <= order; ++l) {
                       for (int c = 0; c < dim; ++c, ++exact) {
                         const auto i = index_of((k * 4 + l) * dim + c), total = index_of(k + l);
                         if (total > 0) largest[total] = std::max(largest[total], std::abs(*exact));
                         errors[total] = std::max(errors[total], std::abs(all[i] - *exact));
                       }
                     }
                   }
                   ASSERT_EQ(exact, at.exact.end());
                   for (std::size_t total = 0; total < 4; ++total) {
                     const double error = errors[total] / ulp_of(largest[total]);
                     worst = std::max(worst, error);
                     EXPECT_LE(error, 1) << "order " << total << " at " << at.u << ", " << at.v;
                   }
                   ++places;
                 });
  std::printf("%d places, worst %.2f ulp\n", places, worst);
  EXPECT_GT(places, 200);
}

TEST(SurfaceReferences, FileIsWhatItsGeneratorWrites) {
  const auto run = support::run_program(
      {"/usr/bin/python3", KNOTWAVE_SOURCE_DIR "/tools/make_surface_references.py", "--check"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

}  // namespace
}  // namespace knotwave::test

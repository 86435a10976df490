// SPDX-License-Identifier: MIT
// Edits against exact rationals (tools/make_edit_references.py): every value of an edited curve is
// within 4 ulp of max|P| of what the edit means.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/curves/bezier.h"
#include "knotwave/curves/combine.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "random_curve.h"
#include "reference_records.h"
#include "support/program.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::Side;

struct Case {
  std::string edit;
  std::vector<double> arguments;
  std::vector<CurveSpec> specs;
};

Result<NurbsCurve> carry_out(const Case& edit) {
  std::vector<NurbsCurve> curve;
  for (const CurveSpec& spec : edit.specs) {
    auto made = NurbsCurve::create(spec);
    if (!made) return made.error();
    curve.push_back(std::move(*made));
  }
  const std::vector<double>& with = edit.arguments;
  if (edit.edit == "insert_and_remove") {
    const int times = static_cast<int>(with[1]);
    auto finer = insert_knot(curve[0], with[0], times);
    if (!finer) return finer.error();
    auto back = remove_knot(*finer, with[0], times, 16 * ulp_of(largest_coordinate(curve[0])));
    if (!back) return back.error();
    EXPECT_EQ(back->removed, times);
    return back->curve;
  }
  if (edit.edit == "elevate_and_reduce") {
    auto raised = elevate_degree(curve[0]);
    if (!raised) return raised.error();
    auto back = reduce_degree(*raised, 16 * ulp_of(largest_coordinate(curve[0])));
    if (!back) return back.error();
    return back->curve;
  }
  if (edit.edit == "from_bezier") return from_bezier(to_bezier(curve[0]));
  if (edit.edit == "refine") return refine(curve[0], with);
  if (edit.edit == "elevate_degree") return elevate_degree(curve[0], static_cast<int>(with[0]));
  if (edit.edit == "sum") return sum(curve[0], curve[1]);
  if (edit.edit == "product") return product(curve[0], curve[1]);
  if (edit.edit == "join") return join(curve[0], curve[1]);
  if (edit.edit == "morph") return morph(curve[0], curve[1], with[0]);
  if (edit.edit == "compose") return compose(curve[0], curve[1]);
  if (edit.edit == "reverse") return reverse(curve[0]);
  if (edit.edit == "reparametrize") return reparametrize(curve[0], with[0], with[1]);
  if (edit.edit == "bend") return bend(curve[0], with[0]);
  return fail(ErrorCode::unknown_name, "no edit is called " + edit.edit);
}

struct Score {
  int places = 0;
  double worst_ulp = 0;
};

void judge(const NurbsCurve& result, std::istream& words, Score& score) {
  std::string u_text, side;
  words >> u_text >> side;
  const std::vector<double> exact = hex_numbers(words);
  ASSERT_EQ(static_cast<int>(exact.size()), result.dim());
  std::vector<double> out(exact.size());
  result.evaluate(std::strtod(u_text.c_str(), nullptr), side == "L" ? Side::left : Side::right,
                  out);
  ++score.places;
  for (std::size_t c = 0; c < exact.size(); ++c) {
    const double error = std::abs(out[c] - exact[c]) / ulp_of(largest_coordinate(result));
    score.worst_ulp = std::max(score.worst_ulp, error);
    EXPECT_LE(error, 4) << u_text << side << ": " << out[c] << ", exactly " << exact[c];
  }
}

TEST(EditReferences, EveryEditIsWithin4UlpOfExactRationals) {
  std::ifstream file(KNOTWAVE_SOURCE_DIR "/tests/golden/curves/edits.txt");
  ASSERT_TRUE(file);
  Case edit;
  std::optional<NurbsCurve> result;
  std::map<std::string, Score> scores;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string what;
    words >> what;
    if (what == "edit") {
      edit = {};
      result.reset();
      words >> edit.edit;
      edit.arguments = hex_numbers(words);
    }
    if (what == "curve") edit.specs.emplace_back();
    if (!edit.specs.empty()) read_curve_record(what, words, edit.specs.back());
    if (what != "at") continue;
    if (!result) {
      auto done = carry_out(edit);
      ASSERT_TRUE(done) << edit.edit << ": " << done.error().message;
      result = std::move(*done);
    }
    SCOPED_TRACE(edit.edit + " of degree " + std::to_string(edit.specs[0].degree));
    judge(*result, words, scores[edit.edit]);
  }
  for (const auto& [name, score] : scores) {
    std::printf("%s: %d places, worst %.2f ulp of max|P|\n", name.c_str(), score.places,
                score.worst_ulp);
    EXPECT_GT(score.places, 50) << name;
  }
  EXPECT_EQ(scores.size(), 13u);
}

TEST(EditReferences, FileIsWhatItsGeneratorWrites) {
  const auto run = support::run_program(
      {"/usr/bin/python3", KNOTWAVE_SOURCE_DIR "/tools/make_edit_references.py", "--check"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

}  // namespace
}  // namespace knotwave::test

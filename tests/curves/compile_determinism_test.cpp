// SPDX-License-Identifier: MIT
// Compiled programs and what they play are the same bits from every compiler, optimisation level,
// vector unit and machine: one hash. It changes only with the sound, and then on purpose.
#include <gtest/gtest.h>

#include "knotwave/base/sha256.h"
#include "knotwave/curves/compile.h"

#include "curves/random_curves.h"
#include "support/simd_guard.h"

namespace knotwave::curves {
namespace {
using testing::Draws;
using testing::made;
using testing::random_curve;

void add_program(base::Sha256& hash, const CurveProgram& program) {
  std::vector<float> floats(701);
  std::vector<double> doubles(floats.size());
  const double length = program.u_max() - program.u_min();
  const GridRun run{program.u_min() - 0.1 * length, length / 577, 0};
  for (int c = 0; c < program.dim(); ++c) {
    CurveCursor cursor;
    program.render(run, floats, cursor, c);
    program.render(run, doubles, cursor, c);
    hash.update(floats);
    hash.update(std::as_bytes(std::span(doubles)));
    for (double& slope : doubles) {
      slope = program.slope_at_u(run.at(&slope - doubles.data()), c);
    }
    hash.update(std::as_bytes(std::span(doubles)));
  }
  const double error = program.max_error();
  hash.update(std::as_bytes(program.breaks()));
  hash.update(std::as_bytes(std::span(&error, 1)));
}

NurbsCurve easing(double x1, double y1, double x2, double y2) {
  CurveSpec spec;
  spec.name = "easing";
  spec.dim = 2;
  spec.points = {0, 0, x1, y1, x2, y2, 1, 1};
  return made(std::move(spec));
}

std::string hash_of_everything() {
  base::Sha256 hash;
  for (int i = 0; i < 40; ++i) {
    Draws draw(12, i);
    testing::RandomCurveOptions options;
    options.max_degree = 12;
    options.dim = 1 + i % 2;
    const NurbsCurve curve = random_curve(draw, options);
    add_program(hash, *compile_parametric(curve));
    add_program(hash, *compile_polynomial(curve));
    if (curve.degree() > kMaxPieceDegree || curve.dim() > 1) continue;
    CompileOptions controlled;
    controlled.controls = {{ControlRange::Kind::weight, 1, 0, 0.1, 10}};
    add_program(hash, *compile_function(curve, controlled));
    const double u = 0.3 * curve.u_max() + 0.7 * curve.u_min();
    if (!curve.is_periodic()) add_program(hash, compile_join(curve, u)->basis);
  }
  for (const auto& [x1, x2] : {std::pair{.25, .25}, {.42, .58}, {0., 0.}, {1., 0.}, {1., 1.}}) {
    const NurbsCurve curve = easing(x1, 0.1, x2, 0.9);
    add_program(hash, *compile_function(curve));
    add_program(hash, compile_join(curve, 0.2)->basis);
  }
  return hash.finish_hex();
}

TEST(CompileDeterminism, EveryBuildAndVectorUnitGivesTheSameBits) {
  const char* const expected = "caab0f4444df1fc542d34f7c278e35613a0d8080d8a31fe63fb925057458cd98";
  for (const SimdLevel level : simd_levels()) {
    const support::SimdGuard guard(level);
    EXPECT_EQ(hash_of_everything(), expected) << simd_level_name();
  }
}

}  // namespace
}  // namespace knotwave::curves

// SPDX-License-Identifier: MIT
#include "knotwave/curves/fast_program.h"

#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/base/sha256.h"
#include "knotwave/curves/compile.h"

#include "curves/random_curve.h"
#include "curves/random_curves.h"
#include "support/allocation_count.h"
#include "support/seed.h"
#include "support/simd_guard.h"

namespace knotwave::curves {
namespace {
using support::SimdGuard;
using testing::Draws;
using testing::line;
using testing::made;
using testing::random_curve;
using testing::rational;

FastProgram fast(const NurbsCurve& curve,
                 double max_error = std::numeric_limits<double>::infinity()) {
  auto program = compile_parametric(curve);
  if (!program) ADD_FAILURE() << program.error().message;
  return FastProgram(std::move(*program), max_error);
}

NurbsCurve cycle() {
  CurveSpec spec;
  spec.name = "cycle";
  spec.points = {0, 1, 0, -1, 0.5};
  spec.periodic = true;
  return made(std::move(spec));
}

/// The run in blocks of sizes drawn from 1..most.
std::vector<float> in_blocks(const FastProgram& program, const GridRun& run, std::size_t count,
                             Draws& draw, int most, int coordinate = 0) {
  std::vector<float> out(count);
  CurveCursor cursor{3};
  for (std::size_t i = 0; i < count;) {
    const auto block = std::min(count - i, static_cast<std::size_t>(draw.whole(1, most)));
    GridRun part = run;
    part.first += static_cast<std::int64_t>(i);
    program.render(part, std::span(out).subspan(i, block), cursor, coordinate);
    i += block;
  }
  return out;
}

void expect_same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i]), std::bit_cast<std::uint32_t>(b[i]))
        << "sample " << i << ": " << a[i] << " and " << b[i];
  }
}

GridRun random_run(Draws& draw, const NurbsCurve& curve) {
  const double length = curve.u_max() - curve.u_min();
  const double steps[] = {0.3, 0.03, 0.003, 0.0003};
  return {curve.u_min() - draw.between(-0.2, 0.3) * length,
          (draw.chance(0.5) ? 1 : -1) * draw.between(0.5, 1) * length * steps[draw.whole(0, 3)],
          draw.whole(-400, 400)};
}

TEST(FastProgram, AnySplitAndEveryVectorUnitGiveTheBitsOfOneSampleAtATime) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(150); ++i) {
    Draws draw(seed, i);
    testing::RandomCurveOptions options;
    options.dim = draw.whole(1, 3);
    const NurbsCurve curve = random_curve(draw, options);
    const FastProgram program = fast(curve);
    const GridRun run = random_run(draw, curve);
    SCOPED_TRACE(i);
    for (int c = 0; c < curve.dim(); ++c) {
      const std::vector<float> one_by_one = in_blocks(program, run, 400, draw, 1, c);
      for (const SimdLevel level : simd_levels()) {
        const SimdGuard guard(level);
        for (const int most : {3, 70, 200, 400}) {
          expect_same_bits(in_blocks(program, run, 400, draw, most, c), one_by_one);
        }
      }
    }
  }
}

TEST(FastProgram, EveryBlockSizeUpTo600GivesTheSameBits) {
  const FastProgram bell = fast(line({0, 0.3, 1, 0.2, -0.5, 0.1, 0}, 3));
  Draws draw(1, 1);
  const GridRun run{-0.05, 0.0016, -2};
  const std::vector<float> one_by_one = in_blocks(bell, run, 750, draw, 1);
  for (const SimdLevel level : simd_levels()) {
    const SimdGuard guard(level);
    for (std::size_t block = 1; block <= 600; ++block) {
      std::vector<float> out(one_by_one.size());
      CurveCursor cursor;
      for (std::size_t i = 0; i < out.size(); i += block) {
        GridRun part = run;
        part.first += static_cast<std::int64_t>(i);
        bell.render(part, std::span(out).subspan(i, std::min(block, out.size() - i)), cursor);
      }
      expect_same_bits(out, one_by_one);
    }
  }
}

TEST(FastProgram, IsWithinItsProvedErrorOfTheExactCurve) {
  const std::uint64_t seed = support::test_seed();
  double worst_share = 0;
  for (int i = 0; i < support::test_count(400); ++i) {
    Draws draw(seed + 7, i);
    testing::RandomCurveOptions options;
    options.max_degree = 12;
    const NurbsCurve curve = random_curve(draw, options);
    const FastProgram program = fast(curve);
    const GridRun run = random_run(draw, curve);
    std::vector<float> out(500);
    CurveCursor cursor;
    program.render(run, out, cursor);
    double worst = 0;
    for (std::size_t k = 0; k < out.size(); ++k) {
      double exact = 0;
      curve.evaluate(run.at(static_cast<std::int64_t>(k)), std::span(&exact, 1));
      worst = std::max(worst, std::abs(double(out[k]) - exact));
    }
    EXPECT_LE(worst, program.max_error()) << "curve " << i << ", degree " << curve.degree();
    worst_share = std::max(worst_share, worst / program.max_error());
  }
  std::printf("largest error seen: %.2f of the proved one\n", worst_share);
  EXPECT_GT(worst_share, 0.1);  // the bound says something
}

// Weights and points from 1e-6 to 1e6, knots of every kind.
TEST(FastProgram, NastyCurvesAreWithinTheirProvedError) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(300); ++i) {
    test::Dice dice(seed * 1000 + std::uint64_t(i));
    const NurbsCurve curve = test::random_curve(dice);
    CompileOptions options;
    options.max_error = 1e-7 * test::largest_coordinate(curve);
    const auto compiled = compile_parametric(curve, options);
    if (!compiled) continue;
    const FastProgram program(*compiled, i % 2 == 0 ? 1e300 : 1e-6);
    for (int k = 0; k < 50; ++k) {
      const double u = test::random_parameter(dice, curve);
      const double step = (curve.u_max() - curve.u_min()) * std::ldexp(1.0, -dice.below(30));
      const GridRun run{u, step, dice.below(100) - 50};
      float out[5];
      double exact[kMaxDim];
      CurveCursor cursor;
      for (int c = 0; c < curve.dim(); ++c) {
        program.render(run, out, cursor, c);
        for (int n = 0; n < 5; ++n) {
          curve.evaluate(run.at(n), exact);
          ASSERT_LE(std::abs(double(out[n]) - exact[c]),
                    program.max_error(c) + 1e-11 * test::largest_coordinate(curve))
              << "curve " << i << ", u = " << run.at(n);
        }
      }
    }
  }
}

TEST(FastProgram, CubicsWithPointsInMinusOneToOneAreProvedTo116DecibelsAndSeenAt129) {
  const std::uint64_t seed = support::test_seed();
  double proved = 0, seen = 0;
  for (int i = 0; i < support::test_count(200); ++i) {
    Draws draw(seed + 8, i);
    testing::RandomCurveOptions options;
    options.min_degree = options.max_degree = 3;
    options.rational = false;
    const NurbsCurve curve = random_curve(draw, options);
    const FastProgram program = fast(curve);
    proved = std::max(proved, program.max_error());
    std::vector<float> out(4000);
    CurveCursor cursor;
    const GridRun run{curve.u_min(), (curve.u_max() - curve.u_min()) / 4000, 0};
    program.render(run, out, cursor);
    for (std::size_t k = 0; k < out.size(); ++k) {
      double exact = 0;
      curve.evaluate(run.at(static_cast<std::int64_t>(k)), std::span(&exact, 1));
      seen = std::max(seen, std::abs(double(out[k]) - exact));
    }
  }
  std::printf("proved %.1f dBFS, seen %.1f dBFS\n", 20 * std::log10(proved), 20 * std::log10(seen));
  EXPECT_LT(proved, 1.584e-6);
  EXPECT_LT(seen, 3.548e-7);
}

TEST(FastProgram, PiecesAboveTheAskedErrorArePlayedInDouble) {
  const NurbsCurve curve = line({0, 1, -1, 1, -1, 1, -1, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5}, 3);
  const FastProgram all = fast(curve);
  const FastProgram none = fast(curve, 1e-12);
  const FastProgram some = fast(curve, 4e-7);
  EXPECT_EQ(all.fast_piece_count(), all.accurate().piece_count());
  EXPECT_EQ(none.fast_piece_count(), 0);
  EXPECT_GT(some.fast_piece_count(), 0);
  EXPECT_LT(some.fast_piece_count(), some.accurate().piece_count());
  EXPECT_LE(some.max_error(), 4e-7 + some.accurate().max_error());
  EXPECT_LT(none.max_error(), 1e-7);
  std::vector<float> expected(300), out(300);
  CurveCursor cursor;
  const GridRun run{-0.1, 0.004, 0};
  none.accurate().render(run, expected, cursor);
  none.render(run, out, cursor);
  expect_same_bits(out, expected);
}

// The error of a quotient whose weights are 12 decades apart has no bound in float32.
TEST(FastProgram, PiecesWithoutABoundArePlayedInDouble) {
  const NurbsCurve curve =
      rational({0, 0, 0, 0.8125, 0, 0}, {1e6, 2.3e-5, 2.5e-5, 1e6, 1e6, 1e6}, 2);
  CompileOptions options;
  options.max_error = 1e-5;
  const FastProgram program(*compile_parametric(curve, options));
  EXPECT_LT(program.fast_piece_count(), program.accurate().piece_count());
  EXPECT_TRUE(std::isfinite(program.max_error()));
  std::vector<float> out(257);
  program.evaluate_grid(MapGrid{0, 1, 256}, 0, out);
  for (int i = 0; i <= 256; ++i) {
    double exact = 0;
    curve.evaluate(i / 256.0, std::span(&exact, 1));
    EXPECT_LE(std::abs(double(out[std::size_t(i)]) - exact), program.max_error()) << i;
  }
}

TEST(FastProgram, AllCoordinatesInOnePassHaveTheBitsOfOneAtATime) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(60); ++i) {
    Draws draw(seed + 9, i);
    testing::RandomCurveOptions options;
    options.dim = draw.whole(1, 4);
    const NurbsCurve curve = random_curve(draw, options);
    const FastProgram program = fast(curve, draw.chance(0.5) ? 1e300 : 5e-7);
    const GridRun run = random_run(draw, curve);
    std::vector<std::vector<float>> all(4, std::vector<float>(333));
    const std::span<float> outs[] = {all[0], all[1], all[2], all[3]};
    CurveCursor cursor;
    program.render(run, std::span(outs).first(std::size_t(curve.dim())), cursor);
    for (int c = 0; c < curve.dim(); ++c) {
      std::vector<float> one(333);
      program.render(run, one, cursor, c);
      expect_same_bits(all[std::size_t(c)], one);
    }
  }
}

TEST(FastProgram, NeverLeavesItsHull) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(200); ++i) {
    Draws draw(seed + 3, i);
    CurveSpec spec = random_curve(draw).spec();
    for (double& x : spec.points) x = draw.chance(0.6) ? 0.3 : (draw.chance(0.5) ? 0.2 : 0.7);
    const FastProgram program = fast(made(std::move(spec)));
    const CurveProgram& accurate = program.accurate();
    std::vector<float> out(700);
    CurveCursor cursor;
    program.render(GridRun{accurate.u_min(), (accurate.u_max() - accurate.u_min()) / 699, 0}, out,
                   cursor);
    for (const float y : out) {
      ASSERT_GE(y, static_cast<float>(accurate.low()));
      ASSERT_LE(y, static_cast<float>(accurate.high()));
    }
  }
}

TEST(FastProgram, HostileGridsGiveWhatTheAccurateProgramGives) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const FastProgram& program : {fast(line({0.25, 0.3, 1, 0.2, -0.5}, 3)), fast(cycle())}) {
    for (const GridRun& run :
         {GridRun{nan, 0.1, 0}, GridRun{0, nan, 0}, GridRun{inf, -inf, 3}, GridRun{0, inf, -3},
          GridRun{0, 1e308, -5}, GridRun{1e16, 0.01, 0}, GridRun{0.3, 0, 5},
          GridRun{0.1, -1e300, 7}, GridRun{0.1, 0.37, std::int64_t{1} << 58}}) {
      for (const int most : {1, 33}) {
        Draws draw(3, most);
        const std::vector<float> out = in_blocks(program, run, 80, draw, most);
        CurveCursor cursor;
        std::vector<float> expected(out.size());
        program.accurate().render(run, expected, cursor);
        for (std::size_t i = 0; i < out.size(); ++i) {
          ASSERT_NEAR(out[i], expected[i], 2 * program.max_error()) << i;
        }
      }
    }
  }
}

TEST(FastProgram, FarFromZeroItIsStillWithinItsError) {
  const FastProgram program = fast(cycle());
  for (const double origin : {0.0, 1e3, 1e6, 3e6, 4e6, 1e7, 1e9}) {
    const GridRun run{origin, 1e-3, 1000};
    std::vector<float> out(3000);
    CurveCursor cursor;
    program.render(run, out, cursor);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double exact = program.accurate().at_u(run.at(static_cast<std::int64_t>(i)));
      ASSERT_LE(std::abs(double(out[i]) - exact), program.max_error()) << origin << ", " << i;
    }
  }
}

TEST(FastProgram, AGridHasItsLastNodeExactly) {
  const FastProgram program = fast(line({0.1, 0.7, 0.3, 0.9}, 3));
  std::vector<float> out(6);
  program.evaluate_grid(MapGrid{0, 1, 97}, 95, out);
  EXPECT_EQ(out[2], 0.9F);
  EXPECT_EQ(out[5], 0.9F);
}

TEST(FastProgram, RenderingDoesNotAllocate) {
  const FastProgram program = fast(rational({0, 0.9, 0.2, 0.6, -0.3, 0}, {1, 2, 0.5, 1, 1, 1}, 3));
  std::vector<float> out(512);
  const std::span<float> outs[] = {out};
  CurveCursor cursor;
  const std::int64_t before = support::allocation_count();
  program.render(GridRun{-0.1, 0.003, 5}, out, cursor);
  program.render(GridRun{-0.1, 0.003, 5}, outs, cursor);
  program.evaluate_grid(MapGrid{0, 1, 511}, 0, out);
  EXPECT_EQ(support::allocation_count() - before, 0);
}

TEST(FastProgram, EveryBuildAndVectorUnitGivesTheSameBits) {
  for (const SimdLevel level : simd_levels()) {
    const SimdGuard guard(level);
    base::Sha256 hash;
    for (int i = 0; i < 40; ++i) {
      Draws draw(21, i);
      const NurbsCurve curve = random_curve(draw);
      const FastProgram program = fast(curve);
      std::vector<float> out(701);
      CurveCursor cursor;
      program.render(random_run(draw, curve), out, cursor);
      hash.update(out);
      const double error = program.max_error() - program.accurate().max_error();
      hash.update(std::as_bytes(std::span(&error, 1)));
    }
    EXPECT_EQ(hash.finish_hex(), "19ac58bad531ba4b61a7545153870cfcc79964c455b01eff89f3b8431cfdfdec")
        << simd_level_name();
  }
}

}  // namespace
}  // namespace knotwave::curves

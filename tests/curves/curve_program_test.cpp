// SPDX-License-Identifier: MIT
#include "knotwave/curves/curve_program.h"

#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/curves/compile.h"

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

CurveProgram compiled(const NurbsCurve& curve, const CompileOptions& options = {}) {
  auto program = compile_parametric(curve, options);
  if (!program) ADD_FAILURE() << program.error().message;
  return std::move(*program);
}

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }
std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

NurbsCurve with_jump() {
  CurveSpec spec;
  spec.name = "jump";
  spec.degree = 2;
  spec.points = {0, 0.5, 1, -1, 0.25, 0.5};
  spec.knots = {0, 0, 0, 0.4, 0.4, 0.4, 1, 1, 1};
  spec.jumps = {0.4};
  return made(std::move(spec));
}

template <class Float>
std::vector<Float> in_blocks(const CurveProgram& program, const GridRun& run, std::size_t count,
                             std::size_t block, int coordinate) {
  std::vector<Float> out(count);
  CurveCursor cursor{3};
  for (std::size_t i = 0; i < count; i += block) {
    GridRun part = run;
    part.first += static_cast<std::int64_t>(i);
    program.render(part, std::span(out).subspan(i, std::min(block, count - i)), cursor, coordinate);
  }
  return out;
}

/// Every node of `run`, by blocks of every size, float and double, has the bits of at_u.
void expect_blocks_are_scalar(const CurveProgram& program, const GridRun& run, std::size_t count,
                              std::size_t max_block) {
  for (int c = 0; c < program.dim(); ++c) {
    for (std::size_t block = 1; block <= max_block; block += block < 8 ? 1 : 7) {
      const auto doubles = in_blocks<double>(program, run, count, block, c);
      const auto floats = in_blocks<float>(program, run, count, block, c);
      for (std::size_t i = 0; i < count; ++i) {
        const double one = program.at_u(run.at(static_cast<std::int64_t>(i)), c);
        ASSERT_EQ(bits(doubles[i]), bits(one)) << "sample " << i << ", block " << block;
        ASSERT_EQ(bits(floats[i]), bits(static_cast<float>(one)))
            << "sample " << i << ", block " << block;
      }
    }
  }
}

TEST(CurveProgram, IsTheConstantZeroByDefault) {
  const CurveProgram program;
  EXPECT_EQ(program.dim(), 1);
  EXPECT_EQ(program.piece_count(), 1);
  EXPECT_EQ(program.at_u(0.5), 0.0);
  EXPECT_EQ(program.slope_at_u(0.5), 0.0);
  std::vector<float> out(70, 1.0F);
  CurveCursor cursor;
  program.render(GridRun{-0.1, 0.02, 0}, out, cursor);
  for (const float y : out) EXPECT_EQ(y, 0.0F);
}

TEST(CurveProgram, EveryBlockSizeUpTo130HasTheBitsOfOneSampleAtATime) {
  for (const SimdLevel level : simd_levels()) {
    const SimdGuard guard(level);
    SCOPED_TRACE(simd_level_name());
    const CurveProgram bell = compiled(line({0, 0.3, 1, 0.2, -0.5, 0.1, 0}, 3));
    const GridRun run{-0.05, 0.0083, -2};
    for (std::size_t block = 1; block <= 130; ++block) {
      const auto doubles = in_blocks<double>(bell, run, 150, block, 0);
      const auto floats = in_blocks<float>(bell, run, 150, block, 0);
      for (std::size_t i = 0; i < doubles.size(); ++i) {
        const double one = bell.at_u(run.at(static_cast<std::int64_t>(i)));
        ASSERT_EQ(bits(doubles[i]), bits(one)) << "sample " << i << ", block " << block;
        ASSERT_EQ(bits(floats[i]), bits(static_cast<float>(one)));
      }
    }
  }
}

TEST(CurveProgram, RandomCurvesHaveTheSameBitsInBlocksOnEveryVectorUnit) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(120); ++i) {
    Draws draw(seed, i);
    testing::RandomCurveOptions options;
    options.dim = draw.whole(1, 3);
    const NurbsCurve curve = random_curve(draw, options);
    const CurveProgram program = compiled(curve);
    const double length = curve.u_max() - curve.u_min();
    const GridRun run{curve.u_min() - draw.between(-0.2, 0.4) * length,
                      draw.between(-1, 1) * length * (draw.chance(0.2) ? 0.3 : 0.01),
                      draw.whole(-300, 300)};
    SCOPED_TRACE(i);
    for (const SimdLevel level : simd_levels()) {
      const SimdGuard guard(level);
      expect_blocks_are_scalar(program, run, 150, 130);
    }
  }
}

TEST(CurveProgram, FarIndicesHaveTheBitsOfOneSampleAtATime) {
  CurveSpec spec;
  spec.name = "cycle";
  spec.points = {0, 1, 0, -1, 0.5};
  spec.periodic = true;
  const CurveProgram cycle = compiled(made(std::move(spec)));
  for (const std::int64_t first :
       {std::int64_t{1} << 40, (std::int64_t{1} << 52) - 70, (std::int64_t{1} << 53) - 70,
        std::int64_t{1} << 58, -(std::int64_t{1} << 52) - 70}) {
    expect_blocks_are_scalar(cycle, GridRun{0.1, 0.37, first}, 140, 70);
    expect_blocks_are_scalar(cycle, GridRun{0.1, 1e-9, first}, 140, 70);
  }
}

TEST(CurveProgram, ArraysInAnyOrderHaveTheBitsOfOneSampleAtATime) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(100); ++i) {
    Draws draw(seed + 1, i);
    const NurbsCurve curve = random_curve(draw);
    const CurveProgram program = compiled(curve);
    const double length = curve.u_max() - curve.u_min();
    std::vector<double> u(200);
    double walk = curve.u_min();
    for (double& x : u) {
      walk += draw.between(-0.02, 0.03) * length;
      x = i % 2 == 0 ? walk : curve.u_min() + draw.between(-0.5, 1.5) * length;
    }
    std::vector<double> out(u.size());
    for (const int hint : {0, 5, -7, 1 << 30}) {
      CurveCursor cursor{hint};
      program.render(u, out, cursor);
      for (std::size_t k = 0; k < u.size(); ++k) {
        ASSERT_EQ(bits(out[k]), bits(program.at_u(u[k]))) << "curve " << i << ", u = " << u[k];
      }
    }
  }
}

TEST(CurveProgram, ControlsThatMoveEverySampleHaveTheBitsOfOneSampleAtATime) {
  const NurbsCurve curve = rational({0, 0.9, 0.2, 0.6, -0.3, 0}, {1, 2, 0.5, 1, 1, 1}, 3);
  CompileOptions options;
  options.controls = {{ControlRange::Kind::weight, 1, 0, 0.1, 10},
                      {ControlRange::Kind::coordinate, 3, 0, -1, 1},
                      {ControlRange::Kind::coordinate, 5, 0, -0.5, 0.5}};
  const CurveProgram program = compiled(curve, options);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Draws draw(support::test_seed(), 0);
  std::vector<double> u(131), out(131), weight(131), point(131), end(131);
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = draw.chance(0.1) ? draw.between(-1, 2) : -0.1 + 0.01 * static_cast<double>(i);
    weight[i] = draw.chance(0.1) ? nan : draw.between(-5, 15);
    point[i] = draw.between(-1.5, 1.5);
    end[i] = draw.between(-1, 1);
  }
  for (const SimdLevel level : simd_levels()) {
    const SimdGuard guard(level);
    for (std::size_t block = 1; block <= u.size(); ++block) {
      CurveCursor cursor;
      for (std::size_t i = 0; i < u.size(); i += block) {
        const std::size_t n = std::min(block, u.size() - i);
        const double* controls[] = {weight.data() + i, point.data() + i, end.data() + i};
        program.render(std::span(u).subspan(i, n), controls, std::span(out).subspan(i, n), cursor);
      }
      for (std::size_t i = 0; i < u.size(); ++i) {
        const double controls[] = {weight[i], point[i], end[i]};
        ASSERT_EQ(bits(out[i]), bits(program.at_u(u[i], 0, controls))) << i << " of " << block;
      }
    }
  }
}

TEST(CurveProgram, AGridHasItsLastNodeExactly) {
  const CurveProgram program = compiled(line({0.1, 0.7, 0.3, 0.9}, 3));
  const MapGrid grid{0.1, 0.7, 3};
  std::vector<float> out(6);
  program.evaluate_grid(grid, 0, out);
  for (std::int64_t i = 0; i < 6; ++i) {
    EXPECT_EQ(bits(out[static_cast<std::size_t>(i)]),
              bits(static_cast<float>(program.at_u(grid.at(i)))));
  }
  program.evaluate_grid(MapGrid{0, 1, 97}, 95, out);
  EXPECT_EQ(out[2], 0.9F);
}

TEST(CurveProgram, ClampedEndsAreTheControlPointsToTheBit) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < 200; ++i) {
    Draws draw(seed + 2, i);
    const NurbsCurve curve = random_curve(draw);
    if (!curve.is_clamped()) continue;
    const CurveProgram program = compiled(curve);
    const double first = curve.points().front();
    const double last = curve.points().back();
    EXPECT_EQ(program.at_u(curve.u_min()), first);
    EXPECT_EQ(program.at_u(curve.u_max()), last);
    EXPECT_EQ(program.at_u(curve.u_min() - 1), first);
    EXPECT_EQ(program.at_u(curve.u_max() + 1), last);
  }
}

TEST(CurveProgram, HostileParametersGiveTheEnds) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CurveProgram bell = compiled(line({0.25, 0.3, 1, 0.2, -0.5}, 3));
  EXPECT_EQ(bell.at_u(nan), 0.25);
  EXPECT_EQ(bell.at_u(-inf), 0.25);
  EXPECT_EQ(bell.at_u(-1e300), 0.25);
  EXPECT_EQ(bell.at_u(inf), -0.5);
  EXPECT_EQ(bell.at_u(1e300), -0.5);
  CurveSpec spec;
  spec.name = "cycle";
  spec.points = {0, 1, 0, -1, 0.5};
  spec.periodic = true;
  const CurveProgram cycle = compiled(made(std::move(spec)));
  const double seam = cycle.at_u(0.0);
  for (const double u : {nan, inf, -inf, 1e300, -1e300, 1.0, -3.0, 1048576.0}) {
    EXPECT_EQ(bits(cycle.at_u(u)), bits(seam)) << u;
    EXPECT_TRUE(std::isfinite(cycle.slope_at_u(u)));
  }
  for (const CurveProgram* program : {&bell, &cycle}) {
    for (const GridRun& run :
         {GridRun{nan, 0.1, 0}, GridRun{0, nan, 0}, GridRun{inf, -inf, 3}, GridRun{0, inf, -3},
          GridRun{0, 1e308, -5}, GridRun{1e16, 0.01, 0}, GridRun{0.3, 0, 5}}) {
      expect_blocks_are_scalar(*program, run, 40, 33);
    }
  }
}

TEST(CurveProgram, HasTheRightHandValueAndSlopeAtAJump) {
  const CurveProgram program = compiled(with_jump());
  EXPECT_EQ(program.at_u(0.4), -1.0);
  EXPECT_NEAR(program.at_u(std::nextafter(0.4, 0.0)), 1.0, 1e-15);
  EXPECT_NEAR(program.slope_at_u(0.4), 2 * 1.25 / 0.6, 1e-13);
  EXPECT_NEAR(program.slope_at_u(std::nextafter(0.4, 0.0)), 2 * 0.5 / 0.4, 1e-13);
  expect_blocks_are_scalar(program, GridRun{0, 0.02, 0}, 60, 60);
}

TEST(CurveProgram, NeverLeavesItsHull) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(200); ++i) {
    Draws draw(seed + 3, i);
    // Many equal points: curves that run along their hull.
    CurveSpec spec = random_curve(draw).spec();
    for (double& x : spec.points) x = draw.chance(0.6) ? 0.3 : (draw.chance(0.5) ? 0.3 - 0.1 : 0.7);
    const CurveProgram program = compiled(made(std::move(spec)));
    for (int k = 0; k <= 500; ++k) {
      const double y =
          program.at_u(program.u_min() + (program.u_max() - program.u_min()) * k / 500);
      ASSERT_GE(y, program.low());
      ASSERT_LE(y, program.high());
    }
  }
}

TEST(CurveProgram, SlopeIsTheDerivativeOfTheCurve) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(200); ++i) {
    Draws draw(seed + 4, i);
    const NurbsCurve curve = random_curve(draw);
    const CurveProgram program = compiled(curve);
    for (int k = 0; k < 20; ++k) {
      const double u = curve.u_min() + draw.unit() * (curve.u_max() - curve.u_min());
      double jet[2];
      curve.derivatives(u, 1, Side::right, jet);
      EXPECT_NEAR(program.slope_at_u(u), jet[1], 1e-10 * (1 + std::abs(jet[1])));
    }
    if (curve.is_periodic()) continue;
    double jet[2];
    curve.derivatives(curve.u_max(), 1, Side::left, jet);
    EXPECT_NEAR(program.slope_at_u(curve.u_max()), jet[1], 1e-10 * (1 + std::abs(jet[1])));
  }
}

TEST(CurveProgram, RenderingDoesNotAllocate) {
  const CurveProgram program = compiled(line({0, 0.3, 1, 0.2, -0.5, 0.1, 0}, 3));
  std::vector<float> floats(512);
  std::vector<double> doubles(512), u(512, 0.3);
  CurveCursor cursor;
  const std::int64_t before = support::allocation_count();
  program.render(GridRun{0, 0.01, 0}, floats, cursor);
  program.render(GridRun{0, 0.01, 0}, doubles, cursor);
  program.render(u, doubles, cursor);
  program.evaluate_grid(MapGrid{0, 1, 511}, 0, floats);
  EXPECT_EQ(program.slope_at_u(0.0) != 0.0, true);
  EXPECT_EQ(support::allocation_count() - before, 0);
}

TEST(CurveProgram, CoefficientsArePowersOfTheLocalParameter) {
  const CurveProgram program = compiled(line({1, 2, 4}, 2));
  const auto c = program.coefficients(0);
  ASSERT_EQ(c.size(), 3U);
  EXPECT_EQ(c[0], 1.0);
  EXPECT_EQ(c[1], 2.0);
  EXPECT_EQ(c[2], 1.0);
}

}  // namespace
}  // namespace knotwave::curves

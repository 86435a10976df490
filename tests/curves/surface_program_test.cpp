// SPDX-License-Identifier: MIT
#include "knotwave/curves/surface_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"

#include "random_curve.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::NurbsSurface;
using curves::SurfaceProgram;
using curves::SurfaceSpec;

using base::index_of;

std::vector<double> random_knots(Dice& dice, int count, int degree) {
  std::vector<double> knots(index_of(count + degree + 1));
  double at = dice.between(-2, 2);
  for (double& knot : knots) {
    knot = at;
    if (!dice.one_in(4)) at += dice.one_in(10) ? 1e-9 : dice.between(0.01, 1);
  }
  return knots;
}

// Any degree to 7, any knots a surface may have, rational or not, periodic or not.
NurbsSurface random_surface(Dice& dice) {
  while (true) {
    SurfaceSpec spec;
    spec.name = "random";
    spec.degree_u = 1 + dice.below(7);
    spec.degree_v = 1 + dice.below(7);
    spec.dim = 1 + dice.below(4);
    spec.count_u = spec.degree_u + 1 + dice.below(5);
    spec.count_v = spec.degree_v + 1 + dice.below(5);
    spec.periodic_u = dice.one_in(3);
    const double size = dice.one_in(4) ? 1e5 : 1;
    const int count = spec.count_u * spec.count_v;
    for (int i = 0; i < count * spec.dim; ++i) spec.points.push_back(dice.between(-size, size));
    if (dice.one_in(2)) {
      for (int i = 0; i < count; ++i) spec.weights.push_back(dice.between(0.1, 3));
    }
    if (dice.one_in(2)) spec.knots_v = random_knots(dice, spec.count_v, spec.degree_v);
    if (!spec.periodic_u && dice.one_in(2)) {
      spec.knots_u = random_knots(dice, spec.count_u, spec.degree_u);
    }
    auto surface = NurbsSurface::create(std::move(spec));
    if (surface) return std::move(*surface);
  }
}

struct Uv {
  double u, v;
};
Uv random_place(Dice& dice, const NurbsSurface& surface) {
  const auto one = [&](std::span<const double> knots, double low, double high) {
    if (dice.one_in(4))
      return std::clamp(knots[index_of(dice.below(int(knots.size())))], low, high);
    return dice.between(low, high);
  };
  return {one(surface.knots_u(), surface.u_min(), surface.u_max()),
          one(surface.knots_v(), surface.v_min(), surface.v_max())};
}

SurfaceProgram compiled(const NurbsSurface& surface) {
  auto program = curves::compile_surface(surface);
  EXPECT_TRUE(program) << (program ? "" : program.error().message);
  return std::move(*program);
}

TEST(SurfaceProgram, IsTheSurfaceWithinTheErrorItStates) {
  Dice dice(support::test_seed());
  double worst = 0;  // stated error over the largest coordinate
  for (int round = 0; round < support::test_count(200); ++round) {
    const NurbsSurface surface = random_surface(dice);
    const SurfaceProgram program = compiled(surface);
    double largest = 0;
    for (const double x : surface.points()) largest = std::max(largest, std::abs(x));
    worst = std::max(worst, program.max_error() / largest);
    for (int k = 0; k < 20; ++k) {
      const Uv place = random_place(dice, surface);
      double exact[curves::kMaxDim];
      surface.evaluate(place.u, place.v, exact);
      for (int c = 0; c < surface.dim(); ++c) {
        const double value = program.at(place.u, place.v, c);
        ASSERT_LE(std::abs(value - exact[c]), program.max_error())
            << "round " << round << ", " << place.u << ", " << place.v;
        ASSERT_TRUE(value >= program.low(c) && value <= program.high(c));
      }
    }
  }
  EXPECT_LT(worst, 1e-7) << "-140 dB for every degree to 7 and weights from 0.1 to 3";
}

TEST(SurfaceProgram, ARowIsItsPointsToTheBit) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(60); ++round) {
    const NurbsSurface surface = random_surface(dice);
    const SurfaceProgram program = compiled(surface);
    std::vector<double> u, row(30);
    for (int i = 0; i < 30; ++i) u.push_back(random_place(dice, surface).u);
    if (dice.one_in(2)) std::sort(u.begin(), u.end());
    const double v = random_place(dice, surface).v;
    program.render_row(u, v, row);
    for (std::size_t i = 0; i < u.size(); ++i) ASSERT_EQ(row[i], program.at(u[i], v));
  }
}

TEST(SurfaceProgram, APathIsItsPointsToTheBit) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(60); ++round) {
    const NurbsSurface surface = random_surface(dice);
    const SurfaceProgram program = compiled(surface);
    std::vector<double> u, v, path(30);
    for (int i = 0; i < 30; ++i) {
      const Uv place = random_place(dice, surface);
      u.push_back(place.u);
      v.push_back(place.v);
    }
    const int coordinate = dice.below(surface.dim());
    program.render_path(u, v, path, coordinate);
    for (std::size_t i = 0; i < u.size(); ++i) {
      ASSERT_EQ(path[i], program.at(u[i], v[i], coordinate));
    }
  }
}

TEST(SurfaceProgram, SlopesAreThePartialDerivatives) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(100); ++round) {
    const NurbsSurface surface = random_surface(dice);
    const SurfaceProgram program = compiled(surface);
    const Uv place = random_place(dice, surface);
    std::vector<double> exact(4 * index_of(surface.dim()));
    surface.derivatives(place.u, place.v, 1, exact);
    double narrowest = 1, largest = 1;
    const auto look_at = [&](std::span<const double> breaks) {
      for (std::size_t i = 1; i < breaks.size(); ++i) {
        narrowest = std::min(narrowest, breaks[i] - breaks[i - 1]);
      }
    };
    look_at(program.breaks_u());
    look_at(program.breaks_v());
    for (const double x : surface.points()) largest = std::max(largest, std::abs(x));
    for (int c = 0; c < surface.dim(); ++c) {
      const auto slopes = program.slopes_at(place.u, place.v, c);
      // Index k * 2 + l: by v is 1, by u is 2.
      EXPECT_NEAR(slopes.by_v, exact[index_of(surface.dim() + c)], 1e-9 * largest / narrowest);
      EXPECT_NEAR(slopes.by_u, exact[index_of(2 * surface.dim() + c)], 1e-9 * largest / narrowest);
    }
  }
}

TEST(SurfaceProgram, WrapsAPeriodAndHoldsWhatEnds) {
  SurfaceSpec spec;
  spec.name = "wrap";
  spec.degree_u = 2;
  spec.degree_v = 1;
  spec.count_u = 4;
  spec.count_v = 2;
  spec.periodic_u = true;
  spec.points = {0, 1, 2, 3, 10, 11, 12, 13};
  const SurfaceProgram program = compiled(*NurbsSurface::create(spec));
  EXPECT_EQ(program.at(1.25, 0.5), program.at(0.25, 0.5));
  EXPECT_EQ(program.at(-0.75, 0.5), program.at(0.25, 0.5));
  EXPECT_EQ(program.at(1, 0.5), program.at(0, 0.5));
  EXPECT_EQ(program.at(0.25, -7), program.at(0.25, 0));
  EXPECT_EQ(program.at(0.25, 7), program.at(0.25, 1));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(program.at(kNan, kNan), program.at(0, 0));
  EXPECT_EQ(program.at(kInfinity, kInfinity), program.at(0, 1));
}

TEST(SurfaceProgram, WithoutASurfaceItIsNothing) {
  const SurfaceProgram nothing;
  EXPECT_EQ(nothing.at(0.5, 0.5), 0);
  EXPECT_EQ(nothing.slopes_at(0.5, 0.5).by_u, 0);
}

TEST(SurfaceProgram, TellsWhatCannotBePlayed) {
  SurfaceSpec spec;
  spec.name = "steep";
  spec.degree_u = 8;
  spec.degree_v = 1;
  spec.count_u = 9;
  spec.count_v = 2;
  spec.points.assign(18, 0.5);
  const auto program = curves::compile_surface(*NurbsSurface::create(spec));
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::degree_out_of_range);
  EXPECT_EQ(program.error().message,
            "surface 'steep': degree 8 along u is above 7, the most that can be played");
}

TEST(SurfaceProgram, PlayingAllocatesNothing) {
  Dice dice(support::test_seed());
  const NurbsSurface surface = random_surface(dice);
  const SurfaceProgram program = compiled(surface);
  std::array<double, 100> u{}, out{};
  EXPECT_EQ(support::allocations_in([&] {
              program.render_row(u, 0.5, out);
              out[0] = program.at(0.1, 0.2) + program.slopes_at(0.1, 0.2).by_v;
            }),
            0);
}

}  // namespace
}  // namespace knotwave::test

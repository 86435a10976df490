// SPDX-License-Identifier: MIT
// Grids and meshes of maps: rows of docs/from-opengl.md.
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/index.h"
#include "knotwave/curves/map.h"

#include "map_examples.h"
#include "random_curve.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using base::index_of;
using curves::CurveSpec;
using curves::Map1;
using curves::Map2;
using curves::MapGrid;
using curves::MapSet;
using curves::MapValues;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::SurfaceSpec;
using curves::Target;
using testing::ElementsAre;

TEST(Map, GridEndsAreTheEndsOfTheCurve) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(300); ++round) {
    CurveSpec spec = random_spec(dice);
    spec.periodic = false;
    spec.dim = 1;
    spec.degree = 3;
    spec.knots.clear();
    spec.jumps.clear();
    spec.weights.clear();
    spec.points = {dice.between(-9, 9), dice.between(-9, 9), dice.between(-9, 9),
                   dice.between(-9, 9), dice.between(-9, 9)};
    const double first = spec.points.front(), last = spec.points.back();
    const double u1 = dice.between(-1, 1), u2 = u1 + dice.between(0.1, 3);
    MapSet maps;
    enable(maps, Map1{Target::amp, u1, u2, *NurbsCurve::create(spec)});
    const int n = 1 + dice.below(1000);
    std::vector<double> out(index_of(n + 1));
    const MapSet::Channel channel{Target::amp, 0, out};
    maps.evaluate_grid({u1, u2, n}, 0, {&channel, 1});
    EXPECT_EQ(out.front(), first);
    EXPECT_EQ(out.back(), last);
  }
}

// A set of everything: curves of any kind, plain and rational, on several targets.
MapSet random_maps(Dice& dice) {
  MapSet maps;
  for (int i = 0; i < 6; ++i) {
    NurbsCurve curve = random_curve(dice, 1 + dice.below(7));
    constexpr Target kWide[] = {Target::modulation, Target::free_1, Target::free_2, Target::free_3};
    const Target target = curve.dim() == 1 ? static_cast<Target>(dice.below(curves::kTargetCount))
                                           : kWide[dice.below(4)];
    const double u1 = dice.between(-2, 2), u2 = u1 + dice.between(-3, 3);
    const auto key = maps.define(Map1{target, u1, u2, std::move(curve), 1e-3});
    if (key) maps.enable(*key, !dice.one_in(4));  // a fitted one may miss its error
  }
  return maps;
}

TEST(Map, AGridIsEvaluateToTheBit) {
  Dice dice(support::test_seed());
  for (int round = 0; round < support::test_count(60); ++round) {
    const MapSet maps = random_maps(dice);
    const MapGrid grid{dice.between(-3, 3), dice.between(-3, 3), 1 + dice.below(200)};
    const std::int64_t first = dice.below(20) - 10;
    std::vector<std::vector<double>> out(index_of(2 * curves::kTargetCount),
                                         std::vector<double>(150));
    std::vector<MapSet::Channel> channels;
    for (int t = 0; t < curves::kTargetCount; ++t) {
      for (int c = 0; c < 2; ++c) {
        channels.push_back({static_cast<Target>(t), c, out[index_of(2 * t + c)]});
      }
    }
    maps.evaluate_grid(grid, first, channels);
    for (int i = 0; i < 150; ++i) {
      MapValues values;
      maps.evaluate(grid.at(first + i), values);
      for (const auto& channel : channels) {
        const auto numbers = values.of(channel.target);
        const bool is_there = channel.coordinate < static_cast<int>(numbers.size());
        ASSERT_EQ(
            std::bit_cast<std::uint64_t>(channel.out[index_of(i)]),
            std::bit_cast<std::uint64_t>(is_there ? numbers[index_of(channel.coordinate)] : 0.0))
            << to_string(channel.target) << " node " << i;
      }
    }
  }
}

TEST(Map, AnySplitOfAGridGivesTheSameBits) {
  MapSet maps;
  CurveSpec spec;
  spec.name = "split";
  spec.degree = 3;
  spec.points = {0, 1, -1, 0.5, 0.25, 1, 0};
  spec.weights = {1, 2, 1, 0.5, 1, 3, 1};
  spec.knots = {0, 0, 0, 0, 0.2, 0.5, 0.7, 1, 1, 1, 1};
  enable(maps, Map1{Target::amp, 0.1, 0.9, *NurbsCurve::create(spec)});
  const MapGrid grid{0, 1, 999};
  support::expect_block_size_does_not_matter<double>(1000, [&] {
    return [&](std::size_t first, std::span<double> out) {
      const MapSet::Channel channel{Target::amp, 0, out};
      maps.evaluate_grid(grid, static_cast<std::int64_t>(first), {&channel, 1});
    };
  });
}

TEST(Map, AMeshIsEvaluateToTheBitRowByRow) {
  MapSet maps;
  SurfaceSpec spec;
  spec.name = "mesh";
  spec.degree_u = 3;
  spec.degree_v = 2;
  spec.count_u = 6;
  spec.count_v = 4;
  spec.periodic_u = true;
  Dice dice(support::test_seed());
  for (int i = 0; i < 24; ++i) {
    spec.points.push_back(dice.between(-1, 1));
    spec.weights.push_back(dice.between(0.3, 3));
  }
  enable(maps, Map2{Target::amp, 0, 1, 0, 1, *NurbsSurface::create(spec)});
  const MapGrid grid_u{-0.5, 1.5, 200}, grid_v{0, 1, 7};
  constexpr int kRow = 201;
  std::vector<double> whole(kRow * 8);
  const MapSet::Channel channel{Target::amp, 0, whole};
  maps.evaluate_mesh(grid_u, 0, kRow, grid_v, 0, {&channel, 1});
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < kRow; ++i) {
      MapValues values;
      maps.evaluate(grid_u.at(i), grid_v.at(j), values);
      ASSERT_EQ(values.of(Target::amp)[0], whole[index_of(j * kRow + i)]) << i << ", " << j;
    }
  }
  // A part of each of two rows.
  std::vector<double> part(2 * 30, 7), constant(4);
  const MapSet::Channel channels[] = {{Target::amp, 0, part}, {Target::pan, 0, constant}};
  maps.set_current(Target::pan, std::array{0.5});
  maps.evaluate_mesh(grid_u, 90, 30, grid_v, 3, channels);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(part[index_of(i)], whole[index_of((3 + i / 30) * kRow + 90 + i % 30)]);
  }
  EXPECT_THAT(constant, ElementsAre(0.5, 0.5, 0.5, 0.5));
}

}  // namespace
}  // namespace knotwave::test

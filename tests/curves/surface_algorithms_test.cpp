// SPDX-License-Identifier: MIT
#include "knotwave/curves/surface_algorithms.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/algorithms.h"

#include "random_surface.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::Direction;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::SurfaceSpec;
using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr Direction kBoth[] = {Direction::u, Direction::v};

NurbsSurface made(SurfaceSpec spec) {
  auto surface = NurbsSurface::create(std::move(spec));
  EXPECT_TRUE(surface) << (surface ? "" : surface.error().message);
  return std::move(*surface);
}

NurbsSurface value_of(Result<NurbsSurface> surface) {
  EXPECT_TRUE(surface) << (surface ? "" : surface.error().message);
  return std::move(*surface);
}

std::span<const double> knots_of(const NurbsSurface& surface, Direction direction) {
  return direction == Direction::u ? surface.knots_u() : surface.knots_v();
}

double low_of(const NurbsSurface& surface, Direction direction) {
  return direction == Direction::u ? surface.u_min() : surface.v_min();
}
double high_of(const NurbsSurface& surface, Direction direction) {
  return direction == Direction::u ? surface.u_max() : surface.v_max();
}

// Three rows of three, quadratic along u and linear along v.
NurbsSurface sample(bool periodic = false) {
  SurfaceSpec spec;
  spec.name = "pad";
  spec.degree_u = 2;
  spec.degree_v = 1;
  spec.count_u = spec.count_v = 3;
  spec.points = {0, 1, 2, 3, 4, 8, 5, 5, 1};
  spec.weights = {1, 2, 1, 1, 3, 1, 2, 2, 2};
  spec.periodic_u = periodic;
  return made(spec);
}

// What happens to 1 row is what happens to its curve, so 300 surfaces are thousands of curves.
template <class Edit>
void expect_same_surface(Edit edit) {
  Dice dice(support::test_seed());
  double worst = 0;
  const int count = support::test_count(300);
  for (int round = 0; round < count; ++round) {
    const NurbsSurface surface = random_surface(dice);
    for (const Direction direction : kBoth) {
      const NurbsSurface edited = value_of(edit(dice, surface, direction));
      worst = std::max(worst, surface_distance_ulp(dice, surface, edited));
    }
  }
  std::printf("worst of %d surfaces: %.2f ulp of max|P|\n", count, worst);
  EXPECT_LE(worst, 4);
}

TEST(SurfaceEdits, InsertionIsTheSameSurface) {
  expect_same_surface([](Dice& dice, const NurbsSurface& surface, Direction direction) {
    return insert_knot(surface, direction, dice.between(0.001, 0.009), 1);
  });
}

TEST(SurfaceEdits, RefinementIsTheSameSurface) {
  expect_same_surface([](Dice& dice, const NurbsSurface& surface, Direction direction) {
    const std::vector<double> knots = {dice.unit(), dice.unit(), dice.unit()};
    return refine(surface, direction, knots);
  });
}

TEST(SurfaceEdits, ElevationIsTheSameSurface) {
  expect_same_surface([](Dice& dice, const NurbsSurface& surface, Direction direction) {
    return elevate_degree(surface, direction, 1 + dice.below(2));
  });
}

TEST(SurfaceEdits, PartsAreTheSameSurface) {
  expect_same_surface([](Dice& dice, const NurbsSurface& surface, Direction direction) {
    double a = dice.unit(), b = dice.unit();
    if (a > b) std::swap(a, b);
    auto part = sub_surface(surface, direction, a, b);
    EXPECT_EQ(low_of(*part, direction), a);
    EXPECT_EQ(high_of(*part, direction), b);
    EXPECT_FALSE(direction == Direction::u && part->is_periodic_u());
    return part;
  });
}

TEST(SurfaceEdits, RemovalTakesInsertedKnotsOutAgain) {
  expect_same_surface([](Dice& dice, const NurbsSurface& surface, Direction direction) {
    const double at = dice.between(0.001, 0.009);
    const int degree = direction == Direction::u ? surface.degree_u() : surface.degree_v();
    const int times = 1 + dice.below(degree);
    const NurbsSurface finer = value_of(insert_knot(surface, direction, at, times));
    const auto back = remove_knot(finer, direction, at, times, 1e-14);
    EXPECT_TRUE(back) << (back ? "" : back.error().message);
    EXPECT_EQ(back->removed, times);
    EXPECT_LE(back->max_error, 1e-14);
    EXPECT_THAT(knots_of(back->surface, direction), ElementsAreArray(knots_of(surface, direction)));
    return Result<NurbsSurface>(back->surface);
  });
}

TEST(SurfaceEdits, ReductionUndoesElevation) {
  expect_same_surface([](Dice&, const NurbsSurface& surface, Direction direction) {
    const NurbsSurface finer = value_of(elevate_degree(surface, direction));
    const auto back = reduce_degree(finer, direction, 1e-14);
    EXPECT_TRUE(back) << (back ? "" : back.error().message);
    EXPECT_EQ(back->removed, 1);
    return Result<NurbsSurface>(back->surface);
  });
}

// No place of a fine grid is farther than the bound, and the bound is no more than is promised of
// surfaces whose weights are the same from row to row.
TEST(SurfaceEdits, WhatIsRemovedStaysWithinTheBound) {
  Dice dice(support::test_seed());
  int removed = 0;
  for (int round = 0; round < 200; ++round) {
    const NurbsSurface surface = random_surface(dice);
    const Direction direction = kBoth[round % 2];
    const auto knots = knots_of(surface, direction);
    const double at = knots[knots.size() / 2];
    if (!(at > low_of(surface, direction) && at < high_of(surface, direction))) continue;
    const auto smaller = remove_knot(surface, direction, at, 1, 10);
    ASSERT_TRUE(smaller) << smaller.error().message;
    removed += smaller->removed;
    double worst = 0;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        const double u = surface.u_min() + (surface.u_max() - surface.u_min()) * i / 40;
        const double v = surface.v_min() + (surface.v_max() - surface.v_min()) * j / 40;
        double a[3], b[3], square = 0;
        surface.evaluate(u, v, a);
        smaller->surface.evaluate(u, v, b);
        for (int c = 0; c < surface.dim(); ++c) square += (a[c] - b[c]) * (a[c] - b[c]);
        worst = std::max(worst, std::sqrt(square));
      }
    }
    EXPECT_LE(worst, smaller->max_error + 1e-15);
  }
  EXPECT_GT(removed, 30);
}

TEST(SurfaceEdits, AToleranceThatIsTooSmallKeepsTheKnot) {
  SurfaceSpec spec = sample().spec();
  spec.degree_u = 1;
  spec.knots_u.clear();
  const NurbsSurface surface = made(spec);
  const auto kept = remove_knot(surface, Direction::u, 0.5, 1, 1e-3);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->removed, 0);
  EXPECT_EQ(kept->max_error, 0);
  EXPECT_TRUE(kept->surface == surface);
  const auto gone = remove_knot(surface, Direction::u, 0.5, 1, 20);
  ASSERT_TRUE(gone) << gone.error().message;
  EXPECT_EQ(gone->removed, 1);
  EXPECT_GT(gone->max_error, 0.1);
}

TEST(SurfaceEdits, SplitPartsShareTheirBorder) {
  const auto parts = split(sample(), Direction::v, 0.3);
  ASSERT_TRUE(parts) << parts.error().message;
  EXPECT_EQ(parts->low.v_max(), 0.3);
  EXPECT_EQ(parts->high.v_min(), 0.3);
  for (double u = 0; u <= 1; u += 0.125) {
    double low, high;
    parts->low.evaluate(u, 0.3, std::span(&low, 1));
    parts->high.evaluate(u, 0.3, std::span(&high, 1));
    EXPECT_EQ(low, high);
  }
}

TEST(SurfaceEdits, ReversedTwiceAndTransposedTwiceIsTheSurfaceToTheBit) {
  const NurbsSurface surface = sample();
  for (const Direction direction : kBoth) {
    const NurbsSurface back = value_of(reverse(surface, direction));
    double first, last;
    surface.evaluate(0.25, 0.5, std::span(&first, 1));
    const bool u = direction == Direction::u;
    back.evaluate(u ? 0.75 : 0.25, 0.5, std::span(&last, 1));
    EXPECT_DOUBLE_EQ(first, last);
    EXPECT_TRUE(value_of(reverse(back, direction)) == surface);
  }
  const NurbsSurface turned = value_of(transpose(surface));
  EXPECT_EQ(turned.degree_u(), 1);
  EXPECT_EQ(turned.degree_v(), 2);
  EXPECT_THAT(turned.points(), testing::ElementsAre(0, 3, 5, 1, 4, 5, 2, 8, 1));
  EXPECT_TRUE(value_of(transpose(turned)) == surface);
}

TEST(SurfaceEdits, PeriodicRowsStayPeriodicUntilTheyAreCut) {
  const NurbsSurface tube = sample(true);
  EXPECT_TRUE(value_of(insert_knot(tube, Direction::u, 0.4)).is_periodic_u());
  EXPECT_TRUE(value_of(elevate_degree(tube, Direction::u)).is_periodic_u());
  EXPECT_TRUE(value_of(insert_knot(tube, Direction::v, 0.4)).is_periodic_u());
  EXPECT_TRUE(value_of(sub_surface(tube, Direction::v, 0.1, 0.4)).is_periodic_u());
  EXPECT_FALSE(value_of(sub_surface(tube, Direction::u, 0.1, 0.4)).is_periodic_u());
  const auto turned = transpose(tube);
  ASSERT_FALSE(turned);
  EXPECT_EQ(turned.error().code, ErrorCode::unsupported);
}

TEST(SurfaceEdits, ReparametrizationKeepsPointsToTheBit) {
  const NurbsSurface surface = sample();
  const NurbsSurface longer = value_of(reparametrize(surface, Direction::v, -1, 3));
  EXPECT_EQ(longer.v_min(), -1);
  EXPECT_EQ(longer.v_max(), 3);
  EXPECT_EQ(longer.u_max(), 1);
  EXPECT_THAT(longer.points(), ElementsAreArray(surface.points()));
  EXPECT_THAT(longer.weights(), ElementsAreArray(surface.weights()));
}

TEST(SurfaceEdits, FaultsNameTheSurfaceTheDirectionAndItsParameter) {
  const NurbsSurface surface = sample();
  EXPECT_EQ(insert_knot(surface, Direction::u, 2).error().message,
            "surface 'pad' along u: u = 2 is outside 0..1");
  EXPECT_EQ(insert_knot(surface, Direction::v, 2).error().message,
            "surface 'pad' along v: v = 2 is outside 0..1");
  EXPECT_EQ(insert_knot(surface, Direction::v, 0.5, 3).error().message,
            "surface 'pad' along v: 3 more knots at v = 0.5 beside 1, degree 1 allows 1");
  EXPECT_EQ(sub_surface(surface, Direction::u, 0.5, 0.5).error().code, ErrorCode::empty_domain);
  EXPECT_EQ(remove_knot(surface, Direction::v, 0.3, 1, 1).error().code,
            ErrorCode::parameter_out_of_range);
  EXPECT_EQ(remove_knot(surface, Direction::v, 0.5, 1, -1).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(remove_knot(surface, Direction::v, 0.5, -1, 1).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(reduce_degree(surface, Direction::v, 1).error().code, ErrorCode::degree_out_of_range);
  const auto missed = reduce_degree(surface, Direction::u, 1e-6);
  ASSERT_FALSE(missed);
  EXPECT_EQ(missed.error().code, ErrorCode::error_bound_missed);
  EXPECT_THAT(missed.error().message, HasSubstr("surface 'pad' along u: at degree 1"));
  EXPECT_THAT(missed.error().message, HasSubstr("the tolerance is 1e-06"));
  EXPECT_EQ(elevate_degree(surface, Direction::u, 14).error().code, ErrorCode::degree_out_of_range);
}

TEST(SurfaceEdits, PointsOfAllRowsTogetherHaveALimit) {
  SurfaceSpec spec;
  spec.name = "wide";
  spec.degree_u = spec.degree_v = 1;
  spec.count_u = spec.count_v = 64;
  spec.points.resize(64 * 64);
  const auto finer = insert_knot(made(spec), Direction::u, 0.5001);
  ASSERT_FALSE(finer);
  EXPECT_EQ(finer.error().code, ErrorCode::too_many_points);
}

}  // namespace
}  // namespace knotwave::test

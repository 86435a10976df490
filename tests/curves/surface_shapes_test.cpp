// SPDX-License-Identifier: MIT
#include "knotwave/curves/surface_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/combine.h"
#include "knotwave/curves/shapes.h"

#include "random_curve.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::NurbsSurface;
using testing::ElementsAre;
using testing::HasSubstr;

NurbsCurve curve_of(int degree, int dim, std::vector<double> points,
                    std::vector<double> weights = {}) {
  CurveSpec spec;
  spec.name = "edge";
  spec.degree = degree;
  spec.dim = dim;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

NurbsSurface value_of(Result<NurbsSurface> surface) {
  EXPECT_TRUE(surface) << (surface ? "" : surface.error().message);
  return std::move(*surface);
}

std::vector<double> at(const NurbsSurface& surface, double u, double v) {
  std::vector<double> out(std::size_t(surface.dim()));
  surface.evaluate(u, v, out);
  return out;
}

std::vector<double> at(const NurbsCurve& curve, double u) {
  std::vector<double> out(std::size_t(curve.dim()));
  curve.evaluate(u, out);
  return out;
}

NurbsCurve moved(const NurbsCurve& curve, double x, double y) {
  CurveSpec spec = curve.spec();
  for (std::size_t i = 0; i < spec.points.size(); i += 2) {
    spec.points[i] += x;
    spec.points[i + 1] += y;
  }
  return *NurbsCurve::create(std::move(spec));
}

double largest_of(const NurbsSurface& surface) {
  double largest = 0;
  for (const double x : surface.points()) largest = std::max(largest, std::abs(x));
  return largest;
}

// Calls back with parameters of a grid that meets knots and what lies between them.
template <class Look>
void on_grid(const NurbsSurface& surface, Look look) {
  for (int j = 0; j <= 32; ++j) {
    for (int i = 0; i <= 32; ++i) {
      look(surface.u_min() + (surface.u_max() - surface.u_min()) * i / 32,
           surface.v_min() + (surface.v_max() - surface.v_min()) * j / 32);
    }
  }
}

TEST(Revolved, SphereAndTorusHaveTheirRadiusWithin4Ulp) {
  const double radius = 0.7, tube = 0.25;
  const NurbsSurface sphere = value_of(revolved(*curves::arc(radius, -0.25, 0.5)));
  EXPECT_EQ(sphere.dim(), 3);
  EXPECT_TRUE(sphere.is_rational());
  double worst = 0;
  on_grid(sphere, [&](double u, double v) {
    const auto p = at(sphere, u, v);
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    worst = std::max(worst, std::abs(length - radius) / ulp_of(radius));
  });
  std::printf("sphere: %.2f ulp of its radius\n", worst);
  EXPECT_LE(worst, 4);

  const NurbsSurface torus = value_of(revolved(moved(*curves::arc(tube, 0, 1), 1, 0)));
  worst = 0;
  on_grid(torus, [&](double u, double v) {
    const auto p = at(torus, u, v);
    const double ring = std::sqrt(p[0] * p[0] + p[1] * p[1]) - 1;
    const double length = std::sqrt(ring * ring + p[2] * p[2]);
    worst = std::max(worst, std::abs(length - tube) / ulp_of(largest_of(torus)));
  });
  std::printf("torus: %.2f ulp of its largest coordinate\n", worst);
  EXPECT_LE(worst, 4);
}

TEST(Revolved, DistanceAndHeightAreThoseOfTheProfile) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < 200; ++round) {
    CurveSpec spec = random_spec(dice);
    const auto count = spec.points.size() / std::size_t(spec.dim);
    spec.dim = 2;
    spec.points.clear();
    for (std::size_t i = 0; i < 2 * count; ++i) spec.points.push_back(dice.between(0.1, 1));
    const auto profile = NurbsCurve::create(spec);
    ASSERT_TRUE(profile) << profile.error().message;
    const double length = dice.between(0.05, 1) * (dice.one_in(2) ? 1 : -1);
    const auto surface = revolved(*profile, length);
    if (!surface) {
      EXPECT_EQ(surface.error().code, ErrorCode::weight_out_of_range);
      continue;
    }
    for (int i = 0; i < 20; ++i) {
      double v = std::clamp(random_parameter(dice, *profile), profile->u_min(), profile->u_max());
      if (profile->is_periodic() && v == profile->u_max()) v = profile->u_min();
      const auto p = at(*surface, dice.unit(), v), flat = at(*profile, v);
      const double distance = std::sqrt(p[0] * p[0] + p[1] * p[1]);
      worst = std::max(
          {worst, std::abs(distance - flat[0]) / ulp_of(1), std::abs(p[2] - flat[1]) / ulp_of(1)});
    }
  }
  std::printf("worst: %.2f ulp of 1\n", worst);
  EXPECT_LE(worst, 4);
}

TEST(Revolved, GoesRoundFromXToYAndAWholeTurnEndsWhereItBegins) {
  const NurbsCurve profile = curve_of(1, 2, {2, 0, 3, 1});
  EXPECT_THAT(at(value_of(revolved(profile, 0.25)), 1, 0), ElementsAre(0, 2, 0));
  EXPECT_THAT(at(value_of(revolved(profile, -0.25)), 1, 1), ElementsAre(0, -3, 1));
  const NurbsSurface whole = value_of(revolved(profile));
  EXPECT_THAT(at(whole, 0.5, 0), ElementsAre(-2, 0, 0));
  for (double v = 0; v <= 1; v += 0.125) EXPECT_EQ(at(whole, 0, v), at(whole, 1, v));
  EXPECT_EQ(revolved(profile, 0).error().code, ErrorCode::value_out_of_range);
  EXPECT_EQ(revolved(profile, 1.5).error().message,
            "curve 'edge' turned 1.5 cycles long: the length must be within -1..1 and not 0");
  EXPECT_EQ(revolved(curve_of(1, 1, {0, 1})).error().code, ErrorCode::dimension_mismatch);
}

TEST(Ruled, BordersAreTheCurvesAndLinesBetweenThemAreStraight) {
  const NurbsCurve first = *curves::arc(1, 0, 0.25);
  const NurbsCurve second = curve_of(3, 2, {2, 0, 2, 1, 1, 3, 0, 2}, {1, 2, 1, 3});
  const NurbsSurface surface = value_of(ruled(first, second));
  EXPECT_EQ(surface.degree_u(), 3);
  EXPECT_EQ(surface.degree_v(), 1);
  for (double u = 0; u <= 1; u += 0.0625) {
    const auto a = at(first, u), b = at(second, u), middle = at(surface, u, 0.375);
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_NEAR(at(surface, u, 0)[c], a[c], 4 * ulp_of(3));
      EXPECT_NEAR(at(surface, u, 1)[c], b[c], 4 * ulp_of(3));
    }
    const double along_x = b[0] - a[0], along_y = b[1] - a[1];
    EXPECT_NEAR(along_x * (middle[1] - a[1]), along_y * (middle[0] - a[0]), 1e-14);
  }
}

// Weights that are all 2 are no weights: between plain curves the way is at an even pace.
TEST(Ruled, EqualWeightsDoNotPull) {
  const NurbsCurve plain = curve_of(1, 1, {0, 0}), heavy = curve_of(1, 1, {1, 1}, {2, 2});
  const NurbsSurface surface = value_of(ruled(plain, heavy));
  EXPECT_FALSE(surface.is_rational());
  EXPECT_EQ(at(surface, 0.5, 0.25)[0], 0.25);
}

TEST(Ruled, PeriodicCurvesMakeAClosedSurface) {
  CurveSpec spec;
  spec.points = {0, 1, 0, -1};
  spec.periodic = true;
  const NurbsCurve wave = *NurbsCurve::create(spec);
  spec.points = {0, 0, 1, 0, -1};
  const NurbsCurve other = *NurbsCurve::create(spec);
  const NurbsSurface surface = value_of(ruled(wave, other));
  EXPECT_TRUE(surface.is_periodic_u());
  for (double u = 0; u < 1; u += 0.0625) {
    EXPECT_NEAR(at(surface, u, 0)[0], at(wave, u)[0], 4 * ulp_of(1));
    EXPECT_NEAR(at(surface, u, 1)[0], at(other, u)[0], 4 * ulp_of(1));
  }
}

TEST(SurfaceShapes, AJumpIsRefused) {
  CurveSpec spec;
  spec.name = "step";
  spec.degree = 1;
  spec.points = {0, 0, 1, 1};
  spec.knots = {0, 0, 0.5, 0.5, 1, 1};
  spec.jumps = {0.5};
  const NurbsCurve step = *NurbsCurve::create(spec), flat = curve_of(1, 1, {0, 0});
  const auto surface = ruled(flat, step);
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().code, ErrorCode::unsupported);
  EXPECT_EQ(surface.error().message,
            "curve 'step': a jump at u = 0.5; surfaces have none, split() cuts there");
}

TEST(Bilinear, CornersAreWhereTheyShouldBe) {
  const NurbsSurface surface = value_of(curves::bilinear(std::vector<double>{0, 1, 2, 7}));
  EXPECT_EQ(at(surface, 1, 0)[0], 1);
  EXPECT_EQ(at(surface, 0, 1)[0], 2);
  EXPECT_EQ(at(surface, 0.5, 0.5)[0], 2.5);
  EXPECT_EQ(curves::bilinear(std::vector<double>{0, 1, 2}).error().code,
            ErrorCode::dimension_mismatch);
}

// Random waves of unequal kinds, periodic and rational ones among them: row k is at position k.
TEST(Lofted, GoesThroughEveryRow) {
  Dice dice(support::test_seed());
  double worst = 0;
  for (int round = 0; round < 100; ++round) {
    const bool periodic = dice.one_in(2), rational = dice.one_in(2);
    std::vector<NurbsCurve> rows;
    std::vector<double> positions;
    const int count = 2 + dice.below(5);
    for (int k = 0; k < count; ++k) {
      CurveSpec spec;
      spec.degree = 1 + dice.below(3);
      spec.dim = 2;
      spec.periodic = periodic;
      const int n = spec.degree + 1 + dice.below(3);
      for (int i = 0; i < 2 * n; ++i) spec.points.push_back(dice.between(-1, 1));
      for (int i = 0; i < n && rational; ++i) spec.weights.push_back(dice.between(1, 1.05));
      rows.push_back(*NurbsCurve::create(spec));
      positions.push_back(k + dice.between(0, 0.5));
    }
    const NurbsSurface surface =
        value_of(lofted(rows, 1 + dice.below(std::min(count - 1, 5)), positions));
    EXPECT_EQ(surface.is_periodic_u(), periodic);
    EXPECT_EQ(surface.v_min(), positions.front());
    EXPECT_EQ(surface.v_max(), positions.back());
    for (int k = 0; k < count; ++k) {
      for (int i = 0; i < 8; ++i) {
        const double u = i / 8.0;
        const auto a = at(surface, u, positions[std::size_t(k)]), b = at(rows[std::size_t(k)], u);
        for (std::size_t c = 0; c < 2; ++c) {
          worst = std::max(worst, std::abs(a[c] - b[c]) / ulp_of(largest_of(surface)));
        }
      }
    }
  }
  std::printf("worst: %.2f ulp of max|P|\n", worst);
  EXPECT_LE(worst, 4);
}

// Distances 1, 4 and 9 between rows: their square roots are 1, 2 and 3.
TEST(Lofted, PositionsLeftOutAreCentripetal) {
  const std::vector<NurbsCurve> rows = {curve_of(1, 1, {0, 10}), curve_of(1, 1, {1, 11}),
                                        curve_of(1, 1, {5, 15}), curve_of(1, 1, {14, 24})};
  const NurbsSurface surface = value_of(lofted(rows, 1));
  EXPECT_THAT(surface.knots_v(),
              testing::Pointwise(testing::DoubleEq(), {0.0, 0.0, 1 / 6.0, 0.5, 1.0, 1.0}));
}

TEST(Lofted, DegreeOneIsRuledBetweenNeighbours) {
  const NurbsCurve a = curve_of(2, 1, {0, 1, 0}), b = curve_of(3, 1, {1, 0, 2, 1});
  const std::vector<NurbsCurve> rows = {a, b};
  const NurbsSurface lofted_surface = value_of(lofted(rows, 1)),
                     ruled_surface = value_of(ruled(a, b));
  EXPECT_TRUE(lofted_surface == ruled_surface);
}

TEST(Lofted, FaultsSayWhatIsMissing) {
  const NurbsCurve a = curve_of(1, 1, {0, 1}), b = curve_of(1, 1, {1, 0});
  const std::vector<NurbsCurve> two = {a, b}, same = {a, a};
  EXPECT_EQ(lofted(two, 2).error().message, "lofting: degree 2 needs 3 rows, found 2");
  EXPECT_EQ(lofted(two, 0).error().code, ErrorCode::degree_out_of_range);
  EXPECT_EQ(curves::lofted({}, 1).error().code, ErrorCode::too_few_points);
  EXPECT_EQ(lofted(same, 1).error().message,
            "lofting: rows 0 and 1 are the same; only given positions have a step between them");
  EXPECT_EQ(lofted(two, 1, std::vector<double>{0}).error().message,
            "lofting: 1 positions for 2 rows");
  EXPECT_EQ(lofted(two, 1, std::vector<double>{1, 1}).error().code, ErrorCode::knots_decrease);
  const std::vector<NurbsCurve> mixed = {a, curve_of(1, 2, {0, 0, 1, 1})};
  EXPECT_EQ(lofted(mixed, 1).error().code, ErrorCode::dimension_mismatch);
}

TEST(Lofted, WeightsThatSwingBelowZeroAreRefused) {
  std::vector<NurbsCurve> rows;
  for (const double w : {1.0, 1e-3, 1.0, 1e3}) rows.push_back(curve_of(1, 1, {0, 1}, {w, 1}));
  rows.push_back(rows[1]);
  const auto surface = lofted(rows, 3, std::vector<double>{0, 1, 2, 3, 4});
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().code, ErrorCode::weight_not_positive);
}

// Borders of unequal degree and knots come back at the four edges; the middle is the blend.
TEST(Coons, BordersAreTheCurves) {
  const NurbsCurve bottom = curve_of(2, 2, {0, 0, 1, 1, 2, 0});
  const NurbsCurve top = curve_of(3, 2, {0, 3, 1, 2, 1, 4, 1.5, 5, 2, 3});
  const NurbsCurve left = curve_of(1, 2, {0, 0, -1, 1, 0, 3});
  const NurbsCurve right = curve_of(2, 2, {2, 0, 3, 1, 3, 2, 2, 3});
  const NurbsSurface surface = value_of(coons(bottom, top, left, right));
  EXPECT_EQ(surface.degree_u(), 3);
  EXPECT_EQ(surface.degree_v(), 2);
  for (double t = 0; t <= 1; t += 0.0625) {
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_NEAR(at(surface, t, 0)[c], at(bottom, t)[c], 4 * ulp_of(5));
      EXPECT_NEAR(at(surface, t, 1)[c], at(top, t)[c], 4 * ulp_of(5));
      EXPECT_NEAR(at(surface, 0, t)[c], at(left, t)[c], 4 * ulp_of(5));
      EXPECT_NEAR(at(surface, 1, t)[c], at(right, t)[c], 4 * ulp_of(5));
    }
  }
  const auto b = at(bottom, 0.5), t = at(top, 0.5), l = at(left, 0.5), r = at(right, 0.5);
  EXPECT_NEAR(at(surface, 0.5, 0.5)[0], (b[0] + t[0] + l[0] + r[0]) / 2 - 1, 1e-15);
  EXPECT_NEAR(at(surface, 0.5, 0.5)[1], (b[1] + t[1] + l[1] + r[1]) / 2 - 1.5, 1e-15);
}

// Four quarter arcs: their ends have weight 1, and so has the border of the patch its circle.
TEST(Coons, ArcsStayArcs) {
  const double r = std::sqrt(0.5);
  const auto quarter = [&](double x0, double y0, double x1, double y1) {
    return curve_of(2, 2, {x0, y0, x0 + x1, y0 + y1, x1, y1}, {1, r, 1});
  };
  const NurbsSurface disc = value_of(coons(quarter(-r, -r, r, -r), quarter(-r, r, r, r),
                                           quarter(-r, -r, -r, r), quarter(r, -r, r, r)));
  for (double t = 0; t <= 1; t += 0.0625) {
    for (const auto& p : {at(disc, t, 0), at(disc, t, 1), at(disc, 0, t), at(disc, 1, t)}) {
      EXPECT_NEAR(std::sqrt(p[0] * p[0] + p[1] * p[1]), 1, 4 * ulp_of(1));
    }
  }
}

TEST(Coons, CornersThatAlmostMeetAreThoseOfBottomAndTop) {
  const NurbsCurve bottom = curve_of(1, 1, {0, 1}), top = curve_of(1, 1, {2, 3});
  const NurbsCurve left = curve_of(1, 1, {1e-10, 2}), right = curve_of(1, 1, {1, 3 - 1e-10});
  const NurbsSurface surface = value_of(coons(bottom, top, left, right));
  EXPECT_THAT(surface.points(), ElementsAre(0, 1, 2, 3));
  const auto gap = coons(bottom, top, curve_of(1, 1, {0, 2.5}), right);
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().code, ErrorCode::not_closed);
  EXPECT_EQ(gap.error().message,
            "coons: top and left are 0.5 apart at the corner (0, 1), the tolerance is 1e-09");
  const auto uneven = coons(curve_of(1, 1, {0, 1}, {1, 2}), top, left, right);
  ASSERT_FALSE(uneven);
  EXPECT_EQ(uneven.error().code, ErrorCode::unsupported);
  EXPECT_EQ(coons(bottom, top, left, right, -1).error().code, ErrorCode::value_out_of_range);
  EXPECT_THAT(coons(bottom, curve_of(1, 2, {0, 0, 1, 1}), left, right).error().message,
              HasSubstr("1 and 2 coordinates"));
}

// However many there are, each is as near to itself as one of a pair.
TEST(MakeCompatible, AnyNumberOfCurvesStayTheirOwn) {
  Dice dice(support::test_seed());
  std::vector<NurbsCurve> all;
  for (int i = 0; i < 20; ++i) {
    CurveSpec spec;
    spec.degree = 1 + i % 4;
    const int n = spec.degree + 1 + dice.below(4);
    for (int k = 0; k < n; ++k) spec.points.push_back(dice.between(-1, 1));
    for (int k = 0; k < n && i % 2 == 0; ++k) spec.weights.push_back(dice.between(0.5, 2));
    all.push_back(*NurbsCurve::create(spec));
  }
  const auto same = curves::make_compatible(all);
  ASSERT_TRUE(same) << same.error().message;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_THAT((*same)[i].knots(), testing::ElementsAreArray(same->front().knots()));
    for (double u = 0; u <= 1; u += 0.03125) {
      EXPECT_NEAR(at((*same)[i], u)[0], at(all[i], u)[0], 4 * ulp_of(1));
    }
  }
  EXPECT_TRUE(curves::make_compatible({})->empty());
}

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// Curves and surfaces through C are those of C++, to the bit.
#include <cmath>
#include <limits>
#include <vector>

#include "knotwave/curves/calculus.h"
#include "knotwave/curves/extrapolate.h"
#include "knotwave/curves/nurbs_surface.h"

#include "c_handles.h"

namespace knotwave::c {
namespace {

using curves::NurbsCurve;

std::vector<double> all(const double* first, size_t count) { return {first, first + count}; }

TEST(CCurve, HoldsWhatWasGiven) {
  const auto wanted = NurbsCurve::create(bell());
  const Curve curve = curve_of(bell());
  EXPECT_STREQ(kw_curve_name(curve.get()), "bell");
  EXPECT_EQ(kw_curve_degree(curve.get()), 3);
  EXPECT_EQ(kw_curve_dim(curve.get()), 1);
  EXPECT_TRUE(kw_curve_is_rational(curve.get()));
  EXPECT_TRUE(kw_curve_is_clamped(curve.get()));
  EXPECT_FALSE(kw_curve_is_periodic(curve.get()));
  EXPECT_EQ(kw_curve_u_min(curve.get()), 0);
  EXPECT_EQ(kw_curve_u_max(curve.get()), 1);
  EXPECT_EQ(kw_curve_point_count(curve.get()), 6u);
  size_t count = 0;
  const double* points = kw_curve_points(curve.get(), &count);
  EXPECT_EQ(all(points, count), bell().points);
  const double* weights = kw_curve_weights(curve.get(), &count);
  EXPECT_EQ(all(weights, count), bell().weights);
  const double* knots = kw_curve_knots(curve.get(), &count);
  EXPECT_EQ(all(knots, count), bell().knots);
  kw_curve_jumps(curve.get(), &count);
  EXPECT_EQ(count, 0u);
}

TEST(CCurve, CountsAboveTheLimitsAreRefusedBeforeAnythingIsRead) {
  const double points[] = {0, 1};
  for (const size_t count : {SIZE_MAX, size_t{1} << 61, size_t{16385}}) {
    kw_curve_spec spec = KW_CURVE_SPEC_INIT;
    spec.points = points;
    spec.points_count = count;
    const Failure failure = refused<kw_curve>(kw_curve_create, &spec);
    EXPECT_EQ(failure.status, KW_TOO_MANY_POINTS);
    EXPECT_EQ(failure.message, "the spec's points_count is " + std::to_string(count) +
                                   ", at most 16384 are possible");
    spec.points_count = 2;
    spec.knots = points;
    spec.knots_count = count;
    EXPECT_EQ(refused<kw_curve>(kw_curve_create, &spec).status, KW_TOO_MANY_POINTS);
    kw_surface_spec surface = KW_SURFACE_SPEC_INIT;
    surface.points = points;
    surface.points_count = count;
    EXPECT_EQ(refused<kw_surface>(kw_surface_create, &surface).status, KW_TOO_MANY_POINTS);
  }
}

TEST(CCurve, OfNothingTheCountIs0) {
  using Lender = const double* (*)(const kw_curve*, size_t*);
  const Lender lenders[] = {kw_curve_points, kw_curve_weights, kw_curve_knots, kw_curve_jumps};
  for (const Lender lender : lenders) {
    size_t count = 7;
    EXPECT_EQ(lender(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0u);
  }
}

TEST(CCurve, OutlivesWhatItWasMadeFrom) {
  Curve curve = curve_of(bell());
  const Curve copy = made<Curve>(kw_curve_copy, curve.get());
  const Curve renamed = made<Curve>(kw_curve_renamed, curve.get(), "gong");
  EXPECT_TRUE(kw_curve_equal(curve.get(), copy.get()));
  EXPECT_FALSE(kw_curve_equal(curve.get(), renamed.get()));
  curve.reset();
  EXPECT_STREQ(kw_curve_name(renamed.get()), "gong");
  expect_same(copy.get(), NurbsCurve::create(bell()));
}

TEST(CCurve, ValuesAndDerivativesAreThoseOfTheLibrary) {
  const auto wanted = NurbsCurve::create(bell());
  const Curve curve = curve_of(bell());
  std::vector<double> places;
  for (int i = -2; i <= 34; ++i) places.push_back(i / 32.0);
  places.push_back(std::numeric_limits<double>::quiet_NaN());
  std::vector<double> values(places.size());
  ASSERT_EQ(kw_curve_evaluate_many(curve.get(), places.data(), places.size(), KW_SIDE_RIGHT,
                                   values.data(), values.size()),
            KW_OK);
  for (size_t i = 0; i < places.size(); ++i) {
    double value = 0, one = 0;
    wanted->evaluate(places[i], {&value, 1});
    EXPECT_EQ(values[i], value);
    EXPECT_EQ(kw_curve_evaluate(curve.get(), places[i], KW_SIDE_RIGHT, &one, 1), KW_OK);
    EXPECT_EQ(one, value);
    double here[5], there[5];
    wanted->derivatives(places[i], 4, curves::Side::left, there);
    EXPECT_EQ(kw_curve_derivatives(curve.get(), places[i], 4, KW_SIDE_LEFT, here, 5), KW_OK);
    EXPECT_EQ(all(here, 5), all(there, 5));
  }
}

TEST(CCurve, AJumpHasTwoSides) {
  const Curve step = curve_of({.name = "step",
                               .degree = 1,
                               .points = {0, 0.25, 0.75, 1},
                               .knots = {0, 0, 0.5, 0.5, 1, 1},
                               .jumps = {0.5}});
  double left = 0, right = 0;
  EXPECT_EQ(kw_curve_evaluate(step.get(), 0.5, KW_SIDE_LEFT, &left, 1), KW_OK);
  EXPECT_EQ(kw_curve_evaluate(step.get(), 0.5, KW_SIDE_RIGHT, &right, 1), KW_OK);
  EXPECT_EQ(left, 0.25);
  EXPECT_EQ(right, 0.75);
}

TEST(CCurve, BeyondItsEndsItDoesWhatIsAsked) {
  const auto wanted = NurbsCurve::create(plain());
  const Curve curve = curve_of(plain());
  const kw_extrapolation modes[] = {KW_EXTRAPOLATE_HOLD, KW_EXTRAPOLATE_LINEAR,
                                    KW_EXTRAPOLATE_PERIODIC, KW_EXTRAPOLATE_MIRROR};
  const curves::Extrapolation theirs[] = {
      curves::Extrapolation::hold, curves::Extrapolation::linear, curves::Extrapolation::periodic,
      curves::Extrapolation::mirror};
  for (size_t m = 0; m < 4; ++m) {
    for (const double u : {-1.3, 0.3, 2.7}) {
      double here = 0, there = 0;
      curves::evaluate_extrapolated(*wanted, u, theirs[m], theirs[3 - m], {&there, 1});
      EXPECT_EQ(kw_curve_evaluate_extrapolated(curve.get(), u, modes[m], modes[3 - m], &here, 1),
                KW_OK);
      EXPECT_EQ(here, there) << m << " at " << u;
    }
  }
  double here = 0;
  EXPECT_EQ(kw_curve_evaluate_extrapolated(curve.get(), 2, 4, 0, &here, 1), KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(kw_curve_curvature(curve.get(), 0.3, KW_SIDE_RIGHT, &here), KW_OK);
  EXPECT_EQ(here, curves::curvature(*wanted, 0.3));
}

TEST(CCurve, OutputsOfTheWrongSizeAreRefusedAndNotWritten) {
  const Curve curve = curve_of(bell());
  double out[4] = {7, 7, 7, 7};
  const double u[2] = {0, 1};
  EXPECT_EQ(kw_curve_evaluate(curve.get(), 0.5, KW_SIDE_RIGHT, out, 2), KW_DIMENSION_MISMATCH);
  EXPECT_EQ(kw_curve_evaluate_many(curve.get(), u, 2, KW_SIDE_RIGHT, out, 3),
            KW_DIMENSION_MISMATCH);
  EXPECT_EQ(kw_curve_derivatives(curve.get(), 0.5, 2, KW_SIDE_RIGHT, out, 2),
            KW_DIMENSION_MISMATCH);
  EXPECT_EQ(kw_curve_derivatives(curve.get(), 0.5, -1, KW_SIDE_RIGHT, out, 0),
            KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(kw_curve_evaluate(curve.get(), 0.5, 2, out, 1), KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(kw_curve_evaluate(curve.get(), 0.5, KW_SIDE_RIGHT, nullptr, 1), KW_NULL_ARGUMENT);
  EXPECT_EQ(all(out, 4), std::vector<double>(4, 7.0));
}

TEST(CSurface, PartialsEndAtOrder15) {
  const double points[] = {0, 1, 2, 5}, weights[] = {1, 2, 3, 4};
  kw_surface_spec spec = KW_SURFACE_SPEC_INIT;
  spec.degree_u = spec.degree_v = 1;
  spec.count_u = spec.count_v = 2;
  spec.points = points;
  spec.weights = weights;
  spec.points_count = spec.weights_count = 4;
  const Surface surface = made<Surface>(kw_surface_create, &spec);
  std::vector<double> out(17 * 17);
  EXPECT_EQ(kw_surface_derivatives(surface.get(), 0.5, 0.5, 15, out.data(), 16 * 16), KW_OK);
  EXPECT_EQ(kw_surface_derivatives(surface.get(), 0.5, 0.5, 16, out.data(), 17 * 17),
            KW_VALUE_OUT_OF_RANGE);
}

TEST(CSurface, IsThatOfTheLibrary) {
  const curves::SurfaceSpec spec{.name = "hill",
                                 .degree_u = 2,
                                 .degree_v = 1,
                                 .count_u = 4,
                                 .count_v = 2,
                                 .points = {0, 1, 0.5, 0, 1, 0, 0.25, 1},
                                 .weights = {1, 2, 1, 1, 1, 1, 3, 1},
                                 .periodic_u = true};
  const auto wanted = curves::NurbsSurface::create(spec);
  ASSERT_TRUE(wanted) << wanted.error().to_string();
  kw_surface_spec from = KW_SURFACE_SPEC_INIT;
  from.name = "hill";
  from.degree_u = 2;
  from.degree_v = 1;
  from.count_u = 4;
  from.count_v = 2;
  from.points = spec.points.data();
  from.points_count = 8;
  from.weights = spec.weights.data();
  from.weights_count = 8;
  from.periodic_u = true;
  const Surface surface = made<Surface>(kw_surface_create, &from);
  const Surface copy = made<Surface>(kw_surface_copy, surface.get());
  EXPECT_TRUE(kw_surface_equal(surface.get(), copy.get()));
  EXPECT_STREQ(kw_surface_name(surface.get()), "hill");
  EXPECT_EQ(kw_surface_degree_u(surface.get()), 2);
  EXPECT_EQ(kw_surface_degree_v(surface.get()), 1);
  EXPECT_EQ(kw_surface_dim(surface.get()), 1);
  EXPECT_TRUE(kw_surface_is_rational(surface.get()));
  EXPECT_TRUE(kw_surface_is_periodic_u(surface.get()));
  EXPECT_EQ(kw_surface_count_u(surface.get()), wanted->count_u());
  EXPECT_EQ(kw_surface_count_v(surface.get()), 2);
  EXPECT_EQ(kw_surface_u_min(surface.get()), wanted->u_min());
  EXPECT_EQ(kw_surface_u_max(surface.get()), wanted->u_max());
  EXPECT_EQ(kw_surface_v_min(surface.get()), 0);
  EXPECT_EQ(kw_surface_v_max(surface.get()), 1);
  size_t count = 0;
  kw_surface_points(surface.get(), &count);
  EXPECT_EQ(count, wanted->points().size());
  kw_surface_weights(surface.get(), &count);
  EXPECT_EQ(count, wanted->weights().size());
  kw_surface_knots_u(surface.get(), &count);
  EXPECT_EQ(count, wanted->knots_u().size());
  const double* knots_v = kw_surface_knots_v(surface.get(), &count);
  EXPECT_EQ(all(knots_v, count), (std::vector<double>{0, 0, 1, 1}));

  const double u[3] = {0.1, 0.5, 1.7}, v[2] = {0.25, 0.75};
  double grid[6];
  ASSERT_EQ(kw_surface_evaluate_grid(surface.get(), u, 3, v, 2, grid, 6), KW_OK);
  for (size_t j = 0; j < 2; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      double value = 0, one = 0, here[9], there[9];
      wanted->evaluate(u[i], v[j], {&value, 1});
      EXPECT_EQ(grid[j * 3 + i], value);
      EXPECT_EQ(kw_surface_evaluate(surface.get(), u[i], v[j], &one, 1), KW_OK);
      EXPECT_EQ(one, value);
      wanted->derivatives(u[i], v[j], 2, there);
      EXPECT_EQ(kw_surface_derivatives(surface.get(), u[i], v[j], 2, here, 9), KW_OK);
      EXPECT_EQ(all(here, 9), all(there, 9));
    }
  }
  EXPECT_EQ(kw_surface_evaluate_grid(surface.get(), u, 3, v, 2, grid, 5), KW_DIMENSION_MISMATCH);
  expect_same(made<Curve>(kw_surface_iso_curve_at_v, surface.get(), 0.25).get(),
              wanted->iso_curve_at_v(0.25));
  expect_same(made<Curve>(kw_surface_iso_curve_at_u, surface.get(), 0.25).get(),
              wanted->iso_curve_at_u(0.25));
}

}  // namespace
}  // namespace knotwave::c

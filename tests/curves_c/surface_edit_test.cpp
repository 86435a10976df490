// SPDX-License-Identifier: MIT
// Surfaces edited and made from curves, through C: those of C++, to the bit.
#include "knotwave/curves/surface_algorithms.h"
#include "knotwave/curves/surface_shapes.h"

#include "c_handles.h"

namespace knotwave::c {
namespace {

using curves::Direction;
using curves::NurbsSurface;

curves::SurfaceSpec hill() {
  return {.name = "hill",
          .degree_u = 2,
          .degree_v = 1,
          .dim = 1,
          .count_u = 4,
          .count_v = 3,
          .points = {0, 1, 2, 0, 1, 3, 2, 1, 0, -1, 1, 0},
          .weights = {1, 2, 1, 1, 1, 1, 3, 1, 1, 1, 1, 2}};
}

Surface surface_of(const curves::SurfaceSpec& spec) {
  kw_surface_spec from = KW_SURFACE_SPEC_INIT;
  from.name = spec.name.c_str();
  from.degree_u = spec.degree_u;
  from.degree_v = spec.degree_v;
  from.dim = spec.dim;
  from.count_u = spec.count_u;
  from.count_v = spec.count_v;
  from.points = spec.points.data();
  from.points_count = spec.points.size();
  from.weights = spec.weights.data();
  from.weights_count = spec.weights.size();
  from.knots_u = spec.knots_u.data();
  from.knots_u_count = spec.knots_u.size();
  from.knots_v = spec.knots_v.data();
  from.knots_v_count = spec.knots_v.size();
  from.periodic_u = spec.periodic_u;
  return made<Surface>(kw_surface_create, &from);
}

void expect_same(const kw_surface* made, const Result<NurbsSurface>& wanted) {
  ASSERT_TRUE(wanted) << wanted.error().to_string();
  EXPECT_TRUE(kw_surface_equal(made, surface_of(wanted->spec()).get()));
}

TEST(CSurfaceEdit, EachIsThatOfTheLibrary) {
  const NurbsSurface theirs = *NurbsSurface::create(hill());
  const Surface ours = surface_of(hill());
  const kw_surface* s = ours.get();
  constexpr kw_direction kU = KW_DIRECTION_U, kV = KW_DIRECTION_V;
  const auto finer = insert_knot(theirs, Direction::u, 0.25, 1);
  const Surface inserted = made<Surface>(kw_surface_insert_knot, s, kU, 0.25, 1);
  expect_same(inserted.get(), finer);
  const double knots[] = {0.25, 0.75};
  expect_same(made<Surface>(kw_surface_refine, s, kV, knots, size_t{2}).get(),
              refine(theirs, Direction::v, knots));
  const auto higher = elevate_degree(theirs, Direction::v, 2);
  const Surface raised = made<Surface>(kw_surface_elevate_degree, s, kV, 2);
  expect_same(raised.get(), higher);
  expect_same(made<Surface>(kw_surface_part, s, kU, 0.25, 0.75).get(),
              sub_surface(theirs, Direction::u, 0.25, 0.75));
  expect_same(made<Surface>(kw_surface_reverse, s, kU).get(), reverse(theirs, Direction::u));
  expect_same(made<Surface>(kw_surface_reparametrize, s, kV, 2.0, 3.0).get(),
              reparametrize(theirs, Direction::v, 2, 3));
  expect_same(made<Surface>(kw_surface_transpose, s).get(), transpose(theirs));

  kw_surface *low = nullptr, *high = nullptr;
  ASSERT_EQ(kw_surface_split(s, kU, 0.5, &low, &high, nullptr), KW_OK);
  const Surface owns_low(low), owns_high(high);
  const auto parts = split(theirs, Direction::u, 0.5);
  expect_same(low, parts->low);
  expect_same(high, parts->high);

  kw_surface* out = nullptr;
  int32_t removed = 0;
  double max_error = -1;
  ASSERT_EQ(kw_surface_remove_knot(inserted.get(), kU, 0.25, 1, 1e-13, &out, &removed, &max_error,
                                   nullptr),
            KW_OK);
  const Surface smaller(out);
  const auto theirs_smaller = remove_knot(*finer, Direction::u, 0.25, 1, 1e-13);
  expect_same(out, theirs_smaller->surface);
  EXPECT_EQ(removed, 1);
  EXPECT_EQ(max_error, theirs_smaller->max_error);
  ASSERT_EQ(kw_surface_reduce_degree(raised.get(), kV, 1e-12, &out, &max_error, nullptr), KW_OK);
  const Surface lower(out);
  expect_same(out, reduce_degree(*higher, Direction::v, 1e-12)->surface);
}

TEST(CSurfaceEdit, FaultsMakeNothingAndSayWhy) {
  const Surface ours = surface_of(hill());
  EXPECT_EQ(refused<kw_surface>(kw_surface_insert_knot, ours.get(), 2, 0.5, 1).status,
            KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(refused<kw_surface>(kw_surface_insert_knot, ours.get(), 0, 5.0, 1).status,
            KW_PARAMETER_OUT_OF_RANGE);
  const double* const none = nullptr;
  EXPECT_EQ(refused<kw_surface>(kw_surface_refine, ours.get(), 0, none, size_t{1}).status,
            KW_NULL_ARGUMENT);
  kw_surface *low = nullptr, *high = nullptr;
  EXPECT_EQ(kw_surface_split(ours.get(), 0, 2, &low, &high, nullptr), KW_PARAMETER_OUT_OF_RANGE);
  EXPECT_EQ(kw_surface_split(ours.get(), 0, 0.5, nullptr, &high, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_surface_split(ours.get(), 0, 0.5, &low, &low, nullptr), KW_MALFORMED);
  const double knot = 0.5;
  const double* const one = &knot;
  EXPECT_EQ(refused<kw_surface>(kw_surface_refine, ours.get(), 0, one, size_t{1} << 61).message,
            "knots_count is 2305843009213693952, at most 4112 are possible");
  EXPECT_EQ(low, nullptr);
  EXPECT_EQ(high, nullptr);
}

TEST(CSurfaceShapes, EachIsThatOfTheLibrary) {
  const auto line = [](std::vector<double> points) {
    return curves::CurveSpec{.name = "line", .degree = 1, .points = std::move(points)};
  };
  const auto theirs = [&](std::vector<double> points) {
    return *curves::NurbsCurve::create(line(std::move(points)));
  };
  const Curve a = curve_of(line({0, 1})), b = curve_of(line({2, 5})), c = curve_of(line({0, 2})),
              d = curve_of(line({1, 5}));
  expect_same(made<Surface>(kw_surface_ruled, a.get(), b.get()).get(),
              curves::ruled(theirs({0, 1}), theirs({2, 5})));
  const kw_curve* rows[] = {a.get(), b.get(), c.get()};
  const curves::NurbsCurve their_rows[] = {theirs({0, 1}), theirs({2, 5}), theirs({0, 2})};
  const double positions[] = {0, 1, 3};
  expect_same(made<Surface>(kw_surface_lofted, rows, size_t{3}, 2, positions, size_t{3}).get(),
              curves::lofted(their_rows, 2, positions));
  const double* const evenly = nullptr;
  expect_same(made<Surface>(kw_surface_lofted, rows, size_t{3}, 2, evenly, size_t{0}).get(),
              curves::lofted(their_rows, 2));
  const curves::CurveSpec wall{.name = "wall", .degree = 1, .dim = 2, .points = {1, 0, 2, 3}};
  expect_same(made<Surface>(kw_surface_revolved, curve_of(wall).get(), 0.5).get(),
              curves::revolved(*curves::NurbsCurve::create(wall), 0.5));
  const double corners[] = {0, 1, 2, 5};
  expect_same(made<Surface>(kw_surface_bilinear, corners, size_t{4}, 1).get(),
              curves::bilinear(corners));
  expect_same(made<Surface>(kw_surface_coons, a.get(), b.get(), c.get(), d.get(), 1e-9).get(),
              curves::coons(theirs({0, 1}), theirs({2, 5}), theirs({0, 2}), theirs({1, 5})));
  rows[1] = nullptr;
  EXPECT_EQ(refused<kw_surface>(kw_surface_lofted, rows, size_t{3}, 2, evenly, size_t{0}).message,
            "argument 'rows[1]' is NULL");
}

}  // namespace
}  // namespace knotwave::c

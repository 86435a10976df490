// SPDX-License-Identifier: MIT
// What is played beside programs, and regions, through C: those of C++, to the bit.
#include <cmath>
#include <limits>

#include "knotwave/curves/combine.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/fast_program.h"
#include "knotwave/curves/moving_curve.h"
#include "knotwave/curves/trim_region.h"

#include "c_handles.h"
#include "support/allocation_count.h"

namespace knotwave::c {
namespace {

using Join = std::unique_ptr<kw_join_program, Freed<kw_join_program_free>>;
using Fast = std::unique_ptr<kw_fast_program, Freed<kw_fast_program_free>>;
using Moving = std::unique_ptr<kw_moving_curve, Freed<kw_moving_curve_free>>;
using Region = std::unique_ptr<kw_trim_region, Freed<kw_trim_region_free>>;

TEST(CJoinProgram, StartsAsTheLibraryDoes) {
  const Curve curve = curve_of(bell());
  const Join join = made<Join>(kw_compile_join, curve.get(), 0.25, nullptr);
  const auto theirs = compile_join(*curves::NurbsCurve::create(bell()), 0.25);
  ASSERT_TRUE(theirs);
  EXPECT_EQ(kw_join_program_u_join(join.get()), 0.25);
  EXPECT_EQ(kw_join_program_u_basis_end(join.get()), theirs->u_basis_end);
  EXPECT_TRUE(kw_join_program_moves_p1(join.get()));
  const kw_program* basis = kw_join_program_basis(join.get());
  EXPECT_EQ(kw_program_dim(basis), 2);
  EXPECT_EQ(kw_program_at(basis, 0.3, 1, nullptr, 0), theirs->basis.at_u(0.3, 1));
  const std::int64_t before = support::allocation_count();
  const kw_join_deltas start = kw_join_program_start(join.get(), 0.5, 40);
  const kw_join_deltas level = kw_join_program_start_c0(join.get(), 0.5);
  EXPECT_EQ(support::allocation_count(), before);
  const auto wanted = theirs->join(0.5, 40);
  EXPECT_EQ(start.dp0, wanted.dp0);
  EXPECT_EQ(start.dp1, wanted.dp1);
  EXPECT_EQ(start.limited, wanted.limited);
  EXPECT_EQ(level.dp1, theirs->join_c0(0.5).dp1);
  EXPECT_EQ(refused<kw_join_program>(kw_compile_join, curve.get(), 5.0, nullptr).status,
            KW_PARAMETER_OUT_OF_RANGE);
  EXPECT_EQ(kw_join_program_start(nullptr, 1, 1).dp0, 0);
  EXPECT_EQ(kw_join_program_basis(nullptr), nullptr);
}

TEST(CJoinProgram, BasesAre0FromTheirEndOnButForDegree1InTheLastSpan) {
  for (const int degree : {1, 2, 3, 5}) {
    for (const int spans : {1, 2, 4}) {
      for (const bool in_last_span : {false, true}) {
        curves::CurveSpec spec{.name = "zigzag", .degree = degree};
        for (int i = 0; i < degree + spans; ++i) spec.points.push_back(i % 2);
        const Curve curve = curve_of(spec);
        const double u_join = in_last_span ? 1 - 0.5 / spans : 0.1 / spans;
        const Join join = made<Join>(kw_compile_join, curve.get(), u_join, nullptr);
        const double end = kw_join_program_u_basis_end(join.get());
        const kw_program* basis = kw_join_program_basis(join.get());
        const bool is_exception = degree == 1 && (in_last_span || spans == 1);
        EXPECT_EQ(kw_program_at(basis, end, 0, nullptr, 0), 0);
        EXPECT_EQ(kw_program_at(basis, end, 1, nullptr, 0), is_exception ? 1 : 0)
            << "degree " << degree << ", " << spans << " spans";
        if (degree == 1) {
          EXPECT_FALSE(kw_join_program_moves_p1(join.get()));
          EXPECT_EQ(kw_join_program_start(join.get(), 0.25, 40).dp1, 0);
        }
      }
    }
  }
}

TEST(CFastProgram, RendersTheSamplesOfTheLibrary) {
  const Curve curve = curve_of(bell());
  const Program program = made<Program>(kw_compile_function, curve.get(), nullptr);
  const Fast fast = made<Fast>(kw_fast_program_create, program.get(), HUGE_VAL);
  const curves::FastProgram theirs(*curves::compile_function(*curves::NurbsCurve::create(bell())));
  EXPECT_EQ(kw_fast_program_max_error(fast.get(), 0), theirs.max_error());
  EXPECT_TRUE(std::isnan(kw_fast_program_max_error(fast.get(), 1)));
  EXPECT_EQ(kw_fast_program_fast_piece_count(fast.get(), 0), theirs.fast_piece_count());
  std::vector<float> wanted(100), out(100);
  curves::CurveCursor cursor;
  theirs.render(curves::GridRun{0, 0.01, 3}, std::span<float>(wanted), cursor);
  int32_t hint = 0;
  const std::int64_t before = support::allocation_count();
  ASSERT_EQ(kw_fast_program_render(fast.get(), 0, 0.01, 3, 0, out.data(), 100, &hint), KW_OK);
  EXPECT_EQ(support::allocation_count(), before);
  EXPECT_EQ(out, wanted);
  EXPECT_EQ(kw_fast_program_render(fast.get(), 0, 0.01, 3, 1, out.data(), 100, &hint),
            KW_DIMENSION_MISMATCH);
  EXPECT_EQ(out, std::vector<float>(100, 0.0F));
  EXPECT_EQ(kw_fast_program_render(nullptr, 0, 0.01, 3, 0, out.data(), 100, &hint),
            KW_NULL_ARGUMENT);
}

TEST(CMovingCurve, IsThatOfTheLibrary) {
  const curves::CurveSpec ease{.name = "ease", .dim = 2, .points = {0, 0, 0.3, 0, 0.6, 1, 1, 1}};
  const Curve curve = curve_of(ease);
  const Moving moving = made<Moving>(kw_moving_curve_create, curve.get());
  const auto theirs = curves::MovingCurve::create(*curves::NurbsCurve::create(ease));
  EXPECT_EQ(kw_moving_curve_degree(moving.get()), 3);
  ASSERT_EQ(kw_moving_curve_point_count(moving.get()), 4u);
  const double points[] = {0, 0, 0.1, 0.5, 0.9, 0.5, 1, 1};
  const double times[] = {0.25, 0.5, std::numeric_limits<double>::quiet_NaN()};
  std::vector<std::vector<double>> rows;
  std::vector<const double*> first;
  for (const double x : points) rows.emplace_back(3, x);
  for (const auto& row : rows) first.push_back(row.data());
  double out[3] = {9, 9, 9};
  const std::int64_t before = support::allocation_count();
  ASSERT_EQ(kw_moving_curve_render(moving.get(), times, 3, first.data(), 8, out, 3), KW_OK);
  EXPECT_EQ(support::allocation_count(), before);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out[i], theirs->at(times[i], points));
    EXPECT_EQ(out[i], kw_moving_curve_at(moving.get(), times[i], points, 8));
  }
  EXPECT_EQ(kw_moving_curve_at(moving.get(), 0.5, points, 7), 0);
  EXPECT_EQ(kw_moving_curve_render(moving.get(), times, 3, first.data(), 7, out, 3),
            KW_DIMENSION_MISMATCH);
  first[2] = nullptr;
  EXPECT_EQ(kw_moving_curve_render(moving.get(), times, 3, first.data(), 8, out, 3),
            KW_NULL_ARGUMENT);
  EXPECT_EQ(out[0], 0);
  EXPECT_EQ(refused<kw_moving_curve>(kw_moving_curve_create, curve_of(bell()).get()).status,
            KW_DIMENSION_MISMATCH);
}

TEST(CTrimRegion, KeepsWhatTheLibraryKeeps) {
  const Curve outer = made<Curve>(kw_curve_rectangle, 0.0, 4.0, 0.0, 4.0);
  const Curve inner = made<Curve>(kw_curve_rectangle, 1.0, 2.0, 1.0, 2.0);
  const Curve hole = made<Curve>(kw_curve_reverse, inner.get());
  const kw_curve* loops[] = {outer.get(), hole.get()};
  const size_t sizes[] = {1, 1}, wrong[] = {1, 2};
  const Region region =
      made<Region>(kw_trim_region_create, loops, size_t{2}, sizes, size_t{2}, 0.0);
  EXPECT_TRUE(kw_trim_region_contains(region.get(), 3, 1.5));
  EXPECT_FALSE(kw_trim_region_contains(region.get(), 1.5, 1.5));
  EXPECT_FALSE(kw_trim_region_contains(nullptr, 3, 1.5));
  EXPECT_FALSE(kw_trim_region_is_unbounded(region.get()));
  kw_doubles kept{};
  ASSERT_EQ(kw_trim_region_intervals_at_v(region.get(), 1.5, &kept, nullptr), KW_OK);
  EXPECT_EQ(std::vector<double>(kept.numbers, kept.numbers + kept.count),
            (std::vector<double>{0, 1, 2, 4}));
  kw_doubles_free(&kept);
  ASSERT_EQ(kw_trim_region_intervals_at_u(region.get(), 3, &kept, nullptr), KW_OK);
  EXPECT_EQ(std::vector<double>(kept.numbers, kept.numbers + kept.count),
            (std::vector<double>{0, 4}));
  kw_doubles_free(&kept);
  EXPECT_EQ(refused<kw_trim_region>(kw_trim_region_create, loops, size_t{2}, wrong, size_t{2}, 0.0)
                .message,
            "the sizes of the loops do not add up to 2");
  const size_t* const no_sizes = nullptr;
  const Region all =
      made<Region>(kw_trim_region_create, loops, size_t{0}, no_sizes, size_t{0}, 0.0);
  EXPECT_TRUE(kw_trim_region_is_unbounded(all.get()));
}

TEST(CProgramControls, AKnotMovesWithinItsRange) {
  const Curve curve = curve_of({.name = "hat", .degree = 2, .points = {0, 1, 0, 1}});
  const kw_control_range knot{KW_CONTROL_KNOT, 3, 0, 0, 0.25, 0.75};
  kw_compile_options options = KW_COMPILE_OPTIONS_INIT;
  options.controls = &knot;
  options.controls_count = 1;
  const Program program = made<Program>(kw_compile_function, curve.get(), &options);
  EXPECT_EQ(kw_program_control_low(program.get(), 0), 0.25);
  EXPECT_EQ(kw_program_control_high(program.get(), 0), 0.75);
  EXPECT_TRUE(std::isnan(kw_program_control_low(program.get(), 1)));
  EXPECT_TRUE(std::isnan(kw_program_control_high(nullptr, 0)));
  const double moved = 0.3;
  EXPECT_NE(kw_program_at(program.get(), 0.4, 0, &moved, 1),
            kw_program_at(program.get(), 0.4, 0, nullptr, 0));
}

TEST(CMakeCompatible, TakesAnyNumberOfCurves) {
  const curves::CurveSpec line{.name = "line", .degree = 1, .points = {0, 1}};
  const Curve a = curve_of(bell()), b = curve_of(line), c = curve_of(line);
  const kw_curve* from[] = {a.get(), b.get(), c.get()};
  kw_curve* out[3];
  ASSERT_EQ(kw_curve_make_all_compatible(from, 3, out, 3, nullptr), KW_OK);
  const Curve first(out[0]), second(out[1]), third(out[2]);
  const curves::NurbsCurve theirs[] = {*curves::NurbsCurve::create(bell()),
                                       *curves::NurbsCurve::create(line),
                                       *curves::NurbsCurve::create(line)};
  const auto wanted = curves::make_compatible(std::span(theirs));
  ASSERT_TRUE(wanted);
  for (size_t i = 0; i < 3; ++i) expect_same(out[i], (*wanted)[i]);
  kw_curve* none[2];
  EXPECT_EQ(kw_curve_make_all_compatible(from, 3, none, 2, nullptr), KW_DIMENSION_MISMATCH);
  EXPECT_EQ(none[0], nullptr);
}

}  // namespace
}  // namespace knotwave::c

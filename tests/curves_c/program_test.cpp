// SPDX-License-Identifier: MIT
// Programs through C: the samples of C++, no allocation, any split, defined for every input.
#include <cmath>
#include <limits>

#include "knotwave/curves/compile.h"

#include "c_handles.h"
#include "support/allocation_count.h"

namespace knotwave::c {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class CProgram : public testing::Test {
 protected:
  const curves::CurveProgram theirs_ =
      *curves::compile_function(*curves::NurbsCurve::create(bell()));
  const Curve curve_ = curve_of(bell());
  const Program program_ = made<Program>(kw_compile_function, curve_.get(), nullptr);
  const kw_program* const p_ = program_.get();
};

TEST_F(CProgram, TellsWhatItIs) {
  EXPECT_EQ(kw_program_dim(p_), 1);
  EXPECT_TRUE(kw_program_is_rational(p_));
  EXPECT_FALSE(kw_program_is_periodic(p_));
  EXPECT_EQ(kw_program_piece_count(p_), theirs_.piece_count());
  EXPECT_EQ(kw_program_piece_degree(p_), theirs_.piece_degree());
  EXPECT_EQ(kw_program_u_min(p_), 0);
  EXPECT_EQ(kw_program_u_max(p_), 1);
  EXPECT_EQ(kw_program_max_error(p_), theirs_.max_error());
  EXPECT_EQ(kw_program_low(p_, 0), -0.25);
  EXPECT_EQ(kw_program_high(p_, 0), 1);
  EXPECT_TRUE(std::isnan(kw_program_low(p_, 1)));
  EXPECT_TRUE(std::isnan(kw_program_high(p_, -1)));
  size_t count = 0;
  const double* breaks = kw_program_breaks(p_, &count);
  EXPECT_EQ(std::vector<double>(breaks, breaks + count), (std::vector<double>{0, 0.5, 1}));
  const double* powers = kw_program_coefficients(p_, 1, 1, &count);
  const auto wanted = theirs_.coefficients(1, 1);
  EXPECT_EQ(std::vector<double>(powers, powers + count),
            std::vector<double>(wanted.begin(), wanted.end()));
  EXPECT_EQ(kw_program_coefficients(p_, 2, 0, &count), nullptr);
  EXPECT_EQ(kw_program_coefficients(p_, 0, 2, &count), nullptr);
  EXPECT_EQ(kw_program_control_count(p_), 0);
  EXPECT_TRUE(std::isnan(kw_program_control_rest(p_, 0)));
}

TEST_F(CProgram, RendersTheSamplesOfTheLibraryInBlocksOfAnySize) {
  constexpr size_t kCount = 257;
  std::vector<double> wanted(kCount), whole(kCount);
  std::vector<float> wanted_float(kCount), grid(kCount);
  curves::CurveCursor cursor;
  const curves::GridRun run{-0.1, 1.3 / 256, 5};
  theirs_.render(run, std::span<double>(wanted), cursor);
  theirs_.render(run, std::span<float>(wanted_float), cursor);
  ASSERT_EQ(kw_program_render(p_, -0.1, 1.3 / 256, 5, 0, whole.data(), kCount, nullptr), KW_OK);
  EXPECT_EQ(whole, wanted);
  for (size_t block = 1; block <= 64; ++block) {
    std::vector<double> out(kCount);
    std::vector<float> out_float(kCount);
    int32_t hint = 0, float_hint = 0;
    for (size_t at = 0; at < kCount; at += block) {
      const size_t n = std::min(block, kCount - at);
      const auto first = 5 + int64_t(at);
      kw_program_render(p_, -0.1, 1.3 / 256, first, 0, out.data() + at, n, &hint);
      kw_program_render_float(p_, -0.1, 1.3 / 256, first, 0, out_float.data() + at, n, &float_hint);
    }
    EXPECT_EQ(out, wanted) << block;
    EXPECT_EQ(out_float, wanted_float) << block;
  }
  std::vector<float> wanted_grid(kCount);
  theirs_.evaluate_grid({0, 1, 256}, 0, wanted_grid);
  ASSERT_EQ(kw_program_evaluate_grid(p_, 0, 1, 256, 0, grid.data(), kCount), KW_OK);
  EXPECT_EQ(grid, wanted_grid);
  EXPECT_EQ(grid.back(), 0.0F);
}

TEST_F(CProgram, PlaysAtAnyPlaces) {
  const double places[] = {0.7, 0.1, -3, 0.5, 9, kNaN};
  double out[6];
  int32_t cursor = 1 << 30;
  ASSERT_EQ(kw_program_render_at(p_, places, 6, 0, out, 6, &cursor), KW_OK);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(out[i], theirs_.at_u(places[i]));
    EXPECT_EQ(kw_program_at(p_, places[i], 0, nullptr, 0), theirs_.at_u(places[i]));
    EXPECT_EQ(kw_program_slope_at(p_, places[i], 0, nullptr, 0), theirs_.slope_at_u(places[i]));
  }
}

TEST_F(CProgram, ControlsMoveWhatWasDeclared) {
  const kw_control_range moved = {KW_CONTROL_WEIGHT, 2, 0, 0, 0.5, 8};
  kw_compile_options options = KW_COMPILE_OPTIONS_INIT;
  options.controls = &moved;
  options.controls_count = 1;
  const Program made_program = made<Program>(kw_compile_function, curve_.get(), &options);
  const Program program = made<Program>(kw_program_copy, made_program.get());
  EXPECT_EQ(kw_program_control_count(program.get()), 1);
  EXPECT_EQ(kw_program_control_rest(program.get(), 0), 4);
  const double u[3] = {0.25, 0.25, 0.25}, weights[3] = {1, 4, 8};
  const double* const controls[] = {weights};
  const double* const both[] = {weights, weights};
  double out[3];
  ASSERT_EQ(kw_program_render_controlled(program.get(), u, 3, controls, 1, 0, out, 3, nullptr),
            KW_OK);
  EXPECT_LT(out[0], out[1]);
  EXPECT_LT(out[1], out[2]);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(out[i], kw_program_at(program.get(), 0.25, 0, &weights[i], 1));
  }
  EXPECT_EQ(kw_program_render_controlled(program.get(), u, 3, both, 2, 0, out, 3, nullptr),
            KW_DIMENSION_MISMATCH);
  const kw_control_range reserved = {KW_CONTROL_WEIGHT, 2, 0, 5, 0.5, 8};
  options.controls = &reserved;
  EXPECT_EQ(refused<kw_program>(kw_compile_function, curve_.get(), &options).message,
            "control 0: reserved is 5, not 0");
  options.controls_count = SIZE_MAX;
  EXPECT_EQ(refused<kw_program>(kw_compile_function, curve_.get(), &options).message,
            "18446744073709551615 controls, at most 8 are allowed");
  options.controls_count = 1;
  const kw_control_range unknown = {2, 2, 0, 0, 0.5, 8};
  options.controls = &unknown;
  EXPECT_EQ(refused<kw_program>(kw_compile_function, curve_.get(), &options).status,
            KW_VALUE_OUT_OF_RANGE);
}

TEST_F(CProgram, EveryInputHasAnOutput) {
  double out[2] = {7, 7};
  float out_float[2] = {7, 7};
  EXPECT_EQ(kw_program_render(p_, 0, 0.1, 0, 1, out, 2, nullptr), KW_DIMENSION_MISMATCH);
  EXPECT_EQ(out[1], 0);
  EXPECT_EQ(kw_program_render(p_, kNaN, kNaN, 0, 0, out, 2, nullptr), KW_OK);
  EXPECT_EQ(out[1], theirs_.at_u(0));
  EXPECT_EQ(kw_program_evaluate_grid(p_, 0, 1, 0, 0, out_float, 2), KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(out_float[1], 0);
  out_float[1] = 7;
  EXPECT_EQ(kw_program_render_float(nullptr, 0, 1, 0, 0, out_float, 2, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(out_float[1], 0);
  EXPECT_EQ(kw_program_render(p_, 0, 1, 0, 0, nullptr, 2, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_program_render_at(p_, out, 1, 0, out, 2, nullptr), KW_DIMENSION_MISMATCH);
  EXPECT_EQ(kw_program_render(p_, 0, 1, 0, 0, nullptr, 0, nullptr), KW_OK);
}

TEST_F(CProgram, AllocatesNothingWhilePlaying) {
  std::vector<double> out(512), places(512, 0.3);
  std::vector<float> out_float(512);
  int32_t cursor = 0;
  const auto play = [&] {
    kw_program_render(p_, 0, 1e-3, 0, 0, out.data(), out.size(), &cursor);
    kw_program_render_float(p_, 0, 1e-3, 0, 0, out_float.data(), out_float.size(), &cursor);
    kw_program_render_at(p_, places.data(), places.size(), 0, out.data(), out.size(), &cursor);
    kw_program_evaluate_grid(p_, 0, 1, 511, 0, out_float.data(), out_float.size());
    kw_program_at(p_, 0.5, 0, nullptr, 0);
    kw_curve_evaluate_many(curve_.get(), places.data(), places.size(), KW_SIDE_LEFT, out.data(),
                           out.size());
    kw_curve_derivatives(curve_.get(), 0.5, 3, KW_SIDE_LEFT, out.data(), 4);
    kw_curve_evaluate(nullptr, 0, 0, nullptr, 0);
  };
  EXPECT_EQ(support::allocations_in(play), 0);
  EXPECT_GT(support::allocations_in([&] { made<Curve>(kw_curve_reverse, curve_.get()); }), 0);
}

TEST_F(CProgram, TheOtherCompilersAreThereToo) {
  const curves::CurveSpec circle = {
      .name = "arc", .degree = 2, .dim = 2, .points = {1, 0, 1, 1, 0, 1}, .weights = {1, 1, 2}};
  const Curve arc = curve_of(circle);
  const Program orbit = made<Program>(kw_compile_parametric, arc.get(), nullptr);
  const Program pieces = made<Program>(kw_compile_polynomial, arc.get(), nullptr);
  EXPECT_TRUE(kw_program_is_rational(orbit.get()));
  EXPECT_FALSE(kw_program_is_rational(pieces.get()));
  const double x = kw_program_at(orbit.get(), 0.3, 0, nullptr, 0);
  const double y = kw_program_at(orbit.get(), 0.3, 1, nullptr, 0);
  EXPECT_NEAR(x * x + y * y, 1, 1e-15);
  EXPECT_NEAR(kw_program_at(pieces.get(), 0.3, 1, nullptr, 0), y, 1e-7);
  EXPECT_EQ(refused<kw_program>(kw_compile_function, arc.get(), nullptr).status, KW_NOT_A_FUNCTION);
}

}  // namespace
}  // namespace knotwave::c

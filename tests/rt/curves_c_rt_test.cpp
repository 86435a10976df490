// SPDX-License-Identifier: MIT
// The [audio] and [any] functions of the C interface inside the gate, called from its shared
// library.
#include <array>

#include <gtest/gtest.h>

#include "knotwave/curves.h"

#include "rt_gate.h"

namespace knotwave::rt {
namespace {

class CurvesFromCInTheGate : public testing::TestWithParam<Gate> {};

TEST_P(CurvesFromCInTheGate, RenderingAndEvaluation) {
  const std::array<double, 5> points = {0, 0, 1, 0, 0}, weights = {1, 1, 4, 1, 1};
  kw_curve_spec spec = KW_CURVE_SPEC_INIT;
  spec.points = points.data();
  spec.points_count = points.size();
  spec.weights = weights.data();
  spec.weights_count = weights.size();
  kw_curve* curve = nullptr;
  kw_program* program = nullptr;
  ASSERT_EQ(kw_curve_create(&spec, &curve, nullptr), KW_OK);
  ASSERT_EQ(kw_compile_function(curve, nullptr, &program, nullptr), KW_OK);

  kw_map_set* maps = nullptr;
  kw_map_key amp = {};
  ASSERT_EQ(kw_map_set_create(&maps, nullptr), KW_OK);
  ASSERT_EQ(kw_map_set_define_curve(maps, KW_TARGET_AMP, 0, 1, curve, 1e-7, &amp, nullptr), KW_OK);

  std::array<double, 256> out{}, places{};
  std::array<float, 256> out_float{};
  places.fill(0.3);
  kw_status worst = KW_OK;
  kw_map_values values = {};
  const kw_map_grid grid = {0, 1, 255};
  const kw_map_channel channel = {KW_TARGET_AMP, 0, out.data(), out.size()};
  const double half = 0.5;
  const auto work = [&] {
    int32_t cursor = 0;
    const kw_status states[] = {
        kw_program_render(program, 0, 1e-3, 0, 0, out.data(), out.size(), &cursor),
        kw_program_render_float(program, 0, 1e-3, 0, 0, out_float.data(), out_float.size(),
                                &cursor),
        kw_program_render_at(program, places.data(), places.size(), 0, out.data(), out.size(),
                             &cursor),
        kw_program_evaluate_grid(program, 0, 1, 255, 0, out_float.data(), out_float.size()),
        kw_curve_evaluate_many(curve, places.data(), places.size(), KW_SIDE_LEFT, out.data(),
                               out.size()),
        kw_curve_derivatives(curve, 0.5, 3, KW_SIDE_RIGHT, out.data(), 4),
        kw_curve_evaluate_extrapolated(curve, 7, KW_EXTRAPOLATE_HOLD, KW_EXTRAPOLATE_MIRROR,
                                       out.data(), 1),
        kw_curve_curvature(curve, 0.5, KW_SIDE_RIGHT, out.data()),
        kw_map_set_enable(maps, &amp, true) ? KW_OK : KW_INTERNAL,
        kw_map_set_set_current(maps, KW_TARGET_PAN, &half, 1),
        kw_map_set_evaluate(maps, 0.5, &values),
        kw_map_set_slopes_uv(maps, 0.5, 0.5, &values, &values),
        kw_map_set_evaluate_grid(maps, &grid, 0, &channel, 1),
        kw_map_set_evaluate_mesh(maps, &grid, 0, 16, &grid, 0, &channel, 1)};
    for (const kw_status state : states) worst = state > worst ? state : worst;
    out[0] += kw_program_at(program, 0.5, 0, nullptr, 0) +
              kw_program_slope_at(program, 0.5, 0, nullptr, 0);
  };
  const GateReport report = run_in_gate(GetParam(), work, work);  // the first touches its pages
  EXPECT_EQ(report.findings(), "");
  EXPECT_EQ(worst, KW_OK);
  kw_map_set_free(maps);
  kw_program_free(program);
  kw_curve_free(curve);
}

INSTANTIATE_TEST_SUITE_P(Both, CurvesFromCInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt

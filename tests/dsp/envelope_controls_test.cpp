// SPDX-License-Identifier: MIT
// Envelopes whose points and weights are moved while they sound.
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/envelope.h"

#include "envelopes.h"
#include "support/block_sweep.h"

namespace {

using namespace knotwave::test;
using knotwave::curves::ControlRange;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;

TEST(Envelope, ControlsMoveItAndJoinsKeepItsValue) {
  EnvelopeSpec spec;
  spec.seconds = 0.1;
  spec.sustain_u = 0.625;
  spec.compile.controls = {{ControlRange::Kind::coordinate, 2, 0, 0, 2}};
  const NurbsCurve curve = bell();
  const EnvelopeProgram program = program_of(curve, spec);
  ASSERT_EQ(program.program().control_count(), 1);
  CurveSpec moved = curve.spec();
  moved.points[2] = 1.75;
  const NurbsCurve moved_curve = NurbsCurve::create(moved).value();

  Envelope envelope;
  const std::vector<double> constant(4000, 1.75);
  const double* const controls[] = {constant.data()};
  std::vector<double> y(1200);
  envelope.gate_on(program, {0, 0}, kRate, 1);
  envelope.render(program, 0, controls, y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    EXPECT_NEAR(y[i], value_of(moved_curve, static_cast<double>(i) / 4800), 1e-12);
  }
  envelope.gate_on(program, {1200, 0}, kRate, 1);
  std::vector<double> joined(400);
  envelope.render(program, 1200, controls, joined);
  EXPECT_NEAR(joined[0], value_of(moved_curve, 0.25), 1e-12);
  // Still controls: the slope is kept too.
  EXPECT_NEAR(joined[1] - joined[0], y[1199] - y[1198], 1e-5);
}

TEST(Envelope, ABlockWithControlsMayBeSplitAnywhere) {
  EnvelopeSpec spec;
  spec.seconds = 0.01;
  spec.loop_start_u = 0.25;
  spec.loop_end_u = 0.6;
  spec.compile.controls = {{ControlRange::Kind::weight, 2, 0, 0.1, 10}};
  const EnvelopeProgram program =
      program_of(curve_of({0, 0, 1, 0.8, 0.5, 0, 0}, 3, {1, 1, 2, 1, 1, 1, 1}), spec);
  std::vector<double> weight(1500);
  for (std::size_t i = 0; i < weight.size(); ++i)
    weight[i] = 1 + 0.9 * std::sin(0.05 * static_cast<double>(i));
  weight[700] = std::numeric_limits<double>::quiet_NaN();
  knotwave::support::expect_block_size_does_not_matter<double>(1500, [&] {
    Envelope envelope;
    envelope.gate_on(program, {0, 12345}, kRate, 1);
    return [&, envelope](std::size_t first, std::span<double> out) mutable {
      const double* const controls[] = {weight.data() + first};
      if (first == 0) {
        out[0] = 0;
        const double* const later[] = {weight.data() + 1};
        envelope.render(program, 1, later, out.subspan(1));
      } else {
        envelope.render(program, static_cast<std::int64_t>(first), controls, out);
      }
      for (const double y : out) ASSERT_TRUE(std::isfinite(y));
    };
  });
}

}  // namespace

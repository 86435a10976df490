// SPDX-License-Identifier: MIT
// Envelopes whose points and weights are moved while they sound.
#include <algorithm>
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

TEST(Envelope, AMovedKnotMovesThePeakAndJoinsStayInTheHull) {
  EnvelopeSpec spec;
  spec.seconds = 0.02;
  spec.sustain_u = 0.6;
  spec.compile.controls = {{ControlRange::Kind::knot, 4, 0, 0.02, 0.45}};
  const NurbsCurve curve = bell();
  const EnvelopeProgram program = program_of(curve, spec);
  std::vector<double> knot(3000);
  for (std::size_t i = 0; i < knot.size(); ++i)
    knot[i] = 0.25 + 0.22 * std::sin(0.01 * static_cast<double>(i));
  const auto play = [&](Envelope& envelope, std::size_t first, std::span<double> out) {
    const std::size_t gates[] = {300, 421, 800, 1100, 1101, 2000};
    for (std::size_t done = 0; done < out.size();) {
      std::size_t next = out.size();
      for (std::size_t k = 0; k < std::size(gates); ++k) {
        if (gates[k] < first + done || gates[k] >= first + out.size()) continue;
        if (gates[k] > first + done) {
          next = std::min(next, gates[k] - first);
        } else if (k % 3 == 2) {
          envelope.gate_off(program, {static_cast<std::int64_t>(gates[k]), 0});
        } else {
          envelope.gate_on(program, {static_cast<std::int64_t>(gates[k]), 0}, kRate, 1);
        }
      }
      const double* const controls[] = {&knot[first + done]};
      envelope.render(program, static_cast<std::int64_t>(first + done), controls,
                      out.subspan(done, next - done));
      done = next;
    }
  };
  const auto started = [&] {
    Envelope envelope;
    envelope.gate_on(program, {0, 0}, kRate, 1);
    return envelope;
  };
  Envelope whole = started();
  std::vector<double> y(3000);
  play(whole, 0, y);
  for (std::size_t i = 0; i < 300; ++i) {
    const NurbsCurve now =
        knotwave::curves::curve_with(curve, spec.compile.controls, {std::min(knot[i], 0.45)})
            .value();
    EXPECT_NEAR(y[i], value_of(now, std::min(static_cast<double>(i) / 960, 0.6)), 1e-12) << i;
  }
  for (std::size_t i = 1; i < y.size(); ++i) {
    ASSERT_TRUE(y[i] >= 0 && y[i] <= 1) << i;
    EXPECT_NEAR(y[i], y[i - 1], 0.02) << i;  // no step at any gate
  }
  knotwave::support::expect_block_size_does_not_matter<double>(3000, [&] {
    return [&, envelope = started()](std::size_t first, std::span<double> out) mutable {
      play(envelope, first, out);
    };
  });
}

}  // namespace

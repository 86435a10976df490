// SPDX-License-Identifier: MIT
// What an envelope plays: start, hold, loop, end, at any rate and block size.
#include "knotwave/dsp/envelope.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "envelopes.h"
#include "support/allocation_count.h"
#include "support/block_sweep.h"

namespace {

using namespace knotwave::test;
using knotwave::base::SampleTime;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;

TEST(Envelope, PlaysTheCurveInTheSecondsAskedFromASubSampleStart) {
  const NurbsCurve curve = bell();
  const EnvelopeProgram program = program_of(curve, {.compile = {}, .seconds = 0.1});
  Envelope envelope;
  envelope.gate_on(program, {1000, 1u << 30}, kRate, 1);  // 1000.25
  const auto y = rendered(envelope, program, 1001, 6000);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double u = (static_cast<double>(i) + 0.75) / 4800;
    EXPECT_NEAR(y[i], value_of(curve, std::min(u, 1.0)), 1e-12) << i;
  }
  EXPECT_TRUE(envelope.is_idle());
}

TEST(Envelope, TimeScaleStretchesTheWholeCurve) {
  const NurbsCurve curve = bell();
  const EnvelopeProgram program = program_of(curve, {.compile = {}, .seconds = 0.1});
  Envelope envelope;
  envelope.gate_on(program, {0, 0}, kRate, 2);
  EXPECT_NEAR(sample_at(envelope, program, 4800), value_of(curve, 0.5), 1e-12);
  envelope.reset();
  envelope.gate_on(program, {0, 0}, kRate, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(sample_at(envelope, program, 2400), value_of(curve, 0.5), 1e-12);
  envelope.reset();
  envelope.gate_on(program, {0, 0}, kRate, 0);
  EXPECT_NEAR(sample_at(envelope, program, 1), 0, 1e-12);  // 1e-4: over within a sample
}

TEST(Envelope, RestsAtTheEndOfItsCurve) {
  const EnvelopeProgram program =
      program_of(curve_of({0, 1, 0.25, 0.25}), {.compile = {}, .seconds = 0.01});
  Envelope envelope;
  EXPECT_TRUE(envelope.is_idle());
  EXPECT_EQ(program.end_value(), 0.25);
  EXPECT_EQ(sample_at(envelope, program, 7), 0.25);
  envelope.gate_on(program, {100, 0}, kRate, 1);
  EXPECT_FALSE(envelope.is_idle());
  EXPECT_TRUE(envelope.gate_is_open());
  rendered(envelope, program, 100, 480);
  EXPECT_FALSE(envelope.is_idle());
  const auto y = rendered(envelope, program, 580, 100);
  EXPECT_TRUE(envelope.is_idle());
  EXPECT_FALSE(envelope.gate_is_open());
  for (const double value : y) EXPECT_EQ(value, 0.25);
}

TEST(Envelope, HoldsAtSustainAndThenGoesOnAsDrawnWithItsCornerRounded) {
  const NurbsCurve curve = bell();
  const EnvelopeProgram program =
      program_of(curve, {.compile = {}, .seconds = 0.1, .sustain_u = 0.5});
  ASSERT_TRUE(program.has_release());
  Envelope envelope;
  envelope.gate_on(program, {0, 0}, kRate, 1);
  const auto held = rendered(envelope, program, 0, 48000);
  for (std::size_t i = 2400; i < held.size(); ++i) ASSERT_EQ(held[i], program.program().at_u(0.5));
  EXPECT_TRUE(envelope.gate_is_open());
  envelope.gate_off(program, {48000, 1u << 31});
  const auto y = rendered(envelope, program, 48001, 3000);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double u = 0.5 + (static_cast<double>(i) + 0.5) / 4800;
    const double rounded = u < 0.5 + 0.5 / 32 ? 0.5 / 32 * 2.4 * 27 / 256 : 1e-12;  // slope -2.4
    EXPECT_NEAR(y[i], value_of(curve, std::min(u, 1.0)), rounded);
  }
  EXPECT_TRUE(envelope.is_idle());
}

TEST(Envelope, RunsOnToItsEndWhenThereIsNoReleaseSection) {
  const NurbsCurve curve = bell();
  const EnvelopeProgram program = program_of(curve, {.compile = {}, .seconds = 0.1});
  EXPECT_FALSE(program.has_release());
  Envelope with, without;
  with.gate_on(program, {0, 0}, kRate, 1);
  without.gate_on(program, {0, 0}, kRate, 1);
  with.gate_off(program, {100, 77});
  const auto a = rendered(with, program, 101, 5000), b = rendered(without, program, 101, 5000);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-13);
  EXPECT_TRUE(with.is_idle());
}

TEST(Envelope, RepeatsItsLoopForHoursWithoutDrift) {
  const NurbsCurve curve = bell();
  const EnvelopeProgram program =
      program_of(curve, {.compile = {}, .seconds = 0.1, .loop_start_u = 0.25, .loop_end_u = 0.625});
  Envelope envelope;
  envelope.gate_on(program, {0, 0}, kRate, 1);
  // The loop is 1800 samples long, the first time round it ends at sample 3000.
  for (const std::int64_t turns : {std::int64_t{0}, std::int64_t{1}, std::int64_t{100000}}) {
    for (int i = 0; i < 1800; i += 7) {
      const double u = 0.25 + i / 4800.0;
      ASSERT_NEAR(sample_at(envelope, program, 1200 + turns * 1800 + i), value_of(curve, u), 1e-9)
          << "turn " << turns << " sample " << i;
    }
  }
  EXPECT_TRUE(envelope.gate_is_open());
}

TEST(Envelope, GateMayCloseBeforeAnySampleIsRendered) {
  const EnvelopeProgram program =
      program_of(bell(), {.compile = {}, .seconds = 0.1, .sustain_u = 0.5});
  Envelope envelope;
  envelope.gate_on(program, {10, 0}, kRate, 1);
  envelope.gate_off(program, {10, 1000});
  const auto y = rendered(envelope, program, 11, 3000);
  EXPECT_NEAR(y[0], 0, 1e-3);  // from where it was, not from the sustain level
  EXPECT_TRUE(envelope.is_idle());
  envelope.gate_off(program, {4000, 0});  // closed already: nothing
  EXPECT_TRUE(envelope.is_idle());
}

TEST(Envelope, BlockSizeDoesNotMatter) {
  const EnvelopeProgram held =
      program_of(bell(), {.compile = {}, .seconds = 0.01, .sustain_u = 0.625});
  const EnvelopeProgram looped =
      program_of(bell(), {.compile = {}, .seconds = 0.01, .loop_start_u = 0.2, .loop_end_u = 0.6});
  for (const EnvelopeProgram* program : {&held, &looped}) {
    knotwave::support::expect_block_size_does_not_matter<double>(2500, [&] {
      return [&, envelope = Envelope()](std::size_t first, std::span<double> out) mutable {
        struct Gate {
          SampleTime time;
          bool on;
        };
        const Gate gates[] = {{{100, 3}, true}, {{800, 9}, false}, {{900, 1u << 31}, true},
                              {{950, 0}, true}, {{951, 7}, true},  {{1500, 0}, false},
                              {{2400, 1}, true}};
        // As an engine does: the block is cut where gates are.
        std::size_t done = 0;
        for (const Gate& gate : gates) {
          const auto at = static_cast<std::size_t>(first_sample(gate.time));
          if (at < first || at >= first + out.size()) continue;
          envelope.render(*program, static_cast<std::int64_t>(first + done), {},
                          out.subspan(done, at - first - done));
          done = at - first;
          if (gate.on) {
            envelope.gate_on(*program, gate.time, kRate, 1.1);
          } else {
            envelope.gate_off(*program, gate.time);
          }
        }
        envelope.render(*program, static_cast<std::int64_t>(first + done), {}, out.subspan(done));
      };
    });
  }
}

TEST(Envelope, AgreesAtEqualSecondsForAnyRate) {
  const EnvelopeProgram program =
      program_of(bell(), {.compile = {}, .seconds = 2, .sustain_u = 0.625});
  const auto at_time = [](double seconds, double rate_hz) {
    const double samples = seconds * rate_hz;
    const double whole = std::floor(samples);
    return SampleTime{static_cast<std::int64_t>(whole),
                      static_cast<std::uint32_t>((samples - whole) * 0x1p32)};
  };
  const auto played = [&](double rate_hz) {
    Envelope envelope;
    envelope.gate_on(program, at_time(0.101, rate_hz), rate_hz, 1.3);
    envelope.gate_on(program, at_time(0.737, rate_hz), rate_hz, 0.7);
    envelope.gate_off(program, at_time(1.313, rate_hz));
    std::vector<double> y;
    for (int i = 132; i < 190; ++i) {  // every 10 ms
      const double sample = i * 0.01 * rate_hz;
      y.push_back(sample_at(envelope, program, static_cast<std::int64_t>(sample + 0.5)));
    }
    return y;
  };
  const auto reference = played(48000);
  EXPECT_GT(reference.front(), 0.01);
  for (const double rate_hz : {44100.0, 96000.0, 384000.0}) {
    const auto y = played(rate_hz);
    for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(y[i], reference[i], 1e-6) << rate_hz;
  }
}

TEST(Envelope, HandleCurvesAreReadByTheirTime) {
  CurveSpec spec;
  spec.name = "handles";
  spec.dim = 2;
  spec.points = {0, 0, 0.1, 1, 0.3, 1, 1, 0.5, 1.5, 0.2, 1.7, 0, 2, 0};
  spec.knots = {0, 0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1, 1};
  const NurbsCurve curve = NurbsCurve::create(spec).value();
  const EnvelopeProgram program =
      program_of(curve, {.compile = {}, .seconds = 0.1, .sustain_u = 1});
  EXPECT_NEAR(program.u_per_second(), 10, 1e-12);
  Envelope envelope;
  envelope.gate_on(program, {0, 0}, kHighRate, 1);
  for (const double u : {0.1, 0.2, 0.35, 0.45}) {
    double xy[2];
    curve.evaluate(u, xy);
    const auto sample = static_cast<std::int64_t>(std::lround(xy[0] * 480000));
    EXPECT_NEAR(sample_at(envelope, program, sample), xy[1], 1e-5);
  }
  const std::int64_t again = 300000;
  rendered(envelope, program, 0, static_cast<std::size_t>(again) - 3);
  expect_c1(across(envelope, program, again, [&](Envelope& e) {
    e.gate_on(program, {again, 0}, kHighRate, 1);
  }));
}

TEST(Envelope, DoesNotAllocate) {
  const EnvelopeProgram program =
      program_of(bell(), {.compile = {}, .seconds = 0.1, .sustain_u = 0.625});
  std::vector<double> out(500);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              Envelope envelope;
              envelope.gate_on(program, {0, 0}, kRate, 1);
              envelope.render(program, 0, {}, out);
              envelope.gate_on(program, {500, 0}, kRate, 1);
              envelope.render(program, 500, {}, out);
              envelope.gate_off(program, {1000, 0});
              envelope.render(program, 1000, {}, out);
            }),
            0);
}

}  // namespace

// SPDX-License-Identifier: MIT
// What happens to value and slope where a gate moves a sounding envelope.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/envelope.h"

#include "envelopes.h"
#include "support/seed.h"

namespace {

using namespace knotwave::test;
using knotwave::base::SampleTime;
using knotwave::curves::NurbsCurve;

TEST(Envelope, ReleaseJoinsValueAndSlopeFromAnywhere) {
  const EnvelopeProgram program =
      program_of(bell(), {.compile = {}, .seconds = 0.1, .sustain_u = 0.625, .release_u = 0.75});
  for (const double u : {0.05, 0.2, 0.3, 0.45, 0.55}) {
    Envelope envelope;
    envelope.gate_on(program, {0, 0}, kHighRate, 1);
    const auto sample = static_cast<std::int64_t>(u * 480000);
    rendered(envelope, program, 0, static_cast<std::size_t>(sample) - 3);
    expect_c1(across(envelope, program, sample, [&](Envelope& e) {
      e.gate_off(program, {sample, 0});
    }));
    envelope.gate_off(program, {sample, 0});
    EXPECT_EQ(envelope.limited_joins(), 0);
    // The section is 0.25 of 0.1 s; then it rests.
    rendered(envelope, program, sample, 120001);
    EXPECT_TRUE(envelope.is_idle());
  }
}

TEST(Envelope, RetriggerJoinsWherePlainAndWhereJoining) {
  const EnvelopeProgram program =
      program_of(bell(), {.compile = {}, .seconds = 0.1, .sustain_u = 0.625});
  Envelope envelope;
  envelope.gate_on(program, {0, 0}, kHighRate, 1);
  std::int64_t sample = 0;
  // Each comes while the join of the one before is still under way (the first span lasts 120000).
  for (const int gap : {200000, 30000, 11111, 50000, 70001}) {
    rendered(envelope, program, sample, static_cast<std::size_t>(gap) - 3);
    sample += gap;
    expect_c1(across(envelope, program, sample, [&](Envelope& e) {
      e.gate_on(program, {sample, 0}, kHighRate, 1);
    }));
    envelope.gate_on(program, {sample, 0}, kHighRate, 1);
  }
  EXPECT_EQ(envelope.limited_joins(), 0);
}

TEST(Envelope, AJoinIsOverToTheBitWhenItsBasisIs) {
  const NurbsCurve curve = bell();
  const EnvelopeProgram program = program_of(curve, {.compile = {}, .seconds = 0.1});
  Envelope envelope, fresh;
  envelope.gate_on(program, {0, 0}, kRate, 1);
  rendered(envelope, program, 0, 1500);
  envelope.gate_on(program, {1500, 99}, kRate, 1);
  fresh.gate_on(program, {1500, 99}, kRate, 1);
  const auto joined = rendered(envelope, program, 1501, 4800);
  const auto plain = rendered(fresh, program, 1501, 4800);
  EXPECT_NE(joined[0], plain[0]);
  const auto over = static_cast<std::size_t>(program.start_join().u_basis_end * 4800) + 1;
  ASSERT_LT(over, 4000u);
  for (std::size_t i = over; i < joined.size(); ++i) ASSERT_EQ(joined[i], plain[i]) << i;
}

TEST(Envelope, RestartJumpsToTheStart) {
  const EnvelopeProgram program = program_of(
      bell(), {.compile = {}, .seconds = 0.1, .retrigger = EnvelopeSpec::Retrigger::restart});
  Envelope envelope, fresh;
  envelope.gate_on(program, {0, 0}, kRate, 1);
  rendered(envelope, program, 0, 1500);
  envelope.gate_on(program, {1500, 5}, kRate, 1);
  fresh.gate_on(program, {1500, 5}, kRate, 1);
  EXPECT_EQ(rendered(envelope, program, 1501, 100), rendered(fresh, program, 1501, 100));
}

TEST(Envelope, LoopThenRelease) {
  const EnvelopeProgram program =
      program_of(bell(), {.compile = {}, .seconds = 0.1, .loop_start_u = 0.25, .loop_end_u = 0.5});
  Envelope envelope;
  envelope.gate_on(program, {0, 0}, kHighRate, 1);
  const std::int64_t sample = 1000000;
  rendered(envelope, program, 0, static_cast<std::size_t>(sample) - 3);
  expect_c1(across(envelope, program, sample, [&](Envelope& e) {
    e.gate_off(program, {sample, 0});
  }));
  envelope.gate_off(program, {sample, 0});
  rendered(envelope, program, sample, 240001);
  EXPECT_TRUE(envelope.is_idle());
}

TEST(Envelope, AJoinDiesAwayAcrossLoopsAndInTheHold) {
  // One span: its bases last to the end of the domain, past the loop's end and the sustain knot.
  const NurbsCurve curve = curve_of({0, 0.9, 0.9, 0.4});
  for (const bool loops : {true, false}) {
    EnvelopeSpec spec;
    spec.seconds = 0.1;
    if (loops) {
      spec.loop_start_u = 0.4;
      spec.loop_end_u = 0.7;
    } else {
      spec.sustain_u = 0.5;
    }
    const EnvelopeProgram program = program_of(curve, spec);
    Envelope envelope, fresh;
    envelope.gate_on(program, {0, 0}, kRate, 1);
    rendered(envelope, program, 0, 2000);
    envelope.gate_on(program, {2000, 0}, kRate, 1);
    fresh.gate_on(program, {2000, 0}, kRate, 1);
    const auto y = rendered(envelope, program, 2000, 20000);
    const auto plain = rendered(fresh, program, 2000, 20000);
    double last = y[0] - plain[0];
    EXPECT_GT(std::abs(last), 0.1);
    for (std::size_t i = 1; i < y.size(); ++i) {
      const double added = y[i] - plain[i];
      EXPECT_LT(std::abs(added - last), 2e-3) << i;  // no step at the loop's end
      last = added;
    }
    EXPECT_EQ(last, 0);
  }
}

// A slow rise to 1 and a fall of 1 in 10 ms.
NurbsCurve steep() {
  return curve_of({0, 0.5, 1, 1, 1, 0, 0}, 3, {},
                  {0, 0, 0, 0, 0.9, 0.9, 0.9, 0.91, 0.91, 0.91, 0.91});
}

TEST(Envelope, SteepSlopesStayInTheHullAndAreCountedAndStillJoin) {
  const EnvelopeProgram program = program_of(steep(), {.compile = {}, .seconds = 0.91});
  for (const double seconds : {0.903, 0.905, 0.907}) {
    Envelope envelope;
    envelope.gate_on(program, {0, 0}, kHighRate, 1);
    const auto sample = static_cast<std::int64_t>(seconds * kHighRate);
    rendered(envelope, program, 0, static_cast<std::size_t>(sample) - 3);
    expect_c1(across(envelope, program, sample, [&](Envelope& e) {
      e.gate_on(program, {sample, 0}, kHighRate, 1);
    }));
    envelope.gate_on(program, {sample, 0}, kHighRate, 1);
    EXPECT_EQ(envelope.limited_joins(), 1);
    for (const double y : rendered(envelope, program, sample, 4000000)) {
      ASSERT_GE(y, 0);
      ASSERT_LE(y, 1 + 1e-12);
    }
  }
}

TEST(Envelope, StraightLinesJoinTheirSlopeToo) {
  const EnvelopeProgram program =
      program_of(curve_of({0, 1, 0.6, 0}, 1, {}, {0, 0, 0.2, 0.5, 1, 1}),
                 {.compile = {}, .seconds = 0.1, .sustain_u = 0.5});
  EXPECT_FALSE(program.start_join().moves_p1);
  for (const double u : {0.1, 0.3}) {
    for (const bool off : {true, false}) {
      Envelope envelope;
      envelope.gate_on(program, {0, 0}, kHighRate, 1);
      const auto sample = static_cast<std::int64_t>(u * 480000);
      rendered(envelope, program, 0, static_cast<std::size_t>(sample) - 3);
      expect_c1(across(envelope, program, sample, [&](Envelope& e) {
        off ? e.gate_off(program, {sample, 0}) : e.gate_on(program, {sample, 0}, kHighRate, 1);
      }));
    }
  }
}

TEST(Envelope, NeverLeavesTheHullHoweverItIsPlayed) {
  const NurbsCurve curves[] = {
      bell(),
      steep(),
      curve_of({0.2, 1, 0.1, 0.9}, 1),
      curve_of({0, 1, 0, 1, 0}, 4, {1, 0.1, 20, 3, 1}),
      curve_of({0.4, 0.1, 0.2, 0.7, 1, 0.3, 0, 0.5}, 5),
      curve_of({0.3, 0, 0.9, 0.3, 1, 0.2, 0.5, 0.8}, 7, {1, 9, 0.2, 1, 30, 1, 2, 1})};
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<double> unit(0, 1);
  for (const NurbsCurve& curve : curves) {
    const double length = curve.u_max() - curve.u_min();
    const EnvelopeProgram program = program_of(
        curve, {.compile = {}, .seconds = 0.05, .sustain_u = curve.u_min() + 0.6 * length});
    const auto points = curve.points();
    const double low = *std::min_element(points.begin(), points.end());
    const double high = *std::max_element(points.begin(), points.end());
    Envelope envelope;
    std::int64_t sample = 0;
    for (int i = 0; i < knotwave::support::test_count(500); ++i) {
      const SampleTime time{sample, static_cast<std::uint32_t>(random())};
      if (unit(random) < 0.6) {
        envelope.gate_on(program, time, kRate, std::exp2(6 * unit(random) - 3));
      } else {
        envelope.gate_off(program, time);
      }
      const auto samples = static_cast<std::size_t>(1 + 3000 * unit(random) * unit(random));
      for (const double y : rendered(envelope, program, first_sample(time), samples)) {
        ASSERT_GE(y, low - 1e-9);
        ASSERT_LE(y, high + 1e-9);
      }
      sample = first_sample(time) + static_cast<std::int64_t>(samples);
    }
  }
}

}  // namespace

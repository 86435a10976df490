// SPDX-License-Identifier: MIT
#include "knotwave/dsp/envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace {

using knotwave::base::SampleTime;
using knotwave::curves::ControlRange;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::dsp::Envelope;
using knotwave::dsp::EnvelopeProgram;
using knotwave::dsp::EnvelopeSpec;

constexpr double kRate = 48000;

NurbsCurve curve_of(std::vector<double> points, int degree = 3, std::vector<double> weights = {},
                    std::vector<double> knots = {}) {
  CurveSpec spec;
  spec.name = "test";
  spec.degree = degree;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  spec.knots = std::move(knots);
  return NurbsCurve::create(std::move(spec)).value();
}

// Up to 1, down to 0.5 and from there to 0: the knots lie at 0, 0.25, 0.5, 0.75, 1.
NurbsCurve bell() { return curve_of({0, 0, 1, 0.8, 0.5, 0, 0}); }

EnvelopeProgram program_of(const NurbsCurve& curve, const EnvelopeSpec& spec) {
  auto program = EnvelopeProgram::create(curve, spec);
  if (!program) {
    ADD_FAILURE() << program.error().to_string();
    std::abort();
  }
  return *program;
}

double value_of(const NurbsCurve& curve, double u) {
  double y = 0;
  curve.evaluate(u, {&y, 1});
  return y;
}

std::vector<double> rendered(Envelope& envelope, const EnvelopeProgram& program, std::int64_t first,
                             std::size_t count) {
  std::vector<double> out(count);
  envelope.render(program, first, {}, out);
  return out;
}

double sample_at(Envelope envelope, const EnvelopeProgram& program, std::int64_t sample) {
  return rendered(envelope, program, sample, 1)[0];
}

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

// Value and slope (per sample) just before and just after an event, by a rate so high that the
// curve hardly bends between samples.
struct Ends {
  double value_before, value_after, slope_before, slope_after;
};

template <class Event>
Ends across(Envelope envelope, const EnvelopeProgram& program, std::int64_t event_sample,
            Event event) {
  const auto before = rendered(envelope, program, event_sample - 3, 3);
  event(envelope);
  const auto after = rendered(envelope, program, event_sample, 4);
  return {3 * before[2] - 3 * before[1] + before[0], after[0],
          2.5 * before[2] - 4 * before[1] + 1.5 * before[0],
          -1.5 * after[0] + 2 * after[1] - 0.5 * after[2]};
}

void expect_c1(const Ends& ends) {
  EXPECT_NEAR(ends.value_before, ends.value_after, 1e-9);
  EXPECT_NEAR(ends.slope_before / ends.slope_after, 1, 2e-3);
}

constexpr double kHighRate = 4.8e6;

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
  EXPECT_FALSE(program.joins_slope());
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
  const NurbsCurve curves[] = {bell(), steep(), curve_of({0.2, 1, 0.1, 0.9}, 1),
                               curve_of({0, 1, 0, 1, 0}, 4, {1, 0.1, 20, 3, 1})};
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

std::string error_of(const EnvelopeSpec& spec) {
  const auto program = EnvelopeProgram::create(bell(), spec);
  EXPECT_FALSE(program.has_value());
  return program ? "" : program.error().message;
}

TEST(EnvelopeProgram, SaysWhichPlaceIsWrong) {
  using ::testing::Test;
  EXPECT_EQ(error_of({.compile = {}, .seconds = 0}),
            "an envelope lasts more than 0 and less than 1e9 seconds, not 0");
  EXPECT_EQ(error_of({.compile = {}, .sustain_u = 1.5}),
            "sustain is at 1.5, the curve runs from 0 to 1");
  EXPECT_EQ(error_of({.compile = {}, .loop_start_u = 0.5, .loop_end_u = 0.25}),
            "loop start (0.5) is after loop end (0.25)");
  EXPECT_EQ(error_of({.compile = {}, .loop_start_u = 0.25, .loop_end_u = 0.5, .release_u = 0.3}),
            "loop end (0.5) is after release (0.3)");
  EXPECT_EQ(error_of({.compile = {}, .sustain_u = 0.5, .release_u = 0.3}),
            "sustain (0.5) is after release (0.3)");
  EXPECT_EQ(error_of({.compile = {}, .sustain_u = 0.3, .loop_start_u = 0.25, .loop_end_u = 0.5}),
            "an envelope holds at its sustain place (0.3) or repeats its loop (0.25 to 0.5), not "
            "both");
  EXPECT_NE(error_of({.compile = {}, .release_u = std::numeric_limits<double>::quiet_NaN()}), "");
}

}  // namespace

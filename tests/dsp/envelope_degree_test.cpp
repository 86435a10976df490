// SPDX-License-Identifier: MIT
// Envelopes of degree 8 to 15: fitted within the stated error, joined as all others.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "envelopes.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace {

using namespace knotwave::test;
using knotwave::base::SampleTime;
using knotwave::curves::NurbsCurve;

/// Up, down and to rest in `degree` + 4 points.
NurbsCurve wave_of(int degree) {
  std::vector<double> points{0, 0.2};
  for (int i = 0; i < degree; ++i) points.push_back(i % 3 == 1 ? 0.3 : 0.9);
  points.insert(points.end(), {0.1, 0});
  return curve_of(std::move(points), degree);
}

TEST(HighDegreeEnvelope, PlaysTheCurveWithinTheErrorItReports) {
  for (int degree = 8; degree <= 15; ++degree) {
    const NurbsCurve curve = wave_of(degree);
    const EnvelopeProgram program = program_of(curve, {.compile = {}, .seconds = 0.1});
    EXPECT_LE(program.program().max_error(), 1e-7);
    EXPECT_LE(program.program().piece_degree(), knotwave::curves::kMaxPieceDegree);
    Envelope envelope;
    envelope.gate_on(program, {0, 0}, kRate, 1);
    const auto out = rendered(envelope, program, 0, 4800);
    for (std::size_t i = 0; i < out.size(); ++i) {
      ASSERT_NEAR(out[i], value_of(curve, static_cast<double>(i) / 4800),
                  program.program().max_error() + 1e-13)
          << degree;
    }
  }
}

TEST(HighDegreeEnvelope, JoinsValueAndSlopeWhenRetriggeredAndReleased) {
  for (int degree = 8; degree <= 15; ++degree) {
    const EnvelopeProgram program = program_of(
        wave_of(degree), {.compile = {}, .seconds = 0.1, .sustain_u = 0.6, .release_u = 0.75});
    for (const double u : {0.11, 0.34, 0.57}) {
      Envelope envelope;
      envelope.gate_on(program, {0, 0}, kHighRate, 1);
      const auto sample = static_cast<std::int64_t>(u * 480000);
      rendered(envelope, program, 0, static_cast<std::size_t>(sample) - 3);
      for (const bool on : {true, false}) {
        expect_c1(across(envelope, program, sample, [&](Envelope& e) {
          on ? e.gate_on(program, {sample, 0}, kHighRate, 1) : e.gate_off(program, {sample, 0});
        }));
      }
    }
  }
}

TEST(HighDegreeEnvelope, HoldsRepeatsAndLetsGoWhereItIsTold) {
  const NurbsCurve curve = wave_of(11);
  const EnvelopeProgram held =
      program_of(curve, {.compile = {}, .seconds = 0.1, .sustain_u = 0.3, .release_u = 0.5});
  Envelope envelope;
  envelope.gate_on(held, {0, 0}, kRate, 1);
  EXPECT_NEAR(rendered(envelope, held, 0, 5000).back(), value_of(curve, 0.3), 1.1e-7);
  EXPECT_EQ(held.release_join().u_join, 0.5);
  envelope.gate_off(held, {5000, 0});
  const auto tail = rendered(envelope, held, 5000, 3000);
  EXPECT_NEAR(tail[0], value_of(curve, 0.3), 2e-7);
  EXPECT_TRUE(envelope.is_idle());
  const EnvelopeProgram looped =
      program_of(curve, {.compile = {}, .seconds = 0.1, .loop_start_u = 0.25, .loop_end_u = 0.5});
  Envelope turning;
  turning.gate_on(looped, {0, 0}, kRate, 1);
  const auto turns = rendered(turning, looped, 0, 12000);
  for (std::size_t i = 1200; i + 1200 < turns.size(); i += 37) {
    EXPECT_NEAR(turns[i], turns[i + 1200], 1e-9) << i;
    EXPECT_NEAR(turns[i], value_of(curve, 0.25 + std::fmod(double(i) / 4800 - 0.25, 0.25)), 1.1e-7);
  }
}

TEST(HighDegreeEnvelope, ReadsHandlesByTheirTime) {
  // x runs evenly, so y over x is the 1-D curve; and where x starts vertically it still compiles.
  std::vector<double> handles, heights{0, 0.1, 0.9, 0.8, 1, 0.3, 0.6, 0.2, 0};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    handles.insert(handles.end(), {static_cast<double>(i) / 8, heights[i]});
  }
  const auto timed = [](std::vector<double> points) {
    knotwave::curves::CurveSpec spec;
    spec.degree = 8;
    spec.dim = 2;
    spec.points = std::move(points);
    return NurbsCurve::create(std::move(spec)).value();
  };
  const EnvelopeSpec spec{.compile = {}, .seconds = 0.1, .sustain_u = 0.5};
  const EnvelopeProgram by_x = program_of(timed(handles), spec);
  const EnvelopeProgram by_u = program_of(curve_of(heights, 8), spec);
  for (double u = 0; u <= 1; u += 1.0 / 512) {
    EXPECT_NEAR(by_x.program().at_u(u), by_u.program().at_u(u), 2e-7) << u;
  }
  handles[2] = 0;  // the second point right above the first
  const EnvelopeProgram vertical = program_of(timed(handles), spec);
  EXPECT_TRUE(vertical.start_join().is_vertical);
  EXPECT_LE(vertical.program().max_error(), 1e-7);
}

TEST(HighDegreeEnvelope, LeavesTheHullByNoMoreThanTheStatedErrorHoweverItIsPlayed) {
  const EnvelopeProgram program =
      program_of(wave_of(13), {.compile = {}, .seconds = 0.05, .sustain_u = 0.6});
  const std::uint64_t seed = knotwave::support::test_seed();
  const knotwave::base::RandomStream random{seed, 13, 5};
  Envelope envelope;
  std::int64_t sample = 0;
  for (std::uint64_t i = 0; i < 600; ++i) {
    if (random.unit(3 * i) < 0.6) {
      envelope.gate_on(program, {sample, 0}, kRate, std::exp2(6 * random.unit(3 * i + 1) - 3));
    } else {
      envelope.gate_off(program, {sample, 0});
    }
    const auto count = static_cast<std::size_t>(1 + 2000 * random.unit(3 * i + 2));
    for (const double y : rendered(envelope, program, sample, count)) {
      ASSERT_GE(y, -2e-7);
      ASSERT_LE(y, 0.9 + 2e-7);
    }
    sample += static_cast<std::int64_t>(count);
  }
}

TEST(HighDegreeEnvelope, BlockSizeDoesNotMatter) {
  const EnvelopeProgram program = program_of(
      wave_of(15), {.compile = {}, .seconds = 0.01, .loop_start_u = 0.2, .loop_end_u = 0.7});
  knotwave::support::expect_block_size_does_not_matter<double>(1500, [&] {
    Envelope started;
    started.gate_on(program, {0, 77}, kRate, 1);
    rendered(started, program, 0, 333);
    started.gate_on(program, {333, 1u << 30}, kRate, 0.7);
    return [&, envelope = started](std::size_t first, std::span<double> out) mutable {
      envelope.render(program, 334 + static_cast<std::int64_t>(first), {}, out);
    };
  });
}

}  // namespace

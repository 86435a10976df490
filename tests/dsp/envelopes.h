// SPDX-License-Identifier: MIT
// Curves, programs and ways to look at them that the envelope tests share.
#pragma once
#include <cstdlib>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/dsp/envelope.h"

namespace knotwave::test {

using dsp::Envelope;
using dsp::EnvelopeProgram;
using dsp::EnvelopeSpec;

inline constexpr double kRate = 48000;
/// So high that a curve hardly bends between samples.
inline constexpr double kHighRate = 4.8e6;

inline curves::NurbsCurve curve_of(std::vector<double> points, int degree = 3,
                                   std::vector<double> weights = {},
                                   std::vector<double> knots = {}) {
  curves::CurveSpec spec;
  spec.name = "test";
  spec.degree = degree;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  spec.knots = std::move(knots);
  return curves::NurbsCurve::create(std::move(spec)).value();
}

/// Up to 1, down to 0.5 and from there to 0: the knots lie at 0, 0.25, 0.5, 0.75, 1.
inline curves::NurbsCurve bell() { return curve_of({0, 0, 1, 0.8, 0.5, 0, 0}); }

inline EnvelopeProgram program_of(const curves::NurbsCurve& curve, const EnvelopeSpec& spec) {
  auto program = EnvelopeProgram::create(curve, spec);
  if (!program) {
    ADD_FAILURE() << program.error().to_string();
    std::abort();
  }
  return *program;
}

inline double value_of(const curves::NurbsCurve& curve, double u) {
  double y = 0;
  curve.evaluate(u, {&y, 1});
  return y;
}

inline std::vector<double> rendered(Envelope& envelope, const EnvelopeProgram& program,
                                    std::int64_t first, std::size_t count) {
  std::vector<double> out(count);
  envelope.render(program, first, {}, out);
  return out;
}

inline double sample_at(Envelope envelope, const EnvelopeProgram& program, std::int64_t sample) {
  return rendered(envelope, program, sample, 1)[0];
}

/// Value and slope (per sample) just before and just after an event, at kHighRate.
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

inline void expect_c1(const Ends& ends) {
  EXPECT_NEAR(ends.value_before, ends.value_after, 1e-9);
  EXPECT_NEAR(ends.slope_before / ends.slope_after, 1, 2e-3);
}

}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// The vector functions against their scalar twins, bit by bit: numbers of every exponent, the
// borders of each range, NaN, infinities; on every vector unit; every length up
// to a few vectors.
#include "knotwave/dsp/elementary_block.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/elementary.h"
#include "knotwave/dsp/filter.h"

#include "support/allocation_count.h"
#include "support/seed.h"
#include "support/simd_guard.h"

namespace {

using knotwave::base::Phase;
using knotwave::curves::SimdLevel;

constexpr double kRate = 48000;

std::vector<double> hard_numbers() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> numbers = {0.0, -0.0, kInfinity, -kInfinity, std::nan(""), 5e-324, -5e-324};
  for (const double border : {1022.0, 1024.0, 6153.0, 6165.0, 12000.0, 134.6, 69.0, 0.5}) {
    for (const double x : {border, -border}) {
      numbers.push_back(x);
      numbers.push_back(std::nextafter(x, kInfinity));
      numbers.push_back(std::nextafter(x, -kInfinity));
    }
  }
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<double> wide(-1100, 1100), narrow(-2, 2), notes(-20, 150);
  const int count = knotwave::support::test_count(20000);
  for (int i = 0; i < count; ++i) {
    numbers.push_back(std::bit_cast<double>(random()));
    numbers.push_back(wide(random));
    numbers.push_back(narrow(random));
    numbers.push_back(notes(random));
  }
  return numbers;
}

class ElementaryBlock : public testing::TestWithParam<SimdLevel> {
 private:
  const knotwave::support::SimdGuard level_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Units, ElementaryBlock, testing::ValuesIn(knotwave::curves::simd_levels()),
                         [](const auto& level) { return to_string(level.param); });

/// The message names the first number whose bits differ.
template <class Number>
void expect_same_bits(const std::vector<Number>& found, const std::vector<Number>& expected,
                      const std::vector<double>& in) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(expected[i]))
        << "of " << in[i] << " (place " << i << ")";
  }
}

TEST_P(ElementaryBlock, Exp2HasTheBitsOfOneNumberAtATime) {
  const std::vector<double> in = hard_numbers();
  std::vector<double> expected, out = in;
  for (const double x : in) expected.push_back(knotwave::base::exp2(x));
  knotwave::dsp::exp2(out, out);
  expect_same_bits(out, expected, in);
}

TEST_P(ElementaryBlock, DbToGainHasTheBitsOfOneNumberAtATime) {
  const std::vector<double> in = hard_numbers();
  std::vector<double> expected, out = in;
  for (const double x : in) expected.push_back(knotwave::base::db_to_gain(x));
  knotwave::dsp::db_to_gain(out, out);
  expect_same_bits(out, expected, in);
}

TEST_P(ElementaryBlock, NoteIncrementsHaveTheBitsOfOneNoteAtATime) {
  const std::vector<double> notes = hard_numbers();
  for (const double rate_hz : {kRate, 1.0, 1e300, 0.0, std::nan("")}) {
    std::vector<Phase> expected, out(notes.size());
    for (const double note : notes) {
      expected.push_back(
          knotwave::base::phase_increment(knotwave::base::note_to_hz(note), rate_hz));
    }
    knotwave::dsp::note_increments(notes, rate_hz, out);
    expect_same_bits(out, expected, notes);
  }
}

TEST_P(ElementaryBlock, APhaseRampHasTheBitsOfOnePhaseAtATime) {
  std::mt19937_64 random(knotwave::support::test_seed());
  for (const double width : {1.0, 3.7, -0.1}) {
    Phase phase{random()};
    const Phase first = phase, step{random()};
    std::vector<double> expected, out(1000);
    for (std::size_t i = 0; i < out.size(); ++i) {
      expected.push_back(0.25 + phase.cycles() * width);
      phase = phase + step;
    }
    knotwave::dsp::phase_ramp(first, step, 0.25, width, out);
    expect_same_bits(out, expected, expected);
  }
}

TEST_P(ElementaryBlock, EveryLengthGivesTheSameBitsAndWritesNoFurther) {
  const std::vector<double> in = hard_numbers();
  for (std::size_t n = 0; n <= 40; ++n) {
    const auto some = std::span(in).subspan(50, n);
    std::vector<double> power(n + 1, 7), gain(n + 1, 7), ramp(n + 1, 7);
    std::vector<Phase> increments(n + 1, Phase{7});
    knotwave::dsp::exp2(some, std::span(power).first(n));
    knotwave::dsp::db_to_gain(some, std::span(gain).first(n));
    knotwave::dsp::phase_ramp({1}, {std::uint64_t{1} << 60}, 0, 1, std::span(ramp).first(n));
    knotwave::dsp::note_increments(some, kRate, std::span(increments).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const double hz = knotwave::base::note_to_hz(some[i]);
      ASSERT_EQ(power[i], knotwave::base::exp2(some[i])) << n;
      ASSERT_EQ(gain[i], knotwave::base::db_to_gain(some[i])) << n;
      ASSERT_EQ(increments[i], knotwave::base::phase_increment(hz, kRate)) << n;
      ASSERT_EQ(ramp[i], (Phase{1 + (i << 60)}.cycles())) << n;
    }
    EXPECT_EQ(power[n], 7);
    EXPECT_EQ(gain[n], 7);
    EXPECT_EQ(ramp[n], 7);
    EXPECT_EQ(increments[n], Phase{7});
  }
}

TEST_P(ElementaryBlock, TheFilterUsesTheCoefficientsOfOneSampleAtATime) {
  std::mt19937_64 random(knotwave::support::test_seed());
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> cutoff(777), resonance(777), in(777), out(777);
  for (std::size_t i = 0; i < in.size(); ++i) {
    cutoff[i] = 30000 * unit(random) * unit(random) - 100;
    resonance[i] = 1.2F * unit(random) - 0.1F;
    in[i] = 2 * unit(random) - 1;
  }
  cutoff[5] = resonance[9] = std::numeric_limits<float>::quiet_NaN();
  knotwave::dsp::StateVariableFilter filter;
  filter.render(knotwave::dsp::FilterKind::low, kRate, cutoff, resonance, in, out);
  double ic1 = 0, ic2 = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const double hz = cutoff[i] > 5 ? std::min(double{cutoff[i]}, 0.49 * kRate) : 5;
    const double q = resonance[i] > 0 ? std::min(double{resonance[i]}, 1.0) : 0;
    const double k = 2 * knotwave::base::exp2(-6.643856189774724 * q);
    const auto [s, c] = knotwave::base::sin_cos_cycles(hz * (0.5 / kRate));
    const double scale = 1 / (c * c + s * (s + k * c));
    const double a1 = c * c * scale, a2 = s * c * scale, a3 = s * s * scale;
    const double v3 = double{in[i]} - ic2;
    const double band = a1 * ic1 + a2 * v3, low = ic2 + a2 * ic1 + a3 * v3;
    ic1 = 2 * band - ic1;
    ic2 = 2 * low - ic2;
    ASSERT_EQ(out[i], static_cast<float>(low)) << i;
  }
}

TEST_P(ElementaryBlock, DoesNotAllocate) {
  std::vector<double> numbers(100, 0.5);
  std::vector<Phase> increments(100);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              knotwave::dsp::exp2(numbers, numbers);
              knotwave::dsp::db_to_gain(numbers, numbers);
              knotwave::dsp::note_increments(numbers, kRate, increments);
              knotwave::dsp::phase_ramp({0}, {1}, 0, 1, numbers);
            }),
            0);
}

}  // namespace

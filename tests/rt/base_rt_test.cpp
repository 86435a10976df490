// SPDX-License-Identifier: MIT
// The [audio] and [any] functions of base inside the gate.
#include <array>

#include <gtest/gtest.h>

#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"
#include "knotwave/base/hand_over.h"
#include "knotwave/base/random.h"
#include "knotwave/base/time.h"

#include "rt_gate.h"

namespace knotwave::rt {
namespace {

class BaseInTheGate : public testing::TestWithParam<Gate> {};

TEST_P(BaseInTheGate, ElementaryFunctionsRandomNumbersAndTime) {
  std::array<double, 512> values{};
  const auto work = [&] {
    const base::FpStateGuard guard;
    const base::RandomStream random{1, 2, 3};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = random.bipolar(i) * 100;
      values[i] = base::exp2(x) + base::log2(x) + base::sin_cos_cycles(x).sin + base::tanh(x) +
                  base::note_to_hz(x) + base::db_to_gain(x) + base::gain_to_db(x) +
                  base::phase_from_cycles(x).cycles() + base::phase_increment(x, 48000).cycles();
    }
    base::exp2(values, values);
  };
  work();  // the first touch of code and constants may fault a page in
  const GateReport report = run_in_gate(GetParam(), work);
  EXPECT_EQ(report.findings(), "");
}

TEST_P(BaseInTheGate, TakingAndReturningAnObject) {
  base::HandOver<int> hand_over(4);
  for (int i = 0; i < 4; ++i) hand_over.publish(std::make_unique<int>(i));
  int seen = 0;
  const GateReport report = run_in_gate(GetParam(), [&] {
    while (int* object = hand_over.acquire()) {
      seen += *object;
      hand_over.release(object);
    }
  });
  EXPECT_EQ(report.findings(), "");
  EXPECT_EQ(seen, 6);
  hand_over.collect();
  EXPECT_EQ(hand_over.objects_out(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Both, BaseInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt

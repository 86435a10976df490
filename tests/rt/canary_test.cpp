// SPDX-License-Identifier: MIT
// The gate catches every canary; what it does not catch it cannot promise.
#include <gtest/gtest.h>

#include "canary_list.h"
#include "rt_gate.h"
#include "support/program.h"

namespace knotwave::rt {
namespace {

class CanaryTest : public testing::TestWithParam<Canary> {};

TEST_P(CanaryTest, IsCaught) {
  const Canary& canary = GetParam();
#ifndef KNOTWAVE_HAVE_RTSAN
  if (canary.gate == Gate::sanitizer) GTEST_SKIP() << "no RealtimeSanitizer runtime here";
#endif
  const support::ProgramRun run = support::run_program({"rt_canary", canary.name});
  EXPECT_NE(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find(canary.words), std::string::npos) << run.err;
}
INSTANTIATE_TEST_SUITE_P(All, CanaryTest, testing::ValuesIn(kCanaries),
                         [](const auto& canary) { return std::string(canary.param.name); });

TEST(Gate, HasAtLeastTwentyCanaries) { EXPECT_GE(kCanaries.size(), 20u); }

TEST(Gate, LetsArithmeticPass) {
  for (const Gate gate : {Gate::sanitizer, Gate::system}) {
    volatile int x = 0;
    const GateReport report = run_in_gate(gate, [&] { x = x + 1; });
    EXPECT_EQ(report.findings(), "");
    EXPECT_EQ(x, 1);
  }
}

TEST(Gate, IsThere) {
  EXPECT_TRUE(run_in_gate(Gate::system, [] {}).watched) << "no seccomp on this system";
#ifdef KNOTWAVE_HAVE_RTSAN
  EXPECT_TRUE(run_in_gate(Gate::sanitizer, [] {}).watched);
#endif
}

}  // namespace
}  // namespace knotwave::rt

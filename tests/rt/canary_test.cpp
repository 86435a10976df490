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
  if (canary.layer == Layer::sanitizer) GTEST_SKIP() << "no RealtimeSanitizer runtime here";
#endif
  const support::ProgramRun run = support::run_program({"rt_canary", canary.name});
  EXPECT_NE(run.exit_code, 0) << run.err;
  const char* const words = canary.layer == Layer::sanitizer ? "RealtimeSanitizer"
                            : canary.layer == Layer::filter  ? "system calls"
                                                             : "page faults";
  EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
}
INSTANTIATE_TEST_SUITE_P(All, CanaryTest, testing::ValuesIn(kCanaries),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Gate, HasAtLeastTwentyCanaries) { EXPECT_GE(kCanaries.size(), 20u); }

TEST(Gate, LetsPureArithmeticPass) {
  const support::ProgramRun run = support::run_program({"rt_canary", "nothing"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("not caught"), std::string::npos);
}

TEST(Gate, HasAllItsLayersHere) {
  volatile int x = 0;
  const GateReport report = run_in_gate([&] { x = 1; });
  EXPECT_TRUE(report.filtered) << "no seccomp on this system";
#ifdef KNOTWAVE_HAVE_RTSAN
  EXPECT_TRUE(report.sanitized);
#endif
  EXPECT_EQ(report.findings(), "");
}

}  // namespace
}  // namespace knotwave::rt

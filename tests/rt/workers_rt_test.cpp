// SPDX-License-Identifier: MIT
// The engine's worker threads inside the gate: futexes and no other system call, on either side.
#include <array>
#include <atomic>

#include <gtest/gtest.h>

#include "rt_gate.h"
#include "workers.h"

namespace knotwave::rt {
namespace {

struct Rounds {
  std::array<std::atomic<int>, 3> done{};
  std::atomic<int> joined{0};
};

TEST(WorkersInTheGate, UseFutexesAndNothingElse) {
  constexpr int kRounds = 20000;
  auto started = engine::Workers::start(3);
  ASSERT_TRUE(started) << started.error().to_string();
  engine::Workers& workers = **started;
  Rounds rounds;
  const auto count = [](void* context, int thread) {
    auto& done = static_cast<Rounds*>(context)->done[static_cast<std::size_t>(thread)];
    done.fetch_add(1, std::memory_order_relaxed);
  };
  const auto join = [](void* context, int thread) {
    if (thread > 0 && join_parallel_gate()) ++static_cast<Rounds*>(context)->joined;
  };
  // The workers' own gate is for good, and allows what ends them.
  const GateReport report = run_in_gate(
      Gate::parallel,
      [&] {
        for (int i = 0; i < kRounds; ++i) workers.run(count, &rounds);
      },
      [&] {
        workers.run(join, &rounds);
        workers.run(count, &rounds);
      });
  EXPECT_EQ(report.findings(), "");
  EXPECT_EQ(rounds.joined, 2);
  for (const auto& done : rounds.done) EXPECT_EQ(done, kRounds + 1);
}

}  // namespace
}  // namespace knotwave::rt

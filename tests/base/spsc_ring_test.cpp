// SPDX-License-Identifier: MIT
// Run in the tsan preset as well: the two-thread test is there to be raced.
#include "knotwave/base/spsc_ring.h"

#include <array>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "support/seed.h"

namespace knotwave::base {
namespace {

TEST(SpscRing, TakesWhatFitsAndGivesWhatIsThere) {
  SpscRing<int> ring(5);
  EXPECT_EQ(ring.capacity(), 8u);
  std::array<int, 6> in{}, out{};
  std::iota(in.begin(), in.end(), 1);
  EXPECT_EQ(ring.write(in), 6u);
  EXPECT_EQ(ring.write(in), 2u);
  EXPECT_EQ(ring.write(in), 0u);
  EXPECT_EQ(ring.read(out), 6u);
  EXPECT_EQ(out, in);
  EXPECT_EQ(ring.write(in), 6u);  // over the end of the memory
  std::array<int, 9> all{};
  EXPECT_EQ(ring.read(all), 8u);
  EXPECT_EQ(all, (std::array<int, 9>{1, 2, 1, 2, 3, 4, 5, 6, 0}));
  EXPECT_EQ(ring.read(all), 0u);
}

TEST(SpscRing, TwoThreadsSeeEveryItemInOrderInRunsOfAnyLength) {
  SpscRing<std::uint64_t> ring(64);
  const auto count = static_cast<std::uint64_t>(support::test_count(1000000));
  std::thread producer([&] {
    std::vector<std::uint64_t> run(50);
    std::uint64_t next = 0;
    for (std::size_t size = 1; next < count; size = size % 50 + 1) {
      std::iota(run.begin(), run.end(), next);
      const std::size_t taken = ring.write(std::span(run).first(size));
      next += taken;
      if (taken == 0) std::this_thread::yield();
    }
  });
  std::vector<std::uint64_t> run(37);
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < count;) {
    const std::size_t got = ring.read(run);
    for (std::size_t i = 0; i < got; ++i) wrong += run[i] != expected++ ? 1 : 0;
    if (got == 0) std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace knotwave::base

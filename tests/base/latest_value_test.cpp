// SPDX-License-Identifier: MIT
// Run in the tsan preset as well: the two-thread test is there to be raced.
#include "knotwave/base/latest_value.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "support/seed.h"

namespace knotwave::base {
namespace {

TEST(LatestValue, IsTheDefaultBeforeAndTheNewestAfterPublishing) {
  LatestValue<int> value;
  EXPECT_EQ(value.read(), 0);
  value.publish(1);
  EXPECT_EQ(value.read(), 1);
  EXPECT_EQ(value.read(), 1);
  for (int i = 2; i < 9; ++i) value.publish(i);
  EXPECT_EQ(value.read(), 8);
  value.publish(9);
  EXPECT_EQ(value.read(), 9);
}

TEST(LatestValue, IsNeverTornAndNeverGoesBackBetweenTwoThreads) {
  using Words = std::array<std::uint64_t, 40>;
  LatestValue<Words> value;
  const auto count = static_cast<std::uint64_t>(support::test_count(200000));
  std::atomic<bool> done{false};
  std::thread writer([&] {
    Words words;
    for (std::uint64_t i = 1; i <= count; ++i) {
      words.fill(i);
      value.publish(words);
    }
    done = true;
  });
  std::uint64_t torn = 0, stale = 0, last = 0;
  for (bool more = true; more;) {
    more = !done;
    const Words& words = value.read();
    for (const std::uint64_t word : words) torn += word != words[0] ? 1 : 0;
    stale += words[0] < last ? 1 : 0;
    last = words[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(stale, 0u);
  EXPECT_EQ(last, count);
}

}  // namespace
}  // namespace knotwave::base

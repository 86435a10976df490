// SPDX-License-Identifier: MIT
#include "knotwave/io/sleeper.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/io/audio_device.h"

namespace knotwave::io {
namespace {

constexpr std::int64_t kHourNs = 3600 * std::int64_t{1'000'000'000};

TEST(Sleeper, SleepsUntilItsTimeWhereNobodyWakesIt) {
  Sleeper sleeper;
  const std::int64_t until_ns = steady_clock_ns() + 20'000'000;
  sleeper.sleep_until(until_ns);
  EXPECT_GE(steady_clock_ns(), until_ns);
  sleeper.sleep_until(until_ns);  // in the past
}

TEST(Sleeper, WakesBeforeItSleepsEndOneSleep) {
  Sleeper sleeper;
  const std::int64_t begin_ns = steady_clock_ns();
  for (int i = 0; i < 5; ++i) sleeper.wake();
  sleeper.sleep_until(begin_ns + kHourNs);
  const std::int64_t until_ns = steady_clock_ns() + 5'000'000;
  sleeper.sleep_until(until_ns);
  EXPECT_GE(steady_clock_ns(), until_ns) << "five wakes are one";
}

TEST(Sleeper, NoWorkIsMissedBetweenLookingAndSleeping) {
  constexpr int kTurns = 20000;
  Sleeper ping, pong;
  std::atomic<int> asked{0}, answered{0};
  std::thread other([&] {
    for (int i = 1; i <= kTurns; ++i) {
      while (asked < i) ping.sleep_until(steady_clock_ns() + kHourNs);
      answered = i;
      pong.wake();
    }
  });
  for (int i = 1; i <= kTurns; ++i) {
    asked = i;
    ping.wake();
    while (answered < i) pong.sleep_until(steady_clock_ns() + kHourNs);
  }
  other.join();
  EXPECT_EQ(answered, kTurns);
}

}  // namespace
}  // namespace knotwave::io

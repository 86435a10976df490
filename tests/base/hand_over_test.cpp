// SPDX-License-Identifier: MIT
// Run in the tsan preset as well: the two-thread tests are there to be raced.
#include "knotwave/base/hand_over.h"

#include <array>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "support/seed.h"

namespace knotwave::base {
namespace {

TEST(SpscRing, CapacityIsAPowerOfTwoAndIsReached) {
  SpscRing<int> ring(5);
  EXPECT_EQ(ring.capacity(), 8u);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(8));
  int item = -1;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, i);
  }
  EXPECT_FALSE(ring.pop(item));
  EXPECT_EQ(item, 7);
}

TEST(SpscRing, OfNothingStillHoldsOne) {
  SpscRing<int> ring(0);
  EXPECT_EQ(ring.capacity(), 1u);
  EXPECT_TRUE(ring.push(1));
  EXPECT_FALSE(ring.push(2));
}

TEST(SpscRing, TwoThreadsSeeEveryItemInOrder) {
  SpscRing<std::uint64_t> ring(64);
  const auto count = static_cast<std::uint64_t>(support::test_count(1000000));
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < count;) {
      if (ring.push(i)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < count;) {
    std::uint64_t item = 0;
    if (ring.pop(item)) {
      wrong += item != expected++ ? 1 : 0;
    } else {
      std::this_thread::yield();
    }
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
}

/// Counts its living instances; every word must hold the same number.
struct Program {
  explicit Program(std::uint64_t number) { words.fill(number); }
  ~Program() { --living(); }
  static std::atomic<int>& living() {
    static std::atomic<int> count{0};
    return count;
  }
  std::array<std::uint64_t, 32> words;
};
std::unique_ptr<Program> make_program(std::uint64_t number) {
  ++Program::living();
  return std::make_unique<Program>(number);
}

TEST(HandOver, WithNoCreditTheNewestWaitsAndReplacesTheOneBefore) {
  HandOver<Program> hand_over(2);
  EXPECT_TRUE(hand_over.publish(make_program(1)));
  EXPECT_TRUE(hand_over.publish(make_program(2)));
  EXPECT_FALSE(hand_over.publish(make_program(3)));
  EXPECT_FALSE(hand_over.publish(make_program(4)));
  EXPECT_EQ(hand_over.objects_out(), 2u);
  EXPECT_EQ(Program::living(), 3);  // 1, 2 and the waiting 4
  Program* first = hand_over.acquire();
  Program* second = hand_over.acquire();
  EXPECT_EQ(hand_over.acquire(), nullptr);
  EXPECT_EQ(first->words[0], 1u);
  hand_over.release(first);
  hand_over.collect();  // frees 1 and sends 4
  Program* fourth = hand_over.acquire();
  ASSERT_NE(fourth, nullptr);
  EXPECT_EQ(fourth->words[0], 4u);
  hand_over.release(second);
  hand_over.release(fourth);
  hand_over.collect();
  EXPECT_EQ(hand_over.objects_out(), 0u);
  EXPECT_EQ(Program::living(), 0);
}

TEST(HandOver, FreesWhatWasPublishedAndNeverRead) {
  {
    HandOver<Program> hand_over(4);
    for (std::uint64_t i = 0; i < 9; ++i) hand_over.publish(make_program(i));
    hand_over.release(hand_over.acquire());
  }
  EXPECT_EQ(Program::living(), 0);
}

TEST(HandOver, AMillionSwapsWith32CreditsAreWholeInOrderAndFreed) {
  const auto count = static_cast<std::uint64_t>(support::test_count(1000000));
  std::uint64_t torn = 0;
  std::uint64_t stale = 0;
  {
    HandOver<Program> hand_over(32);
    std::atomic<bool> done{false};
    std::thread audio([&] {
      Program* current = nullptr;
      std::uint64_t last = 0;
      for (bool last_round = false; !last_round;) {
        last_round = done.load(std::memory_order_acquire);
        while (Program* next = hand_over.acquire()) {
          stale += next->words[0] <= last ? 1 : 0;
          last = next->words[0];
          for (const std::uint64_t word : next->words) torn += word != last ? 1 : 0;
          if (current != nullptr) hand_over.release(current);
          current = next;
        }
        std::this_thread::yield();
      }
      if (current != nullptr) hand_over.release(current);
    });
    for (std::uint64_t number = 1; number <= count; ++number) {
      hand_over.publish(make_program(number));
      ASSERT_LE(hand_over.objects_out(), 32u);
      if (number % 64 == 0) std::this_thread::yield();
    }
    done.store(true, std::memory_order_release);
    audio.join();
    hand_over.collect();
    hand_over.collect();
  }
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(stale, 0u);
  EXPECT_EQ(Program::living(), 0);
}

}  // namespace
}  // namespace knotwave::base

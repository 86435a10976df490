// SPDX-License-Identifier: MIT
// What carries messages to their time: the queue, the place in a cycle, the count of what was late.
#include "knotwave/io/midi_queue.h"

#include <algorithm>
#include <random>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "knotwave/io/lateness.h"

#include "midi_placement.h"
#include "support/seed.h"

namespace knotwave::io {
namespace {

using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

base::MidiEvent event(std::uint8_t status, std::uint8_t one = 0, std::uint8_t two = 0) {
  base::MidiEvent event;
  event.bytes[0] = status;
  event.bytes[1] = one;
  event.bytes[2] = two;
  return event;
}

base::MidiEvent sysex(const Bytes& data) {
  base::MidiEvent event;
  event.bytes[0] = 0xF0;
  event.sysex = data.data();
  event.sysex_size = static_cast<std::uint32_t>(data.size());
  return event;
}

Bytes next(MidiQueue& queue) {
  const MidiQueue::Message* message = queue.front();
  if (message == nullptr) return {};
  Bytes bytes(message->bytes.begin(), message->bytes.end());
  queue.drop_front();
  return bytes;
}

TEST(MidiQueues, GiveMessagesAsTheyStandOnTheWire) {
  MidiQueue queue(16, 64);
  Bytes data = {1, 2, 3};
  EXPECT_TRUE(queue.push(event(0x90, 60, 100), 5));
  EXPECT_TRUE(queue.push(sysex(data), 6));
  data = {9, 9, 9};  // it was copied
  EXPECT_TRUE(queue.push(event(0xC3, 7), 7));
  EXPECT_TRUE(queue.push(event(0xF8), 8));
  EXPECT_FALSE(queue.push(event(0x40), 9));
  EXPECT_FALSE(queue.push(event(0xF4), 9));
  EXPECT_EQ(queue.front()->due_ns, 5);
  EXPECT_EQ(next(queue), (Bytes{0x90, 60, 100}));
  EXPECT_EQ(next(queue), (Bytes{0xF0, 1, 2, 3, 0xF7}));
  EXPECT_EQ(next(queue), (Bytes{0xC3, 7}));
  EXPECT_FALSE(queue.is_empty());
  EXPECT_EQ(next(queue), (Bytes{0xF8}));
  EXPECT_TRUE(queue.is_empty());
  EXPECT_EQ(queue.front(), nullptr);
}

TEST(MidiQueues, RefuseWhatTheyHaveNoRoomForAndKeepTheRest) {
  MidiQueue queue(4, 32);
  const Bytes data(20, 7), longest(kLongestMidi - 1, 7);
  EXPECT_FALSE(queue.push(sysex(longest), 0));
  EXPECT_TRUE(queue.push(sysex(data), 0));
  EXPECT_FALSE(queue.push(sysex(data), 0));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.push(event(0xFE), i));
  EXPECT_FALSE(queue.push(event(0xFE), 3));
  EXPECT_EQ(next(queue).size(), 22u);
  EXPECT_TRUE(queue.push(sysex(data), 0));
}

TEST(MidiQueues, LoseNothingBetweenTwoThreads) {
  MidiQueue queue(64, 512);
  constexpr int kMessages = 20000;
  std::thread producer([&queue] {
    Bytes data;
    for (int i = 0; i < kMessages; ++i) {
      data.assign(static_cast<std::size_t>(i % 40), static_cast<std::uint8_t>(i % 128));
      const auto two = static_cast<std::uint8_t>(i / 128 % 128);
      const auto one = static_cast<std::uint8_t>(i % 128);
      while (!queue.push(i % 3 == 0 ? sysex(data) : event(0xB0, one, two), i)) {
        std::this_thread::yield();
      }
    }
  });
  int wrong = 0;
  for (int i = 0; i < kMessages; ++i) {
    const MidiQueue::Message* message = nullptr;
    while ((message = queue.front()) == nullptr) std::this_thread::yield();
    const std::size_t size = i % 3 == 0 ? static_cast<std::size_t>(i % 40) + 2 : 3;
    wrong += message->due_ns != i || message->bytes.size() != size ||
             (size > 2 && message->bytes[1] != i % 128);
    queue.drop_front();
  }
  producer.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(queue.is_empty());
}

TEST(MidiPlacements, AreOneBlockLaterAndAtTheSameFrame) {
  MidiPlacement placement;
  placement.advance(0, 1'000'000'000, 480);  // 10 ms at 48 kHz
  EXPECT_FALSE(placement.is_due(0));
  placement.advance(480, 1'010'000'000, 480);
  EXPECT_TRUE(placement.is_due(1'009'999'999));
  EXPECT_FALSE(placement.is_due(1'010'000'000));
  EXPECT_EQ(placement.offset(1'000'000'000), 0);
  EXPECT_EQ(placement.offset(1'000'000'000 + 100 * 1'000'000 / 48), 100);
  EXPECT_EQ(placement.late_ns(1'000'000'000), 0);
  EXPECT_EQ(placement.offset(1'009'999'999), 479);
}

TEST(MidiPlacements, OfWhatComesTooLateAreFirst) {
  MidiPlacement placement;
  placement.advance(0, 0, 100);
  placement.advance(100, 1'000'000, 100);
  EXPECT_EQ(placement.offset(-5'000'000'000'000'000'000), 0);
  EXPECT_EQ(placement.late_ns(-7), 7);
  placement.advance(500, 5'000'000, 100);  // three cycles were skipped
  EXPECT_EQ(placement.offset(1'500'000), 0);
  EXPECT_EQ(placement.late_ns(1'500'000), 2'500'000);
  EXPECT_EQ(placement.offset(4'000'000), 0);
  EXPECT_EQ(placement.offset(4'500'000), 50);
  EXPECT_EQ(placement.late_ns(4'500'000), 0);
}

TEST(MidiPlacements, KeepTheOrderAndTheSpacingWhateverTheCyclesDo) {
  std::mt19937_64 random(support::test_seed());
  for (int run = 0; run < support::test_count(50); ++run) {
    MidiPlacement placement;
    std::int64_t frame = 0, begin_ns = 0, due_ns = 0, last = -1;
    for (int cycle = 0; cycle < 50; ++cycle) {
      placement.advance(frame, begin_ns, 256);
      while (cycle > 0 && placement.is_due(due_ns)) {
        const std::int64_t at = frame + placement.offset(due_ns);
        ASSERT_GE(at, last);
        ASSERT_LT(at, frame + 256);
        last = at;
        due_ns += static_cast<std::int64_t>(random() % 1'000'000);
      }
      frame += 256;
      begin_ns += 5'333'333 + static_cast<std::int64_t>(random() % 200'001) - 100'000;
    }
  }
}

TEST(LatenessCounts, AreTheQuantilesRoundedUpByAnEighthAtMost) {
  std::mt19937_64 random(support::test_seed());
  Lateness lateness;
  EXPECT_EQ(lateness.figures().count, 0);
  EXPECT_EQ(lateness.figures().p99_ns, 0);
  std::vector<std::int64_t> all;
  for (int i = 0; i < 5000; ++i) {
    all.push_back(static_cast<std::int64_t>(random() >> (random() % 40 + 24)));
    lateness.add(all.back());
  }
  std::sort(all.begin(), all.end());
  const Lateness::Figures figures = lateness.figures();
  EXPECT_EQ(figures.count, 5000);
  EXPECT_EQ(figures.max_ns, all.back());
  for (const auto& [found, right] :
       {std::pair(figures.median_ns, all[2499]), std::pair(figures.p99_ns, all[4949])}) {
    EXPECT_GE(found, right);
    EXPECT_LE(static_cast<double>(found), static_cast<double>(right) * 1.125);
  }
  lateness.add(-5);
  EXPECT_EQ(lateness.figures().count, 5001);
}

}  // namespace
}  // namespace knotwave::io

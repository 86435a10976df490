// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_stream.h"

#include <algorithm>
#include <array>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Message {
  std::array<std::uint8_t, 3> bytes{};
  Bytes sysex;
  friend bool operator==(const Message&, const Message&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Message& message) {
    out << std::hex;
    for (const int byte : message.bytes) out << byte << ' ';
    for (const int byte : message.sysex) out << byte << ' ';
    return out << std::dec;
  }
};
using Messages = std::vector<Message>;

Message channel(std::uint8_t status, std::uint8_t data1, std::uint8_t data2 = 0) {
  return {{status, data1, data2}, {}};
}
Message system(std::uint8_t status, std::uint8_t data1 = 0, std::uint8_t data2 = 0) {
  return {{status, data1, data2}, {}};
}
Message exclusive(const Bytes& data) { return {{0xF0, 0, 0}, data}; }

Messages feed(MidiStream& stream, const Bytes& bytes) {
  Messages messages;
  for (const std::uint8_t byte : bytes) {
    if (!stream.feed(byte)) continue;
    const base::MidiEvent& event = stream.message();
    messages.push_back({{event.bytes[0], event.bytes[1], event.bytes[2]},
                        {event.sysex, event.sysex + event.sysex_size}});
  }
  return messages;
}
Messages read(const Bytes& bytes) {
  MidiStream stream;
  return feed(stream, bytes);
}
MidiStreamCounters faults(const Bytes& bytes, std::size_t max_sysex = 16) {
  MidiStream stream(max_sysex);
  feed(stream, bytes);
  return stream.counters();
}

TEST(MidiStream, EveryKindOfMessageHasItsLength) {
  EXPECT_EQ(
      read({0x80, 1, 2, 0x91, 3, 4, 0xA2, 5, 6, 0xB3, 7, 8, 0xC4, 9, 0xD5, 10, 0xE6, 11, 12}),
      (Messages{channel(0x80, 1, 2), channel(0x91, 3, 4), channel(0xA2, 5, 6), channel(0xB3, 7, 8),
                channel(0xC4, 9), channel(0xD5, 10), channel(0xE6, 11, 12)}));
  EXPECT_EQ(read({0xF1, 0x23, 0xF2, 1, 2, 0xF3, 4, 0xF6}),
            (Messages{system(0xF1, 0x23), system(0xF2, 1, 2), system(0xF3, 4), system(0xF6)}));
}

TEST(MidiStream, ANoteOnOfVelocityZeroStaysOne) {
  EXPECT_EQ(read({0x90, 60, 0}), (Messages{channel(0x90, 60, 0)}));
}

TEST(MidiStream, RunningStatusGoesOn) {
  EXPECT_EQ(read({0x90, 60, 100, 61, 101, 60, 0, 0xC0, 1, 2}),
            (Messages{channel(0x90, 60, 100), channel(0x90, 61, 101), channel(0x90, 60, 0),
                      channel(0xC0, 1), channel(0xC0, 2)}));
  EXPECT_EQ(faults({0x90, 60, 100, 61, 101, 0x80, 60, 0}).cut_messages, 0);
}

TEST(MidiStream, RealTimeBytesInsideAMessageComeOutAtOnceAndChangeNothing) {
  EXPECT_EQ(read({0x90, 0xF8, 60, 0xFE, 100, 0xFA, 61, 0xFC, 0xFF, 101}),
            (Messages{system(0xF8), system(0xFE), channel(0x90, 60, 100), system(0xFA),
                      system(0xFC), system(0xFF), channel(0x90, 61, 101)}));
}

TEST(MidiStream, RealTimeBytesInsideSystemExclusiveComeOutAtOnceAndChangeNothing) {
  EXPECT_EQ(read({0xF0, 0xF8, 1, 0xFB, 2, 0xFE, 0xF7}),
            (Messages{system(0xF8), system(0xFB), system(0xFE), exclusive({1, 2})}));
}

TEST(MidiStream, UndefinedRealTimeBytesAreCountedAndChangeNothing) {
  EXPECT_EQ(read({0x90, 0xF9, 60, 0xFD, 100, 61, 101, 0xF0, 1, 0xF9, 2, 0xFD, 0xF7}),
            (Messages{channel(0x90, 60, 100), channel(0x90, 61, 101), exclusive({1, 2})}));
  EXPECT_EQ(faults({0x90, 0xF9, 60, 0xFD, 100}).stray_bytes, 2);
  EXPECT_EQ(faults({0x90, 0xF9, 60, 0xFD, 100}).cut_messages, 0);
}

TEST(MidiStream, SystemCommonEndsRunningStatus) {
  for (const Bytes& common : {Bytes{0xF1, 1}, {0xF2, 1, 2}, {0xF3, 1}, {0xF6}}) {
    Bytes bytes = {0x90, 60, 100};
    bytes.insert(bytes.end(), common.begin(), common.end());
    bytes.insert(bytes.end(), {61, 101});
    const Messages messages = read(bytes);
    ASSERT_EQ(messages.size(), 2u) << int{common[0]};
    EXPECT_EQ(messages[1].bytes[0], common[0]);
    EXPECT_EQ(faults(bytes).stray_bytes, 2);
  }
}

TEST(MidiStream, UndefinedSystemCommonEndsRunningStatusAndIsCounted) {
  for (const std::uint8_t undefined : Bytes{0xF4, 0xF5}) {
    EXPECT_EQ(read({0x90, 60, 100, undefined, 61, 101}), (Messages{channel(0x90, 60, 100)}));
    EXPECT_EQ(faults({0x90, 60, 100, undefined, 61, 101}).stray_bytes, 3);
    EXPECT_EQ(faults({0x90, 60, undefined}).cut_messages, 1);
  }
}

TEST(MidiStream, SystemExclusiveEndsRunningStatus) {
  EXPECT_EQ(read({0x90, 60, 100, 0xF0, 1, 0xF7, 61, 101}),
            (Messages{channel(0x90, 60, 100), exclusive({1})}));
}

TEST(MidiStream, DataWithoutAStatusIsCounted) {
  EXPECT_EQ(read({1, 2, 3, 0x90, 60, 100}), (Messages{channel(0x90, 60, 100)}));
  EXPECT_EQ(faults({1, 2, 3}).stray_bytes, 3);
}

TEST(MidiStream, ASecondStartOfSystemExclusiveBeginsAnother) {
  EXPECT_EQ(read({0xF0, 1, 2, 0xF0, 3, 0xF7}), (Messages{exclusive({3})}));
  EXPECT_EQ(faults({0xF0, 1, 2, 0xF0, 3, 0xF7}).cut_messages, 1);
}

TEST(MidiStream, AStatusCutsSystemExclusive) {
  EXPECT_EQ(read({0xF0, 1, 2, 0x90, 60, 100, 0xF7}), (Messages{channel(0x90, 60, 100)}));
  const MidiStreamCounters counters = faults({0xF0, 1, 2, 0x90, 60, 100, 0xF7});
  EXPECT_EQ(counters.cut_messages, 1);
  EXPECT_EQ(counters.stray_bytes, 1);  // the F7
}

TEST(MidiStream, AStatusCutsAMessage) {
  EXPECT_EQ(read({0x90, 60, 0x80, 60, 0}), (Messages{channel(0x80, 60, 0)}));
  EXPECT_EQ(faults({0x90, 60, 0x80, 60, 0}).cut_messages, 1);
  EXPECT_EQ(faults({0x90, 0x80, 60, 0}).cut_messages, 1);
  EXPECT_EQ(faults({0x90, 60, 100, 61, 0x80, 60, 0}).cut_messages, 1);  // of running status
  EXPECT_EQ(faults({0xF2, 1, 0x80, 60, 0}).cut_messages, 1);
}

TEST(MidiStream, AnEndWithoutABeginningIsCountedAndEndsRunningStatus) {
  EXPECT_EQ(read({0xF7, 0x90, 60, 100, 0xF7, 61, 101}), (Messages{channel(0x90, 60, 100)}));
  EXPECT_EQ(faults({0xF7, 0x90, 60, 100, 0xF7, 61, 101}).stray_bytes, 4);
}

TEST(MidiStream, EmptySystemExclusiveIsAMessage) {
  EXPECT_EQ(read({0xF0, 0xF7}), (Messages{exclusive({})}));
}

TEST(MidiStream, SystemExclusiveOfTheLimitComesOutAndALongerOneIsDroppedWholeAndCountedOnce) {
  for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, std::size_t{64}}) {
    for (const std::size_t size : {limit, limit + 1, limit + 2, limit + 1000}) {
      MidiStream stream(limit);
      Bytes bytes = {0xF0};
      bytes.insert(bytes.end(), size, 0x11);
      bytes.insert(bytes.end(), {0xF7, 0x90, 60, 100});
      const Messages messages = feed(stream, bytes);
      EXPECT_EQ(messages.size(), size <= limit ? 2u : 1u) << size << " bytes, limit " << limit;
      EXPECT_EQ(messages.back(), channel(0x90, 60, 100));
      EXPECT_EQ(stream.counters().sysex_too_long, size <= limit ? 0 : 1);
      EXPECT_EQ(stream.counters().stray_bytes, 0);
      EXPECT_EQ(stream.counters().cut_messages, 0);
    }
  }
}

TEST(MidiStream, ATooLongSystemExclusiveThatIsCutIsCountedOnce) {
  const MidiStreamCounters counters = faults({0xF0, 1, 2, 3, 4, 5, 0x90, 60, 100}, 4);
  EXPECT_EQ(counters.sysex_too_long, 1);
  EXPECT_EQ(counters.cut_messages, 0);
}

TEST(MidiStream, ResetForgetsRunningStatusAndWhatIsHalfRead) {
  for (const Bytes& half : {Bytes{0x90, 60, 100}, {0x90, 60}, {0x90}, {0xF0, 1, 2}, {0xF2, 1}}) {
    MidiStream stream;
    feed(stream, half);
    stream.reset();
    EXPECT_TRUE(feed(stream, {61, 101, 1}).empty());
    EXPECT_EQ(stream.counters().stray_bytes, 3);
    EXPECT_EQ(stream.counters().cut_messages, 0);
    EXPECT_EQ(feed(stream, {0x91, 1, 2}), (Messages{channel(0x91, 1, 2)}));
  }
}

TEST(MidiStream, FeedingAllocatesNothing) {
  MidiStream stream(100);
  EXPECT_EQ(support::allocations_in([&] {
              stream.feed(0xF0);
              for (int i = 0; i < 1000; ++i) stream.feed(static_cast<std::uint8_t>(i & 127));
              stream.feed(0xF7);
              for (int i = 0; i < 1000; ++i) stream.feed(static_cast<std::uint8_t>(i & 255));
            }),
            0);
}

class Random {
 public:
  explicit Random(std::uint64_t seed) { stream_.seed = seed; }
  int below(int n) { return static_cast<int>(stream_.bits(next_++) % static_cast<unsigned>(n)); }
  std::uint8_t data() { return static_cast<std::uint8_t>(below(128)); }

 private:
  base::RandomStream stream_;
  std::uint64_t next_ = 0;
};

/// Any message but the real-time ones, and its bytes appended to `out`; `running` is the status the
/// cable may leave out next time.
Message append_message(Random& random, Bytes& out, std::uint8_t& running) {
  constexpr std::uint8_t kCommon[] = {0xF1, 0xF2, 0xF3, 0xF6};
  const int kind = random.below(10);
  if (kind == 0) {
    Bytes data(static_cast<std::size_t>(random.below(40)));
    for (std::uint8_t& byte : data) byte = random.data();
    running = 0;
    out.push_back(0xF0);
    out.insert(out.end(), data.begin(), data.end());
    out.push_back(0xF7);
    return exclusive(data);
  }
  const std::uint8_t status = kind == 1   ? kCommon[random.below(4)]
                              : kind <= 5 ? std::max<std::uint8_t>(running, 0x80)
                                          : static_cast<std::uint8_t>(0x80 + random.below(112));
  const bool has_one = (status & 0xE0) == 0xC0 || status == 0xF1 || status == 0xF3;
  const int count = status == 0xF6 ? 0 : has_one ? 1 : 2;
  Message message{{status, 0, 0}, {}};
  if (status != running || random.below(2) == 0) out.push_back(status);
  for (int i = 1; i <= count; ++i) {
    message.bytes[static_cast<std::size_t>(i)] = random.data();
    out.push_back(message.bytes[static_cast<std::size_t>(i)]);
  }
  running = status < 0xF0 ? status : 0;
  return message;
}

TEST(MidiStream, WhatIsSentComesOutWhateverRealTimeBytesStandBetween) {
  constexpr std::uint8_t kRealTime[] = {0xF8, 0xFA, 0xFB, 0xFC, 0xFE, 0xFF};
  Random random(support::test_seed());
  for (int trial = 0; trial < support::test_count(2000); ++trial) {
    MidiStream stream(64);
    Messages sent, sent_real_time;
    Bytes plain;
    std::uint8_t running = 0;
    for (int i = 0; i < 30; ++i) sent.push_back(append_message(random, plain, running));
    Bytes bytes;
    for (const std::uint8_t byte : plain) {
      while (random.below(3) == 0) {
        bytes.push_back(kRealTime[random.below(6)]);
        sent_real_time.push_back(system(bytes.back()));
      }
      bytes.push_back(byte);
    }
    // In pieces, with another cable's bytes between them: a stream keeps its state to itself.
    MidiStream other(64);
    Messages received, real_time;
    for (std::size_t at = 0; at < bytes.size();) {
      const auto size = std::min(static_cast<std::size_t>(1 + random.below(9)), bytes.size() - at);
      const auto piece = bytes.begin() + static_cast<std::ptrdiff_t>(at);
      for (const Message& message :
           feed(stream, {piece, piece + static_cast<std::ptrdiff_t>(size)})) {
        (message.bytes[0] >= 0xF8 ? real_time : received).push_back(message);
      }
      feed(other, {random.data(), static_cast<std::uint8_t>(0x80 + random.below(128))});
      at += size;
    }
    ASSERT_EQ(received, sent) << "trial " << trial;
    ASSERT_EQ(real_time, sent_real_time) << "trial " << trial;
    ASSERT_EQ(stream.counters().stray_bytes, 0);
    ASSERT_EQ(stream.counters().cut_messages, 0);
    ASSERT_EQ(stream.counters().sysex_too_long, 0);
  }
}

TEST(MidiStream, AnyBytesGiveWholeMessagesAndTheSameOnesWithoutTheirRealTimeBytes) {
  Random random(support::test_seed() + 1);
  for (int trial = 0; trial < support::test_count(2000); ++trial) {
    Bytes bytes(static_cast<std::size_t>(random.below(300)));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
    Bytes plain;
    std::copy_if(bytes.begin(), bytes.end(), std::back_inserter(plain),
                 [](std::uint8_t byte) { return byte < 0xF8; });
    MidiStream all(8), few(8);
    Messages messages = feed(all, bytes);
    for (const Message& message : messages) {
      ASSERT_GE(message.bytes[0], 0x80);
      ASSERT_LT(message.bytes[1], 0x80);
      ASSERT_LT(message.bytes[2], 0x80);
      ASSERT_LE(message.sysex.size(), 8u);
    }
    std::erase_if(messages, [](const Message& message) { return message.bytes[0] >= 0xF8; });
    ASSERT_EQ(messages, feed(few, plain)) << "trial " << trial;
    ASSERT_EQ(all.counters().cut_messages, few.counters().cut_messages);
    ASSERT_EQ(all.counters().sysex_too_long, few.counters().sysex_too_long);
  }
}

}  // namespace
}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// Whole sessions: whatever was played, by however many threads, its journal gives the same samples;
// no note hangs, no bank is left behind. Run in the tsan preset as well.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <malloc.h>

#include "knotwave/base/random.h"
#include "knotwave/base/sha256.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/map_slots.h"

#include "live_device.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// Three banks that sound unlike each other, by their number.
std::unique_ptr<const BankProgram> numbered_bank(int number) {
  if (number == 0) return bank_from(kRich);
  return bank_from(number == 1 ? std::string(kPlain) : with(kRich, "mode = \"mono\""));
}
JournalBank source_of(int number) { return {std::to_string(number), {}, {}}; }

/// Random numbers of one thread.
class Dice {
 public:
  explicit Dice(int stream)
      : random_{support::test_seed(), 0, 6000u + static_cast<unsigned>(stream)} {}
  std::uint64_t bits() { return random_.bits(draw_++); }
  int below(int end) { return static_cast<int>(bits() % static_cast<std::uint64_t>(end)); }

 private:
  base::RandomStream random_;
  std::uint64_t draw_ = 0;
};

LiveMessage random_message(Dice& dice, std::int64_t time_ns) {
  constexpr std::array<int, 10> kStatus = {0x90, 0x90, 0x90, 0x80, 0x80,
                                           0xB0, 0xB0, 0xE0, 0xD0, 0xC0};
  constexpr std::array<int, 8> kControls = {1, 7, 10, 11, 64, 66, 120, 123};
  const int status = kStatus[static_cast<std::size_t>(dice.below(10))];
  const int one =
      status == 0xB0 ? kControls[static_cast<std::size_t>(dice.below(8))] : 36 + dice.below(48);
  LiveMessage out = message(time_ns, status | dice.below(16), one, dice.below(128));
  switch (dice.below(24)) {
    case 0:
      out.kind = LiveMessage::Kind::tempo;
      out.number = 200000 + dice.below(800000);
      break;
    case 1:
      out.kind = LiveMessage::Kind::all_notes_off;
      break;
    case 2: {  // universal master volume
      constexpr std::array<std::uint8_t, 6> kVolume = {0x7F, 0x7F, 0x04, 0x01, 0x00, 0x70};
      out = message(time_ns, 0xF0, 0, 0);
      std::copy(kVolume.begin(), kVolume.end(), out.sysex.begin());
      out.sysex_size = kVolume.size();
      break;
    }
    case 3:
    case 4:
    case 5:
      out.kind = LiveMessage::Kind::set_target;
      out.index = static_cast<std::uint16_t>(dice.below(kSlotCount + 3));
      out.number = dice.below(2000) / 500.0 - 2;
      break;
    case 6:
      out.kind = LiveMessage::Kind::position;
      out.number = dice.below(20000);
      break;
    default:
      break;
  }
  return out;
}

/// What was heard before the fade, from the first sample on.
struct Recording {
  std::vector<float> samples;  ///< interleaved
  void take(LiveEngine& live) {
    std::array<float, 2 * 1024> part;
    for (;;) {
      const LiveEngine::Tap tap = live.take_tap(part);
      if (tap.frames == 0) return;
      EXPECT_EQ(tap.first, static_cast<std::int64_t>(samples.size() / 2));
      samples.insert(samples.end(), part.begin(),
                     part.begin() + static_cast<std::ptrdiff_t>(2 * tap.frames));
    }
  }
};

std::string hash_of(std::span<const float> samples) {
  base::Sha256 hash;
  hash.update(samples);
  return hash.finish_hex();
}

/// Plays the journal, as text and back, through a plain engine.
void expect_played_again(const Journal& journal, const Recording& recording) {
  const auto read = read_journal(write_journal(journal), "session");
  ASSERT_TRUE(read) << read.error().to_string();
  const std::size_t frames = recording.samples.size() / 2;
  const auto bank = [&](std::uint32_t index) {
    return numbered_bank(std::stoi(read->banks[index].path));
  };
  const Sound again = played_again(*read, bank, frames, 777);
  std::vector<float> interleaved;
  for (std::size_t i = 0; i < frames; ++i) {
    interleaved.push_back(again.left[i]);
    interleaved.push_back(again.right[i]);
  }
  EXPECT_EQ(hash_of(interleaved), hash_of(recording.samples));
  EXPECT_GT(peak(again.left), 1e-3);
}

TEST(LiveSession, PlayedFromItsJournalGivesTheSameBits) {
  for (int session = 0; session < support::test_count(3); ++session) {
    Dice dice(session);
    const auto live = live_for(numbered_bank(0), {.engine = {.max_voices = 10}}, source_of(0));
    Device device(*live);
    live->set_tap(true);
    Recording recording;
    Journal journal;
    while (device.frames() < 60000) {
      for (int i = dice.below(60); i > 0; --i) {
        const std::int64_t ago = dice.below(30'000'000);  // not even in order
        live->push(dice.below(kLiveInputs), random_message(dice, device.time_ns() - ago));
      }
      if (dice.below(12) == 0) live->panic();
      if (dice.below(9) == 0) live->fade(static_cast<float>(dice.below(3)) / 2, 0.05F);
      if (dice.below(6) == 0) {
        const int number = dice.below(3);
        live->install(numbered_bank(number), source_of(number));
      }
      std::vector<base::MidiEvent> exact;
      const auto frames =
          static_cast<std::size_t>(1 + (dice.below(4) == 0 ? dice.below(8192) : dice.below(600)));
      for (int i = dice.below(4); i > 0; --i) {
        const auto fraction = static_cast<std::uint32_t>(dice.below(3)) << 30;
        exact.push_back({{dice.below(static_cast<int>(frames)), fraction}, {0x92, 60, 100}});
      }
      device.block(frames, dice.below(1'000'000), exact);
      recording.take(*live);
      live->take_journal(journal);
      live->collect();
    }
    ASSERT_EQ(live->status().journal_dropped, 0);
    ASSERT_EQ(recording.samples.size() / 2, static_cast<std::size_t>(device.frames()));
    expect_played_again(journal, recording);
  }
}

/// A clock that the device moves on and all threads read.
class VirtualClock {
 public:
  std::int64_t now_ns() const { return now_.load(std::memory_order_relaxed); }
  void set(std::int64_t now_ns) { now_.store(now_ns, std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> now_{5'000'000'000};
};

/// `rendering` threads share the voices; five more play, install banks and look on.
void play_from_many_threads(int rendering) {
  const auto live =
      live_for(numbered_bank(0), {.engine = {.max_voices = 10, .threads = rendering}, .tap_s = 30},
               source_of(0));
  live->set_tap(true);
  Device device(*live);
  VirtualClock clock;
  std::atomic<bool> is_over{false};
  std::vector<std::thread> threads;
  for (int input = 0; input < 4; ++input) {
    threads.emplace_back([&, input] {
      Dice dice(100 + input);
      for (int i = 0; i < 1500; ++i) {
        live->push(input, random_message(dice, clock.now_ns()));
        if (dice.below(700) == 0) live->panic();
        if (dice.below(8) == 0) std::this_thread::yield();
      }
    });
  }
  Recording recording;
  Journal journal;
  threads.emplace_back([&] {
    Dice dice(200);
    while (!is_over) {
      const int number = dice.below(3);
      live->install(numbered_bank(number), source_of(number));
      for (int i = 0; i < 20; ++i) {
        live->collect();
        live->take_journal(journal);
        recording.take(*live);
        live->status();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  });
  Dice dice(300);
  while (device.frames() < 100000) {
    const auto frames = static_cast<std::size_t>(1 + dice.below(1500));
    clock.set(device.time_ns() + dice.below(2'000'000));
    device.block(frames, dice.below(500'000));
    std::this_thread::yield();
  }
  is_over = true;
  for (std::thread& thread : threads) thread.join();
  live->take_journal(journal);
  recording.take(*live);
  ASSERT_EQ(live->status().journal_dropped, 0);
  ASSERT_EQ(live->status().tap_dropped_frames, 0);
  expect_played_again(journal, recording);
}

TEST(LiveSession, OfManyThreadsPlayedFromItsJournalGivesTheSameBits) { play_from_many_threads(1); }

TEST(LiveSession, OfManyThreadsAndTwoThatRenderGivesTheBitsOfOne) { play_from_many_threads(2); }

/// Each thread plays notes and pedals on a channel of its own as fast as it can, and then lets all
/// go, once.
TEST(LiveSession, InAStormNoNoteHangs) {
  const auto live =
      live_for(bank_from(kPlain), {.engine = {.max_voices = 64}, .input_messages = 64});
  Device device(*live);
  std::atomic<int> playing{4};
  std::atomic<bool> is_heard{false};  // however late a thread has its turn
  std::vector<std::thread> threads;
  for (int input = 0; input < 4; ++input) {
    threads.emplace_back([&, input] {
      Dice dice(400 + input);
      const auto push = [&](int status, int one, int two) {
        live->push(input, message(0, status | input, one, two));
      };
      const int count = support::test_count(20000);
      for (int i = 0; i < count || !is_heard; ++i) {
        const int what = dice.below(8);
        if (what < 7) push(what < 4 ? 0x90 : 0x80, dice.below(128), 100);
        if (what == 7) push(0xB0, dice.below(2) == 0 ? kSustain : kSostenuto, dice.below(128));
      }
      push(0xB0, kSustain, 0);
      push(0xB0, kSostenuto, 0);
      for (int key = 0; key < 128; ++key) {
        for (int times = 0; times < 64; ++times) push(0x80, key, 0);  // for each of its voices
      }
      --playing;
    });
  }
  while (playing > 0) {
    device.block(64);
    is_heard = live->status().counters.notes > 100;
  }
  for (std::thread& thread : threads) thread.join();
  device.blocks(20, 512);
  EXPECT_GT(live->status().messages_dropped, 0);
  EXPECT_GT(live->status().counters.notes, 100);
  EXPECT_EQ(live->status().counters.voices_now, 0);
}

/// Banks go in as fast as credits allow while the device plays; all of them come back.
void swap_banks(int count) {
  const std::size_t before = mallinfo2().uordblks;
  {
    const auto live = live_for(bank_from(kPlain));
    std::atomic<bool> is_over{false};
    std::thread control([&] {
      for (int i = 0; i < count;) {
        auto bank = BankProgram::create(BankSpec{});
        ASSERT_TRUE(bank);
        if (live->install(*std::move(bank))) {
          ++i;
        } else {
          std::this_thread::yield();
          live->collect();
        }
      }
      is_over = true;
    });
    std::array<float, 16> left{}, right{};
    for (std::int64_t time = 1; !is_over; time += 333'333) live->process(time, {}, left, right);
    control.join();
  }
  const std::size_t after = mallinfo2().uordblks;
  EXPECT_LT(after, before + 65536) << count << " banks";
}

TEST(LiveSession, EveryBankThatWentInComesBack) { swap_banks(support::test_count(20000)); }

TEST(LiveSessionStress, AMillionBanksGoInAndComeBack) { swap_banks(1'000'000); }

}  // namespace
}  // namespace knotwave::engine

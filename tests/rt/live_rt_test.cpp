// SPDX-License-Identifier: MIT
// The live engine inside the gate, with a control thread outside of it: every shipped patch
// installed while it plays, a storm of MIDI on several inputs, a storm of targets, panic, tap, fade
// and journal.
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/live_engine.h"
#include "knotwave/engine/map_slots.h"

#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

using engine::BankProgram;
using engine::LiveEngine;
using engine::LiveMessage;

constexpr std::size_t kBlock = 64;
constexpr std::int64_t kBlockNs = 1'333'333;
constexpr int kBlocksOfABank = 24;
constexpr int kMostBlocks = 200'000;

std::vector<std::unique_ptr<const BankProgram>> shipped_banks() {
  std::vector<std::unique_ptr<const BankProgram>> banks;
  const std::filesystem::path examples = std::filesystem::path(KNOTWAVE_SOURCE_DIR) / "examples";
  for (const char* folder : {"patches", "banks"}) {
    for (const auto& entry : std::filesystem::directory_iterator(examples / folder)) {
      if (entry.path().extension() != ".toml") continue;
      const auto spec = engine::read_bank(entry.path().string());
      EXPECT_TRUE(spec) << spec.error().to_string();
      auto bank = spec ? BankProgram::create(*spec)
                       : Result<std::unique_ptr<const BankProgram>>(spec.error());
      EXPECT_TRUE(bank) << bank.error().to_string();
      if (bank) banks.push_back(*std::move(bank));
    }
  }
  return banks;
}

/// The audio thread: messages as their threads would push them, then a block.
class Storm {
 public:
  explicit Storm(LiveEngine& live) : live_(live) {}

  void block() {
    for (int i = 0; i < 3; ++i) push();
    if (blocks_ % 500 == 499) live_.panic();
    if (blocks_ % 300 == 299) live_.fade(blocks_ % 600 < 300 ? 1.0F : 0.2F, 0.01F);
    const std::array<engine::Event, 1> exact = {
        engine::Event{.midi = {{static_cast<std::int64_t>(bits() % kBlock), 0},
                               {static_cast<std::uint8_t>(0xB0 | (bits() & 15)), 1,
                                static_cast<std::uint8_t>(blocks_ & 127)}}}};
    time_ns_ += kBlockNs;
    live_.process(time_ns_, exact, left_, right_);
    for (const float sample : left_) loudest_ = std::max(loudest_, sample < 0 ? -sample : sample);
    ++blocks_;
  }
  float loudest() const { return loudest_; }

 private:
  std::uint64_t bits() { return random_.bits(draw_++); }
  void push() {
    constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x90, 0x80,
                                                     0xB0, 0xC0, 0xD0, 0xE0};
    const std::uint64_t draw = bits();
    LiveMessage message;
    message.time_ns = time_ns_ + static_cast<std::int64_t>(draw >> 32) % kBlockNs;
    message.bytes[0] = static_cast<std::uint8_t>(kStatus[draw & 7] | (draw >> 3 & 15));
    message.bytes[1] = static_cast<std::uint8_t>(draw >> 8 & 127);
    message.bytes[2] = static_cast<std::uint8_t>(draw >> 16 & 127);
    if ((draw >> 24 & 1) != 0) {
      message.kind = LiveMessage::Kind::set_target;
      message.index = static_cast<std::uint16_t>(bits() % engine::kSlotCount);
      message.number = random_.bipolar(draw_++);
    }
    live_.push(static_cast<int>(draw >> 28 & 3), message);
  }

  LiveEngine& live_;
  base::RandomStream random_{support::test_seed(), 0, 5001};
  std::uint64_t draw_ = 0;
  std::int64_t time_ns_ = 1'000'000'000;
  int blocks_ = 0;
  std::array<float, kBlock> left_{}, right_{};
  float loudest_ = 0;
};

/// The control thread: installs one bank after the other, and does what else it has to do.
class Control {
 public:
  Control(LiveEngine& live, std::vector<std::unique_ptr<const BankProgram>> banks)
      : thread_([this, &live, all = std::move(banks)]() mutable { run(live, all); }) {}
  ~Control() { thread_.join(); }
  bool is_done() const { return done_.load(std::memory_order_relaxed); }

 private:
  void run(LiveEngine& live, std::vector<std::unique_ptr<const BankProgram>>& banks) {
    engine::Journal journal;
    std::vector<float> tap(2 * 4096);
    std::int64_t last = live.status().now;
    for (auto& bank : banks) {
      live.install(std::move(bank));
      while (live.status().now < last + kBlocksOfABank * std::int64_t{kBlock}) {
        live.collect();
        live.take_journal(journal);
        live.take_tap(tap);
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
      last = live.status().now;
    }
    done_ = true;
  }
  std::atomic<bool> done_{false};
  std::thread thread_;
};

struct Way {
  const char* name;
  Gate gate;
  int threads;
  friend void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }
};
class LiveEngineInTheGate : public testing::TestWithParam<Way> {};

TEST_P(LiveEngineInTheGate, EveryShippedPatchInAStormOfMessagesTargetsAndBanks) {
  auto banks = shipped_banks();
  ASSERT_GT(banks.size(), 40u);
  const auto live = LiveEngine::create(
      {.engine = {.max_voices = 24, .threads = GetParam().threads}}, std::move(banks.back()));
  ASSERT_TRUE(live) << live.error().to_string();
  banks.pop_back();
  (*live)->set_tap(true);
  Storm storm(**live);
  const auto play = [&](const Control& control) {
    for (int i = 0; i < kMostBlocks && !control.is_done(); ++i) storm.block();
  };
  Control warm_up(**live, std::move(banks));
  std::unique_ptr<Control> control;
  const GateReport report = run_in_gate(
      GetParam().gate, [&] { play(*control); },
      [&] {
        play(warm_up);
        control = std::make_unique<Control>(**live, shipped_banks());
      });
  const bool done = control->is_done();
  for (int i = 0; i < kMostBlocks && !control->is_done(); ++i) storm.block();
  control.reset();
  EXPECT_EQ(report.findings(), "");
  EXPECT_TRUE(done);
  EXPECT_GT(storm.loudest(), 1e-3F);
  EXPECT_GT((*live)->status().counters.voices_stolen, 0);
  EXPECT_EQ((*live)->status().journal_dropped, 0);
}

INSTANTIATE_TEST_SUITE_P(All, LiveEngineInTheGate,
                         testing::Values(Way{"sanitizer", Gate::sanitizer, 1},
                                         Way{"system", Gate::system, 1},
                                         Way{"sanitizer_two_threads", Gate::sanitizer, 2},
                                         Way{"system_two_threads", Gate::parallel, 2}),
                         [](const auto& way) { return std::string(way.param.name); });

}  // namespace
}  // namespace knotwave::rt

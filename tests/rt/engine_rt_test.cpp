// SPDX-License-Identifier: MIT
// The engine inside the gate: every kind of message, every shipped patch of the General MIDI bank,
// more notes than voices, and a bank installed while notes sound.
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/engine.h"

#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

constexpr int kBlock = 64;
constexpr int kBlocks = 1500;  // two seconds at 48 kHz

std::unique_ptr<const engine::BankProgram> load(const std::string& name) {
  const auto spec = engine::read_bank(std::string(KNOTWAVE_SOURCE_DIR) + "/examples/" + name);
  EXPECT_TRUE(spec) << spec.error().to_string();
  if (!spec) return nullptr;
  auto bank = engine::BankProgram::create(*spec);
  EXPECT_TRUE(bank) << bank.error().to_string();
  return bank ? std::move(*bank) : nullptr;
}

/// A storm: about one message of any kind in each block, notes most of all.
std::vector<engine::Event> storm(std::int64_t first, int blocks, const engine::BankProgram* other) {
  const base::RandomStream random{support::test_seed(), 0, 2000};
  constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x90, 0x80, 0xA0, 0xB0, 0xD0, 0xE0};
  std::vector<engine::Event> events;
  for (int i = 0; i < 2 * blocks; ++i) {
    const std::uint64_t bits = random.bits(static_cast<std::uint64_t>(i));
    engine::Event event;
    event.midi.time.sample = first + std::int64_t{i} * kBlock / 2;
    event.midi.bytes[0] = static_cast<std::uint8_t>(kStatus[bits & 7] | (bits >> 3 & 15));
    event.midi.bytes[1] = static_cast<std::uint8_t>(bits >> 8 & 127);
    event.midi.bytes[2] = static_cast<std::uint8_t>(bits >> 16 & 127);
    if (i % 50 == 49) event.midi.bytes[0] = static_cast<std::uint8_t>(0xC0 | (bits >> 3 & 15));
    if (i % 400 == 399) event.kind = engine::Event::Kind::tempo;
    if (i % 700 == 699) {
      event.kind = engine::Event::Kind::install_bank;
      event.bank = other;
    }
    events.push_back(event);
  }
  return events;
}

/// Plays `blocks` blocks from engine.now() on and keeps the loudest sample.
struct Player {
  engine::Engine& engine;
  std::span<const engine::Event> events;
  std::array<float, kBlock> left{};
  std::array<float, kBlock> right{};
  float loudest = 0;

  void play(int blocks) {
    for (int i = 0; i < blocks; ++i) {
      const std::int64_t end = engine.now() + kBlock;
      std::size_t count = 0;
      while (count < events.size() && events[count].time().sample < end) ++count;
      engine.process(events.first(count), left, right);
      events = events.subspan(count);
      for (const float sample : left) loudest = std::max(loudest, sample < 0 ? -sample : sample);
    }
  }
};

class EngineInTheGate : public testing::TestWithParam<Gate> {};

TEST_P(EngineInTheGate, AStormOfMessagesOverTheGeneralMidiBank) {
  const auto bank = load("banks/general-midi.toml");
  const auto other = load("banks/first-light.toml");
  ASSERT_NE(bank, nullptr);
  ASSERT_NE(other, nullptr);
  engine::EngineConfig config;
  config.max_voices = 24;
  const auto engine = engine::Engine::create(config, bank.get());
  ASSERT_TRUE(engine) << engine.error().to_string();
  const auto events = storm(0, 2 * kBlocks, other.get());
  Player player{**engine, events};
  const GateReport report = run_in_gate(
      GetParam(), [&] { player.play(kBlocks); }, [&] { player.play(kBlocks); });
  EXPECT_EQ(report.findings(), "");
  EXPECT_GT(player.loudest, 1e-3f);
  EXPECT_GT((*engine)->counters().voices_stolen, 0);
}

INSTANTIATE_TEST_SUITE_P(Both, EngineInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt

// SPDX-License-Identifier: MIT
// Envelope players inside the gate: every shipped envelope patch under a storm of messages, with
// prediction after every block.
#include <filesystem>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/envelope_player.h"

#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

struct Patch {
  std::unique_ptr<const engine::EnvelopePatchProgram> program;
  std::unique_ptr<engine::EnvelopePlayer> player;
};

std::vector<Patch> shipped() {
  std::vector<Patch> all;
  for (const auto& entry :
       std::filesystem::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/envelopes")) {
    const auto spec = engine::read_envelope_patch(entry.path().string());
    EXPECT_TRUE(spec) << spec.error().to_string();
    if (!spec) continue;
    Patch patch;
    auto program = engine::EnvelopePatchProgram::create(*spec);
    EXPECT_TRUE(program) << program.error().to_string();
    patch.program = std::move(*program);
    patch.player = std::move(engine::EnvelopePlayer::create({}, patch.program.get())).value();
    all.push_back(std::move(patch));
  }
  return all;
}

/// Notes most of all, controllers, program changes, songs that start and stop, tempo.
engine::Event storm(const base::RandomStream& random, std::uint64_t i, std::int64_t sample) {
  constexpr std::uint8_t kStatus[] = {0x90, 0x90, 0x90, 0x80, 0xA0, 0xB0, 0xD0, 0xE0};
  const std::uint64_t bits = random.bits(i);
  engine::Event event;
  event.midi.time = {sample, static_cast<std::uint32_t>(bits >> 32)};
  event.midi.bytes[0] = static_cast<std::uint8_t>(kStatus[bits & 7] | (bits >> 3 & 15));
  event.midi.bytes[1] = static_cast<std::uint8_t>(bits >> 8 & 127);
  event.midi.bytes[2] = static_cast<std::uint8_t>(bits >> 16 & 127);
  if (i % 40 == 39) event.midi.bytes[0] = static_cast<std::uint8_t>(0xF8 | (bits & 7));
  if (i % 90 == 89) event.kind = engine::Event::Kind::tempo;
  if (i % 170 == 169) event.kind = engine::Event::Kind::all_notes_off;
  return event;
}

void play(std::vector<Patch>& patches, const base::RandomStream& random, std::uint64_t first,
          std::uint64_t count) {
  for (Patch& patch : patches) {
    engine::EnvelopePlayer& player = *patch.player;
    for (std::uint64_t i = first; i < first + count; ++i) {
      player.handle(storm(random, i, player.now()));
      player.take_messages();
      player.render(64);
      player.predict(100);
      player.take_messages();
    }
    player.release_all();
    player.take_messages();
  }
}

class EnvelopesInTheGate : public testing::TestWithParam<Gate> {};

TEST_P(EnvelopesInTheGate, AStormOfMessagesOverTheShippedPatches) {
  std::vector<Patch> patches = shipped();
  ASSERT_GE(patches.size(), 6u);
  const base::RandomStream random{support::test_seed(), 3, 2200};
  const GateReport report = run_in_gate(
      GetParam(), [&] { play(patches, random, 200, 1500); },
      [&] { play(patches, random, 0, 200); });
  EXPECT_EQ(report.findings(), "");
  bool has_begun = false;
  for (const Patch& patch : patches) has_begun |= patch.player->newest_voice() >= 0;
  EXPECT_TRUE(has_begun);
}

INSTANTIATE_TEST_SUITE_P(Both, EnvelopesInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt

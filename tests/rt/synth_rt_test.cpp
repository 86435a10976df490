// SPDX-License-Identifier: MIT
// What the synth does with MIDI before the engine has it, inside the gate.
#include <array>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "midi_entry.h"
#include "rt_gate.h"

namespace knotwave::rt {
namespace {

base::MidiEvent message(std::uint64_t bits) {
  constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x80, 0xB0, 0xB0, 0xE0, 0xF8, 0xFA, 0xF2};
  base::MidiEvent event;
  event.bytes[0] = kStatus[bits % kStatus.size()];
  event.bytes[1] = static_cast<std::uint8_t>(bits >> 8 & 127);
  event.bytes[2] = static_cast<std::uint8_t>(bits >> 16 & 127);
  event.port = static_cast<std::uint8_t>(bits >> 24 & 15);
  return event;
}

TEST(SynthRt, MessagesOfCablesAndOfTheStreamPassWithoutAllocationAndSystemCalls) {
  synth::EngineGate to_engine;
  synth::MidiEntry entry(to_engine);
  auto learn = engine::MidiLearn::create({"", {{.from = 21, .to = 74}}});
  ASSERT_TRUE(learn.has_value());
  entry.use(*std::move(learn));
  const base::RandomStream random{1, 2, 3};
  std::array<base::MidiEvent, 64> block;
  std::size_t kept = 0;
  const auto work = [&] {
    for (std::uint64_t i = 0; i < 500; ++i) {
      for (std::uint64_t k = 0; k < block.size(); ++k) {
        block[k] = message(random.bits(i * block.size() + k));
        block[k].time.sample = static_cast<std::int64_t>(k);
        entry.heard(block[k], static_cast<std::int64_t>(i) * 1000000);
      }
      kept += entry.translated(block, static_cast<std::int64_t>(i) * 1000000, 48000).size();
      entry.lost(static_cast<int>(i % 16));
      if (i % 3 == 0) entry.stream_sender_left();
      if (i % 7 == 0) entry.forget();
    }
  };
  for (const Gate gate : {Gate::sanitizer, Gate::system}) {
    const GateReport report = run_in_gate(gate, work, work);
    EXPECT_EQ(report.findings(), "");
  }
  EXPECT_GT(kept, 10000u);
}

}  // namespace
}  // namespace knotwave::rt

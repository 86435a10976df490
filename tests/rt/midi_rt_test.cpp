// SPDX-License-Identifier: MIT
// What a MIDI message goes through on its way to the engine, inside the gate.
#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/midi_clock.h"
#include "knotwave/engine/midi_learn.h"
#include "knotwave/io/midi_stream.h"

#include "rt_gate.h"

namespace knotwave::rt {
namespace {

class MidiInTheGate : public testing::TestWithParam<Gate> {};

TEST_P(MidiInTheGate, StreamClockAndLearntKnobs) {
  io::MidiStream stream(1000);
  engine::MidiClock clock;
  clock.reset(48000);
  auto learn = engine::MidiLearn::create({"", {{.from = 21, .to = 74}, {.from = 3, .to = 16}}});
  ASSERT_TRUE(learn.has_value());
  int messages = 0, tempos = 0, changes = 0;
  const auto work = [&] {
    const base::RandomStream random{1, 2, 3};
    for (std::uint64_t i = 0; i < 20000; ++i) {
      const std::uint64_t bits = random.bits(i);
      if (!stream.feed(i % 8 == 0 ? std::uint8_t{0xF8} : static_cast<std::uint8_t>(bits))) continue;
      base::MidiEvent event = stream.message();
      event.time = {static_cast<std::int64_t>(i * 125), 0};
      ++messages;
      tempos += static_cast<int>(clock.handle(event).tempo);
      changes += learn->translate(event).count;
      if (bits % 64 == 0) learn->learn(70 + static_cast<int>(bits >> 8) % 10);
      if (bits % 97 == 0) learn->controllers_went_back();
    }
    tempos += static_cast<int>(clock.quarters_at({1000, 0}) > 1e9);
  };
  work();
  const GateReport report = run_in_gate(GetParam(), work);
  EXPECT_EQ(report.findings(), "");
  EXPECT_GT(messages, 5000);
  EXPECT_GT(tempos, 0);
  EXPECT_GT(changes, 1000);
}

INSTANTIATE_TEST_SUITE_P(Both, MidiInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt

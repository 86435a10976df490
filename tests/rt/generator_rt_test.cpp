// SPDX-License-Identifier: MIT
// The envelope generator and its voltages inside the gate: a storm of every kind of message over
// patches that use every kind of output, then the way to rest.
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/envelope_generator.h"
#include "knotwave/engine/voltage_output.h"

#include "rt_gate.h"
#include "support/seed.h"

namespace knotwave::rt {
namespace {

constexpr int kBlock = 64;
constexpr int kBlocks = 1500;  // two seconds at 48 kHz

constexpr const char* kMpe = R"(format = 1
kind = "envelope"
mode = "poly"
polyphony = 6
notes = "mpe"
[ports.synth]
wire = "din"
[curves.bump]
degree = 2
points = [0, 1.6, 0]
[envelopes.bump]
curve = "bump"
seconds = 0.2
[[outputs]]
from = "bump"
to = "pressure"
channel = "note"
[[outputs]]
from = "bump"
to = "cc11"
bits = 14
channel = "note"
[[outputs]]
from = "bump"
to = "nrpn300"
channel = 16
[[outputs]]
from = "bump"
to = "osc"
address = "/bump"
)";
constexpr const char* kClocked = R"(format = 1
kind = "envelope"
[trigger]
from = "clock"
beats = 0.25
[ports.drums]
wire = "usb"
[curves.drop]
degree = 1
points = [1, 0]
[envelopes.drop]
curve = "drop"
seconds = 0.1
[[outputs]]
from = "drop"
to = "bend"
range = [-8192, 8191]
[[events]]
envelope = "drop"
at = "end"
note = 37
channel = 10
)";

std::unique_ptr<const engine::EnvelopePatchProgram> compile(const char* text) {
  const auto spec = engine::parse_envelope_patch(text, "test.toml");
  EXPECT_TRUE(spec) << spec.error().to_string();
  if (!spec) return nullptr;
  auto program = engine::EnvelopePatchProgram::create(*spec);
  EXPECT_TRUE(program) << program.error().to_string();
  return program ? std::move(*program) : nullptr;
}

struct Counted final : engine::GeneratorSink {
  void midi(int, const base::MidiEvent&) KNOTWAVE_RT override { ++messages; }
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override { ++numbers; }
  int messages = 0, numbers = 0;
};

struct Storm {
  engine::EnvelopeGenerator& generator;
  engine::VoltageOutput& voltage;
  Counted sink;
  base::RandomStream random{support::test_seed(), 0, 2001};
  std::array<double, kBlock> volts{};
  std::array<float, kBlock> samples{};

  void play(int blocks) {
    constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x80, 0xF8,
                                                     0xA0, 0xB0, 0xD0, 0xE0};
    for (int i = 0; i < blocks; ++i) {
      const std::int64_t now = generator.now();
      const std::uint64_t bits = random.bits(static_cast<std::uint64_t>(now));
      base::MidiEvent event;
      event.time.sample = now + static_cast<std::int64_t>(bits >> 32 & 63);
      event.bytes[0] = kStatus[bits & 7];
      if (event.bytes[0] < 0xF0) event.bytes[0] |= static_cast<std::uint8_t>(bits >> 3 & 15);
      event.bytes[1] = static_cast<std::uint8_t>(bits >> 8 & 127);
      event.bytes[2] = static_cast<std::uint8_t>(bits >> 16 & 127);
      generator.handle(event);
      if (i % 500 == 0) generator.say_again(i / 500 % 2);
      generator.advance(now + kBlock, sink);
      volts.fill(static_cast<double>(bits >> 40) * 1e-6);
      voltage.render(now, volts, samples);
    }
  }
};

class GeneratorInTheGate : public testing::TestWithParam<Gate> {};

TEST_P(GeneratorInTheGate, AStormOfMessagesAndTheWayToRest) {
  const auto mpe = compile(kMpe), clocked = compile(kClocked);
  ASSERT_NE(mpe, nullptr);
  ASSERT_NE(clocked, nullptr);
  engine::EnvelopeGeneratorConfig config;
  config.thru = true;
  const engine::EnvelopePatchProgram* patches[] = {mpe.get(), clocked.get()};
  const auto generator = engine::EnvelopeGenerator::create(config, patches);
  ASSERT_TRUE(generator) << generator.error().to_string();
  auto voltage = engine::VoltageOutput::create({}, 1);
  ASSERT_TRUE(voltage) << voltage.error().to_string();
  Storm storm{**generator, *voltage, {}};
  const GateReport report = run_in_gate(
      GetParam(), [&] { storm.play(kBlocks); },
      [&] {
        storm.play(kBlocks);
        (*generator)->go_to_rest();
        storm.play(kBlocks);
      });
  EXPECT_EQ(report.findings(), "");
  EXPECT_GT(storm.sink.messages, 1000);
  EXPECT_GT(storm.sink.numbers, 100);
  EXPECT_TRUE((*generator)->is_at_rest());
}

INSTANTIATE_TEST_SUITE_P(Both, GeneratorInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt

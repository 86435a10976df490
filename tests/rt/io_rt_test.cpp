// SPDX-License-Identifier: MIT
// What io does on the audio thread, between a device and the client, inside the gate.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "block_pump.h"
#include "complete_midi.h"
#include "cycle_clock.h"
#include "rt_gate.h"

namespace knotwave::rt {
namespace {

class CountingClient : public io::AudioClient {
 public:
  void process(const io::AudioBlock& block) KNOTWAVE_RT override {
    for (float* output : block.outputs) std::fill_n(output, block.frames, 0.5F);
    messages += static_cast<int>(block.midi.size());
  }
  int messages = 0;
};

TEST(AudioDeviceRt, ABlockOnItsWayToTheClientAllocatesAndAsksTheSystemNothing) {
  CountingClient client;
  io::BlockPump pump(client, 48000, 2);
  io::CycleClock clock;
  std::vector<float> left(20000), right(20000);
  float* const outputs[] = {left.data(), right.data()};
  std::array<base::MidiEvent, 64> events;
  const std::uint8_t note[] = {0x90, 60, 100}, broken[] = {0x90, 60};
  const auto blocks = [&](int count) {
    for (int i = 0; i < count; ++i) {
      const int frames = i % 10 == 0 ? 20000 : 64;
      clock.advance({static_cast<std::uint32_t>(i * 64), 10, 64}, io::steady_clock_ns());
      std::size_t kept = 0;
      for (std::size_t k = 0; k < events.size(); ++k) {
        if (io::read_complete_midi(k % 2 == 0 ? std::span<const std::uint8_t>(note)
                                              : std::span<const std::uint8_t>(broken),
                                   events[kept])) {
          events[kept++].time.sample = static_cast<std::int64_t>(k);
        }
      }
      pump.run({.frame = clock.frame(),
                .time_ns = clock.time_ns(),
                .outputs = outputs,
                .frames = frames,
                .midi = std::span(events).first(kept),
                .has_deadline = i % 3 != 0});
    }
  };
  pump.open();
  for (const Gate gate : {Gate::sanitizer, Gate::system}) {
    const GateReport report = run_in_gate(
        gate, [&] { blocks(1000); }, [&] { blocks(20); });
    EXPECT_EQ(report.findings(), "");
  }
  EXPECT_EQ(client.messages, 2 * 1020 * 32);
  EXPECT_EQ(pump.blocks(), 2 * 1020);
}

}  // namespace
}  // namespace knotwave::rt

// SPDX-License-Identifier: MIT
// Control voltage as the audio callback of knotwave-env plays it, inside the gate.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "cv_player.h"
#include "rt_gate.h"

namespace knotwave::rt {
namespace {

base::MidiEvent message(std::uint64_t bits) {
  constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x80, 0xB0, 0xE0, 0xD0, 0xFA, 0xFC};
  base::MidiEvent event;
  event.bytes[0] = kStatus[bits % kStatus.size()];
  event.bytes[1] = static_cast<std::uint8_t>(bits >> 8 & 127);
  event.bytes[2] = static_cast<std::uint8_t>(bits >> 16 & 127);
  return event;
}

TEST(EnvRt, VoltagesArePlayedWithoutAllocationAndSystemCalls) {
  const auto spec = engine::read_envelope_patch(std::string(KNOTWAVE_SOURCE_DIR) +
                                                "/examples/envelopes/four-voltages.toml");
  ASSERT_TRUE(spec) << spec.error().to_string();
  const auto program = engine::EnvelopePatchProgram::create(*spec);
  ASSERT_TRUE(program) << program.error().to_string();
  engine::VoltageConfig voltage;
  voltage.direct_current = true;
  auto player = env::CvPlayer::create(voltage, 1, {program->get()});
  ASSERT_TRUE(player) << player.error().to_string();
  ASSERT_EQ(player->channels(), 5u);
  std::array<std::array<float, env::CvPlayer::kMostSamples>, 5> channels{};
  std::array<float*, 5> out{};
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = channels[c].data();
  const base::RandomStream random{1, 2, 3};
  float most = 0;
  const auto work = [&] {
    for (std::uint64_t i = 0; i < 2000; ++i) {
      engine::Event event;
      event.midi = message(random.bits(i));
      event.midi.time.sample = player->now();
      player->handle(event);
      player->render(1 + i % env::CvPlayer::kMostSamples, out);
      most = std::max(most, channels[0][0]);
    }
  };
  const auto end = [&] {
    work();
    player->ramp_out();
    work();
  };
  for (const Gate gate : {Gate::sanitizer, Gate::system}) {
    const GateReport report = run_in_gate(gate, work, end);
    EXPECT_EQ(report.findings(), "");
  }
  EXPECT_GT(most, 0.01F);
}

}  // namespace
}  // namespace knotwave::rt

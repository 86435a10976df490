// SPDX-License-Identifier: MIT
// Bends before controllers, but not for ever.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/engine/output_port.h"

#include "output_port_cases.h"

namespace knotwave::engine {
namespace {

using test::Motion;
using test::play;
using test::Sent;
using test::Wire;

constexpr double kRate = 48000;

OutputPortConfig config_of(PortSpec::Wire wire) {
  OutputPortConfig config;
  config.wire = wire;
  return config;
}

LaneSpec control(int number) {
  LaneSpec lane;
  lane.number = number;
  return lane;
}

/// A bend that runs faster than the cable, for ever.
double fast_bend(double t, double) { return 8192 + 4000 * std::sin(2 * 3.14159265358979 * 5 * t); }

LaneSpec bend() {
  LaneSpec lane;
  lane.kind = OutputKind::pitch_bend;
  lane.first_step = 8192;
  return lane;
}

TEST(OutputTurns, ABendThatFillsTheCableLeavesRoomForAController) {
  for (const auto wire_kind : {PortSpec::Wire::din, PortSpec::Wire::usb}) {
    const OutputPortConfig config = config_of(wire_kind);
    auto port = *OutputPort::create(config);
    const bool is_din = wire_kind == PortSpec::Wire::din;
    const int bends = is_din ? 1 : 16;
    std::vector<Motion> motions;
    for (int i = 0; i < bends; ++i) {
      LaneSpec lane = bend();
      lane.channel = i + 1;
      ASSERT_TRUE(port->add_lane(lane));
      motions.emplace_back(fast_bend);
    }
    ASSERT_TRUE(port->add_lane(control(74)));
    motions.emplace_back([](double t, double) { return std::clamp((t - 0.1) * 254, 0.0, 127.0); });
    Wire wire(config);
    play(*port, wire, motions, 0, 48000, kRate);
    std::vector<double> times;
    for (const Sent& sent : wire.sent) {
      if (sent.event.bytes[0] == 0xB0) times.push_back(sent.begin_s);
    }
    ASSERT_GE(times.size(), 40u);
    // 10 ms of patience, up to 4 ms until the value is at another step, a bend and itself.
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_LT(times[i] - times[i - 1], 0.016);
    EXPECT_EQ(port->last_step(bends), 127);
    EXPECT_LT(times.back(), 0.612);
    EXPECT_GT(wire.sent.size() - times.size(), 10 * times.size()) << "bends go first otherwise";
  }
}

/// A value of 14 bits that begins to fall at sample 4800 while a note is on the cable; when its
/// first message has come.
double first_arrival(OutputKind kind, double steps_per_sample, std::int64_t note_at) {
  OutputPortConfig config = config_of(PortSpec::Wire::din);
  config.running_status = false;
  auto port = *OutputPort::create(config);
  LaneSpec lane = control(28);
  lane.kind = kind;
  lane.bits = 14;
  EXPECT_TRUE(port->add_lane(lane));
  Wire wire(config);
  const Motion motion = [steps_per_sample](double t, double) {
    return std::max(0.0, 16256 - steps_per_sample * std::max(t * kRate - 4800, 0.0));
  };
  base::MidiEvent note;
  note.time.sample = note_at;
  note.bytes[0] = 0x90;
  note.bytes[1] = note.bytes[2] = 64;
  EXPECT_TRUE(port->post(note, OutputPriority::note, true));
  play(*port, wire, {motion}, 0, 12000, kRate, {note_at});
  EXPECT_EQ(port->last_step(0), 0);
  const auto first = std::find_if(wire.sent.begin(), wire.sent.end(), [](const Sent& sent) {
    return sent.event.bytes[0] == 0xB0 && sent.begin_s > 0.09;
  });
  return first == wire.sent.end() ? 0 : first->arrival_s * kRate;
}

// Two halves were due, the cable was busy, and the upper half alone says it: there is time for it.
TEST(OutputTurns, AnUpperHalfThatWouldComeTooEarlyWaitsUntilItsValueIsThere) {
  for (const OutputKind kind : {OutputKind::control, OutputKind::nrpn}) {
    for (const double steps_per_sample : {3, 4, 8}) {
      for (std::int64_t note_at = 4640; note_at < 4760; ++note_at) {
        EXPECT_GE(first_arrival(kind, steps_per_sample, note_at), 4800)
            << note_at << " " << steps_per_sample;
      }
    }
  }
}

TEST(OutputTurns, OfTwoMessagesOneIsABendsHoweverManyControllersWait) {
  const OutputPortConfig config = config_of(PortSpec::Wire::din);
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(bend()));
  std::vector<Motion> motions = {fast_bend};
  for (int number = 64; number < 88; ++number) {
    ASSERT_TRUE(port->add_lane(control(number)));
    motions.emplace_back([](double t, double) { return 63.5 + 60 * std::sin(20 * t); });
  }
  Wire wire(config);
  play(*port, wire, motions, 0, 48000, kRate);
  std::map<int, int> count;
  for (const Sent& sent : wire.sent) {
    ++count[sent.event.bytes[0] == 0xE0 ? -1 : int{sent.event.bytes[1]}];
  }
  ASSERT_EQ(count.size(), 25u) << "every controller is sent";
  EXPECT_GE(2 * count[-1] + 24, static_cast<int>(wire.sent.size()));
  for (const auto& [number, messages] : count) EXPECT_GE(messages, 15) << number;
}

TEST(OutputTurns, APedalThatPassesThroughIsNotKeptByABend) {
  const OutputPortConfig config = config_of(PortSpec::Wire::din);
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(bend()));
  Wire wire(config);
  base::MidiEvent down;
  down.time.sample = 960;
  down.bytes[0] = 0xB0;
  down.bytes[1] = 64;
  down.bytes[2] = 127;
  ASSERT_TRUE(port->post(down, OutputPriority::control, true));
  play(*port, wire, {fast_bend}, 0, 9600, kRate, {960});
  const auto pedal = std::find_if(wire.sent.begin(), wire.sent.end(),
                                  [](const Sent& sent) { return sent.event.bytes[0] == 0xB0; });
  ASSERT_NE(pedal, wire.sent.end());
  EXPECT_LT(pedal->begin_s, 0.02 + 0.012);
}

}  // namespace
}  // namespace knotwave::engine

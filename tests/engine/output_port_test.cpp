// SPDX-License-Identifier: MIT
#include "knotwave/engine/output_port.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "output_port_cases.h"

namespace knotwave::engine {
namespace {

using base::MidiEvent;
using test::Motion;
using test::play;
using test::Sent;
using test::Wire;

constexpr double kRate = 48000;

OutputPortConfig config_of(PortSpec::Wire wire, bool running_status = true) {
  OutputPortConfig config;
  config.wire = wire;
  config.running_status = running_status;
  return config;
}
OutputPortConfig din(bool running_status = true) {
  return config_of(PortSpec::Wire::din, running_status);
}

LaneSpec control(int number, int bits = 7) {
  LaneSpec lane;
  lane.number = number;
  lane.bits = bits;
  return lane;
}

MidiEvent message(std::int64_t sample, int status, int data_1, int data_2) {
  MidiEvent event;
  event.time.sample = sample;
  event.bytes[0] = static_cast<std::uint8_t>(status);
  event.bytes[1] = static_cast<std::uint8_t>(data_1);
  event.bytes[2] = static_cast<std::uint8_t>(data_2);
  return event;
}

using Bytes = std::array<int, 3>;
std::vector<Bytes> bytes_of(const Wire& wire) {
  std::vector<Bytes> all;
  for (const Sent& sent : wire.sent) {
    all.push_back({sent.event.bytes[0], sent.event.bytes[1], sent.event.bytes[2]});
  }
  return all;
}

/// Value `values[i]` from i * 10 ms on.
Motion stairs(std::vector<double> values) {
  return [values](double t, double) {
    const auto i = static_cast<std::size_t>(std::floor(t * 100 + 1e-9));
    return values[std::min(i, values.size() - 1)];
  };
}

TEST(OutputPort, TheLastByteComesWhenTheValueCrosses) {
  for (const bool running : {false, true}) {
    const OutputPortConfig config = din(running);
    auto port = *OutputPort::create(config);
    ASSERT_TRUE(port->add_lane(control(74)));
    Wire wire(config);
    const Motion ramp = [](double t, double) { return std::clamp((t - 0.1) * 127, 0.0, 127.0); };
    play(*port, wire, {ramp}, 0, 60000, kRate);
    ASSERT_EQ(wire.sent.size(), 127u);
    for (std::size_t i = 0; i < wire.sent.size(); ++i) {
      EXPECT_EQ(wire.sent[i].event.bytes[2], i + 1);
      EXPECT_NEAR(wire.sent[i].arrival_s, 0.1 + (static_cast<double>(i) + 0.5) / 127, 1e-8);
    }
    EXPECT_EQ(port->counters().bytes, running ? 3 + 126 * 2 : 127 * 3);
    EXPECT_EQ(port->lane_bytes(0), port->counters().bytes);
  }
}

TEST(OutputPort, OfFourteenBitsTheLowerHalfGoesAloneWhereOnlyItChanges) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(1, 14)));
  Wire wire(config);
  play(*port, wire, {stairs({0, 5, 133, 128, 256, 384, 387})}, 0, 4800, kRate);
  const std::vector<Bytes> expected = {
      {0xB0, 1, 0},  {0xB0, 33, 5},  // 5: nothing was sent before
      {0xB0, 1, 1},  {0xB0, 33, 5},  // 133: an upper half resets the lower
      {0xB0, 33, 0},                 // 128
      {0xB0, 1, 2},                  // 256: the lower half was 0 and stays so
      {0xB0, 1, 3},                  // 384
      {0xB0, 33, 3}};                // 387
  EXPECT_EQ(bytes_of(wire), expected);
}

TEST(OutputPort, AnUpperHalfOfSomebodyElseIsSaidAgain) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(1, 14)));
  Wire wire(config);
  const Motion motion = stairs({133, 134, 134});
  play(*port, wire, {motion}, 0, 700, kRate);
  ASSERT_TRUE(port->post(message(700, 0xB0, 1, 90), OutputPriority::note, true));
  play(*port, wire, {motion}, 700, 1400, kRate);
  const std::vector<Bytes> expected = {{0xB0, 1, 1}, {0xB0, 33, 5}, {0xB0, 33, 6}, {0xB0, 1, 90}};
  EXPECT_EQ(bytes_of(wire), expected);
  play(*port, wire, {stairs({135})}, 1400, 2000, kRate);
  const std::vector<Bytes> after = {{0xB0, 1, 1}, {0xB0, 33, 7}};
  const std::vector<Bytes> all = bytes_of(wire);
  EXPECT_EQ(std::vector<Bytes>(all.begin() + 4, all.end()), after);
}

TEST(OutputPort, AnNrpnIsSelectedOnceAndLetGoAfterHalfASecond) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  LaneSpec lane = control(1000);
  lane.kind = OutputKind::nrpn;
  lane.channel = 3;
  ASSERT_TRUE(port->add_lane(lane));
  Wire wire(config);
  play(*port, wire, {stairs({0, 7, 8, 9})}, 0, 48000, kRate);
  const std::vector<Bytes> expected = {{0xB2, 99, 7},   {0xB2, 98, 104}, {0xB2, 6, 7},
                                       {0xB2, 6, 8},    {0xB2, 6, 9},    {0xB2, 101, 127},
                                       {0xB2, 100, 127}};
  EXPECT_EQ(bytes_of(wire), expected);
  EXPECT_EQ(wire.sent[0].bytes, 3);
  EXPECT_NEAR(wire.sent[2].arrival_s, 0.01, 25e-6) << "7 bytes came before the value changed";
  EXPECT_NEAR(wire.sent[5].begin_s - wire.sent[4].begin_s, 0.5, 1e-6);
}

TEST(OutputPort, AParameterSelectedBySomebodyElseIsSelectedAgain) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  LaneSpec lane = control(2);
  lane.kind = OutputKind::nrpn;
  ASSERT_TRUE(port->add_lane(lane));
  Wire wire(config);
  play(*port, wire, {stairs({1})}, 0, 960, kRate);
  ASSERT_TRUE(port->post(message(960, 0xB0, 101, 0), OutputPriority::control, true));
  play(*port, wire, {stairs({1})}, 960, 1920, kRate);
  play(*port, wire, {stairs({2})}, 1920, 2880, kRate);
  const std::vector<Bytes> expected = {{0xB0, 99, 0}, {0xB0, 98, 2}, {0xB0, 6, 1}, {0xB0, 101, 0},
                                       {0xB0, 99, 0}, {0xB0, 98, 2}, {0xB0, 6, 2}};
  EXPECT_EQ(bytes_of(wire), expected);
}

TEST(OutputPort, BendAndPressuresAreOneMessageEach) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  LaneSpec bend, pressure, key_pressure;
  bend.kind = OutputKind::pitch_bend;
  bend.first_step = 8192;
  pressure.kind = OutputKind::channel_pressure;
  key_pressure.kind = OutputKind::poly_pressure;
  key_pressure.key = 61;
  key_pressure.channel = 16;
  for (const LaneSpec& lane : {bend, pressure, key_pressure}) ASSERT_TRUE(port->add_lane(lane));
  Wire wire(config);
  play(*port, wire, {stairs({8192, 16383}), stairs({0, 0, 90}), stairs({0, 0, 0, 33})}, 0, 4800,
       kRate);
  const std::vector<Bytes> expected = {{0xE0, 127, 127}, {0xD0, 90, 0}, {0xAF, 61, 33}};
  EXPECT_EQ(bytes_of(wire), expected);
  EXPECT_EQ(port->counters().bytes, 8);
}

TEST(OutputPort, ClockGoesBeforeNotesBeforeBendBeforeControllers) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  LaneSpec bend;
  bend.kind = OutputKind::pitch_bend;
  ASSERT_TRUE(port->add_lane(control(74)));
  ASSERT_TRUE(port->add_lane(bend));
  Wire wire(config);
  // A long message holds the cable while the rest comes.
  const std::uint8_t data[30] = {};
  MidiEvent sysex = message(0, 0xF0, 0, 0);
  sysex.sysex = data;
  sysex.sysex_size = sizeof(data);
  ASSERT_TRUE(port->post(sysex, OutputPriority::note, true));
  play(*port, wire, {stairs({0}), stairs({0})}, 0, 64, kRate);
  ASSERT_TRUE(port->post(message(100, 0x90, 60, 100), OutputPriority::note, true));
  ASSERT_TRUE(port->post(message(200, 0xF8, 0, 0), OutputPriority::clock, true));
  play(*port, wire, {stairs({9}), stairs({99})}, 64, 4800, kRate);
  const std::vector<Bytes> expected = {
      {0xF0, 0, 0}, {0xF8, 0, 0}, {0x90, 60, 100}, {0xE0, 99, 0}, {0xB0, 74, 9}};
  EXPECT_EQ(bytes_of(wire), expected);
  EXPECT_EQ(wire.sent[1].event.time.sample, 491) << "32 bytes of 15.36 samples";
}

TEST(OutputPort, WhatIsPassedThroughKeepsItsOrderItsBytesAndItsTime) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  Wire wire(config);
  std::vector<MidiEvent> posted;
  for (int i = 0; i < 100; ++i) {
    MidiEvent event = message(i * 64,
                              i % 3 == 0   ? 0xC2
                              : i % 3 == 1 ? 0xB2
                                           : 0x92,
                              i, i % 3 == 0 ? 0 : 99 - i);
    event.time.fraction = 12345u + static_cast<std::uint32_t>(i);
    posted.push_back(event);
    const auto priority = i % 3 == 2 ? OutputPriority::note : OutputPriority::control;
    ASSERT_TRUE(port->post(event, priority, true));
    play(*port, wire, {}, i * 64, i * 64 + 64, kRate);
  }
  ASSERT_EQ(wire.sent.size(), posted.size());
  for (std::size_t i = 0; i < posted.size(); ++i) {
    EXPECT_EQ(0, std::memcmp(wire.sent[i].event.bytes, posted[i].bytes, 3));
    EXPECT_EQ(wire.sent[i].event.time, posted[i].time) << "the cable was free";
  }
  EXPECT_EQ(port->counters().overload_bytes, 0);
  EXPECT_EQ(port->counters().thru_bytes, port->counters().bytes);
}

TEST(OutputPort, AFloodIsCountedAndNothingIsLostWhileThereIsRoom) {
  const OutputPortConfig config = din(false);
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(74)));
  Wire wire(config);
  for (std::size_t i = 0; i < OutputPort::kMostWaiting; ++i) {
    ASSERT_TRUE(
        port->post(message(0, 0x90, 60, static_cast<int>(i % 128)), OutputPriority::note, true));
  }
  EXPECT_FALSE(port->post(message(0, 0x90, 60, 1), OutputPriority::note, true));
  EXPECT_GT(port->counters().overload_bytes, 3000 - 70);
  play(*port, wire, {stairs({64})}, 0, 960, kRate);
  EXPECT_TRUE(port->is_waiting());
  play(*port, wire, {stairs({64})}, 960, 50000, kRate);
  EXPECT_FALSE(port->is_waiting());
  ASSERT_EQ(wire.sent.size(), OutputPort::kMostWaiting + 1);
  EXPECT_EQ(wire.sent.back().event.bytes[2], 64) << "the lane was sent when there was room";
  EXPECT_NEAR(port->counters().most_waiting_s, 1023 * 3 / kDinBytesPerSecond, 1e-4);
  EXPECT_GT(port->counters().use, 0.9);
}

TEST(OutputPort, ANoteThatAFullCableLeavesOutIsLeftOutWithItsEndAndNoOtherHangs) {
  const OutputPortConfig config = din(true);
  auto port = *OutputPort::create(config);
  Wire wire(config);
  std::mt19937_64 random(7);
  std::vector<std::pair<int, int>> held;
  std::int64_t refused = 0;
  const auto post = [&](std::int64_t sample, int status, int channel, int key) {
    MidiEvent event = message(sample, status | channel, key, 90);
    refused += port->post(event, OutputPriority::note, true) ? 0 : 1;
  };
  constexpr std::int64_t kFlood = 100000;
  for (std::int64_t sample = 0; sample < kFlood + 100000; sample += 10) {
    if (sample < kFlood && random() % 2 == 0) {
      held.emplace_back(random() % 16, random() % 128);
      post(sample, 0x90, held.back().first, held.back().second);
    } else if (!held.empty()) {
      const std::size_t which = random() % held.size();
      post(sample, 0x80, held[which].first, held[which].second);
      held.erase(held.begin() + static_cast<std::ptrdiff_t>(which));
    }
    play(*port, wire, {}, sample, sample + 10, kRate);
  }
  play(*port, wire, {}, kFlood + 100000, kFlood + 900000, kRate);
  ASSERT_TRUE(held.empty());
  ASSERT_FALSE(port->is_waiting());
  EXPECT_GT(refused, 1000);
  EXPECT_EQ(port->counters().lost, refused);
  std::map<std::pair<int, int>, int> open;
  std::int64_t on = 0, off = 0;
  for (const auto& sent : wire.sent) {
    const bool begins = sent.event.bytes[0] >> 4 == 9;
    (begins ? on : off) += 1;
    int& count = open[{sent.event.channel(), sent.event.bytes[1]}];
    count = begins ? count + 1 : 0;
  }
  for (const auto& [key, count] : open) EXPECT_EQ(count, 0) << key.first << ' ' << key.second;
  EXPECT_NEAR(static_cast<double>(on), static_cast<double>(off), 0.1 * static_cast<double>(on));
}

TEST(OutputPort, EndsOfNotesHaveAPlaceBehindAllNotesOffWhichNotEveryReceiverHears) {
  auto port = *OutputPort::create(din(true));
  const auto post = [&](int status, int one, int two) {
    return port->post(message(0, status, one, two), OutputPriority::note, true);
  };
  for (std::size_t i = 0; i < OutputPort::kMostWaiting; ++i) {
    ASSERT_TRUE(post(0x90, static_cast<int>(i % 128), 90));
  }
  EXPECT_FALSE(post(0x90, 5, 90));
  ASSERT_TRUE(post(0xB0, 123, 0));
  for (int key = 0; key < 128; ++key) EXPECT_TRUE(post(0x80, key, 64)) << key;
  EXPECT_EQ(port->counters().lost, 1);
}

TEST(OutputPort, UsbCarriesSixteenEventsInAnyMillisecondAndALaneOnceInAFrame) {
  const OutputPortConfig config = config_of(PortSpec::Wire::usb);
  auto port = *OutputPort::create(config);
  std::vector<Motion> motions;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(port->add_lane(control(64 + i)));
    motions.push_back([i](double t, double) { return 63.5 + 63.5 * std::sin(200 * t + i); });
  }
  Wire wire(config);
  play(*port, wire, motions, 0, 9600, kRate);
  ASSERT_GT(wire.sent.size(), 3000u);
  std::array<double, 128> last{};
  last.fill(-1);
  for (std::size_t i = 0; i < wire.sent.size(); ++i) {
    if (i >= 16) {
      EXPECT_GE(wire.sent[i].begin_s - wire.sent[i - 16].begin_s, 0.001 - 1e-12);
    }
    double& before = last[wire.sent[i].event.bytes[1]];
    EXPECT_GE(wire.sent[i].begin_s - before, 0.001 - 1e-12);
    before = wire.sent[i].begin_s;
  }
}

TEST(OutputPort, WithoutABudgetEveryStepOfAnAttackOf30MsIsSentWhenItIsCrossed) {
  const OutputPortConfig config;
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(74)));
  Wire wire(config);
  const Motion attack = [](double t, double) {
    if (t >= 0.03) return 127.0;
    return 127 * (1 - std::exp(-4 * t / 0.03)) / (1 - std::exp(-4.0));
  };
  play(*port, wire, {attack}, 0, 4800, kRate);
  ASSERT_EQ(wire.sent.size(), 127u);
  for (std::size_t i = 0; i < wire.sent.size(); ++i) {
    const double part = (static_cast<double>(i) + 0.5) / 127 * (1 - std::exp(-4.0));
    EXPECT_NEAR(wire.sent[i].begin_s, -0.03 / 4 * std::log(1 - part), 1e-6);
  }
}

TEST(OutputPort, APeakShorterThanAMessageIsReachedAndLeft) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(74)));
  Wire wire(config);
  const Motion peak = [](double t, double) {
    return std::max(0.0, 127.4 - std::abs(t - 0.02) * 400000);
  };
  play(*port, wire, {peak}, 0, 4800, kRate);
  ASSERT_GE(wire.sent.size(), 2u);
  EXPECT_EQ(std::ranges::max(wire.sent, {}, [](const Sent& s) { return s.event.bytes[2]; })
                .event.bytes[2],
            127);
  EXPECT_EQ(wire.sent.back().event.bytes[2], 0);
  EXPECT_LE(wire.sent.size(), 3u);
}

/// 0, and from `begin_s` on for a millisecond 127.
Motion pulse(double begin_s) {
  return [=](double t, double) { return t >= begin_s && t < begin_s + 0.001 ? 127.0 : 0.0; };
}

std::vector<int> steps_sent(const Wire& wire, int number) {
  std::vector<int> steps;
  for (const Sent& sent : wire.sent) {
    if (sent.event.bytes[1] == number) steps.push_back(sent.event.bytes[2]);
  }
  return steps;
}

TEST(OutputPort, APeakBeforeALanesFirstMessageIsReachedOnAFullCable) {
  auto port = *OutputPort::create(din());
  Wire wire(din());
  std::vector<Motion> motions;
  for (int i = 0; i < 20; ++i) {
    LaneSpec lane = control(i);
    lane.first_step = -1;
    lane.rest_step = 0;
    ASSERT_TRUE(port->add_lane(lane));
    motions.push_back(pulse(0.004));  // the cable is busy until 0.013
  }
  play(*port, wire, motions, 0, 9600, kRate);
  for (int i = 0; i < 20; ++i) {
    const std::vector<int> steps = steps_sent(wire, i);
    EXPECT_EQ(std::ranges::max(steps), 127) << "controller " << i;
    EXPECT_EQ(steps.back(), 0) << "controller " << i;
  }
}

TEST(OutputPort, AValueThatStartsFromRestBeforeAMessageCouldComeIsNotSaidAtRest) {
  for (const int rest : {0, 64}) {
    auto port = *OutputPort::create(din());
    Wire wire(din());
    LaneSpec lane = control(1);
    lane.first_step = -1;
    lane.rest_step = rest;
    ASSERT_TRUE(port->add_lane(lane));
    play(*port, wire, {[](double t, double) { return std::min(t * 20000, 127.0); }}, 0, 9600,
         kRate);
    const std::vector<int> steps = steps_sent(wire, 1);
    ASSERT_FALSE(steps.empty());
    EXPECT_EQ(steps.front() == 0, rest != 0) << "rest is " << rest;
    EXPECT_EQ(steps.back(), 127);
  }
}

TEST(OutputPort, ARestThatIsLeftBeforeTheFirstMessageComesIsNotSentAfterTheValue) {
  for (const int bits : {7, 14}) {
    for (const int lanes : {1, 30}) {
      for (const double begin_s : {0.0001, 0.0005, 0.0009, 0.002}) {
        auto port = *OutputPort::create(din());
        Wire wire(din());
        std::vector<Motion> motions;
        for (int i = 0; i < lanes; ++i) {
          LaneSpec lane = control(i, bits);
          lane.first_step = -1;
          lane.rest_step = 0;
          ASSERT_TRUE(port->add_lane(lane));
          // Falls from 100 to 76 after the rest: neither hides behind it.
          motions.push_back([=](double t, double) {
            if (t < begin_s) return 0.0;
            return t < begin_s + 0.1 ? 100.0 : 76.0;
          });
        }
        play(*port, wire, motions, 0, 24000, kRate);
        const int number = bits == 7 ? lanes - 1 : lanes - 1 + 32;
        std::vector<int> steps = steps_sent(wire, number);
        ASSERT_GE(steps.size(), 2u);
        if (lanes == 1 && begin_s > 0.001) steps.erase(steps.begin());  // it came in time
        EXPECT_EQ(std::ranges::count(steps, 0), 0)
            << bits << " bits, " << lanes << " lanes, from " << begin_s;
        EXPECT_EQ(steps.back(), 76);
      }
    }
  }
}

TEST(OutputPort, LanesThatMoveAlikeAreServedAlike) {
  const OutputPortConfig config = din(false);
  auto port = *OutputPort::create(config);
  std::vector<Motion> motions;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(port->add_lane(control(64 + i)));
    motions.push_back([](double t, double) { return 63.5 + 63.5 * std::sin(60 * t); });
  }
  Wire wire(config);
  play(*port, wire, motions, 0, 96000, kRate);
  std::array<int, 8> count{};
  for (const Sent& sent : wire.sent) ++count[sent.event.bytes[1] - 64u];
  const auto [least, most] = std::ranges::minmax(count);
  EXPECT_GT(least, 200);
  EXPECT_LE(most - least, 12);
}

TEST(OutputPort, ALaneOfAnotherChannelSaysItsValueThere) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(74)));
  Wire wire(config);
  play(*port, wire, {stairs({50})}, 0, 640, kRate);
  port->address(0, 1, 99, 640);
  play(*port, wire, {stairs({50})}, 640, 1280, kRate);
  EXPECT_EQ(wire.sent.size(), 1u) << "a key is nothing to a controller";
  port->address(0, 5, 60, 1280);
  play(*port, wire, {stairs({50})}, 1280, 1920, kRate);
  const std::vector<Bytes> expected = {{0xB0, 74, 50}, {0xB4, 74, 50}};
  EXPECT_EQ(bytes_of(wire), expected);
}

TEST(OutputPort, AValueThatHoldsBetweenTwoStepsIsNotSentTwice) {
  const OutputPortConfig config = din();
  auto port = *OutputPort::create(config);
  ASSERT_TRUE(port->add_lane(control(74)));
  Wire wire(config);
  const Motion noisy = [](double t, double) { return 63.5 + 1e-12 * std::sin(40000 * t); };
  play(*port, wire, {noisy}, 0, 48000, kRate);
  EXPECT_EQ(wire.sent.size(), 1u);
}

TEST(OutputPort, WhatCannotBeIsRefused) {
  OutputPortConfig config;
  config.rate_hz = 100;
  EXPECT_EQ(OutputPort::create(config).error().code, ErrorCode::value_out_of_range);
  config.rate_hz = std::nan("");
  EXPECT_FALSE(OutputPort::create(config));
  auto port = *OutputPort::create({});
  for (const LaneSpec& lane : {control(120), control(32, 14), control(-1), control(1, 8)}) {
    EXPECT_FALSE(port->add_lane(lane));
  }
  LaneSpec osc;
  osc.kind = OutputKind::osc;
  EXPECT_FALSE(port->add_lane(osc));
  for (int i = 0; i < OutputPort::kMostLanes; ++i) {
    ASSERT_TRUE(port->add_lane(control(i % 120)));
  }
  const auto full = port->add_lane(control(1));
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().message.find("512"), std::string::npos);
}

}  // namespace
}  // namespace knotwave::engine

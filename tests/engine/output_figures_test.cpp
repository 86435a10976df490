// SPDX-License-Identifier: MIT
// How well a receiver follows exponential attacks over a cable of 3125 bytes a second, beside a
// poll of 200 Hz. The bounds are the figures of docs/envelope-generator.md.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "output_port_cases.h"

namespace knotwave::engine {
namespace {

using test::Held;
using test::Motion;
using test::Sent;
using test::Wire;

constexpr double kRate = 48000;
constexpr std::int64_t kStart = 4800;
constexpr double kStart_s = 0.1;

struct Figures {
  double worst = 0, rms = 0;
  std::size_t messages = 0;
};

double attack(double t, double length_s, double top) {
  if (t <= 0) return 0;
  if (t >= length_s) return top;
  return top * (1 - std::exp(-4 * t / length_s)) / (1 - std::exp(-4.0));
}

/// Against the attack from its start to its end, in steps of 7 bits.
Figures measure(const std::vector<Held>& held, double length_s, double top) {
  Figures f;
  std::size_t next = 0;
  int step = 0;
  double sum = 0;
  constexpr int kPoints = 200000;
  for (int i = 0; i < kPoints; ++i) {
    const double t = length_s * i / kPoints;
    for (; next < held.size() && held[next].time_s <= t; ++next) {
      step = held[next].step;
      if (held[next].time_s > 0) ++f.messages;
    }
    const double error = std::abs(step - attack(t, length_s, top)) * 127 / top;
    f.worst = std::max(f.worst, error);
    sum += error * error;
  }
  f.rms = std::sqrt(sum / kPoints);
  return f;
}

/// As VCV's CV to CC, sent in no time.
Figures poll_200_hz(double length_s) {
  std::vector<Held> held;
  for (double t = 0.005; t < length_s + 0.01; t += 0.005) {
    held.push_back({t, static_cast<int>(std::floor(attack(t, length_s, 127) + 0.5))});
  }
  return measure(held, length_s, 127);
}

Figures through_port(const LaneSpec& spec, bool running_status, double length_s, bool is_known) {
  OutputPortConfig config;
  config.wire = PortSpec::Wire::din;
  config.running_status = running_status;
  auto port = OutputPort::create(config);
  LaneSpec lane = spec;
  lane.first_step = -1;
  EXPECT_TRUE((*port)->add_lane(lane));
  const double top = lane.bits == 14 ? 16383 : 127;
  Wire wire(config);
  const auto motion = [&](double t, double known) {
    return known < kStart_s && !is_known ? 0 : attack(t - kStart_s, length_s, top);
  };
  const auto end = kStart + static_cast<std::int64_t>((length_s + 0.1) * kRate);
  test::play(**port, wire, {motion}, 0, end, kRate, {kStart});
  std::vector<Held> held;
  int high = 0, low = 0;
  for (std::size_t i = 0; i < wire.sent.size(); ++i) {
    const Sent& sent = wire.sent[i];
    const int number = sent.event.bytes[1], value = sent.event.bytes[2];
    if (lane.bits == 7) {
      high = value;
    } else if (lane.kind == OutputKind::pitch_bend) {
      high = value * 128 + number;
    } else if (number == 98 || number == 99) {
      continue;
    } else if (number < 32) {
      high = value;
      low = 0;
    } else {
      low = value;
    }
    const int step =
        lane.bits == 7 || lane.kind == OutputKind::pitch_bend ? high : high * 128 + low;
    held.push_back({sent.arrival_s - kStart_s, step});
  }
  EXPECT_EQ(held.back().step, static_cast<int>(top));
  return measure(held, length_s, top);
}

struct Bound {
  double worst, rms;
};
struct Row {
  double length_s;
  Bound din, running;  ///< the goals of the generator
};
constexpr Row kGoals[] = {{0.010, {41, 11}, {29, 7}},
                          {0.030, {15, 3.4}, {11, 2.3}},
                          {0.100, {4.8, 1.0}, {3.5, 0.7}},
                          {0.300, {2.0, 0.4}, {1.5, 0.3}}};
/// What docs/envelope-generator.md says.
constexpr Row kControl7[] = {{0.010, {21.6, 5.1}, {15.6, 3.4}},
                             {0.030, {8.0, 1.8}, {5.6, 1.2}},
                             {0.100, {2.7, 0.58}, {2.1, 0.44}},
                             {0.300, {1.3, 0.33}, {1.1, 0.30}}};
constexpr Row kControl14[] = {{0.010, {21.9, 5.1}, {15.0, 3.4}},
                              {0.030, {8.0, 1.8}, {5.7, 1.2}},
                              {0.100, {2.9, 0.60}, {2.0, 0.43}},
                              {0.300, {1.9, 0.30}, {1.7, 0.24}}};
constexpr Row kBend[] = {{0.010, {22.0, 5.1}, {15.3, 3.4}},
                         {0.030, {8.0, 1.7}, {5.4, 1.2}},
                         {0.100, {2.5, 0.51}, {1.7, 0.34}},
                         {0.300, {0.9, 0.17}, {0.6, 0.12}}};

LaneSpec lane_of(OutputKind kind, int bits) {
  LaneSpec lane;
  lane.kind = kind;
  lane.number = 1;
  lane.bits = bits;
  return lane;
}

void expect_within(const Figures& f, const Bound& bound, const std::string& what) {
  EXPECT_LE(f.worst, bound.worst) << what;
  EXPECT_LE(f.rms, bound.rms) << what;
}

void expect_rows(const LaneSpec& lane, std::span<const Row> rows) {
  for (const Row& row : rows) {
    const std::string what = std::to_string(row.length_s) + " s";
    expect_within(through_port(lane, false, row.length_s, true), row.din, what);
    expect_within(through_port(lane, true, row.length_s, true), row.running, what + ", running");
  }
}

TEST(OutputFigures, AnAttackKnownOneMessageAheadIsBetterThanTheCrossingsOfAPlainSender) {
  for (const Row& row : kGoals) {
    for (const bool running : {false, true}) {
      const Bound& goal = running ? row.running : row.din;
      const Figures sent =
          through_port(lane_of(OutputKind::control, 7), running, row.length_s, true);
      const Figures poll = poll_200_hz(row.length_s);
      expect_within(sent, goal, std::to_string(row.length_s) + " s");
      EXPECT_GT(poll.worst, 2.5 * goal.worst);
      EXPECT_GT(poll.rms, 4.5 * goal.rms);
      std::printf("%3.0f ms%s: worst %.2f rms %.2f of %zu messages; poll of 200 Hz %.1f %.1f\n",
                  row.length_s * 1000, running ? " running" : "", sent.worst, sent.rms,
                  sent.messages, poll.worst, poll.rms);
    }
  }
}

TEST(OutputFigures, AnAttackThatNobodyForesawCostsTheFirstMessageAndNoMore) {
  for (const Row& row : kGoals) {
    for (const bool running : {false, true}) {
      const Figures sent =
          through_port(lane_of(OutputKind::control, 7), running, row.length_s, false);
      const double message_s = (running ? 2 : 3) / kDinBytesPerSecond;
      EXPECT_LE(sent.worst, std::max(attack(message_s, row.length_s, 127) + 0.01, 1.7));
      EXPECT_LE(sent.rms, running ? row.running.rms : row.din.rms);
    }
  }
}

TEST(OutputFigures, OfSevenBitsAreAsStated) {
  expect_rows(lane_of(OutputKind::control, 7), kControl7);
}
TEST(OutputFigures, OfFourteenBitsAreAsStated) {
  expect_rows(lane_of(OutputKind::control, 14), kControl14);
}
TEST(OutputFigures, OfNrpnAreThoseOfFourteenBitsOnceItIsSelected) {
  expect_rows(lane_of(OutputKind::nrpn, 14), kControl14);
}
TEST(OutputFigures, OfPitchBendAreAsStated) {
  expect_rows(lane_of(OutputKind::pitch_bend, 14), kBend);
}

}  // namespace
}  // namespace knotwave::engine

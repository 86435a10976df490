// SPDX-License-Identifier: MIT
// Random lanes and random traffic through a port: what holds whatever comes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "output_port_cases.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using base::MidiEvent;
using test::Motion;
using test::Sent;
using test::Wire;

constexpr double kRate = 48000;
constexpr double kWindow_s = 0.02;

struct Case {
  OutputPortConfig config;
  std::vector<LaneSpec> lanes;
  std::vector<Motion> motions;
  std::vector<MidiEvent> thru;
  std::vector<OutputPriority> priorities;
  double end_s = 0.1;  ///< values hold from here on
};

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : random_(seed) {}
  double real(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  int integer(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  Case make() {
    Case c;
    c.config.wire = integer(0, 3) == 0 ? PortSpec::Wire::usb : PortSpec::Wire::din;
    c.config.running_status = integer(0, 1) == 1;
    const int lanes = integer(1, 6);
    for (int i = 0; i < lanes; ++i) add_lane(c, i + 1);
    add_thru(c);
    return c;
  }

 private:
  void add_lane(Case& c, int channel) {
    constexpr OutputKind kKinds[] = {OutputKind::control, OutputKind::nrpn, OutputKind::pitch_bend,
                                     OutputKind::channel_pressure, OutputKind::poly_pressure};
    LaneSpec lane;
    lane.kind = kKinds[integer(0, 4)];
    lane.channel = channel;
    lane.bits = integer(0, 1) == 1 ? 14 : 7;
    lane.number = lane.kind == OutputKind::nrpn ? integer(0, 16382) : integer(7, 31);
    if (lane.kind == OutputKind::pitch_bend) lane.bits = 14;
    if (lane.kind >= OutputKind::channel_pressure) lane.bits = 7;
    c.lanes.push_back(lane);
    c.motions.push_back(motion(lane.bits == 14 ? 16383 : 127, c.end_s));
  }
  /// From 0 to 1 and back somehow, then at rest.
  Motion motion(double top, double end_s) {
    const double hz = std::exp2(real(-1, 11)), phase = real(0, 1), start = real(0, 0.05);
    const double length = std::exp2(real(-10, -3)), last = std::floor(real(0, 1) * top);
    const int kind = integer(0, 3);
    return [=](double t, double) {
      if (t >= end_s) return last;
      double v = 0;
      if (kind == 0) v = 0.5 - 0.51 * std::cos(6.283185307179586 * (hz * t + phase));
      if (kind == 1) v = t < start ? 0 : (1 - std::exp(-4 * (t - start) / length)) * 1.02;
      if (kind == 2) v = std::abs(t - start) < length / 20 ? 1 : 0;
      if (kind == 3) v = std::fmod(t * hz + phase, 1.0);
      return std::clamp(v, 0.0, 1.0) * top;
    };
  }
  void add_thru(Case& c) {
    const double rate_hz = integer(0, 2) == 0 ? 0 : std::exp2(real(1, 12));
    if (rate_hz == 0) return;
    for (double t = real(0, 0.01); t < c.end_s && c.thru.size() < 900; t += real(0, 2) / rate_hz) {
      MidiEvent event;
      event.time.sample = static_cast<std::int64_t>(t * kRate);
      event.time.fraction = static_cast<std::uint32_t>(random_());
      constexpr int kStatus[] = {0x98, 0x88, 0xB8, 0xC9, 0xE9, 0xF8};
      const int kind = integer(0, 5);
      event.bytes[0] = static_cast<std::uint8_t>(kStatus[kind]);
      if (kind < 5) event.bytes[1] = static_cast<std::uint8_t>(integer(0, 127));
      if (kind < 5 && kind != 3) event.bytes[2] = static_cast<std::uint8_t>(integer(0, 127));
      c.thru.push_back(event);
      c.priorities.push_back(kind == 5   ? OutputPriority::clock
                             : kind <= 1 ? OutputPriority::note
                                         : OutputPriority::control);
    }
  }
  std::mt19937_64 random_;
};

struct Log {
  std::vector<Sent> sent;
  std::int64_t overload_bytes = 0, expected_overload = 0;
  bool is_waiting = false;
};

int full_bytes(const MidiEvent& e) {
  return e.bytes[0] >= 0xF8 ? 1 : (e.bytes[0] & 0xE0) == 0xC0 ? 2 : 3;
}

Log run(const Case& c, const std::function<std::int64_t()>& block) {
  auto port = *OutputPort::create(c.config);
  for (const LaneSpec& lane : c.lanes) EXPECT_TRUE(port->add_lane(lane));
  Wire wire(c.config);
  Log log;
  std::size_t next = 0;
  std::int64_t posted_bytes = 0;
  const double room = c.config.wire == PortSpec::Wire::din ? 62.5 : 960;
  const auto end = static_cast<std::int64_t>((c.end_s + 1.5) * kRate);
  for (std::int64_t first = 0; first < end;) {
    const std::int64_t n = std::min(block(), end - first);
    for (; next < c.thru.size() && c.thru[next].time.sample < first + n; ++next) {
      std::int64_t begun = 0;
      for (const Sent& sent : wire.sent) {
        const int channel = sent.event.channel();
        if (sent.event.bytes[0] >= 0xF8 || channel >= 8) begun += full_bytes(sent.event);
      }
      if (static_cast<double>(posted_bytes - begun) > room) {
        log.expected_overload += full_bytes(c.thru[next]);
      }
      EXPECT_TRUE(port->post(c.thru[next], c.priorities[next], true));
      posted_bytes += full_bytes(c.thru[next]);
    }
    test::play(*port, wire, c.motions, first, first + n, kRate, {}, [n] { return n; });
    first += n;
  }
  log.sent = wire.sent;
  log.overload_bytes = port->counters().overload_bytes;
  log.is_waiting = port->is_waiting();
  return log;
}

bool is_thru(const MidiEvent& event) { return event.bytes[0] >= 0xF8 || event.channel() >= 8; }

void expect_budget(const Case& c, const Log& log) {
  const bool is_din = c.config.wire == PortSpec::Wire::din;
  std::size_t oldest = 0;
  int bytes = 0;
  for (std::size_t i = 0; i < log.sent.size(); ++i) {
    const Sent& sent = log.sent[i];
    if (is_din && i > 0) {
      ASSERT_GE(sent.begin_s, log.sent[i - 1].arrival_s - 1e-10) << "the cable is taken";
    }
    if (!is_din) {
      if (i < 16) continue;
      ASSERT_GE(sent.begin_s - log.sent[i - 16].begin_s, 0.001 - 1e-10);
      continue;
    }
    // A leaky bucket that holds one message.
    bytes += sent.bytes;
    for (; log.sent[oldest].begin_s < sent.begin_s - kWindow_s; ++oldest) {
      bytes -= log.sent[oldest].bytes;
    }
    ASSERT_LE(bytes, kWindow_s * kDinBytesPerSecond + sent.bytes);
  }
}

/// The steps that a receiver hears of, per lane.
std::vector<int> heard(const LaneSpec& lane, const Log& log) {
  std::vector<int> steps;
  int high = 0, low = 0;
  for (const Sent& sent : log.sent) {
    const MidiEvent& e = sent.event;
    if (is_thru(e) || e.channel() != lane.channel - 1) continue;
    if (lane.kind == OutputKind::pitch_bend) {
      steps.push_back(e.bytes[1] + 128 * e.bytes[2]);
    } else if (lane.kind == OutputKind::channel_pressure) {
      steps.push_back(e.bytes[1]);
    } else if (lane.kind == OutputKind::poly_pressure) {
      steps.push_back(e.bytes[2]);
    } else {
      const int number = lane.kind == OutputKind::nrpn ? 6 : lane.number;
      if (e.bytes[1] == number) {
        high = e.bytes[2];
        low = 0;
      } else if (lane.bits == 14 && e.bytes[1] == number + 32) {
        low = e.bytes[2];
      } else {
        continue;
      }
      steps.push_back(lane.bits == 14 ? high * 128 + low : high);
    }
  }
  return steps;
}

void expect_values(const Case& c, const Log& log) {
  EXPECT_FALSE(log.is_waiting);
  for (std::size_t i = 0; i < c.lanes.size(); ++i) {
    std::vector<int> steps = heard(c.lanes[i], log);
    if (c.lanes[i].first_step >= 0) steps.insert(steps.begin(), c.lanes[i].first_step);
    ASSERT_FALSE(steps.empty()) << "lane " << i;
    const double last = c.motions[i](10, 10);
    EXPECT_LE(std::abs(steps.back() - last), 0.5 + 1e-6) << "the last value of lane " << i;
    double low = 1e9, high = -1e9;
    for (std::int64_t k = 0; k < 9600; ++k) {
      const double v = c.motions[i](static_cast<double>(k) / kRate, 10);
      low = std::min(low, v);
      high = std::max(high, v);
    }
    const double reached_high = std::ranges::max(steps), reached_low = std::ranges::min(steps);
    EXPECT_GE(reached_high, std::ceil(high - 0.5 - 1e-6)) << "the highest step of lane " << i;
    EXPECT_LE(reached_low, std::floor(low + 0.5 + 1e-6)) << "the lowest step of lane " << i;
    EXPECT_LE(reached_high, high + 0.5 + 1e-6) << "lane " << i;
  }
}

void expect_thru(const Case& c, const Log& log) {
  std::vector<MidiEvent> clocks, rest, sent_clocks, sent_rest;
  for (const MidiEvent& e : c.thru) (e.bytes[0] >= 0xF8 ? clocks : rest).push_back(e);
  for (const Sent& s : log.sent) {
    if (!is_thru(s.event)) continue;
    (s.event.bytes[0] >= 0xF8 ? sent_clocks : sent_rest).push_back(s.event);
  }
  ASSERT_EQ(sent_clocks.size(), clocks.size());
  ASSERT_EQ(sent_rest.size(), rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_EQ(0, std::memcmp(rest[i].bytes, sent_rest[i].bytes, 3));
    EXPECT_GE(sent_rest[i].time, rest[i].time);
  }
  EXPECT_EQ(log.overload_bytes, log.expected_overload);
}

void expect_same(const Log& a, const Log& b) {
  ASSERT_EQ(a.sent.size(), b.sent.size());
  for (std::size_t i = 0; i < a.sent.size(); ++i) {
    ASSERT_EQ(0, std::memcmp(a.sent[i].event.bytes, b.sent[i].event.bytes, 3)) << i;
    ASSERT_EQ(a.sent[i].event.time, b.sent[i].event.time) << i;
  }
}

enum class Receiver { holds_0, unknown };

void check_case(std::uint64_t seed, int number, Receiver receiver) {
  SCOPED_TRACE("case " + std::to_string(number) + " of seed " + std::to_string(seed) +
               (receiver == Receiver::unknown ? ", what receivers hold is unknown" : ""));
  Maker maker(seed * 1000003u + static_cast<std::uint64_t>(number));
  Case c = maker.make();
  if (receiver == Receiver::unknown) {
    for (LaneSpec& lane : c.lanes) lane.first_step = -1;
  }
  const Log log = run(c, [] { return std::int64_t{64}; });
  expect_budget(c, log);
  expect_values(c, log);
  expect_thru(c, log);
  std::int64_t size = 1;
  const Log split = run(c, [&] { return size = size % 64 + 1; });
  expect_same(log, split);
}

void check_cases(int count) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    check_case(seed, i, Receiver::holds_0);
    check_case(seed, i, Receiver::unknown);
  }
}

TEST(OutputBudget, HoldsForRandomLanesAndTraffic) { check_cases(support::test_count(20)); }
TEST(OutputBudget, HoldsWhereABlockEndsWithinAGroupThatOthersInterrupt) {
  check_case(1, 420, Receiver::holds_0);
}
TEST(OutputBudget, HoldsWhereAHalfAloneArrivesBeforeTheValueLeaves) {
  check_case(1, 425, Receiver::holds_0);
}
TEST(OutputBudget, HoldsWhereAChangeWaitsForTheCableOverManyBlocks) {
  check_case(1, 781, Receiver::holds_0);
}
TEST(OutputBudgetStress, HoldsForTenThousandRandomLanesAndTraffics) {
  check_cases(support::test_count(10000));
}

TEST(OutputBudget, AMonotoneCurveStaysMonotone) {
  Maker maker(support::test_seed());
  for (int i = 0; i < support::test_count(100); ++i) {
    Case c;
    c.config.wire = i % 4 == 0 ? PortSpec::Wire::usb : PortSpec::Wire::din;
    c.config.running_status = i % 2 == 0;
    LaneSpec lane;
    lane.bits = i % 3 == 0 ? 7 : 14;
    lane.kind = i % 3 == 2 ? OutputKind::pitch_bend : OutputKind::control;
    lane.number = 1;
    const double top = lane.bits == 14 ? 16383 : 127;
    const double length = std::exp2(maker.real(-10, -3)), bend = maker.real(-8, 8);
    c.lanes.push_back(lane);
    c.motions.push_back([=](double t, double) {
      const double x = std::clamp((t - 0.01) / length, 0.0, 1.0);
      return top * (std::abs(bend) < 0.01 ? x : std::expm1(bend * x) / std::expm1(bend));
    });
    c.end_s = 0.01;
    const Log log = run(c, [] { return std::int64_t{64}; });
    // Both halves of a value of 14 bits are one.
    std::vector<int> steps;
    int high = 0, low = 0;
    for (std::size_t m = 0; m < log.sent.size(); ++m) {
      const MidiEvent& e = log.sent[m].event;
      if (lane.kind == OutputKind::pitch_bend) {
        steps.push_back(e.bytes[1] + 128 * e.bytes[2]);
        continue;
      }
      if (e.bytes[1] == 1) {
        high = e.bytes[2];
        low = 0;
        const bool has_low = m + 1 < log.sent.size() && log.sent[m + 1].event.bytes[1] == 33 &&
                             log.sent[m + 1].begin_s <= log.sent[m].arrival_s + 1e-9;
        if (lane.bits == 14 && has_low) continue;
      } else {
        low = e.bytes[2];
      }
      steps.push_back(lane.bits == 14 ? high * 128 + low : high);
    }
    EXPECT_TRUE(std::ranges::is_sorted(steps))
        << "case " << i << " length " << length << " bend " << bend;
    EXPECT_EQ(steps.back(), static_cast<int>(top));
  }
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// A virtual cable of MIDI clocks.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/midi_clock.h"

#include "support/seed.h"

namespace knotwave::engine::scenes {

inline constexpr double kRate = 48000;

inline base::SampleTime at(double seconds) {
  const double samples = seconds * kRate, whole = std::floor(samples);
  return {static_cast<std::int64_t>(whole), static_cast<std::uint32_t>((samples - whole) * 0x1p32)};
}

/// Sends messages and keeps the tempos and positions that come back.
class Cable {
 public:
  Cable() { clock.reset(kRate); }

  bool send(double time_s, std::uint8_t status, std::uint8_t data1 = 0, std::uint8_t data2 = 0) {
    base::MidiEvent event;
    event.time = at(time_s);
    event.bytes[0] = status;
    event.bytes[1] = data1;
    event.bytes[2] = data2;
    const auto [has_tempo, has_position] = clock.handle(event);
    if (has_tempo) {
      const Event tempo = clock.tempo_event();
      EXPECT_EQ(tempo.kind, Event::Kind::tempo);
      EXPECT_EQ(tempo.time(), event.time);
      tempos.push_back({time_s, 6e7 / tempo.microseconds_per_quarter});
    }
    if (has_position) {
      const Event position = clock.position_event();
      EXPECT_EQ(position.kind, Event::Kind::position);
      EXPECT_EQ(position.time(), event.time);
      positions.push_back({time_s, position.song_clocks});
    }
    return has_tempo;
  }

  /// Clocks at a tempo that is a function of the time, jittered by `noise_s` (rms), until end_s.
  void run(double end_s, const std::function<double(double)>& bpm, double noise_s = 0) {
    for (; due_s < end_s; due_s += 60 / (24 * bpm(due_s))) {
      send(due_s + noise_s * normal(), 0xF8);
      ++sent;
      if (watch) watch(due_s);
    }
  }
  void run(double end_s, double bpm, double noise_s = 0) {
    run(
        end_s, [bpm](double) { return bpm; }, noise_s);
  }

  /// Gaussian, by Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - random.unit(next++)));
    return radius * std::cos(2 * std::numbers::pi * random.unit(next++));
  }

  struct Tempo {
    double time_s, bpm;
  };
  MidiClock clock;
  struct Position {
    double time_s = 0;
    std::int64_t clocks = 0;
    bool operator==(const Position&) const = default;
  };
  std::vector<Tempo> tempos;
  std::vector<Position> positions;
  std::function<void(double)> watch;
  double due_s = 0.1;
  std::int64_t sent = 0;
  base::RandomStream random{support::test_seed(), 0, 0};
  std::uint64_t next = 0;
};

}  // namespace knotwave::engine::scenes

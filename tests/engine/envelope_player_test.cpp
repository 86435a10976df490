// SPDX-License-Identifier: MIT
#include "knotwave/engine/envelope_player.h"

#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "engine/envelope_rig.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

constexpr double kRate = 48000;

// Values.

TEST(EnvelopePlayer, ValuesAreThoseOfTheCurveFromTheGatesOwnTime) {
  EnvelopeRig rig(std::string(kSwell) + "rest = 0.25\n");
  rig.midi(1000.5, 0x90, 60, 100);
  rig.midi(30000.25, 0x80, 60, 64);
  rig.play(70000);
  EXPECT_EQ(rig.at(1000), 0.25) << "at rest before the first gate";
  for (std::int64_t n = 1001; n <= 30000; ++n) {
    const double u = std::min((static_cast<double>(n) - 1000.5) / kRate, 0.4);
    ASSERT_NEAR(rig.at(n), swell(u), 1e-9) << n;
  }
  // Behind the corner, which is rounded over 10 ms, it goes on as drawn.
  for (std::int64_t n = 30500; n < 70000; ++n) {
    const double u = 0.4 + (static_cast<double>(n) - 30000.25) / kRate;
    ASSERT_NEAR(rig.at(n), swell(u), 1e-9) << n;
  }
  EXPECT_EQ(rig.at(69999), 0);
  EXPECT_TRUE(rig.player().is_still());
}

// An oracle of its own: the blossom of a cubic by de Casteljau, and the law between of and range.
TEST(EnvelopePlayer, ACubicThroughAMapAndALawIsWhatItsFormulasSay) {
  EnvelopeRig rig(
      "[curves.rise]\ndegree = 3\npoints = [0, 0.9, 0.2, 1]\n"
      "[curves.squared]\ndegree = 2\npoints = [0, 0, 1]\n"
      "[envelopes.rise]\ncurve = 'rise'\nseconds = 0.25\n"
      "[[maps]]\nfrom = 'rise'\ncurve = 'squared'\nto = 'free.x'\ndepth = 0.5\n"
      "[[maps]]\nfrom = 'velocity'\nto = 'free.x'\ndepth = 0.25\n"
      "[[outputs]]\nfrom = 'free.x'\nto = 'bend'\nof = [-0.5, 1]\nrange = [4000, -8192]\n");
  rig.midi(10, 0x90, 60, 127);
  rig.play(10000);
  for (std::int64_t n = 10; n < 10000; ++n) {
    const double t = static_cast<double>(n - 10) / kRate / 0.25, s = 1 - t;
    const double y = 3 * 0.9 * t * s * s + 3 * 0.2 * t * t * s + t * t * t;
    const double x = (0.5 * y * y + 0.25 + 0.5) / 1.5;
    ASSERT_NEAR(rig.at(n), 4000 + (-8192.0 - 4000) * x, 1e-6) << n;
  }
}

TEST(EnvelopePlayer, AFullSweepReachesBothEndsOfTheRangeExactly) {
  EnvelopeRig rig(
      "[curves.up]\ndegree = 1\npoints = [0, 1]\n[envelopes.up]\ncurve = 'up'\n"
      "seconds = 0.01\n[[outputs]]\nfrom = 'up'\nto = 'cc1'\nbits = 14\n");
  rig.midi(0, 0x90, 60, 1);
  rig.play(1000);
  EXPECT_EQ(rig.at(0), 0);
  EXPECT_EQ(rig.at(999), 16383);
}

// Weights, points and knots that controllers move, as in a patch of sound.
TEST(EnvelopePlayer, ControllersMovePointsWeightsAndTimes) {
  EnvelopeRig rig(
      "[curves.hill]\ndegree = 1\npoints = [0.5, 0.5, 0.5]\n"
      "[envelopes.hill]\ncurve = 'hill'\nseconds = 1\n"
      "[[maps]]\nfrom = 'mod'\nto = 'curve.hill.point.1'\nlow = 0\nhigh = 1\nsmooth_s = 0\n"
      "[[maps]]\nfrom = 'velocity'\nto = 'envelope.hill.time'\ndepth = -1\n"
      "[[outputs]]\nfrom = 'hill'\nto = 'osc'\naddress = '/a'\n");
  rig.midi(0, 0xB0, 1, 127);
  rig.midi(100, 0x90, 60, 127);  // an octave faster: half a second
  rig.play(30000);
  EXPECT_NEAR(rig.at(100), 0.5, 1e-12);
  EXPECT_NEAR(rig.at(100 + 6000), 0.75, 1e-9);
  EXPECT_NEAR(rig.at(100 + 12000), 1, 1e-9);
  EXPECT_NEAR(rig.at(100 + 18000), 0.75, 1e-9);
}

TEST(EnvelopePlayer, EnvelopesInBeatsTakeTheTempoOfTheirGate) {
  EnvelopeRig rig(
      "[curves.up]\ndegree = 1\npoints = [0, 1]\n[envelopes.up]\ncurve = 'up'\n"
      "beats = 2\n[[outputs]]\nfrom = 'up'\nto = 'osc'\naddress = '/a'\n");
  rig.tempo(0, 250000);  // 12000 samples a quarter
  rig.midi(100, 0x90, 60, 100);
  rig.tempo(5000, 1000000);
  rig.play(30000);
  EXPECT_NEAR(rig.at(100 + 12000), 0.5, 1e-9);
  EXPECT_NEAR(rig.at(100 + 24000), 1, 1e-9);
}

TEST(EnvelopePlayer, AFreeLfoInBeatsStandsWhereTheSongIs) {
  EnvelopeRig rig(
      "[curves.ramp]\ndegree = 1\npoints = [0, 1]\n"
      "[lfos.saw]\ncurve = 'ramp'\nbeats = 1\nmode = 'free'\n"
      "[trigger]\nfrom = 'loop'\n[[outputs]]\nfrom = 'saw'\nto = 'osc'\naddress = '/a'\n");
  rig.midi(30000, 0xFA);  // the song begins here
  rig.play(60000);
  EXPECT_NEAR(rig.at(6000), 0.25, 1e-9);
  EXPECT_NEAR(rig.at(29999), 5999 / 24000.0, 1e-9);
  EXPECT_NEAR(rig.at(30000), 0, 1e-9);
  EXPECT_NEAR(rig.at(42000), 0.5, 1e-9);
  EXPECT_FALSE(rig.player().is_still());
}

// Blocks and prediction.

constexpr const char* kMoving =
    "[curves.a]\ndegree = 2\npoints = [0, 1, 0.3, 0.6, 0]\n"
    "[envelopes.a]\ncurve = 'a'\nseconds = 0.02\nloop = [0.3, 0.6]\n"
    "[envelopes.b]\ncurve = 'a'\nbeats = 0.03\nsustain_at = 0.5\nvelocity_time = 1\n"
    "[lfos.wow]\ncurve = 'sine'\nrate_hz = 30\nrandom = true\n"
    "[[maps]]\nfrom = 'mod'\nto = 'curve.a.point.1'\nlow = 0.5\nhigh = 2\nsmooth_s = 0.003\n"
    "[[maps]]\nfrom = 'pressure'\nto = 'lfo.wow.rate'\ndepth = 2\n"
    "[[maps]]\nfrom = 'b'\nto = 'free.x'\n"
    "[[maps]]\nfrom = 'wow'\nto = 'free.x'\ndepth = 0.1\n"
    "[[outputs]]\nfrom = 'a'\nto = 'cc74'\n"
    "[[outputs]]\nfrom = 'free.x'\nto = 'bend'\nchannel = 2\n"
    "[[events]]\nenvelope = 'a'\nat = 0.45\nnote = 40\nseconds = 0.002\n"
    "[[events]]\nenvelope = 'a'\nat = 'loop'\ngate = 1\nseconds = 0.001\n"
    "[[events]]\nenvelope = 'b'\nat = 'end'\nnote = 41\n";

const char* const kPlayers[] = {
    "mode = 'mono'\n",
    "mode = 'legato'\npriority = 'high'\n",
    "mode = 'poly'\npolyphony = 3\n",
    "mode = 'poly'\npolyphony = 4\nnotes = 'mpe'\n",
    "notes = 'thru'\n",
};
const char* const kTriggers[] = {
    "[trigger]\nfrom = 'cc20'\n",
    "[trigger]\nfrom = 'clock'\nbeats = 0.0625\noffset_beats = 0.01\ngate = 0.3\n",
    "[trigger]\nfrom = 'loop'\n",
};

std::vector<std::string> moving_patches() {
  std::vector<std::string> all;
  for (const char* player : kPlayers) all.push_back(player + std::string(kMoving));
  for (const char* trigger : kTriggers) all.push_back(kMoving + std::string(trigger));
  return all;
}

void add_performance(EnvelopeRig& rig) {
  const base::RandomStream random{support::test_seed(), 0, 2200};
  double time = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    time += 5 + 180 * random.unit(4 * i);
    const std::uint64_t bits = random.bits(4 * i + 1);
    const int key = 60 + static_cast<int>(bits & 3), value = static_cast<int>(bits >> 8 & 127);
    constexpr std::array<int, 8> kStatus = {0x90, 0x90, 0x90, 0x80, 0x80, 0xB0, 0xD0, 0xB0};
    const int status = kStatus[bits >> 4 & 7];
    if (i % 20 == 19) {
      rig.tempo(time, 300000 + static_cast<std::uint32_t>(bits & 0xFFFFF));
    } else if (i % 20 == 9) {
      rig.midi(time, i < 30 ? 0xFA : 0xFC);
    } else {
      rig.midi(time, status, status == 0xB0 ? (key & 1 ? 20 : 1) : key, value);
    }
  }
}

TEST(EnvelopePlayer, AnySplitIntoBlocksGivesTheSameBits) {
  for (const std::string& patch : moving_patches()) {
    EnvelopeRig whole(patch);
    add_performance(whole);
    whole.play(7000);
    EXPECT_GT(whole.messages().size(), 5u) << patch;
    for (std::size_t block = 1; block < 64; block += block < 20 ? 1 : 7) {
      EnvelopeRig split(patch);
      add_performance(split);
      split.play(7000, block);
      ASSERT_EQ(split.bits(), whole.bits()) << block << "\n" << patch;
    }
  }
}

TEST(EnvelopePlayer, WhatIsPredictedComesIfNothingHappens) {
  constexpr std::size_t kAhead = 200;
  for (const std::string& patch : moving_patches()) {
    EnvelopeRig rig(patch);
    add_performance(rig);
    int moving = 0;
    for (std::int64_t at = 500; at < 7000; at += 487) {
      EnvelopeRig quiet(patch);  // the same up to `at`, then nothing more
      add_performance(quiet);
      quiet.play(at);
      quiet.player().predict(kAhead);
      std::vector<std::vector<double>> predicted;
      const int outputs = static_cast<int>(quiet.program().outputs().size());
      for (int row = 0; row < quiet.player().voices() * outputs; ++row) {
        const auto got = quiet.player().values(row / outputs, row % outputs);
        ASSERT_GE(got.size(), kAhead);
        predicted.emplace_back(got.end() - kAhead, got.end());
        moving += got.back() != got[got.size() - kAhead];
      }
      for (std::size_t done = 0; done < kAhead; done += 40) {
        quiet.player().render(40);
        for (std::size_t row = 0; row < predicted.size(); ++row) {
          const auto got = quiet.player().values(static_cast<int>(row) / outputs,
                                                 static_cast<int>(row) % outputs);
          for (std::size_t i = 0; i < 40; ++i) {
            ASSERT_EQ(std::bit_cast<std::uint64_t>(got[i]),
                      std::bit_cast<std::uint64_t>(predicted[row][done + i]))
                << patch << at << " row " << row << " + " << done + i;
          }
        }
      }
    }
    EXPECT_GT(moving, 4) << patch;
  }
}

TEST(EnvelopePlayer, PredictionChangesNothing) {
  const std::string patch = moving_patches()[2];
  EnvelopeRig one(patch), other(patch);
  for (EnvelopeRig* rig : {&one, &other}) add_performance(*rig);
  for (std::int64_t at = 100; at < 5000; at += 100) {
    one.play(at);
    other.play(at);
    other.player().predict(static_cast<std::size_t>(at % 250));
  }
  EXPECT_EQ(one.bits(), other.bits());
}

// Storms.

// Messages of every kind, notes most of all, and songs that start and stop.
Event storm_event(const base::RandomStream& random, std::uint64_t i, std::int64_t sample) {
  constexpr std::array<int, 16> kStatus = {0x90, 0x90, 0x90, 0x90, 0x90, 0x80, 0x80, 0x80,
                                           0x80, 0xB0, 0xB0, 0xB0, 0xA0, 0xC0, 0xD0, 0xE0};
  const std::uint64_t bits = random.bits(i);
  Event event;
  event.midi.time = {sample, static_cast<std::uint32_t>(bits >> 32)};
  int status = kStatus[bits & 15] | static_cast<int>(bits >> 4 & 15);
  int one = static_cast<int>(bits >> 8 & 127);
  if ((status & 0xF0) == 0xB0 && (bits >> 30 & 1) != 0) {
    constexpr std::array<int, 8> kControls = {64, 66, 120, 121, 123, 100, 101, 6};
    one = kControls[bits >> 11 & 7];
  }
  if (i % 97 == 0) {
    constexpr std::array<int, 8> kSystem = {0xF8, 0xF8, 0xFA, 0xFB, 0xFC, 0xF2, 0xF8, 0xFE};
    status = kSystem[bits >> 20 & 7];
  }
  event.midi.bytes[0] = static_cast<std::uint8_t>(status);
  event.midi.bytes[1] = static_cast<std::uint8_t>(one);
  event.midi.bytes[2] = static_cast<std::uint8_t>(bits >> 20 & 127);
  if (i % 211 == 0) {
    event.kind = Event::Kind::tempo;
    event.microseconds_per_quarter = static_cast<std::uint32_t>(bits & 0xFFFFF);
  }
  if (i % 509 == 0) event.kind = Event::Kind::all_notes_off;
  return event;
}

struct StormReport {
  std::int64_t allocations = 0;
  int out_of_range = 0;
  std::array<std::array<int, 128>, 16> sounding{};
  int most_sounding = 0;
};

void hear(EnvelopePlayer& player, StormReport& report) {
  for (const PlayerMessage& message : player.take_messages()) {
    if (message.kind == PlayerMessage::Kind::place_gate) continue;
    const auto channel = static_cast<std::size_t>(message.midi.channel());
    int& count = report.sounding[channel][message.midi.bytes[1] & 127];
    count = message.midi.status() == base::MidiStatus::note_on ? count + 1 : 0;
    report.most_sounding = std::max(report.most_sounding, count);
  }
}

void check_values(EnvelopePlayer& player, const EnvelopePatchProgram& program,
                  StormReport& report) {
  for (int voice = 0; voice < player.voices(); ++voice) {
    for (int output = 0; output < static_cast<int>(program.outputs().size()); ++output) {
      const OutputSpec& spec = program.outputs()[static_cast<std::size_t>(output)].spec;
      for (const double value : player.values(voice, output)) {
        report.out_of_range +=
            !(value >= std::min(spec.low, spec.high) && value <= std::max(spec.low, spec.high));
      }
    }
  }
}

TEST(EnvelopePlayer, AStormOfEventsLeavesNoNoteNoNaNAndNoAllocation) {
  const base::RandomStream random{support::test_seed(), 1, 2200};
  const auto patches = moving_patches();
  const std::uint64_t count = 100'000 / patches.size();
  for (const std::string& patch : patches) {
    const auto program = envelope_program(patch);
    auto player = std::move(EnvelopePlayer::create({}, program.get())).value();
    StormReport report;
    report.allocations = support::allocations_in([&] {
      for (std::uint64_t i = 0; i < count; ++i) {
        player->handle(storm_event(random, i, player->now()));
        hear(*player, report);
        player->render(random.bits(i) >> 40 & 15);
        if (i % 16 == 0) player->predict(64);
        check_values(*player, *program, report);
        hear(*player, report);
      }
      player->release_all();
      hear(*player, report);
      for (int i = 0; i < 3000; ++i) {
        player->render(64);
        hear(*player, report);
      }
    });
    EXPECT_EQ(report.allocations, 0) << patch;
    EXPECT_EQ(report.out_of_range, 0) << patch;
    for (const auto& channel : report.sounding) EXPECT_THAT(channel, testing::Each(0)) << patch;
    for (int voice = 0; voice < player->voices(); ++voice) {
      EXPECT_FALSE(player->voice(voice).is_active) << patch << voice;
    }
  }
}

TEST(EnvelopePlayer, WhatCannotBeIsRefused) {
  const auto program = envelope_program(kSwell);
  const auto code_of = [&](const EnvelopePlayerConfig& config) {
    const auto player = EnvelopePlayer::create(config, program.get());
    return player ? std::string("none") : std::string(to_string(player.error().code));
  };
  EXPECT_EQ(code_of({}), "none");
  EXPECT_EQ(code_of({.rate_hz = 7999}), "value_out_of_range");
  EXPECT_EQ(code_of({.rate_hz = std::nan("")}), "value_out_of_range");
  EXPECT_EQ(code_of({.most_ahead_samples = -1}), "value_out_of_range");
  EXPECT_EQ(code_of({.most_ahead_samples = 65537}), "value_out_of_range");
}

TEST(EnvelopePlayer, AKeyStruckTwiceEndsTwiceOnItsWayThrough) {
  EnvelopeRig rig(std::string("notes = 'thru'\n") + kSwell);
  rig.midi(1, 0x80, 60, 10);  // of nothing
  rig.midi(2, 0x90, 60, 1);
  rig.midi(3, 0x90, 60, 2);
  rig.midi(4, 0x80, 60, 11);
  rig.midi(5, 0x90, 60, 0);
  rig.midi(6, 0x80, 60, 12);
  rig.midi(7, 0x90, 61, 3);
  rig.midi(8, 0x90, 61, 4);
  rig.midi(9, 0xB0, 123, 0);
  rig.play(64);
  EXPECT_EQ(rig.told(),
            (std::vector<std::string>{"2 144 60 1", "3 144 60 2", "4 128 60 11", "5 128 60 64",
                                      "7 144 61 3", "8 144 61 4", "9 128 61 64"}));
}

}  // namespace
}  // namespace knotwave::engine

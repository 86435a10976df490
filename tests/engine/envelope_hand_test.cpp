// SPDX-License-Identifier: MIT
// What a hand does to an envelope patch that plays: set_target events, a gate of its own, and the
// end of everything.
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/envelope_generator.h"
#include "knotwave/engine/map_slots.h"
#include "knotwave/engine/voltage_mix.h"

#include "engine/envelope_rig.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

constexpr std::int64_t kGlide = 240;  // 5 ms at 48 kHz

Event target(double sample, int slot, double number) {
  Event event;
  event.kind = Event::Kind::set_target;
  event.midi.time = EnvelopeRig::time_of(sample);
  event.slot = static_cast<std::uint16_t>(slot);
  event.number = number;
  event.every_channel = true;
  return event;
}

const std::string kTurned =
    "[curves.climb]\ndegree = 1\npoints = [0, 1]\n[envelopes.climb]\ncurve = 'climb'\n"
    "seconds = 0.5\n[[outputs]]\nfrom = 'climb'\nto = 'cc7'\nrange = [110, 20]\nrest = 64\n"
    "[[outputs]]\nfrom = 'climb'\nto = 'cv'\nrange = [-2, 6]\n";

TEST(EnvelopeByHand, DepthTurnsAboutTheRestValueAndOffsetCountsInRanges) {
  EnvelopeRig plain(kTurned), rig(kTurned);
  for (EnvelopeRig* each : {&plain, &rig}) each->midi(100, 0x90, 60, 100);
  rig.add(target(50, kSlotOutputDepth, -0.75));
  rig.add(target(50, kSlotOutputOffset + 1, 0.5));
  plain.play(30000);
  rig.play(30000);
  EXPECT_EQ(rig.at(99, 0, 0), 64) << "at rest before the first gate, whatever is set";
  for (std::int64_t n = 100 + kGlide; n < 30000; ++n) {
    const double x = plain.at(n, 0, 0);
    ASSERT_NEAR(rig.at(n, 0, 0), 64 + 0.25 * (x - 64), 1e-12) << n;
    ASSERT_NEAR(rig.at(n, 0, 1), plain.at(n, 0, 1) + 0.5 * 8, 1e-12) << n;
  }
}

TEST(EnvelopeByHand, TargetsMoveTimesRatesAndFreeNumbers) {
  const std::string patch =
      "[curves.climb]\ndegree = 1\npoints = [0, 1]\n[envelopes.climb]\ncurve = 'climb'\n"
      "seconds = 0.5\n[[maps]]\nfrom = 'climb'\nto = 'free.x'\n"
      "[[outputs]]\nfrom = 'free.x'\nto = 'cv'\nof = [-10, 10]\nrange = [-10, 10]\n";
  EnvelopeRig rig(patch);
  rig.add(target(0, kSlotEnvelopeTime, -1));
  rig.midi(1000, 0x90, 60, 100);
  rig.add(target(20000, kSlotFree, 3));
  rig.play(30000);
  EXPECT_NEAR(rig.at(1000 + 6000), 0.5, 1e-9) << "a quarter of a second is the whole";
  EXPECT_NEAR(rig.at(19999), 1, 1e-12);
  EXPECT_NEAR(rig.at(20000 + kGlide + 1), 4, 1e-12) << "though nothing else moves any more";
  for (std::int64_t n = 20001; n < 20000 + kGlide; ++n) ASSERT_GE(rig.at(n), rig.at(n - 1));
}

TEST(EnvelopeByHand, NothingSetIsNothingChanged) {
  EnvelopeRig plain(kTurned), rig(kTurned);
  for (EnvelopeRig* each : {&plain, &rig}) {
    each->midi(100, 0x90, 60, 100);
    each->midi(9000, 0x90, 64, 50);
  }
  for (int slot = 0; slot <= kSlotGate; ++slot) rig.add(target(9500, slot, 0));
  rig.add(target(9600, kSlotOutputDepth, std::numeric_limits<double>::quiet_NaN()));
  plain.play(20000);
  rig.play(20000);
  EXPECT_EQ(rig.bits(), plain.bits());
}

TEST(EnvelopeByHand, ItsGateTakesTheTriggersPlace) {
  for (const char* trigger :
       {"", "mode = 'poly'\n", "mode = 'legato'\n", "[trigger]\nfrom = 'cc20'\n",
        "[trigger]\nfrom = 'clock'\n", "[trigger]\nfrom = 'loop'\n"}) {
    EnvelopeRig rig(std::string(trigger) + std::string(kSwell));
    rig.add(target(0, kSlotGateByHand, 1));
    rig.midi(100, 0x90, 60, 100);
    rig.midi(200, 0xB0, 20, 100);
    rig.play(60000);
    for (std::int64_t n = 55000; n < 60000; ++n) ASSERT_EQ(rig.at(n), 0) << trigger << n;
    rig.add(target(60000, kSlotGate, 90));
    rig.midi(62000, 0x80, 60, 0);
    rig.midi(62001, 0xB0, 123, 0);
    rig.midi(62002, 0xB0, 64, 127);
    rig.midi(62003, 0xB0, 64, 0);
    rig.midi(62004, 0xB0, 20, 0);
    rig.add(target(90000, kSlotGate, 0));
    rig.play(140000);
    for (std::int64_t n = 60000; n <= 90000; ++n) {
      const double u = std::min(static_cast<double>(n - 60000) / 48000, 0.4);
      ASSERT_NEAR(rig.at(n), swell(u), 1e-9) << trigger << n;
    }
    EXPECT_EQ(rig.at(139999), 0) << trigger;
    EXPECT_FALSE(rig.player().voice(0).is_active) << trigger;
  }
}

TEST(EnvelopeByHand, TheTriggerComesBackWithNothingHanging) {
  EnvelopeRig rig(kSwell);
  rig.midi(0, 0x90, 60, 100);
  rig.add(target(5000, kSlotGateByHand, 1));
  rig.add(target(6000, kSlotGate, 90));
  rig.add(target(9000, kSlotGateByHand, 0));
  rig.play(100000);
  EXPECT_FALSE(rig.player().voice(0).is_active) << "its key was heard before";
  rig.midi(100000, 0x90, 62, 100);
  rig.play(120000);
  EXPECT_TRUE(rig.player().voice(0).is_active);
  EnvelopeRig loop("[trigger]\nfrom = 'loop'\n" + std::string(kSwell));
  loop.add(target(5000, kSlotGateByHand, 1));
  loop.add(target(9000, kSlotGateByHand, 0));
  loop.play(100000);
  EXPECT_TRUE(loop.player().voice(0).is_active) << "a loop runs again";
}

TEST(EnvelopeByHand, ThruPassesNotesWhileTheHandHasTheGate) {
  EnvelopeRig rig("notes = 'thru'\n" + std::string(kSwell));
  rig.add(target(0, kSlotGateByHand, 1));
  rig.midi(100, 0x90, 61, 100);
  rig.midi(200, 0x80, 61, 10);
  rig.play(1000);
  EXPECT_EQ(rig.told(), (std::vector<std::string>{"100 144 61 100", "200 128 61 10"}));
}

TEST(EnvelopeByHand, TheSongIsWhereItIsSaidToBeAtItsSample) {
  EnvelopeRig rig(
      "[trigger]\nfrom = 'clock'\nbeats = 0.5\n"
      "[curves.spike]\ndegree = 1\npoints = [1, 0]\n[envelopes.spike]\n"
      "curve = 'spike'\nseconds = 0.01\nretrigger = 'restart'\n"
      "[[outputs]]\nfrom = 'spike'\nto = 'cv'\nrange = [0, 1]\n");
  rig.add(target(0, kSlotSongStops, 0));
  rig.add(target(10000, kSlotSong, 7.25));   // 24000 samples a quarter note
  rig.add(target(30000, kSlotSong, 0.499));  // back
  rig.add(target(34000, kSlotSong, 0.499 + 4000.0 / 24000 + 1e-4));
  rig.add(target(50000, kSlotSongStops, 0));
  rig.play(90000);
  std::vector<std::int64_t> openings;
  for (std::int64_t n = 1; n < 90000; ++n) {
    if (rig.at(n) > rig.at(n - 1) + 0.5) openings.push_back(n);
  }
  // 7.5 and 8 (of 10000), 0.5 (of 30000), 1 (of 34000), none while it stands.
  EXPECT_EQ(openings, (std::vector<std::int64_t>{16000, 28000, 30024, 42022}));
}

std::vector<std::string> patches() {
  const std::string moving =
      "[curves.hill]\ndegree = 2\npoints = [0, 1, 0.4, 0]\n[envelopes.hill]\ncurve = 'hill'\n"
      "seconds = 0.03\nsustain_at = 0.6\n[lfos.wave]\ncurve = 'sine'\nrate_hz = 60\n"
      "[[maps]]\nfrom = 'hill'\nto = 'free.x'\n[[maps]]\nfrom = 'wave'\nto = 'free.x'\n"
      "depth = 0.2\n[[outputs]]\nfrom = 'free.x'\nto = 'cc1'\n[[outputs]]\nfrom = 'hill'\n"
      "to = 'cv'\n[[outputs]]\nfrom = 'wave'\nto = 'bend'\nof = [-1, 1]\n";
  return {"mode = 'poly'\nnotes = 'mpe'\n" + moving, "notes = 'thru'\n" + moving,
          "[trigger]\nfrom = 'clock'\nbeats = 0.0625\n" + moving};
}

void add_storm(EnvelopeRig& rig) {
  const base::RandomStream random{support::test_seed(), 0, 77};
  double time = 0;
  for (std::uint64_t i = 0; i < 90; ++i) {
    time += 100 * random.unit(3 * i);
    const std::uint64_t bits = random.bits(3 * i + 1);
    const int key = 60 + static_cast<int>(bits & 3);
    if ((bits >> 4 & 1) == 0) {
      rig.midi(time, (bits >> 5 & 1) != 0 ? 0x90 : 0x80, key, 100);
    } else {
      constexpr std::array<int, 8> kSlots = {
          kSlotOutputDepth,  kSlotOutputDepth + 1, kSlotOutputOffset + 2, kSlotFree,
          kSlotEnvelopeTime, kSlotLfoRate,         kSlotGateByHand,       kSlotGate};
      const int slot = kSlots[bits >> 8 & 7];
      const double number = slot >= kSlotGateByHand ? static_cast<double>(bits >> 11 & 1) * 80
                                                    : random.bipolar(3 * i + 2);
      rig.add(target(time, slot, number));
    }
  }
}

TEST(EnvelopeByHand, AnySplitIntoBlocksGivesTheSameBits) {
  for (const std::string& patch : patches()) {
    EnvelopeRig whole(patch);
    add_storm(whole);
    whole.play(6000);
    for (std::size_t block = 1; block < 64; block += block < 10 ? 1 : 9) {
      EnvelopeRig split(patch);
      add_storm(split);
      split.play(6000, block);
      ASSERT_EQ(split.bits(), whole.bits()) << block << "\n" << patch;
    }
  }
}

TEST(EnvelopeByHand, WhatIsPredictedComes) {
  for (const std::string& patch : patches()) {
    for (std::int64_t at = 300; at < 5000; at += 611) {
      EnvelopeRig rig(patch, {.most_ahead_samples = 40});
      add_storm(rig);
      rig.play(at);
      rig.player().predict(40);
      std::vector<std::vector<double>> predicted;
      const int outputs = static_cast<int>(rig.program().outputs().size());
      for (int row = 0; row < rig.player().voices() * outputs; ++row) {
        const auto got = rig.player().values(row / outputs, row % outputs);
        predicted.emplace_back(got.end() - 40, got.end());
      }
      rig.player().render(40);
      for (std::size_t row = 0; row < predicted.size(); ++row) {
        const auto got =
            rig.player().values(static_cast<int>(row) / outputs, static_cast<int>(row) % outputs);
        ASSERT_TRUE(std::equal(got.begin(), got.end(), predicted[row].begin()))
            << patch << at << " row " << row;
      }
    }
  }
}

TEST(EnvelopeByHand, TheEndOfEverythingRestsLetsGoAndPlaysOn) {
  EnvelopeRig rig("notes = 'thru'\n" + std::string(kSwell) + "rest = 0.25\n");
  rig.midi(0, 0x90, 60, 100);
  rig.play(9000);
  EXPECT_GT(rig.at(8999), 0.5);
  const auto allocations = support::allocation_count();
  rig.player().end_all();
  EXPECT_EQ(support::allocation_count(), allocations);
  rig.play(12000);
  EXPECT_EQ(rig.told(), (std::vector<std::string>{"0 144 60 100", "9000 128 60 64"}));
  for (std::int64_t n = 9000; n < 12000; ++n) ASSERT_EQ(rig.at(n), 0.25);
  EXPECT_EQ(rig.player().newest_voice(), -1);
  rig.midi(12000, 0x90, 62, 100);
  rig.play(14000);
  EXPECT_NEAR(rig.at(13999), swell(1999.0 / 48000), 1e-9) << "from its start, not joined";
}

// The generator's voltages.

class Volts final : public GeneratorSink {
 public:
  void midi(int, const base::MidiEvent& event) KNOTWAVE_RT override { sent.push_back(event); }
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override {}
  void volts(int channel, std::int64_t first, std::span<const double> values) KNOTWAVE_RT override {
    auto& row = rows[channel];
    EXPECT_EQ(first, static_cast<std::int64_t>(row.size()));
    row.insert(row.end(), values.begin(), values.end());
  }
  std::map<int, std::vector<double>> rows;
  std::vector<base::MidiEvent> sent;
};

std::string gated(int channel, double place) {
  return std::string(kSwell) + "[[outputs]]\nfrom = 'swell'\nto = 'cv'\ncv_channel = 2\n" +
         "range = [0, 4]\n[[events]]\nenvelope = 'swell'\nat = " + std::to_string(place) +
         "\ngate = " + std::to_string(channel) + "\nvolts = 3\nseconds = 0.001\n";
}

TEST(EnvelopeGenerator, GivesEveryVoltageAtItsSample) {
  const auto program = envelope_program(gated(3, 0.05));
  const EnvelopePatchProgram* patches[] = {program.get()};
  for (const std::int64_t block : {1, 7, 64, 1000}) {
    auto generator = EnvelopeGenerator::create({}, patches);
    ASSERT_TRUE(generator);
    EXPECT_EQ((*generator)->voltage_channels(), 3u);
    Volts volts;
    EnvelopeRig rig(gated(3, 0.05));
    rig.midi(10.5, 0x90, 60, 100);
    base::MidiEvent note;
    note.time = EnvelopeRig::time_of(10.5);
    note.bytes[0] = 0x90;
    note.bytes[1] = 60;
    note.bytes[2] = 100;
    ASSERT_TRUE((*generator)->handle(note));
    for (std::int64_t at = 0; at < 6000; at += block) {
      (*generator)->advance(std::min<std::int64_t>(at + block, 6000), volts);
    }
    rig.play(6000);
    ASSERT_EQ(volts.rows.size(), 3u);
    for (std::int64_t n = 0; n < 6000; ++n) {
      const auto i = static_cast<std::size_t>(n);
      ASSERT_EQ(volts.rows[0][i], 0);
      ASSERT_EQ(volts.rows[1][i], rig.at(n, 0, 1)) << n;
      const double passed = static_cast<double>(n) - 10.5 - 0.05 * 48000;
      ASSERT_EQ(volts.rows[2][i], passed >= 0 && passed < 48 ? 3 : 0) << n;
    }
  }
}

TEST(EnvelopeGenerator, WithoutALeadAnySplitGivesTheSameNotesOfPlaces) {
  const auto program = envelope_program(std::string(kSwell) +
                                        "[[events]]\nenvelope = 'swell'\nat = 0.05\nnote = 37\n" +
                                        "seconds = 0.0012345\n");
  const EnvelopePatchProgram* patches[] = {program.get()};
  std::vector<base::MidiEvent> whole;
  for (const std::int64_t block : {6000, 1, 7, 48, 64, 480}) {
    auto generator = EnvelopeGenerator::create({.lead_s = 0}, patches);
    ASSERT_TRUE(generator);
    Volts sink;
    for (int i = 0; i < 4; ++i) {
      base::MidiEvent note;
      note.time = EnvelopeRig::time_of(10.3 + 1301.7 * i);
      note.bytes[0] = 0x90;
      note.bytes[1] = static_cast<std::uint8_t>(60 + i);
      note.bytes[2] = 100;
      ASSERT_TRUE((*generator)->handle(note));
    }
    for (std::int64_t at = 0; at < 9000; at += block) (*generator)->advance(at + block, sink);
    std::erase_if(sink.sent, [](const auto& event) { return event.time.sample >= 9000; });
    if (whole.empty()) whole = sink.sent;
    ASSERT_EQ(sink.sent.size(), whole.size()) << block;
    EXPECT_GT(whole.size(), 1u);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_EQ(sink.sent[i].time, whole[i].time) << block << " message " << i;
      ASSERT_EQ(sink.sent[i].bytes[0], whole[i].bytes[0]);
    }
  }
}

TEST(EnvelopeGenerator, EndsAllAndPlaysOn) {
  const auto program = envelope_program(
      "notes = 'thru'\n[curves.climb]\ndegree = 1\npoints = [0, 1]\n[envelopes.climb]\n"
      "curve = 'climb'\nseconds = 0.5\n[[outputs]]\nfrom = 'climb'\nto = 'cc74'\nrest = 30\n");
  const EnvelopePatchProgram* patches[] = {program.get()};
  auto generator = EnvelopeGenerator::create({}, patches);
  ASSERT_TRUE(generator);
  Volts sink;
  base::MidiEvent note;
  note.bytes[0] = 0x90;
  note.bytes[1] = 60;
  note.bytes[2] = 100;
  ASSERT_TRUE((*generator)->handle(note));
  (*generator)->advance(24000, sink);
  const std::size_t before = sink.sent.size();
  (*generator)->end_all();
  (*generator)->advance(30000, sink);
  std::map<int, int> told;  // status and number: value
  for (std::size_t i = before; i < sink.sent.size(); ++i) {
    told[sink.sent[i].bytes[0] << 8 | sink.sent[i].bytes[1]] = sink.sent[i].bytes[2];
  }
  EXPECT_EQ(told, (std::map<int, int>{{0x803C, 64}, {0xB04A, 30}}));
  EXPECT_FALSE((*generator)->is_at_rest());
  note.time.sample = 30000;
  ASSERT_TRUE((*generator)->handle(note));
  (*generator)->advance(60000, sink);
  EXPECT_EQ(sink.sent.back().bytes[2], 127);
}

}  // namespace
}  // namespace knotwave::engine

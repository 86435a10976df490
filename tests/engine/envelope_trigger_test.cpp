// SPDX-License-Identifier: MIT
// What opens and closes the gates of an envelope player, and what it tells: triggers, modes, MPE in
// and out, places.
#include <array>
#include <functional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "engine/envelope_rig.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using testing::ElementsAre;

// 1 while the gate is open; it falls to 0 within the sample after it closed.
constexpr const char* kGate =
    "[curves.gate]\ndegree = 1\npoints = [1, 1, 0, 0]\nknots = [0, 0, 0.5, 0.501, 1, 1]\n"
    "[envelopes.gate]\ncurve = 'gate'\nseconds = 0.001\nsustain_at = 0.5\n"
    "retrigger = 'restart'\n[[outputs]]\nfrom = 'gate'\nto = 'osc'\naddress = '/a'\n";

// The key of the gate that is open, and how often one opened.
constexpr const char* kKeys =
    "[curves.ramp]\ndegree = 1\npoints = [0, 1]\n"
    "[envelopes.ramp]\ncurve = 'ramp'\nseconds = 1\nretrigger = 'restart'\n"
    "[[maps]]\nfrom = 'key'\nto = 'free.key'\ndepth = 127\nsmooth_s = 0\n"
    "[[outputs]]\nfrom = 'ramp'\nto = 'osc'\naddress = '/a'\n"
    "[[outputs]]\nfrom = 'free.key'\nto = 'osc'\naddress = '/b'\nof = [0, 127]\nrange = [0, 127]\n";

/// Where a gate opened and closed: "100+ 200-".
std::string edges(const EnvelopeRig& rig) {
  std::string text;
  bool was_open = false;
  for (std::size_t n = 0; n < rig.values().size(); ++n) {
    const bool is_open = rig.values()[n] > 0.5;
    if (is_open == was_open) continue;
    was_open = is_open;
    text += text.empty() ? "" : " ";
    text += is_open ? std::to_string(n) + "+" : std::to_string(n - 1) + "-";
  }
  return text;
}

std::string gate_edges(const std::string& trigger, std::int64_t until,
                       const std::function<void(EnvelopeRig&)>& play) {
  EnvelopeRig rig(std::string(kGate) + "[trigger]\n" + trigger);
  play(rig);
  rig.play(until);
  return edges(rig);
}

// Triggers.

Event choke(std::int64_t sample, int channel, int key) {
  Event event;
  event.kind = Event::Kind::choke;
  event.midi.time.sample = sample;
  event.midi.bytes[0] = static_cast<std::uint8_t>(channel);
  event.midi.bytes[1] = static_cast<std::uint8_t>(key);
  return event;
}

TEST(EnvelopeTrigger, AChokeClosesTheGateOfItsKeyWhateverHoldsIt) {
  const auto choked_at = [](int channel, int key) {
    return gate_edges("", 1000, [&](EnvelopeRig& rig) {
      rig.midi(0, 0xB0, 64, 127);
      rig.midi(100, 0x90, 60, 100);
      rig.midi(200, 0x90, 64, 100);
      rig.midi(300, 0x80, 64, 0);
      rig.add(choke(400, channel, key));
    });
  };
  EXPECT_EQ(choked_at(0, 61), "100+");
  EXPECT_EQ(choked_at(1, 60), "100+");
  EXPECT_EQ(choked_at(0, 60), "100+ 400-");
  EXPECT_EQ(choked_at(0, Event::kEveryKey), "100+ 400-");
}

TEST(EnvelopeTrigger, NotesOfItsChannelAndKeysAlone) {
  EXPECT_EQ(gate_edges("channel = 3\nkeys = [40, 50]\n", 1000,
                       [](EnvelopeRig& rig) {
                         rig.midi(100, 0x90, 45, 100);  // channel 1
                         rig.midi(200, 0x92, 39, 100);
                         rig.midi(300, 0x92, 40, 100);
                         rig.midi(350, 0x80, 40, 64);
                         rig.midi(400, 0x92, 40, 0);
                         rig.midi(500, 0x92, 50, 1);
                         rig.midi(600, 0x82, 50, 64);
                         rig.midi(700, 0x92, 51, 100);
                       }),
            "300+ 400- 500+ 600-");
}

TEST(EnvelopeTrigger, AControllerFromItsThresholdOnOnAnyChannel) {
  EXPECT_EQ(gate_edges("from = 'cc20'\nthreshold = 100\n", 1000,
                       [](EnvelopeRig& rig) {
                         rig.midi(100, 0xB0, 20, 99);
                         rig.midi(200, 0xB0, 20, 100);
                         rig.midi(250, 0xB0, 20, 127);
                         rig.midi(300, 0xB5, 20, 100);  // another channel holds it too
                         rig.midi(400, 0xB0, 20, 0);
                         rig.midi(500, 0xB5, 20, 99);
                         rig.midi(600, 0x90, 60, 100);  // no note opens it
                       }),
            "200+ 500-");
}

TEST(EnvelopeTrigger, ThePedalAndItsReset) {
  EXPECT_EQ(gate_edges("from = 'pedal'\nchannel = 1\n", 1000,
                       [](EnvelopeRig& rig) {
                         rig.midi(50, 0xB1, 64, 127);
                         rig.midi(100, 0xB0, 64, 64);
                         rig.midi(200, 0xB0, 64, 63);
                         rig.midi(300, 0xB0, 64, 127);
                         rig.midi(400, 0xB0, 121, 0);  // reset all controllers
                       }),
            "100+ 200- 300+ 400-");
}

TEST(EnvelopeTrigger, AClockDivisionToTheSample) {
  EXPECT_EQ(gate_edges("from = 'clock'\nbeats = 0.5\noffset_beats = 0.25\ngate = 0.25\n", 60000,
                       [](EnvelopeRig&) {}),
            "6000+ 9000- 18000+ 21000- 30000+ 33000- 42000+ 45000- 54000+ 57000-");
}

TEST(EnvelopeTrigger, AClockDivisionFollowsTheTempo) {
  // 24000 samples a quarter, from sample 12000 on 12000: the quarter at 1 comes at 18000.
  EXPECT_EQ(gate_edges("from = 'clock'\nbeats = 1\ngate = 0.5\n", 50000,
                       [](EnvelopeRig& rig) { rig.tempo(6000, 250000); }),
            "0+ 9000- 15000+ 21000- 27000+ 33000- 39000+ 45000-");
}

// Against exact arithmetic, at tempi that are no whole number of samples.
TEST(EnvelopeTrigger, ClockDivisionsStayInTimeOverAnHour) {
  constexpr std::int64_t kMicroseconds = 461539;  // 130 bpm, rounded
  EnvelopeRig rig(std::string(kGate) + "[trigger]\nfrom = 'clock'\nbeats = 0.25\ngate = 0.5\n");
  rig.tempo(0, kMicroseconds);
  EnvelopePlayer& player = rig.player();
  Event tempo;
  tempo.kind = Event::Kind::tempo;
  tempo.microseconds_per_quarter = kMicroseconds;
  player.handle(tempo);
  std::int64_t opened = 0;
  bool was_open = false;
  for (std::int64_t n = 0; n < 3600 * 48000LL; n += 64) {
    player.render(64);
    for (std::int64_t i = 0; i < 64; ++i) {
      const bool is_open = player.values(0, 0)[static_cast<std::size_t>(i)] > 0.5;
      if (is_open && !was_open) {
        // The first sample at or after opened / 4 quarters of 461539 us.
        const std::int64_t exact = (opened * kMicroseconds * 48 + 3999) / 4000;
        ASSERT_EQ(n + i, exact) << opened;
        ++opened;
      }
      was_open = is_open;
    }
  }
  EXPECT_EQ(opened, 3600 * 4 * 1000000LL / kMicroseconds + 1);
}

TEST(EnvelopeTrigger, AShareOfOneNeverClosesAndOneOfZeroIsATouch) {
  EXPECT_EQ(gate_edges("from = 'clock'\nbeats = 0.5\ngate = 1\n", 30000, [](EnvelopeRig&) {}),
            "0+");
  EnvelopeRig rig(std::string(kKeys) + "[trigger]\nfrom = 'clock'\nbeats = 0.5\ngate = 0\n");
  rig.play(30000);
  EXPECT_NEAR(rig.at(11999), 11999 / 48000.0, 1e-9) << "it plays to its end all the same";
  EXPECT_EQ(rig.at(12000), 0);
}

TEST(EnvelopeTrigger, SongsStartStopContinueAndArePlaced) {
  const std::string clock = "from = 'clock'\nbeats = 1\ngate = 0.5\n";
  EXPECT_EQ(gate_edges(clock, 60000,
                       [](EnvelopeRig& rig) {
                         rig.midi(5000, 0xFC);   // closes the gate
                         rig.midi(20000, 0xFA);  // from the beginning
                         rig.midi(40000, 0xFC);
                       }),
            "0+ 5000- 20000+ 32000-");
  EXPECT_EQ(gate_edges(clock, 60000,
                       [](EnvelopeRig& rig) {
                         rig.midi(18000, 0xFC);  // at 0.75
                         rig.midi(30000, 0xFB);  // the quarter at 1 is 6000 later
                       }),
            "0+ 12000- 36000+ 48000-");
  EXPECT_EQ(gate_edges(clock, 60000,
                       [](EnvelopeRig& rig) {
                         rig.midi(1000, 0xFC);
                         rig.midi(1500, 0xF2, 7, 0);  // 7 sixteenths: 1.75 quarters
                         rig.midi(2000, 0xFB);
                       }),
            "0+ 1000- 8000+ 20000- 32000+ 44000- 56000+");
}

TEST(EnvelopeTrigger, WhereClocksRunTheSongBeginsWithTheOneAfterStart) {
  EXPECT_EQ(gate_edges("from = 'clock'\nbeats = 1\ngate = 0.5\n", 30000,
                       [](EnvelopeRig& rig) {
                         rig.midi(10, 0xFC);
                         for (int i = 1; i < 30; ++i) {
                           if (i == 10) rig.midi(1000 * i - 500, 0xFA);
                           rig.midi(1000 * i, 0xF8);
                         }
                       }),
            "0+ 10- 10000+ 22000-");
}

TEST(EnvelopeTrigger, ALoopRunsFromTheStartToTheEnd) {
  EnvelopeRig rig(std::string(kGate) + "[trigger]\nfrom = 'loop'\n");
  rig.midi(100, 0x90, 60, 100);
  rig.play(1000);
  EXPECT_EQ(edges(rig), "0+");
  rig.player().release_all();
  rig.play(2000);
  EXPECT_EQ(edges(rig), "0+ 1000-");
  rig.midi(3000, 0xFA);
  rig.play(4000);
  EXPECT_EQ(edges(rig), "0+ 1000- 3000+");
}

TEST(EnvelopeTrigger, AProgramChangeSelectsThePatchForTheNotesThatFollow) {
  EXPECT_EQ(gate_edges("program = 3\n", 2000,
                       [](EnvelopeRig& rig) {
                         rig.midi(100, 0x90, 60, 100);
                         rig.midi(150, 0x80, 60, 64);
                         rig.midi(200, 0xC0, 3);
                         rig.midi(300, 0x90, 60, 100);
                         rig.midi(400, 0xC0, 4);  // held keys play on
                         rig.midi(500, 0x80, 60, 64);
                         rig.midi(600, 0x90, 60, 100);
                       }),
            "300+ 500-");
  EXPECT_EQ(gate_edges("from = 'loop'\nprogram = 3\nchannel = 2\n", 2000,
                       [](EnvelopeRig& rig) {
                         rig.midi(100, 0xC0, 3);
                         rig.midi(200, 0xC1, 3);
                         rig.midi(300, 0xC1, 0);
                       }),
            "200+ 300-");
}

// Modes.

TEST(EnvelopeMode, MonoRetriggersAndGoesBackToWhatIsHeld) {
  EnvelopeRig rig(kKeys);
  rig.midi(100, 0x90, 60, 100);
  rig.midi(200, 0x90, 64, 100);
  rig.midi(300, 0x80, 64, 64);
  rig.midi(400, 0x80, 60, 64);
  rig.play(1000);
  EXPECT_EQ(rig.at(250, 0, 1), 64);
  EXPECT_EQ(rig.at(350, 0, 1), 60);
  EXPECT_EQ(rig.at(200), 0);
  EXPECT_EQ(rig.at(300), 0);
  EXPECT_NEAR(rig.at(350), 50 / 48000.0, 1e-12);
  EXPECT_EQ(rig.player().voices(), 1);
  EXPECT_EQ(rig.player().voice(0).note, 3u);
}

TEST(EnvelopeMode, LegatoGoesOnUnderANewKey) {
  EnvelopeRig rig("mode = 'legato'\n" + std::string(kKeys));
  rig.midi(100, 0x90, 60, 100);
  rig.midi(200, 0x90, 64, 100);
  rig.midi(300, 0x80, 60, 64);
  rig.midi(400, 0x80, 64, 64);
  rig.midi(500, 0x90, 67, 100);
  rig.play(1000);
  EXPECT_EQ(rig.at(250, 0, 1), 64);
  EXPECT_NEAR(rig.at(399), 299 / 48000.0, 1e-12);
  EXPECT_EQ(rig.at(500), 0) << "after all keys were up it begins again";
  EXPECT_EQ(rig.player().voice(0).note, 2u);
  EXPECT_EQ(rig.player().voice(0).key, 67);
}

TEST(EnvelopeMode, PriorityChoosesAmongHeldKeysOfAllChannels) {
  for (const auto& [priority, keys] : {std::pair("last", std::vector<int>{60, 55, 67, 67, 60}),
                                       {"low", {60, 55, 55, 60, 60}},
                                       {"high", {60, 60, 67, 67, 60}}}) {
    EnvelopeRig rig("priority = '" + std::string(priority) + "'\n" + kKeys);
    rig.midi(100, 0x90, 60, 100);
    rig.midi(200, 0x91, 55, 100);
    rig.midi(300, 0x92, 67, 100);
    rig.midi(400, 0x81, 55, 64);
    rig.midi(500, 0x82, 67, 64);
    rig.play(600);
    for (int i = 0; i < 5; ++i) {
      EXPECT_EQ(rig.at(150 + 100 * i, 0, 1), keys[static_cast<std::size_t>(i)]) << priority << i;
    }
  }
}

TEST(EnvelopeMode, PedalsHoldWhatKeysLetGo) {
  for (const char* mode : {"mode = 'mono'\n", "mode = 'poly'\npolyphony = 1\n"}) {
    EnvelopeRig rig(mode + std::string(kGate));
    rig.midi(100, 0x90, 60, 100);
    rig.midi(150, 0xB0, 64, 127);
    rig.midi(200, 0x80, 60, 64);
    rig.midi(300, 0xB0, 64, 0);
    rig.midi(400, 0x90, 60, 100);
    rig.midi(450, 0xB0, 66, 127);  // sostenuto catches what is down
    rig.midi(500, 0x80, 60, 64);
    rig.midi(600, 0xB0, 66, 0);
    rig.midi(700, 0x90, 60, 100);
    rig.midi(800, 0xB0, 123, 0);
    rig.midi(900, 0x90, 60, 100);
    rig.midi(910, 0xB0, 64, 127);
    rig.midi(950, 0xB0, 120, 0);  // whatever pedals hold
    rig.play(1100);
    EXPECT_EQ(edges(rig), "100+ 300- 400+ 600- 700+ 800- 900+ 950-") << mode;
  }
}

TEST(EnvelopeMode, KeysOfManyChannelsLetGoAtOnceOpenNoGateBetween) {
  for (const int how : {0, 1, 2}) {
    EnvelopeRig rig(kKeys);
    for (int channel = 0; channel < 5; ++channel) {
      rig.midi(100 + channel, 0x90 + channel, 60 + channel, 100);
    }
    Event event;
    event.midi.time.sample = 200;
    if (how == 0) event.kind = Event::Kind::all_notes_off;
    event.midi.bytes[0] = 0xFF;
    if (how < 2) rig.add(event);
    rig.play(210);
    if (how == 2) rig.player().release_all();
    rig.play(300);
    EXPECT_EQ(rig.player().voice(0).note, 5u) << how;
    EXPECT_EQ(rig.player().voice(0).key, 64) << how;
    EXPECT_NEAR(rig.at(299), 195 / 48000.0, 1e-12) << "it ran on; " << how;
  }
}

TEST(EnvelopeMode, PolyPlaysEachNoteInAVoiceAndStealsTheOldest) {
  EnvelopeRig rig("mode = 'poly'\npolyphony = 2\n" + std::string(kKeys));
  rig.midi(100, 0x90, 60, 100);
  rig.midi(200, 0x92, 64, 100);
  rig.play(250);
  EXPECT_EQ(rig.at(249, 0, 1), 60);
  EXPECT_EQ(rig.at(249, 1, 1), 64);
  EXPECT_EQ(rig.at(150, 1, 1), 0) << "at rest until it begins";
  EXPECT_EQ(rig.player().newest_voice(), 1);
  EXPECT_EQ(rig.player().voice(1).channel, 3);
  rig.midi(300, 0x90, 67, 100);
  rig.play(350);
  EXPECT_EQ(rig.at(349, 0, 1), 67) << "the oldest";
  EXPECT_EQ(rig.player().newest_voice(), 0);
  rig.midi(400, 0x80, 60, 64);  // stolen: nobody's
  rig.midi(500, 0x80, 67, 64);
  rig.midi(600, 0x90, 70, 100);
  rig.play(700);
  EXPECT_EQ(rig.at(699, 0, 1), 70) << "one that was let go before one that is held";
  EXPECT_EQ(rig.at(699, 1, 1), 64);
}

// MPE.

TEST(EnvelopeMpe, MembersOfAZoneHaveTheirOwnPressureAndTheMasterSpeaksForAll) {
  EnvelopeRig rig(
      "mode = 'poly'\npolyphony = 2\n[trigger]\nchannel = 1\n"
      "[[maps]]\nfrom = 'pressure'\nto = 'free.p'\nsmooth_s = 0\n"
      "[[maps]]\nfrom = 'mod'\nto = 'free.m'\nsmooth_s = 0\n"
      "[[outputs]]\nfrom = 'free.p'\nto = 'pressure'\nchannel = 'note'\n"
      "[[outputs]]\nfrom = 'free.m'\nto = 'cc1'\n");
  for (const auto& [controller, value] : {std::pair(101, 0), {100, 6}, {6, 4}}) {
    rig.midi(0, 0xB0, controller, value);
  }
  rig.midi(10, 0x91, 60, 100);
  rig.midi(20, 0x92, 64, 100);
  rig.midi(30, 0xD1, 100);
  rig.midi(40, 0xD2, 50);
  rig.midi(50, 0xB0, 1, 127);
  rig.midi(60, 0x97, 64, 100);  // no member of the zone
  rig.play(500);
  EXPECT_EQ(rig.at(499, 0, 0), 100);
  EXPECT_EQ(rig.at(499, 1, 0), 50);
  EXPECT_EQ(rig.at(499, 0, 1), 127);
  EXPECT_EQ(rig.at(499, 1, 1), 127);
  EXPECT_EQ(rig.player().voice(0).channel, 2);
  EXPECT_EQ(rig.player().voice(1).channel, 3);
}

TEST(EnvelopeMpe, NotesGoOutOnTheMemberChannelThatHasBeenFreeLongest) {
  EnvelopeRig rig("mode = 'poly'\npolyphony = 3\nnotes = 'mpe'\n" + std::string(kGate));
  rig.midi(100, 0x90, 60, 100);
  rig.midi(200, 0x90, 64, 101);
  rig.midi(300, 0x80, 60, 10);
  rig.midi(1300, 0x90, 67, 102);
  rig.midi(1400, 0x90, 60, 103);
  rig.midi(1500, 0x90, 72, 104);  // steals the oldest, 64 on channel 3
  rig.midi(1600, 0x80, 64, 11);   // nobody's any more
  rig.midi(1700, 0x80, 72, 12);
  rig.play(2000);
  EXPECT_THAT(rig.told(), ElementsAre("100 145 60 100", "200 146 64 101", "300 129 60 10",
                                      "1300 147 67 102", "1400 148 60 103", "1500 130 64 64",
                                      "1500 149 72 104", "1700 133 72 12"));
}

TEST(EnvelopeMpe, ChannelsGoRoundAndNoTwoSoundingNotesShareOne) {
  EnvelopeRig rig("mode = 'poly'\npolyphony = 15\nnotes = 'mpe'\n" + std::string(kGate));
  const base::RandomStream random{support::test_seed(), 2, 2200};
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const std::uint64_t bits = random.bits(i);
    rig.midi(static_cast<double>(10 * i), (bits & 1) != 0 ? 0x90 : 0x80,
             40 + static_cast<int>(bits >> 8) % 30, 100);
  }
  rig.play(41000);
  std::array<int, 17> sounding{};
  std::array<int, 17> used{};
  for (const PlayerMessage& message : rig.messages()) {
    const auto channel = static_cast<std::size_t>(message.midi.channel()) + 1;
    ASSERT_GE(channel, 2u);
    const bool is_on = message.midi.status() == base::MidiStatus::note_on;
    EXPECT_EQ(sounding[channel], is_on ? 0 : 1);
    sounding[channel] = is_on;
    used[channel] += is_on;
  }
  for (std::size_t channel = 2; channel <= 16; ++channel) EXPECT_GT(used[channel], 20) << channel;
}

TEST(EnvelopeNotes, ThruPassesTheNotesThatAreHeardAsTheyAreAndEndsEachOne) {
  EnvelopeRig rig("notes = 'thru'\n" + std::string(kGate) + "[trigger]\nkeys = [40, 80]\n");
  rig.midi(100, 0x93, 60, 99);
  rig.midi(150, 0x93, 30, 99);
  rig.midi(200, 0x83, 60, 13);
  rig.midi(250, 0x83, 60, 13);
  rig.midi(300, 0x90, 62, 1);
  rig.midi(400, 0xB0, 123, 0);
  rig.midi(500, 0x80, 62, 64);
  rig.play(600);
  EXPECT_THAT(rig.told(),
              ElementsAre("100 147 60 99", "200 131 60 13", "300 144 62 1", "400 128 62 64"));
}

TEST(EnvelopeNotes, ReleaseAllLetsGoOfEveryNoteThatWentOut) {
  for (const char* notes : {"notes = 'thru'\n", "notes = 'mpe'\n"}) {
    EnvelopeRig rig("mode = 'poly'\n" + std::string(notes) + kGate);
    rig.midi(100, 0x90, 60, 100);
    rig.midi(110, 0xB0, 64, 127);
    rig.midi(200, 0x91, 64, 100);
    rig.play(300);
    rig.player().release_all();
    const auto told = rig.player().take_messages();
    ASSERT_EQ(told.size(), 2u) << notes;
    for (const PlayerMessage& message : told) {
      EXPECT_EQ(message.midi.status(), base::MidiStatus::note_off);
      EXPECT_EQ(message.midi.time.sample, 300);
    }
    rig.play(2000);
    EXPECT_TRUE(rig.player().is_still());
    rig.midi(2000, 0x90, 70, 100);
    rig.play(2100);
    EXPECT_TRUE(rig.player().voice(rig.player().newest_voice()).is_active);
  }
}

// Places.

constexpr double kMicrosecond = 0.048;  // in samples

double time_of(const PlayerMessage& message) {
  return static_cast<double>(message.midi.time.sample) + message.midi.time.fraction * 0x1p-32;
}

TEST(EnvelopePlaces, APlaceAndTheEndAreToldOnceAtTheirExactTime) {
  EnvelopeRig rig(std::string(kSwell) +
                  "[[events]]\nenvelope = 'swell'\nat = 0.123\nnote = 40\nchannel = 10\n"
                  "velocity = 90\nseconds = 0.005\n"
                  "[[events]]\nenvelope = 'swell'\nat = 0.4\ngate = 2\n"
                  "[[events]]\nenvelope = 'swell'\nat = 'end'\nnote = 41\n"
                  "[[events]]\nenvelope = 'swell'\nat = 0\nnote = 42\n");
  rig.midi(1000.375, 0x90, 60, 100);
  rig.midi(30000.75, 0x80, 60, 64);
  rig.play(90000);
  const double expected[] = {1000.375,
                             1000.375 + 480,
                             1000.375 + 0.123 * 48000,
                             1000.375 + 0.123 * 48000 + 240,
                             1000.375 + 0.4 * 48000,
                             1000.375 + 0.4 * 48000 + 480,
                             30000.75 + 0.6 * 48000,
                             30000.75 + 0.6 * 48000 + 480};
  const int events[] = {3, 3, 0, 0, 1, 1, 2, 2};
  ASSERT_EQ(rig.messages().size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(time_of(rig.messages()[i]), expected[i], 1e-3 * kMicrosecond) << i;
    EXPECT_EQ(rig.messages()[i].place_event, events[i]) << i;
  }
  EXPECT_EQ(rig.messages()[2].midi.bytes[0], 0x99);
  EXPECT_EQ(rig.messages()[2].midi.bytes[1], 40);
  EXPECT_EQ(rig.messages()[2].midi.bytes[2], 90);
  EXPECT_EQ(rig.messages()[3].midi.bytes[0], 0x89);
  EXPECT_EQ(rig.messages()[4].kind, PlayerMessage::Kind::place_gate);
  EXPECT_EQ(rig.messages()[4].midi.bytes[2], 1);
  EXPECT_EQ(rig.messages()[5].midi.bytes[2], 0);
}

TEST(EnvelopePlaces, ALoopTellsEveryTimeRoundAndItsPlacesOnceACycle) {
  EnvelopeRig rig(
      "[curves.wave]\ndegree = 1\npoints = [0, 1, 0]\n"
      "[envelopes.wave]\ncurve = 'wave'\nseconds = 0.1\nloop = [0.2, 0.7]\n"
      "[[events]]\nenvelope = 'wave'\nat = 'loop'\nnote = 1\nseconds = 0.001\n"
      "[[events]]\nenvelope = 'wave'\nat = 0.5\nnote = 2\nseconds = 0.001\n"
      "[[events]]\nenvelope = 'wave'\nat = 0.1\nnote = 3\nseconds = 0.001\n"
      "[[events]]\nenvelope = 'wave'\nat = 0.9\nnote = 4\nseconds = 0.001\n"
      "[[events]]\nenvelope = 'wave'\nat = 'end'\nnote = 5\nseconds = 0.001\n");
  constexpr double kBegin = 77.3;
  rig.midi(kBegin, 0x90, 60, 100);
  rig.midi(kBegin + 4800 * 1.45, 0x80, 60, 64);  // at 0.45 of the second time round
  rig.play(20000);
  std::vector<std::pair<int, double>> ons;
  for (const PlayerMessage& message : rig.messages()) {
    if (message.midi.status() != base::MidiStatus::note_on) continue;
    ons.emplace_back(message.midi.bytes[1], (time_of(message) - kBegin) / 4800);
  }
  // It is let go at 1.45 and goes on from the loop's end, 0.7.
  const std::pair<int, double> expected[] = {{3, 0.1}, {2, 0.5},        {1, 0.7},       {2, 1.0},
                                             {1, 1.2}, {4, 1.45 + 0.2}, {5, 1.45 + 0.3}};
  ASSERT_EQ(ons.size(), std::size(expected));
  for (std::size_t i = 0; i < ons.size(); ++i) {
    EXPECT_EQ(ons[i].first, expected[i].first) << i;
    EXPECT_NEAR(ons[i].second * 4800, expected[i].second * 4800, 1e-2 * kMicrosecond) << i;
  }
}

TEST(EnvelopePlaces, ANoteThatStillSoundsEndsBeforeItIsStruckAgain) {
  EnvelopeRig rig(
      "[curves.wave]\ndegree = 1\npoints = [0, 1]\n"
      "[envelopes.wave]\ncurve = 'wave'\nseconds = 0.01\nloop = [0, 1]\n"
      "[trigger]\nfrom = 'loop'\n"
      "[[events]]\nenvelope = 'wave'\nat = 'loop'\nnote = 1\nseconds = 0.0125\n");
  rig.play(1200);
  rig.player().release_all();
  EXPECT_THAT(rig.told(), ElementsAre("480 144 1 100", "960 128 1 64", "960 144 1 100"));
  const auto last = rig.player().take_messages();
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0].midi.bytes[0], 0x80) << "released at once";
}

// A loop shorter than a sample passes its place at most once a sample.
TEST(EnvelopePlaces, AMinuteLoopIsToldOnceASampleAtMost) {
  EnvelopeRig rig(
      "[curves.wave]\ndegree = 1\npoints = [0, 1]\n"
      "[envelopes.wave]\ncurve = 'wave'\nseconds = 0.0001\nloop = [0, 0.001]\n"
      "[trigger]\nfrom = 'loop'\n"
      "[[events]]\nenvelope = 'wave'\nat = 'loop'\ngate = 1\nseconds = 0.0001\n");
  rig.play(640);
  std::int64_t last = -1;
  int ons = 0;
  for (const PlayerMessage& message : rig.messages()) {
    if (message.midi.bytes[2] == 0) continue;
    EXPECT_GE(message.midi.time.sample, last);
    last = message.midi.time.sample;
    ++ons;
  }
  EXPECT_GT(ons, 600);
  EXPECT_LE(ons, 641);
}

}  // namespace
}  // namespace knotwave::engine

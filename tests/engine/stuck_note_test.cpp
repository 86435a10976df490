// SPDX-License-Identifier: MIT
// Every way notes are known to get stuck, each played and then listened to for silence.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"

#include "scenes.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

class StuckNote : public testing::Test {
 protected:
  void use(std::string_view patch) {
    bank_ = bank_from(patch);
    engine_ = engine_for(*bank_, {.max_voices = 32});
  }
  /// Plays and says how many voices sound half a second later (releases take 50 ms).
  int voices_after(const std::vector<Event>& events) {
    const std::int64_t last = events.empty() ? 0 : events.back().time().sample;
    play(*engine_, events, static_cast<std::size_t>(last - engine_->now() + 24000));
    return engine_->counters().voices_now;
  }
  std::unique_ptr<const BankProgram> bank_;
  std::unique_ptr<Engine> engine_;
};

class StuckNoteInMode : public StuckNote, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override { use(with(kPlain, std::string("mode = \"") + GetParam() + "\"")); }
};
INSTANTIATE_TEST_SUITE_P(Modes, StuckNoteInMode, testing::Values("poly", "mono", "legato"));

TEST_P(StuckNoteInMode, AHeldKeySoundsUntilItIsLifted) {
  EXPECT_EQ(voices_after({on(0, 0, 60)}), 1);
  EXPECT_EQ(voices_after({off(30000, 0, 60)}), 0);
}

TEST_P(StuckNoteInMode, NoteOnWithVelocityZeroIsANoteOff) {
  EXPECT_EQ(voices_after({on(0, 0, 60), on(100, 0, 60, 0)}), 0);
}

TEST_P(StuckNoteInMode, ANoteOffBeforeItsNoteOnIsForgotten) {
  EXPECT_EQ(voices_after({off(0, 0, 60), on(1, 0, 60)}), 1);
  EXPECT_EQ(voices_after({off(30000, 0, 60)}), 0);
}

TEST_P(StuckNoteInMode, SustainHoldsAndLetsGo) {
  EXPECT_EQ(voices_after({control(0, 0, kSustain, 127), on(1, 0, 60), off(2, 0, 60)}), 1);
  EXPECT_EQ(voices_after({control(30000, 0, kSustain, 0)}), 0);
}

TEST_P(StuckNoteInMode, SustainReleasedWhileTheKeyIsDownKeepsTheNote) {
  EXPECT_EQ(voices_after({on(0, 0, 60), control(1, 0, kSustain, 127), control(2, 0, kSustain, 0)}),
            1);
  EXPECT_EQ(voices_after({off(30000, 0, 60)}), 0);
}

TEST_P(StuckNoteInMode, SostenutoHoldsOnlyWhatWasDown) {
  EXPECT_EQ(voices_after({on(0, 0, 60), control(1, 0, kSostenuto, 127), off(2, 0, 60)}), 1);
  EXPECT_EQ(voices_after({control(30000, 0, kSostenuto, 0)}), 0);
  EXPECT_EQ(voices_after({control(60000, 0, kSostenuto, 127), on(60001, 0, 62), off(60002, 0, 62)}),
            0);
}

TEST_P(StuckNoteInMode, SustainTakesOverFromSostenuto) {
  EXPECT_EQ(voices_after({on(0, 0, 60), control(1, 0, kSostenuto, 127), off(2, 0, 60),
                          control(3, 0, kSustain, 127), control(4, 0, kSostenuto, 0)}),
            1);
  EXPECT_EQ(voices_after({control(30000, 0, kSustain, 0)}), 0);
}

TEST_P(StuckNoteInMode, ResetAllControllersLiftsThePedals) {
  EXPECT_EQ(voices_after({control(0, 0, kSustain, 127), on(1, 0, 60), off(2, 0, 60),
                          control(3, 0, kResetControllers, 0)}),
            0);
}

TEST_P(StuckNoteInMode, AllNotesOffLiftsKeysButNotPedals) {
  EXPECT_EQ(voices_after({on(0, 0, 60), control(1, 0, kAllNotesOff, 0)}), 0);
  EXPECT_EQ(voices_after({on(30000, 0, 60), control(30001, 0, kSustain, 127),
                          control(30002, 0, kAllNotesOff, 0)}),
            1);
  EXPECT_EQ(voices_after({control(60000, 0, kSustain, 0)}), 0);
}

TEST_P(StuckNoteInMode, AllSoundOffIsSilentWithinFiveMilliseconds) {
  play(*engine_, {on(0, 0, 60), control(1, 0, kSustain, 127), control(1000, 0, kAllSoundOff, 0)},
       1000 + 241);
  EXPECT_TRUE(engine_->is_idle());
  EXPECT_EQ(voices_after({off(2000, 0, 60), control(2001, 0, kSustain, 0)}), 0);
}

TEST_P(StuckNoteInMode, ModeMessagesLiftKeys) {
  for (const int mode : {kOmniOff, kOmniOn, kMonoOn, kPolyOn}) {
    const std::int64_t now = engine_->now();
    EXPECT_EQ(voices_after({on(now, 0, 60), control(now + 9, 0, mode, 0)}), 0) << mode;
  }
}

TEST_P(StuckNoteInMode, AProgramChangeUnderAHeldNoteLeavesItsNoteOff) {
  EXPECT_EQ(voices_after({on(0, 0, 60), midi(1, 0xC0, 17, 0), off(2, 0, 60)}), 0);
}

TEST_P(StuckNoteInMode, TheEventThatEndsASongLiftsEverything) {
  EXPECT_EQ(
      voices_after({control(0, 0, kSustain, 127), control(0, 1, kSostenuto, 127), on(1, 0, 60),
                    on(2, 1, 61), off(3, 0, 60), of_kind(100, Event::Kind::all_notes_off)}),
      0);
}

TEST_P(StuckNoteInMode, ASystemResetSilencesAndForgetsPedals) {
  static constexpr std::uint8_t kGeneralMidiOn[] = {0x7E, 0x7F, 0x09, 0x01};
  Event reset = midi(5, 0xF0, 0, 0);
  reset.midi.sysex = kGeneralMidiOn;
  reset.midi.sysex_size = sizeof kGeneralMidiOn;
  EXPECT_EQ(voices_after({control(0, 0, kSustain, 127), on(1, 0, 60), reset}), 0);
  const std::int64_t now = engine_->now();
  EXPECT_EQ(voices_after({on(now, 0, 60), off(now + 1, 0, 60)}), 0);
}

TEST_P(StuckNoteInMode, AHeldNoteGoesOverToANewBankAndStillEnds) {
  const auto other = bank_from(kPlain);
  Event install = of_kind(5000, Event::Kind::install_bank);
  install.bank = other.get();
  EXPECT_EQ(voices_after({on(0, 0, 60), install}), 1);
  EXPECT_TRUE(engine_->is_playing(other.get()));
  EXPECT_FALSE(engine_->is_playing(bank_.get()));
  EXPECT_EQ(voices_after({off(60000, 0, 60)}), 0);
  engine_.reset();  // before `other`
}

TEST_P(StuckNoteInMode, APedalHeldNoteGoesOverToANewBankAndStillEnds) {
  const auto other = bank_from(with(kPlain, "mode = \"mono\""));
  Event install = of_kind(5000, Event::Kind::install_bank);
  install.bank = other.get();
  EXPECT_EQ(voices_after({control(0, 0, kSustain, 127), on(1, 0, 60), off(2, 0, 60), install}), 1);
  EXPECT_EQ(voices_after({control(60000, 0, kSustain, 0)}), 0);
  engine_.reset();
}

TEST_F(StuckNote, TwoNoteOnsOfAKeyNeedTwoNoteOffs) {
  use(kPlain);
  EXPECT_EQ(voices_after({on(0, 0, 60), on(1, 0, 60)}), 2);
  EXPECT_EQ(voices_after({off(30000, 0, 60)}), 1);
  EXPECT_EQ(voices_after({off(60000, 0, 60)}), 0);
}

TEST_F(StuckNote, AKeyStruckAgainUnderThePedalDoesNotPileUp) {
  use(kPlain);
  std::vector<Event> events = {control(0, 0, kSustain, 127)};
  for (int i = 0; i < 20; ++i) {
    events.push_back(on(100 * i, 0, 60));
    events.push_back(off(100 * i + 50, 0, 60));
  }
  EXPECT_EQ(voices_after(events), 1);
}

TEST_F(StuckNote, MonoFallsBackToTheKeyStillDown) {
  use(with(kPlain, "mode = \"mono\""));
  EXPECT_EQ(voices_after({on(0, 0, 60), on(1, 0, 64), off(2, 0, 64)}), 1);
  EXPECT_EQ(voices_after({off(30000, 0, 60)}), 0);
}

TEST_F(StuckNote, MpeNotesEndWithTheMastersPedal) {
  use(kPlain);
  const std::vector<Event> zone = {control(0, 0, kRpnMsb, 0), control(0, 0, kRpnLsb, 6),
                                   control(0, 0, kDataEntryMsb, 5)};
  std::vector<Event> events = zone;
  events.push_back(control(1, 0, kSustain, 127));
  events.push_back(on(2, 1, 60));
  events.push_back(on(3, 2, 64));
  events.push_back(off(4, 1, 60));
  events.push_back(off(5, 2, 64));
  EXPECT_EQ(voices_after(events), 2);
  EXPECT_EQ(voices_after({control(60000, 0, kSustain, 0)}), 0);
  EXPECT_EQ(voices_after({on(90000, 3, 60), control(90001, 0, kAllNotesOff, 0)}), 0);
  EXPECT_EQ(voices_after({on(120000, 4, 60), control(120001, 0, kAllSoundOff, 0)}), 0);
}

TEST_F(StuckNote, SettingUpAZoneLiftsItsKeys) {
  use(kPlain);
  EXPECT_EQ(voices_after({on(0, 2, 60), control(1, 0, kRpnMsb, 0), control(1, 0, kRpnLsb, 6),
                          control(1, 0, kDataEntryMsb, 5)}),
            0);
}

TEST_F(StuckNote, TwoThousandNotesNeverReleasedEndWithTheSong) {
  use(kPlain);
  std::vector<Event> events;
  for (int i = 0; i < 2048; ++i) events.push_back(on(i * 3, i % 16, (i * 7) % 128));
  EXPECT_LE(voices_after(events), 32);
  EXPECT_EQ(voices_after({of_kind(60000, Event::Kind::all_notes_off)}), 0);
  EXPECT_TRUE(engine_->is_idle());
}

/// Any three bytes at any time.
std::vector<Event> storm(std::uint64_t seed, int count, int per_sample) {
  const base::RandomStream random{seed, 0, 78};
  std::vector<Event> events;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t bits = random.bits(static_cast<std::uint64_t>(i));
    Event event = midi(i / per_sample, 0x80 | int(bits & 127), int(bits >> 8 & 127),
                       int(bits >> 16 & 127), static_cast<std::uint32_t>(bits >> 32));
    if ((bits >> 24 & 63) == 0) event.midi.bytes[1] |= 0x80;  // not a data byte
    if (i % per_sample != 0) event.midi.time.fraction = events.back().midi.time.fraction;
    events.push_back(event);
  }
  return events;
}

TEST_P(StuckNoteInMode, AStormOfRandomMessagesEndsInSilence) {
  const int count = support::test_count(20000);
  const auto events = storm(support::test_seed(), count, 8);
  const auto frames = static_cast<std::size_t>(count / 8);
  const Sound sound = play(*engine_, events, frames, 500);
  for (std::size_t i = 0; i < frames; ++i) {
    ASSERT_TRUE(std::isfinite(sound.left[i]) && std::isfinite(sound.right[i])) << i;
  }
  EXPECT_LE(engine_->counters().voices_peak, 32);
  EXPECT_GT(engine_->counters().notes, count / 64);
  EXPECT_EQ(voices_after({of_kind(engine_->now(), Event::Kind::all_notes_off)}), 0);
  EXPECT_TRUE(engine_->is_idle());
}

TEST_P(StuckNoteInMode, AStormEndsWithNoteOffsAndPedalsUpOnEveryChannel) {
  const auto events = storm(support::test_seed() + 1, 4000, 4);
  play(*engine_, events, 1000, 77);
  std::vector<Event> calm;
  const std::int64_t now = engine_->now();
  for (int c = 0; c < 16; ++c) {
    calm.push_back(control(now, c, kSustain, 0));
    calm.push_back(control(now, c, kSostenuto, 0));
    calm.push_back(control(now, c, kAllNotesOff, 0));
  }
  EXPECT_EQ(voices_after(calm), 0);
}

}  // namespace
}  // namespace knotwave::engine

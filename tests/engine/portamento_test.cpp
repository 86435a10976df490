// SPDX-License-Identifier: MIT
// Portamento and note modes by MIDI: CC 5, 65, 84, 126, 127 against what the patch says.
#include <gtest/gtest.h>

#include "knotwave/engine/channel_state.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

// CC 5 = 75 is 5 s * (75 / 127)^3 = 1.0298 s: at its middle the built-in S is at one half.
constexpr int kSecond = 75;
constexpr double kSeconds = 5.0 * kSecond * kSecond * kSecond / (127.0 * 127 * 127);
constexpr auto kMiddle = static_cast<std::int64_t>(kSeconds / 2 * 48000);
constexpr std::size_t kFrames = 70000;
constexpr std::int64_t kSecondNote = 4800;

struct Played {
  Sound sound;
  EngineCounters counters;

  double hz_at(std::int64_t sample) const {
    return frequency_hz(sound.left, static_cast<std::size_t>(sample - 400),
                        static_cast<std::size_t>(sample + 400));
  }
};

Played played(std::string_view lines, const std::vector<Event>& events, std::size_t block = 256,
              std::size_t frames = kFrames) {
  const auto bank = bank_from(with(kPlain, lines));
  const auto engine = engine_for(*bank);
  Played result;
  result.sound = play(*engine, events, frames, block);
  result.counters = engine->counters();
  return result;
}

// An octave up, from A3 to A4, the first note short; `before` at the start.
std::vector<Event> octave(std::vector<Event> before, std::int64_t first_off = 2400) {
  before.push_back(on(0, 0, 57));
  before.push_back(off(first_off, 0, 57));
  before.insert(first_off < kSecondNote ? before.end() : before.end() - 1, on(kSecondNote, 0, 69));
  return before;
}
const Event time_control = control(0, 0, kPortamentoTime, kSecond);
const Event switch_on = control(0, 0, kPortamento, 127);
const Event switch_off = control(0, 0, kPortamento, 0);
const double halfway_hz = 440 / std::sqrt(2.0);

TEST(Portamento, TheSwitchGlidesEveryNoteInTheTimeOfControlFive) {
  const Played glide = played("", octave({time_control, switch_on}));
  EXPECT_NEAR(glide.hz_at(kSecondNote + kMiddle), halfway_hz, 2);
  EXPECT_NEAR(glide.hz_at(kSecondNote + 2 * kMiddle + 500), 440, 0.01);
  EXPECT_NEAR(played("", octave({time_control})).hz_at(kSecondNote + 2000), 440, 0.01);
  EXPECT_NEAR(played("", octave({switch_on})).hz_at(kSecondNote + 2000), 440, 0.01);  // in no time
}

TEST(Portamento, AGlideOfThePatchHoldsUntilAMessageSaysOtherwise) {
  constexpr std::string_view kOwn = "glide_s = 0.5";
  EXPECT_NEAR(played(kOwn, octave({})).hz_at(kSecondNote + 12000), halfway_hz, 2);
  EXPECT_NEAR(played(kOwn, octave({switch_on})).hz_at(kSecondNote + 12000), halfway_hz, 2);
  EXPECT_NEAR(played(kOwn, octave({time_control})).hz_at(kSecondNote + kMiddle), halfway_hz, 2);
  EXPECT_NEAR(played(kOwn, octave({switch_off})).hz_at(kSecondNote + 2000), 440, 0.01);
  EXPECT_NEAR(played(kOwn, octave({control(0, 0, kPortamentoTime, 0)})).hz_at(kSecondNote + 2000),
              440, 0.01);
}

TEST(Portamento, ResetAllControllersGivesTheSwitchBackToThePatch) {
  const Event reset = control(0, 0, kResetControllers, 0);
  EXPECT_TRUE(played("", octave({time_control, switch_on, reset})).sound ==
              played("", octave({})).sound);
  EXPECT_TRUE(played("glide_s = 0.5", octave({switch_off, reset})).sound ==
              played("glide_s = 0.5", octave({})).sound);
}

TEST(Portamento, TheSwitchGlidesALegatoPatchWithoutATieToo) {
  constexpr std::string_view kLegato = "mode = 'legato'\nglide_s = 0.5";
  EXPECT_NEAR(played(kLegato, octave({})).hz_at(kSecondNote + 2000), 440, 0.01);
  EXPECT_NEAR(played(kLegato, octave({switch_on})).hz_at(kSecondNote + 12000), halfway_hz, 2);
  EXPECT_NEAR(played(kLegato, octave({switch_off}, 60000)).hz_at(kSecondNote + 2000), 440, 0.01);
}

TEST(Portamento, ControlEightyFourNamesWhereTheNextNoteAloneComesFrom) {
  const Event source = control(0, 0, kPortamentoControl, 57);
  const Played glide =
      played("", {time_control, switch_off, source, on(0, 0, 69)});  // whatever the switch says
  EXPECT_NEAR(glide.hz_at(kMiddle), halfway_hz, 2);
  EXPECT_NEAR(glide.hz_at(2 * kMiddle + 500), 440, 0.01);
  const Played next =
      played("", {time_control, source, on(0, 0, 69), off(100, 0, 69), on(kSecondNote, 0, 69)});
  EXPECT_NEAR(next.hz_at(kSecondNote + 2000), 440, 0.01);
}

TEST(Portamento, AVoiceThatStillSoundsTheSourceGoesOnToTheNewNote) {
  const std::vector<Event> events = {time_control,
                                     on(0, 0, 57),
                                     control(kSecondNote, 0, kPortamentoControl, 57),
                                     on(kSecondNote, 0, 69, 1),
                                     off(kSecondNote + 100, 0, 57),
                                     off(60000, 0, 69)};
  const Played tied = played("", events);
  EXPECT_EQ(tied.counters.voices_peak, 1);
  EXPECT_NEAR(tied.hz_at(kSecondNote + kMiddle), halfway_hz, 2);
  EXPECT_NEAR(tied.hz_at(57000), 440, 0.01);
  // Neither struck again nor as soft as its velocity, and its own note-off ends it.
  EXPECT_NEAR(peak(tied.sound.left, 55000, 59000), peak(tied.sound.left, 2000, 4800), 2e-3);
  EXPECT_EQ(peak(tied.sound.left, 64000), 0);
}

TEST(Portamento, AMonoVoiceIsTiedToItsSourceAndLeftByOthers) {
  const auto from = [](int source) {
    return std::vector<Event>{time_control, on(0, 0, 57),
                              control(kSecondNote, 0, kPortamentoControl, source),
                              on(kSecondNote, 0, 69)};
  };
  EXPECT_NEAR(played("mode = 'mono'", from(57)).hz_at(kSecondNote + kMiddle), halfway_hz, 2);
  EXPECT_NEAR(played("mode = 'mono'", from(81)).hz_at(kSecondNote + kMiddle), 440 * std::sqrt(2.0),
              3);
}

TEST(Portamento, TheLengthOfABlockIsNotHeard) {
  const std::vector<Event> events = {control(0, 0, kPortamentoTime, 20),
                                     switch_on,
                                     on(0, 0, 57),
                                     on(301, 0, 69),
                                     control(555, 0, kPortamentoControl, 69),
                                     on(777, 0, 64),
                                     control(901, 0, kMonoOn, 1),
                                     on(1000, 0, 50),
                                     on(1203, 0, 62),
                                     off(1400, 0, 62),
                                     control(1600, 0, kPolyOn, 0),
                                     on(1700, 0, 40)};
  const Sound whole = played("", events, 3000, 3000).sound;
  for (const std::size_t block : {1u, 7u, 64u, 256u}) {
    EXPECT_TRUE(played("", events, block, 3000).sound == whole) << block;
  }
}

TEST(NoteMode, MonoOnMakesAPolyPatchPlayOneNoteAndPolyOnBack) {
  const auto peak_voices = [](std::string_view patch, const std::vector<Event>& before) {
    std::vector<Event> events = before;
    for (const int key : {57, 60, 64}) events.push_back(on(0, 0, key));
    return played(patch, events, 256, 4800).counters.voices_peak;
  };
  const Event mono = control(0, 0, kMonoOn, 1), poly = control(0, 0, kPolyOn, 0);
  EXPECT_EQ(peak_voices("", {}), 3);
  EXPECT_EQ(peak_voices("", {mono}), 1);
  EXPECT_EQ(peak_voices("", {mono, poly}), 3);
  EXPECT_EQ(peak_voices("mode = 'legato'", {}), 1);
  EXPECT_EQ(peak_voices("mode = 'legato'", {poly}), 3);
  EXPECT_EQ(peak_voices("", {mono, control(0, 0, kResetControllers, 0)}), 1);
}

TEST(NoteMode, TheCountSaysHowManyChannelsAndNoughtAllThatAreLeft) {
  const auto mono_channels = [](const std::vector<Event>& before) {
    std::vector<int> found;
    for (int channel = 0; channel < 16; ++channel) {
      std::vector<Event> events = before;
      events.push_back(on(10, channel, 57));
      events.push_back(on(10, channel, 64));
      if (played("", events, 256, 512).counters.voices_peak == 1) found.push_back(channel);
    }
    return found;
  };
  EXPECT_EQ(mono_channels({control(0, 3, kMonoOn, 1)}), (std::vector<int>{3}));
  EXPECT_EQ(mono_channels({control(0, 3, kMonoOn, 3)}), (std::vector<int>{3, 4, 5}));
  EXPECT_EQ(mono_channels({control(0, 13, kMonoOn, 0)}), (std::vector<int>{13, 14, 15}));
  EXPECT_EQ(mono_channels({control(0, 13, kMonoOn, 9)}), (std::vector<int>{13, 14, 15}));
  EXPECT_EQ(mono_channels({control(0, 3, kMonoOn, 3), control(0, 3, kMonoOn, 1)}),
            (std::vector<int>{3}));
  EXPECT_EQ(mono_channels({control(0, 3, kMonoOn, 3), control(0, 3, kPolyOn, 0)}),
            (std::vector<int>{}));
}

TEST(NoteMode, ModeMessagesLiftTheKeysAndPedalsStillHold) {
  for (const int mode : {124, 125, 126, 127}) {
    const std::vector<Event> lifted = {on(0, 0, 57), control(4800, 0, mode, 1)};
    EXPECT_EQ(peak(played("", lifted, 256, 12000).sound.left, 9000), 0) << mode;
    const std::vector<Event> held = {on(0, 0, 57), control(0, 0, kSustain, 127),
                                     control(4800, 0, mode, 1), control(12000, 0, kSustain, 0)};
    const Played sound = played("", held, 256, 20000);
    EXPECT_GT(peak(sound.sound.left, 9000, 12000), 0.01) << mode;
    EXPECT_EQ(peak(sound.sound.left, 16000), 0) << mode;
  }
}

TEST(NoteMode, AVoiceHeldByAPedalAcrossAChangeOfModeIsReleasedByThePedal) {
  for (const auto& [first, second] : {std::pair{kMonoOn, kPolyOn}, std::pair{kPolyOn, kMonoOn}}) {
    const std::vector<Event> events = {
        control(0, 0, first, 1),      on(10, 0, 57),  control(20, 0, kSustain, 127),
        control(100, 0, second, 1),   on(200, 0, 64), off(300, 0, 64),
        control(4800, 0, kSustain, 0)};
    EXPECT_EQ(peak(played("", events, 256, 12000).sound.left, 9000), 0);
  }
}

}  // namespace
}  // namespace knotwave::engine

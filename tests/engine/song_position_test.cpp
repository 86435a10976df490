// SPDX-License-Identifier: MIT
// Where the song is: what goes with it, what does not.
#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "scenes.h"
#include "support/block_sweep.h"
#include "support/seed.h"
#include "tempo_clock.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// +20 dB in the first half of a quarter note, -20 dB in the second, to the song.
constexpr std::string_view kPulse = R"(
[lfos.pulse]
curve = "square"
beats = 1
mode = "free"
[[maps]]
from = "pulse"
to = "amp"
depth = 20
)";

Event position(std::int64_t sample, std::int64_t clocks, std::uint32_t fraction = 0) {
  Event event = of_kind(sample, Event::Kind::position);
  event.midi.time.fraction = fraction;
  event.song_clocks = clocks;
  return event;
}

Event tempo(std::int64_t sample, std::uint32_t microseconds) {
  Event event = of_kind(sample, Event::Kind::tempo);
  event.microseconds_per_quarter = microseconds;
  return event;
}

Sound later(const Sound& sound, std::int64_t samples) {
  return {{sound.left.begin() + samples, sound.left.end()},
          {sound.right.begin() + samples, sound.right.end()}};
}

/// Whether the pulse is up, from its loudness over 40 cycles of the note around a sample.
bool is_up(const Sound& sound, std::size_t sample) {
  return peak(sound.left, sample - 2000, sample + 2000) > 0.1;
}

TEST(SongPosition, AtTheStartOfTheSongAllBeginsAsAtEngineTimeZero) {
  const auto bank = bank_from(std::string(kPlain) + std::string(kPulse));
  constexpr std::int64_t kStart = 31234;
  const auto moved = engine_for(*bank), fresh = engine_for(*bank);
  const Sound begun = play(*fresh, {tempo(0, 731234), on(5, 0, 69), off(40000, 0, 69)}, 60000);
  const Sound sound = play(*moved,
                           {tempo(0, 731234), tempo(9000, 400000), tempo(20000, 731234),
                            position(kStart, 0), on(kStart + 5, 0, 69), off(kStart + 40000, 0, 69)},
                           60000 + kStart);
  EXPECT_GT(peak(begun.left), 0.1);
  EXPECT_EQ(later(sound, kStart), begun);
}

TEST(SongPosition, MovesAFreeLfoUnderAHeldNote) {
  const auto bank = bank_from(std::string(kPlain) + std::string(kPulse));
  const auto engine = engine_for(*bank);
  // Up for 24000 samples and down for 24000, from 0; from 36000 as from 12 clocks on: down.
  const Sound sound = play(*engine,
                           {tempo(0, 1000000), on(0, 0, 69), position(12000, 24 * 7 + 12),
                            position(60000, 0), position(72000, 6)},
                           120000);
  EXPECT_TRUE(is_up(sound, 9000));
  EXPECT_FALSE(is_up(sound, 15000));
  EXPECT_FALSE(is_up(sound, 33000));
  EXPECT_TRUE(is_up(sound, 39000));
  EXPECT_TRUE(is_up(sound, 63000));
  EXPECT_TRUE(is_up(sound, 81000));  // 72000 + 12000 are 12 clocks
  EXPECT_FALSE(is_up(sound, 87000));
}

TEST(SongPosition, PutsAFreeLfoWhereItSaysWhateverItsRateHasBeen) {
  constexpr std::string_view kRate = R"(
[[maps]]
from = "mod"
to = "lfo.pulse.rate"
depth = 1
)";
  const auto bank = bank_from(std::string(kPlain) + std::string(kPulse) + std::string(kRate));
  const auto engine = engine_for(*bank);
  // Twice as fast from 12000 on: up until 18000, from 30000 until 42000; the song begins at 50000.
  const Sound sound =
      play(*engine,
           {tempo(0, 1000000), on(0, 0, 69), control(12000, 0, 1, 127), position(50000, 0)}, 90000);
  EXPECT_TRUE(is_up(sound, 9000));
  EXPECT_FALSE(is_up(sound, 24000));
  EXPECT_TRUE(is_up(sound, 36000));
  EXPECT_FALSE(is_up(sound, 46000));
  EXPECT_TRUE(is_up(sound, 53000));
  EXPECT_FALSE(is_up(sound, 65000));
  EXPECT_TRUE(is_up(sound, 77000));
}

TEST(SongPosition, LeavesWhatBeganWithANoteAlone) {
  constexpr std::string_view kKeyed = R"(
[lfos.keyed]
curve = "triangle"
beats = 0.31
[lfos.once]
curve = "sine"
beats = 2.5
mode = "one_shot"
[lfos.levels]
curve = "triangle"
beats = 0.2
random = true
[lfos.clock]
curve = "sine"
rate_hz = 3
mode = "free"
[[maps]]
from = "keyed"
to = "amp"
depth = 3
[[maps]]
from = "once"
to = "pitch"
depth = 2
[[maps]]
from = "levels"
to = "pan"
depth = 1
[[maps]]
from = "clock"
to = "a.level"
depth = 2
[[maps]]
from = "mod"
to = "lfo.keyed.rate"
depth = 1
)";
  const auto bank = bank_from(std::string(kPlain) + std::string(kKeyed));
  // A quarter note is 32768 samples, so that its part at a sample is a double, whatever was added.
  const EngineConfig config{.rate_hz = 32768};
  const std::vector<Event> played = {tempo(0, 1000000), on(100, 0, 60), control(5000, 0, 1, 90),
                                     on(9000, 0, 67)};
  std::vector<Event> moved = played;
  for (int i = 0; i < 40; ++i) moved.push_back(position(10000 + 777 * i, 1000 - 31 * i));
  const auto one = engine_for(*bank, config), other = engine_for(*bank, config);
  EXPECT_EQ(play(*one, played, 60000), play(*other, moved, 60000));
}

TEST(SongPosition, AnySplitGivesTheSameBits) {
  const auto bank = bank_from(kRich);
  const base::RandomStream random{support::test_seed(), 0, 8101};
  std::vector<Event> events = {control(0, 0, 1, 100), on(0, 0, 60), on(0, 0, 67)};
  std::int64_t sample = 0;
  for (std::uint64_t i = 0; i < 30; ++i) {
    const std::uint64_t bits = random.bits(i);
    sample += 1 + static_cast<std::int64_t>(bits % 60);
    events.push_back(position(sample, static_cast<std::int64_t>(bits >> 20 & 4095),
                              static_cast<std::uint32_t>(bits >> 32)));
    if (i % 5 == 2)
      events.push_back(tempo(sample + 1, 300000 + static_cast<std::uint32_t>(bits % 5)));
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time() < b.time(); });
  const auto whole = engine_for(*bank);
  const Sound expected = play(*whole, events, 2000, 2000);
  EXPECT_GT(peak(expected.left), 1e-3);
  for (std::size_t block = 1; block <= 130; ++block) {
    const auto engine = engine_for(*bank);
    ASSERT_EQ(play(*engine, events, 2000, block), expected) << block;
  }
}

TEST(TempoClock, APositionCountsFromItsFractionOfASampleAndWhatIsPlayedGoesOn) {
  TempoClock clock;
  clock.reset(32768);
  clock.set_tempo({0, 0}, 1000000);
  EXPECT_EQ(clock.moves(), 0u);
  clock.set_position({100, 0x80000000u}, 7.25);
  EXPECT_EQ(clock.moves(), 1u);
  EXPECT_EQ(clock.beats_at(101), 7.25 + 0.5 / 32768);
  EXPECT_EQ(clock.played_at(101), 101.0 / 32768);
  clock.set_tempo({200, 0}, 500000);
  EXPECT_EQ(clock.moves(), 1u);
  EXPECT_EQ(clock.beats_at(300), 7.25 + (99.5 + 200) / 32768);
  EXPECT_EQ(clock.played_at(300), (200.0 + 200) / 32768);
}

}  // namespace
}  // namespace knotwave::engine

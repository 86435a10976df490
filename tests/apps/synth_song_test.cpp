// SPDX-License-Identifier: MIT
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "song/event_feed.h"
#include "song_player.h"
#include "support/seed.h"

namespace knotwave::synth {
namespace {

using Kind = engine::Event::Kind;
constexpr double kRateHz = 48000;

/// Two seconds at 120 bpm; the second note and a pedal of channel 2 have no end.
io::Song song_with_loose_ends() {
  io::Song song;
  song.track_count = 1;
  song.time_base.ticks_per_quarter = 480;
  song.events = {{0, 0, {0x90, 60, 100}, 0, 0},
                 {7, 0, {0xF0, 0, 0}, 0, 3},
                 {480, 0, {0x80, 60, 0}, 0, 0},
                 {481, 0, {0x91, 62, 90}, 0, 0},
                 {600, 0, {0xB1, 64, 127}, 0, 0}};
  song.sysex_bytes = {1, 2, 3};
  song.tempos = {{0, 500000}, {960, 250000}};
  song.length_ticks = 1440 + 480;
  return song;
}

/// All that is due in `frames`, asked for in blocks of random sizes; times from the first frame.
std::vector<engine::Event> all_due(SongPlayer& song, std::int64_t frames, std::uint64_t seed = 0) {
  const base::RandomStream random{support::test_seed(), 0, 6001};
  std::vector<engine::Event> all;
  for (std::int64_t at = 0; at < frames;) {
    const int block = static_cast<int>(1 + random.bits(seed++) % 3000);
    for (const engine::Event& event : song.due(block)) {
      EXPECT_GE(event.time().sample, 0);
      EXPECT_LT(event.time().sample, block);
      all.push_back(event);
      all.back().midi.time.sample += at;
    }
    at += block;
  }
  return all;
}

std::vector<int> bytes_of(const engine::Event& event) {
  return {event.midi.bytes[0], event.midi.bytes[1], event.midi.bytes[2]};
}

TEST(SongPlayer, GivesTheEventsOfTheFileAtTheirTimesAndThenLetsGoWhatItHolds) {
  const io::Song file = song_with_loose_ends();
  song::EventFeed feed(file, 48000);
  const auto given = feed.before(std::numeric_limits<std::int64_t>::max());
  const std::vector<engine::Event> expected(given.begin(), given.end() - 1);
  for (std::uint64_t split = 0; split < 20; ++split) {
    SongPlayer song(file);
    song.begin(kRateHz, 0);
    const auto events = all_due(song, 200000, 100 * split);
    ASSERT_EQ(events.size(), expected.size() + 2);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(events[i].time(), expected[i].time());
      EXPECT_EQ(events[i].kind, expected[i].kind);
      EXPECT_EQ(bytes_of(events[i]), bytes_of(expected[i]));
      EXPECT_EQ(events[i].midi.sysex_size, expected[i].midi.sysex_size);
    }
    EXPECT_EQ(bytes_of(events[expected.size()]), (std::vector<int>{0xB1, 64, 0}));
    EXPECT_EQ(bytes_of(events.back()), (std::vector<int>{0x81, 62, 64}));
    EXPECT_EQ(events.back().time(), feed.end());
    EXPECT_TRUE(song.is_over());
    EXPECT_EQ(song.position_s(), song.length_s());
    EXPECT_TRUE(song.due(512).empty());
  }
}

TEST(SongPlayer, ThatIsStoppedLetsGoWhatItHoldsWithTheNextBlock) {
  SongPlayer song(song_with_loose_ends());
  song.begin(kRateHz, 0);
  song.due(100);
  EXPECT_FALSE(song.is_over());
  song.stop();
  const auto last = song.due(100);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(bytes_of(last[0]), (std::vector<int>{0x80, 60, 64}));
  EXPECT_EQ(last[0].time().sample, 0);
  EXPECT_TRUE(song.is_over());
  EXPECT_TRUE(song.due(48000).empty());
}

TEST(SongPlayer, BegunAtAPositionGoesOnFromThereAtAnyRate) {
  SongPlayer song(song_with_loose_ends());
  song.begin(kRateHz, 0);
  song.due(24000);
  EXPECT_EQ(song.position_s(), 0.5);
  song.begin(44100, song.position_s());
  const auto events = all_due(song, 120000);
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(bytes_of(events[0]), (std::vector<int>{0x80, 60, 0}));
  EXPECT_EQ(events[0].time().sample, 0);
  EXPECT_EQ(bytes_of(events[1]), (std::vector<int>{0x91, 62, 90}));
  EXPECT_EQ(events[1].time().sample, 45) << "a tick of 45.9 samples later";
  // What was held before is known: stopped at once, it is let go.
  SongPlayer other(song_with_loose_ends());
  other.begin(44100, 0.25);
  other.stop();
  ASSERT_EQ(other.due(64).size(), 1u);
}

TEST(SongPlayer, MoreThanOneBlockCanTakeComesWithTheNext) {
  io::Song file = song_with_loose_ends();
  file.events.assign(10000, {0, 0, {0xB0, 1, 5}, 0, 0});
  SongPlayer song(file);
  song.begin(kRateHz, 0);
  std::size_t count = 0;
  for (int i = 0; i < 3; ++i) {
    const auto due = song.due(64);
    EXPECT_LE(due.size(), SongPlayer::kMostEvents);
    for (const engine::Event& event : due) EXPECT_EQ(event.time().sample, 0);
    count += due.size();
  }
  EXPECT_EQ(count, 10001u) << "and a tempo";
}

}  // namespace
}  // namespace knotwave::synth

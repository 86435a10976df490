// SPDX-License-Identifier: MIT
#include "song/event_feed.h"

#include <gtest/gtest.h>

#include "knotwave/base/random.h"

#include "support/seed.h"

namespace knotwave::song {
namespace {

using Kind = engine::Event::Kind;

io::Song two_notes() {
  io::Song song;
  song.track_count = 1;
  song.time_base.ticks_per_quarter = 480;
  song.events = {{0, 0, {0x90, 60, 100}, 0, 0},
                 {480, 0, {0xF0, 0, 0}, 0, 3},
                 {480, 0, {0x82, 60, 0}, 0, 0},
                 {960, 0, {0x93, 62, 0}, 0, 0}};
  song.sysex_bytes = {1, 2, 3};
  song.tempos = {{0, 600000}, {480, 250000}};
  song.length_ticks = 1920;
  return song;
}

std::vector<engine::Event> all_events(EventFeed& feed, std::int64_t block, std::int64_t end) {
  std::vector<engine::Event> all;
  for (std::int64_t now = block; now < end + block; now += block) {
    const auto events = feed.before(now);
    all.insert(all.end(), events.begin(), events.end());
  }
  return all;
}

TEST(EventFeed, TempoComesBeforeTheNotesOfItsTickAndAllNotesOffAtTheEnd) {
  const io::Song song = two_notes();
  EventFeed feed(song, 48000);
  const auto events = all_events(feed, 1 << 20, 1 << 20);
  ASSERT_EQ(events.size(), 7u);
  EXPECT_EQ(events[0].kind, Kind::tempo);
  EXPECT_EQ(events[0].microseconds_per_quarter, 600000u);
  EXPECT_EQ(events[1].midi.bytes[0], 0x90);
  EXPECT_EQ(events[2].kind, Kind::tempo);
  EXPECT_EQ(events[2].time().sample, 28800);
  EXPECT_EQ(events[3].midi.sysex_size, 3u);
  EXPECT_EQ(events[3].midi.sysex[2], 3);
  EXPECT_EQ(events[4].midi.bytes[0], 0x82);
  EXPECT_EQ(events[5].time().sample, 28800 + 12000);
  EXPECT_EQ(events[6].kind, Kind::all_notes_off);
  EXPECT_EQ(events[6].time(), feed.end());
  EXPECT_EQ(feed.end().sample, 28800 + 3 * 12000);
}

TEST(EventFeed, OnlyChannelsWithANoteOnAreUsed) {
  const io::Song song = two_notes();  // 0x93 has velocity 0: a note off
  EXPECT_EQ(EventFeed(song, 48000).channels(), 1u);
}

TEST(EventFeed, TimesHaveFractionsOfASample) {
  io::Song song = two_notes();
  song.time_base.ticks_per_quarter = 7;
  song.tempos.clear();
  song.events = {{1, 0, {0x90, 60, 100}, 0, 0}};
  EventFeed feed(song, 48000);
  const auto events = feed.before(1 << 20);
  // 48000 / 2 / 7 = 3428 4/7
  EXPECT_EQ(events[0].time(), (base::SampleTime{3428, 2454267026u}));
}

TEST(EventFeed, AnySplitGivesTheSameEvents) {
  io::Song song;
  const base::RandomStream random{.seed = support::test_seed(), .voice = 0, .purpose = 0};
  std::uint64_t tick = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    tick += random.bits(2 * i) % 40;
    const auto key = static_cast<std::uint8_t>(random.bits(2 * i + 1) % 128);
    song.events.push_back({tick, 0, {0x90, key, 100}, 0, 0});
    if (i % 50 == 0) song.tempos.push_back({tick, 100000u + static_cast<std::uint32_t>(i)});
  }
  song.length_ticks = tick;
  const std::int64_t end = EventFeed(song, 8000).end().sample + 1;
  EventFeed whole_feed(song, 8000);
  const auto whole = all_events(whole_feed, end + 1, end);
  ASSERT_EQ(whole.size(), 511u);
  for (const std::int64_t block : {1, 7, 64, 256, 4096}) {
    EventFeed feed(song, 8000);
    const auto split = all_events(feed, block, end);
    ASSERT_EQ(split.size(), whole.size()) << block;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(split[i].time(), whole[i].time());
      EXPECT_EQ(split[i].kind, whole[i].kind);
      EXPECT_EQ(split[i].midi.bytes[1], whole[i].midi.bytes[1]);
    }
  }
}

TEST(EventFeed, NoEventIsGivenAtOrPastTheEndOfItsBlock) {
  const io::Song song = two_notes();
  EventFeed feed(song, 48000);
  EXPECT_EQ(feed.before(28800).size(), 2u);
  EXPECT_EQ(feed.before(28801).size(), 3u);
}

}  // namespace
}  // namespace knotwave::song

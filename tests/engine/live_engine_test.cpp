// SPDX-License-Identifier: MIT
// When messages sound, what becomes of too many of them, and that all of it is in the journal.
#include "knotwave/engine/live_engine.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"

#include "live_device.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

TEST(LiveEngine, RefusesWhatItCannotHold) {
  EXPECT_EQ(LiveEngine::create({.input_messages = 0}, bank_from(kPlain)).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(LiveEngine::create({.journal_records = 0}, bank_from(kPlain)).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(LiveEngine::create({.tap_s = -1}, bank_from(kPlain)).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(LiveEngine::create({.engine = {.rate_hz = 1}}, bank_from(kPlain)).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(LiveEngine::create({}, nullptr).error().code, ErrorCode::missing_key);
}

TEST(LiveEngine, EveryMessageSoundsTheLatencyAfterItWasHeardWhateverItsBlock) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  const base::RandomStream random{support::test_seed(), 0, 3001};
  device.block(8192);  // from here on the longest block is known
  std::vector<double> heard;
  std::uint64_t draw = 0;
  for (int i = 0; i < 400; ++i) {
    const auto most = i % 3 == 0 ? 8191 : 300;
    const auto size = i % 40 == 0 ? 8192 : 1 + static_cast<std::size_t>(random.unit(draw++) * most);
    // Heard while the block before was played, in order; the last one just before this block.
    const double before = static_cast<double>(device.frames()) - 1;
    for (const double frame : {before - random.unit(draw++) / 2, before + random.unit(draw++)}) {
      heard.push_back(frame);
      live->push(0, message(device.time_of(frame), 0xB0, 1, static_cast<int>(draw & 127)));
    }
    device.block(size);
  }
  device.blocks(2, 8192);
  const Journal journal = journal_of(*live);
  const LiveStatus status = live->status();
  EXPECT_EQ(status.latency_frames, 8192 + 24);
  EXPECT_EQ(status.messages_late, 0);
  ASSERT_EQ(journal.records.size(), heard.size());
  for (std::size_t i = 0; i < heard.size(); ++i) {
    const auto waited = static_cast<double>(journal.records[i].time.sample) - heard[i];
    ASSERT_NEAR(waited, status.latency_frames, 0.51) << "message " << i;
    EXPECT_EQ(journal.records[i].time.fraction, 0u);
  }
}

TEST(LiveEngine, JitterOfTheDeviceIsFilteredOutOfTheMessages) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  const base::RandomStream random{support::test_seed(), 0, 3002};
  constexpr std::size_t kBlock = 256;
  constexpr int kBlocks = 6000;  // half a minute
  std::vector<double> heard;
  for (int i = 0; i < kBlocks; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    heard.push_back(static_cast<double>(device.frames()) - kBlock * random.unit(4 * n));
    if (i > 0) live->push(0, message(device.time_of(heard.back()), 0xB0, 1, i & 127));
    // Up to 0.4 ms late, and now and then far too late.
    const double late = random.unit(4 * n + 1) < 0.01 ? 5e6 : 0.4e6 * random.unit(4 * n + 2);
    device.block(kBlock, static_cast<std::int64_t>(late));
  }
  const Journal journal = journal_of(*live);
  ASSERT_GT(journal.records.size(), std::size_t{kBlocks} - 4);
  double least = 1e9, most = 0;
  for (std::size_t i = kBlocks / 3; i < journal.records.size(); ++i) {
    const double waited = static_cast<double>(journal.records[i].time.sample) - heard[i + 1];
    least = std::min(least, waited);
    most = std::max(most, waited);
  }
  // A block at a time would spread them over 256 samples and the jitter.
  EXPECT_LT(most - least, 10) << least << " to " << most;
  EXPECT_EQ(live->status().messages_late, 0);
}

TEST(LiveEngine, MessagesOfSeveralInputsComeInOrderOfTimeAndAtOneTimeInOrderOfInputs) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  device.blocks(2, 512);
  const auto at = [&](double frame) { return device.time_of(600 + frame); };
  live->push(2, message(at(10), 0xB0, 1, 3));
  live->push(2, message(at(20), 0xB0, 1, 5));
  live->push(1, message(at(10), 0xB0, 1, 2));
  live->push(1, message(at(30), 0xB0, 1, 6));
  live->push(0, message(at(5), 0xB0, 1, 1));
  live->push(0, message(at(15), 0xB0, 1, 4));
  const std::array<base::MidiEvent, 2> exact = {base::MidiEvent{{0, 0}, {0xB0, 2, 0}},
                                                base::MidiEvent{{511, 0}, {0xB0, 2, 127}}};
  device.block(512, 0, exact);
  device.block(512);
  const Journal journal = journal_of(*live);
  std::vector<int> values;
  for (const JournalRecord& record : journal.records) values.push_back(record.bytes[2]);
  EXPECT_EQ(values, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 127}));
  EXPECT_EQ(journal.records.front().time.sample, 1024);
  EXPECT_EQ(journal.records.back().time.sample, 1024 + 511);
}

TEST(LiveEngine, ExactEventsOfEveryKindPlayAsOfflineFractionsOfASampleIncluded) {
  const auto bank = bank_from(kPlain);
  const base::RandomStream random{support::test_seed(), 0, 3004};
  std::vector<Event> events;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto key = static_cast<std::uint8_t>(60 + i % 12);
    Event event;
    event.midi.time = {static_cast<std::int64_t>(400 * i + random.bits(2 * i) % 300),
                       static_cast<std::uint32_t>(random.bits(2 * i + 1))};
    event.midi.bytes[0] = i % 2 == 0 ? 0x90 : 0x80;
    event.midi.bytes[1] = i % 2 == 0 ? key : static_cast<std::uint8_t>(key - 1);
    event.midi.bytes[2] = 100;
    if (i % 10 == 5) event.kind = Event::Kind::tempo;
    if (i % 10 == 7) event.kind = Event::Kind::position;
    event.song_clocks = static_cast<std::int64_t>(i);
    if (i % 10 == 9) event.kind = Event::Kind::all_notes_off;
    events.push_back(event);
  }
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  std::size_t next = 0;
  while (device.frames() < 25000) {
    const auto frames = static_cast<std::int64_t>(1 + random.bits(1000 + next) % 700);
    std::vector<Event> due;
    for (; next < events.size() && events[next].time().sample < device.frames() + frames; ++next) {
      due.push_back(events[next]);
      due.back().midi.time.sample -= device.frames();
    }
    device.block_with(static_cast<std::size_t>(frames), 0, due);
  }
  const auto offline = engine_for(*bank, {});
  const Sound expected = play(*offline, events, static_cast<std::size_t>(device.frames()));
  EXPECT_GT(peak(expected.left), 0.01);
  EXPECT_EQ(device.sound().left, expected.left);
  EXPECT_EQ(device.sound().right, expected.right);
  const Journal journal = journal_of(*live);
  ASSERT_EQ(journal.records.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(journal.records[i].time, events[i].time());
    EXPECT_EQ(journal.records[i].kind, events[i].kind);
  }
}

TEST(LiveEngine, AMessageWithoutATimeAndALateOneSoundAtTheFirstSampleOfTheBlock) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  device.blocks(9, 256);
  live->push(0, message(0, 0xB0, 1, 1));
  live->push(1, message(device.time_of(3), 0xB0, 1, 2));
  device.block(256);
  const Journal journal = journal_of(*live);
  ASSERT_EQ(journal.records.size(), 2u);
  EXPECT_EQ(journal.records[0].time.sample, 9 * 256);
  EXPECT_EQ(journal.records[1].time.sample, 9 * 256);
  EXPECT_EQ(live->status().messages_late, 1);
}

TEST(LiveEngine, ANoteOnOverASecondLateIsDroppedAndItsNoteOffIsNot) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  device.blocks(400, 256);
  live->push(0, message(device.time_of(3), 0x90, 60, 100));
  live->push(0, message(device.time_of(9), 0x80, 60, 64));
  device.block(256);
  const Journal journal = journal_of(*live);
  ASSERT_EQ(journal.records.size(), 1u);
  EXPECT_EQ(journal.records[0].bytes[0], 0x80);
  EXPECT_EQ(live->status().messages_dropped, 1);
}

TEST(LiveEngine, GarbageTimesStayWithinABlockAndTheLatency) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  device.blocks(4, 256);
  for (const std::int64_t time : {INT64_MAX, INT64_MIN, std::int64_t{-1}, std::int64_t{1}}) {
    live->push(0, message(time, 0xB0, 1, 1));
  }
  device.blocks(4, 256);
  const Journal journal = journal_of(*live);
  ASSERT_EQ(journal.records.size(), 4u);
  for (const JournalRecord& record : journal.records) {
    EXPECT_GE(record.time.sample, 4 * 256);
    EXPECT_LE(record.time.sample, 7 * 256);
  }
}

TEST(LiveEngine, WhereARingIsFullNothingThatEndsNotesIsLost) {
  const auto live = live_for(bank_from(kPlain), {.input_messages = 64});
  Device device(*live);
  for (int key = 0; key < 32; ++key) EXPECT_TRUE(live->push(0, message(0, 0x90, key, 100)));
  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += live->push(0, message(0, 0xB0, 1, i)) ? 1 : 0;
  EXPECT_EQ(taken, 32);
  for (int key = 0; key < 32; ++key) EXPECT_TRUE(live->push(0, message(0, 0x80, key, 64)));
  device.block(256);
  device.blocks(100, 1024);
  EXPECT_EQ(live->status().messages_dropped, 68);
  EXPECT_EQ(live->status().counters.voices_now, 0);
  EXPECT_EQ(live->status().counters.notes, 32);
}

TEST(LiveEngine, WhereEvenTheReserveIsFullTheChannelGoesSilentAndTheNextNoteSounds) {
  const auto live = live_for(bank_from(kPlain), {.input_messages = 64});
  Device device(*live);
  for (int key = 0; key < 64; ++key) EXPECT_TRUE(live->push(3, message(0, 0x95, key, 100)));
  int lost = 0;
  for (int i = 0; i < 100; ++i) lost += live->push(3, message(0, 0x85, i & 63, 0)) ? 0 : 1;
  EXPECT_EQ(lost, 36);
  device.block(256);
  live->push(3, message(0, 0x95, 70, 100));
  device.blocks(10, 1024);
  EXPECT_EQ(live->status().counters.voices_now, 1);
  const Journal journal = journal_of(*live);
  const auto silenced = std::find_if(
      journal.records.begin(), journal.records.end(),
      [](const JournalRecord& r) { return r.bytes[0] == 0xB5 && r.bytes[1] == kAllSoundOff; });
  ASSERT_NE(silenced, journal.records.end());
  EXPECT_EQ(silenced - journal.records.begin(), 64 + 64 + 2);
}

TEST(LiveEngine, PanicEndsEveryNoteOfTheNextBlockAndThoseStillUnderWay) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  device.blocks(4, 512);
  for (int channel = 0; channel < 16; ++channel) {
    live->push(0, message(device.time_ns(), 0xB0 | channel, kSustain, 127));
    live->push(0, message(device.time_ns(), 0x90 | channel, 60, 127));
    live->push(0, message(device.time_ns(), 0xC0 | channel, 5, 0));
  }
  device.blocks(4, 512);
  EXPECT_EQ(live->status().counters.voices_now, 16);
  live->push(0, message(device.time_ns(), 0x90, 62, 127));
  live->panic();
  device.blocks(2, 512);
  const auto quiet_from = static_cast<std::size_t>(8 * 512 + 0.006 * kRateHz);
  EXPECT_GT(peak(device.sound().left, 0, quiet_from), 0.01);
  EXPECT_EQ(peak(device.sound().left, quiet_from), 0);
  EXPECT_EQ(live->status().counters.voices_now, 0);
  live->push(0, message(device.time_ns(), 0x90, 62, 127));
  device.blocks(4, 512);
  EXPECT_EQ(live->status().counters.voices_now, 1);
}

TEST(LiveEngine, FadesAfterTheTapAndTheJournal) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  live->set_tap(true);
  live->push(0, message(0, 0x90, 60, 127));
  device.blocks(20, 512);
  live->fade(0, 0.05F);
  device.blocks(10, 512);
  EXPECT_GT(peak(device.sound().left, 20 * 512, 20 * 512 + 1000), 0.01);
  EXPECT_EQ(peak(device.sound().left, 20 * 512 + 2400), 0);
  live->fade(1, 0);
  device.block(512);
  std::vector<float> taken(2 * 31 * 512);
  const LiveEngine::Tap tap = live->take_tap(taken);
  EXPECT_EQ(tap.first, 0);
  ASSERT_EQ(tap.frames, 31u * 512u);
  const Journal journal = journal_of(*live);
  const Sound again = played_again(
      journal, [](std::uint32_t) { return bank_from(kPlain); }, tap.frames);
  for (std::size_t i = 0; i < tap.frames; ++i) {
    ASSERT_EQ(taken[2 * i], again.left[i]) << i;
    ASSERT_EQ(taken[2 * i + 1], again.right[i]) << i;
  }
  for (std::size_t i = 30 * 512 + 1; i < tap.frames; ++i) {
    ASSERT_EQ(device.sound().left[i], again.left[i]) << i;
  }
}

TEST(LiveEngine, TheTapSaysWhereSamplesAreMissing) {
  const auto live = live_for(bank_from(kPlain), {.tap_s = 1024 / kRateHz});
  Device device(*live);
  std::vector<float> out(2 * 4096);
  device.block(256);
  EXPECT_EQ(live->take_tap(out).frames, 0u);
  live->set_tap(true);
  device.blocks(8, 256);  // room for four of them
  EXPECT_EQ(live->status().tap_dropped_frames, 1024);
  LiveEngine::Tap tap = live->take_tap(std::span(out).first(2 * 1000));
  EXPECT_EQ(tap.first, 256);
  EXPECT_EQ(tap.frames, 1000u);
  device.block(256);
  tap = live->take_tap(out);
  EXPECT_EQ(tap.first, 1256);
  EXPECT_EQ(tap.frames, 24u);
  tap = live->take_tap(out);
  EXPECT_EQ(tap.first, 9 * 256);
  EXPECT_EQ(tap.frames, 256u);
  live->set_tap(false);
  device.block(256);
  live->set_tap(true);
  device.block(256);
  tap = live->take_tap(out);
  EXPECT_EQ(tap.first, 11 * 256);
  EXPECT_EQ(tap.frames, 256u);
}

TEST(LiveEngine, KeepsTheTextOfABankOnceAndTheInstallsByItsPlace) {
  const JournalBank one{"one", {{"one", "first"}}}, two{"two", {{"two", "second"}}};
  const auto live = live_for(bank_from(kPlain), {}, one);
  Device device(*live);
  Journal journal;
  device.block(64);
  for (const JournalBank& bank : {two, one, two}) {
    EXPECT_TRUE(live->install(bank_from(kPlain), bank));
    device.block(64);
    live->take_journal(journal);
  }
  EXPECT_TRUE(live->install(bank_from(kPlain), two));  // two for one block: the last is played
  EXPECT_TRUE(live->install(bank_from(kPlain), one));
  device.block(64);
  live->take_journal(journal);
  ASSERT_EQ(journal.banks.size(), 2u);
  EXPECT_EQ(journal.banks[0].path, "one");
  EXPECT_EQ(journal.banks[1].path, "two");
  std::vector<int> installed;
  for (const JournalRecord& record : journal.records) {
    EXPECT_EQ(record.kind, Event::Kind::install_bank);
    installed.push_back(static_cast<int>(record.index));
  }
  EXPECT_EQ(installed, (std::vector<int>{1, 0, 1, 0}));
}

TEST(LiveEngine, CountsWhatTheJournalHadNoRoomFor) {
  const auto live = live_for(bank_from(kPlain), {.journal_records = 8});
  Device device(*live);
  for (int i = 0; i < 20; ++i) live->push(0, message(0, 0xB0, 1, i));
  device.block(64);
  EXPECT_EQ(live->status().journal_dropped, 12);
  EXPECT_EQ(journal_of(*live).records.size(), 8u);
}

TEST(LiveEngine, MoreEventsThanOneCallTakesAreAllPlayedInOrder) {
  const auto live = live_for(bank_from(kPlain), {.input_messages = 8192});
  Device device(*live);
  for (int i = 0; i < 5000; ++i) live->push(0, message(0, 0xB0, 1, i & 127));
  std::vector<base::MidiEvent> exact(5000, base::MidiEvent{{100, 0}, {0xB0, 2, 1}});
  device.block(512, 0, exact);
  const Journal journal = journal_of(*live);
  ASSERT_EQ(journal.records.size(), 10000u);
  for (std::size_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(journal.records[i].bytes[2], i & 127);
    EXPECT_EQ(journal.records[i].time.sample, 0);
    EXPECT_EQ(journal.records[5000 + i].time.sample, 100);
  }
  EXPECT_EQ(live->status().counters.events_late, 0);
}

TEST(LiveEngine, ShowsTheMomentAndThePeakSinceTheLastLook) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  EXPECT_EQ(live->status().now, 0);
  live->push(0, message(0, 0x90, 60, 127));
  live->push(0, message(0, 0xF8, 0, 0));  // clock is passed over
  device.blocks(8, 512);
  const LiveStatus status = live->status();
  EXPECT_EQ(status.now, 8 * 512);
  EXPECT_EQ(status.messages, 1);
  EXPECT_EQ(status.last_midi[0], 0x90);
  EXPECT_EQ(static_cast<double>(status.peak_left), peak(device.sound().left));
  EXPECT_EQ(static_cast<double>(status.peak_right), peak(device.sound().right));
  EXPECT_EQ(live->status().peak_left, 0);
}

TEST(LiveEngine, ShowsWhereTheNewestNoteIsInItsEnvelope) {
  const auto live = live_for(bank_from(kPlain));
  Device device(*live);
  device.block(48);
  EXPECT_EQ(live->status().envelope_position, -1);
  EXPECT_EQ(live->status().envelope_patch, -1);
  live->push(0, message(0, 0x90, 60, 127));
  device.block(240);  // 5 ms of 60
  EXPECT_NEAR(live->status().envelope_position, 5.0 / 60, 1e-9);
  EXPECT_EQ(live->status().envelope_patch, 0);
  device.block(4800);  // held at 10 ms
  EXPECT_NEAR(live->status().envelope_position, 10.0 / 60, 1e-9);
  live->push(0, message(0, 0x80, 60, 0));
  device.block(1200);  // 25 ms
  EXPECT_NEAR(live->status().envelope_position, 35.0 / 60, 1e-9);
  device.block(4800);
  EXPECT_EQ(live->status().envelope_position, -1);
}

TEST(LiveMessage, HoldsShortSystemExclusiveAndTellsLongByItsSize) {
  std::array<std::uint8_t, 25> data{};
  data.fill(7);
  base::MidiEvent event;
  event.bytes[0] = 0xF0;
  event.sysex = data.data();
  event.sysex_size = 24;
  EXPECT_EQ(live_message(event, 5).sysex_size, 24);
  EXPECT_EQ(live_message(event, 5).sysex[23], 7);
  EXPECT_EQ(live_message(event, 5).time_ns, 5);
  event.sysex_size = 25;
  EXPECT_EQ(live_message(event, 5).sysex_size, 0);
}

}  // namespace
}  // namespace knotwave::engine

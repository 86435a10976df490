// SPDX-License-Identifier: MIT
// The MIDI reader, fault by fault, without a corpus.
#include "knotwave/io/midi_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/midi_bytes.h"

namespace knotwave::io {
namespace {

using testing::HasSubstr;

/// The song and the one warning it came with.
Song with_warning(const Bytes& bytes, const std::string& text) {
  auto song = parse(bytes);
  EXPECT_TRUE(song.has_value()) << song.error().to_string();
  if (!song) return {};
  EXPECT_EQ(song->warnings.size(), 1u);
  if (song->warnings.empty()) return *song;
  EXPECT_THAT(song->warnings[0].message, HasSubstr(text));
  return *song;
}
Song without_warning(const Bytes& bytes) {
  auto song = parse(bytes);
  EXPECT_TRUE(song.has_value()) << song.error().to_string();
  if (!song) return {};
  EXPECT_TRUE(song->warnings.empty()) << song->warnings[0].message;
  return *song;
}
void expect_error(const Bytes& bytes, ErrorCode code, long long offset, const std::string& text) {
  const auto song = parse(bytes);
  ASSERT_FALSE(song.has_value());
  EXPECT_EQ(song.error().code, code);
  EXPECT_EQ(song.error().offset, offset);
  EXPECT_EQ(song.error().source, "test.mid");
  EXPECT_THAT(song.error().message, HasSubstr(text));
}
void expect_one_note(const Song& song, std::uint64_t tick = 0) {
  ASSERT_EQ(song.events.size(), 2u);
  EXPECT_EQ(song.events[0].tick, tick);
  EXPECT_EQ(song.events[0].bytes[0], 0x90);
  EXPECT_EQ(song.events[0].bytes[1], 0x3C);
  EXPECT_EQ(song.events[0].bytes[2], 0x64);
  EXPECT_EQ(song.events[1].tick, tick + 96);
  EXPECT_EQ(song.events[1].bytes[0], 0x80);
}

TEST(MidiFile, ANoteIsReadWithItsTicks) {
  const Song song = without_warning(header() + track(kNote + kEnd));
  expect_one_note(song);
  EXPECT_EQ(song.format, 0);
  EXPECT_EQ(song.track_count, 1);
  EXPECT_EQ(song.time_base.ticks_per_quarter, 96);
  EXPECT_EQ(song.length_ticks, 96u);
}

TEST(MidiFile, AnEmptyFileIsMalformed) { expect_error({}, ErrorCode::malformed, 0, "empty"); }

TEST(MidiFile, AWebPageIsCalledOne) {
  expect_error(text_bytes("<!DOCTYPE html><html></html>"), ErrorCode::malformed, 0, "web page");
}

TEST(MidiFile, EveryTruncationOfTheHeaderIsMalformed) {
  const Bytes whole = header();
  for (std::size_t n = 1; n < whole.size(); ++n) {
    EXPECT_FALSE(parse(Bytes(whole.begin(), whole.begin() + static_cast<long>(n)))) << n;
  }
  with_warning(whole, "the header says 1 tracks, the file has 0");
}

TEST(MidiFile, EveryTruncationOfATrackKeepsTheEventsBeforeIt) {
  const Bytes whole = header() + track(kNote + kNote + kEnd);
  for (std::size_t n = 22; n < whole.size(); ++n) {
    const auto song = parse(Bytes(whole.begin(), whole.begin() + static_cast<long>(n)));
    ASSERT_TRUE(song.has_value()) << n;
    EXPECT_EQ(song->events.size(), (n - 22) / 4) << n;
    EXPECT_GE(song->warnings.size(), 1u) << n;
  }
}

TEST(MidiFile, ALongerHeaderIsPassedOver) {
  Bytes long_header = header();
  long_header[7] = 8;
  expect_one_note(without_warning(long_header + Bytes{0xAA, 0xBB} + track(kNote + kEnd)));
}

TEST(MidiFile, AHeaderLengthBelowSixOrPastTheFileIsMalformed) {
  Bytes bytes = header() + track(kNote + kEnd);
  bytes[7] = 5;
  expect_error(bytes, ErrorCode::malformed, 4, "the header says it has 5 bytes");
  bytes[4] = 0xFF;
  expect_error(bytes, ErrorCode::malformed, 4, "4278190085");
}

TEST(MidiFile, FormatThreeIsUnsupported) {
  expect_error(header(3) + track(kNote + kEnd), ErrorCode::unsupported_format, 8, "format 3");
}

TEST(MidiFile, ZeroTicksAreMalformed) {
  expect_error(header(0, 1, 0) + track(kEnd), ErrorCode::malformed, 12, "0 ticks a quarter");
  expect_error(header(0, 1, 0xE700) + track(kEnd), ErrorCode::malformed, 12, "0 ticks a frame");
}

TEST(MidiFile, SmpteRatesAreTheFourOfTheStandard) {
  for (const int fps : {24, 25, 29, 30}) {
    const Song song = without_warning(header(0, 1, (256 - fps) << 8 | 40) + track(kNote + kEnd));
    EXPECT_EQ(song.time_base, (TimeBase{0, fps, 40}));
  }
  for (const int fps : {1, 23, 60, 128}) {
    expect_error(header(0, 1, (256 - fps) << 8 | 40) + track(kEnd), ErrorCode::malformed, 12,
                 std::to_string(fps) + " frames a second");
  }
}

TEST(MidiFile, JunkBeforeTheHeaderIsPassedOverUpToOneKibibyte) {
  const Bytes midi = header() + track(kNote + kEnd);
  expect_one_note(with_warning(Bytes(128) + midi, "128 bytes before"));
  expect_one_note(with_warning(Bytes(1024) + midi, "1024 bytes before"));
  expect_error(Bytes(1025) + midi, ErrorCode::malformed, 0, "MThd");
}

TEST(MidiFile, BytesAfterTheLastTrackAreToldOf) {
  expect_one_note(with_warning(header() + track(kNote + kEnd) + Bytes(777), "777 bytes after"));
}

TEST(MidiFile, ASecondFileIsNotRead) {
  const Bytes one = header() + track(kNote + kEnd);
  expect_one_note(with_warning(one + one, "second MIDI file"));
}

TEST(MidiFile, UnknownChunksArePassedOver) {
  const Bytes unknown = chunk("XFIH", text_bytes("abcd"));
  expect_one_note(without_warning(header() + unknown + track(kNote + kEnd) + unknown));
}

TEST(MidiFile, AnUnknownChunkPastTheEndIsMalformedBeforeTheFirstTrackOnly) {
  const Bytes huge = chunk("XXXX", {}, 0xFFFFFFFFLL);
  const Bytes notes = track(kNote + kEnd);
  expect_error(header() + huge + notes, ErrorCode::malformed, 14, "4294967295");
  expect_one_note(with_warning(header() + notes + huge, "4294967295"));
}

TEST(MidiFile, AWrongTrackCountIsToldOf) {
  const Bytes one = track(kNote + kEnd);
  with_warning(header(1, 65535) + one, "says 65535 tracks, the file has 1");
  with_warning(header(1, 1) + one + one + one, "says 1 tracks, the file has 3");
  expect_one_note(with_warning(header(0, 0) + one, "says 0 tracks, the file has 1"));
  EXPECT_EQ(with_warning(header(0, 2) + one + one, "format 0 with 2 tracks").events.size(), 4u);
}

TEST(MidiFile, ATrackEndsAtItsEndOfTrackWhateverLengthItDeclares) {
  const Bytes body = kNote + kEnd;
  for (const long long declared : {0LL, 5LL, 13LL, 0x80000000LL, 0xFFFFFFFFLL}) {
    const Song song = with_warning(header() + track(body, declared), "track 0 says it has");
    expect_one_note(song);
  }
}

TEST(MidiFile, ATrackFollowsOneOfHugeLength) {
  const Bytes bytes = header(1, 2) + track(kNote + kEnd, 0xFFFFFFFFLL) + track(kNote + kEnd);
  EXPECT_EQ(with_warning(bytes, "says it has 4294967295").events.size(), 4u);
}

TEST(MidiFile, AMissingEndOfTrackIsToldOf) {
  expect_one_note(with_warning(header() + track(kNote), "track 0 has no End of Track"));
}

TEST(MidiFile, WhatFollowsEndOfTrackIsNotRead) {
  EXPECT_TRUE(
      with_warning(header() + track(kEnd + kNote), "8 bytes after End of Track").events.empty());
}

TEST(MidiFile, AnEndOfTrackWithContentIsOne) {
  expect_one_note(with_warning(header() + track(kNote + meta(0x2F, text_bytes("abcde"))),
                               "End of Track is not empty"));
}

TEST(MidiFile, NumbersHaveAtMostFourBytes) {
  EXPECT_EQ(
      without_warning(header() + track(Bytes{0xFF, 0xFF, 0xFF, 0x7F, 0x90, 0x3C, 0x64} + kEnd))
          .events[0]
          .tick,
      0x0FFFFFFFu);
  EXPECT_EQ(without_warning(header() + track(Bytes{0x80, 0x80, 0x05, 0x90, 0x3C, 0x64} + kEnd))
                .events[0]
                .tick,
            5u);
  expect_error(header() + track(Bytes{0x81, 0x80, 0x80, 0x80, 0x00, 0x90, 0x3C, 0x64} + kEnd),
               ErrorCode::malformed, 22, "a delta time of track 0 has more than 4 bytes");
  expect_error(header() + track(Bytes(4096, 0x80)), ErrorCode::malformed, 22, "more than 4");
  expect_error(header() + track(Bytes{0x00, 0xFF, 0x01, 0x80, 0x80, 0x80, 0x80, 0x00} + kEnd),
               ErrorCode::malformed, 25, "a meta event of track 0 has more than 4 bytes");
}

TEST(MidiFile, TicksAreCountedIn64Bits) {
  Bytes body;
  for (int i = 0; i < 40; ++i) body = body + Bytes{0xFF, 0xFF, 0xFF, 0x7F, 0x90, 0x3C, 0x64};
  const Song song = without_warning(header() + track(body + kEnd));
  EXPECT_EQ(song.length_ticks, 40ull * 0x0FFFFFFF);
  EXPECT_GT(song.length_ticks, 0xFFFFFFFFull);
}

TEST(MidiFile, RunningStatusHolds) {
  const Song song =
      without_warning(header() + track(Bytes{0x00, 0x90, 0x3C, 0x64, 0x10, 0x3C, 0x00} + kEnd));
  ASSERT_EQ(song.events.size(), 2u);
  EXPECT_EQ(song.events[1].bytes[0], 0x90);
  EXPECT_EQ(song.events[1].tick, 16u);
}

TEST(MidiFile, RunningStatusAfterMetaOrSysexHoldsAndIsToldOfOnce) {
  const Bytes note_on = {0x00, 0x90, 0x3C, 0x64};
  const Bytes running = {0x10, 0x3C, 0x00};
  const Bytes sysex = {0x00, 0xF0, 0x02, 0x7E, 0xF7};
  const std::string warning = "goes on after a meta or system event";
  EXPECT_EQ(with_warning(header() + track(note_on + meta(1, {'a'}) + running + meta(1, {'b'}) +
                                          running + kEnd),
                         warning)
                .events.size(),
            3u);
  EXPECT_EQ(with_warning(header() + track(note_on + sysex + running + kEnd), warning).events.size(),
            3u);
}

TEST(MidiFile, RunningStatusDoesNotCrossTracks) {
  const Bytes bytes = header(1, 2) + track(Bytes{0x00, 0x90, 0x3C, 0x64} + kEnd) +
                      track(Bytes{0x00, 0x3C, 0x00} + kEnd);
  EXPECT_EQ(with_warning(bytes, "data byte 0x3C comes before any status").events.size(), 1u);
}

TEST(MidiFile, AMessageWithADataByteAbove127IsLeftOut) {
  const Song song = with_warning(header() + track(Bytes{0x00, 0x90, 0xBC, 0x64} + kNote + kEnd),
                                 "message 0x90 with a data byte above 0x7F");
  expect_one_note(song);
}

TEST(MidiFile, SystemMessagesAreLeftOutWithTheirDataBytes) {
  const Bytes body = {0x00, 0xF1, 0x11, 0x00, 0xF2, 0x22, 0x22, 0x00, 0xF3, 0x33,
                      0x00, 0xF4, 0x00, 0xF5, 0x00, 0xF6, 0x00, 0xF8, 0x00, 0xFE};
  const auto song = parse_track(body + kNote + kEnd);
  ASSERT_TRUE(song.has_value());
  EXPECT_EQ(song->warnings.size(), 8u);
  expect_one_note(*song);
}

TEST(MidiFile, TempoAndMeterAreMapped) {
  const Song song =
      without_warning(header() + track(meta(0x51, {0x07, 0xA1, 0x20}) + meta(0x58, {6, 3, 24, 8}) +
                                       kNote + meta(0x51, {0x00, 0x00, 0x01}) + kEnd));
  EXPECT_EQ(song.tempos, (std::vector<TempoChange>{{0, 500000}, {96, 1}}));
  EXPECT_EQ(song.meters, (std::vector<MeterChange>{{0, 6, 8}}));
}

TEST(MidiFile, MetaEventsOutOfRangeAreLeftOut) {
  const struct {
    Bytes event;
    const char* warning;
  } cases[] = {{meta(0x51, {0, 0, 0}), "tempo of 0 microseconds"},
               {meta(0x51, {1, 1}), "tempo of 2 bytes"},
               {meta(0x51, {}), "tempo of 0 bytes"},
               {meta(0x58, {4, 255, 24, 8}), "meter 4/2^255"},
               {meta(0x58, {0, 2, 24, 8}), "meter 0/2^2"},
               {meta(0x58, {4, 2}), "meter of 2 bytes"},
               {meta(0x59, {0x7F, 0xFF}), "key signature"},
               {meta(0x54, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF}), "SMPTE offset"}};
  for (const auto& c : cases) {
    const Song song = with_warning(header() + track(c.event + kNote + kEnd), c.warning);
    expect_one_note(song);
    EXPECT_TRUE(song.tempos.empty());
    EXPECT_TRUE(song.meters.empty());
  }
}

TEST(MidiFile, MetaLengthsPastTheEndCutTheTrack) {
  const Bytes body = kNote + Bytes{0x00, 0xFF, 0x01, 0xFF, 0xFF, 0xFF, 0x7F, 'a', 'b', 'c'};
  expect_one_note(with_warning(header() + track(body), "268435455 bytes where 3 are left"));
  expect_one_note(with_warning(header() + track(kNote + Bytes{0x00, 0xFF}), "cut off"));
}

TEST(MidiFile, TextsAreKeptAsTheyAre) {
  const Bytes name = {0xFF, 0xFE, 0x00, 0x80, 'e', 0x1B, '['};
  const Song song = without_warning(header() + track(meta(3, name) + kNote + kEnd));
  ASSERT_EQ(song.texts.size(), 1u);
  EXPECT_EQ(song.texts[0].meta_type, 3);
  EXPECT_EQ(song.texts[0].text, std::string(name.begin(), name.end()));
}

TEST(MidiFile, SysexIsKeptWithoutItsFrame) {
  const Song song = without_warning(
      header() + track(Bytes{0x05, 0xF0, 0x05, 0x7E, 0x7F, 0x09, 0x01, 0xF7} + kEnd));
  ASSERT_EQ(song.events.size(), 1u);
  EXPECT_EQ(song.events[0], (SongEvent{5, 0, {0xF0, 0, 0}, 0, 4}));
  EXPECT_EQ(song.sysex_bytes, (Bytes{0x7E, 0x7F, 0x09, 0x01}));
}

TEST(MidiFile, SplitSysexIsOneEventAtItsLastPacket) {
  const Song song =
      without_warning(header() + track(Bytes{0x00, 0xF0, 0x03, 0x43, 0x12, 0x00, 0x10, 0xF7, 0x02,
                                             0x43, 0x12, 0x08, 0xF7, 0x02, 0x44, 0xF7} +
                                       kEnd));
  ASSERT_EQ(song.events.size(), 1u);
  EXPECT_EQ(song.events[0], (SongEvent{24, 0, {0xF0, 0, 0}, 0, 6}));
  EXPECT_EQ(song.sysex_bytes, (Bytes{0x43, 0x12, 0x00, 0x43, 0x12, 0x44}));
}

TEST(MidiFile, SysexWithoutEndIsLeftOut) {
  const Bytes open = {0x00, 0xF0, 0x04, 0x7E, 0x7F, 0x09, 0x01};
  const Song song = with_warning(header() + track(open + kNote + kEnd), "has no end (F7)");
  expect_one_note(song);
  EXPECT_TRUE(song.sysex_bytes.empty());
  with_warning(header() + track(open + kEnd), "has no end (F7)");
  with_warning(header() + track(Bytes{0x00, 0xF0, 0x00} + kEnd), "of no bytes");
  with_warning(header() + track(Bytes{0x00, 0xF0, 0x8F, 0xFF, 0xFF, 0x7F, 0x7E}), "33554431 bytes");
}

TEST(MidiFile, EscapesArePassedOver) {
  expect_one_note(without_warning(header() + track(Bytes{0x00, 0xF7, 0x01, 0xF8} + kNote + kEnd)));
}

TEST(MidiFile, TracksAreMergedByTickThenTrack) {
  const auto program = [](int delta, int value) {
    return Bytes{static_cast<std::uint8_t>(delta), 0xC0, static_cast<std::uint8_t>(value)};
  };
  const Song song = without_warning(
      header(1, 3) + track(program(0, 1) + program(0, 2) + program(9, 3) + kEnd) +
      track(program(0, 4) + program(3, 5) + program(6, 6) + kEnd) + track(program(2, 7) + kEnd));
  std::vector<int> order;
  for (const SongEvent& e : song.events) order.push_back(e.bytes[1]);
  EXPECT_EQ(order, (std::vector<int>{1, 2, 4, 7, 5, 3, 6}));
}

TEST(MidiFile, PatternsOfFormatTwoFollowOneAnotherFromTheirOwnTempo) {
  const Bytes slow = track(meta(0x51, {0x0F, 0x42, 0x40}) + kNote + kEnd);
  const Song song = without_warning(header(2, 2) + slow + track(kNote + kEnd));
  ASSERT_EQ(song.events.size(), 4u);
  EXPECT_EQ(song.events[2].tick, 96u);
  EXPECT_EQ(song.length_ticks, 192u);
  EXPECT_EQ(song.tempos, (std::vector<TempoChange>{{0, 1000000}, {96, 500000}}));
}

TEST(MidiFile, RmidIsUnwrapped) {
  const Bytes midi = header() + track(kNote + kEnd);
  const auto little = [](std::size_t n) {
    return Bytes{static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n >> 8), 0, 0};
  };
  const Bytes list = text_bytes("LIST") + little(3) + text_bytes("abc") + Bytes{0};
  const Bytes data = text_bytes("data") + little(midi.size()) + midi;
  const Bytes body = text_bytes("RMID") + list + data;
  expect_one_note(without_warning(text_bytes("RIFF") + little(body.size()) + body));

  const Bytes huge = text_bytes("data") + Bytes(4, 0xFF) + midi;
  expect_one_note(with_warning(text_bytes("RIFF") + Bytes(4, 0xFF) + text_bytes("RMID") + huge,
                               "the RIFF data chunk says 4294967295 bytes"));
  expect_error(text_bytes("RIFF") + little(4) + text_bytes("RMID"), ErrorCode::malformed, 12,
               "without MIDI data");
}

TEST(MidiFile, SeveralPortsOnSixteenChannelsAreToldOf) {
  const Bytes port0 = track(meta(0x21, {0}) + kNote + kEnd);
  const Bytes port1 = track(meta(0x21, {1}) + kNote + kEnd);
  without_warning(header(1, 2) + port0 + port0);
  with_warning(header(1, 2) + port0 + port1, "several MIDI ports");
}

TEST(MidiFile, OnlyTheFirstHundredWarningsAreKept) {
  Bytes body;
  for (int i = 0; i < 150; ++i) body = body + Bytes{0x00, 0xF8};
  const auto song = parse_track(body + kEnd);
  EXPECT_EQ(song->warnings.size(), 100u);
  EXPECT_EQ(song->warnings_left_out, 50u);
}

TEST(MidiFile, AFileOfMoreThan64MebibytesIsTooLarge) {
  const Bytes bytes(kMaxMidiFileBytes + 1);
  expect_error(bytes, ErrorCode::file_too_large, 0, "67108865 bytes");
}

TEST(MidiFile, WarningsCarryTheirOffset) {
  EXPECT_EQ(parse(header() + track(kNote))->warnings[0].offset, 30u);
}

}  // namespace
}  // namespace knotwave::io

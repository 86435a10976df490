// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "knotwave/io/midi_file.h"

#include "io/midi_bytes.h"
#include "support/corpus.h"

namespace knotwave::io {
namespace {

void expect_same_song(const Song& a, const Song& b, const std::string& name) {
  EXPECT_EQ(a.events, b.events) << name;
  EXPECT_EQ(a.tempos, b.tempos) << name;
  EXPECT_EQ(a.meters, b.meters) << name;
  EXPECT_EQ(a.texts, b.texts) << name;
  EXPECT_EQ(a.time_base, b.time_base) << name;
  EXPECT_EQ(a.length_ticks, b.length_ticks) << name;
}

TEST(WriteMidi, OneTrackIsFormatZeroToTheByte) {
  const Bytes bytes = header() + track(Bytes{0x00, 0xC0, 0x05} + kNote + kEnd);
  EXPECT_EQ(write_midi(*parse(bytes)), bytes);
}

TEST(WriteMidi, SysexTempoMeterAndTextComeBack) {
  const Bytes bytes =
      header(1, 2, 0xE728) +
      track(meta(0x51, {0x07, 0xA1, 0x20}) + meta(0x58, {7, 3, 24, 8}) + meta(3, {'a'}) + kEnd) +
      track(Bytes{0x05, 0xF0, 0x03, 0x7E, 0x7F, 0xF7} + kNote + meta(5, {'b'}) + kEnd);
  const auto song = parse(bytes);
  const auto again = parse(write_midi(*song));
  expect_same_song(*song, *again, "song");
  EXPECT_EQ(song->sysex_bytes, again->sysex_bytes);
  EXPECT_TRUE(again->warnings.empty());
}

TEST(WriteMidi, GapsLongerThanADeltaTimeComeBack) {
  Song song;
  song.track_count = 1;
  song.events = {{5, 0, {0x90, 60, 100}, 0, 0}, {0x0FFFFFFFull * 3 + 17, 0, {0x80, 60, 0}, 0, 0}};
  song.length_ticks = 0x0FFFFFFFull * 5;
  const auto again = parse(write_midi(song));
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(again->warnings.empty());
  expect_same_song(song, *again, "gaps");
}

TEST(WriteMidi, EverySongOfTheCorpusComesBack) {
  const auto files = support::corpus_files("", {".mid"});
  int read = 0;
  for (const auto& file : files) {
    const auto song = parse(bytes_of_file(file));
    if (!song) continue;
    ++read;
    const auto again = parse(write_midi(*song));
    ASSERT_TRUE(again.has_value()) << file << ": " << again.error().to_string();
    expect_same_song(*song, *again, file);
    if (HasFailure()) return;
  }
  std::printf("corpus: %d of %zu files written and read again\n", read, files.size());
  EXPECT_EQ(read == 0, files.empty());
}

}  // namespace
}  // namespace knotwave::io

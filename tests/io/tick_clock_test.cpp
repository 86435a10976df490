// SPDX-License-Identifier: MIT
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "knotwave/io/midi_file.h"

namespace knotwave::io {
namespace {

/// A row of golden/tick_clock.tsv: exact fractions by tools/make_tick_clock_golden.py.
struct Row {
  Song song;
  std::string key;  ///< all that makes the song
  std::uint32_t rate_hz = 0;
  std::uint64_t tick = 0;
  base::SampleTime time;
};

Song golden_song(const std::string& division, std::string tempos) {
  Song song;
  std::stringstream numbers(division);
  int first = 0, second = 0;
  char colon = 0;
  numbers >> first >> colon >> second;
  song.time_base = second > 0 ? TimeBase{0, first, second} : TimeBase{first, 0, 0};
  if (tempos == "-") return song;
  std::stringstream entries(tempos);
  for (std::string entry; std::getline(entries, entry, ',');) {
    TempoChange change;
    std::stringstream(entry) >> change.tick >> colon >> change.microseconds_per_quarter;
    song.tempos.push_back(change);
  }
  return song;
}

std::vector<Row> golden_rows() {
  std::ifstream in(KNOTWAVE_SOURCE_DIR "/tests/golden/tick_clock.tsv");
  std::vector<Row> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::stringstream fields(line);
    std::string division, tempos;
    Row row;
    fields >> division >> row.rate_hz >> tempos >> row.tick >> row.time.sample >> row.time.fraction;
    row.song = golden_song(division, tempos);
    row.key = division + "/" + std::to_string(row.rate_hz) + "/" + tempos;
    rows.push_back(row);
  }
  return rows;
}

TEST(TickClock, AgreesWithExactFractions) {
  const auto rows = golden_rows();
  ASSERT_GT(rows.size(), 500u);
  for (const Row& row : rows) {
    EXPECT_EQ(TickClock(row.song, row.rate_hz).at(row.tick), row.time)
        << row.key << " tick " << row.tick;
  }
}

TEST(TickClock, WalkingForwardAndJumpingBackAgree) {
  const auto rows = golden_rows();
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end].key == rows[begin].key) ++end;
    TickClock clock(rows[begin].song, rows[begin].rate_hz);
    for (std::size_t i = begin; i < end; ++i) EXPECT_EQ(clock.at(rows[i].tick), rows[i].time);
    for (std::size_t i = end; i-- > begin;) EXPECT_EQ(clock.at(rows[i].tick), rows[i].time);
    begin = end;
  }
}

TEST(TickClock, HalfASecondAQuarterUntilTheFirstTempo) {
  const Song song;
  EXPECT_EQ(TickClock(song, 48000).at(480), (base::SampleTime{24000, 0}));
}

TEST(TickClock, SaturatesAtTheLastSample) {
  Song song;
  song.time_base.ticks_per_quarter = 1;
  song.tempos = {{0, 16777215}};
  EXPECT_EQ(TickClock(song, 768000).at(~0ull), (base::SampleTime{std::int64_t{1} << 62, 0}));
}

TEST(TickClock, SmpteTimeIgnoresTempo) {
  Song song;
  song.time_base = {0, 25, 40};
  song.tempos = {{0, 1}};
  EXPECT_EQ(TickClock(song, 48000).at(1000), (base::SampleTime{48000, 0}));
}

}  // namespace
}  // namespace knotwave::io

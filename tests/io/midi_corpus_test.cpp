// SPDX-License-Identifier: MIT
// The MIDI reader against files from outside: hostile ones with frozen verdicts, good ones against
// midicsv, an independent reader.
#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "io/midi_bytes.h"
#include "support/corpus.h"
#include "support/program.h"
#include "support/verdicts.h"

namespace knotwave::io {
namespace {

constexpr const char* kVerdictTable = KNOTWAVE_SOURCE_DIR "/tests/golden/midi_verdicts.tsv";

std::string verdict_of(const std::string& file) {
  const auto song = read_midi_file(file);
  if (!song) {
    EXPECT_GE(song.error().offset, 0) << file;
    EXPECT_EQ(song.error().source, file);
    return to_string(song.error().code);
  }
  return "accept " + std::to_string(song->warnings.size() + song->warnings_left_out);
}

support::Verdicts seen_verdicts() {
  support::Verdicts seen;
  const std::string root = support::corpus_root() + "/midi_bad/";
  for (const auto& file : support::corpus_files("midi_bad", {".mid"})) {
    seen[file.substr(root.size())] = verdict_of(file);
  }
  return seen;
}

TEST(MidiCorpus, HostileFilesGetTheirFrozenVerdict) {
  const support::Verdicts seen = seen_verdicts();
  std::printf("corpus: %zu files of midi_bad\n", seen.size());
  if (seen.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no midi_bad: no file was read";
  support::expect_verdicts(support::read_verdicts(kVerdictTable), seen,
                           testing::TempDir() + "midi_verdicts_seen.tsv");
}

TEST(MidiCorpus, TheFrozenVerdictsAgreeWithWhatTheCorpusExpects) {
  const auto expectations =
      support::read_expectations(support::corpus_root() + "/midi_bad/generated/EXPECT.tsv");
  std::printf("corpus: %zu expectations\n", expectations.size());
  if (expectations.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no EXPECT.tsv";
  const support::Verdicts frozen = support::read_verdicts(kVerdictTable);
  for (const auto& [file, expectation] : expectations) {
    const auto row = frozen.find("generated/" + file);
    ASSERT_NE(row, frozen.end()) << file;
    EXPECT_TRUE(support::is_expected(row->second, expectation, true))
        << file << ": " << row->second << ", expected: " << expectation;
  }
}

/// Lines of midicsv, or of ours in its words: one a channel message, system exclusive or tempo.
using Lines = std::vector<std::string>;

std::string line_of(const SongEvent& event, const Song& song) {
  std::ostringstream line;
  line << event.track + 1 << ", " << event.tick << ", ";
  const int channel = event.bytes[0] & 15;
  const int a = event.bytes[1];
  const int b = event.bytes[2];
  switch (event.bytes[0] >> 4) {
    case 0x8:
      line << "Note_off_c, " << channel << ", " << a << ", " << b;
      break;
    case 0x9:
      line << "Note_on_c, " << channel << ", " << a << ", " << b;
      break;
    case 0xA:
      line << "Poly_aftertouch_c, " << channel << ", " << a << ", " << b;
      break;
    case 0xB:
      line << "Control_c, " << channel << ", " << a << ", " << b;
      break;
    case 0xC:
      line << "Program_c, " << channel << ", " << a;
      break;
    case 0xD:
      line << "Channel_aftertouch_c, " << channel << ", " << a;
      break;
    case 0xE:
      line << "Pitch_bend_c, " << channel << ", " << (a | b << 7);
      break;
    default:
      line << "System_exclusive, " << event.sysex_size + 1;
      for (std::uint32_t i = 0; i < event.sysex_size; ++i) {
        line << ", " << static_cast<int>(song.sysex_bytes[event.sysex_begin + i]);
      }
      line << ", 247";
  }
  return line.str();
}

Lines our_lines(const Song& song) {
  std::vector<SongEvent> events = song.events;
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.track < b.track; });
  Lines lines;
  for (const SongEvent& event : events) lines.push_back(line_of(event, song));
  for (const TempoChange& tempo : song.tempos) {
    lines.push_back(std::to_string(tempo.tick) + ", Tempo, " +
                    std::to_string(tempo.microseconds_per_quarter));
  }
  return lines;
}

Lines midicsv_lines(const std::string& csv) {
  Lines lines;
  std::vector<std::pair<std::uint64_t, std::string>> tempos;
  std::istringstream in(csv);
  for (std::string line; std::getline(in, line);) {
    const std::size_t tick = line.find(", ") + 2;
    const std::size_t word = line.find(", ", tick) + 2;
    if (line.compare(word, 6, "Tempo,") == 0) {
      tempos.emplace_back(std::stoull(line.substr(tick)), line.substr(tick));
    } else if (line.find("_c, ", word) != std::string::npos &&
               line.find('"') == std::string::npos) {
      lines.push_back(line);
    } else if (line.compare(word, 17, "System_exclusive,") == 0) {
      lines.push_back(line);
    }
  }
  std::stable_sort(tempos.begin(), tempos.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [tick, line] : tempos) lines.push_back(line);
  return lines;
}

TEST(MidiCorpus, GoodFilesReadAsMidicsvReadsThem) {
  const auto files = support::corpus_files("midi", {".mid"});
  std::printf("corpus: %zu files of midi\n", files.size());
  if (files.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no midi: no file was read";
  std::size_t lines = 0;
  for (const auto& file : files) {
    const auto song = read_midi_file(file);
    ASSERT_TRUE(song.has_value()) << song.error().to_string();
    if (song->format == 2) continue;  // midicsv does not lay patterns one after another
    const auto run = support::run_program({"/usr/bin/env", "midicsv", file});
    ASSERT_NE(run.exit_code, 127) << "midicsv is not installed: apt-get install midicsv";
    ASSERT_EQ(run.exit_code, 0) << file << ": " << run.err;
    const Lines theirs = midicsv_lines(run.out);
    ASSERT_EQ(our_lines(*song), theirs) << file;
    lines += theirs.size();
  }
  std::printf("corpus: %zu messages and tempos agree with midicsv\n", lines);
}

}  // namespace
}  // namespace knotwave::io

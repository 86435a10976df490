// SPDX-License-Identifier: MIT
// The MIDI reader against files from outside: hostile ones with frozen verdicts, good ones against
// midicsv, an independent reader.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "io/midi_bytes.h"
#include "io/midi_lines.h"
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

// SPDX-License-Identifier: MIT
// The sound reader against files from outside, with frozen verdicts.
#include <set>

#include <gtest/gtest.h>

#include "knotwave/io/sound_file.h"

#include "support/corpus.h"
#include "support/verdicts.h"

namespace knotwave::io {
namespace {

constexpr const char* kVerdictTable = KNOTWAVE_SOURCE_DIR "/tests/golden/wav_verdicts.tsv";

constexpr std::string_view kAsCycles = ", as cycles ";

template <class Read>
std::string verdict_of(const Read& read, const std::string& file) {
  if (read) return "accept " + std::to_string(read->warnings.size());
  EXPECT_EQ(read.error().source, file);
  EXPECT_FALSE(read.error().message.empty());
  return to_string(read.error().code);
}

/// What the file is as a sound and, if it is one, as cycles of an oscillator.
std::string verdict_of(const std::string& file) {
  const auto sound = read_sound(file);
  std::string verdict = verdict_of(sound, file);
  if (sound) verdict.append(kAsCycles).append(verdict_of(read_cycles(file), file));
  return verdict;
}

TEST(WavCorpus, FilesGetTheirFrozenVerdict) {
  support::Verdicts seen;
  const std::string root = support::corpus_root() + "/wav/";
  for (const auto& file : support::corpus_files("wav", {".wav", ".wt"})) {
    seen[file.substr(root.size())] = verdict_of(file);
  }
  std::printf("corpus: %zu files of wav\n", seen.size());
  if (seen.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no wav: no file was read";
  support::expect_verdicts(support::read_verdicts(kVerdictTable), seen,
                           testing::TempDir() + "wav_verdicts_seen.tsv");
}

// Where we differ from what the corpus expects, because libsndfile 1.2 does and says so:
// it reads no Surge tables (.wt), gives up on 20,000 empty chunks, and reads what is there of an
// RF64 whose sizes cannot be.
const std::set<std::string> kOtherwise = {"72_chunk_bomb.wav", "75_rf64_ds64_huge.wav",
                                          "95_wt_ok_f32.wt", "95_wt_ok_i16.wt"};

TEST(WavCorpus, TheFrozenVerdictsAgreeWithWhatTheCorpusExpects) {
  const auto expectations =
      support::read_expectations(support::corpus_root() + "/wav/generated/EXPECT.tsv");
  std::printf("corpus: %zu expectations\n", expectations.size());
  if (expectations.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no EXPECT.tsv";
  const support::Verdicts frozen = support::read_verdicts(kVerdictTable);
  for (const auto& [file, expectation] : expectations) {
    const auto row = frozen.find("generated/" + file);
    ASSERT_NE(row, frozen.end()) << file;
    const std::size_t split = row->second.find(kAsCycles);
    const bool is_for_cycles =
        split != std::string::npos && expectation.find("wavetable") != std::string::npos;
    const std::string verdict =
        is_for_cycles ? row->second.substr(split + kAsCycles.size()) : row->second.substr(0, split);
    EXPECT_EQ(support::is_expected(verdict, expectation, false), !kOtherwise.contains(file))
        << file << ": " << row->second << ", expected: " << expectation;
  }
}

TEST(WavCorpus, SingleCyclesOfTheAkwfSetAreOneCycleEach) {
  const auto files = support::corpus_files("wavetables/akwf", {".wav"});
  std::printf("corpus: %zu single cycles\n", files.size());
  if (files.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no wavetables: no file was read";
  for (const auto& file : files) {
    const auto cycles = read_cycles(file);
    ASSERT_TRUE(cycles.has_value()) << cycles.error().to_string();
    EXPECT_EQ(cycles->frame, 600) << file;
    EXPECT_EQ(cycles->rows, 1) << file;
  }
}

}  // namespace
}  // namespace knotwave::io

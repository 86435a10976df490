// SPDX-License-Identifier: MIT
// The General MIDI bank with real songs: finite, unclipped without any limiter, sensibly loud by
// ITU-R BS.1770 (libebur128), ending in zeros.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/io/midi_file.h"

#include "apps/loudness_meter.h"
#include "support/corpus.h"

namespace {

using knotwave::render::kMeterRateHz;
using knotwave::render::Measure;
using knotwave::render::measure;

constexpr const char* kBank = KNOTWAVE_SOURCE_DIR "/examples/banks/general-midi.toml";

/// Whether a note begins on a channel whose volume (CC 7) is not 0: one song turns it off at once.
bool sounds_a_note(const std::string& path) {
  const auto song = knotwave::io::read_midi_file(path);
  if (!song) return false;
  std::array<bool, 16> is_audible;
  is_audible.fill(true);
  for (const auto& e : song->events) {
    if (e.sysex_size != 0) continue;
    const std::size_t channel = e.bytes[0] & 0x0F;
    const int kind = e.bytes[0] & 0xF0;
    if (kind == 0xB0 && e.bytes[1] == 7) is_audible[channel] = e.bytes[2] > 0;
    if (kind == 0x90 && e.bytes[2] > 0 && is_audible[channel]) return true;
  }
  return false;
}

double song_seconds(const std::string& path) {
  const auto song = knotwave::io::read_midi_file(path);
  if (!song) return 0;
  knotwave::io::TickClock clock(*song, kMeterRateHz);
  return static_cast<double>(clock.at(song->length_ticks).sample) / kMeterRateHz;
}

/// Renders each file, checks it, and prints a line of totals.
void check_songs(const std::vector<std::string>& songs) {
  double seconds = 0, cpu_s = 0, quietest = 0, loudest = -100, highest = 0;
  for (const auto& song : songs) {
    const Measure m = measure(kBank, song);
    ASSERT_EQ(m.exit_code, 0) << song << "\n" << m.err;
    EXPECT_TRUE(m.finite) << song;
    EXPECT_LT(m.peak, 1.0) << song;
    // A voice may come to rest within the last millisecond, so a curve's last steps may lie there.
    EXPECT_LT(m.end_peak, 1e-5) << song << " does not end below -100 dBFS";
    seconds += m.seconds();
    cpu_s += m.cpu_s;
    highest = std::max(highest, m.peak);
    std::printf("%-40s %6.1f s %7.2f LUFS peak %6.2f dBFS\n",
                std::filesystem::path(song).filename().c_str(), m.seconds(), m.loudness_lufs,
                m.peak_dbfs());
    if (!sounds_a_note(song)) {
      EXPECT_EQ(m.peak, 0) << song << " has no note to be heard";
      continue;
    }
    EXPECT_GE(m.loudness_lufs, -30) << song;
    EXPECT_LE(m.loudness_lufs, -12) << song;
    quietest = std::min(quietest, m.loudness_lufs);
    loudest = std::max(loudest, m.loudness_lufs);
  }
  std::printf(
      "%zu files, %.0f s of music in %.0f s: %.1f times real time; %.1f to %.1f LUFS, "
      "highest peak %.2f dBFS\n",
      songs.size(), seconds, cpu_s, seconds / cpu_s, quietest, loudest, 20 * std::log10(highest));
}

TEST(GeneralMidi, OwnScoresAreUnclippedAndSensiblyLoud) {
  std::vector<std::string> songs;
  for (const auto& entry :
       std::filesystem::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/scores")) {
    if (entry.path().extension() == ".mid") songs.push_back(entry.path().string());
  }
  ASSERT_GE(songs.size(), 3u);
  std::sort(songs.begin(), songs.end());
  check_songs(songs);
}

TEST(GeneralMidi, ASampleOfTheCorpusIsUnclippedAndSensiblyLoud) {
  const auto all = knotwave::support::corpus_files("midi", {".mid"});
  if (all.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS is not set: no file of the corpus was run";
  constexpr double kLongestSeconds = 90;
  std::vector<std::string> shorter;
  for (const auto& path : all) {
    if (song_seconds(path) <= kLongestSeconds) shorter.push_back(path);
  }
  ASSERT_GE(shorter.size(), 30u);
  std::printf(
      "30 of the %zu songs of up to %.0f s; %zu longer ones are left to GeneralMidiStress, which "
      "plays all %zu\n",
      shorter.size(), kLongestSeconds, all.size() - shorter.size(), all.size());
  std::vector<std::string> songs;
  for (std::size_t i = 0; i < 30; ++i) songs.push_back(shorter[i * shorter.size() / 30]);
  check_songs(songs);
}

/// A share of the corpus a test, so that the shares run side by side.
constexpr int kShares = 8;
std::vector<std::string> share_of(const std::vector<std::string>& all, std::size_t share) {
  std::vector<std::string> songs;
  for (std::size_t i = share; i < all.size(); i += kShares) songs.push_back(all[i]);
  return songs;
}

TEST(GeneralMidi, TheSharesOfTheStressRunAreAllSongs) {
  for (const std::size_t count : {1u, 7u, 8u, 198u}) {
    std::vector<std::string> all, played;
    for (std::size_t i = 0; i < count; ++i) all.push_back(std::to_string(1000 + i));
    for (std::size_t share = 0; share < kShares; ++share) {
      for (const auto& song : share_of(all, share)) played.push_back(song);
    }
    std::sort(played.begin(), played.end());
    EXPECT_EQ(played, all);
  }
}

class GeneralMidiStress : public testing::TestWithParam<int> {};

TEST_P(GeneralMidiStress, EveryFileOfTheCorpusIsUnclippedAndSensiblyLoud) {
  const auto all = knotwave::support::corpus_files("midi", {".mid"});
  if (all.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS is not set: no file of the corpus was run";
  check_songs(share_of(all, static_cast<std::size_t>(GetParam())));
}
INSTANTIATE_TEST_SUITE_P(Shares, GeneralMidiStress, testing::Range(0, kShares));

}  // namespace

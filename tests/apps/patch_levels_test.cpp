// SPDX-License-Identifier: MIT
// The shipped patches are level with each other: one phrase in each patch's own register is equally
// loud by ITU-R BS.1770, and two hands full of loud notes stay below full scale without a limiter.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "apps/loudness_meter.h"
#include "apps/notes_file.h"
#include "support/program.h"

namespace {

using knotwave::render::Measure;
using knotwave::render::measure;
using knotwave::render::Note;
using knotwave::render::notes_file;

// Eight keys at once leave this much room: what rings (plucked strings, keys, bells) has peaks 18
// dB above its loudness, and no limiter catches them.
constexpr double kTargetLufs = -26.5;
constexpr double kFirstLightLufs = -21;
constexpr double kToleranceLu = 2;

/// The four first-light patches are heard one after the other in their demo, four notes at a time:
/// level with each other, louder than the rest.
enum class Kind { melodic, drum, first_light };
struct Placed {
  std::string_view patch;
  int root;  ///< the phrase's lowest key; a drum's own key
  Kind kind = Kind::melodic;
};
constexpr auto kPlaced = std::to_array<Placed>({
    {"arc", 60},
    {"bass", 33},
    {"bell", 72},
    {"belltree", 84, Kind::drum},
    {"block", 76, Kind::drum},
    {"brass", 55},
    {"clap", 39, Kind::drum},
    {"conga", 64, Kind::drum},
    {"cowbell", 68, Kind::drum},
    {"cuica", 72, Kind::drum},
    {"cymbal", 60, Kind::drum},
    {"drawn-lead", 64},
    {"drive", 45},
    {"first-light-1-lines", 60, Kind::first_light},
    {"first-light-2-decay", 60, Kind::first_light},
    {"first-light-3-weight", 60, Kind::first_light},
    {"first-light-4-surface", 60, Kind::first_light},
    {"flute", 72},
    {"guiro", 60, Kind::drum},
    {"hat-closed", 42, Kind::drum},
    {"hat-open", 46, Kind::drum},
    {"jingle", 72, Kind::drum},
    {"keys", 60},
    {"kick", 36, Kind::drum},
    {"leaning-bell", 67},
    {"mono-lead", 64},
    {"morph-pad", 55},
    {"muted-drum", 62, Kind::drum},
    {"organ", 55},
    {"pluck", 55},
    {"reed", 60},
    {"ride", 60, Kind::drum},
    {"scratch", 60, Kind::drum},
    {"shaker", 54, Kind::drum},
    {"snare", 38, Kind::drum},
    {"strings", 55},
    {"tom", 45, Kind::drum},
    {"vibraslap", 60, Kind::drum},
    {"voice", 55},
    {"whistle", 60, Kind::drum},
    {"wind", 60},
    {"zap", 60, Kind::drum},
});

/// At 120 beats a minute. A phrase up and down the chord, then the chord itself, held.
std::vector<Note> phrase(int root) {
  std::vector<Note> notes;
  double beat = 0;
  for (const int step : {0, 4, 7, 12, 7, 4}) notes.push_back({beat++, 0.9, root + step, 90});
  for (const int step : {0, 4, 7}) notes.push_back({beat, 3.6, root + step, 90});
  return notes;
}
/// Eight keys under two hands, played forte, struck at once and held.
std::vector<Note> two_hands(int root) {
  std::vector<Note> notes;
  for (const int step : {-12, -5, 0, 4, 7, 10, 12, 16}) notes.push_back({0, 6, root + step, 100});
  return notes;
}
/// A drum is struck once a beat, hard.
std::vector<Note> beats(int key) {
  std::vector<Note> notes;
  for (int beat = 0; beat < 4; ++beat) notes.push_back({double(beat), 0.5, key, 127});
  return notes;
}

Measure played(std::string_view patch, const std::vector<Note>& notes) {
  const knotwave::support::ScratchFolder folder;
  const std::string file = KNOTWAVE_SOURCE_DIR "/examples/patches/" + std::string(patch) + ".toml";
  const Measure m = measure(file, notes_file(folder, notes));
  EXPECT_EQ(m.exit_code, 0) << patch << "\n" << m.err;
  EXPECT_TRUE(m.finite) << patch;
  return m;
}

TEST(PatchLevels, EveryShippedPatchIsMeasured) {
  for (const auto& entry :
       std::filesystem::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/patches")) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().stem().string();
    EXPECT_TRUE(std::any_of(kPlaced.begin(), kPlaced.end(),
                            [&](const Placed& placed) { return placed.patch == name; }))
        << name << ": say in which register it is played";
  }
}

TEST(PatchLevels, OnePhraseIsWithin2LuOfOneLoudnessWithEveryMelodicPatch) {
  for (const Placed& placed : kPlaced) {
    if (placed.kind == Kind::drum) continue;
    const Measure m = played(placed.patch, phrase(placed.root));
    std::printf("%-24s %7.2f LUFS\n", std::string(placed.patch).c_str(), m.loudness_lufs);
    const bool is_first_light = placed.kind == Kind::first_light;
    EXPECT_NEAR(m.loudness_lufs, is_first_light ? kFirstLightLufs : kTargetLufs, kToleranceLu)
        << placed.patch;
  }
}

TEST(PatchLevels, TwoHandsFullOfLoudNotesStayBelowFullScale) {
  for (const Placed& placed : kPlaced) {
    if (placed.kind == Kind::first_light) continue;
    const bool is_drum = placed.kind == Kind::drum;
    const Measure m = played(placed.patch, is_drum ? beats(placed.root) : two_hands(placed.root));
    std::printf("%-24s %7.2f dBFS\n", std::string(placed.patch).c_str(), m.peak_dbfs());
    EXPECT_LT(m.peak, 1.0) << placed.patch;
  }
}

}  // namespace

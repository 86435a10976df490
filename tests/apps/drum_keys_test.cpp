// SPDX-License-Identifier: MIT
// Every drum of the General MIDI bank, one after the other: none is silent, none drowns the rest,
// each dies away by itself.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/loudness_meter.h"
#include "apps/notes_file.h"
#include "support/program.h"

namespace {

using knotwave::render::kMeterRateHz;
using knotwave::render::LoudnessMeter;
using knotwave::render::Measure;
using knotwave::render::Note;
using knotwave::render::notes_file;

constexpr int kFirstKey = 27, kLastKey = 87;  // of General MIDI 2
constexpr int kDrumChannel = 10;
constexpr std::size_t kSlotSeconds = 5;
constexpr std::size_t kSlotBytes = kSlotSeconds * kMeterRateHz * 2 * sizeof(float);

/// One hit a slot, as loud as can be.
std::vector<Note> hits() {
  constexpr double kBeats = 2 * kSlotSeconds;
  std::vector<Note> notes;
  for (int key = kFirstKey; key <= kLastKey; ++key) {
    notes.push_back({kBeats * (key - kFirstKey), 0.5, key, 127, kDrumChannel});
  }
  return notes;
}

/// Each slot of what `song` renders to.
std::vector<Measure> measured_slots(const std::string& song) {
  std::vector<Measure> slots(1);
  LoudnessMeter meter;
  std::size_t left = kSlotBytes;
  knotwave::support::ProgramOptions options;
  options.timeout_s = 600;
  options.on_output = [&](std::span<const char> bytes) {
    while (!bytes.empty()) {
      if (left == 0) {
        meter.finish(slots.back());
        meter.restart();
        slots.emplace_back();
        left = kSlotBytes;
      }
      const std::size_t n = std::min(left, bytes.size());
      meter.add(bytes.first(n), slots.back());
      bytes = bytes.subspan(n);
      left -= n;
    }
  };
  const std::string bank = KNOTWAVE_SOURCE_DIR "/examples/banks/general-midi.toml";
  const auto run = knotwave::support::run_program(
      {"knotwave-render", bank, song, "-o", "-", "--quiet", "--tail", "5"}, options);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  meter.finish(slots.back());
  return slots;
}

TEST(DrumKeys, EachSoundsAsLoudAsADrumShouldAndDiesAway) {
  const knotwave::support::ScratchFolder folder;
  const auto slots = measured_slots(notes_file(folder, hits()));
  ASSERT_GE(slots.size(), std::size_t{kLastKey - kFirstKey + 1});
  for (int key = kFirstKey; key <= kLastKey; ++key) {
    const Measure& m = slots[static_cast<std::size_t>(key - kFirstKey)];
    std::printf("key %d %7.2f LUFS peak %6.2f dBFS\n", key, m.loudness_lufs, m.peak_dbfs());
    EXPECT_TRUE(m.finite) << key;
    EXPECT_LT(m.peak_dbfs(), -10) << key;
    EXPECT_GT(m.loudness_lufs, -45) << key;
    EXPECT_LT(m.loudness_lufs, -20) << key;
    EXPECT_LT(m.end_peak, m.peak * 1e-3) << key << " rings on";
  }
}

}  // namespace

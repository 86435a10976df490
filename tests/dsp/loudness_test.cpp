// SPDX-License-Identifier: MIT
#include "knotwave/dsp/loudness.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/elementary.h"

namespace knotwave::dsp {
namespace {

using testing::HasSubstr;
using Measure = LoudnessConfig::Measure;

struct ReferenceLevel {
  std::int64_t frame;
  double rms, peak;
};
struct Reference {
  int rate_hz, channels;
  std::int64_t frames, window, hop;
  std::vector<ReferenceLevel> levels;
};
#include "loudness_reference.inc"

/// The sound of the reference.
std::vector<float> sound_of(const Reference& reference) {
  std::vector<float> samples;
  std::int64_t state = 12345;
  for (std::int64_t i = 0; i < reference.frames * reference.channels; ++i) {
    state = (state * 1103515245 + 12345) % (std::int64_t{1} << 31);
    const std::int64_t loud = 1 + (i / reference.channels) * 7 / reference.frames;
    const double whole = static_cast<double>(state / 32768 - 32768);
    samples.push_back(static_cast<float>(std::floor(whole / static_cast<double>(loud)) / 32768));
  }
  return samples;
}

LoudnessConfig config_of(const Reference& reference, Measure measure) {
  return {measure, reference.rate_hz, reference.channels,
          static_cast<double>(reference.window) / reference.rate_hz,
          static_cast<double>(reference.hop) / reference.rate_hz};
}

std::vector<LoudnessMeter::Level> levels_of(const LoudnessConfig& config,
                                            std::span<const float> samples,
                                            std::size_t frames_at_once) {
  auto meter = LoudnessMeter::create(config);
  EXPECT_TRUE(meter.has_value());
  const std::size_t step = frames_at_once * static_cast<std::size_t>(config.channels);
  for (std::size_t at = 0; at < samples.size(); at += step) {
    meter->add(samples.subspan(at, std::min(step, samples.size() - at)));
  }
  meter->finish();
  return meter->levels();
}

TEST(Loudness, IsWhatNumpyComputes) {
  for (const Reference& reference : kReferences) {
    const auto samples = sound_of(reference);
    const auto rms = levels_of(config_of(reference, Measure::rms), samples, samples.size());
    const auto peak = levels_of(config_of(reference, Measure::peak), samples, samples.size());
    ASSERT_EQ(rms.size(), reference.levels.size());
    ASSERT_EQ(peak.size(), reference.levels.size());
    for (std::size_t i = 0; i < rms.size(); ++i) {
      EXPECT_EQ(rms[i].frame, reference.levels[i].frame);
      EXPECT_NEAR(rms[i].level, reference.levels[i].rms, 1e-14 * reference.levels[i].rms);
      EXPECT_EQ(peak[i].level, reference.levels[i].peak);
    }
  }
}

TEST(Loudness, IsTheSameForAnySplitOfTheSound) {
  for (const Reference& reference : kReferences) {
    const auto samples = sound_of(reference);
    for (const Measure measure : {Measure::rms, Measure::peak}) {
      const auto whole = levels_of(config_of(reference, measure), samples, samples.size());
      for (const int frames : {1, 2, 3, 64, 479, 4096}) {
        const auto split =
            levels_of(config_of(reference, measure), samples, static_cast<std::size_t>(frames));
        ASSERT_EQ(split.size(), whole.size());
        for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(split[i].level, whole[i].level);
      }
    }
  }
}

TEST(Loudness, OfALongSoundKeepsNoMoreThanItsWindow) {
  auto meter = LoudnessMeter::create({.window_s = 0.01, .hop_s = 0.01});
  ASSERT_TRUE(meter.has_value());
  const std::vector<float> second(48000, 0.5F);
  for (int i = 0; i < 100; ++i) meter->add(second);
  meter->finish();
  EXPECT_EQ(meter->frames(), 4800000);
  ASSERT_EQ(meter->levels().size(), 10001u);
  for (const auto& level : meter->levels()) EXPECT_EQ(level.level, 0.5);
}

TEST(Loudness, OfAFullScaleSineIsTheRootOfAHalfInAnyNumberOfChannels) {
  for (const int channels : {1, 2}) {
    std::vector<float> samples;
    for (int i = 0; i < 4800; ++i) {
      for (int channel = 0; channel < channels; ++channel) {
        samples.push_back(static_cast<float>(base::sin_cos_cycles(i / 48.0).sin));
      }
    }
    const auto levels =
        levels_of({.channels = channels, .window_s = 0.01, .hop_s = 0.01}, samples, 99);
    // Half a window at both ends, ten cycles elsewhere; single-precision samples.
    for (const auto& level : levels) EXPECT_NEAR(level.level, std::sqrt(0.5), 1e-7);
  }
}

TEST(Loudness, OfWhatIsNotFiniteIsThatOfSilence) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> samples = {nan, infinity, -infinity, nan};
  for (const auto& level : levels_of({.rate_hz = 100}, samples, 1)) EXPECT_EQ(level.level, 0);
}

TEST(Loudness, OfOneFrameStandsAtBothItsEndsAndOfNoneNowhere) {
  const std::vector<float> one = {-0.25F};
  const auto levels = levels_of({}, one, 1);
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].frame, 0);
  EXPECT_EQ(levels[1].frame, 1);
  EXPECT_EQ(levels[0].level, 0.25);
  EXPECT_EQ(levels[1].level, 0.25);
  EXPECT_TRUE(levels_of({}, {}, 1).empty());
}

TEST(Loudness, RefusesAHopBeyondItsWindow) {
  const auto meter = LoudnessMeter::create({.window_s = 0.01, .hop_s = 0.02});
  ASSERT_FALSE(meter.has_value());
  EXPECT_THAT(meter.error().message, HasSubstr("0.02"));
  EXPECT_FALSE(LoudnessMeter::create({.rate_hz = 0}).has_value());
  EXPECT_FALSE(LoudnessMeter::create({.channels = 65}).has_value());
  EXPECT_FALSE(LoudnessMeter::create({.window_s = 1e9}).has_value());
}

TEST(Loudness, OnAScaleOfDecibelsIsStraight) {
  EXPECT_EQ(level_on_db_scale(1, -60), 1);
  EXPECT_EQ(level_on_db_scale(0, -60), 0);
  EXPECT_NEAR(level_on_db_scale(base::db_to_gain(-15), -60), 0.75, 1e-15);
  EXPECT_EQ(level_on_db_scale(base::db_to_gain(-61), -60), 0);
  EXPECT_NEAR(level_on_db_scale(base::db_to_gain(6), -60), 1.1, 1e-15);
}

}  // namespace
}  // namespace knotwave::dsp

// SPDX-License-Identifier: MIT
// Whatever a patch asks of its targets, the samples are finite.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"

#include "scenes.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

struct Target {
  const char* word;
  double most;  ///< depth
};
// Every target that adds, with the largest depth the reader takes.
constexpr Target kTargets[] = {{"amp", 240},
                               {"gain", 1000},
                               {"pitch", 240},
                               {"pan", 1000},
                               {"a.level", 240},
                               {"a.gain", 1000},
                               {"a.pitch", 240},
                               {"a.pan", 1000},
                               {"a.phase", 1000},
                               {"a.position", 1000},
                               {"noise.level", 240},
                               {"noise.gain", 1000},
                               {"noise.pan", 1000},
                               {"crossfade", 1000},
                               {"shaper.drive", 240},
                               {"filter.cutoff", 240},
                               {"filter.resonance", 1000},
                               {"lfo.w.rate", 20},
                               {"lfo.s.rate", 20},
                               {"envelope.amp.time", 20},
                               {"free.x", 1000}};
constexpr int kTargetCount = static_cast<int>(std::size(kTargets));

constexpr std::string_view kPatch = R"(format = 1
kind = "patch"
gain_db = 24
velocity_db = 0
[curves.gate]
degree = 1
points = [-1000000, 1000000, 1000000, 0]
[curves.steep]
degree = 2
points = [-1000000, 0, 1000000]
[curves.law]
degree = 1
points = [[1000000, 0], [0, 1000000]]
[surfaces.row]
degree_u = 1
degree_v = 1
points = [[0, 1000000], [-1000000, 1000000]]
[oscillators.a]
wave = "row"
level_db = 24
pan = 0.2
envelope = "amp"
[noise]
level_db = 24
[crossfade]
between = ["a", "noise"]
law = "law"
[envelopes.amp]
curve = "gate"
seconds = 0.02
sustain_at = 0.5
[envelopes.b]
curve = "steep"
seconds = 0.01
[lfos.w]
curve = "saw"
rate_hz = 1000
[lfos.s]
curve = "steep"
beats = 0.001
)";

/// 32 maps of random sources at the ends of their depths, with or without a shaper and a filter.
std::string extreme_patch(const base::RandomStream& random) {
  std::uint64_t next = 0;
  const auto below = [&](int count) { return static_cast<int>(random.unit(next++) * count); };
  std::string text(kPatch);
  const bool shapes = below(2) == 1;
  const char* filters[] = {"low", "band", "high", "notch"};
  const int filter = below(5);
  if (shapes) text += "[shaper]\ncurve = 'steep'\ndrive_db = 60\n";
  if (filter < 4) {
    text += "[filter]\nkind = '" + std::string(filters[filter]) + "'\nkey_track = 4\n";
  }
  const char* sources[] = {"constant", "mod", "bend",   "key_octaves", "b",
                           "w",        "s",   "random", "free.x"};
  for (int i = 0; i < kMaxMaps; ++i) {
    // The loudness first, then all others in turn.
    const Target& target = kTargets[i < kTargetCount ? i : below(kTargetCount)];
    const std::string word = target.word;
    if (!shapes && word.starts_with("shaper")) continue;
    if (filter == 4 && word.starts_with("filter")) continue;
    // An LFO or a free number does not move itself, and an envelope's time nothing that moves.
    const bool at_rest = word.starts_with("lfo") || word.starts_with("envelope");
    text += "[[maps]]\nfrom = '" +
            std::string(sources[below(at_rest            ? 4
                                      : word == "free.x" ? 8
                                                         : 9)]) +
            "'\n";
    if (below(2) == 1) text += "curve = 'steep'\n";
    text += "to = '" + word + "'\nsmooth_s = " + (below(2) == 1 ? "0" : "0.01") +
            "\ndepth = " + (below(4) == 0 ? "-" : "") +
            std::to_string(static_cast<int>(target.most)) + "\n";
  }
  return text;
}

std::vector<Event> performance(const base::RandomStream& random, std::int64_t frames) {
  std::vector<Event> events;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const std::int64_t at = static_cast<std::int64_t>(i) * frames / 40;
    const int channel = static_cast<int>(i % 3);
    const int value = static_cast<int>(random.unit(1000 + i) * 128);
    switch (i % 4) {
      case 0:
        events.push_back(on(at, channel, value, 127));
        break;
      case 1:
        events.push_back(control(at, channel, 1, value));
        break;
      case 2:
        events.push_back(midi(at, 0xE0 | channel, value, value));
        break;
      default:
        events.push_back(control(at, channel, kVolume, 127));
        break;
    }
  }
  return events;
}

bool is_finite(const Sound& sound) {
  const auto all_finite = [](const std::vector<float>& side) {
    return std::all_of(side.begin(), side.end(), [](float x) { return std::isfinite(x); });
  };
  return all_finite(sound.left) && all_finite(sound.right);
}

TEST(Extremes, SamplesAreFiniteWhateverTheMapsAsk) {
  const int count = support::test_count(60);
  const std::uint64_t seed = support::test_seed();
  int heard = 0;
  for (int i = 0; i < count; ++i) {
    const base::RandomStream random{seed, static_cast<std::uint32_t>(i), 91};
    const auto bank = bank_from(extreme_patch(random));
    ASSERT_NE(bank, nullptr);
    const double rates[] = {8000, 48000, 384000};
    const auto engine = engine_for(*bank, {.rate_hz = rates[i % 3], .volume_db = 60});
    const Sound sound = play(*engine, performance(random, 3000), 3000);
    ASSERT_TRUE(is_finite(sound)) << "patch " << i << "\n" << extreme_patch(random);
    heard += peak(sound.left) > 1 ? 1 : 0;
  }
  EXPECT_GT(heard, count / 4);
}

TEST(Extremes, APatchAsksForThousandDecibelsInVain) {
  std::string text(kPlain);
  for (int i = 0; i < 5; ++i) text += "[[maps]]\nfrom = 'velocity'\nto = 'amp'\ndepth = 240\n";
  const auto bank = bank_from(text);
  const auto engine = engine_for(*bank);
  const Sound sound = play(*engine, {control(0, 0, kVolume, 127), on(0, 0, 69, 127)}, 24000);
  // -9 dB of a voice and -3.01 of the centre, and 120 dB: what maps add up to at most.
  EXPECT_NEAR(dbfs(peak(sound.left, 4000)), 120 - 9 - 3.01, 0.01);
}

TEST(Extremes, ADepthBeyondItsTargetsRangeIsToldWhereItIsWritten) {
  const auto read = [](const Target& target, double depth) {
    std::string text(kPlain);
    text += "[filter]\n[lfos.w]\ncurve = 'sine'\n[[maps]]\nfrom = 'mod'\nto = '";
    text += target.word;
    text += "'\ndepth = ";
    text += std::to_string(static_cast<int>(depth));
    return parse_patch(text, "p.toml");
  };
  for (const Target& target : {Target{"amp", 240}, Target{"filter.cutoff", 240},
                               Target{"lfo.w.rate", 20}, Target{"gain", 1000}}) {
    EXPECT_TRUE(read(target, target.most));
    const auto patch = read(target, target.most + 1);
    ASSERT_FALSE(patch) << target.word;
    EXPECT_EQ(patch.error().code, ErrorCode::value_out_of_range);
    EXPECT_THAT(patch.error().to_string(), testing::StartsWith("p.toml:22:9: error: map 1: "));
  }
}

}  // namespace
}  // namespace knotwave::engine

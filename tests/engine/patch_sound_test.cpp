// SPDX-License-Identifier: MIT
// What each part of a patch does to the sound.
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/engine/channel_state.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// kPlain with `change` applied to its spec, playing `events`.
template <class Change>
Sound heard(Change&& change, const std::vector<Event>& events, std::size_t frames = 24000) {
  auto patch = parse_patch(kPlain, "scene.toml");
  EXPECT_TRUE(patch);
  change(*patch);
  const auto bank = BankProgram::create(bank_of(*std::move(patch)));
  EXPECT_TRUE(bank) << (bank ? "" : bank.error().to_string());
  return play(*engine_for(**bank), events, frames);
}
double pitch_of(const Sound& sound) { return frequency_hz(sound.left, 4000, 24000); }
double level_of(const Sound& sound) { return dbfs(peak(sound.left, 4000)); }
const std::vector<Event> kNote = {on(0, 0, 57, 127)};
const auto kAsItIs = [](PatchSpec&) {};

MapSpec map_to(MapSource source, int source_index, MapTarget target, int target_index,
               double depth) {
  MapSpec map;
  map.source = source;
  map.source_index = source_index;
  map.target = target;
  map.target_index = target_index;
  map.depth = depth;
  return map;
}

TEST(PatchSound, RatioTransposeAndDetuneMultiplyTheFrequency) {
  const auto sound = heard(
      [](PatchSpec& p) {
        p.oscillators[0].ratio = 1.5;
        p.oscillators[0].transpose_semitones = 12;
        p.oscillators[0].detune_cents = 50;
      },
      kNote);
  EXPECT_NEAR(pitch_of(sound), 220 * 1.5 * 2 * std::exp2(0.5 / 12), 0.01);
}

TEST(PatchSound, AFixedFrequencyIgnoresKeyAndBendButHearsMaps) {
  const auto fixed = [](PatchSpec& p) { p.oscillators[0].fixed_hz = 100; };
  EXPECT_NEAR(pitch_of(heard(fixed, {midi(0, 0xE0, 0, 127), on(0, 0, 90)})), 100, 0.01);
  const auto mapped = [&](PatchSpec& p) {
    fixed(p);
    p.maps = {map_to(MapSource::constant, 0, MapTarget::pitch, -1, 12)};
  };
  EXPECT_NEAR(pitch_of(heard(mapped, kNote)), 200, 0.01);
}

TEST(PatchSound, MapsOntoOneTargetAdd) {
  const auto two = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::constant, 0, MapTarget::pitch, 0, 5),
              map_to(MapSource::velocity, 0, MapTarget::pitch, -1, 7)};
  };
  EXPECT_NEAR(pitch_of(heard(two, kNote)), 440, 0.01);
}

TEST(PatchSound, ADisabledMapDoesNothing) {
  const auto off_map = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::constant, 0, MapTarget::pitch, -1, 5)};
    p.maps[0].enabled = false;
  };
  EXPECT_TRUE(heard(off_map, kNote) == heard(kAsItIs, kNote));
}

TEST(PatchSound, LevelIsDecibelsAndGainAFactor) {
  const double plain = level_of(heard(kAsItIs, kNote));
  const auto level = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::constant, 0, MapTarget::level, 0, -6)};
  };
  EXPECT_NEAR(level_of(heard(level, kNote)) - plain, -6, 1e-3);
  const auto gain = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::constant, 0, MapTarget::gain, 0, -0.75)};
  };
  EXPECT_NEAR(level_of(heard(gain, kNote)) - plain, dbfs(0.25), 1e-3);
  const auto below_zero = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::constant, 0, MapTarget::gain, -1, -2)};
  };
  EXPECT_EQ(peak(heard(below_zero, kNote).left), 0);
  const auto amp = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::constant, 0, MapTarget::amp, -1, -20)};
  };
  EXPECT_NEAR(level_of(heard(amp, kNote)) - plain, -20, 1e-3);
}

TEST(PatchSound, ASourcesOwnEnvelopeShapesThatSourceAlone) {
  const auto with_click = [](PatchSpec& p) {
    p.oscillators.push_back(p.oscillators[0]);
    p.oscillators[1].transpose_semitones = 24;
    EnvelopeUse click;
    click.name = "click";
    click.curve = "gate";
    click.spec.seconds = 0.06;
    p.envelopes.push_back(click);
    p.oscillators[1].envelope = "click";
  };
  const Sound both = heard(with_click, kNote), alone = heard(kAsItIs, kNote);
  EXPECT_GT(peak(both.left, 0, 2000), 1.2 * peak(alone.left, 0, 2000));
  for (std::size_t i = 4000; i < 24000; ++i) ASSERT_EQ(both.left[i], alone.left[i]) << i;
}

TEST(PatchSound, ACrossfadeTakesAllOfOneOrTheOther) {
  const auto at = [](double position) {
    return [position](PatchSpec& p) {
      p.oscillators.push_back(p.oscillators[0]);
      p.oscillators[1].transpose_semitones = 12;
      p.crossfade_on = true;
      p.crossfade_position = position;
    };
  };
  EXPECT_NEAR(pitch_of(heard(at(0), kNote)), 220, 0.01);
  EXPECT_NEAR(pitch_of(heard(at(1), kNote)), 440, 0.01);
  EXPECT_NEAR(level_of(heard(at(0), kNote)), level_of(heard(at(1), kNote)), 1e-3);
}

TEST(PatchSound, TheFilterFollowsTheKeyAsAsked) {
  const auto filtered = [](double track) {
    return [track](PatchSpec& p) {
      p.filter_on = true;
      p.filter_cutoff_hz = 261.6255653;  // middle C: the corner of every key that tracks
      p.filter_key_track = track;
    };
  };
  const auto loss = [&](double track, int key) {
    const std::vector<Event> note = {on(0, 0, key, 127)};
    return level_of(heard(filtered(track), note)) - level_of(heard(kAsItIs, note));
  };
  EXPECT_NEAR(loss(1, 48), loss(1, 84), 0.05);
  EXPECT_NEAR(loss(1, 60), dbfs(0.5), 0.01);  // Q = 0.5
  EXPECT_LT(loss(0, 84), loss(0, 60) - 10);
}

TEST(PatchSound, AnOscillatorPannedToOneSideIsHeardThere) {
  const Sound left = heard([](PatchSpec& p) { p.oscillators[0].pan = 0; }, kNote);
  EXPECT_EQ(peak(left.right), 0);
  const Sound centre = heard(kAsItIs, kNote);
  EXPECT_NEAR(level_of(left) - level_of(centre), 3.0103, 0.01);
}

TEST(PatchSound, VelocityAndKeyStretchAnEnvelope) {
  const auto slow = [](PatchSpec& p) { p.envelopes[0].velocity_time = 3; };
  const auto attack_of = [&](int velocity) {
    const Sound sound = heard(slow, {on(0, 0, 81, velocity)});
    const double half = peak(sound.left) / 2;
    std::size_t i = 0;
    while (std::abs(static_cast<double>(sound.left[i])) < half) ++i;
    return static_cast<double>(i);
  };
  EXPECT_NEAR(attack_of(1) / attack_of(127), 8, 1.0);
}

TEST(PatchSound, EnvelopeTimeByMapIsReadWhenTheNoteStarts) {
  const auto stretched = [](PatchSpec& p) {
    p.maps = {map_to(MapSource::control, 1, MapTarget::envelope_time, 0, 3)};
  };
  const std::vector<Event> late = {on(0, 0, 57), control(5, 0, 1, 127)};
  EXPECT_TRUE(heard(stretched, late) == heard(kAsItIs, {on(0, 0, 57)}));
  const std::vector<Event> early = {control(0, 0, 1, 127), on(0, 0, 57)};
  EXPECT_LT(peak(heard(stretched, early).left, 0, 600),
            0.6 * peak(heard(kAsItIs, {on(0, 0, 57)}).left, 0, 600));
}

TEST(PatchSound, NoiseIsTheSameForTheSameNoteAndSeed) {
  const auto noisy = [](PatchSpec& p) {
    p.oscillators.clear();
    p.noise_db = -6;
  };
  EXPECT_TRUE(heard(noisy, kNote) == heard(noisy, kNote));
  const auto other_seed = [&](PatchSpec& p) {
    noisy(p);
    p.seed = 2;
  };
  EXPECT_FALSE(heard(noisy, kNote) == heard(other_seed, kNote));
}

TEST(PatchSound, TheSoftPedalTakesFiveDecibelsFromNewNotes) {
  EXPECT_NEAR(level_of(heard(kAsItIs, {control(0, 0, kSoft, 127), on(0, 0, 57, 127)})) -
                  level_of(heard(kAsItIs, kNote)),
              -5, 1e-3);
}

TEST(PatchSound, UniversalMasterVolumeIsSquared) {
  static constexpr std::uint8_t kHalf[] = {0x7F, 0x7F, 0x04, 0x01, 0x00, 0x40};
  Event volume = midi(0, 0xF0, 0, 0);
  volume.midi.sysex = kHalf;
  volume.midi.sysex_size = sizeof kHalf;
  EXPECT_NEAR(
      level_of(heard(kAsItIs, {volume, on(0, 0, 57, 127)})) - level_of(heard(kAsItIs, kNote)),
      dbfs(8192.0 / 16383 * 8192 / 16383), 1e-3);
}

}  // namespace
}  // namespace knotwave::engine

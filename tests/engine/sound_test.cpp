// SPDX-License-Identifier: MIT
// What is heard: pitch, bends, controllers, stealing, glides, MPE, tunings, programs.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/dsp/fft.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/patch_program.h"

#include "scenes.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// Level of what a Hann window of 1024 samples around `at` holds between 5 and 20 kHz, in dBFS.
double splice_dbfs(const std::vector<float>& x, std::size_t at) {
  constexpr std::size_t kSize = 1024;
  std::vector<std::complex<double>> windowed(kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * double(i) / kSize);
    windowed[i] = window * double(x[at - kSize / 2 + i]);
  }
  dsp::fft(windowed, false);
  double energy = 0;
  for (std::size_t k = kSize * 5 / 48; k < kSize * 20 / 48; ++k) energy += std::norm(windowed[k]);
  return dbfs(std::sqrt(2 * energy) / kSize);
}

TEST(Sound, TheKeyGivesThePitch) {
  const auto bank = bank_from(kPlain);
  for (const int key : {45, 69, 93}) {
    const auto engine = engine_for(*bank);
    const Sound sound = play(*engine, {on(0, 0, key)}, 30000);
    EXPECT_NEAR(frequency_hz(sound.left, 2000, 30000) / (440 * std::exp2((key - 69) / 12.0)), 1,
                1e-6);
  }
}

TEST(Sound, BendFollowsItsRangeAndTuningAdds) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  const std::vector<Event> events = {on(0, 0, 69),
                                     midi(10000, 0xE0, 127, 127),  // 2 semitones up
                                     control(20000, 0, kRpnMsb, 0),
                                     control(20000, 0, kRpnLsb, 0),
                                     control(20000, 0, kDataEntryMsb, 12),  // now 12
                                     control(30000, 0, kRpnLsb, 2),
                                     control(30000, 0, kDataEntryMsb, 65)};  // coarse tuning
  const Sound sound = play(*engine, events, 40000);
  EXPECT_NEAR(frequency_hz(sound.left, 1000, 10000), 440, 1e-3);
  EXPECT_NEAR(frequency_hz(sound.left, 10500, 20000), 440 * std::exp2(2 / 12.0), 2e-3);
  EXPECT_NEAR(frequency_hz(sound.left, 20500, 30000), 880, 2e-3);
  EXPECT_NEAR(frequency_hz(sound.left, 30500, 40000), 880 * std::exp2(1 / 12.0), 2e-3);
}

TEST(Sound, VelocityAndVolumeFollowTheirLaws) {
  const auto bank = bank_from(kPlain);
  const auto level = [&](int velocity, int volume) {
    const auto engine = engine_for(*bank);
    const Sound sound =
        play(*engine, {control(0, 0, kVolume, volume), on(0, 0, 69, velocity)}, 24000);
    return dbfs(peak(sound.left, 4000));
  };
  const double full = level(127, 127);
  EXPECT_NEAR(level(1, 127) - full, -24, 0.01);
  EXPECT_NEAR(level(64, 127) - full, -12, 0.01);
  EXPECT_NEAR(level(127, 64) - full, 40 * std::log10(64 / 127.0), 0.01);
  EXPECT_EQ(level(127, 0), dbfs(0));
}

TEST(Sound, PanKeepsThePower) {
  const auto bank = bank_from(kPlain);
  const auto sides = [&](int pan) {
    const auto engine = engine_for(*bank);
    const Sound sound = play(*engine, {control(0, 0, kPan, pan), on(0, 0, 69, 127)}, 24000);
    return std::pair(peak(sound.left, 4000), peak(sound.right, 4000));
  };
  const auto [centre_left, centre_right] = sides(64);
  const auto [left, nothing] = sides(0);
  EXPECT_NEAR(centre_left, centre_right, 1e-6);
  EXPECT_NEAR(left * left, centre_left * centre_left + centre_right * centre_right, 1e-5);
  EXPECT_EQ(nothing, 0);
}

TEST(Sound, AStolenVoiceFadesOutWithoutAClick) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank, {.max_voices = 1});
  constexpr std::size_t kFrames = 20000;
  std::vector<std::vector<float>> buffers(4, std::vector<float>(kFrames));
  const std::vector<Engine::Stem> stems = {{buffers[0], buffers[1]}, {buffers[2], buffers[3]}};
  std::vector<float> left(kFrames), right(kFrames);
  engine->process(std::vector<Event>{on(0, 0, 57, 127), on(10037, 1, 64, 127)}, left, right, stems);
  EXPECT_EQ(engine->counters().voices_stolen, 1);
  EXPECT_GT(peak(buffers[0], 9000, 10037), 0.1);
  EXPECT_EQ(peak(buffers[0], 10037 + 241, kFrames), 0);  // 5 ms
  EXPECT_GT(peak(buffers[2], 11000, kFrames), 0.1);      // the new one is there
  EXPECT_LE(splice_dbfs(buffers[0], 10037 + 120), -130) << splice_dbfs(buffers[0], 5000);
}

TEST(Sound, StealingTakesTheReleasedVoiceBeforeHeldOnes) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank, {.max_voices = 2});
  constexpr std::size_t kFrames = 9000;
  std::vector<std::vector<float>> buffers(6, std::vector<float>(kFrames));
  const std::vector<Engine::Stem> stems = {
      {buffers[0], buffers[1]}, {buffers[2], buffers[3]}, {buffers[4], buffers[5]}};
  std::vector<float> left(kFrames), right(kFrames);
  engine->process(
      std::vector<Event>{on(0, 0, 57), on(100, 1, 64), off(5000, 1, 64), on(5100, 2, 69)}, left,
      right, stems);
  EXPECT_GT(peak(buffers[0], 8000, kFrames), 0);  // the oldest, but its key is down
  EXPECT_EQ(peak(buffers[2], 5400, kFrames), 0);  // released 2 ms before
  EXPECT_GT(peak(buffers[4], 8000, kFrames), 0);
}

TEST(Sound, SixteenChannelsHaveTheirOwnPrograms) {
  BankSpec spec;
  spec.drum_channel = 0;
  for (int i = 0; i < 16; ++i) {
    auto patch = parse_patch(kPlain, "scene.toml");
    ASSERT_TRUE(patch);
    patch->oscillators[0].transpose_semitones = i;
    spec.patches.push_back(*std::move(patch));
    BankEntry entry;
    entry.program_low = entry.program_high = i;
    spec.entries.push_back(entry);
    spec.entry_patch.push_back(i);
  }
  const auto bank = BankProgram::create(spec);
  ASSERT_TRUE(bank);
  const auto engine = engine_for(**bank);
  constexpr std::size_t kFrames = 12000;
  std::vector<std::vector<float>> buffers(32, std::vector<float>(kFrames));
  std::vector<Engine::Stem> stems;
  std::vector<Event> events;
  for (int c = 0; c < 16; ++c) {
    stems.push_back({buffers[std::size_t(2 * c)], buffers[std::size_t(2 * c + 1)]});
    events.push_back(midi(0, 0xC0 | c, 15 - c, 0));
  }
  for (int c = 0; c < 16; ++c) events.push_back(on(0, c, 69));
  std::vector<float> left(kFrames), right(kFrames);
  engine->process(events, left, right, stems);
  for (int c = 0; c < 16; ++c) {
    EXPECT_NEAR(frequency_hz(buffers[std::size_t(2 * c)], 1000, kFrames),
                440 * std::exp2((15 - c) / 12.0), 0.01)
        << "channel " << c;
  }
}

TEST(Sound, MonoGlidesAndLegatoDoesNotRetrigger) {
  const auto bank = bank_from(with(kPlain, "mode = \"legato\"\nglide_s = 0.1"));
  const auto engine = engine_for(*bank);
  const Sound sound = play(*engine, {on(0, 0, 57), on(12000, 0, 69)}, 30000);
  EXPECT_EQ(engine->counters().voices_peak, 1);
  EXPECT_NEAR(frequency_hz(sound.left, 4000, 12000), 220, 0.01);
  EXPECT_NEAR(frequency_hz(sound.left, 17000, 30000), 440, 0.01);
  const double halfway = frequency_hz(sound.left, 14200, 14600);  // of 4800 samples
  EXPECT_NEAR(halfway, 440 / std::sqrt(2), 8);
  // One cycle of the lower note always holds the full peak: the loudness never dips.
  for (std::size_t i = 12000; i < 20000; i += 220) {
    EXPECT_NEAR(peak(sound.left, i, i + 220), peak(sound.left, 4000, 12000), 2e-3) << i;
  }
}

TEST(Sound, MonoRetriggersOnTheSameVoiceWithoutAClick) {
  const auto bank = bank_from(with(kPlain, "mode = \"mono\""));
  const auto engine = engine_for(*bank);
  const Sound sound = play(*engine, {on(0, 0, 57, 127), on(10037, 0, 57, 127)}, 20000);
  EXPECT_EQ(engine->counters().voices_peak, 1);
  EXPECT_LE(splice_dbfs(sound.left, 10037), -110);
}

TEST(Sound, AThousandRandomRetriggersAreClickFree) {
  const auto bank = bank_from(with(kPlain, "mode = \"mono\""));
  const auto engine = engine_for(*bank);
  const base::RandomStream random{support::test_seed(), 0, 79};
  const int count = support::test_count(1000);
  std::vector<Event> events = {on(0, 0, 57, 127)};
  std::vector<std::size_t> splices;
  std::size_t at = 4000;
  for (int i = 0; i < count; ++i) {
    at += 1500 + static_cast<std::size_t>(random.unit(static_cast<std::uint64_t>(2 * i)) * 500);
    splices.push_back(at);
    const auto fraction =
        static_cast<std::uint32_t>(random.bits(static_cast<std::uint64_t>(2 * i + 1)));
    // Off within the release or not, then on again: attack of 10 ms, release of 50 ms.
    if (i % 2 == 0) events.push_back(off(static_cast<std::int64_t>(at) - 900, 0, 57));
    events.push_back(midi(static_cast<std::int64_t>(at), 0x90, 57, 127, fraction));
  }
  const Sound sound = play(*engine, events, at + 4000);
  EXPECT_EQ(engine->counters().voices_peak, 1);
  double worst = -400;
  for (const std::size_t splice : splices) worst = std::max(worst, splice_dbfs(sound.left, splice));
  EXPECT_LE(worst, -110);
}

TEST(Sound, MpeBendsOneNoteOfAChord) {
  const auto bank = bank_from(kPlain);
  const auto engine = engine_for(*bank);
  std::vector<Event> events = {control(0, 0, kRpnMsb, 0), control(0, 0, kRpnLsb, 6),
                               control(0, 0, kDataEntryMsb, 3)};
  events.push_back(midi(1, 0xE1, 0, 80));  // member 2: 16/63.99 of 48 semitones
  events.push_back(on(2, 1, 57));
  const Sound sound = play(*engine, events, 24000);
  EXPECT_NEAR(frequency_hz(sound.left, 2000, 24000),
              220 * std::exp2(48 * (80 * 128 - 8192) / 8191.0 / 12), 0.01);
}

TEST(Sound, AStepOfTheBendRangeStartsFromThePatchesOwn) {
  const auto bank = bank_from(with(kPlain, "bend_semitones = 12"));
  const auto engine = engine_for(*bank);
  std::vector<Event> events = {control(0, 0, kRpnMsb, 0), control(0, 0, kRpnLsb, 0)};
  for (int i = 0; i < 10; ++i) events.push_back(control(0, 0, kDataIncrement, 0));
  events.push_back(midi(1, 0xE0, 127, 127));
  events.push_back(on(2, 0, 57));
  const Sound sound = play(*engine, events, 24000);
  EXPECT_NEAR(frequency_hz(sound.left, 2000, 24000), 220 * std::exp2(12.1 / 12), 0.01);
}

TEST(Sound, TheBendRangeOfOneMpeMemberIsThatOfItsZoneAndTheMasterHasItsOwn) {
  const auto bank = bank_from(kPlain);
  const auto pitch_of = [&](int told, int bent) {
    const auto engine = engine_for(*bank);
    std::vector<Event> events;
    for (const int master : {0, 15}) {
      events.push_back(control(0, master, kRpnMsb, 0));
      events.push_back(control(0, master, kRpnLsb, 6));
      events.push_back(control(0, master, kDataEntryMsb, 3));
    }
    events.push_back(control(0, told, kRpnMsb, 0));
    events.push_back(control(0, told, kRpnLsb, 0));
    events.push_back(control(0, told, kDataEntryMsb, 24));
    events.push_back(midi(1, 0xE0 | bent, 127, 127));
    events.push_back(on(2, bent == 0 ? 1 : bent, 57));
    const Sound sound = play(*engine, events, 24000);
    return 12 * std::log2(frequency_hz(sound.left, 2000, 24000) / 220);
  };
  EXPECT_NEAR(pitch_of(2, 1), 24, 1e-3);
  EXPECT_NEAR(pitch_of(2, 3), 24, 1e-3);
  EXPECT_NEAR(pitch_of(2, 0), 2, 1e-3);    // the master keeps its range
  EXPECT_NEAR(pitch_of(0, 1), 48, 1e-3);   // and speaks of its own alone
  EXPECT_NEAR(pitch_of(2, 13), 48, 1e-3);  // the other zone
}

TEST(Sound, AReleasedMpeNoteDoesNotFollowTheNextOneOnItsChannel) {
  const auto bank = bank_from(kPlain);
  constexpr std::size_t kFrames = 20000;
  const auto render = [&](bool next_note) {
    const auto engine = engine_for(*bank);
    std::vector<Event> events = {control(0, 0, kRpnMsb, 0), control(0, 0, kRpnLsb, 6),
                                 control(0, 0, kDataEntryMsb, 3), on(2, 1, 57), off(10000, 1, 57)};
    if (next_note) {
      events.push_back(on(10100, 1, 69));
      events.push_back(midi(10200, 0xE1, 0, 100));
    }
    return play(*engine, events, kFrames);
  };
  const Sound alone = render(false), both = render(true);
  std::vector<float> second(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) second[i] = both.left[i] - alone.left[i];
  // What is left over is the second note alone: a pure bent tone, no trace of a bent first one.
  EXPECT_NEAR(frequency_hz(second, 10600, 12300),
              440 * std::exp2(48 * (100 * 128 - 8192) / 8191.0 / 12), 2);
}

TEST(Sound, AWeightOnTheWheelBendsTheEnvelopeWhileItSounds) {
  constexpr std::string_view kWeighted = R"(
format = 1
kind = "patch"
[curves.arch]
degree = 2
points = [0, 1, 0]
weights = [1, 1, 1]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "arch"
seconds = 1
[[maps]]
from = "mod"
to = "curve.arch.weight.1"
low = 1
high = 4
)";
  const auto bank = bank_from(kWeighted);
  const auto middle = [&](int wheel) {
    const auto engine = engine_for(*bank);
    const Sound sound = play(*engine, {control(0, 0, 1, wheel), on(0, 0, 69, 127)}, 48000);
    return peak(sound.left, 23900, 24100);
  };
  // The middle of a rational parabola of heights 0, 1, 0 is w / (1 + w).
  EXPECT_NEAR(middle(127) / middle(0), (4 / 5.0) / (1 / 2.0), 1e-3);
  EXPECT_NEAR(middle(64) / middle(0), (1 + 3 * 64 / 127.0) / (2 + 3 * 64 / 127.0) / 0.5, 1e-3);
  // The wheel at rest is `low`, and the weight in the file is not heard.
  std::string written(kWeighted);
  written.replace(written.find("[1, 1, 1]"), 9, "[1, 3, 1]");
  const auto other = bank_from(written);
  const auto engine = engine_for(*other);
  EXPECT_EQ(peak(play(*engine, {on(0, 0, 69, 127)}, 48000).left, 23900, 24100), middle(0));
}

TEST(Sound, TempoSetsAnLfoInBeats) {
  constexpr std::string_view kBeats = R"(
[lfos.pulse]
curve = "square"
beats = 1
[[maps]]
from = "pulse"
to = "amp"
depth = 20
)";
  const auto bank = bank_from(std::string(kPlain) + std::string(kBeats));
  const auto engine = engine_for(*bank);
  Event tempo = of_kind(0, Event::Kind::tempo);
  tempo.microseconds_per_quarter = 1000000;
  const Sound sound = play(*engine, {tempo, on(0, 0, 69)}, 96000);
  EXPECT_NEAR(dbfs(peak(sound.left, 4000, 23000)) - dbfs(peak(sound.left, 26000, 47000)), 40, 0.1);
  EXPECT_NEAR(dbfs(peak(sound.left, 50000, 71000)) - dbfs(peak(sound.left, 74000, 95000)), 40, 0.1);
}

TEST(Sound, ChokedNotesAreSilentInFiveMilliseconds) {
  BankSpec spec;
  auto patch = parse_patch(kPlain, "scene.toml");
  ASSERT_TRUE(patch);
  spec.patches.push_back(*std::move(patch));
  for (const int key : {42, 46}) {
    BankEntry entry;
    entry.key = key;
    entry.note = key + 20;
    entry.choke_group = 1;
    spec.entries.push_back(entry);
    spec.entry_patch.push_back(0);
  }
  const auto bank = BankProgram::create(spec);
  ASSERT_TRUE(bank);
  const auto engine = engine_for(**bank);
  play(*engine, {on(0, 9, 46), on(5000, 9, 42), on(5000, 9, 41)}, 5300);
  EXPECT_EQ(engine->counters().voices_now, 1);
  EXPECT_EQ(engine->counters().notes, 2);  // key 41 has no entry
}

TEST(Sound, AHeldNoteCrossfadesToANewBankWhereItsEnvelopeStands) {
  const auto bank = bank_from(kPlain), same = bank_from(kPlain);
  const auto alone = engine_for(*bank);
  const auto engine = engine_for(*bank);
  Event install = of_kind(9600, Event::Kind::install_bank);
  install.bank = same.get();
  const Sound expected = play(*alone, {on(0, 0, 69, 127)}, 20000);
  const Sound sound = play(*engine, {on(0, 0, 69, 127), install}, 20000);
  EXPECT_EQ(peak(sound.left, 9500, 9600), peak(expected.left, 9500, 9600));
  EXPECT_NEAR(peak(sound.left, 11000), peak(expected.left, 11000), 1e-4);  // no new attack
  EXPECT_LE(splice_dbfs(sound.left, 9600 + 480), -110);
}

/// When the old bank is played no more, in samples after a new one came under so many held notes.
std::int64_t samples_until_free(int notes) {
  const auto bank = bank_from(kPlain), other = bank_from(kPlain);
  const auto engine = engine_for(*bank, {.max_voices = 64});
  std::vector<Event> events;
  for (int i = 0; i < notes; ++i) events.push_back(on(0, i % 16, 40 + i));
  play(*engine, events, 4800);
  Event install = of_kind(4800, Event::Kind::install_bank);
  install.bank = other.get();
  play(*engine, {install}, 1, 1);
  while (engine->is_playing(bank.get()) && engine->now() < 48000) play(*engine, {}, 1, 1);
  EXPECT_EQ(engine->counters().voices_now, notes);
  EXPECT_EQ(engine->counters().notes_dropped, 0);
  return engine->now() - 4800;
}

TEST(Sound, AFewNotesGoOverToANewBankAtOnceAndAFullHouseInEightGroups) {
  EXPECT_EQ(samples_until_free(1), 960);
  EXPECT_EQ(samples_until_free(8), 960);
  EXPECT_EQ(samples_until_free(9), 960 + 240);
  EXPECT_EQ(samples_until_free(64), 960 + 7 * 240);
}

TEST(PatchProgram, WhatMovesItselfIsRefusedByName) {
  auto patch = parse_patch(kPlain, "scene.toml");
  ASSERT_TRUE(patch);
  LfoUse lfo;
  lfo.name = "wobble";
  lfo.curve = "gate";
  patch->lfos.push_back(lfo);
  MapSpec map;
  map.source = MapSource::lfo;
  map.target = MapTarget::lfo_rate;
  map.target_index = 0;
  patch->maps.push_back(map);
  const auto program = PatchProgram::create(*patch);
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().code, ErrorCode::cyclic_reference);
  EXPECT_NE(program.error().message.find("lfo 'wobble'"), std::string::npos)
      << program.error().message;
  EXPECT_EQ(program.error().source, "scene.toml");
}

TEST(PatchProgram, FaultsNameTheirPlace) {
  const auto spec = parse_patch(kPlain, "scene.toml");
  ASSERT_TRUE(spec);
  const auto fault = [&](auto&& change) {
    PatchSpec broken = *spec;
    change(broken);
    const auto program = PatchProgram::create(broken);
    EXPECT_FALSE(program);
    return program ? Error{} : program.error();
  };
  EXPECT_EQ(fault([](PatchSpec& p) { p.oscillators[0].wave = "sinne"; }).code,
            ErrorCode::unknown_name);
  EXPECT_EQ(fault([](PatchSpec& p) { p.envelopes[0].curve = "gat"; }).message,
            "patch 'Plain': envelope 'amp': no curve 'gat'; did you mean 'gate'?");
  EXPECT_EQ(fault([](PatchSpec& p) { p.oscillators[0].envelope = "none"; }).code,
            ErrorCode::unknown_name);
  EXPECT_EQ(fault([](PatchSpec& p) { p.oscillators.resize(5, p.oscillators[0]); }).code,
            ErrorCode::value_out_of_range);
  const auto two_maps = [](PatchSpec& p) {
    MapSpec map;
    map.target = MapTarget::curve_point;
    map.target_curve = "gate";
    map.target_point = 2;
    p.maps = {map, map};
  };
  EXPECT_EQ(fault(two_maps).code, ErrorCode::control_conflict);
  const auto map_to_nothing = [](PatchSpec& p) {
    MapSpec map;
    map.target = MapTarget::level;
    map.target_index = 3;
    p.maps = {map};
  };
  EXPECT_EQ(fault(map_to_nothing).message,
            "patch 'Plain': map 1: oscillator 3 does not exist; there are 1");
}

TEST(PatchProgram, AMapFromVelocityToLoudnessReplacesTheBuiltInLaw) {
  auto spec = parse_patch(kPlain, "scene.toml");
  ASSERT_TRUE(spec);
  EXPECT_TRUE((*PatchProgram::create(*spec))->uses_velocity_law());
  MapSpec map;
  map.source = MapSource::velocity;
  map.target = MapTarget::amp;
  spec->maps = {map};
  EXPECT_FALSE((*PatchProgram::create(*spec))->uses_velocity_law());
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "knotwave/engine/patch.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "knotwave/engine/bank.h"

#include "support/broken.h"

namespace knotwave::engine {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples = KNOTWAVE_SOURCE_DIR "/examples";

std::vector<std::string> toml_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// A patch of the least that is one, with `more` at its end.
std::string least_patch(const std::string& more = "") {
  return "format = 1\nkind = \"patch\"\n[curves.ring]\ndegree = 1\npoints = [1, 0]\n"
         "[oscillators.a]\nwave = \"sine\"\n[envelopes.amp]\ncurve = \"ring\"\n" +
         more;
}

PatchSpec parsed(const std::string& text) {
  auto patch = parse_patch(text, "test.toml");
  EXPECT_TRUE(patch) << patch.error().to_string();
  return patch ? std::move(*patch) : PatchSpec{};
}

std::string error_of(const std::string& text) {
  const auto patch = parse_patch(text, "test.toml");
  return patch ? "no error" : patch.error().to_string();
}

// A folder of its own that goes with the test.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("knotwave_patch_test_" + unique())) {
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code failed;
    fs::remove_all(path_, failed);
  }
  std::string write(const std::string& name, const std::string& text) const {
    const fs::path path = path_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

 private:
  static std::string unique() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::string(test->name()) + std::to_string(::getpid());
  }
  fs::path path_;
};

TEST(Patch, EveryShippedPatchReadsAndFitsOnAScreen) {
  const auto files = toml_files(std::string(kExamples) + "/patches");
  EXPECT_GE(files.size(), 12u);
  for (const std::string& file : files) {
    const auto bank = read_bank(file);
    ASSERT_TRUE(bank) << bank.error().to_string();
    EXPECT_FALSE(bank->patches.at(0).name.empty()) << file;
    std::ifstream text(file);
    const auto lines = std::count(std::istreambuf_iterator<char>(text), {}, '\n');
    EXPECT_LE(lines, 80) << file;
  }
}

TEST(Patch, EveryShippedBankReads) {
  const auto files = toml_files(std::string(kExamples) + "/banks");
  EXPECT_GE(files.size(), 1u);
  for (const std::string& file : files) {
    const auto bank = read_bank(file);
    ASSERT_TRUE(bank) << bank.error().to_string();
    EXPECT_EQ(bank->entries.size(), bank->entry_patch.size());
  }
}

TEST(Patch, TheGeneralMidiBankHasEveryProgramAndEveryDrumKey) {
  const auto bank = read_bank(std::string(kExamples) + "/banks/general-midi.toml");
  ASSERT_TRUE(bank) << bank.error().to_string();
  EXPECT_EQ(bank->drum_channel, 10);
  std::vector<int> programs(128), keys(128);
  for (const BankEntry& entry : bank->entries) {
    if (entry.key >= 0) {
      ++keys[static_cast<std::size_t>(entry.key)];
      continue;
    }
    for (int i = entry.program_low; i <= entry.program_high; ++i) {
      ++programs[static_cast<std::size_t>(i)];
    }
  }
  EXPECT_THAT(programs, testing::Each(1));
  for (std::size_t key = 27; key <= 87; ++key) EXPECT_EQ(keys[key], 1) << key;
}

TEST(Patch, WhatIsNotWrittenHasTheDefaultsOfTheSpec) {
  const PatchSpec patch = parsed(least_patch());
  EXPECT_EQ(patch.polyphony, 32);
  EXPECT_EQ(patch.mode, PlayMode::poly);
  EXPECT_EQ(patch.bend_semitones, 2);
  EXPECT_EQ(patch.velocity_db, 24);
  EXPECT_EQ(patch.seed, 1u);
  EXPECT_EQ(patch.noise_db, kNoiseOffDb);
  EXPECT_FALSE(patch.filter_on);
  EXPECT_FALSE(patch.crossfade_on);
  ASSERT_EQ(patch.envelopes.size(), 1u);
  EXPECT_EQ(patch.envelopes[0].spec.seconds, 1);
  EXPECT_LT(patch.envelopes[0].spec.sustain_u, 0);
  EXPECT_LT(patch.envelopes[0].spec.release_u, 0);
  EXPECT_EQ(patch.envelopes[0].spec.loop_start_u, patch.envelopes[0].spec.loop_end_u);
  ASSERT_NE(patch.curves.find_curve("sine"), nullptr);
}

TEST(Patch, EveryKeyReachesItsField) {
  const PatchSpec patch = parsed(
      "format = 1\nkind = 'patch'\nname = 'N'\nabout = 'A'\ngain_db = -6\npan = 0.4\n"
      "polyphony = 8\nmode = 'legato'\npriority = 'high'\nglide_s = 0.1\nglide_curve = 'up'\n"
      "bend_semitones = 12\nvelocity_db = 30\nseed = 77\n"
      "[curves.up]\ndegree = 1\npoints = [0, 1]\n"
      "[surfaces.row]\ndegree_u = 1\ndegree_v = 1\npoints = [[0, 1], [1, 0]]\n"
      "[oscillators.a]\nwave = 'row'\nlevel_db = -3\ntranspose = 12\ndetune_cents = 5\nratio = "
      "1.5\n"
      "position = 0.25\nphase = 0.75\npan = 0.1\nenvelope = 'mod2'\n"
      "[oscillators.b]\nwave = 'saw'\nfixed_hz = 50\nphase = 'random'\n"
      "[noise]\nlevel_db = -20\npan = 0.6\nenvelope = 'amp'\n"
      "[crossfade]\nbetween = ['b', 'noise']\nlaw = 'up'\nposition = 0.3\n"
      "[shaper]\ncurve = 'up'\ndrive_db = 6\nmix = 0.5\n"
      "[filter]\nkind = 'notch'\ncutoff_hz = 1200\nresonance = 0.2\nkey_track = 0.5\n"
      "[envelopes.amp]\ncurve = 'up'\nbeats = 2\nsustain_at = 0.5\nrelease_at = 0.6\n"
      "retrigger = 'restart'\nvelocity_time = 1\nkey_time = -1\n"
      "[envelopes.mod2]\ncurve = 'up'\nseconds = 4\nloop = [0.1, 0.4]\nrelease_at = 0.4\n"
      "[lfos.wow]\ncurve = 'sine'\nrate_hz = 3\nmode = 'free'\nphase = 0.5\ndelay_s = 0.1\n"
      "fade_s = 0.2\nrandom = true\n"
      "[lfos.beat]\ncurve = 'triangle'\nbeats = 0.5\nmode = 'one_shot'\n"
      "[[maps]]\nfrom = 'cc74'\ncurve = 'up'\nto = 'a.phase'\ndepth = 0.5\nsmooth_s = 0.02\n"
      "enabled = false\n"
      "[[maps]]\nfrom = ['wow', 'mod2']\nsurface = 'row'\nto = 'lfo.beat.rate'\n"
      "[[maps]]\nfrom = 'mod'\nto = 'curve.up.weight.1'\nlow = 0.5\nhigh = 2\n"
      "[[maps]]\nfrom = 'random'\nto = 'curve.up.point.0.x'\nlow = -1\nhigh = 1\n"
      "[[maps]]\nfrom = 'velocity'\nto = 'envelope.mod2.time'\n");
  EXPECT_EQ(patch.name, "N");
  EXPECT_EQ(patch.about, "A");
  EXPECT_EQ(patch.gain_db, -6);
  EXPECT_EQ(patch.pan, 0.4);
  EXPECT_EQ(patch.polyphony, 8);
  EXPECT_EQ(patch.mode, PlayMode::legato);
  EXPECT_EQ(patch.priority, NotePriority::high);
  EXPECT_EQ(patch.glide_s, 0.1);
  EXPECT_EQ(patch.glide_curve, "up");
  EXPECT_EQ(patch.bend_semitones, 12);
  EXPECT_EQ(patch.velocity_db, 30);
  EXPECT_EQ(patch.seed, 77u);
  ASSERT_EQ(patch.oscillators.size(), 2u);
  const OscillatorSpec& a = patch.oscillators[0];
  EXPECT_EQ(a.wave, "row");
  EXPECT_EQ(a.level_db, -3);
  EXPECT_EQ(a.transpose_semitones, 12);
  EXPECT_EQ(a.detune_cents, 5);
  EXPECT_EQ(a.ratio, 1.5);
  EXPECT_EQ(a.position, 0.25);
  EXPECT_EQ(a.phase_cycles, 0.75);
  EXPECT_EQ(a.pan, 0.1);
  EXPECT_EQ(a.envelope, "mod2");
  EXPECT_EQ(patch.oscillators[1].fixed_hz, 50);
  EXPECT_TRUE(patch.oscillators[1].random_phase);
  EXPECT_EQ(patch.noise_db, -20);
  EXPECT_EQ(patch.noise_pan, 0.6);
  EXPECT_EQ(patch.noise_envelope, "amp");
  EXPECT_TRUE(patch.crossfade_on);
  EXPECT_EQ(patch.crossfade_a, 1);
  EXPECT_EQ(patch.crossfade_b, kMaxOscillators);
  EXPECT_EQ(patch.crossfade_law, "up");
  EXPECT_EQ(patch.crossfade_position, 0.3);
  EXPECT_EQ(patch.shaper_curve, "up");
  EXPECT_EQ(patch.shaper_drive_db, 6);
  EXPECT_EQ(patch.shaper_mix, 0.5);
  EXPECT_TRUE(patch.filter_on);
  EXPECT_EQ(patch.filter_kind, dsp::FilterKind::notch);
  EXPECT_EQ(patch.filter_cutoff_hz, 1200);
  EXPECT_EQ(patch.filter_resonance, 0.2);
  EXPECT_EQ(patch.filter_key_track, 0.5);
  ASSERT_EQ(patch.envelopes.size(), 2u);
  const EnvelopeUse& amp = patch.envelopes[0];
  EXPECT_TRUE(amp.tempo_beats);
  EXPECT_EQ(amp.spec.seconds, 2);
  EXPECT_EQ(amp.spec.sustain_u, 0.5);
  EXPECT_EQ(amp.spec.release_u, 0.6);
  EXPECT_EQ(amp.spec.retrigger, dsp::EnvelopeSpec::Retrigger::restart);
  EXPECT_EQ(amp.velocity_time, 1);
  EXPECT_EQ(amp.key_time, -1);
  EXPECT_EQ(patch.envelopes[1].spec.loop_start_u, 0.1);
  EXPECT_EQ(patch.envelopes[1].spec.loop_end_u, 0.4);
  ASSERT_EQ(patch.lfos.size(), 2u);
  const dsp::LfoSpec& wow = patch.lfos[0].spec;
  EXPECT_EQ(wow.rate_hz, 3);
  EXPECT_EQ(wow.mode, dsp::LfoSpec::Mode::free);
  EXPECT_EQ(wow.phase_cycles, 0.5);
  EXPECT_EQ(wow.delay_s, 0.1);
  EXPECT_EQ(wow.fade_s, 0.2);
  EXPECT_TRUE(wow.random);
  EXPECT_EQ(patch.lfos[1].spec.beats, 0.5);
  EXPECT_EQ(patch.lfos[1].spec.mode, dsp::LfoSpec::Mode::one_shot);
  ASSERT_EQ(patch.maps.size(), 5u);
  EXPECT_EQ(patch.maps[0].source, MapSource::control);
  EXPECT_EQ(patch.maps[0].source_index, 74);
  EXPECT_EQ(patch.maps[0].curve, "up");
  EXPECT_EQ(patch.maps[0].target, MapTarget::phase);
  EXPECT_EQ(patch.maps[0].target_index, 0);
  EXPECT_EQ(patch.maps[0].depth, 0.5);
  EXPECT_EQ(patch.maps[0].smooth_s, 0.02);
  EXPECT_FALSE(patch.maps[0].enabled);
  EXPECT_EQ(patch.maps[1].source, MapSource::lfo);
  EXPECT_EQ(patch.maps[1].source_v, MapSource::envelope);
  EXPECT_EQ(patch.maps[1].source_v_index, 1);
  EXPECT_EQ(patch.maps[1].surface, "row");
  EXPECT_EQ(patch.maps[1].target, MapTarget::lfo_rate);
  EXPECT_EQ(patch.maps[1].target_index, 1);
  EXPECT_EQ(patch.maps[2].target, MapTarget::curve_weight);
  EXPECT_EQ(patch.maps[2].target_curve, "up");
  EXPECT_EQ(patch.maps[2].target_point, 1);
  EXPECT_EQ(patch.maps[2].low, 0.5);
  EXPECT_EQ(patch.maps[2].high, 2);
  EXPECT_EQ(patch.maps[3].target, MapTarget::curve_point);
  EXPECT_EQ(patch.maps[3].target_coordinate, 0);
  EXPECT_EQ(patch.maps[4].target, MapTarget::envelope_time);
  EXPECT_EQ(patch.maps[4].target_index, 1);
}

TEST(Patch, CurvesComeFromFilesBesideThePatchUnderTheNameOfTheTable) {
  const Folder folder;
  folder.write("curves/decay.toml",
               "format = 1\nkind = 'curve'\n[curves.fast]\ndegree = 1\npoints = [1, 0.5]\n"
               "[curves.slow]\ndegree = 1\npoints = [1, 0.25]\n");
  const std::string path = folder.write(
      "patches/p.toml",
      "format = 1\nkind = 'patch'\n[curves.ring]\ncurve_file = '../curves/decay.toml#slow'\n"
      "[curves.fast]\ncurve_file = '../curves/decay.toml'\n"
      "[oscillators.a]\nwave = 'saw'\n[envelopes.amp]\ncurve = 'ring'\n");
  const auto bank = read_bank(path);
  ASSERT_TRUE(bank) << bank.error().to_string();
  const curves::CurveSet& set = bank->patches[0].curves;
  ASSERT_NE(set.find_curve("ring"), nullptr);
  EXPECT_EQ(set.find_curve("ring")->points()[1], 0.25);
  ASSERT_NE(set.find_curve("fast"), nullptr);
  EXPECT_EQ(set.find_curve("fast")->points()[1], 0.5);
}

TEST(Patch, AFaultInANamedFileIsToldAtItsOwnPlaceAndAMissingOneAtTheName) {
  const Folder folder;
  folder.write("bad.toml", "format = 1\nkind = 'curve'\n[curves.c]\ndegree = 0\npoints = [1]\n");
  const std::string head = "format = 1\nkind = 'patch'\n[curves.c]\n";
  auto bank = read_bank(folder.write("a.toml", head + "curve_file = 'bad.toml'\n"));
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::HasSubstr("bad.toml:4:10: error: curve 'c': "));
  bank = read_bank(folder.write("b.toml", head + "curve_file = 'none.toml'\n"));
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::HasSubstr("b.toml:4:14: error: curve 'c': "));
  EXPECT_EQ(bank.error().code, ErrorCode::file_not_found);
  bank = read_bank(folder.write("c.toml", head + "curve_file = 'c.toml'\n"));
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::HasSubstr("c.toml:4:14: error: curve 'c': "));
  EXPECT_EQ(bank.error().code, ErrorCode::cyclic_reference);
}

TEST(Patch, ATuningIsReadBesideThePatchAndItsFaultsAreToldThere) {
  const Folder folder;
  folder.write("good.scl", "pure\n2\n3/2\n2/1\n");
  folder.write("bad.scl", "pure\n2\n3/2\n0/1\n");
  folder.write("empty.scl", "");
  auto bank = read_bank(folder.write("a.toml", "tuning = 'good.scl'\n" + least_patch()));
  ASSERT_TRUE(bank) << bank.error().to_string();
  EXPECT_NEAR(bank->patches[0].tuning.hz(71), 880, 1e-9);
  bank = read_bank(folder.write("b.toml", "tuning = 'bad.scl'\n" + least_patch()));
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::HasSubstr("bad.scl:4:1: error: "));
  bank = read_bank(folder.write("c.toml", "tuning = 'none.scl'\n" + least_patch()));
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::HasSubstr("c.toml:1:10: error: "));
  bank = read_bank(folder.write("d.toml", "tuning = 'empty.scl'\n" + least_patch()));
  ASSERT_FALSE(bank);
  EXPECT_THAT(bank.error().to_string(), testing::HasSubstr("empty.scl:1:1: error: "));
}

TEST(Patch, APatchAloneIsABankThatPlaysEveryProgramAndHasNoDrumChannel) {
  const Folder folder;
  const auto bank = read_bank(folder.write("a.toml", least_patch()));
  ASSERT_TRUE(bank) << bank.error().to_string();
  ASSERT_EQ(bank->entries.size(), 1u);
  EXPECT_EQ(bank->drum_channel, 0);
  EXPECT_EQ(bank->entries[0].program_low, 0);
  EXPECT_EQ(bank->entries[0].program_high, 127);
  EXPECT_EQ(bank->entries[0].key, -1);
}

TEST(Patch, ABankReadsEachPatchOnceAndSpreadsRangesOfKeys) {
  const Folder folder;
  folder.write("p.toml", least_patch());
  const auto bank = read_bank(folder.write(
      "b.toml",
      "format = 1\nkind = 'bank'\nname = 'B'\ngain_db = -3\n"
      "[[programs]]\nprogram = [0, 7]\nbank = [1, 2]\npatch = 'p.toml'\ntranspose = -12\n"
      "[[programs]]\nprogram = 8\npatch = './p.toml'\ngain_db = 2\n"
      "[drums]\nchannel = 11\n[[drums.keys]]\nkey = [41, 43]\npatch = 'p.toml'\nnote = 50\n"
      "choke = 2\n"));
  ASSERT_TRUE(bank) << bank.error().to_string();
  EXPECT_EQ(bank->patches.size(), 1u);
  EXPECT_EQ(bank->gain_db, -3);
  EXPECT_EQ(bank->drum_channel, 11);
  ASSERT_EQ(bank->entries.size(), 5u);
  EXPECT_EQ(bank->entries[0].program_high, 7);
  EXPECT_EQ(bank->entries[0].bank_msb, 1);
  EXPECT_EQ(bank->entries[0].bank_lsb, 2);
  EXPECT_EQ(bank->entries[0].transpose_semitones, -12);
  EXPECT_EQ(bank->entries[1].program_low, 8);
  EXPECT_EQ(bank->entries[1].bank_msb, -1);
  EXPECT_EQ(bank->entries[1].gain_db, 2);
  EXPECT_EQ(bank->entries[4].key, 43);
  EXPECT_EQ(bank->entries[4].note, 50);
  EXPECT_EQ(bank->entries[4].choke_group, 2);
}

TEST(Patch, EachBrokenPatchAndBankIsReportedAtItsFault) {
  auto files = support::broken_files("patch_");
  const auto banks = support::broken_files("bank_");
  files.insert(files.end(), banks.begin(), banks.end());
  EXPECT_GE(files.size(), 50u);
  for (const auto& file : files) {
    const auto bank = read_bank(file.path);
    ASSERT_FALSE(bank) << file.name;
    EXPECT_EQ(support::broken_report(file, bank.error()), file.report);
    EXPECT_EQ(std::string(to_string(bank.error().code)), file.code) << file.name;
    EXPECT_GE(bank.error().line, 1) << file.name;
    EXPECT_GE(bank.error().column, 1) << file.name;
  }
}

TEST(Patch, AnEnvelopeGeneratorPatchIsRefusedByName) {
  EXPECT_EQ(error_of("format = 1\nkind = 'envelope'\n"),
            "test.toml:2:8: error: this is a patch of the envelope generator (kind = "
            "\"envelope\"), which makes no sound: knotwave-env plays it");
}

}  // namespace
}  // namespace knotwave::engine

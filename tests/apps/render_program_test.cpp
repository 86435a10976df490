// SPDX-License-Identifier: MIT
// knotwave-render as a user runs it: what it prints, writes and ends with.
#include <cmath>
#include <cstring>
#include <regex>

#include <gmock/gmock.h>

#include "knotwave/base/sha256.h"
#include "knotwave/curves/simd.h"
#include "knotwave/io/sound_file.h"

#include "apps/render_scene.h"

namespace knotwave::render {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using RenderProgram = RenderScene;

std::string sha256_of(const std::string& bytes) {
  base::Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes)));
  return hash.finish_hex();
}
std::vector<float> floats_in(const std::string& bytes) {
  std::vector<float> samples(bytes.size() / 4);
  std::memcpy(samples.data(), bytes.data(), samples.size() * 4);
  return samples;
}

TEST_F(RenderProgram, EndsWithOneLineThatSaysAll) {
  const auto done = render({"-o", "out.wav"});
  const std::regex line(
      "out\\.wav: [0-9]+\\.[0-9]{3} s, 48000 Hz, 2 channels, peak -[0-9.]+ dBFS, rms -[0-9.]+ "
      "dBFS, seed 1, sha256 [0-9a-f]{64}, [0-9.]+ times real time\n");
  EXPECT_TRUE(std::regex_match(done.out, line)) << done.out;
  EXPECT_THAT(done.err, IsEmpty()) << "no progress bar where there is no terminal";
}

TEST_F(RenderProgram, TheHashIsOverTheFloatSamplesBeforeConversion) {
  const auto pipe = render({"-o", "-"});
  EXPECT_EQ(hash_in(pipe.err), sha256_of(pipe.out));
  for (const char* bits : {"16", "24", "32f"}) {
    EXPECT_EQ(hash_in(render({"-o", "out.wav", "--bits", bits}).out), hash_in(pipe.err)) << bits;
  }
  EXPECT_EQ(hash_in(render({"-o", "out.flac"}).out), hash_in(pipe.err));
  render({"-o", "out.wav", "--bits", "32f"});
  EXPECT_EQ(io::read_sound(file("out.wav"))->samples, floats_in(pipe.out));
}

TEST_F(RenderProgram, BlockThreadsAndSimdChangeNoSample) {
  const std::string hash = hash_in(render({"-o", "out.wav"}).out);
  ASSERT_EQ(hash.size(), 64u);
  for (const char* block : {"1", "7", "64", "256", "4096"}) {
    EXPECT_EQ(hash_in(render({"-o", "out.wav", "--block", block}).out), hash) << block;
  }
  for (const char* threads : {"2", "4"}) {
    EXPECT_EQ(hash_in(render({"-o", "out.wav", "--threads", threads}).out), hash) << threads;
  }
  for (const curves::SimdLevel level : curves::simd_levels()) {
    EXPECT_EQ(hash_in(render({"-o", "out.wav", "--simd", to_string(level)}).out), hash)
        << to_string(level);
  }
}

TEST_F(RenderProgram, ADashIsTheScoreOnStandardInput) {
  const std::string hash = hash_in(render({"-o", "out.wav"}).out);
  support::ProgramOptions options;
  options.folder = folder_.path();
  const std::string program = KNOTWAVE_BIN_DIR "/knotwave-render small.toml - ";
  const auto shell = [&](const std::string& command) {
    return support::run_program({"/bin/sh", "-c", command}, options);
  };
  EXPECT_EQ(hash_in(shell(program + "-o out.wav <small.mid").out), hash);
  EXPECT_EQ(hash_in(shell("cat small.mid | " + program + "-o out.wav").out), hash);
  EXPECT_EQ(shell(program + "--check <small.mid").out,
            "standard input: ok: 1 track, 8 events, 1.000 s\n");
  EXPECT_THAT(shell(program + "--check <small.toml").err, testing::StartsWith("standard input:"));
  const auto over = shell(program + "-o a.wav --json small.mid <small.mid");
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_THAT(over.err, HasSubstr("--json 'small.mid' would overwrite the score '-'"));
}

TEST_F(RenderProgram, AMapThatMovesACurveNothingPlaysIsTold) {
  const std::string map =
      "[curves.idle]\ndegree = 1\npoints = [0, 1]\n[[maps]]\nfrom = \"mod\"\nlow = 0\nhigh = 1\n";
  write("idle.toml", kSmallPatch + map + "to = \"curve.idle.point.0\"\n");
  const std::string told = "idle.toml:22:6: warning: this map moves 'idle', which nothing plays\n";
  EXPECT_EQ(run({"idle.toml", "small.mid", "--check"}).err, told);
  support::ProgramOptions options;
  options.folder = folder_.path();
  const auto checked = support::run_program({"knotwave-curve", "check", "idle.toml"}, options);
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_EQ(checked.err, told);
  write("busy.toml", kSmallPatch + map + "to = \"curve.gate.point.1\"\n");
  const auto busy = run({"busy.toml", "small.mid", "--check"});
  EXPECT_EQ(busy.exit_code, 0);
  EXPECT_THAT(busy.err, IsEmpty());
}

TEST_F(RenderProgram, AFreeNumberThatNothingReadsIsTold) {
  const std::string patch = std::string(kSmallPatch) +
                            "[[maps]]\nfrom = \"mod\"\nto = \"free.swell\"\n"
                            "[[maps]]\nfrom = \"velocity\"\nto = \"free.swell\"\n";
  const std::string words =
      "warning: this map moves 'free.swell', which no map reads (from = \"free.swell\")\n";
  write("idle.toml", patch);
  EXPECT_EQ(run({"idle.toml", "small.mid", "--check"}).err,
            "idle.toml:17:6: " + words + "idle.toml:20:6: " + words);
  const std::string reader = "[[maps]]\nfrom = \"free.swell\"\nto = \"pitch\"\n";
  write("off.toml", patch + reader + "enabled = false\n");
  EXPECT_THAT(run({"off.toml", "small.mid", "--check"}).err, HasSubstr(words))
      << "a map switched off";
  write("read.toml", patch + reader);
  EXPECT_THAT(run({"read.toml", "small.mid", "--check"}).err, IsEmpty());
}

TEST_F(RenderProgram, AConstantCurveAsAWaveIsSilence) {
  const std::string flat = "[curves.flat]\ndegree = 1\npoints = [0.5, 0.5]\n";
  std::string patch = kSmallPatch + flat;
  patch.replace(patch.find("\"sine\""), 6, "\"flat\"");
  write("flat.toml", patch);
  const auto samples = floats_in(run({"flat.toml", "small.mid", "-o", "-"}).out);
  EXPECT_GT(samples.size(), 2 * 48000u);
  for (const float sample : samples) ASSERT_LT(std::abs(sample), 1e-15f);
}

TEST_F(RenderProgram, AWaveFrameThatNoCycleHasIsToldWithItsPlace) {
  render({"-o", "wave.wav"});
  for (const auto& [frame, is_good] : {std::pair{3, false}, {64, true}, {65537, false}}) {
    write("cut.toml",
          "format = 1\nkind = \"patch\"\nname = \"cut\"\n[oscillators.a]\nwave_file = "
          "\"wave.wav\"\nwave_frame = " +
              std::to_string(frame) +
              "\n[curves.gate]\ndegree = 1\npoints = [1, 0]\n[envelopes.amp]\ncurve = \"gate\"\n");
    support::ProgramOptions options;
    options.folder = folder_.path();
    const auto done = support::run_program({"knotwave-curve", "check", "cut.toml"}, options);
    EXPECT_EQ(done.exit_code, is_good ? 0 : 1) << done.err;
    if (is_good) continue;
    EXPECT_EQ(done.err, "cut.toml:6:14: error: oscillator 'a': wave_frame is " +
                            std::to_string(frame) + "; it must be in 4 to 65536\n");
  }
}

TEST_F(RenderProgram, TwoRunsWriteTheSameBytes) {
  for (const char* name : {"a.wav", "a.flac"}) {
    render({"-o", name, "--bits", "16"});
    const std::string first = read(name);
    render({"-o", name, "--bits", "16"});
    EXPECT_EQ(read(name), first) << name;
  }
}

TEST_F(RenderProgram, StemsAddUpToTheMixToTheBit) {
  render({"-o", "mix.wav", "--bits", "32f", "--stems", "stems"});
  const auto mix = io::read_sound(file("mix.wav"));
  std::vector<float> sum(mix->samples.size());
  for (const char* name : {"channel-01.wav", "channel-02.wav", "channel-05.wav"}) {
    const auto stem = io::read_sound(file(std::string("stems/") + name));
    ASSERT_TRUE(stem.has_value()) << stem.error().to_string();
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += stem->samples[i];
  }
  EXPECT_EQ(sum, mix->samples);
  EXPECT_THAT(read("stems/channel-03.wav"), IsEmpty());
}

TEST_F(RenderProgram, StemsChangeNoSampleOfTheMix) {
  const std::string hash = hash_in(render({"-o", "mix.wav"}).out);
  EXPECT_EQ(hash_in(render({"-o", "mix.wav", "--stems", "stems"}).out), hash);
}

TEST_F(RenderProgram, JsonHoldsTheReport) {
  const auto done = render({"-o", "out.wav", "--json", "-", "--seed", "9"});
  for (const char* key :
       {"path", "seconds", "frames", "rate_hz", "channels", "peak_dbfs", "rms_dbfs", "seed",
        "sha256", "sha256_file", "realtime_factor", "voices_peak", "voices_stolen", "warnings"}) {
    EXPECT_THAT(done.out, HasSubstr(std::string("\"") + key + "\": "));
  }
  EXPECT_THAT(done.out, HasSubstr("\"sha256_file\": \"" + sha256_of(read("out.wav")) + "\""));
  EXPECT_THAT(done.out, HasSubstr("\"sha256\": \"" + hash_in(done.err) + "\""));
  EXPECT_THAT(done.out, HasSubstr("\"seed\": 9"));
  render({"-o", "out.wav", "--json", "out.json"});
  EXPECT_THAT(read("out.json"), HasSubstr("\"path\": \"out.wav\""));
}

TEST_F(RenderProgram, NotesWithoutAPatchAreToldByRenderAndCheck) {
  write("bank.toml",
        "format = 1\nkind = 'bank'\n[[programs]]\nprogram = 0\npatch = 'small.toml'\n");
  io::Song song = small_song();
  song.events.insert(song.events.begin(), io::SongEvent{0, 0, {0xC4, 77, 0}, 0, 0});
  write_song("other.mid", song);
  const std::string warning =
      "other.mid: warning: 1 note is silent: the bank has no patch for program 77 of bank 0:0 "
      "(channel 5); numbers count from 0\n";
  const auto done = run({"bank.toml", "other.mid", "-o", "out.wav", "--json", "out.json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr(warning));
  EXPECT_THAT(done.out, HasSubstr(", 1 note without a patch\n"));
  EXPECT_THAT(read("out.json"), HasSubstr("\"notes_without_patch\": 1"));
  EXPECT_THAT(read("out.json"), HasSubstr("no patch for program 77"));
  const auto checked = run({"--check", "bank.toml", "other.mid"});
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_EQ(checked.err, warning);
}

TEST_F(RenderProgram, AFixedTailIsExactAndAutoEndsInSilence) {
  // The song ends after 1 s.
  EXPECT_EQ(render({"-o", "-", "--tail", "0.5"}).out.size(), 72000u * 8);
  EXPECT_EQ(render({"-o", "-", "--tail", "0"}).out.size(), 48000u * 8);
  const auto samples = floats_in(render({"-o", "-"}).out);
  EXPECT_GT(samples.size(), 2 * 48000u);
  EXPECT_LT(samples.size(), 2 * 54000u);
  EXPECT_EQ(samples[samples.size() - 1], 0.0f);
}

TEST_F(RenderProgram, AScoreWithoutLengthBecomesAValidFile) {
  io::Song song;
  song.track_count = 1;
  song.time_base.ticks_per_quarter = 480;
  write_song("empty.mid", song);
  for (const char* name : {"z.flac", "z.wav"}) {
    const auto done = run({"small.toml", "empty.mid", "-o", name, "--tail", "0"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    const std::string bytes = read(name);
    EXPECT_GE(bytes.size(), 42u) << name;
    EXPECT_THAT(bytes.substr(0, 4), testing::AnyOf("fLaC", "RIFF"));
  }
}

TEST_F(RenderProgram, EndingsCountInAnyCase) {
  for (const char* name : {"x.WAV", "x.Flac"}) {
    render({"-o", name, "--stems", std::string(name) + ".stems"});
    EXPECT_TRUE(io::read_sound(file(name)).has_value()) << name;
  }
  EXPECT_EQ(read("x.Flac.stems/channel-01.flac").substr(0, 4), "fLaC");
}

TEST_F(RenderProgram, ANameMayBeAsLongAsTheFileSystemAllows) {
  const std::string name = std::string(250, 'n') + ".wav";
  render({"-o", name});
  EXPECT_TRUE(io::read_sound(file(name)).has_value());
}

TEST_F(RenderProgram, AWaveOfMorePiecesThanThereMayBeIsToldSo) {
  std::string points;
  for (int i = 0; i < 4096; ++i) points += std::to_string(i * 2557 % 4096) + ",";
  std::string patch = kSmallPatch;
  patch.replace(patch.find("\"sine\""), 6, "\"long\"");
  write("long.toml",
        patch + "[curves.long]\nperiodic = true\ndegree = 15\npoints = [" + points + "]\n");
  const auto done = run({"--check", "long.toml", "small.mid"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("4096 pieces are not enough to follow its "));
  EXPECT_THAT(done.err, HasSubstr("use fewer points or a lower degree"));
}

TEST_F(RenderProgram, ARateIsKept) {
  render({"-o", "out.wav", "--rate", "44100", "--tail", "0"});
  const auto sound = io::read_sound(file("out.wav"));
  EXPECT_EQ(sound->rate_hz, 44100);
  EXPECT_EQ(sound->frames, 44100);
}

TEST_F(RenderProgram, ALongerSongThanMaxLengthIsRefused) {
  const auto done = run({"small.toml", "small.mid", "-o", "out.wav", "--max-length", "0.9"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_EQ(done.err, "small.mid: error: the song lasts 1.0 s; --max-length allows 0.9 s\n");
  EXPECT_THAT(read("out.wav"), IsEmpty());
}

TEST_F(RenderProgram, CheckReadsEverythingAndWritesNothing) {
  const auto done = run({"--check", "small.toml", "small.mid"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "small.mid: ok: 1 track, 8 events, 1.000 s\n");
  write("broken.toml", "format = 1\nkind = \"patch\"\nnaem = \"x\"\n");
  const auto broken = run({"--check", "broken.toml", "small.mid"});
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(broken.err, HasSubstr("broken.toml:3:"));
  EXPECT_THAT(broken.err, HasSubstr("did you mean 'name'?"));
}

TEST_F(RenderProgram, WarningsOfTheSongAreToldUnlessQuiet) {
  std::string bytes = read("small.mid");
  write("cut.mid", bytes.substr(0, bytes.size() - 4));
  const auto done = run({"small.toml", "cut.mid", "-o", "out.wav"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_THAT(done.err, HasSubstr("cut.mid: byte "));
  EXPECT_THAT(done.err, HasSubstr(": warning: "));
  EXPECT_THAT(run({"small.toml", "cut.mid", "-o", "out.wav", "--quiet"}).err, IsEmpty());
}

TEST_F(RenderProgram, ClippingIsCountedAndTold) {
  std::string loud = kSmallPatch;
  loud.insert(loud.find("[curves"), "gain_db = 24\n");
  write("loud.toml", loud);
  const auto done = run({"loud.toml", "small.mid", "-o", "out.wav"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("samples were beyond full scale and are clipped"));
  EXPECT_THAT(run({"loud.toml", "small.mid", "-o", "out.wav", "--bits", "32f"}).err, IsEmpty());
}

TEST_F(RenderProgram, SampledCyclesArePlayedAndAFileIsCutInOneWayOnly) {
  io::SoundWriteConfig config{.path = file("cycle.wav"), .channels = 1};
  auto writer = io::SoundWriter::create(config);
  std::vector<float> cycle(512, 0.5f);
  std::fill(cycle.begin() + 256, cycle.end(), -0.5f);
  ASSERT_TRUE(writer->write(cycle).has_value());
  ASSERT_TRUE(writer->finish().has_value());
  std::string patch = kSmallPatch;
  patch.replace(patch.find("wave = \"sine\""), 13, "wave_file = \"cycle.wav\"");
  write("square.toml", patch);
  const auto done = run({"square.toml", "small.mid", "-o", "out.wav"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(hash_in(done.out), hash_in(render({"-o", "out.wav"}).out));
  write("twice.toml", patch + "[oscillators.b]\nwave_file = \"cycle.wav\"\nwave_frame = 256\n");
  const auto twice = run({"twice.toml", "small.mid", "-o", "out.wav"});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_THAT(twice.err, HasSubstr("cycles of 512 frames elsewhere, and of 256 here"));
  write("cycle.wav", "no sound");
  const auto bad = run({"square.toml", "small.mid", "-o", "out.wav"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, testing::StartsWith("square.toml:9:13: error: oscillator 'a': "));
  EXPECT_THAT(bad.err, HasSubstr("cycle.wav"));
}

TEST_F(RenderProgram, DemosNeedNoOtherFile) {
  const auto done = run({"--demo", "first-light", "-o", "out.wav"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(read("out.wav").substr(0, 4), "RIFF");
}

TEST_F(RenderProgram, FailureIsCode1WithTheFileNamed) {
  const struct {
    std::vector<std::string> words;
    const char* text;
  } cases[] = {
      {{"none.toml", "small.mid", "-o", "x.wav"}, "none.toml: error: no such file"},
      {{"small.toml", "none.mid", "-o", "x.wav"}, "none.mid: error: no such file"},
      {{"smal.toml", "small.mid", "-o", "x.wav"}, "no such file; did you mean 'small.toml'?"},
      {{"small.toml", "small.mdi", "-o", "x.wav"}, "no such file; did you mean 'small.mid'?"},
      {{"small.toml", "small.toml", "-o", "x.wav"}, "small.toml: byte 0: error: not a MIDI file"},
      {{"small.toml", "small.mid", "-o", "no/such/x.wav"}, "no/such"},
      {{"small.toml", "small.mid", "-o", "x.wav", "--json", "no/x.json"}, "into folder 'no'"},
      {{"small.toml", "small.mid", "-o", "x.wav", "--stems", "small.mid"}, "small.mid"},
  };
  for (const auto& c : cases) {
    const auto done = run(c.words);
    EXPECT_EQ(done.exit_code, 1) << done.err;
    EXPECT_THAT(done.err, HasSubstr(c.text));
    EXPECT_THAT(read("x.wav"), IsEmpty());
  }
}

TEST_F(RenderProgram, HelpNamesEveryOptionAndExitCode) {
  const auto help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* word :
       {"--output", "--demo", "--check", "--max-length", "--rate", "--block", "--threads", "--seed",
        "--bits", "--tail", "--json", "--stems", "--quiet", "--simd", "--version", "first-light",
        "75 try again", "130 interrupted"}) {
    EXPECT_THAT(help.out, HasSubstr(word));
  }
  EXPECT_THAT(run({"--version"}).out, testing::MatchesRegex("knotwave-render [0-9.]+\n"));
}

TEST_F(RenderProgram, ProgressIsDrawnOnATerminal) {
  const std::string command =
      KNOTWAVE_BIN_DIR "/knotwave-render small.toml small.mid -o out.wav --tail 60";
  support::ProgramOptions options;
  options.folder = folder_.path();
  const auto on_terminal =
      support::run_program({"/usr/bin/script", "-qec", command, "/dev/null"}, options);
  EXPECT_EQ(on_terminal.exit_code, 0) << on_terminal.out;
  EXPECT_THAT(on_terminal.out, HasSubstr(" left"));
  const auto quiet =
      support::run_program({"/usr/bin/script", "-qec", command + " --quiet", "/dev/null"}, options);
  EXPECT_THAT(quiet.out, testing::Not(HasSubstr(" left")));
}

}  // namespace
}  // namespace knotwave::render

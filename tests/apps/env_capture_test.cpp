// SPDX-License-Identifier: MIT
// knotwave-env --capture as a user runs it, from files: knobs and loudness into curves.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/curves/curve_file.h"
#include "knotwave/io/midi_file.h"
#include "knotwave/io/sound_file.h"

#include "support/corpus.h"
#include "support/program.h"
#include "support/seed.h"

namespace knotwave::env {
namespace {

using support::ProgramRun;
using support::run_program;
using support::ScratchFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

ProgramRun capture(std::vector<std::string> words) {
  words.insert(words.begin(), {"knotwave-env", "--capture"});
  return run_program(words);
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_song(const std::string& path, const io::Song& song) {
  const auto bytes = io::write_midi(song);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

struct Told {
  std::uint64_t tick;
  int number, value;
  int channel = 1;
};

/// Controllers; a tick is 1/960 s.
io::Song song_of(const std::vector<Told>& all, std::uint64_t length) {
  io::Song song;
  song.track_count = 1;
  for (const Told& one : all) {
    song.events.push_back(
        {one.tick,
         0,
         {static_cast<std::uint8_t>(0xAF + one.channel), static_cast<std::uint8_t>(one.number),
          static_cast<std::uint8_t>(one.value)}});
  }
  song.length_ticks = length;
  return song;
}

/// C(u) by de Boor's recursion over the numbers of the file, in long double: not our evaluator.
double value_at(const curves::NurbsCurve& curve, double u) {
  const curves::CurveSpec spec = curve.spec();
  const auto p = static_cast<std::size_t>(spec.degree);
  const auto knots = curve.knots();
  std::size_t k = p;
  while (k + 1 < spec.points.size() && knots[k + 1] <= u) ++k;
  std::vector<long double> d;
  for (std::size_t j = 0; j <= p; ++j) d.push_back(spec.points[j + k - p]);
  for (std::size_t r = 1; r <= p; ++r) {
    for (std::size_t j = p; j >= r; --j) {
      const long double low = knots[j + k - p], high = knots[j + 1 + k - r];
      const long double along = (u - low) / (high - low);
      d[j] = (1 - along) * d[j - 1] + along * d[j];
    }
  }
  return static_cast<double>(d[p]);
}

curves::NurbsCurve curve_of(const std::string& path) {
  const auto set = curves::read_curves(path);
  EXPECT_TRUE(set.has_value()) << set.error().to_string();
  EXPECT_EQ(set->curves.size(), 1u);
  return set->curves.front();
}

constexpr const char* kSweep = R"(
format = 1
kind = "envelope"
name = "sweep"
[trigger]
from = "note"
[ports.out]
wire = "none"
[curves.sweep]
degree = 3
points = [0, 1.2, 0.1, 1, 0.3, 0]
[envelopes.sweep]
curve = "sweep"
seconds = 4
)";

/// A known curve, sent by knotwave-env as `output` says, captured again: the largest difference in
/// steps from the curve as it was, looked for every millisecond.
double steps_apart(const std::string& output, const std::string& word,
                   const std::vector<std::string>& more, double steps, double last_step) {
  const ScratchFolder folder;
  std::ofstream(folder.file("sweep.toml")) << kSweep << "[[outputs]]\nfrom = \"sweep\"\n" << output;
  io::Song keys;
  keys.track_count = 1;
  keys.events.push_back({0, 0, {0x90, 60, 100}});
  keys.events.push_back({4800, 0, {0x80, 60, 0}});
  keys.length_ticks = 4800;
  write_song(folder.file("keys.mid"), keys);
  const ProgramRun sent = run_program({"knotwave-env", folder.file("sweep.toml"), "--dry-run",
                                       folder.file("keys.mid"), "-o", folder.file("sent.mid")});
  EXPECT_EQ(sent.exit_code, 0) << sent.err;
  std::vector<std::string> words = {word,      "--from", folder.file("sent.mid"),
                                    "--whole", "-o",     folder.file("knob.toml")};
  words.insert(words.end(), more.begin(), more.end());
  const ProgramRun run = capture(words);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::printf("%s", run.out.c_str());
  EXPECT_THAT(run.out, HasSubstr("; sent again at most "));
  const curves::NurbsCurve knob = curve_of(folder.file("knob.toml"));
  const auto sweep =
      curves::NurbsCurve::create({.name = "sweep", .points = {0, 1.2, 0.1, 1, 0.3, 0}});
  EXPECT_TRUE(sweep.has_value());
  double most = 0;
  for (int i = 0; i < 4000; ++i) {
    const double time = i * 1e-3;
    const double apart = value_at(knob, time) * last_step - value_at(*sweep, time / 4) * steps;
    most = std::max(most, std::abs(apart));
  }
  return most;
}

// The curve's lines are within half a step of the truth, and the curve within the tolerance of
// them.
TEST(EnvCapture, GivesBackACurveThatWasSent) {
  EXPECT_LE(steps_apart("to = \"cc1\"\n", "cc1", {}, 127, 127), 1);
  EXPECT_LE(steps_apart("to = \"pressure\"\n", "pressure", {}, 127, 127), 1);
  EXPECT_LE(steps_apart("to = \"cc1\"\n", "cc1", {"--tolerance", "0.05"}, 127, 127), 0.55);
}
TEST(EnvCapture, GivesBackACurveOf14Bits) {
  const std::string fine = "bits = 14\nof = [0, 16.383]\n";  // a thousand steps
  EXPECT_LE(steps_apart("to = \"cc1\"\n" + fine, "cc1", {"--bits", "14"}, 1000, 16383), 1);
  EXPECT_LE(steps_apart("to = \"nrpn200\"\n" + fine, "nrpn200", {"--bits", "14"}, 1000, 16383), 1);
  EXPECT_LE(steps_apart("to = \"bend\"\nof = [0, 16.383]\n", "bend", {}, 1000, 16383), 1);
}

/// Random turns, jumps and rests of a knob, in ticks of 1/960 s.
std::vector<Told> random_moves(std::mt19937_64& random, int count) {
  std::vector<Told> all;
  std::uint64_t tick = random() % 1000;
  int value = static_cast<int>(random() % 128);
  for (int i = 0; i < count; ++i) {
    all.push_back({tick, 1, value});
    tick += random() % 8 == 0 ? random() % 3000 : 1 + random() % 30;
    const int size = random() % 10 == 0 ? static_cast<int>(random() % 100) : 1;
    value = std::clamp(value + (random() % 3 == 0 ? -size : size), 0, 127);
  }
  return all;
}

TEST(EnvCapture, OfAnyKnobIsWithinOneStepWhereItWasTold) {
  std::mt19937_64 random(support::test_seed());
  for (int run = 0; run < support::test_count(20); ++run) {
    const ScratchFolder folder;
    const std::vector<Told> all = random_moves(random, 200);
    write_song(folder.file("in.mid"), song_of(all, all.back().tick + 960));
    const ProgramRun done = capture(
        {"cc1", "--from", folder.file("in.mid"), "--whole", "-o", folder.file("knob.toml")});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const curves::NurbsCurve knob = curve_of(folder.file("knob.toml"));
    for (const Told& told : all) {
      const double value = value_at(knob, static_cast<double>(told.tick) / 960) * 127;
      // Half a step of the lines, half a step of tolerance, and the rounding of the numbers.
      EXPECT_LE(std::abs(value - told.value), 1 + 1e-9) << "at tick " << told.tick;
    }
  }
}

TEST(EnvCapture, OfButtonsIsMadeOfStraightLines) {
  const ScratchFolder folder;
  std::vector<Told> all;
  for (int i = 0; i < 40; ++i) all.push_back({static_cast<std::uint64_t>(i) * 480, 1, i % 2 * 127});
  write_song(folder.file("in.mid"), song_of(all, 20000));
  const ProgramRun run =
      capture({"cc1", "--from", folder.file("in.mid"), "-o", folder.file("knob.toml")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const curves::NurbsCurve knob = curve_of(folder.file("knob.toml"));
  EXPECT_EQ(knob.degree(), 1);
  EXPECT_LE(knob.point_count(), 80);
}

TEST(EnvCapture, IsTheSameFileEveryTime) {
  const ScratchFolder folder;
  write_song(folder.file("in.mid"), song_of({{0, 1, 0}, {480, 1, 64}, {960, 1, 65}}, 2000));
  for (const char* name : {"a/knob.toml", "b/knob.toml"}) {
    std::filesystem::create_directories(folder.file(std::string(1, name[0])));
    const ProgramRun run = capture({"cc1", "--from", folder.file("in.mid"), "-o", folder.file(name),
                                    "--plot", folder.file("knob.svg")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_EQ(content(folder.file("a/knob.toml")), content(folder.file("b/knob.toml")));
  EXPECT_THAT(content(folder.file("knob.svg")), HasSubstr("cc1 of channel 1"));
  EXPECT_THAT(content(folder.file("a/knob.toml")), HasSubstr("[curves.knob]"));
}

TEST(EnvCapture, PrintsTheCurveWhereNoFileIsNamed) {
  const ScratchFolder folder;
  write_song(folder.file("in.mid"), song_of({{0, 1, 0}, {480, 1, 64}}, 2000));
  const ProgramRun run = capture({"cc1", "--from", folder.file("in.mid")});
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("[curves.cc1]"));
  EXPECT_TRUE(curves::parse_curves(run.out, "out").has_value());
  EXPECT_THAT(run.err, HasSubstr("cc1 of channel 1, 2 values"));
}

TEST(EnvCapture, CountsInBeatsOfTheSong) {
  const ScratchFolder folder;
  io::Song song = song_of({{0, 1, 0}, {480, 1, 64}, {960, 1, 0}}, 1920);
  song.tempos = {{0, 250000}, {480, 1000000}};  // 480 ticks a beat
  write_song(folder.file("in.mid"), song);
  const ProgramRun run = capture(
      {"cc1", "--from", folder.file("in.mid"), "--beats", "--whole", "-o", folder.file("b.toml")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const curves::NurbsCurve knob = curve_of(folder.file("b.toml"));
  EXPECT_EQ(knob.u_max(), 4);
  EXPECT_NEAR(value_at(knob, 1) * 127, 64, 0.5);
  EXPECT_NEAR(value_at(knob, 2) * 127, 0, 0.5);
  EXPECT_THAT(content(folder.file("b.toml")), HasSubstr("beats = 4\n"));
}

/// A smooth bend from a wheel of 7 bits, told every 5 ms when it moved.
io::Song coarse_bend(int full) {
  io::Song song;
  song.track_count = 1;
  int before = -1;
  for (std::uint64_t tick = 0; tick < 3840; tick += 5) {
    const double t = static_cast<double>(tick) / 960;
    const int high = static_cast<int>(std::floor(64 + 63 * std::sin(2 * t) + 0.5));
    if (high == before) continue;
    before = high;
    const int low = high == 127 ? full : 0;
    song.events.push_back(
        {tick, 0, {0xE0, static_cast<std::uint8_t>(low), static_cast<std::uint8_t>(high)}});
  }
  song.length_ticks = 3840;
  return song;
}

TEST(EnvCapture, ABendWheelOfSevenBitsIsASmoothCurveOfFewPoints) {
  const ScratchFolder folder;
  for (const int full : {0, 127}) {
    SCOPED_TRACE(full);
    write_song(folder.file("in.mid"), coarse_bend(full));
    const ProgramRun run =
        capture({"bend", "--from", folder.file("in.mid"), "-o", folder.file("bend.toml")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::printf("%s", run.out.c_str());
    EXPECT_THAT(run.out, HasSubstr("within 64 steps asked"));
    EXPECT_THAT(content(folder.file("bend.toml")), HasSubstr("told with 7 bits"));
    const curves::NurbsCurve bend = curve_of(folder.file("bend.toml"));
    EXPECT_LE(bend.point_count(), 24);
    // From the first move on: within half a step of the wheel for the reduction, and as much for
    // what the wheel rounded.
    for (const auto& event : coarse_bend(full).events) {
      const double told = event.bytes[2] * 128 + event.bytes[1];
      const double u = std::min(static_cast<double>(event.tick) / 960, bend.u_max());
      if (event.tick < 100 || u == bend.u_max()) continue;
      EXPECT_NEAR(value_at(bend, u) * 16383, told, full == 0 ? 260 : 390) << event.tick;
    }
  }
}

TEST(EnvCapture, PlaysInAnEnvelopePatch) {
  const ScratchFolder folder;
  write_song(folder.file("in.mid"), song_of({{0, 1, 0}, {480, 1, 64}, {960, 1, 127}}, 2000));
  ASSERT_EQ(
      capture({"cc1", "--from", folder.file("in.mid"), "-o", folder.file("knob.toml")}).exit_code,
      0);
  std::string used;  // the lines of the file's own comment
  std::istringstream lines(content(folder.file("knob.toml")));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#   ")) used += line.substr(4) + "\n";
  }
  std::ofstream(folder.file("patch.toml"))
      << "format = 1\nkind = \"envelope\"\n"
      << used << "[[outputs]]\nfrom = \"knob\"\nto = \"cc74\"\n";
  const ProgramRun check = run_program({"knotwave-curve", "check", folder.file("patch.toml")});
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

TEST(EnvCapture, SaysWhatThereIsInsteadOfWhatIsMissing) {
  const ScratchFolder folder;
  write_song(folder.file("in.mid"), song_of({{0, 7, 1}, {9, 7, 2, 3}, {20, 1, 5, 2}}, 2000));
  const ProgramRun none = capture({"cc74", "--from", folder.file("in.mid")});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("there is no cc74; there are: cc1 (ch 2), cc7 (ch 1, 3)"));
  const ProgramRun still = capture({"cc1", "--from", folder.file("in.mid")});
  EXPECT_EQ(still.exit_code, 1);
  EXPECT_THAT(still.err, HasSubstr("never moved: told 1 time, it stayed at 5; --whole"));
  EXPECT_EQ(capture({"cc1", "--from", folder.file("in.mid"), "--whole"}).exit_code, 0);
}

TEST(EnvCapture, RefusesMorePointsThanMayBeAndSaysWhatWouldDo) {
  const ScratchFolder folder;
  std::vector<Told> wave;
  for (int i = 0; i < 400; ++i) {
    wave.push_back({static_cast<std::uint64_t>(i) * 10, 1,
                    64 + static_cast<int>(std::lround(60 * std::sin(i * 0.05)))});
  }
  write_song(folder.file("in.mid"), song_of(wave, 5000));
  const std::string out = folder.file("knob.toml");
  const ProgramRun run =
      capture({"cc1", "--from", folder.file("in.mid"), "--points", "8", "-o", out});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("--points allows 8; --tolerance "));
  EXPECT_FALSE(std::filesystem::exists(out));
  const std::string word = run.err.substr(run.err.find("--tolerance ") + 12);
  const double proposed = std::stod(word);
  const auto with = [&](double tolerance) {
    return capture({"cc1", "--from", folder.file("in.mid"), "--points", "8", "--tolerance",
                    std::to_string(tolerance), "-o", out});
  };
  EXPECT_EQ(with(proposed).exit_code, 0) << with(proposed).err;
  EXPECT_EQ(with(0.98 * proposed).exit_code, 1) << proposed << " is larger than need be";
}

/// A sound of one channel as 32-bit floats.
void write_sound(const std::string& path, const std::vector<float>& samples) {
  auto writer =
      io::SoundWriter::create({.path = path, .channels = 1, .format = io::SampleFormat::float32});
  ASSERT_TRUE(writer.has_value());
  ASSERT_TRUE(writer->write(samples).has_value());
  ASSERT_TRUE(writer->finish().has_value());
}

TEST(EnvCapture, FollowsTheLoudnessOfASound) {
  const ScratchFolder folder;
  std::vector<float> samples;
  const auto level = [](double time) { return std::exp(-2 * time); };
  for (int i = 0; i < 96000; ++i) {
    samples.push_back(static_cast<float>(level(i / 48000.0) * (i % 2 == 0 ? 1 : -1)));
  }
  write_sound(folder.file("in.wav"), samples);
  const ProgramRun run =
      capture({"loudness", "--from", folder.file("in.wav"), "-o", folder.file("level.toml")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::printf("%s", run.out.c_str());
  const curves::NurbsCurve linear = curve_of(folder.file("level.toml"));
  ASSERT_EQ(capture({"loudness", "--from", folder.file("in.wav"), "--floor", "-60", "-o",
                     folder.file("level.toml")})
                .exit_code,
            0);
  const curves::NurbsCurve in_db = curve_of(folder.file("level.toml"));
  EXPECT_EQ(linear.u_max(), 2);
  EXPECT_LE(in_db.point_count(), 8);
  for (double time = 0.025; time < 1.975; time += 1e-3) {
    // A window of 50 ms of this decay is 0.04 % above its middle.
    EXPECT_NEAR(value_at(linear, time), level(time), 0.0105);
    EXPECT_NEAR(value_at(in_db, time), 1 + 20 * std::log10(level(time)) / 60, 0.51 / 60);
  }
}

TEST(EnvCapture, OfSilenceIsNothingAndOfOneFrameALine) {
  const ScratchFolder folder;
  for (const std::size_t frames : {std::size_t{1}, std::size_t{48000}}) {
    write_sound(folder.file("in.wav"), std::vector<float>(frames));
    for (const char* floor : {"0", "-60"}) {
      const ProgramRun run = capture({"peak", "--from", folder.file("in.wav"), "--floor", floor,
                                      "-o", folder.file("level.toml")});
      ASSERT_EQ(run.exit_code, 0) << run.err;
      const curves::NurbsCurve curve = curve_of(folder.file("level.toml"));
      for (const double point : curve.points()) EXPECT_EQ(point, 0);
    }
  }
}

TEST(EnvCapture, OfHostileSoundsEndsWithACurveOrAnError) {
  auto files = support::corpus_files("wav", {".wav"});
  if (files.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS is not set: no sound of the corpus was read";
  const ScratchFolder folder;
  int captured = 0;
  for (const std::string& file : files) {
    const ProgramRun run = capture({"loudness", "--from", file, "-o", folder.file("level.toml")});
    if (run.exit_code == 0) {
      ++captured;
      curve_of(folder.file("level.toml"));
    } else {
      EXPECT_EQ(run.exit_code, 1) << file;
      EXPECT_THAT(run.err, AllOf(StartsWith(file + ": "), HasSubstr("error: "))) << file;
    }
  }
  std::printf("%d of %zu sounds became curves\n", captured, files.size());
  EXPECT_GT(captured, 50);
}

TEST(EnvCapture, OfHostileSongsEndsWithACurveOrAnError) {
  auto files = support::corpus_files("midi_bad", {".mid"});
  if (files.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS is not set: no song of the corpus was read";
  const ScratchFolder folder;
  for (const std::string& file : files) {
    const ProgramRun run = capture({"cc7", "--whole", "--from", file, "-o", folder.file("k.toml")});
    if (run.exit_code == 0) {
      curve_of(folder.file("k.toml"));
    } else {
      EXPECT_EQ(run.exit_code, 1) << file;
      EXPECT_THAT(run.err, AllOf(StartsWith(file + ": "), HasSubstr("error: "))) << file;
    }
  }
  std::printf("%zu songs\n", files.size());
}

TEST(EnvCapture, OfAMillionMessagesSaysThatTheyAreTooMany) {
  const ScratchFolder folder;
  std::vector<Told> all;
  for (int i = 0; i < 1000000; ++i) {
    all.push_back({static_cast<std::uint64_t>(i), 1, i % 2 == 0 ? 0 : 127});
  }
  write_song(folder.file("in.mid"), song_of(all, all.size()));
  const ProgramRun run = capture({"cc1", "--from", folder.file("in.mid")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("1000000 data, a curve is fitted to 262144 at most"));
}

TEST(EnvCapture, OfWhatMakesNoSenseIsUsage) {
  const struct {
    std::vector<std::string> words;
    const char* answer;
  } cases[] = {
      {{"cc200"}, "there are cc0 to cc119"},
      {{"volume"}, "loudness and peak"},
      {{"loudness"}, "name it with --from"},
      {{"loudness", "--from", "a.mid"}, "is named as a MIDI file"},
      {{"cc1", "--from", "a.wav"}, "--from takes a .mid"},
      {{"cc64", "--bits", "14", "--from", "a.mid"}, "cc64 has 7 bits"},
      {{"cc1", "--from", "a.mid", "-o", "b.mid"}, "does not end in .toml"},
      {{"cc1", "--floor", "-60", "--from", "a.mid"}, "--floor is for loudness"},
      {{"peak", "--from", "a.wav", "--hop", "1"}, "longer than --window"},
      {{"cc1", "--window", "0.1", "--from", "a.mid"}, "--window is for loudness"},
      {{"cc1", "--hop", "0.01"}, "--hop is for loudness"},
      {{"peak", "--from", "a.wav", "--bits", "7"}, "--bits is for MIDI"},
      {{"peak", "--from", "a.wav", "--ramp", "0.1"}, "--ramp is for MIDI"},
      {{"peak", "--from", "a.wav", "--whole"}, "--whole is for MIDI"},
      {{"peak", "--from", "a.wav", "--channel", "2"}, "--channel is for"},
      {{"cc1", "--from", "a.mid", "--midi-in", "x"}, "--midi-in is for what is live"},
      {{"cc1", "--from", "a.mid", "--duration", "3"}, "--duration is for what is live"},
      {{"cc1", "--cc", "74"}, "--cc is for playing"},
      {{"cc1", "--thru"}, "--thru is for playing"},
      {{"cc1", "--tail", "2"}, "--tail is for --dry-run"},
      {{"cc1", "--calibration", "x.toml"}, "--calibration is for playing"},
      {{"cc1", "patch.toml"}, "goes behind --from"},
      {{"cc1", "--dry-run", "a.mid"}, "--from names what is captured"},
  };
  for (const auto& one : cases) {
    const ProgramRun run = capture(one.words);
    EXPECT_EQ(run.exit_code, 2) << one.words[0];
    EXPECT_THAT(run.err, HasSubstr(one.answer));
  }
}

}  // namespace
}  // namespace knotwave::env

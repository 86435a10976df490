// SPDX-License-Identifier: MIT
// knotwave-env as a user runs it, without devices: dry runs, and what is refused.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/midi_file.h"
#include "knotwave/io/sound_file.h"

#include "support/program.h"

namespace knotwave::env {
namespace {

using support::ProgramRun;
using support::run_program;
using support::ScratchFolder;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kExamples = std::string(KNOTWAVE_SOURCE_DIR) + "/examples/";

std::string envelope(const std::string& name) { return kExamples + "envelopes/" + name + ".toml"; }
std::string score(const std::string& name) { return kExamples + "scores/" + name + ".mid"; }

ProgramRun env_program(std::vector<std::string> words) {
  words.insert(words.begin(), "knotwave-env");
  return run_program(words);
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string hash_in(const std::string& line) {
  const std::size_t at = line.rfind("sha256 ");
  return at == std::string::npos ? "" : line.substr(at + 7, 64);
}

/// Bytes of every note. A note on of velocity 0 stays one.
std::multiset<std::vector<std::int64_t>> notes_of(const io::Song& song) {
  std::multiset<std::vector<std::int64_t>> notes;
  for (const io::SongEvent& event : song.events) {
    if ((event.bytes[0] & 0xE0) != 0x80) continue;
    notes.insert({event.bytes[0], event.bytes[1], event.bytes[2]});
  }
  return notes;
}

TEST(EnvProgram, ADryRunIsTheSameEveryTime) {
  const ScratchFolder folder;
  std::vector<std::string> hashes, files;
  for (const char* name : {"a.mid", "b.mid"}) {
    const ProgramRun run = env_program(
        {envelope("filter-swell"), "--dry-run", score("pachelbel_canon"), "-o", folder.file(name)});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(" messages in, "));
    EXPECT_THAT(run.out, HasSubstr("synth "));
    hashes.push_back(hash_in(run.out));
    files.push_back(content(folder.file(name)));
  }
  EXPECT_EQ(hashes[0].size(), 64u);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(files[0], files[1]);
}

TEST(EnvProgram, NotesGoThroughUnalteredAndTheLastValueIsTheRest) {
  const ScratchFolder folder;
  const ProgramRun run = env_program(
      {envelope("filter-swell"), "--dry-run", score("first-light"), "-o", folder.file("sent.mid")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto sent = io::read_midi_file(folder.file("sent.mid"));
  const auto played = io::read_midi_file(score("first-light"));
  ASSERT_TRUE(sent.has_value()) << sent.error().to_string();
  ASSERT_TRUE(played.has_value());
  EXPECT_EQ(sent->warnings.size(), 0u);
  EXPECT_EQ(notes_of(*sent), notes_of(*played));
  int last = -1, most = 0;
  for (const io::SongEvent& event : sent->events) {
    if ((event.bytes[0] & 0xF0) != 0xB0 || event.bytes[1] != 74) continue;
    last = event.bytes[2];
    most = std::max(most, last);
  }
  EXPECT_EQ(last, 64);
  EXPECT_GT(most, 64);
}

TEST(EnvProgram, ATableAndAPictureShowTheSame) {
  const ScratchFolder folder;
  const ProgramRun run =
      env_program({envelope("filter-swell"), "--dry-run", score("first-light"), "-o",
                   folder.file("sent.csv"), "--plot", folder.file("sent.svg")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string table = content(folder.file("sent.csv"));
  EXPECT_THAT(table, StartsWith("time_s,port,message,channel,number,value,hex\n"));
  EXPECT_THAT(table, HasSubstr(",synth,control,1,74,"));
  const std::string picture = content(folder.file("sent.svg"));
  EXPECT_THAT(picture, HasSubstr("<svg"));
  EXPECT_THAT(picture, HasSubstr("CC74"));
}

/// How often a text is in another.
int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

const std::string kRise =
    "format = 1\nkind = \"envelope\"\n[curves.c]\ndegree = 1\npoints = [0, 1]\n"
    "[envelopes.e]\ncurve = \"c\"\n";

TEST(EnvProgram, APictureShowsTheMessagesOfEachPortOverItsOwnCurve) {
  const ScratchFolder folder;
  const std::string output = "[[outputs]]\nfrom = \"e\"\nto = ";
  std::ofstream(folder.file("named.toml")) << kRise << "[ports.synth]\n" << output << "\"cc74\"\n";
  std::ofstream(folder.file("bare.toml")) << kRise << output << "\"bend\"\n";
  const ProgramRun run =
      env_program({folder.file("named.toml"), folder.file("bare.toml"), "--dry-run",
                   score("first-light"), "--plot", folder.file("sent.svg")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("out "));
  const std::string picture = content(folder.file("sent.svg"));
  EXPECT_THAT(picture, HasSubstr(">e to CC74 ch1<"));     // as the patch calls it
  EXPECT_EQ(count_of(picture, "fill=\"#0a5cd6\""), 2);    // "curve" in the colour of its line
  EXPECT_EQ(count_of(picture, "fill=\"#ce2160\""), 2);    // and "sent"
  EXPECT_EQ(count_of(picture, "stroke=\"#0a5cd6\""), 2);  // curves
  EXPECT_EQ(count_of(picture, "stroke=\"#ce2160\""), 2);  // what is sent of them
}

/// One key held for 10 s.
void write_long_note(const std::string& path) {
  io::Song song;
  song.track_count = 1;
  song.events.push_back({0, 0, {0x90, 72, 100}});
  song.events.push_back({9600, 0, {0x80, 72, 0}});
  song.length_ticks = 9600;
  const auto bytes = io::write_midi(song);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

TEST(EnvProgram, VoltagesGoIntoASoundFile) {
  const ScratchFolder folder;
  write_long_note(folder.file("long.mid"));
  const ProgramRun run = env_program({envelope("four-voltages"), "--cv", "--dry-run",
                                      folder.file("long.mid"), "-o", folder.file("volts.wav")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("5 channels"));
  const auto sound = io::read_sound(folder.file("volts.wav"));
  ASSERT_TRUE(sound.has_value()) << sound.error().to_string();
  ASSERT_EQ(sound->channels, 5);
  EXPECT_EQ(sound->rate_hz, 48000);
  std::int64_t triggered = 0;
  for (std::size_t c = 0; c < 5; ++c) {
    float most = 0;
    for (std::size_t i = c; i < sound->samples.size(); i += 5) {
      most = std::max(most, std::abs(sound->samples[i]));
      triggered += c == 4 && sound->samples[i] != 0;
    }
    EXPECT_GT(most, 0.01F) << "channel " << c + 1;
    EXPECT_EQ(sound->samples[sound->samples.size() - 5 + c], 0) << "channel " << c + 1;
  }
  EXPECT_EQ(triggered, 5 * 240);  // a loop of 4 beats comes round every 2 s; 5 ms each
  const ProgramRun none = env_program(
      {envelope("filter-swell"), "--dry-run", score("first-light"), "-o", folder.file("none.wav")});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("no patch has an output to = \"cv\""));
  EXPECT_FALSE(std::filesystem::exists(folder.file("none.wav")));
}

TEST(EnvProgram, VoltagesInASoundFileHaveTheirDirectCurrentAndTheScaleOfTheCalibration) {
  const ScratchFolder folder;
  write_long_note(folder.file("long.mid"));
  std::ofstream(folder.file("five.toml"))
      << "format = 1\nkind = \"envelope\"\n[curves.c]\ndegree = 1\npoints = [1, 1]\n"
         "[envelopes.e]\ncurve = \"c\"\nsustain_at = 0.5\n[[outputs]]\nfrom = \"e\"\nto = \"cv\"\n"
         "[[outputs]]\nfrom = \"e\"\nto = \"cv\"\ncv_channel = 2\nrange = [0, 4]\n";
  const auto middle = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {folder.file("five.toml"), "--dry-run",
                                      folder.file("long.mid"), "-o", folder.file("volts.wav")};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun run = env_program(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto sound = io::read_sound(folder.file("volts.wav"));
    if (!sound || sound->samples.size() < 2 * 96002) return std::pair(0.0F, 0.0F);
    return std::pair(sound->samples[2 * 96000], sound->samples[2 * 96000 + 1]);
  };
  EXPECT_EQ(middle({}), std::pair(0.5F, 0.4F));
  EXPECT_EQ(middle({"--cv"}), std::pair(0.5F, 0.4F));
  const auto [one, two] = middle({"--calibration", kExamples + "calibration/two-outputs.toml"});
  EXPECT_NEAR(one, (5 - 0.003) / 10.12, 1e-7);
  EXPECT_NEAR(two, (4 + 0.011) / -5.04, 1e-7);
}

TEST(EnvProgram, TheCalibrationOfTheManualIsTheExample) {
  const std::string example = content(kExamples + "calibration/two-outputs.toml");
  const std::string page = content(std::string(KNOTWAVE_SOURCE_DIR) + "/docs/env.md");
  const std::size_t begin = example.find("format = 1");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_THAT(page, HasSubstr("```toml\n" + example.substr(begin) + "```"));
}

TEST(EnvProgram, EveryShippedPatchPlays) {
  for (const auto& entry : std::filesystem::directory_iterator(kExamples + "envelopes")) {
    if (entry.path().extension() != ".toml") continue;
    const ProgramRun run = env_program({entry.path(), "--dry-run", score("first-light")});
    EXPECT_EQ(run.exit_code, 0) << entry.path() << ": " << run.err;
    EXPECT_EQ(hash_in(run.out).size(), 64u);
    EXPECT_THAT(run.out, Not(HasSubstr("not at rest")));
  }
}

TEST(EnvProgram, OptionsChooseTheControllerAndTheChannel) {
  const ScratchFolder folder;
  const ProgramRun run =
      env_program({envelope("filter-swell"), "--cc", "11", "--channel", "5", "--dry-run",
                   score("first-light"), "-o", folder.file("sent.csv")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(content(folder.file("sent.csv")), HasSubstr(",control,5,11,"));
  EXPECT_THAT(content(folder.file("sent.csv")), Not(HasSubstr(",control,1,74,")));
}

TEST(EnvProgram, WhatMakesNoSenseIsUsage) {
  const std::string patch = envelope("filter-swell"), song = score("first-light");
  const std::string voltages = envelope("four-voltages");
  const std::string calibration = kExamples + "calibration/two-outputs.toml";
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{}, "there is no PATCH to play"},
      {{patch, "-o", "x.mid"}, "--output is for --dry-run"},
      {{patch, "--plot", "x.svg"}, "--plot is for --dry-run"},
      {{patch, "--dry-run", song, "-o", "x.txt"}, "ends neither in .mid nor in .csv nor in .wav"},
      {{patch, "--dry-run", song, "--plot", "x.png"}, "does not end in .svg"},
      {{song}, "is named as a MIDI file"},
      {{patch, "--dry-run", song, "-o", song}, "--output"},
      {{patch, "--cc", "120"}, "--cc: '120' is not a whole number from 0 to 119"},
      {{patch, "--chanel", "3"}, "--channel"},
      {{patch, "--dry-run", song, "--midi-out", "foo=Bar"},
       "no patch has a port 'foo'; there is: synth"},
      {{patch, "--dry-run", song, "--duration", "3"},
       "--duration ends what is played with devices"},
      {{patch, "--dry-run", song, "--cv"}, "--cv is for control voltage, and no patch has"},
      {{patch, "--dry-run", song, "--calibration", "x.toml"},
       "--calibration is for control voltage"},
      {{patch, "--audio-device", "0"}, "--audio-device is for control voltage, and no patch has"},
      {{voltages, "--dry-run", song, "--calibration", calibration},
       "--calibration is for control voltage: a dry run writes that to -o FILE.wav"},
      {{voltages, "--dry-run", song, "--calibration", calibration, "-o", "x.mid"},
       "--calibration is for control voltage"},
      {{patch, "--window", "1"}, "--window is for --capture"},
      {{patch, "--dry-run", song, "--points", "9"}, "--points is for --capture"},
      {{patch, "--whole"}, "--whole is for --capture"},
      {{patch, "--tail", "3"}, "--tail is for --dry-run"},
      {{patch, "--osc", "nowhere"}, "neither a port from 1 to 65535 nor HOST:PORT"},
  };
  for (const auto& [words, message] : cases) {
    const ProgramRun run = env_program(words);
    EXPECT_EQ(run.exit_code, 2) << message;
    EXPECT_THAT(run.err, HasSubstr(message));
  }
}

TEST(EnvProgram, AFreeNumberThatNobodyReadsIsTold) {
  const ScratchFolder folder;
  const std::string head =
      "format = 1\nkind = \"envelope\"\n[curves.c]\ndegree = 1\npoints = [0, 1]\n"
      "[envelopes.e]\ncurve = \"c\"\n[[maps]]\nfrom = \"e\"\nto = \"free.x\"\n[[outputs]]\nto = "
      "\"cc1\"\n";
  std::ofstream(folder.file("idle.toml")) << head + "from = \"e\"\n";
  std::ofstream(folder.file("read.toml")) << head + "from = \"free.x\"\n";
  const std::string warning =
      "idle.toml:10:6: warning: this map moves 'free.x', which no map and no output reads";
  const std::string song = score("first-light");
  EXPECT_THAT(env_program({folder.file("idle.toml"), "--dry-run", song}).err, HasSubstr(warning));
  EXPECT_EQ(env_program({folder.file("read.toml"), "--dry-run", song}).err, "");
  EXPECT_EQ(env_program({folder.file("idle.toml"), "--dry-run", song, "--quiet"}).err, "");
  const ProgramRun check = run_program({"knotwave-curve", "check", folder.file("idle.toml")});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_THAT(check.err, HasSubstr(warning));
  std::ofstream(folder.file("bare.toml")) << "format = 1\n";
  EXPECT_THAT(run_program({"knotwave-curve", "check", folder.file("bare.toml")}).err,
              HasSubstr("or \"envelope\""));
}

TEST(EnvProgram, AnOutputThatCutsItsSourceIsTold) {
  const ScratchFolder folder;
  const std::string head =
      kRise + "[lfos.vib]\ncurve = \"sine\"\n[lfos.walk]\ncurve = \"c\"\nrandom = true\n" +
      "[[outputs]]\nto = \"bend\"\n";
  const std::string song = score("first-light");
  const auto said = [&](const std::string& rest) {
    std::ofstream(folder.file("p.toml")) << head + rest;
    const ProgramRun run = env_program({folder.file("p.toml"), "--dry-run", song});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run_program({"knotwave-curve", "check", folder.file("p.toml")}).err, run.err);
    return run.err;
  };
  EXPECT_THAT(
      said("from = \"vib\"\n"),
      HasSubstr("p.toml:15:8: warning: output 1 clips: 'vib' runs from -1 to 1, of = [0, 1]"));
  EXPECT_THAT(said("from = \"walk\"\n"), HasSubstr("output 1 clips: 'walk' runs from -1 to 1"));
  EXPECT_EQ(said("from = \"e\"\n"), "");
  EXPECT_EQ(said("from = \"vib\"\nof = [-1, 1]\n"), "");
  EXPECT_EQ(said("from = \"vib\"\nof = [0, 1]\n"), "");  // it was asked for
}

TEST(EnvProgram, APatchGivenTwiceIsToldWithItsFile) {
  const std::string patch = envelope("filter-swell");
  const ProgramRun run = env_program({patch, patch, "--dry-run", score("first-light")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr(" (" + patch + ") and output 1 of "));
}

TEST(EnvProgram, FaultsOfFilesAreToldWithTheirPlace) {
  const ScratchFolder folder;
  std::ofstream(folder.file("broken.toml")) << "format = 1\nkind = \"envelope\"\nnane = \"x\"\n";
  const ProgramRun broken =
      env_program({folder.file("broken.toml"), "--dry-run", score("first-light")});
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(broken.err, HasSubstr("broken.toml:"));
  const ProgramRun missing =
      env_program({envelope("filter-swell"), "--dry-run", folder.file("none.mid")});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("none.mid"));
}

}  // namespace
}  // namespace knotwave::env

// SPDX-License-Identifier: MIT
// Command lines of knotwave-synth that are wrong, each with its answer.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/render_scene.h"
#include "device_list.h"
#include "support/program.h"

namespace {

using knotwave::support::run_program;
using testing::HasSubstr;
using testing::Not;

std::string answer(std::vector<std::string> words) {
  words.insert(words.begin(), "knotwave-synth");
  const auto done = run_program(words);
  EXPECT_EQ(done.exit_code, 2) << done.out << done.err;
  return done.err;
}

std::string told(const std::string& fault) {
  return "knotwave-synth: " + fault + "\nTry 'knotwave-synth --help'.\n";
}

TEST(SynthCommandLine, WrongValuesAreToldWithWhatIsRight) {
  EXPECT_EQ(answer({"--channels", "0"}),
            told("--channels: '0' is neither one channel of the device from 1 to 256 nor two "
                 "different ones, as in 1,2"));
  for (const char* wrong : {"", "1,1", "1,2,3", "1,", ",1", "x", "257", "1 2"}) {
    EXPECT_THAT(answer({"--channels", wrong}), HasSubstr("--channels")) << wrong;
  }
  EXPECT_EQ(answer({"--osc", "70000"}),
            told("--osc: '70000' is neither a port from 1 to 65535 nor HOST:PORT"));
  EXPECT_EQ(answer({"--block", "8"}), told("--block: '8' is not a whole number from 16 to 8192"));
  EXPECT_EQ(answer({"--midi-out", "x"}), told("unknown option '--midi-out'; did you mean "
                                              "'--midi-api'?"));
  EXPECT_EQ(answer({"--rate", "1", "--rate", "2"}), told("--rate is given twice"));
}

TEST(SynthCommandLine, WhatDoesNotGoTogetherIsTold) {
  EXPECT_EQ(answer({"a.toml", "--demo", "first-light"}),
            told("--demo plays its own patch; leave out 'a.toml'"));
  EXPECT_EQ(answer({"--plain", "--json-status"}),
            told("--plain and --json-status are two kinds of output; choose"));
  EXPECT_EQ(answer({"song.mid"}),
            told("'song.mid' is named as a MIDI file; play it with a patch or "
                 "a bank: PATCH --song 'song.mid'"));
  EXPECT_EQ(answer({"--demo", "first-light", "--song", "song.mid"}),
            told("--demo plays its own song; leave out --song 'song.mid'"));
  EXPECT_EQ(answer({"--song", "song.mid"}),
            told("--song needs a patch or a bank to play 'song.mid' with: PATCH --song FILE"));
  EXPECT_EQ(answer({"--record", "a.mp3"}),
            told("--record: 'a.mp3' ends neither in .wav nor in .flac"));
  EXPECT_EQ(answer({"--audio-api", "none", "--audio-device", "1"}),
            told("--audio-api none has no devices; leave out --audio-device '1'"));
  EXPECT_THAT(answer({"--demo", "first-lihgt"}), HasSubstr("did you mean 'first-light'?"));
}

TEST(SynthCommandLine, AMissingPatchIsToldWithTheNearestName) {
  const auto done = run_program({"knotwave-synth", "no/such.toml", "--audio-api", "none"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("no/such.toml"));
}

TEST(SynthCommandLine, ATakeThatCannotBeWrittenIsToldOnce) {
  const auto done =
      run_program({"knotwave-synth", "--audio-api", "none", "--record", "/no such/a.wav"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_EQ(done.err,
            "knotwave-synth: error: cannot write into folder '/no such': No such file or "
            "directory\n");
}

class SynthTakes : public knotwave::render::RenderScene {
 protected:
  std::string recorded(std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"knotwave-synth", file("small.toml"), "--audio-api", "none",
                                      "--record",       file("take.wav"),   "--duration",  "0.1"};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = run_program(words);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done.err;
  }
};

TEST_F(SynthTakes, AnOldTakeIsToldWhenItsPlaceIsTaken) {
  EXPECT_THAT(recorded(), Not(HasSubstr("replaced")));
  const std::string again = recorded();
  EXPECT_THAT(again, HasSubstr("recording " + file("take.wav") +
                               "; the take that is there stays until it ends\n"));
  EXPECT_THAT(again,
              HasSubstr(file("take.wav") + ", " + file("take.journal") + ", " + file("take.mid") +
                        ": replaced\n" + file("take.wav") + ": 0:00.1, "));
  std::filesystem::remove(file("take.wav"));
  std::filesystem::remove(file("take.journal"));
  EXPECT_THAT(recorded(), HasSubstr("\n" + file("take.mid") + ": replaced\n"));
}

TEST_F(SynthTakes, ASongIsNotWrittenOverByTheTakeOfItsName) {
  EXPECT_EQ(
      answer({file("small.toml"), "--song", file("small.mid"), "--record", file("small.wav")}),
      told("--record '" + file("small.wav") + "' writes a .mid of its own over the song '" +
           file("small.mid") + "'; give the take another name"));
}

TEST(DeviceTable, SaysWhatItsStarMarksAndWhatTheProgramDoesWithoutADevice) {
  using knotwave::synth::device_table;
  knotwave::io::AudioDeviceList sound;
  EXPECT_THAT(device_table(sound, {}, "it plays on"), HasSubstr("\n  none; it plays on\n"));
  sound.devices = {{.number = 0, .api = "jack", .name = "system", .is_default = true}};
  const std::string table = device_table(sound, {}, "it plays on");
  EXPECT_THAT(table, HasSubstr("* 0  jack"));
  EXPECT_THAT(table, HasSubstr("  * is played to where its API is chosen and no device; "));
  EXPECT_THAT(table, Not(HasSubstr("it plays on")));
}

TEST(SynthCommandLine, AnApiOrAMidiInputThatNobodyHasIsAnError) {
  const auto api = run_program({"knotwave-synth", "--audio-api", "jakc", "--duration", "1"});
  EXPECT_EQ(api.exit_code, 1);
  EXPECT_THAT(api.err, HasSubstr("jakc"));
  const auto port = run_program(
      {"knotwave-synth", "--audio-api", "none", "--midi-in", "no such", "--duration", "1"});
  EXPECT_EQ(port.exit_code, 1);
  EXPECT_THAT(port.err, HasSubstr("no such"));
}

TEST(SynthCommandLine, MidiInputsMayBeNamedAnyNumberOfTimes) {
  const auto done = run_program({"knotwave-synth", "--midi-in", "a", "--midi-in", "b", "--help"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("--midi-in PORT"));
}

}  // namespace

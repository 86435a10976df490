// SPDX-License-Identifier: MIT
// knotwave-synth when its JACK server is killed, stands still or comes back otherwise, and when a
// keyboard is unplugged: what is told and when, what goes on sounding, and that it always ends.
#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/io/audio_device.h"

#include "live/osc_sender.h"

namespace knotwave::synth {
namespace {

using io::seconds_taken;

constexpr double kTellsSeconds = 1.0, kSoundsAgainSeconds = 3.0, kEndsSeconds = 2.0;
/// A server that only stands still is known by 0.8 s without a block, and a line comes with a tick.
constexpr double kTellsOfSilenceSeconds = 1.2;

void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

class SynthLoss : public SynthProgram {
 protected:
  void SetUp() override { ASSERT_TRUE(server_.runs()) << server_.log(); }

  static std::vector<std::string> words(const std::string& api) {
    return {"small.toml", "--json-status", "--audio-api", api, "--osc", osc_port()};
  }
  static bool is_heard(const SynthProcess& synth) {
    if (!synth.says("the sound device is back", 0)) return false;
    JackCapture capture({kOut1}, 2048);
    return capture.is_connected() && capture.wait_for(2048, 1) && onset(capture.channel(0)) < 2048;
  }
  static void expect_end(SynthProcess& synth) {
    int code = -1;
    EXPECT_LT(seconds_taken([&] {
                synth.signal(SIGTERM);
                code = synth.exit_code();
              }),
              kEndsSeconds);
    EXPECT_EQ(code, 0) << synth.err();
  }

  JackServer server_{256};
};

TEST_F(SynthLoss, AKilledServerIsToldAndAfterItsReturnTheHeldNoteSoundsWithinThreeSeconds) {
  SynthProcess synth(words("jack"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  player.hold_note(synth);
  for (int round = 0; round < 2; ++round) {
    server_.kill();
    EXPECT_LT(seconds_until([&] { return synth.says("the sound device is lost", 0); }, 10),
              kTellsSeconds);
    seconds_until([&] { return synth.field("state") == "lost"; }, 10);
    EXPECT_EQ(synth.field("state"), "lost");
    ASSERT_TRUE(server_.restart()) << server_.log();
    EXPECT_LT(seconds_until([&] { return is_heard(synth); }, 20), kSoundsAgainSeconds)
        << synth.err();
  }
  expect_end(synth);
}

TEST_F(SynthLoss, AServerThatStandsStillIsToldAndWhenItGoesOnTheSameProgramSounds) {
  SynthProcess synth(words("jack"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  player.hold_note(synth);
  server_.pause();
  EXPECT_LT(seconds_until([&] { return synth.says("the sound device is lost", 0); }, 10),
            kTellsOfSilenceSeconds);
  wait(3);
  const double seconds = synth.number("seconds");
  server_.resume();
  EXPECT_LT(seconds_until([&] { return is_heard(synth); }, 20), kSoundsAgainSeconds) << synth.err();
  EXPECT_GE(synth.number("seconds"), seconds) << "it was started anew";
  expect_end(synth);
}

TEST_F(SynthLoss, AServerThatStandsStillFromTheStartIsToldWithinASecondAndThenGivenUp) {
  server_.pause();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"small.toml"}, {"small.toml", "--audio-api", "alsa"}}) {
    SynthProcess synth(words, here());
    EXPECT_LT(seconds_until([&] { return synth.says("waiting for the sound server", 0); }, 10),
              kTellsSeconds);
    EXPECT_EQ(synth.exit_code(5), 1) << "in 3 s, and PortAudio is not waited for";
    EXPECT_NE(synth.err().find("the JACK server does not answer: end it or start it anew"),
              std::string::npos)
        << synth.err();
  }
  SynthProcess listed({"--list-devices"}, here());
  EXPECT_LT(seconds_until([&] { return listed.says("waiting for a sound server", 0); }, 10),
            kTellsSeconds);
  EXPECT_EQ(listed.exit_code(6), 0);
  // One that goes on in time is played.
  SynthProcess synth({"small.toml", "--json-status"}, here());
  ASSERT_TRUE(synth.says("waiting for the sound server"));
  server_.resume();
  EXPECT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  expect_end(synth);
}

TEST_F(SynthLoss, AServerThatStoodStillAndIsStartedAnewSounds) {
  SynthProcess synth(words("jack"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  player.hold_note(synth);
  server_.pause();
  ASSERT_TRUE(synth.says("the sound device is lost")) << synth.err();
  ASSERT_TRUE(server_.restart()) << server_.log();
  EXPECT_LT(seconds_until([&] { return is_heard(synth); }, 20), kSoundsAgainSeconds) << synth.err();
  expect_end(synth);
}

TEST_F(SynthLoss, EndsWithinASecondWhereverAServerThatStandsStillLeavesIt) {
  struct Moment {
    const char* api;
    double after_s;
  };
  for (const auto& [api, after_s] :
       {Moment{"jack", 0}, Moment{"jack", 0.7}, Moment{"jack", 1.3}, Moment{"jack", 3},
        Moment{"portaudio-jack", 0.5}, Moment{"portaudio-jack", 2.5}}) {
    SynthProcess synth(words(api), here());
    ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
    server_.pause();
    wait(after_s);
    SCOPED_TRACE(testing::Message() << api << ", " << after_s << " s after");
    expect_end(synth);
    ASSERT_TRUE(server_.restart()) << server_.log();
  }
}

TEST_F(SynthLoss, WherePortAudioHangsTheProgramStartsItselfAnewWithWhatWasHeld) {
  SynthProcess synth(words("portaudio-jack"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  write("other.toml", render::kSmallPatch);
  player.load("other.toml");
  ASSERT_TRUE(synth.says("now playing other.toml"));
  player.hold_note(synth);
  server_.kill();
  EXPECT_LT(seconds_until([&] { return synth.says("the sound device is lost", 0); }, 10),
            kTellsOfSilenceSeconds);
  seconds_until([&] { return synth.number("seconds") < 0.5; }, 10);  // another process by now
  ASSERT_TRUE(server_.restart()) << server_.log();
  EXPECT_LT(seconds_until([&] { return synth.says("the sound device is back", 0); }, 20),
            kSoundsAgainSeconds)
      << synth.err();
  seconds_until([&] { return synth.number("peak_left_dbfs") > -30; }, 5);
  EXPECT_GT(synth.number("peak_left_dbfs"), -30) << "the held note";
  EXPECT_EQ(synth.field("patch"), "other.toml");
  expect_end(synth);
}

TEST_F(SynthProgram, AServerThatComesBackWithAnotherRateIsPlayedAtThatRate) {
  auto server = std::make_unique<JackServer>(256, 48000);
  ASSERT_TRUE(server->runs()) << server->log();
  SynthProcess synth({"small.toml", "--json-status", "--record", "take.wav", "--osc", osc_port()},
                     here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"rate_hz\": 48000")) << synth.err();
  player.hold_note(synth);
  server->kill();
  ASSERT_TRUE(synth.says("the sound device is lost")) << synth.err();
  server.reset();
  server = std::make_unique<JackServer>(256, 44100);
  ASSERT_TRUE(server->runs()) << server->log();
  ASSERT_TRUE(synth.says("the sound device is back: jack: system, 44100 Hz")) << synth.err();
  EXPECT_TRUE(synth.says("take.wav: 0:0")) << "a take ends with its engine";
  seconds_until([&] { return synth.number("rate_hz") == 44100; }, 10);
  seconds_until([&] { return synth.number("peak_left_dbfs") > -30; }, 10);
  EXPECT_GT(synth.number("peak_left_dbfs"), -30) << "the held note";
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
}

/// A keyboard that holds a note, at a port of the synth; then it goes.
void expect_note_ends(const SynthProcess& synth, const std::string& port, const char* told) {
  auto keyboard = std::make_unique<JackMidiSender>(port, held_note());
  ASSERT_TRUE(keyboard->is_connected());
  ASSERT_TRUE(keyboard->wait_until_sent(10));
  seconds_until([&] { return synth.number("voices") == 1; }, 20);
  ASSERT_EQ(synth.number("voices"), 1) << synth.out();
  wait(1);
  EXPECT_EQ(synth.number("voices"), 1) << "it is held";
  keyboard.reset();
  EXPECT_LT(seconds_until([&] { return synth.says(told, 0); }, 20), kTellsSeconds) << synth.err();
  seconds_until([&] { return synth.number("voices") == 0; }, 5);
  EXPECT_EQ(synth.number("voices"), 0) << synth.err();
}

TEST_F(SynthLoss, TheNotesOfAnUnpluggedKeyboardEnd) {
  SynthProcess synth({"small.toml", "--json-status"}, here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  expect_note_ends(synth, kMidiIn, "was unplugged; the notes of its port ended");
  EXPECT_EQ(synth.err().find("has gone"), std::string::npos) << "it is told once";
  wait(1);
  expect_note_ends(synth, "Knotwave-midi:in", "was unplugged; the notes of its port ended");
  expect_end(synth);
}

TEST_F(SynthLoss, ADemoStartedAnewPlaysThePatchThatTabChoseAndItsSongGoesOn) {
  SynthProcess synth({"--demo", "bwv846_prelude", "--audio-api", "portaudio-jack"}, at_terminal());
  ASSERT_TRUE(synth.says("octave 4")) << synth.out();
  ASSERT_TRUE(synth.says("0:01.")) << "of the song";
  for (int i = 0; i < 2; ++i) synth.type("\t");
  ASSERT_TRUE(synth.says("channel 1 plays program 6: ")) << synth.out();
  server_.kill();
  ASSERT_TRUE(synth.says("the sound device is lost")) << synth.err();
  ASSERT_TRUE(server_.restart()) << server_.log();
  std::string anew;  // what the second process says
  const auto plays = [&] {
    const std::string out = synth.out();
    const std::size_t ended = out.find("\x1b[?1049l");
    if (ended != std::string::npos) anew = out.substr(ended);
    return anew.find("sound   portaudio-jack: system") != std::string::npos;
  };
  EXPECT_LT(seconds_until(plays, 20), 5.0) << synth.out();
  EXPECT_NE(anew.find("song    0:0"), std::string::npos) << anew;
  EXPECT_EQ(anew.find("song    0:00."), std::string::npos) << "it began again";
  synth.type("\t");
  EXPECT_TRUE(synth.says("channel 1 plays program 8: ")) << "tab goes on where it was";
  synth.type("q");
  EXPECT_EQ(synth.exit_code(), 0);
}

}  // namespace
}  // namespace knotwave::synth

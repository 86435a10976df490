// SPDX-License-Identifier: MIT
// knotwave-synth under PulseAudio, PipeWire and ALSA without a sound card: servers that are killed,
// started anew and change their rate while a note is held. Label hosts.
#include <algorithm>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"

#include "live/host_servers.h"
#include "live/osc_sender.h"

namespace knotwave::synth {
namespace {

using support::BackgroundProgram;
using support::expect_program;
using support::SetVariable;

constexpr double kTellsSeconds = 1.2, kSoundsAgainSeconds = 3.0, kEndsSeconds = 2.0;

class SynthHosts : public SynthProgram {
 protected:
  static std::vector<std::string> words(const std::string& api) {
    return {"small.toml", "--json-status", "--audio-api", api, "--osc", osc_port()};
  }
  static void expect_end(SynthProcess& synth) {
    int code = -1;
    EXPECT_LT(io::seconds_taken([&] {
                synth.signal(SIGTERM);
                code = synth.exit_code();
              }),
              kEndsSeconds);
    EXPECT_EQ(code, 0) << synth.err();
  }
  /// The held note is rendered for a device that runs.
  static bool sounds(const SynthProcess& synth) {
    return synth.field("state") == "running" && synth.number("peak_left_dbfs") > -30;
  }
  /// Kills the server under a held note, starts it anew, and ends the program.
  void expect_back(support::HostServer& server, const std::string& api) {
    SynthProcess synth(words(api), here());
    OscSender player;
    ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
    player.hold_note(synth);
    server.kill();
    EXPECT_LT(seconds_until([&] { return synth.says("the sound device is lost", 0); }, 10),
              kTellsSeconds)
        << synth.err();
    seconds_until([&] { return synth.field("state") == "lost"; }, 10);
    EXPECT_EQ(synth.field("state"), "lost");
    ASSERT_TRUE(server.start());
    EXPECT_LT(seconds_until([&] { return synth.says("the sound device is back", 0); }, 20),
              kSoundsAgainSeconds)
        << synth.err();
    seconds_until([&] { return sounds(synth); }, 5);
    EXPECT_TRUE(sounds(synth)) << synth.out();
    expect_heard(server);
    expect_end(synth);
  }
  virtual void expect_heard(support::HostServer&) {}
};

class SynthUnderPulse : public SynthHosts {
 protected:
  void SetUp() override {
    expect_program("pulseaudio", "pulseaudio");
    expect_program("pactl", "pulseaudio-utils");
    ASSERT_TRUE(server_.start());
  }
  void expect_heard(support::HostServer& server) override {
    const BackgroundProgram capture(
        {"parec", "-d", "nul.monitor", "--raw", server.folder().file("heard.raw")},
        server.folder().file("parec.log"));
    const auto is_heard = [&] {
      const auto heard = base::read_file(server.folder().file("heard.raw"), 1u << 30);
      return heard && std::any_of(heard->begin(), heard->end(), [](char c) { return c != 0; });
    };
    EXPECT_LT(seconds_until(is_heard, 10), 10);
  }
  support::NoJackServer no_jack_;
  support::PulseServer server_;
};

TEST_F(SynthUnderPulse, AKilledServerIsToldAndAfterItsReturnTheHeldNoteSounds) {
  expect_back(server_, "alsa");
}

TEST_F(SynthUnderPulse, EndsWhileTheServerIsGone) {
  SynthProcess synth(words("alsa"), here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  server_.kill();
  expect_end(synth);
}

class SynthUnderPipeWire : public SynthHosts {
 protected:
  void SetUp() override {
    expect_program("pipewire", "pipewire");
    expect_program("pw-metadata", "pipewire-bin");
    expect_program("pw-jack", "pipewire-jack");
    ASSERT_TRUE(server_.start());
  }
  static void force_rate(const std::string& rate_hz) {
    const auto done = support::run_program(
        {"/bin/sh", "-c", "exec pw-metadata -n settings 0 clock.force-rate " + rate_hz});
    EXPECT_EQ(done.exit_code, 0) << done.err;
  }
  support::PipeWireServer server_;
  /// What pw-jack sets.
  SetVariable library_{"LD_LIBRARY_PATH", "/usr/${LIB}/pipewire-0.3/jack"};
};

TEST_F(SynthUnderPipeWire, AKilledServerIsToldAndAfterItsReturnTheHeldNoteSounds) {
  expect_back(server_, "jack");
}

TEST_F(SynthUnderPipeWire, ASwitchOfTheRateIsFollowedAndTheHeldNoteSoundsOn) {
  SynthProcess synth(words("jack"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"rate_hz\": 48000")) << synth.err();
  player.hold_note(synth);
  force_rate("44100");
  EXPECT_LT(
      seconds_until([&] { return synth.says("the sound device is back: jack: Null, 44100 Hz", 0); },
                    20),
      kTellsSeconds + kSoundsAgainSeconds)
      << synth.err();
  seconds_until([&] { return synth.number("rate_hz") == 44100 && sounds(synth); }, 5);
  EXPECT_EQ(synth.number("rate_hz"), 44100);
  EXPECT_TRUE(sounds(synth)) << synth.out();
  EXPECT_EQ(synth.number("voices"), 1);
  expect_end(synth);
}

/// ALSA's own devices without hardware take samples as fast as they come.
class SynthOnAlsa : public SynthHosts {
 protected:
  SynthOnAlsa() : home_("HOME", folder_.path()) {}
  support::NoJackServer no_jack_;
  SetVariable home_;
};

TEST_F(SynthOnAlsa, PlaysToNothing) {
  write(".asoundrc", "pcm.!default { type null }\n");
  SynthProcess synth(words("alsa"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  player.hold_note(synth);
  player.note_off(69);
  seconds_until([&] { return synth.number("voices") == 0; }, 10);
  EXPECT_EQ(synth.number("voices"), 0);
  expect_end(synth);
}

TEST_F(SynthOnAlsa, PlaysIntoAFile) {
  write(".asoundrc", "pcm.!default { type plug slave.pcm { type file slave.pcm null file \"" +
                         file("heard.raw") + "\" format raw } }\n");
  SynthProcess synth(words("alsa"), here());
  OscSender player;
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  player.hold_note(synth);
  expect_end(synth);
  std::ifstream heard(file("heard.raw"), std::ios::binary);
  std::vector<char> bytes(1 << 20);
  bool is_heard = false;
  while (!is_heard && heard.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    is_heard = std::any_of(bytes.begin(), bytes.end(), [](char c) { return c != 0; });
  }
  EXPECT_TRUE(is_heard);
}

}  // namespace
}  // namespace knotwave::synth

// SPDX-License-Identifier: MIT
// knotwave-synth where the system gives it less than it hopes for: no configuration of ALSA, a full
// disk, a pipe in the place of a patch.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "knotwave/io/sound_file.h"

#include "live/synth_scene.h"

namespace knotwave::synth {
namespace {

using testing::HasSubstr;

TEST_F(SynthProgram, WhereAlsaHasNoConfigurationSaysSoAndRecordsAllTheSame) {
  const support::NoJackServer none;
  for (const char* path : {"/dev/null", "/no/such", "broken.conf"}) {
    write("broken.conf", "pcm.default {");
    const support::SetVariable read_by_alsa("ALSA_CONFIG_PATH", path);
    for (const std::vector<std::string>& api :
         {std::vector<std::string>{}, {"--audio-api", "alsa"}}) {
      std::vector<std::string> words = {"small.toml"};
      words.insert(words.end(), api.begin(), api.end());
      SynthProcess refused(words, here());
      EXPECT_EQ(refused.exit_code(), 1) << path;
      EXPECT_THAT(refused.err(), HasSubstr("no sound device"));
      EXPECT_THAT(refused.err(), HasSubstr("alsa: its configuration "));
      EXPECT_THAT(refused.err(), HasSubstr("install libasound2-data"));
      EXPECT_THAT(refused.err(), HasSubstr("--record FILE"));
    }
    SynthProcess listed({"--list-devices"}, here());
    EXPECT_EQ(listed.exit_code(), 0);
    EXPECT_THAT(listed.out(), HasSubstr("alsa: its configuration "));
  }
  const support::SetVariable read_by_alsa("ALSA_CONFIG_PATH", "/dev/null");
  SynthProcess synth({"small.toml", "--record", "a.wav", "--duration", "0.3"}, here());
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
}

TEST_F(SynthProgram, WhereNoThreadIsLeftSaysSoAndEnds) {
  if (::geteuid() != 0) GTEST_SKIP() << "a user of its own, whose threads are counted, needs root";
  using Words = std::vector<std::string>;
  for (const Words& more : {Words{}, Words{"--osc", osc_port()}, Words{"--threads", "3"}}) {
    for (int most = 1; most <= 6; ++most) {
      Words words = {"/usr/bin/env",
                     "setpriv",
                     "--reuid=54321",
                     "--clear-groups",
                     "prlimit",
                     "--nproc=" + std::to_string(most),
                     KNOTWAVE_BIN_DIR "/knotwave-synth",
                     "--audio-api",
                     "none",
                     "--duration",
                     "0.2"};
      words.insert(words.end(), more.begin(), more.end());
      const auto done = support::run_program(words);
      EXPECT_THAT(done.exit_code, testing::AnyOf(0, 1, 75)) << most << ": " << done.err;
      if (most == 1) {
        EXPECT_THAT(done.err, HasSubstr("thread"));
      }
    }
  }
}

/// A disk of 1 MiB: two seconds of sound.
class SmallDisk {
 public:
  explicit SmallDisk(const std::string& folder) : folder_(folder) {
    std::filesystem::create_directory(folder);
    is_mounted_ = ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=1m") == 0;
  }
  ~SmallDisk() {
    if (is_mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool is_mounted() const { return is_mounted_; }

 private:
  std::string folder_;
  bool is_mounted_;
};

TEST_F(SynthProgram, WhatWasRecordedUntilTheDiskIsFullIsKeptAndRendersAgain) {
  const SmallDisk disk(file("small"));
  if (!disk.is_mounted()) GTEST_SKIP() << "no right to mount a small disk here";
  SynthProcess synth({"small.toml", "--song", "small.mid", "--audio-api", "none", "--record",
                      "small/a.wav", "--duration", "4", "--json-status"},
                     here());
  EXPECT_EQ(synth.exit_code(), 1);
  EXPECT_THAT(synth.err(), HasSubstr("the take ends here: cannot write 'small/a.wav': No space"));
  EXPECT_GT(synth.number("seconds"), 2.9) << "it played on";
  const auto take = io::read_sound(file("small/a.wav"));
  ASSERT_TRUE(take.has_value()) << take.error().to_string();
  EXPECT_GT(take->frames, 48000);
  support::ProgramOptions options;
  options.folder = folder_.path();
  const auto again = support::run_program(
      {"knotwave-render", "--journal", "small/a.journal", "-o", "again.wav"}, options);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(render::hash_in(again.out), render::hash_in(synth.err()));
}

TEST_F(SynthProgram, AFullDiskEndsTheTakeAndNotTheSound) {
  support::ProgramOptions options;
  options.folder = folder_.path();
  options.max_file_bytes = 100'000;
  const auto done = support::run_program({"knotwave-synth", "small.toml", "--audio-api", "none",
                                          "--record", "a.wav", "--duration", "2"},
                                         options);
  EXPECT_THAT(done.err, HasSubstr("the take is lost: "));
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_GT(done.wall_s, 1.9);
  EXPECT_FALSE(std::filesystem::exists(file("a.wav")));
}

TEST_F(SynthProgram, APatchThatBecomesAPipeKeepsNeitherTheSoundNorTheEndWaiting) {
  SynthProcess synth({"small.toml", "--audio-api", "none", "--json-status"}, here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  std::filesystem::remove(file("small.toml"));
  ASSERT_EQ(::mkfifo(file("small.toml").c_str(), 0600), 0);
  EXPECT_TRUE(synth.says("small.toml: error: nobody has written into this pipe")) << synth.err();
  EXPECT_TRUE(synth.says("the old sound plays on"));
  std::filesystem::remove(file("small.toml"));
  write("small.toml", render::kSmallPatch);
  EXPECT_TRUE(synth.says("now playing small.toml")) << synth.err();
  std::filesystem::remove(file("small.toml"));
  ASSERT_EQ(::mkfifo(file("small.toml").c_str(), 0600), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // it is being read by then
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(2), 0) << synth.err();
}

}  // namespace
}  // namespace knotwave::synth

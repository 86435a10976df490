// SPDX-License-Identifier: MIT
// A patch and its curve file that are saved again and again under a sounding knotwave-synth, now
// and then broken: the sound goes on, the last save wins, and nothing is left behind.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "live/osc_sender.h"

namespace knotwave::synth {
namespace {

namespace fs = std::filesystem;

constexpr int kVariants = 64;  ///< saves repeat, as a journal keeps each text once
/// Of four saves three come too soon after each other to be told apart.
std::chrono::milliseconds pause_after(int save) {
  return std::chrono::milliseconds(save % 4 == 3 ? 120 : 20);
}

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

/// What a process has open and in memory.
struct Belongings {
  std::int64_t resident_bytes = 0;
  long files = 0, threads = 0;
};
Belongings belongings_of(pid_t process) {
  const fs::path folder = fs::path("/proc") / std::to_string(process);
  const auto entries = [&](const char* name) {
    return std::distance(fs::directory_iterator(folder / name), fs::directory_iterator());
  };
  std::ifstream file(folder / "statm");
  std::int64_t whole = 0, resident = 0;
  file >> whole >> resident;
  return {resident * sysconf(_SC_PAGESIZE), entries("fd"), entries("task")};
}

class PatchSaves : public SynthProgram {
 protected:
  /// Half of the time as editors do that write a new file and rename it.
  void save(const std::string& name, const std::string& text) {
    const bool is_renamed = ++saves_ % 2 == 0;
    std::ofstream(file(is_renamed ? name + ".new" : name)) << text;
    if (is_renamed) fs::rename(file(name + ".new"), file(name));
  }
  static std::string patch_named(const std::string& name, int variant) {
    return "format = 1\nkind = \"patch\"\nname = \"" + name + "\"\ngain_db = -" +
           std::to_string(variant % 7) +
           "\n[curves.gate]\ncurve_file = \"curves.toml\"\n[oscillators.a]\nwave = \"sine\"\n"
           "detune_cents = " +
           std::to_string(variant) +
           "\n[envelopes.amp]\ncurve = \"gate\"\nseconds = 0.05\nsustain_at = 0.02\n"
           "release_at = 0.02\n";
  }
  static std::string curve(int variant) {
    return "format = 1\nkind = \"curve\"\n[curves.gate]\ndegree = 1\npoints = [0, 1, 1, 0." +
           std::to_string(variant) + ", 0]\nknots = [0,0, 0.01, 0.02, 0.04, 0.05,0.05]\n";
  }
  /// Of ten saves six are patches, two curve files, and one of each is broken.
  void save_one(int i) {
    const int variant = i % kVariants;
    const std::string name = "v" + std::to_string(variant);
    switch (i % 10) {
      case 3:
        return save("small.toml", patch_named(name, variant) + "no_such_key = 1\n");
      case 5:
        return save("curves.toml", "[curves.gate]\npoints = [");
      case 6:
      case 8:
        return save("curves.toml", curve(variant));
      default:
        return save("small.toml", patch_named(name, variant));
    }
  }
  /// Saves patch and curve once more: both are whole, so this is what plays in the end.
  void expect_taken_up(const SynthProcess& synth, int round) {
    const std::string name = "round " + std::to_string(round % kVariants);
    save("curves.toml", curve(1));
    save("small.toml", patch_named(name, 0));
    seconds_until([&] { return synth.field("patch_name") == name; }, 20);
    ASSERT_EQ(synth.field("patch_name"), name) << synth.err();
    EXPECT_GT(synth.number("peak_left_dbfs"), -40) << "the held note";
    EXPECT_EQ(synth.number("voices"), 1);
  }
  void expect_saves_taken(int saves);

  int saves_ = 0;
};

void PatchSaves::expect_saves_taken(int saves) {
  save("curves.toml", curve(1));
  save("small.toml", patch_named("first", 0));
  SynthProcess synth({"small.toml", "--audio-api", "none", "--json-status", "--osc", osc_port()},
                     here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  OscSender player;
  player.hold_note(synth);
  Belongings before;
  int round = 0;
  for (int i = 0; i < saves && !HasFatalFailure(); ++i) {
    save_one(i);
    std::this_thread::sleep_for(pause_after(i));
    if (i % 100 == 99) expect_taken_up(synth, round++);
    if (i == 199) before = belongings_of(synth.id());
  }
  const Belongings after = belongings_of(synth.id());
  EXPECT_LE(after.resident_bytes - before.resident_bytes, std::int64_t{2} << 20);
  EXPECT_EQ(after.files, before.files);
  EXPECT_EQ(after.threads, before.threads);
  player.note_off(69);
  seconds_until([&] { return synth.number("voices") == 0; }, 20);
  EXPECT_EQ(synth.number("voices"), 0);
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
  const std::size_t installed = count_of(synth.err(), "now playing");
  const std::size_t refused = count_of(synth.err(), "plays on");
  EXPECT_GT(installed, static_cast<std::size_t>(saves) / 10);
  EXPECT_GT(refused, 0u);
  std::cout << saves_ << " saves: " << installed << " installed, " << refused
            << " broken ones told, the others overtaken by the next; resident memory "
            << before.resident_bytes << " and " << after.resident_bytes << " bytes, " << after.files
            << " files, " << after.threads << " threads\n";
}

TEST_F(PatchSaves, ThreeHundredWhileANoteSounds) { expect_saves_taken(300); }

using PatchSavesStress = PatchSaves;
TEST_F(PatchSavesStress, TenThousandWhileANoteSounds) { expect_saves_taken(10'000); }

}  // namespace
}  // namespace knotwave::synth

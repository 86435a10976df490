// SPDX-License-Identifier: MIT
// Full disks, forbidden folders, signals: under the final name there is the old file or a whole new
// one, never half of one.
#include <cstring>
#include <filesystem>

#include <gmock/gmock.h>
#include <sys/mount.h>
#include <unistd.h>

#include "knotwave/base/random.h"
#include "knotwave/io/sound_file.h"

#include "apps/render_scene.h"
#include "support/seed.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KNOTWAVE_SANITIZED 1
#endif

namespace knotwave::render {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

class RenderFaults : public RenderScene {
 protected:
  std::vector<std::string> files_with(const std::string& text) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename();
      if (name.find(text) != std::string::npos) names.push_back(name);
    }
    return names;
  }
  /// Many seconds of work on any machine: sixteen notes held for 3500 s.
  std::vector<std::string> long_render() {
    io::Song song;
    song.track_count = 1;
    song.time_base.ticks_per_quarter = 1;
    for (std::uint8_t i = 0; i < 16; ++i) {
      song.events.push_back({0, 0, {0x90, static_cast<std::uint8_t>(48 + i), 40}, 0, 0});
    }
    song.length_ticks = 7000;
    write_song("long.mid", song);
    return {"small.toml", "long.mid", "-o", "out.wav", "--bits", "32f"};
  }
};

/// A small tmpfs, or a read-only one, where the user may mount.
class Mount {
 public:
  Mount(const std::string& folder, unsigned long flags, const char* data) : folder_(folder) {
    fs::create_directory(folder);
    is_there_ = ::mount("tmpfs", folder.c_str(), "tmpfs", flags, data) == 0;
  }
  ~Mount() {
    if (is_there_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  Mount(const Mount&) = delete;
  Mount& operator=(const Mount&) = delete;
  bool is_there() const { return is_there_; }

 private:
  std::string folder_;
  bool is_there_ = false;
};

TEST_F(RenderFaults, AFullDiskIsCode75AndTheOldFileIsKept) {
  const Mount disk(file("disk"), 0, "size=256k");
  if (!disk.is_there())
    GTEST_SKIP() << "mounting a small disk needs root: " << std::strerror(errno);
  for (const char* name : {"disk/out.wav", "disk/out.flac"}) {
    write(name, "old");
    const auto done = run({"small.toml", "small.mid", "-o", name, "--tail", "20"});
    // twenty seconds of silence is little FLAC, so that one may fit
    if (done.exit_code == 0) continue;
    EXPECT_EQ(done.exit_code, 75);
    EXPECT_THAT(done.err, HasSubstr("No space left on device"));
    EXPECT_EQ(read(name), "old");
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(file("disk")), {}), 2);
  EXPECT_EQ(read("disk/out.wav"), "old");
}

TEST_F(RenderFaults, AFullPipeIsCode75) {
  const std::string command = KNOTWAVE_BIN_DIR "/knotwave-render small.toml small.mid -o -";
  support::ProgramOptions options;
  options.folder = folder_.path();
  const auto full = support::run_program({"/bin/sh", "-c", command + " > /dev/full"}, options);
  EXPECT_EQ(full.exit_code, 75);
  EXPECT_THAT(full.err, HasSubstr("cannot write to standard output: No space left on device"));
  const auto closed =
      support::run_program({"/bin/sh", "-c", command + " | head -c 100 >/dev/null"}, options);
  EXPECT_THAT(closed.err, HasSubstr("its reader has gone"));
}

TEST_F(RenderFaults, WhatCannotBePrintedIsToldByEveryProgram) {
  write("curve.toml", "format = 1\nkind = \"curve\"\n[curves.a]\ndegree = 1\npoints = [1, 0]\n");
  support::ProgramOptions options;
  options.folder = folder_.path();
  const std::string render = "knotwave-render small.toml small.mid ";
  for (const std::string& command :
       {render + "-o a.wav", render + "-o b.wav --json -", render + "-o c.wav --json c.json",
        render + "--check", std::string("knotwave-render --help"),
        std::string("knotwave-render --version"), std::string("knotwave-curve --help"),
        std::string("knotwave-curve eval --help"), std::string("knotwave-curve check curve.toml"),
        std::string("knotwave-curve info curve.toml"),
        std::string("knotwave-curve eval curve.toml --grid 4"),
        std::string("knotwave-curve plot curve.toml"),
        std::string("knotwave-curve plot curve.toml -o a.svg")}) {
    const auto done = support::run_program(
        {"/bin/sh", "-c", KNOTWAVE_BIN_DIR "/" + command + " > /dev/full"}, options);
    const std::string program = command.substr(0, command.find(' '));
    EXPECT_EQ(done.exit_code, 75) << command;
    EXPECT_THAT(done.err, testing::EndsWith(program + ": error: cannot write to standard output: " +
                                            std::strerror(ENOSPC) + "\n"))
        << command;
  }
  EXPECT_THAT(read("c.json"), HasSubstr("\"path\": \"c.wav\"")) << "the file has its place";
}

TEST_F(RenderFaults, NothingIsPrintedIntoTheFilesOfClosedStreams) {
  const std::string program = KNOTWAVE_BIN_DIR "/knotwave-render small.toml small.mid ";
  support::ProgramOptions options;
  options.folder = folder_.path();
  const auto shell = [&](const std::string& words) {
    return support::run_program({"/bin/sh", "-c", program + words}, options);
  };
  ASSERT_EQ(shell("-o good.wav --json good.json --quiet").exit_code, 0);
  for (const char* closed : {">&-", "2>&-", "<&-", "<&- >&- 2>&-"}) {
    const bool prints =
        std::string(closed).find(">&-") == std::string::npos || std::string(closed) == "2>&-";
    const auto done = shell("-o out.wav --json out.json " + std::string(closed));
    EXPECT_EQ(done.exit_code, prints ? 0 : 1) << closed;
    EXPECT_EQ(read("out.wav"), read("good.wav")) << closed;
    EXPECT_THAT(read("out.json"), testing::StartsWith("{")) << closed;
  }
  const auto nothing = support::run_program(
      {"/bin/sh", "-c", KNOTWAVE_BIN_DIR "/knotwave-render small.toml - -o out.wav <&-"}, options);
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_EQ(
      nothing.err,
      "knotwave-render: error: the score is -, standard input, but that is closed: name a MIDI "
      "file, or put one in (knotwave-render PATCH - <SCORE.mid)\n");
  EXPECT_EQ(shell("-o - --json samples.json >&-").exit_code, 1);
  EXPECT_FALSE(fs::exists(file("samples.json")) && read("samples.json").substr(0, 1) != "{");
}

#ifndef KNOTWAVE_SANITIZED  // a sanitizer needs terabytes of addresses
TEST_F(RenderFaults, ThreadsThatCannotBeStartedAreToldAndNothingIsLeft) {
  support::ProgramOptions options;
  options.max_address_bytes = 100 << 20;  // 63 stacks of 2 MiB or more do not fit
  const auto done =
      run({"small.toml", "small.mid", "-o", "out.wav", "--json", "out.json", "--threads", "64"},
          options);
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err,
              testing::MatchesRegex("knotwave-render: error: the number of threads is 64; "
                                    "this system starts [0-9]+ and no more: .*\n"));
  EXPECT_THAT(files_with("out"), IsEmpty());
  EXPECT_EQ(run({"small.toml", "small.mid", "-o", "out.wav"}, options).exit_code, 0);
}
#endif

TEST_F(RenderFaults, AnInterruptIsOneLineWhereThereIsNoBar) {
  support::ProgramRun done;
  support::ProgramOptions options;
  for (double after_s = 0.5; after_s < 20 && done.err.empty(); after_s *= 2) {
    options.interrupt_after_s = after_s;
    done = run(long_render(), options);
  }
  EXPECT_EQ(done.err, "knotwave-render: interrupted; no unfinished file is left\n");
}

TEST_F(RenderFaults, AReadOnlyFolderIsNamed) {
  std::string name = "locked/out.wav";
  const Mount disk(file("locked"), MS_RDONLY, "size=256k");
  if (!disk.is_there()) {
    fs::permissions(file("locked"), fs::perms::owner_read | fs::perms::owner_exec);
  }
  const auto done = run({"small.toml", "small.mid", "-o", name});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("locked"));
  if (!disk.is_there()) fs::permissions(file("locked"), fs::perms::owner_all);
}

TEST_F(RenderFaults, AFileSizeLimitIsToldAndNothingIsLeft) {
  support::ProgramOptions options;
  options.max_file_bytes = 50'000;
  const auto done = run({"small.toml", "small.mid", "-o", "out.wav"}, options);
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("File too large"));
  EXPECT_THAT(files_with("out"), IsEmpty());
}

TEST_F(RenderFaults, AnOldFileIsReplacedOnlyByAWholeOne) {
  write("out.wav", "old");
  EXPECT_EQ(run({"none.toml", "small.mid", "-o", "out.wav"}).exit_code, 1);
  EXPECT_EQ(read("out.wav"), "old");
  render({"-o", "out.wav"});
  EXPECT_TRUE(io::read_sound(file("out.wav")).has_value());
}

TEST_F(RenderFaults, DevicesAreNotReplaced) {
  fs::create_symlink("/dev/null", file("null.wav"));
  const auto done = run({"small.toml", "small.mid", "-o", "null.wav"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("it is a device or pipe, not a file"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(RenderFaults, AnInterruptAtAnyTimeLeavesTheOldFileAlone) {
  write("out.wav", "old");
  const base::RandomStream random{.seed = support::test_seed(), .voice = 0, .purpose = 0};
  for (int i = 0; i < support::test_count(8); ++i) {
    support::ProgramOptions options;
    options.interrupt_after_s = 0.02 + 0.3 * random.unit(static_cast<std::uint64_t>(i));
    const auto done = run(long_render(), options);
    // 130 by our handler or, before it is set, by the signal itself.
    EXPECT_EQ(done.exit_code, 130) << "after " << options.interrupt_after_s << " s";
    EXPECT_EQ(read("out.wav"), "old");
    EXPECT_THAT(files_with(".part-"), IsEmpty());
  }
}

TEST_F(RenderFaults, AnInterruptIsTold) {
  // On a busy machine the signal may come before the program has begun: then later.
  support::ProgramRun done;
  support::ProgramOptions options;
  for (double after_s = 0.5; after_s < 20 && done.err.empty(); after_s *= 2) {
    options.interrupt_after_s = after_s;
    done = run(long_render(), options);
    EXPECT_EQ(done.exit_code, 130);
  }
  EXPECT_THAT(done.err, HasSubstr("interrupted; no unfinished file is left"));
}

TEST_F(RenderFaults, ASignalThatIsIgnoredFromTheStartStaysIgnored) {
  support::ProgramOptions options;
  options.is_in_background = true;
  options.interrupt_after_s = 0.5;
  options.kill_after_s = 1.5;
  // It went on until it was killed.
  EXPECT_EQ(run(long_render(), options).exit_code, 137);
}

TEST_F(RenderFaults, AKillLeavesAPartThatTheNextRunSweeps) {
  write("out.wav", "old");
  const base::RandomStream random{.seed = support::test_seed(), .voice = 1, .purpose = 0};
  for (int i = 0; i < support::test_count(4); ++i) {
    support::ProgramOptions options;
    options.kill_after_s = 0.02 + 0.3 * random.unit(static_cast<std::uint64_t>(i));
    EXPECT_EQ(run(long_render(), options).exit_code, 137);
    EXPECT_EQ(read("out.wav"), "old");
  }
  support::ProgramOptions last;  // late enough to have begun writing
  last.kill_after_s = 2;
  EXPECT_EQ(run(long_render(), last).exit_code, 137);
  EXPECT_FALSE(files_with(".part-").empty());
  render({"-o", "out.wav"});
  EXPECT_THAT(files_with(".part-"), IsEmpty());
  EXPECT_TRUE(io::read_sound(file("out.wav")).has_value());
}

}  // namespace
}  // namespace knotwave::render

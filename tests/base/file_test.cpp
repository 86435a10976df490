// SPDX-License-Identifier: MIT
// Written files are complete or absent, the old one is kept, and nothing is left over.
#include "knotwave/base/file.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/program.h"

namespace knotwave::base {
namespace {
namespace fs = std::filesystem;
using support::ScratchFolder;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}
using Names = std::vector<std::string>;

std::string text_of(const std::string& path) {
  const Result<std::string> text = read_file(path, 1 << 20);
  return text ? *text : text.error().to_string();
}

TEST(ReadFile, APipeIsReadToItsEndAndNotWaitedForWhereNobodyWrites) {
  const ScratchFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] {
    std::ofstream out(pipe);
    out << "one, " << std::flush;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    out << "two";
  });
  EXPECT_EQ(text_of(pipe), "one, two");
  writer.join();
  const auto alone = read_file(pipe, 100);
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, ErrorCode::io_failed);
  EXPECT_EQ(alone.error().message, "nobody has written into this pipe for 5 s");
}

TEST(ReadFile, GivesTheBytes) {
  const ScratchFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  ASSERT_TRUE(write_file(folder.file("x"), bytes));
  EXPECT_EQ(text_of(folder.file("x")), bytes);
  ASSERT_TRUE(write_file(folder.file("empty"), ""));
  EXPECT_EQ(text_of(folder.file("empty")), "");
}

TEST(ReadFile, NamesWhatIsWrong) {
  const ScratchFolder folder;
  const std::string missing = folder.file("missing");
  EXPECT_EQ(text_of(missing), missing + ": error: no such file");
  EXPECT_EQ(read_file(missing, 10).error().code, ErrorCode::file_not_found);
  EXPECT_EQ(text_of(folder.path()), folder.path() + ": error: is a folder, not a file");
  ASSERT_TRUE(write_file(folder.file("eleven"), "01234567890"));
  const Result<std::string> large = read_file(folder.file("eleven"), 10);
  EXPECT_EQ(large.error().code, ErrorCode::file_too_large);
  EXPECT_EQ(large.error().message, "the file has 11 bytes; at most 10 are read");
  EXPECT_TRUE(read_file(folder.file("eleven"), 11));
}

TEST(ReadFile, OfAMissingFileSuggestsTheNearestNameInItsFolder) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder.file("bell.toml"), ""));
  ASSERT_TRUE(write_file(folder.file("first-light.mid"), ""));
  const auto message = [&](const std::string& name) {
    return read_file(folder.file(name), 10).error().message;
  };
  const std::string bell = "no such file; did you mean '" + folder.file("bell.toml") + "'?";
  EXPECT_EQ(message("bel.toml"), bell);
  EXPECT_EQ(message("bell"), bell) << "only the ending is missing";
  EXPECT_EQ(message("first-ligth.mid"),
            "no such file; did you mean '" + folder.file("first-light.mid") + "'?");
  EXPECT_EQ(message("something-else.wav"), "no such file");
  EXPECT_EQ(read_file(folder.file("none/bell.toml"), 10).error().message, "no such file");
}

TEST(ReadFile, OfAnEndlessDeviceStopsAtTheLimit) {
  EXPECT_EQ(read_file("/dev/zero", 1 << 20).error().code, ErrorCode::file_too_large);
}

TEST(AtomicFile, TheFinalNameAppearsWithCommitOnly) {
  const ScratchFolder folder;
  const std::string path = folder.file("song.wav");
  Result<AtomicFile> file = AtomicFile::create(path);
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_EQ(file->part_path(), path + ".part-" + std::to_string(::getpid()));
  ASSERT_TRUE(file->write(std::as_bytes(std::span("abc", 3))));
  EXPECT_FALSE(fs::exists(path));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(text_of(path), "abc");
  EXPECT_EQ(names_in(folder.path()), Names{"song.wav"});
}

TEST(AtomicFile, WithoutCommitTheOldFileIsKept) {
  const ScratchFolder folder;
  const std::string path = folder.file("song.wav");
  ASSERT_TRUE(write_file(path, "old"));
  {
    Result<AtomicFile> file = AtomicFile::create(path);
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(std::as_bytes(std::span("new", 3))));
  }
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(names_in(folder.path()), Names{"song.wav"});
}

TEST(AtomicFile, ReplacingKeepsTheModeAndTheLink) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder.file("real"), "old"));
  ASSERT_EQ(::chmod(folder.file("real").c_str(), 0640), 0);
  ASSERT_EQ(::symlink("real", folder.file("link").c_str()), 0);
  ASSERT_TRUE(write_file(folder.file("link"), "new"));
  EXPECT_EQ(text_of(folder.file("real")), "new");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  struct stat info {};
  ASSERT_EQ(::stat(folder.file("real").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST(AtomicFile, ANameMayBeAsLongAsTheFileSystemAllows) {
  const ScratchFolder folder;
  const std::string ending = ".wav";
  for (const std::size_t size : {235u, 239u, 240u, 250u, 255u}) {
    const std::string name = std::string(size - ending.size(), 'n') + ending;
    const Result<AtomicFile> old = AtomicFile::create(folder.file(name));
    ASSERT_TRUE(old) << old.error().to_string();
    const std::string neighbour = "m" + name.substr(1);
    EXPECT_TRUE(write_file(folder.file(neighbour), "x")) << "of the same length";
    const std::string alike = name.substr(0, size - 1) + "x";  // differs where a part is cut
    EXPECT_TRUE(write_file(folder.file(alike), "x"));
    EXPECT_FALSE(write_file(folder.file(name), "x")) << "is being written already";
  }
  EXPECT_EQ(names_in(folder.path()).size(), 10u);
  const Result<void> written = write_file(folder.file(std::string(256, 'n')), "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message,
            "cannot write '" + folder.file(std::string(256, 'n')) + "': File name too long");
}

TEST(AtomicFile, SweepsCutPartsOfTheDeadToo) {
  const ScratchFolder folder;
  const std::string name(254, 'n');
  const pid_t child = ::fork();
  if (child == 0) {
    const Result<AtomicFile> part = AtomicFile::create(folder.file(name));
    ::_exit(part ? 0 : 1);  // no destructor runs
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_EQ(names_in(folder.path()).size(), 1u);
  ASSERT_TRUE(write_file(folder.file(name), "new"));
  EXPECT_EQ(names_in(folder.path()), Names{name});
}

TEST(HasEnding, LettersCountInAnyCase) {
  for (const char* path : {"a.wav", "a.WAV", "a.Wav", ".wav"})
    EXPECT_TRUE(has_ending(path, ".wav"));
  for (const char* path : {"a.wave", "wav", "a.flac", ""}) EXPECT_FALSE(has_ending(path, ".wav"));
}

TEST(AtomicFile, MovesOwnTheFile) {
  const ScratchFolder folder;
  Result<AtomicFile> made = AtomicFile::create(folder.file("a"));
  ASSERT_TRUE(made);
  AtomicFile first = std::move(*made);
  AtomicFile second = std::move(first);
  ASSERT_TRUE(second.commit());
  EXPECT_EQ(names_in(folder.path()), Names{"a"});
}

TEST(AtomicFile, OneWriterPerName) {
  const ScratchFolder folder;
  const Result<AtomicFile> first = AtomicFile::create(folder.file("a"));
  ASSERT_TRUE(first);
  const Result<AtomicFile> second = AtomicFile::create(folder.file("a"));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message,
            "cannot write '" + folder.file("a") + "': it is being written already");
}

TEST(AtomicFile, RefusesWhatIsNoFile) {
  const ScratchFolder folder;
  const auto message = [](const std::string& path) {
    const Result<void> written = write_file(path, "x");
    return written ? "written" : written.error().message;
  };
  EXPECT_EQ(message(folder.path()),
            "cannot write '" + folder.path() + "': it is a folder, not a file");
  EXPECT_EQ(message("/dev/full"), "cannot write '/dev/full': it is a device or pipe, not a file");
  EXPECT_EQ(message("/dev/null"), "cannot write '/dev/null': it is a device or pipe, not a file");
  EXPECT_EQ(message(folder.file("no/x")),
            "cannot write into folder '" + folder.file("no") + "': No such file or directory");
  EXPECT_FALSE(write_file("", "x"));
}

TEST(AtomicFile, SweepsPartsOfTheDeadAndLeavesThoseOfTheLiving) {
  const ScratchFolder folder;
  const pid_t dead = ::fork();
  if (dead == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(dead, nullptr, 0), dead);
  const auto touch = [&](const std::string& name) { std::ofstream(folder.file(name)) << "x"; };
  touch("a.part-" + std::to_string(dead));
  touch("b.part-" + std::to_string(dead));  // of another name
  touch("a.part-1");                        // init lives
  touch("a.part-" + std::to_string(dead) + "x");
  touch("a.part-" + std::to_string(::getpid()));  // ours, left by a process with the same id
  ASSERT_TRUE(write_file(folder.file("a"), "new"));
  Names expected = {"a", "a.part-1", "a.part-" + std::to_string(dead) + "x",
                    "b.part-" + std::to_string(dead)};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names_in(folder.path()), expected);
}

TEST(AtomicFile, ASignalHandlerCanRemoveTheUnfinished) {
  const ScratchFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGTERM, [](int) {
      remove_unfinished_files();
      ::_exit(7);
    });
    const Result<AtomicFile> first = AtomicFile::create(folder.file("a"));
    const Result<AtomicFile> second = AtomicFile::create(folder.file("b"));
    if (!first || !second || names_in(folder.path()).size() != 2) ::_exit(1);
    ::raise(SIGTERM);
    ::_exit(2);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(AtomicFile, TheTableOfTheUnfinishedIsBoundedAndReused) {
  const ScratchFolder folder;
  {
    std::vector<AtomicFile> files;
    for (int i = 0; i < 64; ++i) {
      Result<AtomicFile> file = AtomicFile::create(folder.file(std::to_string(i)));
      ASSERT_TRUE(file) << file.error().to_string();
      files.push_back(std::move(*file));
    }
    EXPECT_FALSE(AtomicFile::create(folder.file("one more")));
  }
  EXPECT_TRUE(AtomicFile::create(folder.file("one more")));
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(AtomicFile, AFileSizeLimitIsAnErrorAndLeavesNothing) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file(folder.file("a"), "old"));
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(write_file(folder.file("a"), std::string(5000, 'x')) ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(text_of(folder.file("a")), "old");
  EXPECT_EQ(names_in(folder.path()), Names{"a"});
}

/// A file system of 64 KiB, mounted for one test; needs root.
class SmallDisk {
 public:
  SmallDisk() { mounted_ = ::mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=64k") == 0; }
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.path().c_str(), MNT_DETACH);
  }
  bool mounted() const { return mounted_; }
  bool make_read_only() const {
    return ::mount("tmpfs", folder_.path().c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  }
  std::string path() const { return folder_.path(); }
  std::string file(const std::string& name) const { return folder_.file(name); }

 private:
  ScratchFolder folder_;
  bool mounted_ = false;
};

TEST(AtomicFile, AFullDiskIsDiskFullAndLeavesNothing) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "no right to mount a small disk here";
  ASSERT_TRUE(write_file(disk.file("a"), "old"));
  const Result<void> written = write_file(disk.file("a"), std::string(200000, 'x'));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::disk_full);
  EXPECT_EQ(written.error().message,
            "cannot write '" + disk.file("a") + "': No space left on device");
  EXPECT_EQ(text_of(disk.file("a")), "old");
  EXPECT_EQ(names_in(disk.path()), Names{"a"});
}

TEST(AtomicFile, AReadOnlyFolderIsNamed) {
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "no right to mount a small disk here";
  ASSERT_TRUE(disk.make_read_only());
  const Result<void> written = write_file(disk.file("a"), "x");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::io_failed);
  EXPECT_EQ(written.error().message,
            "cannot write into folder '" + disk.path() + "': Read-only file system");
}

}  // namespace
}  // namespace knotwave::base

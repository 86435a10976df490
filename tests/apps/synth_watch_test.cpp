// SPDX-License-Identifier: MIT
// Files saved in every way editors do it, and what a watched patch then becomes.
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/render_scene.h"
#include "patch_watch.h"

namespace knotwave::synth {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Asks again and again until it is so, 20 s at most.
bool happens(const std::function<bool()>& is_so) {
  for (int i = 0; i < 4000; ++i) {
    if (is_so()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

class WatchScene : public render::RenderScene {
 protected:
  void overwrite(const std::string& name, const std::string& text) {
    std::FILE* out = std::fopen(file(name).c_str(), "w");
    std::fputs(text.c_str(), out);
    std::fclose(out);
  }
};
using FileWatches = WatchScene;
using PatchWatches = WatchScene;

TEST_F(FileWatches, EveryWayToSaveIsSeen) {
  FileWatch watch;
  watch.watch({file("small.toml")});
  const auto is_seen = [&] { return watch.is_changed(now_ns()); };
  EXPECT_FALSE(is_seen());
  overwrite("small.toml", "a");
  EXPECT_TRUE(happens(is_seen)) << "written over";
  overwrite("new.tmp", "b");
  std::filesystem::rename(file("new.tmp"), file("small.toml"));
  EXPECT_TRUE(happens(is_seen)) << "a new file renamed";
  std::filesystem::rename(file("small.toml"), file("small.toml~"));
  overwrite("small.toml", "c");
  EXPECT_TRUE(happens(is_seen)) << "the old one moved away first";
  std::filesystem::remove(file("small.toml"));
  overwrite("small.toml", "d");
  EXPECT_TRUE(happens(is_seen)) << "removed and written";
}

TEST_F(FileWatches, WhoSavesWithoutAPauseIsSeen) {
  FileWatch watch;
  watch.watch({file("small.toml")});
  const std::int64_t begin_ns = now_ns();
  int seen = 0;
  for (std::int64_t ms = 0; ms < 1000; ms += 10) {  // by a clock of the test's own
    overwrite("small.toml", std::to_string(ms));
    seen += watch.is_changed(begin_ns + ms * 1'000'000) ? 1 : 0;
  }
  EXPECT_GE(seen, 4);
  EXPECT_LE(seen, 5);
}

TEST_F(FileWatches, BothEndsOfALinkAreWatched) {
  std::filesystem::create_directory(file("far"));
  overwrite("far/patch.toml", "a");
  std::filesystem::create_symlink("far/patch.toml", file("link.toml"));
  FileWatch watch;
  watch.watch({file("link.toml")});
  const auto is_seen = [&] { return watch.is_changed(now_ns()); };
  overwrite("far/patch.toml", "b");
  EXPECT_TRUE(happens(is_seen));
}

TEST_F(FileWatches, OtherFilesOfTheFolderDoNotCount) {
  FileWatch watch;
  watch.watch({file("small.toml")});
  overwrite("other.toml", "a");
  overwrite("small.toml", "b");
  EXPECT_TRUE(happens([&] { return watch.is_changed(now_ns()); }));
  overwrite("other.toml", "c");
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(watch.is_changed(now_ns() + i * 10'000'000));
  }
  overwrite("other.toml", "d");
  EXPECT_TRUE(happens([&] { return watch.is_changed(now_ns(), true); }));
}

TEST_F(FileWatches, SavesInARowAreOneChange) {
  FileWatch watch;
  watch.watch({file("small.toml")});
  const std::int64_t start = now_ns();
  for (int i = 0; i < 10; ++i) {
    overwrite("small.toml", std::to_string(i));
    EXPECT_FALSE(watch.is_changed(start + i * 10'000'000)) << "touched 10 ms ago";
  }
  EXPECT_TRUE(watch.is_changed(start + 130'000'000));
  EXPECT_FALSE(watch.is_changed(start + 200'000'000));
}

/// Polls until there is news.
PatchWatch::News news_of(PatchWatch& watch) {
  PatchWatch::News news;
  happens([&] {
    news = watch.poll(now_ns());
    return news.bank.has_value() || !news.lines.empty();
  });
  return news;
}

TEST_F(PatchWatches, ASavedPatchIsCompiledAndABrokenOneToldWithItsPlace) {
  const auto bank = read_playable(file("small.toml"));
  PatchWatch watch(*bank);
  std::string text = render::kSmallPatch;
  overwrite("small.toml", text + "gain_db = -6\n");
  PatchWatch::News news = news_of(watch);
  EXPECT_FALSE(news.bank.has_value()) << "gain_db is no key of an envelope";
  ASSERT_FALSE(news.lines.empty());
  EXPECT_THAT(news.lines[0], HasSubstr("small.toml:15:1: error: "));
  EXPECT_EQ(news.lines[1], "the old sound plays on");
  overwrite("small.toml", text + "velocity_time = 1\n");
  news = news_of(watch);
  ASSERT_TRUE(news.bank.has_value());
  EXPECT_THAT(news.lines, Contains("now playing " + file("small.toml")));
  EXPECT_EQ(news.bank->input.spec.patches[0].envelopes[0].velocity_time, 1);
}

TEST_F(PatchWatches, AFileThatAPatchNamesIsWatchedAsWell) {
  overwrite("curves.toml",
            "format = 1\nkind = \"curve\"\n[curves.a]\ndegree = 1\npoints = [0, 1]\n");
  overwrite("uses.toml",
            std::string(render::kSmallPatch) + "[curves.b]\ncurve_file = \"curves.toml#a\"\n");
  const auto bank = read_playable(file("uses.toml"));
  ASSERT_TRUE(bank.has_value()) << bank.error().to_string();
  PatchWatch watch(*bank);
  overwrite("curves.toml",
            "format = 1\nkind = \"curve\"\n[curves.a]\ndegree = 1\npoints = [0, 2]\n");
  EXPECT_TRUE(news_of(watch).bank.has_value());
}

TEST_F(PatchWatches, TheFileThatIsMissingHealsThePatchWhenItComes) {
  const auto bank = read_playable(file("small.toml"));
  PatchWatch watch(*bank);
  overwrite("small.toml",
            std::string(render::kSmallPatch) + "[curves.b]\ncurve_file = \"late.toml#a\"\n");
  EXPECT_FALSE(news_of(watch).bank.has_value());
  overwrite("late.toml", "format = 1\nkind = \"curve\"\n[curves.a]\ndegree = 1\npoints = [0, 1]\n");
  EXPECT_TRUE(news_of(watch).bank.has_value());
}

TEST_F(PatchWatches, APatchThatIsGoneIsToldOnceAndSoIsItsReturn) {
  const auto bank = read_playable(file("small.toml"));
  PatchWatch watch(*bank);
  std::int64_t clock_ns = now_ns();  // of the test's own: 5 s of looks, 0.1 s apart
  const auto told_in_5_s = [&] {
    std::vector<std::string> lines;
    for (int i = 0; i < 50; ++i) {
      clock_ns += 100'000'000;
      for (auto& line : watch.poll(clock_ns).lines) lines.push_back(std::move(line));
    }
    return lines;
  };
  EXPECT_THAT(told_in_5_s(), IsEmpty());
  std::filesystem::rename(file("small.toml"), file("away"));
  EXPECT_THAT(told_in_5_s(),
              testing::ElementsAre(file("small.toml") + " is gone; the old sound plays on"));
  EXPECT_THAT(told_in_5_s(), IsEmpty()) << "once";
  std::filesystem::rename(file("away"), file("small.toml"));
  std::vector<std::string> lines = told_in_5_s();
  EXPECT_THAT(lines, Contains(file("small.toml") + " is there again"));
  happens([&] {
    const auto news = watch.poll(clock_ns);
    lines.insert(lines.end(), news.lines.begin(), news.lines.end());
    return lines.size() >= 2;
  });
  EXPECT_THAT(lines, testing::ElementsAre(file("small.toml") + " is there again",
                                          "now playing " + file("small.toml")));
}

TEST_F(PatchWatches, ALinkWhoseFarEndIsGoneIsToldOnceByItsOwnName) {
  std::filesystem::create_directory(file("far"));
  overwrite("far/patch.toml", render::kSmallPatch);
  std::filesystem::create_symlink("far/patch.toml", file("link.toml"));
  const auto bank = read_playable(file("link.toml"));
  ASSERT_TRUE(bank.has_value()) << bank.error().to_string();
  PatchWatch watch(*bank);
  std::filesystem::remove(file("far/patch.toml"));
  std::vector<std::string> lines;
  const std::int64_t start_ns = now_ns();
  for (std::int64_t i = 0; i < 50; ++i) {
    for (auto& line : watch.poll(start_ns + i * 100'000'000).lines) lines.push_back(line);
  }
  EXPECT_THAT(lines, testing::ElementsAre(file("link.toml") + " is gone; the old sound plays on"));
}

TEST_F(PatchWatches, AFileThatIsAwayForAMomentIsNotTold) {
  const auto bank = read_playable(file("small.toml"));
  PatchWatch watch(*bank);
  std::int64_t clock_ns = now_ns() + 10'000'000'000;
  std::filesystem::rename(file("small.toml"), file("small.toml~"));
  EXPECT_THAT(watch.poll(clock_ns).lines, IsEmpty()) << "the look that misses it";
  overwrite("small.toml", render::kSmallPatch);
  clock_ns += 1'000'000'000;
  for (int i = 0; i < 5; ++i) {
    for (const std::string& line : watch.poll(clock_ns + i * 50'000'000).lines) {
      EXPECT_EQ(line, "now playing " + file("small.toml"));
    }
  }
}

TEST_F(PatchWatches, TheNextPatchGoesRoundTheFolderPastWhatIsNone) {
  for (const char* name : {"a.toml", "z.toml"}) overwrite(name, render::kSmallPatch);
  overwrite("b-curves.toml", "format = 1\nkind = \"curve\"\n");
  overwrite("c-broken.toml", "format = 1\nkind = \"patch\"\nno key\n");
  overwrite("d-faulty.toml", "format = 1\nkind = \"patch\"\nname = \"x\"\n");
  const auto bank = read_playable(file("small.toml"));
  PatchWatch watch(*bank);
  EXPECT_EQ(watch.next_in_folder(), file("z.toml"));
  watch.load(file("z.toml"));
  EXPECT_TRUE(news_of(watch).bank.has_value());
  EXPECT_EQ(watch.path(), file("z.toml"));
  EXPECT_EQ(watch.next_in_folder(), file("a.toml"));
  watch.load(file("a.toml"));
  news_of(watch);
  EXPECT_EQ(watch.next_in_folder(), file("d-faulty.toml"));
  watch.load(file("d-faulty.toml"));
  EXPECT_THAT(news_of(watch).lines, Contains(file("a.toml") + " plays on"));
  EXPECT_EQ(watch.path(), file("a.toml"));
  EXPECT_EQ(watch.next_in_folder(), file("small.toml")) << "past the faulty one";
}

}  // namespace
}  // namespace knotwave::synth

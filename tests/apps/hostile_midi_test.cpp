// SPDX-License-Identifier: MIT
// knotwave-render --check on hostile MIDI files: the frozen verdict, within a second of processor
// time and 64 MiB + 16 times the file's size.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <gmock/gmock.h>

#include "apps/render_scene.h"
#include "support/corpus.h"
#include "support/verdicts.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KNOTWAVE_SANITIZED 1
#endif

namespace knotwave::render {
namespace {

/// Sanitizers have memory and time of their own.
#ifdef KNOTWAVE_SANITIZED
constexpr bool kLimitsCount = false;
#else
constexpr bool kLimitsCount = true;
#endif

class HostileMidi : public RenderScene {
 protected:
  support::ProgramRun check(const std::string& path) {
    auto done = run({"--check", "--quiet", "small.toml", path});
    if (!kLimitsCount) return done;
    const double limit_kib =
        64 * 1024 + 16.0 / 1024 * static_cast<double>(std::filesystem::file_size(path));
    EXPECT_LE(done.cpu_s, 1.0) << path;
    EXPECT_LE(static_cast<double>(done.max_rss_kib), limit_kib) << path;
    most_cpu_s_ = std::max(most_cpu_s_, done.cpu_s);
    most_rss_kib_ = std::max(most_rss_kib_, done.max_rss_kib);
    return done;
  }
  double most_cpu_s_ = 0;
  long most_rss_kib_ = 0;
};

TEST_F(HostileMidi, EveryFileOfTheCorpusGetsItsFrozenVerdict) {
  const auto files = support::corpus_files("midi_bad", {".mid"});
  std::printf("corpus: %zu files of midi_bad\n", files.size());
  if (files.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no midi_bad: no file was read";
  const auto verdicts =
      support::read_verdicts(KNOTWAVE_SOURCE_DIR "/tests/golden/midi_verdicts.tsv");
  const std::string root = support::corpus_root() + "/midi_bad/";
  for (const auto& path : files) {
    const auto row = verdicts.find(path.substr(root.size()));
    ASSERT_NE(row, verdicts.end()) << path;
    const bool is_accept = row->second.starts_with("accept");
    const auto done = check(path);
    EXPECT_EQ(done.exit_code, is_accept ? 0 : 1) << path << ": " << done.err;
    if (!is_accept) {
      EXPECT_TRUE(done.err.starts_with(path + ": byte ")) << done.err;
      EXPECT_THAT(done.err, testing::HasSubstr(": error: "));
    }
  }
  std::printf("at most %.3f s and %ld KiB a file\n", most_cpu_s_, most_rss_kib_);
}

std::string chunk(const std::string& id, const std::string& body) {
  const auto size = body.size();
  std::string out = id;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(size >> shift);
  return out + body;
}
std::string midi_file(int tracks, const std::string& track) {
  std::string out = chunk("MThd", {0, 1, 0, static_cast<char>(tracks), 0, 96});
  for (int i = 0; i < tracks; ++i) out += chunk("MTrk", track + std::string("\0\xff\x2f\0", 4));
  return out;
}
std::string repeat(const std::string& event, std::size_t bytes) {
  std::string out;
  while (out.size() < bytes) out += event;
  return out;
}

/// The smallest of each event fills a file: the most memory a byte can cost.
TEST_F(HostileMidi, TheDensestFilesStayWithinTheirMemory) {
  constexpr std::size_t kBytes = 2 << 20;
  const struct {
    const char* name;
    std::string bytes;
  } cases[] = {
      {"events in one track", midi_file(1, std::string("\0\xd0\1", 3) + repeat({0, 1}, kBytes))},
      {"events in two tracks", midi_file(2, std::string("\0\xd0\1", 3) + repeat({1, 1}, kBytes))},
      {"texts", midi_file(1, repeat(std::string("\0\xff\1\1a", 5), kBytes))},
      {"empty texts", midi_file(1, repeat(std::string("\0\xff\1\0", 4), kBytes))},
      {"tempos", midi_file(1, repeat(std::string("\1\xff\x51\3\1\2\3", 7), kBytes))},
      {"system exclusives", midi_file(1, repeat(std::string("\0\xf0\2\1\xf7", 5), kBytes))},
      {"warnings", midi_file(1, repeat(std::string("\0\xf8", 2), kBytes))},
      {"empty tracks", midi_file(100, "")},
  };
  for (const auto& c : cases) {
    write("dense.mid", c.bytes);
    const auto done = check(file("dense.mid"));
    EXPECT_EQ(done.exit_code, 0) << c.name << ": " << done.err;
  }
  std::printf("at most %.3f s and %ld KiB\n", most_cpu_s_, most_rss_kib_);
}

}  // namespace
}  // namespace knotwave::render

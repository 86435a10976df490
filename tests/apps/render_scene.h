// SPDX-License-Identifier: MIT
// A small patch and small songs for tests of knotwave-render as a program.
#pragma once
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/io/midi_file.h"

#include "support/program.h"

namespace knotwave::render {

inline constexpr const char* kSmallPatch = R"(format = 1
kind   = "patch"
name   = "small"
[curves.gate]
degree = 1
points = [0, 1, 1, 0]
knots  = [0,0, 0.01, 0.02, 0.05,0.05]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.05
sustain_at = 0.02
release_at = 0.02
)";

/// A second of four notes on three channels.
inline io::Song small_song() {
  io::Song song;
  song.track_count = 1;
  song.time_base.ticks_per_quarter = 480;
  for (int i = 0; i < 4; ++i) {
    const auto key = static_cast<std::uint8_t>(60 + 3 * i);
    const auto channel = static_cast<std::uint8_t>(i == 3 ? 4 : i % 2);
    const auto tick = 240 * static_cast<std::uint64_t>(i);
    const auto on = static_cast<std::uint8_t>(0x90 | channel);
    song.events.push_back({tick + 1, 0, {on, key, 90}, 0, 0});
    song.events.push_back({tick + 200, 0, {on, key, 0}, 0, 0});
  }
  song.length_ticks = 960;
  return song;
}

/// A folder with small.toml and small.mid in it.
class RenderScene : public testing::Test {
 protected:
  RenderScene() {
    write("small.toml", kSmallPatch);
    write_song("small.mid", small_song());
  }
  void write(const std::string& name, std::string_view bytes) {
    const auto written = base::write_file(file(name), bytes);
    ASSERT_TRUE(written.has_value()) << written.error().to_string();
  }
  void write_song(const std::string& name, const io::Song& song) {
    const auto bytes = io::write_midi(song);
    write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  std::string read(const std::string& name) {
    auto bytes = base::read_file(file(name), 1u << 30);
    return bytes ? *bytes : "";
  }
  std::string file(const std::string& name) const { return folder_.file(name); }

  /// knotwave-render in the folder, with the words given.
  support::ProgramRun run(std::vector<std::string> words, support::ProgramOptions options = {}) {
    words.insert(words.begin(), "knotwave-render");
    options.folder = folder_.path();
    return support::run_program(words, options);
  }
  /// The same with the small patch and song, which must go well.
  support::ProgramRun render(std::vector<std::string> words) {
    words.insert(words.begin(), {"small.toml", "small.mid"});
    auto done = run(words);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done;
  }

  support::ScratchFolder folder_;
};

/// The 64 digits after "sha256 " in a report line.
inline std::string hash_in(const std::string& line) {
  const std::size_t at = line.find("sha256 ");
  return at == std::string::npos ? "" : line.substr(at + 7, 64);
}

}  // namespace knotwave::render

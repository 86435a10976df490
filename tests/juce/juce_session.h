// SPDX-License-Identifier: MIT
// What the host made of JUCE (juce_host.cpp) shall do, what it answers, and its files.
#pragma once
#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"

#include "plugins/story.h"
#include "support/program.h"

namespace knotwave::test {

using Lines = std::vector<std::string>;

inline Lines split(const std::string& text, char at) {
  Lines parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

class Session {
 public:
  /// `bin` is the build's folder of programs.
  Session(std::string format, const std::string& bin)
      : program_(bin + "/../tests/juce/knotwave_juce_host"), format_(std::move(format)) {
    say("scan", bin + "/../plugins/" + format_);
  }
  template <class... Words>
  void say(const Words&... words) {
    std::ostringstream line;
    line.precision(17);
    ((line << words << '\t'), ...);
    script_ += line.str();
    script_.back() = '\n';
  }
  std::string file(const std::string& name) const { return folder_.file(name); }

  void play(const Story& story, std::size_t block, const std::string& name) {
    for (const Story::Midi& event : story.midi) {
      say("midi", event.sample, int{event.bytes[0]}, int{event.bytes[1]}, int{event.bytes[2]});
    }
    std::string bytes;
    for (const std::vector<float>& channel : story.inputs) {
      bytes.append(reinterpret_cast<const char*>(channel.data()), channel.size() * sizeof(float));
    }
    EXPECT_TRUE(base::write_file(file(name + ".in"), bytes));
    say("play", story.frames, block, file(name + ".in"), file(name));
  }
  /// Channels of a file that the host wrote.
  Channels sound(const std::string& name, std::size_t frames) const {
    const auto bytes = base::read_file(file(name), 1 << 30);
    EXPECT_TRUE(bytes) << name;
    if (!bytes) return {};
    Channels all(bytes->size() / (frames * sizeof(float)), std::vector<float>(frames));
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::memcpy(all[i].data(), bytes->data() + i * frames * sizeof(float),
                  frames * sizeof(float));
    }
    return all;
  }
  /// Its answers, behind those of the scan. Whatever JUCE itself finds wrong is a failure.
  Lines run() {
    EXPECT_TRUE(base::write_file(file("script"), script_));
    const auto ran = support::run_program({program_, format_, file("script")});
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.err.find("Assertion"), std::string::npos) << ran.err;
    Lines lines = split(ran.out, '\n');
    const auto end = std::ranges::find(lines, "scanned");
    EXPECT_NE(end, lines.end()) << ran.out;
    scanned_.assign(lines.begin(), end);
    lines.erase(lines.begin(), end == lines.end() ? end : end + 1);
    return lines;
  }
  const Lines& scanned() const { return scanned_; }

 private:
  std::string program_, format_, script_;
  support::ScratchFolder folder_;
  Lines scanned_;
};

}  // namespace knotwave::test

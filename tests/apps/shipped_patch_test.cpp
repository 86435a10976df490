// SPDX-License-Identifier: MIT
// What single shipped patches promise: notes that begin without a click, and one push of the brass.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/notes_file.h"
#include "support/program.h"

namespace {

using knotwave::io::SongEvent;
using knotwave::render::Note;
using knotwave::render::notes_file;

/// Two channels, interleaved.
std::vector<float> played(const std::string& patch, const std::vector<Note>& notes,
                          const std::vector<SongEvent>& more = {}) {
  const knotwave::support::ScratchFolder folder;
  const auto done = knotwave::support::run_program(
      {"knotwave-render", KNOTWAVE_SOURCE_DIR "/examples/patches/" + patch + ".toml",
       notes_file(folder, notes, more), "-o", "-", "--tail", "0"});
  EXPECT_EQ(done.exit_code, 0) << patch << "\n" << done.err;
  std::vector<float> samples(done.out.size() / 4);
  std::memcpy(samples.data(), done.out.data(), samples.size() * 4);
  return samples;
}

/// The largest step of one channel from a frame to the next; silence comes before the first.
float largest_step(const std::vector<float>& samples, std::size_t from, std::size_t to) {
  float largest = 0;
  for (std::size_t i = 2 * from; i < std::min(2 * to, samples.size()); ++i) {
    largest = std::max(largest, std::abs(samples[i] - (i < 2 ? 0.0F : samples[i - 2])));
  }
  return largest;
}

// A closed curve that is not 0 where a note begins jumps there. What follows is judge: a bright
// tone has large steps of its own. Drums may begin with a crack.
TEST(ShippedPatches, ToneBeginsWithNoLargerStepThanItGoesOnWith) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/patches")) {
    const std::string patch = entry.path().stem().string();
    const auto samples = played(patch, {{0, 1, 60, 100}});
    const float begin = largest_step(samples, 0, 4), later = largest_step(samples, 20, 4000);
    EXPECT_LT(begin, 2.5F * later) << patch << ": " << begin << ", later " << later;
    ++count;
  }
  EXPECT_GE(count, 40);
}

// Controller 2 and channel pressure add up to the same free number.
TEST(ShippedPatches, BreathAndAftertouchAreOnePushOfTheBrass) {
  const std::vector<Note> note = {{0, 2, 60, 90}};
  const auto plain = played("brass", note);
  const auto breath = played("brass", note, {{480, 0, {0xB0, 2, 100}, 0, 0}});
  const auto pressure = played("brass", note, {{480, 0, {0xD0, 100, 0}, 0, 0}});
  EXPECT_EQ(breath, pressure);
  EXPECT_NE(breath, plain);
  const auto energy = [](const std::vector<float>& samples) {
    double sum = 0;
    for (std::size_t i = samples.size() / 2; i < samples.size(); ++i) {
      sum += double{samples[i]} * double{samples[i]};
    }
    return sum;
  };
  EXPECT_GT(energy(breath), 1.6 * energy(plain)) << "2 dB louder";
}

}  // namespace

// SPDX-License-Identifier: MIT
// Every shipped patch plays every shipped score.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/program.h"

namespace {

using knotwave::support::run_program;

std::vector<std::string> examples(const char* folder, const char* extension) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::string(KNOTWAVE_SOURCE_DIR "/examples/") + folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expect_sound(const std::string& patch, const std::string& score) {
  const auto run = run_program({"knotwave-render", patch, score, "-o", "-", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << patch << " with " << score << "\n" << run.err;
  float peak = 0;
  for (std::size_t i = 0; i + 4 <= run.out.size(); i += 4) {
    float x = 0;
    std::copy_n(run.out.data() + i, 4, reinterpret_cast<char*>(&x));
    ASSERT_TRUE(x > -1 && x < 1) << patch << " with " << score << ": sample " << i / 8;
    peak = std::max(peak, std::abs(x));
  }
  EXPECT_GT(peak, 0.003f) << patch << " with " << score << " is silent";
}

TEST(PatchPairs, EveryPatchPlaysAScoreAndEveryScoreAPatch) {
  const auto patches = examples("patches", ".toml"), scores = examples("scores", ".mid");
  ASSERT_GE(patches.size(), 12u);
  ASSERT_GE(scores.size(), 4u);
  for (const auto& patch : patches) {
    expect_sound(patch, KNOTWAVE_SOURCE_DIR "/examples/scores/first-light.mid");
  }
  for (std::size_t i = 0; i < scores.size(); ++i) expect_sound(patches[i], scores[i]);
  std::printf("%zu patches, %zu scores\n", patches.size(), scores.size());
}

TEST(PatchPairsStress, EveryPatchPlaysEveryScore) {
  for (const auto& patch : examples("patches", ".toml")) {
    for (const auto& score : examples("scores", ".mid")) expect_sound(patch, score);
  }
}

}  // namespace

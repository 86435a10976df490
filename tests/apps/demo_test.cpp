// SPDX-License-Identifier: MIT
#include "demo/demo.h"

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/file.h"

namespace knotwave::demo {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string bytes_of(const std::string& path) {
  auto bytes = base::read_file(path, 1 << 20);
  EXPECT_TRUE(bytes.has_value()) << path;
  return bytes ? *bytes : "";
}

TEST(Demo, FirstLightIsInside) { EXPECT_THAT(names_of_demos(), Contains("first-light")); }

TEST(Demo, EveryFileInsideIsTheOneInExamples) {
  ASSERT_GT(embedded_files().size(), 10u);
  for (const EmbeddedFile& file : embedded_files()) {
    const std::string inside(file.bytes.begin(), file.bytes.end());
    EXPECT_EQ(inside, bytes_of(KNOTWAVE_SOURCE_DIR "/examples/" + std::string(file.name)));
  }
}

// The list in apps/demo/CMakeLists.txt is written by hand.
TEST(Demo, EveryPatchCurveBankAndScoreOfExamplesIsInside) {
  for (const char* folder : {"banks", "curves", "patches", "scores"}) {
    for (const auto& entry : std::filesystem::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/" +
                                                                 std::string(folder))) {
      const std::string name = std::string(folder) + "/" + entry.path().filename().string();
      const auto files = embedded_files();
      EXPECT_TRUE(std::any_of(files.begin(), files.end(),
                              [&](const EmbeddedFile& file) { return file.name == name; }))
          << name << " is missing in apps/demo/CMakeLists.txt";
    }
  }
}

TEST(Demo, FilesLieAsTheyDoInExamplesAndGoAgain) {
  std::string folder;
  {
    const auto demo = DemoFiles::unpack("first-light");
    ASSERT_TRUE(demo.has_value()) << demo.error().to_string();
    EXPECT_THAT(demo->patch(), HasSubstr("/banks/first-light.toml"));
    EXPECT_EQ(bytes_of(demo->score()),
              bytes_of(KNOTWAVE_SOURCE_DIR "/examples/scores/first-light.mid"));
    folder = std::filesystem::path(demo->score()).parent_path().parent_path();
    EXPECT_TRUE(std::filesystem::exists(folder + "/patches/bell.toml"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Demo, AWrongNameGetsASuggestion) {
  const auto demo = DemoFiles::unpack("first-lite");
  ASSERT_FALSE(demo.has_value());
  EXPECT_EQ(demo.error().code, ErrorCode::unknown_name);
  EXPECT_THAT(demo.error().message, HasSubstr("did you mean 'first-light'?"));
}

}  // namespace
}  // namespace knotwave::demo

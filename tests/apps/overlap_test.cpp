// SPDX-License-Identifier: MIT
// No program writes over what it reads, or twice into one file, whatever the names say.
#include <filesystem>
#include <map>

#include <gmock/gmock.h>

#include "apps/render_scene.h"

namespace knotwave::render {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Overlap : public RenderScene {
 protected:
  /// Nothing in the folder has changed and nothing has come.
  std::map<std::string, std::string> all_files() {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = fs::relative(entry.path(), folder_.path());
      files[name] = entry.is_regular_file() ? read(name) : "";
    }
    return files;
  }
  void expect_refused(const support::ProgramRun& done, const std::string& words) {
    EXPECT_EQ(done.exit_code, 2) << words << done.out << done.err;
    EXPECT_THAT(done.err, HasSubstr(words));
  }
  void expect_render_refused(std::vector<std::string> words, const std::string& message) {
    const auto before = all_files();
    words.insert(words.begin(), {"small.toml", "small.mid"});
    expect_refused(run(words), "knotwave-render: " + message + "\n");
    EXPECT_EQ(all_files(), before) << message;
  }
};

TEST_F(Overlap, TheReportNeverReplacesAnInput) {
  expect_render_refused({"-o", "a.wav", "--json", "small.toml"},
                        "--json 'small.toml' would overwrite the patch 'small.toml'");
  expect_render_refused({"-o", "a.wav", "--json", "./small.mid"},
                        "--json './small.mid' would overwrite the score 'small.mid'");
}

TEST_F(Overlap, TwoOutputsAreTwoFiles) {
  expect_render_refused({"-o", "a.wav", "--json", "a.wav"},
                        "--output 'a.wav' and --json 'a.wav' are the same file");
  expect_render_refused({"-o", "a.wav", "--json", "new/../a.wav"},
                        "--output 'a.wav' and --json 'new/../a.wav' are the same file");
  fs::create_directory(file("stems"));
  expect_render_refused(
      {"-o", "stems/channel-05.wav", "--stems", "stems"},
      "--output 'stems/channel-05.wav' and --stems 'stems/channel-05.wav' are the same file");
  render({"-o", "stems/channel-03.wav", "--stems", "stems"});  // channel 3 plays no note
}

TEST_F(Overlap, StemsReplaceNoInput) {
  fs::create_directory(file("stems"));
  fs::rename(file("small.mid"), file("stems/channel-01.wav"));
  const auto before = all_files();
  expect_refused(run({"small.toml", "stems/channel-01.wav", "-o", "a.wav", "--stems", "stems"}),
                 "--stems 'stems/channel-01.wav' would overwrite the score 'stems/channel-01.wav'");
  EXPECT_EQ(all_files(), before);
}

TEST_F(Overlap, LinksAreFollowed) {
  fs::rename(file("small.mid"), file("small.wav"));
  fs::create_symlink("small.wav", file("small.mid"));
  fs::create_hard_link(file("small.toml"), file("hard.json"));
  fs::create_directory_symlink(".", file("here"));
  expect_render_refused({"-o", "small.wav"},
                        "--output 'small.wav' would overwrite the score 'small.mid'");
  expect_render_refused({"-o", "a.wav", "--json", "hard.json"},
                        "--json 'hard.json' would overwrite the patch 'small.toml'");
  expect_render_refused({"-o", "a.wav", "--json", "here/a.wav"},
                        "--output 'a.wav' and --json 'here/a.wav' are the same file");
}

TEST_F(Overlap, WhatAPatchNamesIsAnInputToo) {
  render({"-o", "wave.wav", "--tail", "0"});
  write("curves.toml",
        "format = 1\nkind = \"curve\"\n[curves.gate]\ndegree = 1\npoints = [1, 0]\n");
  write("twelve.scl",
        "twelve\n12\n100.\n200.\n300.\n400.\n500.\n600.\n700.\n800.\n900.\n1000.\n1100.\n2/1\n");
  write("small.toml", R"(format = 1
kind   = "patch"
name   = "small"
tuning = "twelve.scl"
[curves.gate]
curve_file = "curves.toml#gate"
[oscillators.a]
wave_file  = "wave.wav"
wave_frame = 1000
[envelopes.amp]
curve = "gate"
)");
  for (const char* name : {"curves.toml", "twelve.scl"}) {
    expect_render_refused({"-o", "a.wav", "--json", name},
                          std::string("--json '") + name +
                              "' would overwrite a file the patch names, '" + name + "'");
  }
  expect_render_refused({"-o", "wave.wav"},
                        "--output 'wave.wav' would overwrite a sound the patch names, 'wave.wav'");
}

TEST_F(Overlap, APictureNeverReplacesTheCurve) {
  write("x.svg", "format = 1\nkind = \"curve\"\n[curves.env]\ndegree = 1\npoints = [1, 0]\n");
  fs::create_symlink("x.svg", file("y.svg"));
  const auto before = all_files();
  support::ProgramOptions options;
  options.folder = folder_.path();
  for (const char* name : {"x.svg", "y.svg"}) {
    expect_refused(
        support::run_program({"knotwave-curve", "plot", "x.svg#env", "-o", name}, options),
        std::string("--output '") + name + "' would overwrite the file that is read, 'x.svg'");
  }
  EXPECT_EQ(all_files(), before);
}

}  // namespace
}  // namespace knotwave::render

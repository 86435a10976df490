// SPDX-License-Identifier: MIT
// docs/nurbs-for-musicians.md: its commands work, its pictures are what they draw, and what it says
// one hears is in the files they make.
#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <memory>
#include <numbers>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/io/sound_file.h"

#include "support/program.h"
#include "support/spectrum.h"

namespace {

using namespace knotwave;
using support::decibels;
using testing::HasSubstr;

namespace fs = std::filesystem;

constexpr double kRootHz = 220;

std::string page() {
  return *base::read_file(KNOTWAVE_SOURCE_DIR "/docs/nurbs-for-musicians.md", 1 << 20);
}

/// Every line of the page's ```sh blocks.
std::string commands() {
  std::istringstream lines(page());
  std::string script;
  bool is_on = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      is_on = line == "```sh";
    } else if (is_on) {
      script += line + "\n";
    }
  }
  return script;
}

/// A folder that looks like the tree after a build.
class NurbsForMusicians : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_.file("build/release"));
    fs::create_directory(folder_.file("out"));
    fs::create_directory_symlink(KNOTWAVE_BIN_DIR, folder_.file("build/release/bin"));
    fs::create_directory_symlink(KNOTWAVE_SOURCE_DIR "/examples", folder_.file("examples"));
    std::istringstream words(page());
    for (std::string word; words >> word;) text_ += word + " ";
  }
  support::ProgramRun run(const std::string& script) {
    support::ProgramOptions options;
    options.folder = folder_.path();
    return support::run_program(
        {"/bin/bash", "-euo", "pipefail", "-c", "PATH=$PWD/build/release/bin:$PATH\n" + script},
        options);
  }
  /// The line of the page that makes this file.
  std::string command_of(const std::string& file) {
    const std::regex line("[^\n]* -o " + file + "\n");
    std::smatch found;
    const std::string script = commands();
    EXPECT_TRUE(std::regex_search(script, found, line)) << file;
    return found.str();
  }
  /// The left channel of out/NAME.wav, made as the page says unless it is there.
  std::vector<float> sound(const std::string& name) {
    const std::string file = "out/" + name + ".wav";
    if (!fs::exists(folder_.file(file))) {
      const auto done = run(command_of(file));
      EXPECT_EQ(done.exit_code, 0) << done.err;
    }
    const auto read = io::read_sound(folder_.file(file));
    EXPECT_TRUE(read) << read.error().to_string();
    EXPECT_EQ(read->rate_hz, 48000);
    std::vector<float> left;
    for (std::size_t i = 0; i < read->samples.size(); i += std::size_t(read->channels)) {
      left.push_back(read->samples[i]);
    }
    return left;
  }
  /// Of the samples around `at_s`, through a Hann window: the slow change of a fade within it does
  /// not beat with the periods of the tone.
  static double level_db(const std::vector<float>& samples, double at_s, double length_s = 0.1) {
    const auto count = std::size_t(length_s * 48000 + 0.5);
    const auto first = std::size_t(at_s * 48000 + 0.5) - count / 2;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = samples[first + i];
      sum += x * x * (1 - std::cos(2 * std::numbers::pi * double(i) / double(count)));
    }
    return decibels(std::sqrt(sum / double(count)));
  }
  /// Amplitude of one partial, through a Hann window of 0.1 s.
  static double amplitude(const std::vector<float>& samples, double hz, double at_s) {
    constexpr int kCount = 4800;
    const auto first = std::size_t(at_s * 48000 + 0.5) - kCount / 2;
    std::complex<double> sum = 0;
    for (int i = 0; i < kCount; ++i) {
      const double window = 1 - std::cos(2 * std::numbers::pi * i / kCount);
      sum += window * double(samples[first + std::size_t(i)]) *
             std::polar(1.0, -2 * std::numbers::pi * hz * i / 48000);
    }
    return 2 * std::abs(sum) / kCount;
  }
  /// The page says so, wherever its lines end.
  void says(const std::string& words) { EXPECT_THAT(text_, HasSubstr(words)); }

  support::ScratchFolder folder_;
  std::string text_;
};

TEST_F(NurbsForMusicians, EveryCommandWorksAndMakesWhatItNames) {
  const std::string script = commands();
  const auto done = run(script);
  EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
  EXPECT_EQ(done.err, "");
  int files = 0;
  const std::regex name("-o (\\S+)");
  for (std::sregex_iterator at(script.begin(), script.end(), name), end; at != end; ++at) {
    EXPECT_GT(fs::file_size(folder_.file((*at)[1])), 1000u);
    EXPECT_THAT(done.out, HasSubstr((*at)[1].str() + ": "));
    ++files;
  }
  EXPECT_EQ(files, 22);
}

TEST_F(NurbsForMusicians, EveryPictureIsWhatItsCommandDraws) {
  const std::string folder = KNOTWAVE_SOURCE_DIR "/docs/pictures/musicians/";
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    says("](pictures/musicians/" + name + ")");
    ASSERT_EQ(run(command_of("out/" + name)).exit_code, 0);
    const auto drawn = base::read_file(folder_.file("out/" + name), 1 << 24);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_TRUE(*drawn == *base::read_file(entry.path().string(), 1 << 24))
        << name << ": tools/make_musician_pictures.py draws it anew";
    ++pictures;
  }
  const std::string script = commands();
  const std::regex plot("knotwave-curve plot");
  EXPECT_EQ(pictures, std::distance(std::sregex_iterator(script.begin(), script.end(), plot), {}));
  EXPECT_EQ(pictures, 10);
}

TEST_F(NurbsForMusicians, PicturesOfTheGalleryAreWhatItDraws) {
  ASSERT_THAT(commands(), HasSubstr("\ngallery out/gallery\n"));
  ASSERT_EQ(run("gallery out/gallery").exit_code, 0);
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(KNOTWAVE_SOURCE_DIR "/docs/pictures/gallery")) {
    const std::string name = entry.path().filename().string();
    says("](pictures/gallery/" + name + ")");
    const auto drawn = base::read_file(folder_.file("out/gallery/" + name), 1 << 24);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_TRUE(*drawn == *base::read_file(entry.path().string(), 1 << 24))
        << name << ": tools/make_musician_pictures.py draws it anew";
    ++pictures;
  }
  EXPECT_EQ(pictures, 4);
  const std::regex shown("]\\(pictures/[^)]*\\)");
  EXPECT_EQ(std::distance(std::sregex_iterator(text_.begin(), text_.end(), shown), {}), 14);
}

// On either side the string's end and the curve: where they sing the same note it is the only one.
TEST_F(NurbsForMusicians, TheCurveOfStringsLeavesWithTheLeftEndAndArrivesWithTheRight) {
  ASSERT_EQ(run("gallery out/gallery").exit_code, 0);
  const auto read = *io::read_sound(folder_.file("out/gallery/string_art_quadratic.wav"));
  constexpr int kCount = 8192;
  const auto share_db = [&](int channel, double at_s, double low_hz, double high_hz) {
    std::vector<double> part;
    const auto first = std::int64_t(at_s * read.rate_hz) - kCount / 2;
    for (int i = 0; i < kCount; ++i) {
      part.push_back(double(read.samples[std::size_t(2 * (first + i) + channel)]) *
                     (1 - std::cos(2 * std::numbers::pi * i / kCount)));
    }
    const auto lines = support::line_spectrum(std::span<const double>(part));
    double inside = 0, all = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const double hz = double(i) * read.rate_hz / kCount, power = std::norm(lines[i]);
      all += power;
      if (hz >= low_hz && hz <= high_hz) inside += power;
    }
    return 10 * std::log10(inside / all);
  };
  const double end_s = double(read.frames) / read.rate_hz - 0.15;
  EXPECT_GT(share_db(0, 0.15, 95, 140), -1) << "both on the left begin at 110 Hz";
  EXPECT_GT(share_db(1, end_s, 110, 150), -1) << "both on the right end at 130 Hz";
  EXPECT_LT(share_db(1, 0.15, 95, 140), -1) << "the right end begins two octaves above";
  EXPECT_LT(share_db(0, end_s, 110, 150), -1) << "the left end is up there now";
  says("It leaves with the left one and arrives with the right one.");
}

TEST_F(NurbsForMusicians, EveryPatchOfTheFolderIsPlayed) {
  for (const auto& entry : fs::directory_iterator(KNOTWAVE_SOURCE_DIR "/examples/musicians")) {
    says("examples/musicians/" + entry.path().filename().string());
  }
}

TEST_F(NurbsForMusicians, CrossFadesAreAsLoudHalfWayAsThePageSays) {
  const auto circle = sound("7-arc");
  const double full = level_db(circle, 2);
  const auto half_way = [&](const std::string& name) { return level_db(sound(name), 2) - full; };
  EXPECT_NEAR(half_way("1-line"), -3.01, 0.01);
  says("half-way it is 3.01 dB softer than at either end");
  EXPECT_NEAR(half_way("2-quadratic"), 0.51, 0.01);
  says("now it is 0.51 dB louder there");
  for (const char* name : {"1-line", "2-quadratic", "3-cubic"}) {
    const auto samples = sound(name);
    EXPECT_NEAR(level_db(samples, 0.07), full, 0.16) << "an end of " << name;
    EXPECT_NEAR(level_db(samples, 3.93), full, 0.16) << "an end of " << name;
  }
}

TEST_F(NurbsForMusicians, TheCubicIsNearlyEvenAndTheCircleIsEven) {
  const auto spread = [](const std::vector<float>& samples) {
    double low = 1000, high = -1000;
    for (int i = 10; i <= 390; ++i) {
      const double level = level_db(samples, i / 100.0);
      low = std::min(low, level);
      high = std::max(high, level);
    }
    return high - low;
  };
  const double cubic = spread(sound("3-cubic"));
  EXPECT_LT(cubic, 0.0024);
  EXPECT_GT(cubic, 0.0015);
  says("within 0.0024 dB");
  EXPECT_LT(spread(sound("7-arc")), 0.0001);
  says("within 0.0001 dB");
}

TEST_F(NurbsForMusicians, FourTonesHaveTheSharesOfBernstein) {
  const auto samples = sound("4-bernstein");
  const auto shares = [&](double at_s) {
    std::vector<double> amplitudes;
    double sum = 0;
    for (const double ratio : {1.0, 1.25, 1.5, 2.0}) {
      amplitudes.push_back(amplitude(samples, kRootHz * ratio, at_s));
      sum += amplitudes.back();
    }
    for (double& x : amplitudes) x /= sum;
    return amplitudes;
  };
  const auto third = shares(4.0 / 3), half = shares(2);
  EXPECT_NEAR(third[1], 4.0 / 9, 0.002);
  const double at_half[] = {1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(half[std::size_t(i)], at_half[i], 0.002);
  const double loudest = amplitude(samples, kRootHz * 1.25, 4.0 / 3);
  for (double at_s = 0.2; at_s < 3.9; at_s += 0.1) {
    const double there = amplitude(samples, kRootHz * 1.25, at_s);
    if (std::abs(at_s - 4.0 / 3) > 0.2) {
      EXPECT_LT(there, 0.99 * loudest) << at_s;
    }
  }
  says("with a share of 4/9; half-way the shares are 1/8, 3/8, 3/8, 1/8");
}

TEST_F(NurbsForMusicians, TheSharesTogetherStandStill) {
  const auto done =
      run("grep -v ^ratio examples/musicians/4-bernstein.toml >one.toml; build/release/bin/"
          "knotwave-render one.toml examples/musicians/one-note.mid -o out/one.wav");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto samples = sound("one");
  for (int i = 10; i <= 390; ++i) {
    EXPECT_NEAR(level_db(samples, i / 100.0), level_db(samples, 2), 0.0001) << i;
  }
  const auto lines =
      *base::read_file(KNOTWAVE_SOURCE_DIR "/examples/musicians/4-bernstein.toml", 1 << 20);
  const std::regex ratio("\nratio");
  EXPECT_EQ(std::distance(std::sregex_iterator(lines.begin(), lines.end(), ratio), {}), 3);
  says("the three lines with `ratio`");
}

TEST_F(NurbsForMusicians, TheSurfaceWalksFromSoftToReedWithoutSteps) {
  const auto samples = sound("5-surface");
  const auto fifth_db = [&](double at_s) {
    return decibels(amplitude(samples, 5 * kRootHz, at_s) / amplitude(samples, kRootHz, at_s));
  };
  EXPECT_NEAR(fifth_db(0.1), -55, 0.5);
  EXPECT_NEAR(fifth_db(3.9), 0, 0.5);
  says("rises from 55 dB below the fundamental to as loud as that");
  double low = 1000, high = -1000, step = 0;
  for (int i = 11; i < 430; ++i) {  // windows of two periods of 110 Hz, half of it apart
    const double level = level_db(samples, i / 110.0, 2 / 110.0);
    step = std::max(step, std::abs(level - level_db(samples, (i + 1) / 110.0, 2 / 110.0)));
    low = std::min(low, level);
    high = std::max(high, level);
  }
  EXPECT_NEAR(high - low, 1, 0.1);
  EXPECT_LT(step, 0.01);
  says("moves by 1 dB");
  says("it changes by less than 0.01 dB");
}

TEST_F(NurbsForMusicians, AMovedPointActsOnFourSpansAndNoSampleElse) {
  const auto still = sound("6-spline"), moved = sound("6-spline-moved");
  ASSERT_EQ(still.size(), moved.size());
  std::size_t first = still.size(), last = 0;
  for (std::size_t i = 0; i < still.size(); ++i) {
    if (still[i] == moved[i]) continue;
    first = std::min(first, i);
    last = i;
  }
  EXPECT_GE(first, 48000u);
  EXPECT_LE(last, 3 * 48000u);
  EXPECT_LT(first, 48000u * 1.1) << "and it does act there";
  EXPECT_GT(last, 48000u * 2.9);
  says("Before 1 second and after 3 the two files are the same, sample for sample.");
  EXPECT_NEAR(level_db(moved, 2) - level_db(still, 2), 11.3, 0.1);
  says("At 2 seconds the second sound is 11.3 dB louder.");
}

TEST_F(NurbsForMusicians, CrowdedKnotsMakeTheFirstSwellsFiveTimesAsQuick) {
  const auto slow = sound("6-spline-moved"), quick = sound("7-knots");
  const double long_s = 4.0 / 110, short_s = 2.0 / 110;
  const double peak = level_db(quick, 0.2, short_s);
  EXPECT_NEAR(peak, level_db(slow, 1, long_s), 0.05);
  for (const double beside_s : {-0.04, -0.03, 0.03, 0.04}) {
    EXPECT_LT(level_db(quick, 0.2 + beside_s, short_s), peak - 0.3) << "a swell stands there";
  }
  for (const double before_s : {0.03, 0.05, 0.08}) {
    EXPECT_NEAR(level_db(quick, 0.2 - before_s, short_s), level_db(slow, 1 - 5 * before_s, 0.1),
                0.2);
  }
  says("the second swell, which stood at 1 s, is at 0.2 s, and as loud");
}

TEST_F(NurbsForMusicians, WeightsMakeTheDecayStraight) {
  const auto ring = sound("7-decay"), plain = sound("7-plain");
  const auto level = [](const std::vector<float>& samples, double at_s) {
    return level_db(samples, at_s, 1.0 / 55);  // four periods
  };
  for (double at_s = 0.25; at_s < 2.9; at_s += 0.25) {
    EXPECT_NEAR(level_db(ring, at_s) - level_db(ring, at_s + 1), 15, 0.005) << at_s;
  }
  says("The first sound falls by 15.00 dB each second, from its start to -60 dB.");
  EXPECT_NEAR(level(plain, 2) - level(ring, 2), 11.25, 0.05);
  says("half-way it is 11.2 dB too loud");
  EXPECT_NEAR(level(ring, 0.05) - level(ring, 3.98), 15 * (3.98 - 0.05), 0.01);
  EXPECT_NEAR(level(plain, 3.49) - level(plain, 3.99), 16, 0.5);
  EXPECT_NEAR(level(ring, 3.49) - level(ring, 3.99), 7.5, 0.01);
  says("16 dB in the last half second, where the first falls by 7.5");
}

}  // namespace

// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/sound_file.h"

#include "io/wav_bytes.h"
#include "support/program.h"

namespace knotwave::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SoundReader : public testing::Test {
 protected:
  std::string write(const WavBytes& bytes, const std::string& name = "x.wav") {
    const std::string path = folder_.file(name);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return path;
  }
  support::ScratchFolder folder_;
};

std::vector<std::uint64_t> ramp(int count) {
  std::vector<std::uint64_t> words;
  for (int i = 0; i < count; ++i) words.push_back(static_cast<std::uint64_t>(i & 0x7FFF));
  return words;
}

TEST_F(SoundReader, IntegersOfEveryWidthBecomeFractionsOfFullScale) {
  const struct {
    int bits;
    std::vector<std::uint64_t> words;
  } cases[] = {{8, {0, 64, 128, 192}},
               {16, {0x8000, 0xC000, 0, 0x4000}},
               {24, {0x800000, 0xC00000, 0, 0x400000}},
               {32, {0x80000000, 0xC0000000, 0, 0x40000000}}};
  for (const auto& c : cases) {
    const auto sound = read_sound(write(wav_file({1, c.bits, 2, 48000}, c.words)));
    ASSERT_TRUE(sound.has_value()) << sound.error().to_string();
    EXPECT_EQ(sound->rate_hz, 48000);
    EXPECT_EQ(sound->channels, 2);
    EXPECT_EQ(sound->frames, 2);
    EXPECT_THAT(sound->samples, ElementsAre(-1.0f, -0.5f, 0.0f, 0.5f)) << c.bits << " bits";
    EXPECT_TRUE(sound->warnings.empty());
  }
}

TEST_F(SoundReader, FloatsAreReadAsTheyAre) {
  const auto sound =
      read_sound(write(wav_file({3, 32}, {float_bits(0.1f), float_bits(-1.5f), float_bits(999)})));
  EXPECT_THAT(sound->samples, ElementsAre(0.1f, -1.5f, 999.0f));
}

TEST_F(SoundReader, ASampleThatIsNotFiniteIsNamed) {
  const auto nan = read_sound(
      write(wav_file({3, 32, 2}, {0, 0, 0, float_bits(std::numeric_limits<float>::quiet_NaN())})));
  ASSERT_FALSE(nan.has_value());
  EXPECT_EQ(nan.error().code, ErrorCode::not_finite);
  EXPECT_EQ(nan.error().message, "frame 1 of channel 2 is not a number");
  const auto inf = read_sound(
      write(wav_file({3, 32}, {0, float_bits(-std::numeric_limits<float>::infinity())})));
  EXPECT_EQ(inf.error().message, "frame 1 of channel 1 is infinite");
}

TEST_F(SoundReader, ASampleBeyondTheLimitIsNamed) {
  const auto loud = read_sound(write(wav_file({3, 32}, {0, 0, float_bits(1001)})));
  ASSERT_FALSE(loud.has_value());
  EXPECT_EQ(loud.error().code, ErrorCode::value_out_of_range);
  EXPECT_THAT(loud.error().message, HasSubstr("frame 2 of channel 1 is 1001"));
}

TEST_F(SoundReader, LimitsAreKept) {
  const std::string path = write(wav_file({1, 16, 3}, ramp(300)));
  EXPECT_EQ(read_sound(path, {.max_frames = 99}).error().code, ErrorCode::file_too_large);
  EXPECT_TRUE(read_sound(path, {.max_frames = 100}).has_value());
  EXPECT_EQ(read_sound(path, {.max_channels = 2}).error().code, ErrorCode::value_out_of_range);
}

TEST_F(SoundReader, MissingFoldersAndEmptyFilesAreTold) {
  EXPECT_EQ(read_sound(folder_.file("none.wav")).error().code, ErrorCode::file_not_found);
  EXPECT_EQ(read_sound(folder_.path()).error().code, ErrorCode::io_failed);
  EXPECT_EQ(read_sound("/dev/zero").error().code, ErrorCode::io_failed);
  EXPECT_EQ(read_sound(write({})).error().code, ErrorCode::unsupported_format);
  EXPECT_EQ(read_sound(write(wav_file({}, {}))).error().message, "the file has no frames");
}

TEST_F(SoundReader, AFileCutShortIsReadWithAWarning) {
  WavBytes bytes = wav_file({1, 16}, ramp(100));
  bytes.resize(bytes.size() - 50);
  const auto sound = read_sound(write(bytes));
  ASSERT_TRUE(sound.has_value());
  EXPECT_EQ(sound->frames, 75);
  EXPECT_THAT(sound->warnings, ElementsAre("chunk 'data' says it has 200 bytes, 150 are there"));
}

WavBytes clm(const std::string& text) {
  return wav_chunk("clm ", WavBytes(text.begin(), text.end()));
}

TEST_F(SoundReader, AClmTableIsCutByItsChunk) {
  const auto cycles =
      read_cycles(write(wav_file({1, 16}, ramp(1024), clm("<!>256 10000000 wavetable (test)"))));
  ASSERT_TRUE(cycles.has_value()) << cycles.error().to_string();
  EXPECT_EQ(cycles->frame, 256);
  EXPECT_EQ(cycles->rows, 4);
  EXPECT_EQ(cycles->samples[300], 300.0f / 32768);
  EXPECT_TRUE(cycles->warnings.empty());
}

TEST_F(SoundReader, AClmChunkWithoutSenseIsNotUsed) {
  for (const char* text : {"<!>0", "<!>99999999999999999999", "2048", "<!>x", "<!>-4"}) {
    const auto cycles = read_cycles(write(wav_file({1, 16}, ramp(512), clm(text))));
    ASSERT_TRUE(cycles.has_value()) << text;
    EXPECT_EQ(cycles->frame, 512) << text;
    EXPECT_EQ(cycles->warnings.size(), 1u) << text;
  }
}

TEST_F(SoundReader, UntaggedFilesAreOneCycleUpTo8192FramesThenRowsOf2048) {
  EXPECT_EQ(read_cycles(write(wav_file({1, 16}, ramp(600))))->frame, 600);
  EXPECT_EQ(read_cycles(write(wav_file({1, 16}, ramp(8192))))->rows, 1);
  const auto rows = read_cycles(write(wav_file({1, 16}, ramp(10240))));
  EXPECT_EQ(rows->frame, 2048);
  EXPECT_EQ(rows->rows, 5);
  const auto unclear = read_cycles(write(wav_file({1, 16}, ramp(10241))));
  ASSERT_FALSE(unclear.has_value());
  EXPECT_EQ(unclear.error().code, ErrorCode::value_out_of_range);
  EXPECT_THAT(unclear.error().message, HasSubstr("give the frame"));
}

TEST_F(SoundReader, TheAskedFrameCutsTheFileAndTheTailIsToldOf) {
  const auto cycles = read_cycles(write(wav_file({1, 16}, ramp(1000))), 300);
  EXPECT_EQ(cycles->rows, 3);
  EXPECT_THAT(cycles->warnings,
              ElementsAre("the last 100 frames are no whole cycle and are left out"));
  EXPECT_EQ(read_cycles(write(wav_file({1, 16}, ramp(100))), 300).error().code,
            ErrorCode::value_out_of_range);
  EXPECT_EQ(read_cycles(write(wav_file({1, 16}, ramp(3)))).error().code,
            ErrorCode::value_out_of_range);
}

TEST_F(SoundReader, CyclesTakeTheFirstChannel) {
  const auto cycles = read_cycles(write(wav_file({1, 16, 2}, ramp(16))));
  EXPECT_EQ(cycles->frame, 8);
  EXPECT_EQ(cycles->samples[3], 6.0f / 32768);
  EXPECT_THAT(cycles->warnings, ElementsAre(HasSubstr("first of 2 channels")));
}

}  // namespace
}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include "knotwave/base/random.h"
#include "knotwave/base/sha256.h"
#include "knotwave/io/sound_file.h"

#include "support/program.h"
#include "support/seed.h"

namespace knotwave::io {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::string file_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}
std::string sha256_of_file(const std::string& path) {
  const std::string bytes = file_bytes(path);
  base::Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes)));
  return hash.finish_hex();
}

std::vector<float> noise(std::size_t count, std::uint64_t seed, double level = 0.5) {
  const base::RandomStream stream{.seed = seed, .voice = 0, .purpose = base::kRandomNoise};
  std::vector<float> samples;
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(static_cast<float>(level * stream.bipolar(i)));
  }
  return samples;
}

class SoundWriterTest : public testing::Test {
 protected:
  /// Writes in pieces of `piece` frames and finishes.
  void write(const SoundWriteConfig& config, const std::vector<float>& samples,
             std::size_t piece = 1000) {
    auto writer = SoundWriter::create(config);
    ASSERT_TRUE(writer.has_value()) << writer.error().to_string();
    const std::size_t step = piece * static_cast<std::size_t>(config.channels);
    for (std::size_t at = 0; at < samples.size(); at += step) {
      const auto part = std::span(samples).subspan(at, std::min(step, samples.size() - at));
      const auto good = writer->write(part);
      ASSERT_TRUE(good.has_value()) << good.error().to_string();
    }
    const auto done = writer->finish();
    ASSERT_TRUE(done.has_value()) << done.error().to_string();
    clipped_ = writer->clipped();
    EXPECT_EQ(writer->file_sha256(), sha256_of_file(config.path));
  }
  std::size_t files() const {
    const fs::directory_iterator folder(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(folder), end(folder)));
  }

  support::ScratchFolder folder_;
  std::int64_t clipped_ = 0;
};

TEST_F(SoundWriterTest, FloatsComeBackToTheBit) {
  const auto samples = noise(4000, support::test_seed());
  const std::string path = folder_.file("x.wav");
  write({.path = path, .rate_hz = 44100, .format = SampleFormat::float32}, samples);
  const auto sound = read_sound(path);
  EXPECT_EQ(sound->samples, samples);
  EXPECT_EQ(sound->rate_hz, 44100);
  EXPECT_EQ(sound->channels, 2);
  EXPECT_EQ(file_bytes(path).find("PEAK"), std::string::npos) << "a PEAK chunk holds the time";
}

TEST_F(SoundWriterTest, TheBytesAreFrozen) {
  const auto samples = noise(2000, 1);
  const struct {
    SampleFormat format;
    const char* sha256;
  } cases[] = {
      {SampleFormat::pcm16, "bdf3a57c628a2f6106081b24c82f54aed5c54f05f65111dd7093a215bcab33c1"},
      {SampleFormat::pcm24, "4af6ad773afd854660651c54a60e674bd08fd09f36b6387f996dcbbd4443ca89"},
      {SampleFormat::float32, "98925828c6bd908c3d3cbf8849e5c2cab667393e90948b5aa179ef0b1353d82f"},
  };
  for (const auto& c : cases) {
    const std::string path = folder_.file("x.wav");
    write({.path = path, .format = c.format}, samples);
    EXPECT_EQ(sha256_of_file(path), c.sha256);
  }
}

TEST_F(SoundWriterTest, AnySplitGivesTheSameBytes) {
  const auto samples = noise(2 * 700, support::test_seed());
  for (const char* name : {"x.wav", "x.flac"}) {
    const std::string path = folder_.file(name);
    write({.path = path, .format = SampleFormat::pcm16}, samples, 700);
    const std::string whole = file_bytes(path);
    for (const std::size_t piece : {1u, 7u, 64u, 699u}) {
      write({.path = path, .format = SampleFormat::pcm16}, samples, piece);
      EXPECT_EQ(file_bytes(path), whole) << name << " in pieces of " << piece;
    }
  }
}

/// Mean and standard deviation of the error in LSB, over samples that cover half the range.
std::pair<double, double> error_in_lsb(const Sound& sound, const std::vector<float>& samples,
                                       double scale) {
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error =
        (static_cast<double>(sound.samples[i]) - static_cast<double>(samples[i])) * scale;
    sum += error;
    squares += error * error;
  }
  const double mean = sum / static_cast<double>(samples.size());
  return {mean, std::sqrt(squares / static_cast<double>(samples.size()) - mean * mean)};
}

// Rounding has variance 1/12 LSB², triangular dither of +-1 LSB has 1/6: half an LSB together. For
// 200,000 samples the mean's own deviation is 0.5 / sqrt(200000) = 0.0011; the bounds are 5 of it.
TEST_F(SoundWriterTest, DitherMakesTheErrorHalfAnLsbWithoutMean) {
  const auto samples = noise(200'000, support::test_seed());
  const std::string path = folder_.file("x.wav");
  write({.path = path, .format = SampleFormat::pcm16}, samples);
  const auto [mean, deviation] = error_in_lsb(*read_sound(path), samples, 32768);
  EXPECT_NEAR(mean, 0, 0.0056);
  EXPECT_NEAR(deviation, 0.5, 0.005);
}

TEST_F(SoundWriterTest, DitherKeepsAToneBelowOneLsb) {
  // A constant of 0.3 LSB would vanish in rounding; with dither its mean stays.
  const std::vector<float> samples(200'000, 0.3f / 32768);
  const std::string path = folder_.file("x.wav");
  write({.path = path, .format = SampleFormat::pcm16}, samples);
  const auto [mean, deviation] = error_in_lsb(*read_sound(path), samples, 32768);
  EXPECT_NEAR(mean, 0, 0.0056);
  EXPECT_NEAR(deviation, 0.5, 0.005);
}

TEST_F(SoundWriterTest, ChannelsAreDitheredApart) {
  const std::string path = folder_.file("x.wav");
  write({.path = path, .format = SampleFormat::pcm16}, std::vector<float>(2000, 0.0f));
  const auto sound = read_sound(path);
  int equal = 0;
  for (std::size_t i = 0; i < 2000; i += 2) equal += sound->samples[i] == sound->samples[i + 1];
  EXPECT_LT(equal, 700) << "independent triangular dither agrees in 59 of 100 frames at most";
}

TEST_F(SoundWriterTest, FullScaleIsClippedAndCounted) {
  const std::string path = folder_.file("x.wav");
  write({.path = path, .channels = 1, .format = SampleFormat::pcm24},
        {1.0f, -1.0f, 1.5f, -2.0f, 1e30f, 0.5f});
  EXPECT_EQ(clipped_, 3);
  const auto sound = read_sound(path);
  const float top = 1 - 0x1p-23f;
  EXPECT_NEAR(sound->samples[0], top, 0x1p-22f);
  EXPECT_NEAR(sound->samples[1], -1.0f, 0x1p-22f);
  EXPECT_EQ(sound->samples[2], top);
  EXPECT_EQ(sound->samples[3], -1.0f);
  EXPECT_EQ(sound->samples[4], top);
}

TEST_F(SoundWriterTest, FloatFilesAreNotClipped) {
  const std::string path = folder_.file("x.wav");
  write({.path = path, .channels = 1, .format = SampleFormat::float32}, {1.5f, -2.0f});
  EXPECT_EQ(clipped_, 0);
  EXPECT_EQ(read_sound(path)->samples, (std::vector<float>{1.5f, -2.0f}));
}

TEST_F(SoundWriterTest, FlacHoldsWhatWavHolds) {
  const auto samples = noise(20000, support::test_seed());
  for (const SampleFormat format : {SampleFormat::pcm16, SampleFormat::pcm24}) {
    const std::string wav = folder_.file("x.wav");
    const std::string flac = folder_.file("x.FLAC");
    write({.path = wav, .format = format}, samples);
    write({.path = flac, .format = format}, samples);
    EXPECT_EQ(read_sound(flac)->samples, read_sound(wav)->samples);
    EXPECT_EQ(file_bytes(flac).substr(0, 4), "fLaC");
  }
}

TEST_F(SoundWriterTest, Rf64IsChosenFromTheLengthAnnounced) {
  // 2 channels of 3 bytes, and 1024 bytes kept for the header: (2^32 - 1 - 1024) / 6 frames.
  const std::string path = folder_.file("x.wav");
  write({.path = path, .expected_frames = 715'827'711}, noise(100, 1));
  EXPECT_EQ(file_bytes(path).substr(0, 4), "RIFF");
  write({.path = path, .expected_frames = 715'827'712}, noise(100, 1));
  EXPECT_EQ(file_bytes(path).substr(0, 4), "RF64");
  EXPECT_EQ(read_sound(path)->frames, 50);
}

TEST_F(SoundWriterTest, ASampleThatIsNotFiniteIsRefusedWithItsPlace) {
  auto writer = SoundWriter::create({.path = folder_.file("x.wav")});
  ASSERT_TRUE(writer->write(noise(200, 1)).has_value());
  const auto bad = writer->write(std::vector<float>{0, 0, 0, std::nanf("")});
  ASSERT_FALSE(bad.has_value());
  EXPECT_EQ(bad.error().code, ErrorCode::not_finite);
  EXPECT_THAT(bad.error().message, HasSubstr("frame 101 of channel 2"));
}

TEST_F(SoundWriterTest, FormatsThatCannotBeAreRefusedBeforeAnyFileIsMade) {
  const struct {
    SoundWriteConfig config;
    const char* text;
  } cases[] = {
      {{.path = folder_.file("x.flac"), .format = SampleFormat::float32}, "not 32-bit float"},
      {{.path = folder_.file("x.flac"), .rate_hz = 768000}, "768000 Hz: FLAC holds rates to"},
      {{.path = folder_.file("x.flac"), .rate_hz = 655351}, "655351 Hz: FLAC holds rates to"},
      {{.path = folder_.file("x.flac"), .rate_hz = 65536}, "65536 Hz: FLAC holds rates to"},
      {{.path = folder_.file("x.flac"), .channels = 9}, "9 channels"},
      {{.path = folder_.file("x.mp3")}, "neither in .wav nor in .flac"},
      {{.path = folder_.file("x")}, "neither in .wav nor in .flac"},
  };
  for (const auto& c : cases) {
    const auto writer = SoundWriter::create(c.config);
    ASSERT_FALSE(writer.has_value()) << c.text;
    EXPECT_EQ(writer.error().code, ErrorCode::unsupported_format);
    EXPECT_THAT(writer.error().message, HasSubstr(c.text));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(SoundWriterTest, FlacIsWrittenAtItsHighestRates) {
  for (const int rate_hz : {65535, 65540, 192000, 384000, 655350}) {
    const std::string path = folder_.file("x.flac");
    write({.path = path, .rate_hz = rate_hz}, noise(2000, 1));
    const auto sound = read_sound(path);
    EXPECT_EQ(sound->rate_hz, rate_hz);
    EXPECT_EQ(sound->frames, 1000);
  }
}

TEST_F(SoundWriterTest, AFileWithoutFramesHasItsHeader) {
  for (const char* name : {"x.wav", "x.flac"}) {
    const std::string path = folder_.file(name);
    write({.path = path, .rate_hz = 44100}, {});
    const auto sound = read_sound(path);
    ASSERT_FALSE(sound.has_value());
    EXPECT_THAT(sound.error().message, HasSubstr("no frame")) << name;
  }
  // A FLAC begins with its mark and a STREAMINFO of 34 bytes (RFC 9639, section 8.2) that holds the
  // rate in 20 bits, channels - 1 in 3, bits - 1 in 5, 36 bits of length, and the MD5 of no bytes.
  const std::string flac = file_bytes(folder_.file("x.flac"));
  ASSERT_GE(flac.size(), 42u);
  EXPECT_EQ(flac.substr(0, 8), std::string("fLaC\0\0\0\x22", 8));
  EXPECT_EQ(flac.substr(18, 8), std::string("\x0a\xc4\x43\x70\0\0\0\0", 8));
  EXPECT_EQ(flac.substr(26, 4), "\xd4\x1d\x8c\xd9");
}

TEST_F(SoundWriterTest, WithoutFinishTheOldFileIsKeptAndNothingElse) {
  const std::string path = folder_.file("x.wav");
  std::ofstream(path) << "old";
  {
    auto writer = SoundWriter::create({.path = path});
    ASSERT_TRUE(writer->write(noise(20000, 1)).has_value());
    EXPECT_EQ(files(), 2u);
  }
  EXPECT_EQ(file_bytes(path), "old");
  EXPECT_EQ(files(), 1u);
}

/// Writes until something fails; the error.
Error error_of_a_long_write(const std::string& path, SampleFormat format) {
  auto writer = SoundWriter::create({.path = path, .format = format});
  if (!writer) return writer.error();
  const auto block = noise(2000, 1);
  for (int i = 0; i < 1000; ++i) {
    if (const auto good = writer->write(block); !good) return good.error();
  }
  const auto done = writer->finish();
  return done ? Error{} : done.error();
}

TEST_F(SoundWriterTest, AFullDiskIsToldAndTheOldFileIsKept) {
  if (::geteuid() != 0) GTEST_SKIP() << "mounting a small disk needs root";
  const std::string disk = folder_.file("disk");
  fs::create_directory(disk);
  ASSERT_EQ(::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k"), 0) << std::strerror(errno);
  for (const SampleFormat format : {SampleFormat::pcm16, SampleFormat::float32}) {
    const std::string path = disk + "/x.wav";
    std::ofstream(path) << "old";
    const Error error = error_of_a_long_write(path, format);
    EXPECT_EQ(error.code, ErrorCode::disk_full) << error.to_string();
    EXPECT_THAT(error.message, HasSubstr(path));
    EXPECT_EQ(file_bytes(path), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(disk), {}), 1);
  }
  EXPECT_EQ(::umount(disk.c_str()), 0);
}

TEST_F(SoundWriterTest, AFileSizeLimitIsToldAndNothingIsLeft) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_action = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100'000, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const Error error = error_of_a_long_write(folder_.file("x.wav"), SampleFormat::pcm24);
  const Error flac = error_of_a_long_write(folder_.file("x.flac"), SampleFormat::pcm24);
  ::setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_action);
  EXPECT_EQ(error.code, ErrorCode::io_failed);
  EXPECT_THAT(error.message, HasSubstr("File too large"));
  EXPECT_EQ(flac.code, ErrorCode::io_failed);
  EXPECT_EQ(files(), 0u);
}

TEST_F(SoundWriterTest, AMissingFolderIsNamed) {
  const auto writer = SoundWriter::create({.path = folder_.file("no/such/x.wav")});
  ASSERT_FALSE(writer.has_value());
  EXPECT_THAT(writer.error().message, HasSubstr(folder_.file("no/such")));
}

}  // namespace
}  // namespace knotwave::io

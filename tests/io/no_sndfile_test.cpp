// SPDX-License-Identifier: MIT
// Built without libsndfile: sound files are refused by name, the raw pipe still works.
#include <gtest/gtest.h>

#include "knotwave/io/sound_file.h"

namespace knotwave::io {
namespace {

TEST(WithoutSndfile, SoundFilesAreUnsupported) {
  EXPECT_EQ(read_sound("x.wav").error().code, ErrorCode::unsupported);
  EXPECT_EQ(read_cycles("x.wav").error().code, ErrorCode::unsupported);
  EXPECT_EQ(SoundWriter::create({.path = testing::TempDir() + "x.wav"}).error().code,
            ErrorCode::unsupported);
}

TEST(WithoutSndfile, ThePipeWorks) { EXPECT_TRUE(SoundWriter::create({.path = "-"}).has_value()); }

}  // namespace
}  // namespace knotwave::io

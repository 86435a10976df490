// SPDX-License-Identifier: MIT
#include "knotwave/base/sha256.h"

#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/base/random.h"

#include "sha256_blocks.h"
#include "support/program.h"
#include "support/seed.h"

namespace knotwave::base {
namespace {

std::string digest(std::string_view text) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(text)));
  return hash.finish_hex();
}

// FIPS 180-4 example values (also RFC 6234, section 8.5).
TEST(Sha256, GivesThePublishedAnswers) {
  EXPECT_EQ(digest(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(digest(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, AnySplitGivesTheSameDigest) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += static_cast<char>(i * 7);
  const std::string whole = digest(text);
  for (std::size_t step = 1; step <= 130; ++step) {
    Sha256 hash;
    for (std::size_t i = 0; i < text.size(); i += step) {
      hash.update(std::as_bytes(std::span(text).subspan(i, std::min(step, text.size() - i))));
    }
    ASSERT_EQ(hash.finish_hex(), whole) << step;
  }
}

TEST(Sha256, AgreesWithTheSystemsToolForEveryLengthAroundABlock) {
  const support::ScratchFolder folder;
  for (const std::size_t length : {55u, 56u, 57u, 63u, 64u, 65u, 119u, 120u, 128u, 5000u}) {
    const std::string text(length, 'k');
    const std::string path = folder.file("data");
    ASSERT_TRUE(write_file(path, text));
    const support::ProgramRun run = support::run_program({"/usr/bin/sha256sum", path});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out.substr(0, 64), digest(text)) << length;
  }
}

TEST(Sha256, TheProcessorsInstructionsGiveWhatPlainCodeGives) {
  std::vector<std::uint8_t> data(64 * 100);
  const RandomStream stream{.seed = support::test_seed()};
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(stream.bits(i));
  for (const std::size_t blocks : {0u, 1u, 2u, 7u, 100u}) {
    Sha256State state{1, 2, 3, 4, 5, 6, 7, 8}, portable = state;
    sha256_blocks(state, data.data(), blocks);
    sha256_blocks_portable(portable, data.data(), blocks);
    EXPECT_EQ(state, portable) << blocks;
  }
}

TEST(Sha256, FloatsCountAsLittleEndianWords) {
  const std::vector<float> samples = {1.0f, -0.5f};
  Sha256 hash;
  hash.update(samples);
  EXPECT_EQ(hash.finish_hex(), digest(std::string_view("\0\0\x80\x3f\0\0\0\xbf", 8)));
}

}  // namespace
}  // namespace knotwave::base

// SPDX-License-Identifier: MIT
#include "knotwave/base/random.h"

#include <gtest/gtest.h>

namespace knotwave::base {
namespace {

using Block = std::array<std::uint32_t, 4>;

// Known answers for philox4x32 with 10 rounds, from the file kat_vectors of the Random123 library
// that accompanies the paper.
TEST(Philox, GivesThePublishedAnswers) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, EveryPartOfTheKeyMatters) {
  const RandomStream stream{1, 2, 3};
  const std::uint64_t bits = stream.bits(7);
  EXPECT_NE((RandomStream{2, 2, 3}.bits(7)), bits);
  EXPECT_NE((RandomStream{1 + (std::uint64_t{1} << 32), 2, 3}.bits(7)), bits);
  EXPECT_NE((RandomStream{1, 3, 3}.bits(7)), bits);
  EXPECT_NE((RandomStream{1, 2, 4}.bits(7)), bits);
  EXPECT_NE(stream.bits(8), bits);
  EXPECT_NE(stream.bits(7 + (std::uint64_t{1} << 32)), bits);
  EXPECT_EQ((RandomStream{1, 2, 3}.bits(7)), bits);
}

TEST(RandomStream, NumbersStayInTheirRangesWithTheRightMoments) {
  const RandomStream stream{42, 0, kRandomNoise};
  constexpr int kCount = 100000;
  double sum = 0;
  double squares = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double unit = stream.unit(i);
    const double bipolar = stream.bipolar(i);
    ASSERT_TRUE(unit >= 0 && unit < 1);
    ASSERT_TRUE(bipolar >= -1 && bipolar < 1);
    sum += bipolar;
    squares += bipolar * bipolar;
  }
  // Five standard deviations of the mean of a uniform distribution and of that of its squares.
  EXPECT_NEAR(sum / kCount, 0, 5 * 0.577 / 316);
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 5 * 0.298 / 316);
}

}  // namespace
}  // namespace knotwave::base

// SPDX-License-Identifier: MIT
// The private numbers of 4,096 bits, against quadruple precision and the laws of arithmetic.
#include "big_float.h"

#include <cmath>

#include <gtest/gtest.h>

#include "curves/random_curves.h"
#include "support/seed.h"

namespace knotwave::curves {
namespace {
using testing::Draws;
using Wide = __float128;

double random_double(Draws& draw, int reach) {
  const double x = std::ldexp(draw.between(-1, 1), draw.whole(-reach, reach));
  return draw.chance(0.1) ? std::ldexp(draw.chance(0.5) ? 1 : -1, draw.whole(-reach, reach)) : x;
}

/// A sum of doubles far apart: runs of ones and zeros, so carries and borrows run far.
BigFloat random_number(Draws& draw) {
  BigFloat sum;
  for (int i = draw.whole(1, 5); i > 0; --i) sum = sum + BigFloat(random_double(draw, 500));
  return sum;
}

Wide wide(DoubleDouble x) { return Wide(x.hi) + Wide(x.lo); }

TEST(BigFloat, RoundsSumsAndProductsOfDoublesAsQuadruplePrecisionHasThem) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(20'000); ++i) {
    Draws draw(seed, i);
    const double a = random_double(draw, 26), b = random_double(draw, 26);
    for (const auto& [got, want] : {std::pair{BigFloat(a) + b, Wide(a) + Wide(b)},
                                    {BigFloat(a) - b, Wide(a) - Wide(b)},
                                    {BigFloat(a) * b, Wide(a) * Wide(b)}}) {
      const Wide apart = wide(got.rounded()) - want, room = want * Wide(0x1p-100);
      ASSERT_TRUE(apart * apart <= room * room) << a << ", " << b;
      ASSERT_EQ(got.sign(), want > 0 ? 1 : want < 0 ? -1 : 0);
    }
  }
}

TEST(BigFloat, KeepsTheLawsOfArithmetic) {
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < support::test_count(5'000); ++i) {
    Draws draw(seed + 1, i);
    const BigFloat a = random_number(draw), b = random_number(draw), c = random_number(draw);
    EXPECT_EQ((a + b - b - a).sign(), 0);
    EXPECT_EQ((a * b - b * a).sign(), 0);
    EXPECT_EQ(((a + b) * (a - b) - (a * a - b * b)).sign(), 0);
    EXPECT_EQ((a * (b + c) - a * b - a * c).sign(), 0);
    EXPECT_EQ((a - b).sign(), -(b - a).sign());
    EXPECT_EQ((a * b).sign(), a.sign() * b.sign());
  }
}

TEST(BigFloat, CarriesAndBorrowsRunThroughAllLimbs) {
  for (const int far : {1, 31, 32, 33, 64, 1000, 4000}) {
    const BigFloat one = 1.0, least = BigFloat::power_of_two(-far);
    const BigFloat below = one - least;
    EXPECT_EQ((below - one).sign(), -1);
    EXPECT_EQ((below + least - one).sign(), 0);
    EXPECT_EQ(below.magnitude(), 1 - 1 * (far > 0));
    EXPECT_EQ((one + least - one - least).sign(), 0);
    EXPECT_EQ((below * below - one + least + least - least * least).sign(), far <= 2000 ? 0 : -1);
  }
}

TEST(BigFloat, DropsWhatIsBeyondItsLimbs) {
  const BigFloat one = 1.0, tiny = BigFloat::power_of_two(-6000);
  EXPECT_EQ((one + tiny - one).sign(), 0);
  EXPECT_EQ((tiny + tiny - tiny).sign(), 1);
  EXPECT_EQ(tiny.rounded().hi, 0);
  EXPECT_EQ((one - tiny).sign(), 1);
}

TEST(BigFloat, RoundsByWholeLimbs) {
  const DoubleDouble x(1.0, 0x1p-70);
  const BigFloat scaled = BigFloat(x) * BigFloat::power_of_two(96);
  EXPECT_EQ(scaled.rounded(3).hi, 1.0);
  EXPECT_EQ(scaled.rounded(3).lo, 0x1p-70);
  EXPECT_EQ(BigFloat(-5e-324).rounded().hi, 0) << "below 2^-990 or so";
  EXPECT_EQ((BigFloat(-5e-324) * BigFloat::power_of_two(1074) + 1.0).sign(), 0);
}

}  // namespace
}  // namespace knotwave::curves

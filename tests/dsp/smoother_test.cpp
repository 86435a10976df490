// SPDX-License-Identifier: MIT
#include "knotwave/dsp/smoother.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_count.h"
#include "support/block_sweep.h"
#include "support/seed.h"

namespace {

using knotwave::dsp::Smoother;

struct Target {
  std::int64_t sample;
  double value;
};

// Random targets in 0..1, from a burst at one sample to rest between them.
std::vector<Target> random_targets(std::uint64_t seed, int count, int length) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Target> targets;
  std::int64_t sample = 3;
  for (int i = 0; i < count; ++i) {
    targets.push_back({sample, unit(random)});
    const double gap = unit(random);
    sample += static_cast<std::int64_t>(1.5 * length * gap * gap * gap);
  }
  return targets;
}

std::vector<double> played(const std::vector<Target>& targets, int length, std::int64_t samples,
                           double start = 0.5) {
  Smoother smoother;
  smoother.reset(start, length);
  std::vector<double> out(static_cast<std::size_t>(samples));
  std::size_t next = 0;
  for (std::int64_t n = 0; n < samples; ++n) {
    for (; next < targets.size() && targets[next].sample == n; ++next) {
      smoother.set_target(targets[next].value, n);
    }
    out[static_cast<std::size_t>(n)] = smoother.value_at(n);
  }
  return out;
}

TEST(Smoother, IsTheSmoothestStepFromRest) {
  Smoother smoother;
  smoother.reset(2, 100);
  smoother.set_target(5, 10);
  EXPECT_EQ(smoother.value_at(9), 2);
  EXPECT_EQ(smoother.value_at(10), 2);
  EXPECT_EQ(smoother.value_at(60), 3.5);
  for (int i = 0; i <= 100; ++i) {
    const double t = i / 100.0;
    const double step = t * t * t * (10 + t * (6 * t - 15));
    EXPECT_NEAR(smoother.value_at(10 + i), 2 + 3 * step, 1e-14);
  }
  EXPECT_EQ(smoother.value_at(110), 5);
  EXPECT_FALSE(smoother.is_still(109));
  EXPECT_TRUE(smoother.is_still(110));
  EXPECT_EQ(smoother.target(), 5);
}

TEST(Smoother, NeverLeavesTheRangeOfItsTargets) {
  const int length = 240;
  const auto seed = knotwave::support::test_seed();
  for (int run = 0; run < knotwave::support::test_count(50); ++run) {
    const auto targets = random_targets(seed + static_cast<std::uint64_t>(run), 60, length);
    double low = 0.5, high = 0.5;
    for (const Target& target : targets) {
      low = std::min(low, target.value);
      high = std::max(high, target.value);
    }
    const auto values = played(targets, length, targets.back().sample + 2 * length);
    for (const double value : values) {
      EXPECT_GE(value, low - 1e-15);
      EXPECT_LE(value, high + 1e-15);
    }
    EXPECT_EQ(values.back(), targets.back().value);
  }
}

TEST(Smoother, HasContinuousSlopeAndCurvatureWhateverTheTargetsDo) {
  // Third differences are bounded by the third derivative, 60 / length^3 a unit of each of at most
  // eight moves under way, one of them new: a jump of curvature would show as 5.8 / length^2.
  const int length = 4096;
  const auto targets = random_targets(knotwave::support::test_seed(), 100, length);
  const auto y = played(targets, length, targets.back().sample + 2 * length);
  const double bound = 60.0 * 8 / std::pow(length, 3);
  for (std::size_t i = 3; i < y.size(); ++i) {
    const double third = y[i] - 3 * y[i - 1] + 3 * y[i - 2] - y[i - 3];
    ASSERT_LE(std::abs(third), bound + 1e-14) << "sample " << i;
  }
  EXPECT_LT(bound, 5.8 / std::pow(length, 2) / 10);
}

TEST(Smoother, TargetsInABurstCountAsTheLastOfThem) {
  Smoother burst, single;
  burst.reset(0, 64);
  single.reset(0, 64);
  for (int i = 0; i < 100; ++i) burst.set_target(i, 5);
  single.set_target(99, 5);
  for (int n = 0; n < 80; ++n) EXPECT_EQ(burst.value_at(n), single.value_at(n));
}

TEST(Smoother, ATargetEverySampleArrivesWithinNineEighthsOfTheLength) {
  Smoother smoother;
  smoother.reset(0, 80);
  for (int n = 0; n < 500; ++n) smoother.set_target(std::sin(n * 0.1), n);
  EXPECT_TRUE(smoother.is_still(499 + 90));
  EXPECT_EQ(smoother.value_at(499 + 90), std::sin(499 * 0.1));
}

TEST(Smoother, BlockSizeDoesNotMatter) {
  const int length = 40;
  const auto targets = random_targets(11, 40, length);
  const auto samples = static_cast<std::size_t>(targets.back().sample + 2 * length);
  knotwave::support::expect_block_size_does_not_matter<double>(samples, [&] {
    Smoother smoother;
    smoother.reset(0.5, length);
    // As an engine does: a block is cut at the events in it.
    return [&, smoother, next = std::size_t{0}](std::size_t first, std::span<double> out) mutable {
      std::size_t done = 0;
      while (done < out.size()) {
        const auto here = static_cast<std::int64_t>(first + done);
        for (; next < targets.size() && targets[next].sample == here; ++next) {
          smoother.set_target(targets[next].value, here);
        }
        std::size_t end = out.size();
        if (next < targets.size()) {
          end = std::min(end, static_cast<std::size_t>(targets[next].sample) - first);
        }
        smoother.render(here, out.subspan(done, end - done));
        done = end;
      }
    };
  });
}

TEST(Smoother, NanIsIgnoredAndNothingAllocates) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Smoother smoother;
  smoother.reset(nan, 0);
  EXPECT_EQ(smoother.value_at(0), 0);
  smoother.reset(1, 10);
  smoother.set_target(nan, 5);
  EXPECT_EQ(smoother.value_at(20), 1);
  std::vector<float> out(100);
  EXPECT_EQ(knotwave::support::allocations_in([&] {
              smoother.set_target(0, 5);
              smoother.render(0, std::span<float>(out));
            }),
            0);
  EXPECT_EQ(out.front(), 1.0f);
  EXPECT_EQ(out.back(), 0.0f);
}

TEST(Smoother, AgreesAtEqualSecondsForAnyRate) {
  const auto at = [](double rate_hz, double seconds) {
    Smoother smoother;
    smoother.reset(0, static_cast<int>(0.02 * rate_hz));
    smoother.set_target(1, static_cast<std::int64_t>(0.01 * rate_hz));
    smoother.set_target(-1, static_cast<std::int64_t>(0.02 * rate_hz));
    return smoother.value_at(static_cast<std::int64_t>(seconds * rate_hz + 0.5));
  };
  for (int i = 0; i <= 50; ++i) {
    const double seconds = i * 0.001;  // whole samples at 48, 96 and 384 kHz
    EXPECT_NEAR(at(96000, seconds), at(48000, seconds), 1e-12);
    EXPECT_NEAR(at(384000, seconds), at(48000, seconds), 1e-12);
  }
}

}  // namespace

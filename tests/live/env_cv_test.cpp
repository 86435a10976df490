// SPDX-License-Identifier: MIT
// Control voltage of knotwave-env as another client of a JACK server captures it: the curve, the
// ramps in and out, and the high-pass that keeps loudspeakers safe.
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>

#include "env_process.h"
#include "live_clients.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"

namespace knotwave::io {
namespace {

constexpr double kRate = 48000;
constexpr double kTolerance = 0x1p-24;
constexpr std::size_t kMostFrames = 60 * 48000;

using Samples = std::vector<float>;

/// De Casteljau on points that are multiplied with their weights: a rational Bezier curve.
double rational_bezier(std::vector<double> points, std::vector<double> weights, double u) {
  for (std::size_t i = 0; i < points.size(); ++i) points[i] *= weights[i];
  for (std::size_t n = points.size() - 1; n > 0; --n) {
    for (std::size_t i = 0; i < n; ++i) {
      points[i] = (1 - u) * points[i] + u * points[i + 1];
      weights[i] = (1 - u) * weights[i] + u * weights[i + 1];
    }
  }
  return points[0] / weights[0];
}

/// De Boor on a clamped uniform quadratic of 5 points, whose knots are 0 0 0 1/3 2/3 1 1 1.
double quadratic(const std::array<double, 5>& points, double u) {
  constexpr std::array<double, 8> knots = {0, 0, 0, 1.0 / 3, 2.0 / 3, 1, 1, 1};
  std::size_t span = 2;
  while (span < 4 && u >= knots[span + 1]) ++span;
  std::array<double, 3> d = {points[span - 2], points[span - 1], points[span]};
  for (std::size_t level = 1; level <= 2; ++level) {
    for (std::size_t i = 2; i >= level; --i) {
      const std::size_t k = span - 2 + i;
      const double a = (u - knots[k]) / (knots[k + 3 - level] - knots[k]);
      d[i] = (1 - a) * d[i - 1] + a * d[i];
    }
  }
  return d[2];
}

double risen(double passed) {
  const double t = std::clamp(passed / (0.5 * kRate), 0.0, 1.0);
  return 3 * t * t - 2 * t * t * t;
}

class EnvVoltage : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(server_.runs()) << server_.log(); }
  static std::vector<std::string> words(bool direct) {
    std::vector<std::string> all = {"--midi-api", "jack",           "--audio-api",
                                    "jack",       "--audio-device", "capture"};
    if (direct) all.emplace_back("--cv");
    return all;
  }
  /// Until a channel's newest sample is within `near` of `value`; false after 20 s.
  static bool comes_to(const support::JackCapture& capture, std::size_t channel, double value,
                       double near) {
    const auto is_there = [&] {
      const Samples all = capture.channel(channel);
      return !all.empty() && std::abs(static_cast<double>(all.back()) - value) <= near;
    };
    return seconds_until(is_there, 20) < 20;
  }
  support::JackServer server_{256};
};

std::size_t first_that_differs(const Samples& samples, float value) {
  const auto at = std::find_if(samples.begin(), samples.end(), [=](float s) { return s != value; });
  return static_cast<std::size_t>(at - samples.begin());
}

TEST_F(EnvVoltage, WhatIsCapturedIsTheCurve) {
  support::JackCapture capture(std::size_t{2}, kMostFrames);
  EnvProcess env(R"(
format = 1
kind = "envelope"
[curves.swell]
degree = 2
points = [0, 1, 0.6, 0.1, 0]
[curves.pluck]
degree = 4
points = [1, 0.15962, 0.030761, 0.0058833, 0.001]
weights = [0.033544, 0.068924, 0.15018, 0.35327, 1]
[envelopes.swell]
curve = "swell"
seconds = 0.8
[envelopes.pluck]
curve = "pluck"
seconds = 1.25
[[outputs]]
from = "swell"
to = "cv"
range = [0, 8]
[[outputs]]
from = "pluck"
to = "cv"
cv_channel = 2
range = [-5, 5]
)",
                 words(true));
  ASSERT_LT(seconds_until([&] { return env.log().find("\nIN ") != std::string::npos; }, 15), 15)
      << env.log();
  const support::JackMidiSender keys("", {{96000, {0x90, 60, 100}}});
  const auto has_begun = [&] {
    const Samples all = capture.channel(1);
    return first_that_differs(all, 0) + 72000 < all.size();
  };
  ASSERT_LT(seconds_until(has_begun, 20), 20) << env.log();
  const Samples swell = capture.channel(0), pluck = capture.channel(1);
  const std::size_t begin = first_that_differs(pluck, 0);
  EXPECT_EQ(first_that_differs(swell, 0), begin + 1) << "it begins at 0";
  double worst_swell = 0, worst_pluck = 0;
  for (std::size_t i = 0; i < 70000; ++i) {
    const double t = static_cast<double>(i) / kRate;
    const double right_swell = 0.8 * quadratic({0, 1, 0.6, 0.1, 0}, std::min(t / 0.8, 1.0));
    const double right_pluck =
        rational_bezier({1, 0.15962, 0.030761, 0.0058833, 0.001},
                        {0.033544, 0.068924, 0.15018, 0.35327, 1}, std::min(t / 1.25, 1.0)) -
        0.5;
    worst_swell = std::max(worst_swell, std::abs(swell[begin + i] - right_swell));
    worst_pluck = std::max(worst_pluck, std::abs(pluck[begin + i] - right_pluck));
  }
  std::printf("worst error of 70000 samples: quadratic 2^%.2f, rational 2^%.2f of full scale\n",
              std::log2(worst_swell), std::log2(worst_pluck));
  EXPECT_LE(worst_swell, kTolerance);
  EXPECT_LE(worst_pluck, kTolerance);
}

constexpr const char* kFiveVolts = R"(
format = 1
kind = "envelope"
[curves.line]
degree = 1
points = [0, 1]
[envelopes.line]
curve = "line"
[[outputs]]
from = "line"
to = "cv"
range = [0, 8]
rest = 5
)";

/// Worst distance of `samples` from `right(i)` where right counts from the best of some places.
template <class Right>
double worst_from(const Samples& samples, std::size_t first, std::size_t last, std::int64_t place,
                  Right&& right) {
  double best = 1e9;
  for (std::int64_t origin = place - 200; origin <= place + 200; ++origin) {
    double worst = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double passed = static_cast<double>(static_cast<std::int64_t>(i) - origin);
      worst = std::max(worst, std::abs(samples[i] - right(passed)));
    }
    best = std::min(best, worst);
  }
  return best;
}

TEST_F(EnvVoltage, ItComesAndGoesAlongARampOfHalfASecond) {
  support::JackCapture capture(std::size_t{1}, kMostFrames);
  EnvProcess env(kFiveVolts, words(true));
  ASSERT_TRUE(comes_to(capture, 0, 0.5, 0)) << env.log();
  ASSERT_TRUE(capture.wait_for(capture.frames() + 4800, 10));
  const std::size_t held = capture.frames();
  env.program().end(SIGINT);
  ASSERT_TRUE(capture.wait_for(capture.frames() + 4800, 10));
  const Samples all = capture.channel(0);
  const std::size_t rise = first_that_differs(all, 0);
  const auto top = static_cast<std::size_t>(std::find(all.begin(), all.end(), 0.5F) - all.begin());
  const auto fall =
      static_cast<std::size_t>(std::find_if(all.begin() + static_cast<std::ptrdiff_t>(held),
                                            all.end(), [](float s) { return s != 0.5F; }) -
                               all.begin());
  const auto last = static_cast<std::size_t>(
      all.rend() - std::find_if(all.rbegin(), all.rend(), [](float s) { return s != 0; }));
  // The first cycles may be over before JACK has connected the program.
  EXPECT_LE(top - rise, 24000u);
  EXPECT_GE(top - rise, 24000u - 20 * 256);
  EXPECT_NEAR(static_cast<double>(last - fall), 24000, 10);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(held)));
  EXPECT_TRUE(std::is_sorted(all.rbegin(), all.rend() - static_cast<std::ptrdiff_t>(held)));
  const double up = worst_from(all, rise, held, static_cast<std::int64_t>(top) - 24000,
                               [](double passed) { return 0.5 * risen(passed); });
  const double down = worst_from(all, held, all.size(), static_cast<std::int64_t>(last) - 24000,
                                 [](double passed) { return 0.5 * (1 - risen(passed)); });
  std::printf("ramp in: %zu frames seen, worst error 2^%.2f; out: %zu frames, 2^%.2f\n", top - rise,
              std::log2(up), last - fall, std::log2(down));
  EXPECT_LE(up, kTolerance);
  EXPECT_LE(down, kTolerance);
}

TEST_F(EnvVoltage, ALostServerIsLookedForAndTheVoltageRampsInAgain) {
  auto capture = std::make_unique<support::JackCapture>(std::size_t{1}, kMostFrames);
  EnvProcess env(kFiveVolts, words(true));
  ASSERT_TRUE(comes_to(*capture, 0, 0.5, 0)) << env.log();
  server_.kill();
  const auto has_said = [&env](const char* words) {
    return seconds_until([&] { return env.log().find(words) != std::string::npos; }, 15) < 15;
  };
  ASSERT_TRUE(has_said("it is looked for")) << env.log();
  capture.reset();
  ASSERT_TRUE(server_.restart()) << server_.log();
  capture = std::make_unique<support::JackCapture>(std::size_t{1}, kMostFrames);
  ASSERT_TRUE(has_said("control voltage is back")) << env.log();
  ASSERT_TRUE(comes_to(*capture, 0, 0.5, 0)) << env.log();
  const Samples all = capture->channel(0);
  const auto top = std::find(all.begin(), all.end(), 0.5F);
  EXPECT_GE(static_cast<std::size_t>(top - all.begin()) - first_that_differs(all, 0),
            24000u - 20 * 256);
  env.program().end(SIGINT);
  EXPECT_TRUE(comes_to(*capture, 0, 0, 0)) << "it goes to rest as before";
  EXPECT_TRUE(std::none_of(all.begin(), top, [](float s) { return s > 0.5F; }));
}

/// Amplitude of a sine in the last `cycles` of a channel.
double amplitude(const Samples& samples, double hz, double seconds) {
  const auto n = static_cast<std::size_t>(seconds * kRate);
  double re = 0, im = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * hz * static_cast<double>(i) / kRate;
    re += samples[samples.size() - n + i] * std::cos(angle);
    im += samples[samples.size() - n + i] * std::sin(angle);
  }
  return 2 * std::hypot(re, im) / static_cast<double>(n);
}

TEST_F(EnvVoltage, WithoutTheFlagDirectCurrentIsGoneAndTwentyHertzAreThreeDecibelsDown) {
  constexpr std::array<double, 3> kHz = {2, 20, 200};
  std::string patch = "format = 1\nkind = 'envelope'\n[trigger]\nfrom = 'loop'\n";
  for (std::size_t c = 0; c < kHz.size(); ++c) {
    const std::string name = "wave" + std::to_string(c + 1);
    patch += "[lfos." + name + "]\ncurve = 'sine'\nrate_hz = " + std::to_string(kHz[c]) +
             "\n[[outputs]]\nfrom = '" + name + "'\nto = 'cv'\nof = [-1, 1]\nrange = [-5, 5]\n" +
             "cv_channel = " + std::to_string(c + 1) + "\n";
  }
  // A curve that is 1 from the beginning to its end.
  patch +=
      "[curves.one]\ndegree = 1\npoints = [1, 1]\n[envelopes.one]\ncurve = 'one'\n"
      "[[outputs]]\nfrom = 'one'\nto = 'cv'\nrange = [0, 5]\ncv_channel = 4\n";
  support::JackCapture capture(std::size_t{4}, kMostFrames);
  EnvProcess env(patch, words(false));
  ASSERT_LT(
      seconds_until(
          [&] { return first_that_differs(capture.channel(3), 0) < capture.channel(3).size(); },
          20),
      20)
      << env.log();
  ASSERT_TRUE(capture.wait_for(capture.frames() + 4 * 48000, 30));
  for (std::size_t c = 0; c < kHz.size(); ++c) {
    const double gain = amplitude(capture.channel(c), kHz[c], 2) / 0.5;
    const double right = kHz[c] / std::hypot(kHz[c], 20.0);
    std::printf("%3.0f Hz: %.3f dB\n", kHz[c], 20 * std::log10(gain));
    EXPECT_NEAR(gain, right, 2e-3) << kHz[c];
  }
  const Samples direct = capture.channel(3);
  const float most = *std::max_element(direct.begin(), direct.end());
  EXPECT_GT(most, 0.001F) << "the ramp in is heard";
  EXPECT_LT(most, 0.1F);
  EXPECT_LT(std::abs(direct.back()), 0x1p-24F);
  EXPECT_THAT(env.log(), testing::HasSubstr("direct current is kept out"));
}

}  // namespace
}  // namespace knotwave::io

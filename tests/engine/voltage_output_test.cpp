// SPDX-License-Identifier: MIT
#include "knotwave/engine/voltage_output.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

constexpr double kRate = 48000;

VoltageConfig config_of(bool direct_current, double ramp_s = 0.01) {
  VoltageConfig config;
  config.direct_current = direct_current;
  config.ramp_s = ramp_s;
  return config;
}

std::vector<double> wobble(std::size_t n) {
  std::vector<double> volts(n);
  for (std::size_t i = 0; i < n; ++i) volts[i] = 5 + 4 * std::sin(0.01 * static_cast<double>(i));
  return volts;
}

std::vector<float> render(VoltageOutput output, std::span<const double> volts, std::size_t block,
                          std::int64_t ramp_out_at = -1) {
  std::vector<float> out(volts.size());
  for (std::size_t first = 0; first < volts.size();) {
    std::size_t n = std::min(block, volts.size() - first);
    const auto sample = static_cast<std::int64_t>(first);
    if (sample == ramp_out_at) output.ramp_out(sample);
    if (sample < ramp_out_at) n = std::min(n, static_cast<std::size_t>(ramp_out_at - sample));
    output.render(sample, volts.subspan(first, n), std::span(out).subspan(first, n));
    first += n;
  }
  return out;
}

TEST(VoltageOutput, ADirectCurrentIsWithin2ToTheMinus24OfTheIdeal) {
  VoltageConfig config = config_of(true);
  config.channels = {{10, 0}, {-6.75, 0.0125}};
  const std::vector<double> volts = wobble(4800);
  for (const int channel : {1, 2, 3}) {
    const auto out = render(*VoltageOutput::create(config, channel), volts, 64);
    const long double scale = channel == 2 ? -6.75L : 10.0L, offset = channel == 2 ? 0.0125L : 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const long double t = std::min(static_cast<long double>(i) / 480, 1.0L);
      const long double ideal = (3 * t * t - 2 * t * t * t) * (volts[i] - offset) / scale;
      const long double kept = std::clamp(ideal, -1.0L, 1.0L);
      ASSERT_LE(std::abs(out[i] - kept), 0x1p-24L) << "channel " << channel << " sample " << i;
    }
  }
}

TEST(VoltageOutput, TheRampOutEndsAtTheSampleOfASilentDeviceExactly) {
  VoltageConfig config = config_of(true);
  config.channels = {{8, 0.5}};
  const std::vector<double> volts(4800, 4.0);
  const auto out = render(*VoltageOutput::create(config, 1), volts, 64, 2400);
  EXPECT_EQ(out[0], 0.0f);
  EXPECT_EQ(out[2400], 0.4375f);
  EXPECT_EQ(out[2400 + 240], 0.21875f) << "half way down at half the time";
  EXPECT_EQ(out[2400 + 480], 0.0f);
  EXPECT_EQ(out.back(), 0.0f);
  VoltageOutput output = *VoltageOutput::create(config, 1);
  output.ramp_out(100);
  EXPECT_FALSE(output.is_silent(579));
  EXPECT_TRUE(output.is_silent(580));
  output.ramp_out(200);
  EXPECT_TRUE(output.is_silent(580)) << "the first ramp out holds";
}

TEST(VoltageOutput, WithoutCvTheHighPassTakesTheDirectCurrentOut) {
  const std::vector<double> volts(48000, 9.0);
  const auto out = render(*VoltageOutput::create(config_of(false), 1), volts, 64);
  EXPECT_LT(std::abs(out.back()), 1e-7f);
  EXPECT_GT(*std::max_element(out.begin(), out.end()), 0.3f);
  for (const float sample : out) EXPECT_LT(std::abs(sample), 0.9f);
}

TEST(VoltageOutput, TheHighPassIsThreeDecibelsDownAt20Hz) {
  for (const auto& [hz, gain] : {std::pair{20.0, std::sqrt(0.5)}, {2.0, 0.0995}, {2000.0, 1.0}}) {
    std::vector<double> volts(96000);
    for (std::size_t i = 0; i < volts.size(); ++i) {
      volts[i] = 5 * std::sin(2 * M_PI * hz * static_cast<double>(i) / kRate);
    }
    const auto out = render(*VoltageOutput::create(config_of(false), 1), volts, 64);
    std::complex<double> sum = 0;  // the last second
    for (std::size_t i = 48000; i < 96000; ++i) {
      sum += static_cast<double>(out[i]) *
             std::polar(2.0 / 48000, -2 * M_PI * hz * static_cast<double>(i) / kRate);
    }
    EXPECT_NEAR(std::abs(sum) / 0.5, gain, 2e-4) << hz << " Hz";
  }
}

TEST(VoltageOutput, AnySplitGivesTheSameBits) {
  const std::vector<double> volts = wobble(3000);
  for (const bool direct_current : {true, false}) {
    const VoltageOutput output = *VoltageOutput::create(config_of(direct_current), 1);
    const auto whole = render(output, volts, 3000, 2001);
    for (std::size_t block = 1; block <= 64; ++block) {
      ASSERT_EQ(render(output, volts, block, 2001), whole) << "blocks of " << block;
    }
  }
}

TEST(VoltageOutput, WhatTheInterfaceCannotGiveIsClampedAndCounted) {
  VoltageOutput output = *VoltageOutput::create(config_of(true, 0.001), 1);
  std::vector<double> volts(100, 10.5);
  volts[60] = -1e300;
  volts[61] = std::nan("");
  std::vector<float> out(volts.size());
  output.render(0, volts, out);
  EXPECT_EQ(out[59], 1.0f);
  EXPECT_EQ(out[60], -1.0f);
  EXPECT_EQ(out[61], 0.0f);
  std::int64_t at_the_end = 0;
  for (const float sample : out) at_the_end += sample == 1.0f || sample == -1.0f;
  EXPECT_EQ(output.clamped(), at_the_end);
  EXPECT_GT(output.clamped(), 50);
}

TEST(VoltageOutput, WhatCannotBeIsRefused) {
  for (const double ramp_s : {0.0, 0.0009, 61.0, std::nan("")}) {
    EXPECT_EQ(VoltageOutput::create(config_of(true, ramp_s), 1).error().code,
              ErrorCode::value_out_of_range);
  }
  VoltageConfig config = config_of(true);
  EXPECT_FALSE(VoltageOutput::create(config, 0));
  config.channels = {{0, 0}};
  const auto dead = VoltageOutput::create(config, 1);
  ASSERT_FALSE(dead);
  EXPECT_NE(dead.error().message.find("audio channel 1"), std::string::npos);
  config.channels = {{10, std::nan("")}};
  EXPECT_FALSE(VoltageOutput::create(config, 1));
  config.channels = {};
  config.rate_hz = 0;
  EXPECT_FALSE(VoltageOutput::create(config, 1));
}

TEST(Calibration, ChannelsAreReadInOrder) {
  const auto channels = parse_calibration(R"(format = 1
kind = "calibration"
[[channels]]
volts_full_scale = -9.93
offset_v = 0.004
[[channels]]
)",
                                          "es8.toml");
  ASSERT_TRUE(channels) << channels.error().to_string();
  ASSERT_EQ(channels->size(), 2u);
  EXPECT_EQ((*channels)[0].volts_full_scale, -9.93);
  EXPECT_EQ((*channels)[0].offset_v, 0.004);
  EXPECT_EQ((*channels)[1].volts_full_scale, 10);
}

TEST(Calibration, ErrorsSayWhere) {
  const auto message = [](const std::string& text) {
    const auto channels = parse_calibration(text, "c.toml");
    return channels ? std::string("none") : channels.error().to_string();
  };
  const std::string head = "format = 1\nkind = \"calibration\"\n";
  EXPECT_EQ(message(head + "[[channels]]\nvolts_full_scale = 0\n"),
            "c.toml:4:20: error: channel 1: volts_full_scale is 0; 0.01 to 1000 V are possible, "
            "with a minus where the interface inverts");
  EXPECT_NE(message(head + "[[channels]]\nvolts_fullscale = 5\n").find("c.toml:4:1"),
            std::string::npos);
  EXPECT_NE(message("format = 1\nkind = \"patch\"\n").find("calibration"), std::string::npos);
  EXPECT_NE(message("kind = \"calibration\"\n").find("format"), std::string::npos);
  EXPECT_NE(message(head + "channels = [3]\n").find("[[channels]]"), std::string::npos);
  EXPECT_NE(message(head + "channels = 3\n").find("c.toml:3"), std::string::npos);
}

}  // namespace
}  // namespace knotwave::engine

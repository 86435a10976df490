// SPDX-License-Identifier: MIT
// knotwave-env --capture at a JACK server of the test's own: another client moves the knob.
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

#include "knotwave/curves/curve_file.h"

#include "live_clients.h"
#include "support/background_program.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"
#include "support/program.h"

namespace knotwave::io {
namespace {

using testing::HasSubstr;

constexpr int kFramesAStep = 960;

/// Controller 1 of channel 5 from 0 to 127 within 2.5 s, and notes and another knob in between.
std::vector<support::JackMidiSender::Message> sweep(std::int64_t begin) {
  std::vector<support::JackMidiSender::Message> all;
  for (int i = 0; i < 128; ++i) {
    const auto value = static_cast<std::uint8_t>(i);
    all.push_back({begin + i * kFramesAStep, {0xB4, 1, value}});
    all.push_back({begin + i * kFramesAStep + 100, {0xB4, 7, value}});
    all.push_back({begin + i * kFramesAStep + 200, {0x94, 60, 100}});
  }
  return all;
}

class CaptureOnJack : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(server_.runs()) << server_.log(); }
  std::string log() const {
    std::ifstream file(folder_.file("log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<std::string> words(std::vector<std::string> more) const {
    more.insert(more.begin(), {std::string(KNOTWAVE_BIN_DIR) + "/knotwave-env", "--capture", "cc1",
                               "--midi-api", "jack", "-o", folder_.file("knob.toml")});
    return more;
  }
  bool has_said(const std::string& text, double within_s) const {
    return seconds_until([&] { return log().find(text) != std::string::npos; }, within_s) <
           within_s;
  }
  support::JackServer server_{256};
  support::ScratchFolder folder_;
};

TEST_F(CaptureOnJack, AKnobThatAnotherClientTurnsBecomesACurveWhenInterrupted) {
  support::BackgroundProgram program(words({}), folder_.file("log"));
  ASSERT_TRUE(has_said("listens for cc1", 15)) << log();
  // The program connects every source that comes by itself; two seconds are plenty for it.
  const support::JackMidiSender knob("", sweep(96000));
  ASSERT_TRUE(knob.wait_until_sent(20));
  ASSERT_TRUE(has_said("cc1 ch5 127, 128 values", 10)) << log();
  program.end(SIGINT);
  ASSERT_TRUE(std::filesystem::exists(folder_.file("knob.toml"))) << log();
  EXPECT_THAT(log(), HasSubstr("cc1 of channel 5, 128 values in 2.5"));
  const auto set = curves::read_curves(folder_.file("knob.toml"));
  ASSERT_TRUE(set.has_value()) << set.error().to_string();
  const curves::NurbsCurve& curve = set->curves.front();
  EXPECT_LE(curve.point_count(), 12);
  double most = 0;
  for (int i = 0; i < 128; ++i) {
    double value = 0;
    curve.evaluate(i * kFramesAStep / 48000.0, std::span(&value, 1));
    most = std::max(most, std::abs(value * 127 - i));
  }
  std::printf("%d points; %.3f steps off at most\n", curve.point_count(), most);
  // A step of what is recorded and allowed, and a stamp that is some blocks of 0.27 steps late.
  EXPECT_LE(most, 3);
}

TEST_F(CaptureOnJack, NothingHeardIsAnErrorThatNamesWhatCame) {
  support::BackgroundProgram program(words({"--duration", "5"}), folder_.file("log"));
  ASSERT_TRUE(has_said("listens for cc1", 15)) << log();
  const support::JackMidiSender knob("", {{96000, {0xB2, 7, 3}}});
  ASSERT_TRUE(has_said("error: ", 20)) << log();
  EXPECT_THAT(log(), HasSubstr("no cc1 was heard; what came: cc7 (ch 3)"));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("knob.toml")));
}

}  // namespace
}  // namespace knotwave::io

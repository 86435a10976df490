// SPDX-License-Identifier: MIT
// Streams of JACK on a real server, judged by other clients of it.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/audio_device.h"

#include "live/live_clients.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"

namespace knotwave::io {
namespace {

using support::JackCapture;
using support::JackMidiSender;
using support::JackServer;
using State = AudioStatus::State;
using ::testing::HasSubstr;

std::unique_ptr<AudioStream> opened(const AudioConfig& config, AudioClient& client) {
  auto stream = AudioStream::open(config, client);
  EXPECT_TRUE(stream) << stream.error().message;
  return stream ? std::move(*stream) : nullptr;
}

std::string port(const AudioStream& stream, const char* name) {
  return stream.format().client_name + ":" + name;
}

/// All zeros until the first number, then each sample the next number: nothing lost or doubled.
void expect_numbered_without_a_gap(const JackCapture& capture, std::size_t channels) {
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<float> samples = capture.channel(c);
    const auto first = std::find_if(samples.begin(), samples.end(), [](float x) { return x != 0; });
    ASSERT_LT(first - samples.begin(), 1 << 15) << "nothing was captured in channel " << c;
    const std::int64_t number = NumberedClient::number(*first);
    for (auto sample = first; sample != samples.end(); ++sample) {
      ASSERT_EQ(*sample, NumberedClient::sample(number + (sample - first), c))
          << "channel " << c << ", " << sample - first << " samples after the first";
    }
  }
}

class JackStreamTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(server_.runs()) << server_.log(); }
  JackServer server_;
};

TEST_F(JackStreamTest, AServerIsListedWithItsOutputsAndTakenByDefault) {
  const AudioDeviceList list = list_audio_devices();
  ASSERT_FALSE(list.devices.empty());
  const AudioDeviceInfo& system = list.devices.front();
  EXPECT_EQ(system.number, 0);
  EXPECT_EQ(system.api, "jack");
  EXPECT_EQ(system.name, "system");
  EXPECT_EQ(system.outputs, 2);
  EXPECT_EQ(system.rate_hz, 48000);
  EXPECT_GT(system.latency_s, 0);
  EXPECT_TRUE(system.is_default);
  for (const AudioDeviceInfo& device : list.devices) EXPECT_NE(device.api, "portaudio-jack");

  NumberedClient client;
  const auto stream = opened({}, client);
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->format().api, "jack");
  EXPECT_EQ(stream->format().device, "system");
  EXPECT_EQ(stream->format().client_name, "Knotwave");
  EXPECT_EQ(stream->format().rate_hz, 48000);
  EXPECT_EQ(stream->format().block_frames, 1024);
  EXPECT_EQ(stream->format().channels, 2);
  EXPECT_TRUE(stream->format().has_midi);
  EXPECT_FALSE(stream->format().is_freewheeling);
}

TEST_F(JackStreamTest, WhatTheServerDoesNotDoIsRefusedWithTheFix) {
  struct Case {
    AudioConfig config;
    ErrorCode code;
    const char* words;
  } const cases[] = {
      {{.rate_hz = 44100},
       ErrorCode::unsupported,
       "runs at 48000 Hz, not 44100: leave the rate out"},
      {{.block_frames = 64}, ErrorCode::unsupported, "blocks of 1024 frames, not 64"},
      {{.channels = {1, 3}}, ErrorCode::value_out_of_range, "no channel 3: 'system' has 2"},
      {{.api = "jack", .device = "usb"},
       ErrorCode::unknown_name,
       "no device 'usb' of jack; there is: 0 jack 'system'"},
      {{.api = "jack", .device = "7"}, ErrorCode::unknown_name, "no device '7' of jack"},
  };
  for (const Case& wrong : cases) {
    NumberedClient client;
    const auto stream = AudioStream::open(wrong.config, client);
    ASSERT_FALSE(stream) << wrong.words;
    EXPECT_EQ(stream.error().code, wrong.code) << stream.error().message;
    EXPECT_THAT(stream.error().message, HasSubstr(wrong.words));
  }
}

TEST_F(JackStreamTest, EverySampleWrittenIsHeardOnceAtThePaceOfTheServer) {
  NumberedClient client;
  const auto stream = opened({.api = "JACK", .device = "SYS"}, client);
  ASSERT_TRUE(stream);
  ASSERT_TRUE(stream->start());
  {
    JackCapture capture({port(*stream, "out_1"), port(*stream, "out_2")}, 72000);
    ASSERT_TRUE(capture.is_connected());
    ASSERT_TRUE(capture.wait_for(72000, 20));
    expect_numbered_without_a_gap(capture, 2);
  }
  const AudioStatus status = stream->status();
  EXPECT_EQ(status.state, State::running);
  EXPECT_GT(status.load, 0);
  EXPECT_GE(status.load_max, status.load_p99);
  EXPECT_GT(status.load_p99, 0);
  EXPECT_GT(stream->format().latency_s, 0);
  stream->stop();
  const std::int64_t blocks = client.blocks();
  EXPECT_EQ(stream->status().state, State::stopped);
  EXPECT_EQ(stream->status().blocks, blocks);
  EXPECT_EQ(client.overlaps(), 0);
  EXPECT_EQ(client.backsteps(), 0);
  EXPECT_LE(client.last_time_ns(), steady_clock_ns());
  EXPECT_GT(client.last_time_ns(), steady_clock_ns() - 1'000'000'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_EQ(client.blocks(), blocks);  // none after stop()
}

TEST_F(JackStreamTest, EverySampleWrittenIsHeardOnceInFreewheel) {
  NumberedClient client;
  const auto stream = opened({}, client);
  ASSERT_TRUE(stream);
  ASSERT_TRUE(stream->start());
  constexpr std::size_t kFrames = 48000 * 30;
  JackCapture capture({port(*stream, "out_1"), port(*stream, "out_2")}, kFrames);
  ASSERT_TRUE(capture.is_connected());
  capture.set_freewheel(true);
  EXPECT_LT(seconds_until([&] { return stream->status(), stream->format().is_freewheeling; }, 5),
            5);
  ASSERT_TRUE(capture.wait_for(kFrames, 25));
  EXPECT_EQ(stream->status().state, State::running) << stream->status().reason;
  capture.set_freewheel(false);
  EXPECT_LT(seconds_until([&] { return stream->status(), !stream->format().is_freewheeling; }, 5),
            5);
  stream->stop();
  expect_numbered_without_a_gap(capture, 2);
  EXPECT_EQ(client.overlaps(), 0);
  EXPECT_EQ(client.backsteps(), 0);
}

TEST_F(JackStreamTest, ChannelsGoWhereTheMapSaysAndNowhereWithoutConnect) {
  NumberedClient client;
  const auto stream = opened({.channels = {2}}, client);
  ASSERT_TRUE(stream);
  ASSERT_TRUE(stream->start());
  EXPECT_EQ(support::connections_of(port(*stream, "out_1")),
            std::vector<std::string>{"system:playback_2"});
  const auto apart = opened({.client_name = "apart", .connect = false}, client);
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->format().device, "not connected");
  ASSERT_TRUE(apart->start());
  EXPECT_TRUE(support::connections_of("apart:out_1").empty());
}

TEST_F(JackStreamTest, ATakenNameBecomesAnother) {
  NumberedClient client;
  const auto one = opened({}, client), other = opened({}, client);
  ASSERT_TRUE(one && other);
  EXPECT_NE(one->format().client_name, other->format().client_name);
  EXPECT_THAT(other->format().client_name, HasSubstr("Knotwave"));
}

TEST_F(JackStreamTest, TheBlockSizeIsFollowed) {
  NumberedClient client;
  const auto stream = opened({}, client);
  ASSERT_TRUE(stream);
  ASSERT_TRUE(stream->start());
  ASSERT_EQ(support::run_program({"/bin/sh", "-c", "exec jack_bufsize 256"}).exit_code, 0);
  EXPECT_LT(
      seconds_until([&] { return stream->status(), stream->format().block_frames == 256; }, 5), 5);
  EXPECT_EQ(stream->status().state, State::running);
  JackCapture capture({port(*stream, "out_1")}, 24000);
  ASSERT_TRUE(capture.wait_for(24000, 20));
  expect_numbered_without_a_gap(capture, 1);
}

TEST_F(JackStreamTest, ABlockThatComesLateIsAnOverrunAndAnXrun) {
  class LateClient : public NumberedClient {
   public:
    void process(const AudioBlock& block) KNOTWAVE_RT override {
      if (blocks() == 20) std::this_thread::sleep_for(std::chrono::milliseconds(300));
      NumberedClient::process(block);
    }
  } client;
  const auto stream = opened({}, client);
  ASSERT_TRUE(stream);
  ASSERT_TRUE(stream->start());
  EXPECT_LT(seconds_until([&] { return client.blocks() > 40; }, 20), 20);
  stream->stop();
  const AudioStatus status = stream->status();
  EXPECT_GE(status.overruns, 1);
  EXPECT_GE(status.xruns, 1);
  EXPECT_GE(status.load_max, 300.0 / (1024 / 48.0));
  EXPECT_EQ(client.overlaps(), 0);
}

}  // namespace
}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// What needs no sound server: what is refused and how, choosing, the stream without a device, the
// load meter, the pump and calls that hang.
#include "knotwave/io/audio_device.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace knotwave::io {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

/// Writes a ramp of the frame number and keeps what it was asked for.
class RampClient : public AudioClient {
 public:
  struct Call {
    std::int64_t frame, time_ns;
    int frames;
  };
  void process(const AudioBlock& block) KNOTWAVE_RT override {
    for (int i = 0; i < block.frames; ++i) {
      for (float* output : block.outputs) output[i] = static_cast<float>(block.frame + i);
    }
    const std::lock_guard lock(mutex_);
    calls_.push_back({block.frame, block.time_ns, block.frames});
  }
  std::vector<Call> calls() const {
    const std::lock_guard lock(mutex_);
    return calls_;
  }
  void wait_for(std::size_t calls) const {
    while (this->calls().size() < calls) std::this_thread::sleep_for(1ms);
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Call> calls_;
};

Error refused(const AudioConfig& config) {
  RampClient client;
  auto stream = AudioStream::open(config, client);
  EXPECT_FALSE(stream);
  return stream ? Error{} : stream.error();
}

TEST(AudioDevice, ValuesOutOfRangeAreRefusedWithBothNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    AudioConfig config;
    const char* words;
  } const cases[] = {
      {{.api = "none", .rate_hz = 7999}, "7999 Hz is not within 8000 to 768000"},
      {{.api = "none", .rate_hz = nan}, "8000 to 768000"},
      {{.api = "none", .block_frames = 15}, "15 frames is not within 16 to 8192"},
      {{.api = "none", .block_frames = 8193}, "8193 frames is not within 16 to 8192"},
      {{.api = "none", .latency_s = -1}, "-1 s is not within 0 to 10"},
      {{.api = "none", .latency_s = nan}, "0 to 10"},
      {{.api = "none", .channels = {}}, "0 channels are asked for; 1 to 64"},
      {{.api = "none", .channels = std::vector<int>(65, 1)}, "65 channels"},
      {{.api = "none", .channels = {1, 0}}, "device channel 0 is not within 1 to 256"},
      {{.api = "none", .channels = {257}}, "device channel 257 is not within 1 to 256"},
      {{.api = "none", .channels = {3, 1, 3}}, "device channel 3 is asked for twice"},
  };
  for (const Case& wrong : cases) {
    const Error error = refused(wrong.config);
    EXPECT_EQ(error.code, ErrorCode::value_out_of_range) << wrong.words;
    EXPECT_THAT(error.message, HasSubstr(wrong.words));
  }
}

TEST(PacedStream, BlocksFollowOneAnotherAtExactlyRegularTimes) {
  RampClient client;
  auto stream = AudioStream::open({.api = "None", .rate_hz = 44100, .block_frames = 100}, client);
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_EQ((*stream)->format().api, "none");
  EXPECT_EQ((*stream)->format().rate_hz, 44100);
  EXPECT_EQ((*stream)->format().block_frames, 100);
  EXPECT_EQ((*stream)->format().channels, 2);
  EXPECT_EQ((*stream)->status().state, AudioStatus::State::stopped);
  const std::int64_t before_ns = steady_clock_ns();
  ASSERT_TRUE((*stream)->start());
  EXPECT_EQ((*stream)->status().state, AudioStatus::State::running);
  client.wait_for(100);
  (*stream)->stop();
  const std::int64_t after_ns = steady_clock_ns();
  const auto calls = client.calls();
  EXPECT_EQ((*stream)->status().state, AudioStatus::State::stopped);
  EXPECT_EQ((*stream)->status().blocks, static_cast<std::int64_t>(calls.size()));
  EXPECT_GE(calls.front().time_ns, before_ns);
  EXPECT_LE(calls.back().time_ns, after_ns);
  for (std::size_t i = 0; i < calls.size(); ++i) {
    ASSERT_EQ(calls[i].frame, static_cast<std::int64_t>(100 * i));
    ASSERT_EQ(calls[i].frames, 100);
    const double since_ns = static_cast<double>(100 * i) / 44100 * 1e9;
    ASSERT_NEAR(static_cast<double>(calls[i].time_ns - calls[0].time_ns), since_ns, 1);
  }
}

TEST(PacedStream, FramesGoOnAfterStopAndStart) {
  RampClient client;
  auto stream = AudioStream::open({.api = "none", .block_frames = 64}, client);
  ASSERT_TRUE(stream) << stream.error().message;
  ASSERT_TRUE((*stream)->start());
  client.wait_for(3);
  (*stream)->stop();
  const std::size_t first = client.calls().size();
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(client.calls().size(), first);  // none after stop()
  ASSERT_TRUE((*stream)->start());
  client.wait_for(first + 3);
  (*stream)->stop();
  const auto calls = client.calls();
  for (std::size_t i = 0; i < calls.size(); ++i) {
    ASSERT_EQ(calls[i].frame, static_cast<std::int64_t>(64 * i));
  }
  EXPECT_GE(calls[first].time_ns, calls[first - 1].time_ns + 20'000'000 - 64'000'000'000 / 48000);
}

TEST(PacedStream, WhatIsLateIsMadeUpForUnlessItIsMoreThanASecond) {
  class SleepyClient : public RampClient {
   public:
    void process(const AudioBlock& block) KNOTWAVE_RT override {
      RampClient::process(block);
      if (block.frame == 4800) std::this_thread::sleep_for(300ms);
      if (block.frame == 24000) std::this_thread::sleep_for(2300ms);
    }
  } client;
  auto stream = AudioStream::open({.api = "none", .block_frames = 480}, client);
  ASSERT_TRUE(stream) << stream.error().message;
  ASSERT_TRUE((*stream)->start());
  client.wait_for(60);
  (*stream)->stop();
  const auto calls = client.calls();
  for (std::size_t i = 0; i <= 50; ++i) {
    ASSERT_EQ(calls[i].frame, static_cast<std::int64_t>(480 * i));
  }
  EXPECT_GE(calls[51].frame, 24480 + 48000);  // what was slept through
  for (std::size_t i = 52; i < calls.size(); ++i) {
    ASSERT_EQ(calls[i].frame, calls[i - 1].frame + 480);
  }
  for (std::size_t i = 1; i < calls.size(); ++i) {
    const std::int64_t frames = calls[i].frame - calls[i - 1].frame;
    ASSERT_NEAR(static_cast<double>(calls[i].time_ns - calls[i - 1].time_ns),
                static_cast<double>(frames) / 48000 * 1e9, 2);
  }
  const AudioStatus status = (*stream)->status();
  EXPECT_GE(status.xruns, 1);
  EXPECT_GE(status.overruns, 2);
  EXPECT_GE(status.load_max, 230);
}

}  // namespace
}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// A JACK server that goes, stands still and comes back.
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
using support::JackServer;
using State = AudioStatus::State;
using ::testing::HasSubstr;

/// The limits the header states, with what an idle program's thread may have to wait for a core.
constexpr double kAtOnceSeconds = 1.0, kWatchSeconds = 1.0, kSoundsAgainSeconds = 3.0;

class JackLossTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(server_.runs()) << server_.log();
    stream_ = reopened(5);
    ASSERT_TRUE(stream_);
    ASSERT_LT(seconds_until([&] { return client_.blocks() > 10; }, 10), 10);
  }
  /// As a program does: tries again until it opens.
  std::unique_ptr<AudioStream> reopened(double timeout_s) {
    std::unique_ptr<AudioStream> stream;
    seconds_until(
        [&] {
          auto tried = AudioStream::open({.api = "jack"}, client_);
          if (tried && (*tried)->start()) stream = std::move(*tried);
          return stream != nullptr;
        },
        timeout_s);
    return stream;
  }

  JackServer server_;
  NumberedClient client_;
  std::unique_ptr<AudioStream> stream_;
};

TEST_F(JackLossTest, AKilledServerIsNoticedLeftAndFoundAgain) {
  for (int round = 0; round < 3; ++round) {
    server_.kill();
    EXPECT_LT(seconds_until([&] { return stream_->status().state == State::lost; }, 5),
              kAtOnceSeconds);
    EXPECT_THAT(stream_->status().reason, HasSubstr("the JACK server has gone"));
    EXPECT_EQ(stream_->status().state, State::lost);  // and stays so
    EXPECT_FALSE(stream_->start());
    EXPECT_LT(seconds_taken([&] { stream_.reset(); }), kAtOnceSeconds);
    EXPECT_FALSE(AudioStream::is_poisoned());
    const auto refused = AudioStream::open({.api = "jack"}, client_);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("jack: no server is running"));

    ASSERT_TRUE(server_.restart()) << server_.log();
    const std::int64_t blocks = client_.blocks();
    const double again_s = seconds_taken([&] {
      stream_ = reopened(10);
      seconds_until([&] { return client_.blocks() > blocks; }, 10);
    });
    EXPECT_LT(again_s, kSoundsAgainSeconds);
    ASSERT_TRUE(stream_);
    JackCapture capture({stream_->format().client_name + ":out_1"}, 9600);
    ASSERT_TRUE(capture.wait_for(9600, 10));
    const std::vector<float> heard = capture.channel(0);
    EXPECT_NE(heard.back(), 0);
  }
}

TEST_F(JackLossTest, AServerThatStandsStillIsLostAndLeftBehind) {
  server_.pause();
  EXPECT_LT(seconds_until([&] { return stream_->status().state == State::lost; }, 5),
            kWatchSeconds + 0.5);
  EXPECT_THAT(stream_->status().reason, HasSubstr("no block for 0.8 s"));
  EXPECT_LT(seconds_taken([&] { stream_.reset(); }), kAtOnceSeconds);
  const std::int64_t blocks = client_.blocks();
  EXPECT_LT(seconds_taken([&] { list_audio_devices(); }), 10);
  EXPECT_FALSE(AudioStream::open({.api = "jack"}, client_));
  server_.resume();
  // What hung comes back, and all is well again.
  EXPECT_LT(seconds_until([] { return !AudioStream::is_poisoned(); }, 10), 10);
  EXPECT_EQ(client_.blocks(), blocks);  // none after the stream was destroyed
  stream_ = reopened(10);
  ASSERT_TRUE(stream_);
  EXPECT_LT(seconds_until([&] { return client_.blocks() > blocks; }, 10), 10);
}

}  // namespace
}  // namespace knotwave::io

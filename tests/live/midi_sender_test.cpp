// SPDX-License-Identifier: MIT
// Messages sent through a JACK server of the test's own arrive at the frame that their time asks
// for.
#include "knotwave/io/midi_sender.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "knotwave/io/audio_device.h"

#include "jack_receiver.h"
#include "live_clients.h"
#include "support/jack_server.h"

namespace knotwave::io {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

base::MidiEvent control(int number, int value) {
  base::MidiEvent event;
  event.bytes[0] = 0xB0;
  event.bytes[1] = static_cast<std::uint8_t>(number);
  event.bytes[2] = static_cast<std::uint8_t>(value);
  return event;
}

constexpr std::int64_t kMs = 1'000'000;

TEST(MidiSendersOnJack, PutEveryMessageAtItsFrameOneBlockLater) {
  constexpr int kBlock = 512, kMessages = 1500;
  support::JackServer server(kBlock);
  ASSERT_TRUE(server.runs()) << server.log();
  JackReceiver receiver("board");
  auto opened = MidiSender::open({.ports = {{.api = "jack", .port = "BOARD:in"}}});
  ASSERT_TRUE(opened.has_value()) << opened.error().to_string();
  MidiSender& sender = **opened;
  EXPECT_EQ(sender.ports()[0].name, "board:in");
  // 1.1 ms apart, pushed 4 ms before they are due, as a planner does.
  std::vector<std::int64_t> due;
  const std::int64_t begin_ns = steady_clock_ns() + 50 * kMs;
  for (int i = 0; i < kMessages; ++i) {
    due.push_back(begin_ns + i * std::int64_t{1'100'003});
    while (steady_clock_ns() < due.back() - 4 * kMs) std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(sender.push(0, control(i % 100, i % 128), due.back()));
  }
  ASSERT_LT(seconds_until([&] { return receiver.count() == kMessages; }, 10), 10);
  std::vector<double> errors;
  for (int i = 0; i < kMessages; ++i) {
    const auto& heard = receiver.heard(static_cast<std::size_t>(i));
    ASSERT_EQ(heard.bytes, (std::vector<int>{0xB0, i % 100, i % 128}));
    const double right =
        receiver.frame_at(static_cast<double>(due[static_cast<std::size_t>(i)])) + kBlock;
    errors.push_back(std::abs(heard.frame - right));
  }
  const Lateness::Figures late = sender.ports()[0].lateness;
  EXPECT_EQ(late.count, kMessages);
  // What was late is counted, and its error is no more than that: a machine that stops for a while.
  std::sort(errors.begin(), errors.end());
  const double late_frames = static_cast<double>(late.max_ns) * 48e-6;
  std::printf("error in frames: median %.2f, 99 %% %.2f, most %.2f; late by %.1f at most\n",
              errors[kMessages / 2], errors[kMessages * 99 / 100], errors.back(), late_frames);
  EXPECT_LE(errors[kMessages / 2], 1);
  EXPECT_LE(errors.back(), 2 + late_frames);
}

TEST(MidiSendersOnJack, ComeBackWithTheServer) {
  support::JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  auto opened = MidiSender::open({.ports = {{.api = "jack", .client_name = "first"},
                                            {.api = "jack", .client_name = "second"}}});
  ASSERT_TRUE(opened.has_value()) << opened.error().to_string();
  MidiSender& sender = **opened;
  EXPECT_THAT(sender.ports()[1].name, HasSubstr("second:out"));
  server.kill();
  EXPECT_LT(seconds_until(
                [&] {
                  sender.poll();
                  return !sender.ports()[0].is_open && !sender.ports()[1].is_open;
                },
                3),
            3);
  ASSERT_TRUE(server.restart());
  EXPECT_LT(seconds_until(
                [&] {
                  sender.poll();
                  return sender.ports()[0].is_open && sender.ports()[1].is_open;
                },
                5),
            5);
  EXPECT_EQ(sender.ports()[0].reopened, 1);
  JackReceiver receiver("board");
  ASSERT_FALSE(MidiOutput::open({.api = "jack", .port = "nobody"}).has_value());
  sender.push(0, control(1, 2), steady_clock_ns());
  EXPECT_LT(seconds_until([&] { return sender.is_done(); }, 5), 5);
}

TEST(MidiSendersOnJack, EndWithinASecondWhereTheServerHangs) {
  support::JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  auto opened = MidiSender::open({.ports = {{.api = "jack"}, {.api = "jack"}}});
  ASSERT_TRUE(opened.has_value()) << opened.error().to_string();
  server.pause();
  const std::int64_t begin_ns = steady_clock_ns();
  opened->reset();
  EXPECT_LT(steady_clock_ns() - begin_ns, 1100 * kMs);
  server.resume();
  // The client that was left behind is closed by and by.
  EXPECT_LT(seconds_until([] { return MidiOutput::open({.api = "jack"}).has_value(); }, 10), 10);
}

TEST(MidiSendersOnJack, SeeThePortTheySendToVanish) {
  support::JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  for (const char* api : {"jack", "rtmidi-jack"}) {
    auto receiver = std::make_unique<JackReceiver>("board");
    auto output = MidiOutput::open({.api = api, .port = "board"});
    ASSERT_TRUE(output.has_value()) << output.error().to_string();
    EXPECT_TRUE((*output)->exists());
    EXPECT_TRUE((*output)->send(std::vector<std::uint8_t>{0xB0, 1, 2}).has_value());
    EXPECT_LT(seconds_until([&] { return receiver->count() == 1; }, 5), 5);
    receiver.reset();
    EXPECT_LT(seconds_until([&] { return !(*output)->exists(); }, 2), 2) << api;
  }
}

}  // namespace
}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// PulseAudio and PipeWire without a sound card: what is played there is measured. Label hosts,
// which the presets leave out. Debian packages: pulseaudio pulseaudio-utils libasound2-plugins
// pipewire pipewire-jack.
#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/audio_device.h"

#include "live/host_servers.h"
#include "live/live_clients.h"
#include "support/background_program.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"

namespace knotwave::io {
namespace {

using support::BackgroundProgram;
using support::expect_program;
using State = AudioStatus::State;

constexpr std::size_t kRateHz = 48000;

/// How the numbers of NumberedClient came out at the other end.
struct Heard {
  std::size_t gaps = 0;         ///< places where the next sample is not the next number
  std::size_t backward = 0;     ///< those where it is an earlier one
  std::size_t longest_run = 0;  ///< samples without one
};

Heard heard_of(const std::vector<float>& samples) {
  Heard heard;
  std::size_t run = 0;
  std::int64_t number = 0;
  for (const float sample : samples) {
    if (sample == 0) continue;  // what the server puts where it has nothing
    const std::int64_t next = NumberedClient::number(sample);
    if (number != 0 && next != number + 1) {
      ++heard.gaps;
      heard.backward += next <= number ? 1U : 0U;
      run = 0;
    }
    number = next;
    heard.longest_run = std::max(heard.longest_run, ++run);
  }
  return heard;
}

void tell(const char* server, const Heard& heard, std::size_t samples) {
  std::cout << server << ": " << samples << " samples, " << heard.gaps << " gaps, longest run "
            << heard.longest_run << "\n";
}

std::vector<float> left_channel(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<float> samples(bytes.size() / sizeof(float) / 2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::memcpy(&samples[i], bytes.data() + 2 * i * sizeof(float), sizeof(float));
  }
  return samples;
}

TEST(PulseAudio, TheNullSinkHearsTheVerySamples) {
  expect_program("pulseaudio", "pulseaudio");
  expect_program("parec", "pulseaudio-utils");
  const support::NoJackServer no_jack;
  support::PulseServer server;
  ASSERT_TRUE(server.start());
  const support::ScratchFolder& folder = server.folder();
  NumberedClient client;
  std::unique_ptr<AudioStream> stream;
  seconds_until(
      [&] {
        auto tried = AudioStream::open({.rate_hz = kRateHz, .latency_s = 0.05}, client);
        if (tried) stream = std::move(*tried);
        return stream != nullptr;
      },
      10);
  ASSERT_TRUE(stream) << "no device: is libasound2-plugins there?";
  EXPECT_EQ(stream->format().api, "alsa");
  ASSERT_TRUE(stream->start());
  {
    const BackgroundProgram capture(
        {"parec", "-d", "nul.monitor", "--format=float32le", "--rate=48000", "--channels=2",
         "--raw", folder.file("heard.raw")},
        folder.file("parec.log"));
    std::this_thread::sleep_for(std::chrono::seconds(4));
    EXPECT_EQ(stream->status().state, State::running) << stream->status().reason;
  }
  EXPECT_LT(seconds_taken([&] { stream.reset(); }), 1);
  const std::vector<float> samples = left_channel(folder.file("heard.raw"));
  const Heard heard = heard_of(samples);
  tell("PulseAudio", heard, samples.size());
  EXPECT_EQ(heard.backward, 0U);
  EXPECT_GE(heard.longest_run, kRateHz / 2);
}

// Run below by the next test, with PipeWire's libjack in place of jackd's.
TEST(PipeWire, DISABLED_AsAClient) {
  NumberedClient client;
  auto opened = AudioStream::open({}, client);
  ASSERT_TRUE(opened) << opened.error().message;
  auto stream = std::move(*opened);
  EXPECT_EQ(stream->format().api, "jack");
  EXPECT_EQ(stream->format().device, "Null");
  EXPECT_TRUE(stream->format().has_midi);
  ASSERT_TRUE(stream->start());
  std::vector<float> samples;
  {
    support::JackCapture capture({stream->format().client_name + ":out_1"}, kRateHz * 3);
    ASSERT_TRUE(capture.is_connected());
    ASSERT_TRUE(capture.wait_for(kRateHz * 3, 20));
    samples = capture.channel(0);
  }
  EXPECT_EQ(stream->status().state, State::running) << stream->status().reason;
  const double latency_s = stream->format().latency_s;
  EXPECT_TRUE(latency_s == -1 || (latency_s >= 0 && latency_s < 10)) << latency_s;
  EXPECT_LT(seconds_taken([&] { stream.reset(); }), 1);
  EXPECT_EQ(client.overlaps(), 0);
  EXPECT_EQ(client.backsteps(), 0);
  EXPECT_LT(steady_clock_ns() - client.last_time_ns(), 2'000'000'000);
  const Heard heard = heard_of(samples);
  tell("PipeWire", heard, samples.size());
  EXPECT_EQ(heard.backward, 0U);
  EXPECT_GE(heard.longest_run, kRateHz / 2);
}

TEST(PipeWire, TheNullSinkHearsTheVerySamples) {
  expect_program("pipewire", "pipewire");
  expect_program("pw-jack", "pipewire-jack");
  support::PipeWireServer server;
  ASSERT_TRUE(server.start());
  const support::ProgramRun inside = support::run_program(
      {"/bin/sh", "-c",
       "exec pw-jack " + ::testing::internal::GetArgvs()[0] +
           " --gtest_also_run_disabled_tests --gtest_filter=PipeWire.DISABLED_AsAClient"});
  EXPECT_EQ(inside.exit_code, 0) << inside.out << inside.err;
  std::cout << inside.out;
}

}  // namespace
}  // namespace knotwave::io

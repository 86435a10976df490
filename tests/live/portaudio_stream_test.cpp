// SPDX-License-Identifier: MIT
// Streams over PortAudio: on a JACK server, which dies, and on ALSA devices that write a file.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/audio_device.h"

#include "live/live_clients.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"

namespace knotwave::io {
namespace {

using support::JackServer;
using State = AudioStatus::State;
using ::testing::HasSubstr;

std::unique_ptr<AudioStream> started(const AudioConfig& config, NumberedClient& client) {
  auto stream = AudioStream::open(config, client);
  if (!stream) {
    ADD_FAILURE() << stream.error().message;
    return nullptr;
  }
  const auto result = (*stream)->start();
  EXPECT_TRUE(result) << result.error().message;
  EXPECT_LT(seconds_until([&] { return client.blocks() > 10; }, 10), 10);
  return std::move(*stream);
}

TEST(PortAudioStream, EverySampleWrittenIsHeardOnceThroughJack) {
  JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  NumberedClient client;
  const auto stream = started({.api = "portaudio-jack", .client_name = "viaPA"}, client);
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->format().api, "portaudio-jack");
  EXPECT_EQ(stream->format().device, "system");
  EXPECT_FALSE(stream->format().has_midi);
  support::JackCapture capture({"viaPA:out_0", "viaPA:out_1"}, 48000);
  ASSERT_TRUE(capture.is_connected());
  ASSERT_TRUE(capture.wait_for(48000, 20));
  const AudioStatus status = stream->status();
  EXPECT_EQ(status.state, State::running) << status.reason;
  EXPECT_GT(status.load_max, 0);
  stream->stop();
  EXPECT_EQ(client.overlaps(), 0);
  EXPECT_EQ(client.backsteps(), 0);
  for (std::size_t c = 0; c < 2; ++c) {
    const std::vector<float> samples = capture.channel(c);
    const auto first = std::find_if(samples.begin(), samples.end(), [](float x) { return x != 0; });
    ASSERT_NE(first, samples.end());
    const std::int64_t number = NumberedClient::number(*first);
    for (auto sample = first; sample != samples.end(); ++sample) {
      ASSERT_EQ(*sample, NumberedClient::sample(number + (sample - first), c)) << c;
    }
  }
}

// Runs in a process of its own, since what is left behind stays: ends with 0 if all is as it should
// be.
void lose_the_server_and_exit() {
  JackServer server;
  NumberedClient client;
  auto stream = started({.api = "portaudio-jack"}, client);
  const auto expect = [](bool is_so, int code) {
    if (!is_so) std::exit(code);
  };
  expect(stream != nullptr, 10);
  server.kill();
  const double noticed_s = seconds_until([&] { return stream->status().state == State::lost; }, 5);
  expect(noticed_s < 1, 11);
  expect(!AudioStream::is_poisoned(), 12);
  expect(seconds_taken([&] { stream->stop(); }) < 1, 13);
  expect(seconds_taken([&] { stream.reset(); }) < 1, 14);
  const std::int64_t blocks = client.blocks();
  expect(AudioStream::is_poisoned(), 15);
  const auto refused = AudioStream::open({.api = "alsa"}, client);
  expect(!refused, 16);
  expect(refused.error().message.find("start the program anew") != std::string::npos, 17);
  expect(seconds_taken([&] { list_audio_devices(); }) < 1, 18);
  expect(AudioStream::open({.api = "none"}, client).has_value(), 19);
  expect(client.blocks() == blocks, 20);
  std::fprintf(stderr, "all is told");
  std::exit(0);
}

TEST(PortAudioStreamDeathTest, AKilledServerIsToldLeftBehindAndDoesNotKeepTheProgramFromItsEnd) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(lose_the_server_and_exit(), ::testing::ExitedWithCode(0), "all is told");
}

/// ALSA devices without a sound card, known to this process while it lives: one that writes floats
/// into a file as fast as it can, and one that swallows them.
class AlsaFile {
 public:
  AlsaFile() {
    std::ofstream(folder_.file(".asoundrc"))
        << "pcm.swallow { type null }\n"
        << "pcm.keep { type file slave.pcm swallow format raw file \"" << path() << "\" }\n";
    const char* const home = std::getenv("HOME");
    home_ = home == nullptr ? "" : home;
    setenv("HOME", folder_.path().c_str(), 1);
  }
  ~AlsaFile() { setenv("HOME", home_.c_str(), 1); }
  AlsaFile(const AlsaFile&) = delete;
  AlsaFile& operator=(const AlsaFile&) = delete;

  std::string path() const { return folder_.file("kept.raw"); }
  std::vector<float> samples() const {
    std::ifstream file(path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    std::vector<float> samples(bytes.size() / sizeof(float));
    std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(float));
    return samples;
  }

 private:
  support::ScratchFolder folder_;
  std::string home_;
};

TEST(PortAudioStream, AlsaPlaysEverySampleInOrderInTheChannelsOfTheMap) {
  const support::NoJackServer no_jack;
  const AlsaFile alsa;
  NumberedClient client;
  auto stream = started(
      {.device = "KEEP", .rate_hz = 44100, .block_frames = 128, .channels = {3, 1}}, client);
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->format().api, "alsa");
  EXPECT_EQ(stream->format().device, "keep");
  EXPECT_EQ(stream->format().rate_hz, 44100);
  EXPECT_EQ(stream->format().block_frames, 128);
  EXPECT_EQ(stream->status().state, State::running) << stream->status().reason;
  stream->stop();
  EXPECT_EQ(stream->status().state, State::stopped);
  stream.reset();
  EXPECT_FALSE(AudioStream::is_poisoned());
  const std::vector<float> samples = alsa.samples();
  // PortAudio fills the device's buffer with silence before it asks for the first block.
  const auto heard = std::find_if(samples.begin(), samples.end(), [](float x) { return x != 0; });
  const std::int64_t silent = (heard - samples.begin()) / 3;
  const std::int64_t frames =
      std::min(static_cast<std::int64_t>(samples.size()) / 3 - silent, client.written());
  ASSERT_GT(frames, 1000);
  for (std::int64_t i = 0; i < frames; ++i) {  // device channels 1, 2, 3: second, nobody, first
    const auto at = static_cast<std::size_t>(3 * (silent + i));
    ASSERT_EQ(samples[at], NumberedClient::sample(i + 1, 1)) << "frame " << i;
    ASSERT_EQ(samples[at + 1], 0) << "frame " << i;
    ASSERT_EQ(samples[at + 2], NumberedClient::sample(i + 1, 0)) << "frame " << i;
  }
}

TEST(PortAudioStream, StartsAgainAfterStop) {
  const support::NoJackServer no_jack;
  const AlsaFile alsa;
  NumberedClient client;
  const auto stream = started({.api = "alsa", .device = "swallow"}, client);
  ASSERT_TRUE(stream);
  EXPECT_GE(stream->format().block_frames, 16);
  stream->stop();
  const std::int64_t blocks = client.blocks();
  ASSERT_TRUE(stream->start());
  EXPECT_LT(seconds_until([&] { return client.blocks() > blocks; }, 10), 10);
  stream->stop();
  EXPECT_EQ(client.overlaps(), 0);
}

TEST(PortAudioStream, NamesAndNumbersFindTheDevicesOfTheList) {
  const support::NoJackServer no_jack;
  const AlsaFile alsa;
  const AudioDeviceList list = list_audio_devices();
  const auto keep = std::find_if(list.devices.begin(), list.devices.end(),
                                 [](const auto& device) { return device.name == "keep"; });
  ASSERT_NE(keep, list.devices.end());
  EXPECT_EQ(keep->api, "alsa");
  EXPECT_GE(keep->outputs, 2);
  EXPECT_THAT(list.notes, ::testing::Contains(HasSubstr("jack: no server is running")));
  NumberedClient client;
  const auto stream = AudioStream::open({.device = std::to_string(keep->number)}, client);
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_EQ((*stream)->format().device, "keep");
  const auto wrong = AudioStream::open({.device = "grand piano"}, client);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::unknown_name);
  EXPECT_THAT(wrong.error().message, HasSubstr("no device 'grand piano'; there is: "));
  EXPECT_THAT(wrong.error().message, HasSubstr(std::to_string(keep->number) + " alsa 'keep'"));
}

TEST(AudioDeviceList, NothingIsPrintedAndStandardErrorIsGivenBack) {
  const support::NoJackServer no_jack;
  ::testing::internal::CaptureStderr();
  list_audio_devices();
  std::fprintf(stderr, "ours");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "ours");
}

}  // namespace
}  // namespace knotwave::io

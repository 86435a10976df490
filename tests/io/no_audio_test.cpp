// SPDX-License-Identifier: MIT
// Built without JACK and without PortAudio.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/audio_device.h"

namespace knotwave::io {
namespace {

using ::testing::HasSubstr;

class NoClient : public AudioClient {
 public:
  void process(const AudioBlock& /*block*/) KNOTWAVE_RT override {}
};

TEST(NoAudio, TheListIsEmptyAndSaysWhatToInstall) {
  const AudioDeviceList list = list_audio_devices();
  EXPECT_TRUE(list.devices.empty());
  EXPECT_THAT(list.notes, ::testing::Contains(HasSubstr("libjack-jackd2-dev")));
  EXPECT_THAT(list.notes, ::testing::Contains(HasSubstr("portaudio19-dev")));
}

TEST(NoAudio, OpenIsUnsupportedWithTheFixAndWhatToInstall) {
  NoClient client;
  for (const char* api : {"", "jack"}) {
    const auto stream = AudioStream::open({.api = api}, client);
    ASSERT_FALSE(stream);
    EXPECT_EQ(stream.error().code, ErrorCode::unsupported);
    EXPECT_THAT(stream.error().message, HasSubstr("no sound device"));
    EXPECT_THAT(stream.error().message, HasSubstr("libjack-jackd2-dev"));
  }
  EXPECT_FALSE(AudioStream::is_poisoned());
}

}  // namespace
}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// The LV2 plugin in jalv under a JACK server: what is heard is what the engine gives for the same
// notes.
#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/plugins/instrument.h"

#include "support/jack_clients.h"
#include "support/jack_server.h"

namespace knotwave {
namespace {

using support::BackgroundProgram;
using support::JackCapture;
using support::JackMidiSender;
using support::JackServer;

constexpr std::size_t kFrames = 48000;

std::vector<JackMidiSender::Message> notes() {
  return {{0, {0x90, 60, 100}},    {5001, {0x90, 67, 80}},  {9000, {0xE0, 0, 80}},
          {20011, {0x80, 60, 64}}, {24000, {0xB0, 1, 100}}, {30013, {0x80, 67, 64}}};
}

struct Heard {
  std::vector<float> left, right;
};

Heard rendered() {
  plugins::Instrument instrument;
  EXPECT_TRUE(instrument.activate(48000));
  Heard heard{std::vector<float>(kFrames), std::vector<float>(kFrames)};
  instrument.begin(heard.left, heard.right);
  for (const auto& message : notes()) {
    engine::Event event;
    event.midi.time.sample = message.after;
    std::copy(message.bytes.begin(), message.bytes.end(), event.midi.bytes);
    instrument.add(event);
  }
  instrument.render();
  return heard;
}

TEST(PluginHosts, JalvGivesTheVerySamplesOfTheEngine) {
  JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  const support::SetVariable path("LV2_PATH", KNOTWAVE_BIN_DIR "/../plugins/lv2");
  const support::ScratchFolder folder;
  BackgroundProgram jalv({"sh", "-c", "sleep 60 | exec jalv -x -n plugin urn:knotwave:instrument"},
                         folder.file("jalv.log"));
  const auto listens = [] {
    const JackMidiSender probe("plugin:lv2_events_in", {});
    return probe.is_connected();
  };
  for (int i = 0; i < 100 && !listens(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  JackCapture capture({"plugin:lv2_audio_out_1", "plugin:lv2_audio_out_2"}, 48000 * 20);
  ASSERT_TRUE(capture.is_connected()) << *base::read_file(folder.file("jalv.log"), 1 << 20);
  JackMidiSender sender("plugin:lv2_events_in", notes());
  ASSERT_TRUE(sender.is_connected());
  ASSERT_TRUE(sender.wait_until_sent(20));
  const std::size_t begin = sender.begin_frame_time() - capture.first_frame_time();
  ASSERT_TRUE(capture.wait_for(begin + kFrames, 20));
  const Heard expected = rendered();
  const std::vector<float> left = capture.channel(0), right = capture.channel(1);
  EXPECT_GT(*std::ranges::max_element(expected.left), 0.01F);
  for (std::size_t i = 0; i < kFrames; ++i) {
    ASSERT_EQ(left[begin + i], expected.left[i]) << i;
    ASSERT_EQ(right[begin + i], expected.right[i]) << i;
  }
}

}  // namespace
}  // namespace knotwave

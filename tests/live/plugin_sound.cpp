// SPDX-License-Identifier: MIT
#include "plugin_sound.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/plugins/instrument.h"

namespace knotwave::support {

std::vector<JackMidiSender::Message> plugin_notes() {
  return {{0, {0x90, 60, 100}},    {5001, {0x90, 67, 80}},  {9000, {0xE0, 0, 80}},
          {20011, {0x80, 60, 64}}, {24000, {0xB0, 1, 100}}, {30013, {0x80, 67, 64}}};
}

Heard rendered(double pan) {
  plugins::Instrument instrument;
  instrument.set_parameter(plugins::Instrument::table().of_word("pan"), pan);
  EXPECT_TRUE(instrument.activate(48000));
  std::vector<float> before(kFramesBefore), too(kFramesBefore);
  instrument.begin(before, too);
  instrument.render();
  Heard heard{std::vector<float>(kHeardFrames), std::vector<float>(kHeardFrames)};
  instrument.begin(heard.left, heard.right);
  for (const auto& message : plugin_notes()) {
    engine::Event event;
    event.midi.time.sample = message.after;
    std::copy(message.bytes.begin(), message.bytes.end(), event.midi.bytes);
    instrument.add(event);
  }
  instrument.render();
  return heard;
}

bool comes(const std::string& port, int seconds) {
  for (int i = 0; i < seconds * 10; ++i) {
    const JackMidiSender probe(port, {});
    if (probe.is_connected()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

void expect_heard(const std::string& notes_in, const std::string& left_out,
                  const std::string& right_out, const Heard& expected) {
  JackCapture capture({left_out, right_out}, 48000 * 20);
  ASSERT_TRUE(capture.is_connected());
  JackMidiSender sender(notes_in, plugin_notes());
  ASSERT_TRUE(sender.is_connected());
  ASSERT_TRUE(sender.wait_until_sent(20));
  const std::size_t begin = sender.begin_frame_time() - capture.first_frame_time();
  ASSERT_TRUE(capture.wait_for(begin + kHeardFrames, 20));
  const std::vector<float> left = capture.channel(0), right = capture.channel(1);
  EXPECT_GT(*std::ranges::max_element(expected.left), 0.01F);
  for (std::size_t i = 0; i < kHeardFrames; ++i) {
    ASSERT_EQ(left[begin + i], expected.left[i]) << i;
    ASSERT_EQ(right[begin + i], expected.right[i]) << i;
  }
}

}  // namespace knotwave::support

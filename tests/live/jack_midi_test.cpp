// SPDX-License-Identifier: MIT
// The MIDI port of a stream of JACK: offsets to the sample, order, system exclusive.
#include <algorithm>
#include <array>

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

/// Writes an impulse where a note begins, as high as its velocity, and keeps all messages.
class ImpulseClient : public AudioClient {
 public:
  struct Message {
    std::array<std::uint8_t, 3> bytes;
    std::vector<std::uint8_t> sysex;
    std::int64_t frame;
  };
  ImpulseClient() { messages_.reserve(10000); }

  void process(const AudioBlock& block) KNOTWAVE_RT override {
    std::fill_n(block.outputs[0], block.frames, 0.0F);
    for (const base::MidiEvent& event : block.midi) {
      const std::int64_t offset = event.time.sample;
      faults_ += offset < 0 || offset >= block.frames || event.time.fraction != 0 ? 1 : 0;
      if (event.bytes[0] == 0x90) {
        block.outputs[0][offset] += static_cast<float>(event.bytes[2]) / 128;
      }
      messages_.push_back({{event.bytes[0], event.bytes[1], event.bytes[2]},
                           {event.sysex, event.sysex + event.sysex_size},
                           block.frame + offset});
    }
    count_ = messages_.size();
  }
  std::size_t count() const { return count_; }
  // Of a stream that is stopped:
  const std::vector<Message>& messages() const { return messages_; }
  int faults() const { return faults_; }

 private:
  std::vector<Message> messages_;
  int faults_ = 0;
  std::atomic<std::size_t> count_{0};
};

class JackMidiTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(server_.runs()) << server_.log();
    auto stream = AudioStream::open({.channels = {1}}, client_);
    ASSERT_TRUE(stream) << stream.error().message;
    stream_ = std::move(*stream);
    ASSERT_TRUE(stream_->start());
  }
  std::string port(const char* name) const { return stream_->format().client_name + ":" + name; }

  JackServer server_;
  ImpulseClient client_;
  std::unique_ptr<AudioStream> stream_;
};

TEST_F(JackMidiTest, ANoteSoundsAtTheVeryFrameItWasSentAt) {
  std::vector<JackMidiSender::Message> notes;
  for (int i = 0; i < 200; ++i) {  // at each place of a block, and right at its borders
    const std::int64_t frame = 20000 + i * 511 + (i % 3 == 0 ? 1 : 0);
    const auto velocity = static_cast<std::uint8_t>(1 + i % 127);
    notes.push_back({frame, {0x90, 60, velocity}});
  }
  JackCapture capture({port("out_1")}, 48000 * 8);
  ASSERT_TRUE(capture.is_connected());
  JackMidiSender sender(port("midi_in"), notes);
  ASSERT_TRUE(sender.is_connected());
  ASSERT_TRUE(sender.wait_until_sent(20));
  EXPECT_EQ(stream_->status().midi_sources, std::vector<std::string>{"sender:out"});
  ASSERT_TRUE(capture.wait_for(capture.frames() + 4096, 20));
  stream_->stop();
  EXPECT_EQ(sender.refused(), 0);
  EXPECT_EQ(client_.faults(), 0);
  const std::vector<float> samples = capture.channel(0);
  const auto begin =
      static_cast<std::int32_t>(sender.begin_frame_time() - capture.first_frame_time());
  for (const auto& note : notes) {
    const std::size_t at = static_cast<std::size_t>(begin + note.after);
    ASSERT_LT(at, samples.size());
    EXPECT_EQ(samples[at], static_cast<float>(note.bytes[2]) / 128) << "at frame " << note.after;
  }
  EXPECT_EQ(std::count_if(samples.begin(), samples.end(), [](float x) { return x != 0; }), 200);
}

TEST_F(JackMidiTest, MessagesOfOneFrameKeepTheirOrderAndAreWhole) {
  const std::vector<std::uint8_t> sysex = {0xF0, 0x7D, 1, 2, 3, 0xF7}, empty = {0xF0, 0xF7};
  const std::vector<JackMidiSender::Message> sent = {
      {3000, {0x90, 60, 100}}, {3000, {0x80, 60, 64}}, {3000, {0x90, 60, 0}}, {3000, sysex},
      {3000, {0xF8}},          {3000, {0xC3, 5}},      {3001, {0xE0, 0, 64}}, {3001, empty},
      {3001, {0xF2, 1, 2}},    {9000, {0xB0, 123, 0}}, {9000, {0xD0, 7}},     {9000, {0xFE}},
  };
  JackMidiSender sender(port("midi_in"), sent);
  ASSERT_TRUE(sender.is_connected());
  EXPECT_LT(seconds_until([&] { return client_.count() >= sent.size(); }, 20), 20);
  stream_->stop();
  ASSERT_EQ(client_.messages().size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const ImpulseClient::Message& got = client_.messages()[i];
    EXPECT_EQ(got.frame - client_.messages()[0].frame, sent[i].after - sent[0].after) << i;
    EXPECT_EQ(got.bytes[0], sent[i].bytes[0]) << i;
    if (sent[i].bytes[0] == 0xF0) {
      const std::vector<std::uint8_t> data(sent[i].bytes.begin() + 1, sent[i].bytes.end() - 1);
      EXPECT_EQ(got.sysex, data) << i;
      continue;
    }
    for (std::size_t k = 1; k < 3; ++k) {
      EXPECT_EQ(got.bytes[k], k < sent[i].bytes.size() ? sent[i].bytes[k] : 0) << i;
    }
  }
  EXPECT_EQ(stream_->status().midi_dropped, 0);
}

TEST_F(JackMidiTest, WhatIsNoMessageIsDroppedAndCounted) {
  const std::vector<JackMidiSender::Message> sent = {
      {3000, {0x90, 60}},      {3000, {60, 100}}, {3000, {0x90, 60, 100, 0}},
      {3000, {0x90, 0x80, 1}}, {3000, {0xF0, 1}}, {3000, {0xF0, 0xF8, 0xF7}},
      {3000, {0xF4}},          {3000, {0xF7}},    {3001, {0x90, 61, 1}},
  };
  JackMidiSender sender(port("midi_in"), sent);
  ASSERT_TRUE(sender.is_connected());
  EXPECT_LT(seconds_until([&] { return client_.count() >= 1; }, 20), 20);
  stream_->stop();
  ASSERT_EQ(client_.messages().size(), 1U);
  EXPECT_EQ(client_.messages()[0].bytes[1], 61);
  EXPECT_EQ(stream_->status().midi_dropped, 8);
}

TEST_F(JackMidiTest, AsManyMessagesAsTheServerCarriesInABlockAllArrive) {
  std::vector<JackMidiSender::Message> sent;
  for (int i = 0; i < 2000; ++i) {
    sent.push_back(
        {3000, {0xB0, static_cast<std::uint8_t>(i / 128), static_cast<std::uint8_t>(i % 128)}});
  }
  JackMidiSender sender(port("midi_in"), sent);
  ASSERT_TRUE(sender.is_connected());
  EXPECT_LT(seconds_until([&] { return client_.count() >= sent.size(); }, 20), 20);
  stream_->stop();
  ASSERT_EQ(client_.messages().size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    ASSERT_EQ(client_.messages()[i].bytes[1] * 128 + client_.messages()[i].bytes[2],
              static_cast<int>(i));
  }
}

}  // namespace
}  // namespace knotwave::io

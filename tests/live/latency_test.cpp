// SPDX-License-Identifier: MIT
// From a MIDI message to its first sample, through the loop: what is sent at a known frame, or
// stamped at a known time, and where its click begins in what is captured. Each test prints its
// figures; docs/live.md has them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/base/random.h"
#include "knotwave/engine/live_engine.h"
#include "knotwave/io/audio_device.h"

#include "live/live_clients.h"
#include "live/synth_process.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"
#include "support/program.h"

namespace knotwave::synth {
namespace {

using io::AudioBlock;
using io::seconds_until;
using support::JackCapture;
using support::JackMidiSender;
using support::JackServer;

/// Loudest at its very first sample, silent again 5 ms later.
constexpr const char* kClick = R"(format = 1
kind = "patch"
name = "click"
velocity_db = 0
[curves.fall]
degree = 1
points = [1, 0]
[oscillators.a]
wave = "sine"
phase = 0.25
[envelopes.amp]
curve = "fall"
seconds = 0.005
)";

/// Where each click begins: sound after 10 ms of silence.
std::vector<std::int64_t> onsets_in(const std::vector<float>& samples) {
  std::vector<std::int64_t> onsets;
  std::int64_t silent = 480;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] != 0 && silent >= 480) onsets.push_back(static_cast<std::int64_t>(i));
    silent = samples[i] != 0 ? 0 : silent + 1;
  }
  return onsets;
}

void print(const std::string& path, std::vector<double> frames) {
  ASSERT_FALSE(frames.empty());
  std::sort(frames.begin(), frames.end());
  const auto ms = [](double n) { return n / 48; };
  std::cout << "latency, " << path << ": " << frames.size() << " notes, median "
            << frames[frames.size() / 2] << " frames (" << ms(frames[frames.size() / 2])
            << " ms), half of them " << frames[frames.size() / 4] << " to "
            << frames[frames.size() * 3 / 4] << ", least " << frames.front() << ", most "
            << frames.back() << std::endl;
}

/// The whole synth under a server of blocks of 128 frames, paced by the clock.
class LatencyOfSynth : public testing::Test {
 protected:
  /// From a program's port, to where the synth sounds.
  struct Way {
    std::vector<std::string> words;  ///< of the synth's command line
    std::string out;
    /// What the sender connects itself to; empty: the synth finds it.
    std::string in;
  };
  /// Frames from when each note was sent to its first sample.
  std::vector<double> measured(const Way& way) {
    const auto written = base::write_file(folder_.path() + "/click.toml", kClick);
    EXPECT_TRUE(written.has_value());
    SynthProcess::Options options;
    options.folder = folder_.path();
    std::vector<std::string> words = {"click.toml", "--json-status"};
    words.insert(words.end(), way.words.begin(), way.words.end());
    SynthProcess synth(words, options);
    EXPECT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
    JackCapture capture({way.out}, 20 * 48000);
    EXPECT_TRUE(capture.is_connected());
    std::vector<JackMidiSender::Message> notes;
    for (int i = 0; i < 64; ++i) {  // at every other place of a block
      notes.push_back({48000 + i * 7938, {0x90, 69, 100}});
      notes.push_back({48000 + i * 7938 + 500, {0x80, 69, 0}});
    }
    JackMidiSender sender(way.in, notes);
    EXPECT_EQ(sender.is_connected(), !way.in.empty());
    EXPECT_TRUE(sender.wait_until_sent(30));
    EXPECT_TRUE(capture.wait_for(capture.frames() + 9600, 20));
    const auto begin =
        static_cast<std::int32_t>(sender.begin_frame_time() - capture.first_frame_time());
    std::vector<double> frames;
    for (const std::int64_t onset : onsets_in(capture.channel(0))) {  // of the note sent last
      for (std::size_t k = notes.size(); k > 0; k -= 2) {
        const std::int64_t sent = begin + notes[k - 2].after;
        if (sent > onset) continue;
        frames.push_back(static_cast<double>(onset - sent));
        break;
      }
    }
    synth.signal(SIGTERM);
    EXPECT_EQ(synth.exit_code(), 0);
    return frames;
  }

  JackServer server_{128};
  support::ScratchFolder folder_;
};

TEST_F(LatencyOfSynth, ByTheStreamsOwnMidiPortItIsNoneAtAll) {
  ASSERT_TRUE(server_.runs()) << server_.log();
  const std::vector<double> frames = measured({{}, "Knotwave:out_1", "Knotwave:midi_in"});
  print("a port of JACK to the synth's own, blocks of 128", frames);
  EXPECT_EQ(frames.size(), 64U);
  for (const double each : frames) ASSERT_EQ(each, 0);
}

// Its stamps are of blocks, and so is the time of PortAudio's: no figure is promised here.
TEST_F(LatencyOfSynth, ByRtMidiUnderPortAudioEveryNoteIsHeard) {
  ASSERT_TRUE(server_.runs()) << server_.log();
  const std::vector<double> frames =
      measured({{"--audio-api", "portaudio-jack", "--block", "128"}, "Knotwave:out_0", ""});
  print("RtMidi over JACK, blocks of 128", frames);
  EXPECT_EQ(frames.size(), 64U);
}

/// The engine under a stream; keeps what it plays and when each block was due.
class Player : public io::AudioClient {
 public:
  explicit Player(engine::LiveEngine& live) : live_(live) {
    left_.reserve(60 * 48000);
    blocks_.reserve(60 * 48000 / 16);
  }

  void process(const AudioBlock& block) KNOTWAVE_RT override {
    const auto frames = static_cast<std::size_t>(block.frames);
    const std::size_t at = left_.size();
    left_.resize(at + frames);
    live_.process(block.time_ns, {}, std::span(left_).subspan(at), {block.outputs[1], frames});
    std::copy_n(left_.begin() + static_cast<std::ptrdiff_t>(at), frames, block.outputs[0]);
    blocks_.push_back({static_cast<std::int64_t>(at), block.time_ns, io::steady_clock_ns()});
  }

  // Of a stream that is stopped:
  const std::vector<float>& left() const { return left_; }
  /// Frames from a time to a sample, by the times of blocks; none where a block between the two was
  /// done over a millisecond after it was due: the machine was late then, not the engine.
  std::optional<double> frames_between(std::int64_t time_ns, std::int64_t sample) const {
    const auto after = [](std::int64_t at, const Block& block) { return at < block.sample; };
    const auto heard = std::upper_bound(blocks_.begin(), blocks_.end(), sample, after) - 1;
    for (auto block = heard; block->done_ns >= time_ns; --block) {
      if (block->done_ns - block->time_ns > 1'000'000 || block == blocks_.begin()) return {};
    }
    return static_cast<double>(heard->time_ns - time_ns) * 48e-6 +
           static_cast<double>(sample - heard->sample);
  }

 private:
  struct Block {
    std::int64_t sample = 0, time_ns = 0, done_ns = 0;
  };
  engine::LiveEngine& live_;
  std::vector<float> left_;
  std::vector<Block> blocks_;
};

/// Frames from the time each note was stamped to its first sample, and what the engine says of it
/// at the end.
struct Stamped {
  std::vector<double> frames;
  double told = 0;
};
Stamped stamped() {
  auto bank = engine::BankProgram::create(engine::bank_of(*engine::parse_patch(kClick, "click")));
  auto live = *engine::LiveEngine::create({}, *std::move(bank));
  Player player(*live);
  auto stream =
      io::AudioStream::open({.api = "none", .rate_hz = 48000, .block_frames = 64}, player);
  EXPECT_TRUE(stream) << stream.error().message;
  EXPECT_TRUE((*stream)->start());
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the loop has settled
  std::vector<std::int64_t> stamps_ns;
  const base::RandomStream random{7, 0, 0};
  for (std::uint64_t i = 0; i < 100; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(30000 + random.bits(i) % 8192));
    const std::int64_t late = live->status().messages_late;
    const std::int64_t before = live->status().counters.notes;
    engine::LiveMessage note;
    note.time_ns = io::steady_clock_ns();
    note.bytes[0] = 0x90;
    note.bytes[1] = 69;
    note.bytes[2] = 100;
    EXPECT_TRUE(live->push(0, note));
    seconds_until([&] { return live->status().counters.notes > before; }, 5);
    // A thread put aside between stamp and ring is not the engine's doing.
    stamps_ns.push_back(live->status().messages_late == late ? note.time_ns : 0);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  (*stream)->stop();
  const std::vector<std::int64_t> onsets = onsets_in(player.left());
  Stamped result;
  result.told = live->status().latency_frames;
  EXPECT_EQ(onsets.size(), stamps_ns.size());
  for (std::size_t i = 0; onsets.size() == stamps_ns.size() && i < onsets.size(); ++i) {
    if (stamps_ns[i] == 0) continue;
    const auto frames = player.frames_between(stamps_ns[i], onsets[i]);
    if (frames) result.frames.push_back(*frames);
  }
  return result;
}

TEST(LatencyOfStamps, UnderAnExactClockItIsWhatIsToldToASample) {
  const Stamped all = stamped();
  print("stamps, blocks of 64 by the clock", all.frames);
  for (const double each : all.frames) ASSERT_NEAR(each, all.told, 1);
}

}  // namespace
}  // namespace knotwave::synth

// SPDX-License-Identifier: MIT
// Ten million messages of sixteen cables, of other inputs and of the stream's own port, all kinds
// and none, over a whole General MIDI bank: no note stays, no sample is no number, and the audio
// thread allocates nothing.
#include <array>
#include <cmath>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>

#include "knotwave/engine/channel_state.h"
#include "knotwave/io/midi_stream.h"

#include "cable_bytes.h"
#include "engine/live_device.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::endurance {
namespace {

using namespace engine;          // NOLINT: the words of these tests
using namespace engine::scenes;  // NOLINT

constexpr std::size_t kBlock = 128;
constexpr int kCables = 16, kOtherInput = 17, kCalmInput = 18;
constexpr int kVoices = 12, kRoom = 512;
constexpr std::int64_t kTolerance = 2400;  // 50 ms

std::unique_ptr<const BankProgram> general_midi() {
  const auto spec = read_bank(KNOTWAVE_SOURCE_DIR "/examples/banks/general-midi.toml");
  EXPECT_TRUE(spec) << spec.error().to_string();
  auto bank = BankProgram::create(*spec);
  EXPECT_TRUE(bank) << bank.error().to_string();
  return *std::move(bank);
}

/// Samples from a note-off to silence, the most of all programs and drums at both ends of the
/// keyboard, struck softly and hard.
std::int64_t longest_release(const BankProgram& bank) {
  const auto engine = engine_for(bank, {.max_voices = 128});
  std::int64_t longest = 0;  // a low cymbal's: key_time doubles it every octave
  for (int program = 0; program < 128; ++program) {
    std::vector<Event> events, ends;
    for (const int key : {0, 35, 60, 81, 127}) {
      for (const int velocity : {1, 127}) {
        const int channel = velocity == 1 ? 0 : 1;
        events.push_back(midi(engine->now(), 0xC0 | channel, program, 0));
        events.push_back(on(engine->now(), channel, key, velocity));
        events.push_back(midi(engine->now(), 0xC9, program, 0));
        if (program == 0) events.push_back(on(engine->now(), 9, key, velocity));
        ends.push_back(off(engine->now() + 4800, channel, key));
        ends.push_back(off(engine->now() + 4800, 9, key));
      }
    }
    events.insert(events.end(), ends.begin(), ends.end());
    play(*engine, events, 4800 + 256);
    std::int64_t waited = 0;
    for (; !engine->is_idle() && waited < 48000 * 600; waited += 256) play(*engine, {}, 256);
    longest = std::max(longest, waited + 256);
  }
  return longest;
}

/// Plays cables into a live engine, block after block, and looks at every sample.
class Flood {
 public:
  explicit Flood(std::unique_ptr<const BankProgram> bank)
      : live_(live_for(std::move(bank),
                       {.engine = {.max_voices = kVoices}, .input_messages = kRoom})) {
    for (std::uint32_t c = 0; c < kCables; ++c) cables_.emplace_back(random_.seed, c);
    exact_.reserve(1024);
    bytes_.reserve(1 << 17);
  }

  /// A block with some hundred messages, now and then with more of one cable than there is room
  /// for. Every eighth phrase comes by the stream's own port; `with_targets`, another input sends
  /// what is no MIDI and makes no sense.
  void block(bool with_targets) {
    exact_.clear();
    const bool is_burst = below(400) == 0;
    const int burst_cable = below(kCables);
    for (int i = is_burst ? 700 : 48; i > 0; --i) {
      const auto cable = static_cast<std::size_t>(is_burst ? burst_cable : below(kCables));
      bytes_.clear();
      cables_[cable].add_phrase(bytes_);
      allocations_ += support::allocations_in([&] { hear(cable, i % 8 == 7); });
    }
    if (with_targets) push_nonsense();
    render();
  }
  void panic() { live_->panic(); }
  /// What a player does who wants silence: all keys and pedals up, on every channel.
  void lift_all() {
    for (int channel = 0; channel < 16; ++channel) {
      for (const int controller : {kSustain, kSostenuto, kAllNotesOff}) {
        live_->push(kCalmInput, scenes::message(0, 0xB0 | channel, controller, 0));
      }
    }
  }
  void reset() { live_->push(kCalmInput, scenes::message(0, 0xFF, 0, 0)); }
  void play_note() { live_->push(kCalmInput, scenes::message(0, 0x90, 60, 127)); }
  void render_quiet(std::int64_t frames) {
    exact_.clear();
    for (std::int64_t done = 0; done < frames; done += kBlock) render();
  }
  /// The loudest sample since it was last asked for.
  float take_peak() { return std::exchange(peak_, 0.0F); }

  LiveStatus status() { return live_->status(); }
  std::int64_t messages() const { return messages_; }
  std::int64_t bytes() const { return bytes_heard_; }
  std::int64_t allocations() const { return allocations_; }
  std::int64_t not_finite() const { return not_finite_; }
  const std::array<std::int64_t, 16>& of_status() const { return of_status_; }
  float loudest() const { return loudest_; }
  io::MidiStreamCounters faults() const {
    io::MidiStreamCounters all;
    for (const io::MidiStream& stream : streams_) {
      all.stray_bytes += stream.counters().stray_bytes;
      all.cut_messages += stream.counters().cut_messages;
      all.sysex_too_long += stream.counters().sysex_too_long;
    }
    return all;
  }

 private:
  int below(int end) {
    return static_cast<int>(random_.bits(draw_++) % static_cast<std::uint64_t>(end));
  }
  std::int64_t time_ns() const { return 5'000'000'000 + frame_ * 62500 / 3; }

  void hear(std::size_t cable, bool is_exact) {
    io::MidiStream& stream = streams_[cable];
    bytes_heard_ += static_cast<std::int64_t>(bytes_.size());
    for (const std::uint8_t byte : bytes_) {
      if (!stream.feed(byte)) continue;
      base::MidiEvent event = stream.message();
      ++messages_;
      ++of_status_[event.bytes[0] < 0xF0 ? event.bytes[0] >> 4 : 15];
      // What is exact refers to system exclusive data until the block is over.
      if (is_exact && event.sysex_size == 0 && exact_.size() < exact_.capacity()) {
        event.time.sample = below(kBlock);
        exact_.push_back({.midi = event});
      } else {
        live_->push(static_cast<int>(cable), live_message(event, time_ns() - below(2'000'000)));
      }
    }
  }
  void push_nonsense() {
    constexpr std::array<double, 6> kNumbers = {std::numeric_limits<double>::quiet_NaN(),
                                                std::numeric_limits<double>::infinity(),
                                                -1e300,
                                                0,
                                                -3,
                                                400000};
    LiveMessage message = scenes::message(time_ns() - below(4'000'000), 0, 0, 0);
    for (std::uint8_t& byte : message.bytes) byte = static_cast<std::uint8_t>(below(256));
    message.kind = static_cast<LiveMessage::Kind>(below(3));
    message.number = kNumbers[static_cast<std::size_t>(below(6))];
    message.index = static_cast<std::uint16_t>(below(200));
    message.sysex_size = static_cast<std::uint8_t>(below(256));
    live_->push(kOtherInput, message);
    ++messages_;
  }
  void render() {
    allocations_ +=
        support::allocations_in([&] { live_->process(time_ns(), exact_, left_, right_); });
    frame_ += kBlock;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float most = std::max(std::abs(left_[i]), std::abs(right_[i]));
      if (!std::isfinite(left_[i]) || !std::isfinite(right_[i])) ++not_finite_;
      peak_ = std::max(peak_, most);
    }
    loudest_ = std::max(loudest_, peak_);
    if (frame_ / static_cast<std::int64_t>(kBlock) % 32 == 0) live_->take_journal(journal_);
    journal_.records.clear();
  }

  std::unique_ptr<LiveEngine> live_;
  std::vector<CableBytes> cables_;
  std::array<io::MidiStream, kCables> streams_;
  base::RandomStream random_{support::test_seed(), 0, 7201};
  std::uint64_t draw_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::vector<engine::Event> exact_;
  Journal journal_;
  std::array<float, kBlock> left_{}, right_{};
  std::array<std::int64_t, 16> of_status_{};
  std::int64_t frame_ = 0, messages_ = 0, bytes_heard_ = 0, allocations_ = 0, not_finite_ = 0;
  float peak_ = 0, loudest_ = 0;
};

/// After a panic at once, after keys and pedals went up when the longest release is over.
void expect_silence(Flood& flood, bool is_panic, std::int64_t release) {
  if (is_panic) {
    flood.panic();
    flood.render_quiet(kTolerance);
  } else {
    flood.render_quiet(8 * kBlock);  // what was heard before is played before
    flood.lift_all();
    flood.render_quiet(kTolerance);
    for (std::int64_t waited = 0; waited < release && flood.status().counters.voices_now > 0;) {
      flood.render_quiet(kBlock);
      waited += kBlock;
    }
  }
  EXPECT_EQ(flood.status().counters.voices_now, 0) << (is_panic ? "panic" : "all lifted");
  flood.take_peak();
  flood.render_quiet(480);
  EXPECT_EQ(flood.take_peak(), 0.0F) << (is_panic ? "panic" : "all lifted");
}

/// A key still plays, and stops.
void expect_playable(Flood& flood) {
  flood.reset();
  flood.play_note();
  flood.render_quiet(4800);
  EXPECT_EQ(flood.status().counters.voices_now, 1);
  EXPECT_GT(flood.take_peak(), 1e-3F);
  flood.panic();
  flood.render_quiet(kTolerance);
}

void tell(Flood& flood, std::int64_t release, int silences) {
  const LiveStatus status = flood.status();
  const io::MidiStreamCounters faults = flood.faults();
  std::cout << flood.messages() << " messages of " << flood.bytes() << " bytes, "
            << status.counters.notes << " notes, " << status.counters.voices_stolen
            << " stolen, loudest sample " << flood.loudest() << "; stray bytes "
            << faults.stray_bytes << ", cut messages " << faults.cut_messages << ", sysex too long "
            << faults.sysex_too_long << ", unknown " << status.counters.events_unknown
            << ", without room " << status.messages_dropped << "; silent " << silences
            << " times, longest release " << static_cast<double>(release) / kRateHz << " s\n";
}

void flood_with(std::int64_t messages, std::int64_t between_silences) {
  auto bank = general_midi();
  const std::int64_t release = longest_release(*bank);
  Flood flood(std::move(bank));
  int silences = 0;
  while (flood.messages() < messages && !testing::Test::HasFailure()) {
    const bool is_panic = silences % 2 == 0;
    for (const std::int64_t end = flood.messages() + between_silences; flood.messages() < end;) {
      flood.block(is_panic);
    }
    expect_silence(flood, is_panic, release);
    ++silences;
  }
  expect_playable(flood);
  EXPECT_EQ(flood.allocations(), 0);
  EXPECT_EQ(flood.not_finite(), 0);
  const LiveStatus status = flood.status();
  EXPECT_GT(status.counters.notes, messages / 20);
  EXPECT_GT(status.counters.voices_stolen, messages / 100);
  EXPECT_LE(status.counters.voices_peak, kVoices);
  EXPECT_GT(status.counters.events_unknown, 0);
  for (int nibble = 8; nibble < 16; ++nibble) {
    EXPECT_GT(flood.of_status()[static_cast<std::size_t>(nibble)], messages / 200) << nibble;
  }
  EXPECT_GT(flood.faults().stray_bytes, 0);
  EXPECT_GT(flood.faults().cut_messages, 0);
  EXPECT_GT(status.messages_dropped, 0);
  tell(flood, release, silences);
}

TEST(MidiFlood, EndsInSilence) { flood_with(support::test_count(100000), 25000); }

TEST(MidiFloodStress, OfTenMillionMessagesEndsInSilence) { flood_with(10'000'000, 100'000); }

}  // namespace
}  // namespace knotwave::endurance

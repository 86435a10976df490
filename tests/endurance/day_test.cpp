// SPDX-License-Identifier: MIT
// A day of playing, faster than it lasts, and on past sample 2^32: what is played the same sounds
// the same, nothing is left behind, and a note that is held all the time is in tune.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include "knotwave/base/random.h"
#include "knotwave/base/sha256.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/map_slots.h"

#include "engine/live_device.h"
#include "support/allocation_count.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

constexpr std::int64_t kTwoTo31 = std::int64_t{1} << 31;
constexpr std::int64_t kTwoTo32 = std::int64_t{1} << 32;
constexpr std::int64_t kDay = 24 * 3600 * std::int64_t{48000};
/// One round of the score, 60.07 s: 44 cycles of the patch's free LFO, which runs at 48000/65536 Hz
/// so that its phase is a whole number of 2^-64 cycles at every sample.
constexpr std::int64_t kRound = 44 * 65536;
constexpr std::int64_t kThird = kRound / 3;  ///< after each another bank is installed
constexpr std::int64_t kMostBlock = 1024;

/// A voice of many parts and little work; everything it does comes back with the round.
constexpr std::string_view kHourglass = R"(
format = 1
kind = "patch"
name = "Hourglass"
polyphony = 3
glide_s = 0.1
[curves.gate]
degree = 2
points = [0, 1, 1, 1, 0, 0]
knots = [0,0,0, 0.01,0.01, 0.2, 0.4,0.4,0.4]
[curves.drawn]
degree = 3
periodic = true
points = [-0.9, -0.2, 0.9, 1, 0.2, 0.7, 0.1, -0.3, 0.35, -0.5, -1]
[oscillators.a]
wave = "drawn"
[filter]
kind = "low"
cutoff_hz = 1500
resonance = 0.3
key_track = 0.5
[envelopes.amp]
curve = "gate"
seconds = 0.4
sustain_at = 0.01
release_at = 0.01
[lfos.slow]
curve = "sine"
rate_hz = 0.732421875
mode = "free"
[lfos.vibrato]
curve = "triangle"
rate_hz = 5.3
[[maps]]
from = "slow"
to = "filter.cutoff"
depth = 7
[[maps]]
from = "vibrato"
to = "pitch"
depth = 0.2
)";

/// Something a player does at a sample of the round.
struct Deed {
  std::int64_t sample = 0;
  bool is_exact = false;  ///< of the stream's own port; else of a cable
  LiveMessage message;
};

/// Notes of two hands, the second of them mono, with pedals, bends, controllers, targets and
/// tempos; at the end everything goes back.
std::vector<Deed> score() {
  const base::RandomStream random{1, 0, 7100};
  std::vector<Deed> deeds;
  const auto add = [&](std::int64_t sample, int status, int one, int two) {
    deeds.push_back({sample, (sample & 1) != 0, message(0, status, one, two)});
  };
  add(10, 0xB1, kMonoOn, 1);
  for (std::int64_t at = 4000; at < kRound - 60000; at += 19000) {
    const std::uint64_t bits = random.bits(static_cast<std::uint64_t>(at));
    const int channel = static_cast<int>(bits & 1), key = 45 + static_cast<int>(bits >> 8 & 31);
    add(at, 0x90 | channel, key, 40 + static_cast<int>(bits >> 16 & 63));
    add(at + 5000 + static_cast<std::int64_t>(bits >> 24 & 8191), 0x80 | channel, key, 64);
    add(at + 777, 0xE0 | channel, 0, static_cast<int>(bits >> 40 & 127));
    add(at + 1500, 0xB0 | channel, kSustain, (bits >> 48 & 3) == 0 ? 127 : 0);
    add(at + 2500, 0xB0 | channel, kExpression, 90 + static_cast<int>(bits >> 50 & 31));
    Deed other{at + 3001, false, message(0, 0, 0, 0)};
    other.message.kind = LiveMessage::Kind::set_target;
    other.message.index = kSlotCutoff;
    other.message.number = static_cast<double>(bits >> 56 & 7);
    if ((bits >> 59 & 1) != 0) {
      other.message.kind = LiveMessage::Kind::tempo;
      other.message.number = 400000 + static_cast<double>(bits >> 44 & 65535);
    }
    deeds.push_back(other);
  }
  add(kRound - 30001, 0xFF, 0, 0);
  std::stable_sort(deeds.begin(), deeds.end(),
                   [](const Deed& a, const Deed& b) { return a.sample < b.sample; });
  return deeds;
}

/// Block sizes of a round.
std::vector<std::size_t> blocks() {
  const base::RandomStream random{1, 0, 7101};
  std::vector<std::size_t> sizes;
  for (std::int64_t at = 0; at < kRound; at += static_cast<std::int64_t>(sizes.back())) {
    const std::uint64_t number = sizes.size();
    const std::int64_t size = number % 8 == 0
                                  ? kMostBlock
                                  : 1 + static_cast<std::int64_t>(random.bits(number) % kMostBlock);
    sizes.push_back(static_cast<std::size_t>(std::min(size, kRound - at)));
  }
  return sizes;
}

/// malloc counts what it keeps for next time as in use, so only objects are exact.
struct Memory {
  std::int64_t objects = 0, heap_bytes = 0, resident_bytes = 0;
};
constexpr std::int64_t kKeptByMalloc = 1 << 16;
Memory memory_now() {
  std::ifstream file("/proc/self/statm");
  std::int64_t whole = 0, resident = 0;
  file >> whole >> resident;
  return {support::live_objects(), static_cast<std::int64_t>(mallinfo2().uordblks),
          resident * sysconf(_SC_PAGESIZE)};
}

/// The score under a live engine, round after round.
class Rounds {
 public:
  Rounds() : live_(live_for(bank_from(kHourglass), {.engine = {.max_voices = 8}}, {})) {}

  std::int64_t now() const { return frame_; }
  const std::vector<float>& left() const { return left_; }
  LiveEngine& live() { return *live_; }

  /// Plays a round into left().
  void play() {
    std::size_t next = 0;
    std::int64_t at = 0;
    for (const std::size_t size : sizes_) {
      const auto end = at + static_cast<std::int64_t>(size);
      exact_.clear();
      for (; next < deeds_.size() && deeds_[next].sample < end; ++next) tell(deeds_[next], at);
      const auto offset = static_cast<std::size_t>(at);
      block(std::span(left_).subspan(offset, size), std::span(right_).subspan(offset, size));
      if (at / kThird != end / kThird) live_->install(bank_of_third(end / kThird));
      at = end;
    }
    look_after();
  }
  /// Nobody plays for a number of samples that are whole cycles of the free LFO.
  void rest(std::int64_t samples) {
    exact_.clear();
    for (std::int64_t at = 0; at < samples; at += kMostBlock) {
      block(std::span(left_).first(kMostBlock), std::span(right_).first(kMostBlock));
    }
  }

 private:
  // A cable is heard before the block that plays it is asked for.
  void tell(const Deed& deed, std::int64_t block_begin) {
    if (deed.is_exact) {
      const auto& bytes = deed.message.bytes;
      exact_.push_back({.midi = {{deed.sample - block_begin, 0}, {bytes[0], bytes[1], bytes[2]}}});
      return;
    }
    LiveMessage message = deed.message;
    message.time_ns = time_of(frame_ - block_begin + deed.sample - kMostBlock);
    live_->push(static_cast<int>(deed.sample % 7), message);
  }
  void block(std::span<float> left, std::span<float> right) {
    live_->process(time_of(frame_), exact_, left, right);
    frame_ += static_cast<std::int64_t>(left.size());
    if (++blocks_ % 16 == 0) look_after();
  }
  void look_after() {
    live_->collect();
    live_->status();
    live_->take_journal(journal_);
    journal_ = {};  // what a program does whose journal has reached its end
  }
  static std::unique_ptr<const BankProgram> bank_of_third(std::int64_t third) {
    return bank_from(third == 1 ? with(kHourglass, "gain_db = -6") : std::string(kHourglass));
  }
  static std::int64_t time_of(std::int64_t frame) { return 5'000'000'000 + frame * 62500 / 3; }

  const std::vector<Deed> deeds_ = score();
  const std::vector<std::size_t> sizes_ = blocks();
  std::unique_ptr<LiveEngine> live_;
  std::vector<engine::Event> exact_;
  Journal journal_;
  std::int64_t frame_ = 0, blocks_ = 0;
  std::vector<float> left_ = std::vector<float>(kRound), right_ = std::vector<float>(kRound);
};

std::string hash_of(const std::vector<float>& samples) {
  base::Sha256 hash;
  hash.update(std::span<const float>(samples));
  return hash.finish_hex();
}

void expect_equal(const std::vector<float>& heard, const std::vector<float>& first,
                  std::int64_t round) {
  if (std::memcmp(heard.data(), first.data(), first.size() * sizeof(float)) == 0) return;
  const auto differ = std::mismatch(heard.begin(), heard.end(), first.begin());
  const auto at = differ.first - heard.begin();
  FAIL() << "round " << round << " differs from the first at its sample " << at;
}

void expect_all_was_heard(Rounds& rounds) {
  const LiveStatus status = rounds.live().status();
  EXPECT_EQ(status.now, rounds.now());
  EXPECT_EQ(status.messages_dropped, 0);
  EXPECT_EQ(status.messages_late, 0);
  EXPECT_EQ(status.journal_dropped, 0);
  EXPECT_EQ(status.counters.voices_now, 0);
  EXPECT_EQ(status.counters.events_late, 0);
}

/// Rounds up to `end`; memory counts from the end of the second one.
void play_until(std::int64_t end) {
  Rounds rounds;
  rounds.play();
  const std::vector<float> first = rounds.left();
  EXPECT_TRUE(std::all_of(first.begin(), first.end(), [](float x) { return std::isfinite(x); }));
  EXPECT_GT(peak(first), 0.01);
  EXPECT_LT(peak(first), 1);
  rounds.play();
  const Memory before = memory_now();
  std::int64_t round = 2;
  for (; rounds.now() < end && !testing::Test::HasFatalFailure(); ++round) {
    rounds.play();
    expect_equal(rounds.left(), first, round);
    ASSERT_EQ(memory_now().objects, before.objects) << "after round " << round;
  }
  const Memory after = memory_now();
  const std::int64_t grown = after.resident_bytes - before.resident_bytes;
  EXPECT_LE(grown, 1 << 20);
  EXPECT_NEAR(double(after.heap_bytes), double(before.heap_bytes), double(kKeptByMalloc));
  expect_all_was_heard(rounds);
  EXPECT_EQ(hash_of(rounds.left()), hash_of(first));
  std::cout << round << " rounds of " << double(kRound) / kRateHz << " s, " << rounds.now()
            << " samples; all alike: sha256 " << hash_of(first) << "\n"
            << after.objects << " objects after each; heap " << before.heap_bytes << " and "
            << after.heap_bytes << " bytes, resident memory grew by " << grown << " bytes; "
            << double(std::clock()) / CLOCKS_PER_SEC << " s of processor time\n";
}

TEST(Day, RoundsOfAScoreAreAlikeAndLeaveNothingBehind) { play_until(4 * kRound); }

TEST(Day, ARoundAcrossSampleTwoToThe31SoundsAsAtTheBeginning) {
  Rounds rounds;
  rounds.play();
  const std::vector<float> first = rounds.left();
  rounds.rest(kTwoTo31 - 8 * 65536 - kRound);
  rounds.play();
  EXPECT_GT(rounds.now(), kTwoTo31);
  expect_equal(rounds.left(), first, 1);
  expect_all_was_heard(rounds);
}

TEST(DayStress, RoundsOfADayAndPastSampleTwoToThe32AreAlikeAndLeaveNothingBehind) {
  play_until(std::max(kDay, kTwoTo32) + 2 * kRound);
}

constexpr std::string_view kSine = R"(
format = 1
kind = "patch"
name = "Sine"
[curves.gate]
degree = 1
points = [0, 1, 1, 0]
knots = [0,0, 0.01, 0.02, 0.03,0.03]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.03
sustain_at = 0.01
release_at = 0.02
)";

/// A sine of 440 Hz that is held; its phase is measured against the exact one.
class HeldNote {
 public:
  HeldNote() : bank_(bank_from(kSine)), engine_(engine_for(*bank_, {.max_voices = 1})) {
    skip_to(4800, {on(0, 0, 69)});
  }

  std::int64_t now() const { return engine_->now(); }
  void skip_to(std::int64_t sample, const std::vector<Event>& events = {}) {
    std::span<const Event> heard(events);
    while (now() < sample) {
      const auto n = static_cast<std::size_t>(std::min<std::int64_t>(sample - now(), 4096));
      engine_->process(heard, std::span(left_).first(n), std::span(right_).first(n));
      heard = {};
    }
  }
  /// In cycles, -0.5..0.5, over the next second, which is 440 whole cycles.
  double phase_cycles() {
    std::complex<double> sum = 0;
    for (std::int64_t done = 0; done < 48000;) {
      const std::int64_t first = now();
      const auto n = static_cast<std::size_t>(std::min<std::int64_t>(48000 - done, 4096));
      engine_->process({}, std::span(left_).first(n), std::span(right_).first(n));
      for (std::size_t i = 0; i < n; ++i) {
        const auto exact = (first + static_cast<std::int64_t>(i)) * 440 % 48000;
        sum += static_cast<double>(left_[i]) *
               std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(exact) / 48000);
      }
      done += static_cast<std::int64_t>(n);
    }
    return std::arg(sum) / (2 * std::numbers::pi);
  }

 private:
  std::unique_ptr<const BankProgram> bank_;
  std::unique_ptr<Engine> engine_;
  std::array<float, 4096> left_{}, right_{};
};

/// Of a note `cycles` too long or short after `seconds`.
double cents(double cycles, double seconds) {
  return 1200 * std::log2(1 + cycles / (440 * seconds));
}

/// Cents off over the ten seconds from `sample` on.
double cents_at(HeldNote& note, std::int64_t sample) {
  note.skip_to(sample);
  const double begin = note.phase_cycles();
  note.skip_to(sample + 9 * 48000);
  return cents(note.phase_cycles() - begin, 9);
}

TEST(Day, AHeldNoteIsInTuneForTwoMinutes) {
  HeldNote note;
  EXPECT_LT(std::abs(cents_at(note, 48000)), 1e-3);
  EXPECT_LT(std::abs(cents_at(note, 120 * 48000)), 1e-3);
}

TEST(DayStress, ANoteHeldForADayAndPastSampleTwoToThe32IsInTune) {
  HeldNote note;
  note.skip_to(48000);
  const double first = note.phase_cycles();
  double most = 0;
  for (const std::int64_t at :
       {std::int64_t{96000}, kDay, kTwoTo32 - 5 * 48000, kTwoTo32 + 96000}) {
    const double off = cents_at(note, at);
    EXPECT_LT(std::abs(off), 1e-3) << "at sample " << at;
    most = std::max(most, std::abs(off));
  }
  const double drift = note.phase_cycles() - first;
  const double seconds = static_cast<double>(note.now() - 96000) / kRateHz;
  EXPECT_LT(std::abs(cents(drift, seconds)), 1e-9);
  std::cout << "most " << most << " cents off over ten seconds; after " << seconds << " s " << drift
            << " cycles off, " << cents(drift, seconds) << " cents; "
            << double(std::clock()) / CLOCKS_PER_SEC << " s of processor time\n";
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Random envelope patches under random MIDI, floods and stopped clocks among it: what the cables
// carry, what they end with, and that no split of time changes a bit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "knotwave/engine/envelope_generator.h"

#include "engine/envelope_rig.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using base::MidiEvent;

constexpr double kRate = 48000;
constexpr std::int64_t kStormEnd = 48000, kQuietEnd = 120000;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool one_in(int n) { return below(n) == 0; }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  template <std::size_t N>
  const char* of(const std::array<const char*, N>& words) {
    return words[static_cast<std::size_t>(below(static_cast<int>(N)))];
  }

 private:
  std::mt19937_64 random_;
};

struct RandomPatch {
  std::string text;
  bool comes_to_hold = true;  ///< without MIDI all its values stand still
};

std::string number(double value) { return std::to_string(value); }

void add_curves(Dice& dice, RandomPatch& patch) {
  for (int i = 0; i < 2; ++i) {
    const std::string name = "c" + std::to_string(i);
    patch.text +=
        "[curves." + name + "]\ndegree = " + std::to_string(1 + dice.below(3)) + "\npoints = [";
    const int points = 4 + dice.below(4);
    for (int k = 0; k < points; ++k) patch.text += (k > 0 ? ", " : "") + number(dice.unit());
    patch.text += "]\n[envelopes." + name + "]\ncurve = '" + name +
                  "'\nseconds = " + number(0.003 + 0.4 * dice.unit() * dice.unit()) + "\n";
    if (dice.one_in(3)) patch.text += "sustain_at = 0.5\n";
    if (dice.one_in(3)) patch.text += "velocity_time = 1\n";
    if (dice.one_in(3)) patch.text += "retrigger = 'restart'\n";
  }
  if (!dice.one_in(3)) return;
  patch.text += "[lfos.l]\ncurve = 'sine'\nrate_hz = " + number(0.5 + 20 * dice.unit()) + "\n";
  patch.text += "[[maps]]\nfrom = 'l'\nto = 'free.x'\n";
  patch.comes_to_hold = false;
}

void add_output(Dice& dice, RandomPatch& patch, int index, int kind, bool has_keys,
                bool follows_notes) {
  const bool has_lfo = !patch.comes_to_hold;
  patch.text += "[[outputs]]\nfrom = '" +
                std::string(has_lfo && dice.one_in(2) ? "free.x"
                            : dice.one_in(2)          ? "c0"
                                                      : "c1") +
                "'\n";
  int top = 127, bottom = 0;
  switch (kind) {
    case 0:
      patch.text += "to = 'bend'\n";
      bottom = -8192;
      top = 8191;
      break;
    case 1:
      patch.text += "to = 'pressure'\n";
      break;
    case 2:
      patch.text += has_keys ? "to = 'poly_pressure'\n" : "to = 'cc69'\n";
      break;
    case 3:
      patch.text += "to = 'nrpn" + std::to_string(dice.below(16384)) + "'\n";
      if (dice.one_in(2)) patch.text += "bits = 14\n", top = 16383;
      break;
    case 4:
      patch.text += "to = 'cc" + std::to_string(16 + dice.below(16)) + "'\nbits = 14\n";
      top = 16383;
      break;
    default:
      patch.text += "to = 'cc" + std::to_string(70 + dice.below(26)) + "'\n";
  }
  const auto step = [&] { return std::to_string(bottom + dice.below(top - bottom + 1)); };
  if (dice.one_in(3)) {
    const int low = bottom + dice.below((top - bottom) / 2), high = low + 1 + dice.below(top - low);
    patch.text += "range = [" + std::to_string(low) + ", " + std::to_string(high) + "]\n";
    patch.text += "rest = " + std::to_string(low + dice.below(high - low + 1)) + "\n";
  } else if (dice.one_in(2)) {
    patch.text += "rest = " + step() + "\n";
  }
  // Channels of its own, so that nobody else speaks there.
  patch.text +=
      follows_notes ? "channel = 'note'\n" : "channel = " + std::to_string(5 + index) + "\n";
}

RandomPatch random_patch(Dice& dice) {
  RandomPatch patch;
  const bool is_note = !dice.one_in(3);
  const bool is_poly = is_note && dice.one_in(2);
  const bool is_mpe = is_poly && dice.one_in(2);
  patch.text = std::string("mode = '") +
               (is_poly          ? "poly"
                : dice.one_in(2) ? "mono"
                                 : "legato") +
               "'\nseed = " + std::to_string(dice.below(1000)) + "\n";
  if (is_poly) patch.text += "polyphony = " + std::to_string(1 + dice.below(6)) + "\n";
  if (is_mpe) {
    patch.text += "notes = 'mpe'\n";
  } else if (dice.one_in(2)) {
    patch.text += "notes = 'thru'\n";
  }
  patch.text += "[trigger]\n";
  if (!is_note) {
    const std::string from = dice.of(std::array{"pedal", "cc1", "clock", "loop"});
    patch.text += "from = '" + from + "'\n";
    if (from == "clock") patch.text += "beats = 0.25\ngate = " + number(dice.unit()) + "\n";
  }
  if (dice.one_in(5)) patch.text += "program = 1\nchannel = 1\n";
  const std::string wire = dice.of(std::array{"din", "din", "usb", "none"});
  patch.text += "[ports.synth]\nwire = '" + wire + "'\n";
  if (wire == "din" && dice.one_in(2)) patch.text += "running_status = false\n";
  add_curves(dice, patch);
  const int outputs = 1 + dice.below(4);
  const bool follows = is_mpe || (is_poly && dice.one_in(2));
  const int first_kind = dice.below(6);  // no two outputs go to the same place
  for (int i = 0; i < outputs; ++i) {
    add_output(dice, patch, i, (first_kind + i) % 6, is_note, follows);
  }
  if (dice.one_in(3)) {
    patch.text += "[[events]]\nenvelope = 'c0'\nat = 'end'\nnote = 37\nchannel = 12\n";
  }
  return patch;
}

const std::array<std::uint8_t, 40> kSysex = {1, 2, 3};

MidiEvent event_at(std::int64_t sample, int status, int one, int two) {
  MidiEvent event;
  event.time = {sample, 0};
  event.bytes[0] = static_cast<std::uint8_t>(status);
  event.bytes[1] = static_cast<std::uint8_t>(one);
  event.bytes[2] = static_cast<std::uint8_t>(two);
  if (status == 0xF0) {
    event.sysex = kSysex.data();
    event.sysex_size = kSysex.size();
  }
  return event;
}

/// Keys, pedals, wheels, programs, clocks that stop, system exclusive and floods; in the end all is
/// let go and the clock stops.
std::vector<MidiEvent> random_storm(Dice& dice) {
  std::vector<MidiEvent> all;
  const auto add = [&all](std::int64_t t, int a, int b = 0, int c = 0) {
    all.push_back(event_at(t, a, b, c));
  };
  const int gap = 1 + dice.below(3000);
  for (std::int64_t t = 1; t < kStormEnd; t += dice.below(gap)) {
    const int channel = dice.below(3);
    switch (dice.below(12)) {
      case 0:
        add(t, 0xB0 | channel, dice.one_in(2) ? 64 : 1, dice.below(128));
        break;
      case 1:
        add(t, 0xE0 | channel, dice.below(128), dice.below(128));
        break;
      case 2:
        add(t, 0xC0 | channel, dice.below(2));
        break;
      case 3:
        add(t, 0xF0);
        break;
      case 4:
        add(t, dice.of(std::array{"\xFA", "\xFB", "\xFC"})[0] & 0xFF);
        break;
      case 5:
        for (int i = dice.below(30); i > 0; --i) add(t, 0xF8);
        break;
      case 6:
        if (dice.one_in(8)) add(t, 0xB0 | channel, 123);
        if (dice.one_in(20)) {
          for (int i = 0; i < 400; ++i) add(t, 0x90 | channel, i % 128, 1 + i % 127);
        }
        break;
      case 7:
      case 8:
        add(t, 0x80 | channel, 54 + dice.below(12), dice.below(128));
        break;
      default:
        add(t, 0x90 | channel, 54 + dice.below(12), dice.below(128));
    }
    if (all.size() > 6000) break;
  }
  add(kStormEnd, 0xFC);
  for (int channel = 0; channel < 16; ++channel) {
    add(kStormEnd, 0xB0 | channel, 64);
    add(kStormEnd, 0xB0 | channel, 1);
    add(kStormEnd, 0xB0 | channel, 123);
  }
  return all;
}

class Kept final : public GeneratorSink {
 public:
  /// What many voices send where nothing limits it; only what is used takes memory.
  Kept() { messages.reserve(1 << 23); }
  void midi(int, const MidiEvent& event) KNOTWAVE_RT override {
    is_full |= messages.size() == messages.capacity();
    if (!is_full) messages.push_back(event);
  }
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override {}
  std::vector<MidiEvent> messages;
  bool is_full = false;
};

double seconds_of(const MidiEvent& event) {
  return (static_cast<double>(event.time.sample) + event.time.fraction * 0x1p-32) / kRate;
}

/// Messages follow one another: no two on a DIN cable at a time, no 17 USB events in a millisecond.
void expect_budget(const std::vector<MidiEvent>& messages, const PortSpec& port) {
  constexpr double kRounding = 1e-9;
  if (port.wire == PortSpec::Wire::none) return;
  std::uint8_t running = 0;
  double free_s = -1;
  std::vector<double> usb;
  for (const MidiEvent& event : messages) {
    const std::uint8_t status = event.bytes[0];
    double bytes = (status & 0xE0) == 0xC0 ? 2 : 3;
    if (status >= 0xF0) bytes = status == 0xF0 ? event.sysex_size + 2.0 : 1;
    const double begin_s = seconds_of(event);
    if (port.wire == PortSpec::Wire::din) {
      if (status < 0xF0 && port.running_status && status == running) bytes -= 1;
      if (status < 0xF8) running = status < 0xF0 ? status : 0;
      ASSERT_GE(begin_s, free_s - kRounding);
      free_s = begin_s + bytes / kDinBytesPerSecond;
    } else {
      for (double rest = bytes; rest > 0; rest -= 3) usb.push_back(begin_s);
    }
  }
  for (std::size_t i = 16; i < usb.size(); ++i) {
    // A long message takes packets of its own, one after another.
    if (usb[i] == usb[i - 1]) continue;
    ASSERT_GE(usb[i] - usb[i - 16], kUsbFrameSeconds - kRounding);
  }
}

/// What a receiver holds.
class Receiver {
 public:
  Receiver() = default;
  explicit Receiver(const std::vector<MidiEvent>& messages) {
    for (const MidiEvent& event : messages) hear(event);
  }
  void hear(const MidiEvent& event) {
    const int channel = event.channel(), one = event.bytes[1], two = event.bytes[2];
    switch (event.bytes[0] & 0xF0) {
      case 0x90:
        notes_[{channel, one}] = two != 0;
        break;
      case 0x80:
        notes_[{channel, one}] = false;
        break;
      case 0xA0:
        held_[{channel, 2000 + one}] = two;
        break;
      case 0xB0:
        hear_control(channel, one, two);
        break;
      case 0xD0:
        held_[{channel, 1001}] = one;
        break;
      case 0xE0:
        held_[{channel, 1000}] = two << 7 | one;
        break;
      default:
        break;
    }
  }
  int notes_on() const {
    int count = 0;
    for (const auto& [key, is_on] : notes_) count += is_on ? 1 : 0;
    return count;
  }
  /// -1: never told.
  int step(const OutputSpec& spec, int channel, int key) const {
    switch (spec.kind) {
      case OutputKind::pitch_bend:
        return get(channel, 1000);
      case OutputKind::channel_pressure:
        return get(channel, 1001);
      case OutputKind::poly_pressure:
        return get(channel, 2000 + key);
      case OutputKind::nrpn:
        return value(channel, 10000 + spec.number, 40000 + spec.number, spec.bits);
      default:
        return value(channel, spec.number, spec.number + 32, spec.bits);
    }
  }

 private:
  int get(int channel, int what) const {
    const auto found = held_.find({channel, what});
    return found == held_.end() ? -1 : found->second;
  }
  int value(int channel, int high, int low, int bits) const {
    const int upper = get(channel, high);
    return bits == 7 || upper < 0 ? upper : upper << 7 | std::max(get(channel, low), 0);
  }
  // An upper half puts the lower one to 0 (MIDI 1.0).
  void hear_control(int channel, int number, int value) {
    held_[{channel, number}] = value;
    if (number < 32) held_[{channel, number + 32}] = 0;
    const bool is_entry = number == 6 || number == 38;
    const int parameter = std::max(get(channel, 99), 0) << 7 | std::max(get(channel, 98), 0);
    if (!is_entry || parameter == 16383) return;
    held_[{channel, (number == 6 ? 10000 : 40000) + parameter}] = value;
    if (number == 6) held_[{channel, 40000 + parameter}] = 0;
  }

  std::map<std::pair<int, int>, int> held_;
  std::map<std::pair<int, int>, bool> notes_;
};

double offset_of(const OutputSpec& spec) { return spec.kind == OutputKind::pitch_bend ? 8192 : 0; }

/// A generator of one patch and what it sent.
class Case {
 public:
  Case(const EnvelopePatchProgram& program, bool thru) {
    EnvelopeGeneratorConfig config;
    config.thru = thru;
    const EnvelopePatchProgram* const patches[] = {&program};
    auto made = EnvelopeGenerator::create(config, patches);
    EXPECT_TRUE(made) << made.error().to_string();
    generator_ = std::move(*made);
  }
  void play(const std::vector<MidiEvent>& storm, std::int64_t until, std::int64_t block) {
    while (generator_->now() < until) {
      const std::int64_t end = std::min(until, generator_->now() + block);
      for (; next_ < storm.size() && storm[next_].time.sample < end; ++next_) {
        generator_->handle(storm[next_]);
      }
      generator_->advance(end, kept_);
    }
  }
  bool rests(std::int64_t block) {
    generator_->go_to_rest();
    const std::int64_t most = generator_->now() + 960000;
    while (!generator_->is_at_rest() && generator_->now() < most) {
      generator_->advance(generator_->now() + block, kept_);
    }
    return generator_->is_at_rest();
  }
  const std::vector<MidiEvent>& sent() const {
    EXPECT_FALSE(kept_.is_full);
    return kept_.messages;
  }
  const PortSpec& port() const { return generator_->ports()[0]; }

 private:
  std::unique_ptr<EnvelopeGenerator> generator_;
  Kept kept_;
  std::size_t next_ = 0;
};

bool is_same(const MidiEvent& a, const MidiEvent& b) {
  return a.time == b.time && std::memcmp(a.bytes, b.bytes, 3) == 0 && a.sysex == b.sysex;
}

void expect_same(const std::vector<MidiEvent>& a, const std::vector<MidiEvent>& b) {
  const auto [left, right] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), is_same);
  EXPECT_TRUE(left == a.end() && right == b.end())
      << "message " << left - a.begin() << " of " << a.size() << " and " << b.size() << ", at "
      << (left == a.end() ? -1 : seconds_of(*left));
}

/// The lowest and the highest step that a value reached are heard, but for its rest where it left
/// that before a first message, of 12 bytes at most, came.
void expect_extremes(const OutputSpec& spec, const std::vector<double>& values,
                     const std::vector<MidiEvent>& sent) {
  Receiver receiver;
  int heard_low = 1 << 14, heard_high = -1;
  double told_s = 0;
  for (const MidiEvent& event : sent) {
    receiver.hear(event);
    const int step = receiver.step(spec, spec.channel - 1, 0);
    if (step < 0) continue;
    if (heard_high < 0) told_s = seconds_of(event) + 12 / kDinBytesPerSecond;
    heard_low = std::min(heard_low, step);
    heard_high = std::max(heard_high, step);
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto told = values.begin() +
                    std::min(std::ssize(values), static_cast<std::ptrdiff_t>(told_s * kRate) + 1);
  const auto is_rest = [&](auto extreme) {
    const bool comes_back = std::find(told, values.end(), *extreme) != values.end();
    return std::abs(*extreme - spec.rest) <= 0.5 && !comes_back;
  };
  if (!is_rest(high)) {
    EXPECT_GE(heard_high, std::ceil(*high + offset_of(spec) - 0.5 - 1e-6)) << "the highest step";
  }
  if (!is_rest(low)) {
    EXPECT_LE(heard_low, std::floor(*low + offset_of(spec) + 0.5 + 1e-6)) << "the lowest step";
  }
}

/// The values that a player alone has in the end, and where only one voice sounds those on the way.
void expect_values(const EnvelopePatchProgram& program, const std::string& text,
                   const std::vector<MidiEvent>& storm, const std::vector<MidiEvent>& sent) {
  EnvelopeRig rig(text);
  for (const MidiEvent& midi : storm) {
    Event event;
    event.midi = midi;
    rig.add(event);
  }
  rig.play(kQuietEnd);
  const Receiver receiver(sent);
  const int newest = rig.player().newest_voice();
  const auto outputs = program.outputs();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const OutputSpec& spec = outputs[i].spec;
    if (spec.channel == 0 || spec.kind == OutputKind::poly_pressure) continue;
    SCOPED_TRACE("output " + std::to_string(i + 1));
    const double value = newest < 0 ? spec.rest : rig.values(newest, static_cast<int>(i)).back();
    if (newest == 0 && rig.player().voices() == 1) {
      expect_extremes(spec, rig.values(0, static_cast<int>(i)), sent);
    }
    EXPECT_NEAR(receiver.step(spec, spec.channel - 1, 0), value + offset_of(spec), 0.5 + 1e-6);
  }
}

void expect_rest(const EnvelopePatchProgram& program, const Receiver& receiver, bool thru) {
  for (const EnvelopePatchProgram::Output& output : program.outputs()) {
    const OutputSpec& spec = output.spec;
    const int rest = static_cast<int>(std::floor(spec.rest + offset_of(spec) + 0.5));
    for (int channel = 0; channel < 16; ++channel) {
      if (spec.channel != 0 && spec.channel != channel + 1) continue;
      if (thru && channel < 3) continue;  // these have what was passed through
      for (int key = 0; key < (spec.kind == OutputKind::poly_pressure ? 128 : 1); ++key) {
        const int step = receiver.step(spec, channel, key);
        if (step >= 0) {
          EXPECT_EQ(step, rest) << "channel " << channel + 1 << " key " << key;
        }
      }
    }
  }
}

/// A clock has a tempo of its own in the generator, which a player alone does not hear.
bool has_clock(const EnvelopePatchProgram& program) {
  return program.spec().trigger.kind == TriggerSpec::Kind::clock;
}

void try_case(std::uint64_t seed) {
  Dice dice(seed);
  const RandomPatch patch = random_patch(dice);
  const bool thru = dice.one_in(3);
  const std::vector<MidiEvent> storm = random_storm(dice);
  SCOPED_TRACE("case " + std::to_string(seed) + (thru ? ", thru\n" : "\n") + patch.text);
  const auto program = envelope_program(patch.text);
  ASSERT_NE(program, nullptr);
  Case whole(*program, thru);
  const std::int64_t before = support::allocation_count();
  whole.play(storm, kQuietEnd, 480);
  EXPECT_EQ(support::allocation_count(), before);
  if (patch.comes_to_hold && !thru && !has_clock(*program)) {
    expect_values(*program, patch.text, storm, whole.sent());
  }
  ASSERT_TRUE(whole.rests(480));
  expect_budget(whole.sent(), whole.port());
  const Receiver receiver(whole.sent());
  EXPECT_EQ(receiver.notes_on(), 0);
  expect_rest(*program, receiver, thru);
  const std::int64_t block = std::array{1, 7, 64, 1 + dice.below(1000)}[seed % 4];
  Case split(*program, thru);
  split.play(storm, kQuietEnd, block);
  ASSERT_TRUE(split.rests(480));
  expect_same(whole.sent(), split.sent());
}

/// KNOTWAVE_CASE plays one of the cases that a failure names.
void try_cases(int count) {
  if (const char* const one = std::getenv("KNOTWAVE_CASE")) {
    return try_case(std::strtoull(one, nullptr, 10));
  }
  const std::uint64_t seed = support::test_seed();
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    try_case(seed * 1000003 + static_cast<std::uint64_t>(i));
  }
}

TEST(RandomGenerator, KeepsItsBudgetEndsItsNotesAndRestsInAnySplit) {
  try_cases(support::test_count(12));
}

TEST(RandomGenerator, PredictsTheFirstOpeningOfAClockDivisionInAnySplit) { try_case(1000041); }
TEST(RandomGenerator, LeavesTheSameOutOfAFullCableInAnySplit) { try_case(1002265); }
TEST(RandomGenerator, RestsWhereTwoVoicesSpokeToOneKeyAndOneLeft) { try_case(1008104); }

TEST(RandomGeneratorStress, KeepsItsBudgetEndsItsNotesAndRestsInAnySplit) {
  try_cases(support::test_count(300));
}

}  // namespace
}  // namespace knotwave::engine

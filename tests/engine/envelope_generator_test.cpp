// SPDX-License-Identifier: MIT
#include "knotwave/engine/envelope_generator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "engine/envelope_rig.h"
#include "support/allocation_count.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using base::MidiEvent;

constexpr double kRate = 48000;

struct Told {
  int port = 0;
  MidiEvent event;
  double seconds() const {
    return (static_cast<double>(event.time.sample) +
            static_cast<double>(event.time.fraction) * 0x1p-32) /
           kRate;
  }
  bool is(int status, int one, int two) const {
    return event.bytes[0] == status && event.bytes[1] == one && event.bytes[2] == two;
  }
  friend bool operator==(const Told& a, const Told& b) {
    return a.port == b.port && a.event.time == b.event.time &&
           std::memcmp(a.event.bytes, b.event.bytes, 3) == 0;
  }
  friend void PrintTo(const Told& told, std::ostream* out) {
    *out << told.seconds() << " s: " << std::hex << int(told.event.bytes[0]) << std::dec << " "
         << int(told.event.bytes[1]) << " " << int(told.event.bytes[2]);
  }
};

struct OscTold {
  int patch = 0, output = 0;
  std::int64_t sample = 0;
  double value = 0;
  friend bool operator==(const OscTold&, const OscTold&) = default;
};

/// Keeps what is sent; room is made beforehand so that nothing is allocated while it plays.
class Kept final : public GeneratorSink {
 public:
  Kept() {
    messages.reserve(100000);
    numbers.reserve(100000);
  }
  void midi(int port, const MidiEvent& event) KNOTWAVE_RT override {
    messages.push_back({port, event});
  }
  void osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT override {
    numbers.push_back({patch, output, time.sample, value});
  }
  std::vector<Told> messages;
  std::vector<OscTold> numbers;
};

struct Script {
  double sample = 0;
  int status = 0, one = 0, two = 0;
};

class Rig {
 public:
  explicit Rig(const std::vector<std::string>& texts, EnvelopeGeneratorConfig config = {}) {
    for (const std::string& text : texts) programs_.push_back(envelope_program(text));
    std::vector<const EnvelopePatchProgram*> all;
    for (const auto& program : programs_) all.push_back(program.get());
    auto made = EnvelopeGenerator::create(config, all);
    EXPECT_TRUE(made) << made.error().to_string();
    if (made) generator = std::move(*made);
  }
  void play(const std::vector<Script>& script, std::int64_t until, std::int64_t block = 64) {
    std::size_t next = 0;
    while (generator->now() < until) {
      const std::int64_t end = std::min(until, generator->now() + block);
      for (; next < script.size() && script[next].sample < static_cast<double>(end); ++next) {
        EXPECT_TRUE(generator->handle(event_of(script[next])));
      }
      generator->advance(end, kept);
    }
  }
  static MidiEvent event_of(const Script& s) {
    MidiEvent event;
    event.time.sample = static_cast<std::int64_t>(std::floor(s.sample));
    event.time.fraction = static_cast<std::uint32_t>((s.sample - std::floor(s.sample)) * 0x1p32);
    event.bytes[0] = static_cast<std::uint8_t>(s.status);
    event.bytes[1] = static_cast<std::uint8_t>(s.one);
    event.bytes[2] = static_cast<std::uint8_t>(s.two);
    return event;
  }
  /// False after ten seconds.
  bool rests() {
    generator->go_to_rest();
    const std::int64_t most = generator->now() + 480000;
    while (!generator->is_at_rest() && generator->now() < most) {
      generator->advance(generator->now() + 64, kept);
    }
    return generator->is_at_rest();
  }
  std::unique_ptr<EnvelopeGenerator> generator;
  Kept kept;

 private:
  std::vector<std::unique_ptr<const EnvelopePatchProgram>> programs_;
};

const std::string kDin = "[ports.synth]\ndevice = 'Minitaur'\nwire = 'din'\n";

std::string ramp_to(const std::string& output, double seconds, const std::string& trigger = "",
                    const std::string& ports = kDin) {
  return trigger + ports +
         "[curves.climb]\ndegree = 1\npoints = [0, 1]\n[envelopes.climb]\ncurve = 'climb'\nseconds "
         "= " +
         std::to_string(seconds) + "\n[[outputs]]\nfrom = 'climb'\n" + output;
}

TEST(EnvelopeGenerator, AKeysCurveComesOutStepByStepAtItsCrossings) {
  Rig rig({ramp_to("to = 'cc74'\n", 1.0)});
  rig.play({{4800, 0x90, 60, 100}}, 60000);
  ASSERT_EQ(rig.kept.messages.size(), 128u);
  EXPECT_TRUE(rig.kept.messages[0].is(0xB0, 74, 0)) << "at rest before the first key";
  EXPECT_EQ(rig.kept.messages[0].seconds(), 0);
  for (int step = 1; step <= 127; ++step) {
    const Told& told = rig.kept.messages[static_cast<std::size_t>(step)];
    EXPECT_TRUE(told.is(0xB0, 74, step));
    const double arrival = told.seconds() + 2 / kDinBytesPerSecond;
    EXPECT_NEAR(arrival, 0.1 + (step - 0.5) / 127, 1e-6) << step;
  }
}

/// Against the attack from the key on, in steps.
std::pair<double, double> worst_and_rms(const Rig& rig, double start_s, double length_s,
                                        int bytes) {
  const auto attack = [&](double t) {
    return t <= 0 ? 0 : 127 * (1 - std::exp(-4 * t / length_s)) / (1 - std::exp(-4.0));
  };
  double worst = 0, sum = 0;
  std::size_t next = 0;
  int held = 0;
  constexpr int kPoints = 100000;
  for (int i = 0; i < kPoints; ++i) {
    const double t = length_s * i / kPoints;
    const auto& all = rig.kept.messages;
    for (; next < all.size() && all[next].seconds() + bytes / kDinBytesPerSecond - start_s <= t;
         ++next) {
      held = all[next].event.bytes[2];
    }
    const double error = std::abs(held - attack(t));
    worst = std::max(worst, error);
    sum += error * error;
  }
  return {worst, std::sqrt(sum / kPoints)};
}

TEST(EnvelopeGenerator, AttacksOfKeysAreWithinTheCrossingsOfAPlainSender) {
  struct Row {
    double length_s, worst, rms, running_worst, running_rms;
  };
  for (const Row& row : {Row{0.010, 41, 11, 29, 7}, Row{0.030, 15, 3.4, 11, 2.3},
                         Row{0.100, 4.8, 1.0, 3.5, 0.7}, Row{0.300, 2.0, 0.4, 1.5, 0.3}}) {
    for (const bool running : {false, true}) {
      // The exponential as a fine polygon: its own error is below 0.01 steps.
      std::string points;
      for (int i = 0; i <= 400; ++i) {
        const double v = (1 - std::exp(-4.0 * i / 400)) / (1 - std::exp(-4.0));
        points += (i == 0 ? "" : ", ") + std::to_string(v);
      }
      const std::string ports = kDin + "running_status = " + (running ? "true\n" : "false\n");
      Rig rig({ports + "[curves.climb]\ndegree = 1\npoints = [" + points +
               "]\n[envelopes.climb]\ncurve = 'climb'\nseconds = " + std::to_string(row.length_s) +
               "\n[[outputs]]\nfrom = 'climb'\nto = 'cc74'\n"});
      rig.play({{4800, 0x90, 60, 100}}, 48000);
      const auto [worst, rms] = worst_and_rms(rig, 0.1, row.length_s, running ? 2 : 3);
      EXPECT_LE(worst, running ? row.running_worst : row.worst) << row.length_s;
      EXPECT_LE(rms, running ? row.running_rms : row.rms) << row.length_s;
      EXPECT_EQ(rig.kept.messages.back().event.bytes[2], 127);
    }
  }
}

/// Keys, pedals, wheels and clocks on all channels.
std::vector<Script> storm(std::uint64_t seed, double until) {
  std::mt19937_64 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<Script> all;
  for (double t = 100; t < until; t += below(2000) + below(16) / 16.0) {
    constexpr int kStatus[] = {0x90, 0x90, 0x80, 0xB0, 0xE0, 0xD0, 0xC0, 0xF8};
    Script s{t, kStatus[below(8)], below(12) + 54, below(128)};
    if (s.status < 0xF0) s.status |= below(3);
    if ((s.status & 0xF0) == 0xB0) s.one = below(2) == 0 ? 64 : 1;
    if ((s.status & 0xF0) == 0xC0) s.one = below(2);
    if ((s.status & 0xE0) == 0xC0) s.two = 0;
    if (s.status == 0xF8) s.one = s.two = 0;
    all.push_back(s);
  }
  return all;
}

const std::vector<std::string> kBusy = {
    "mode = 'poly'\npolyphony = 4\nnotes = 'mpe'\n" + kDin +
        "[curves.bump]\ndegree = 2\npoints = [0, 1.6, 0]\n"
        "[envelopes.bump]\ncurve = 'bump'\nseconds = 0.2\n"
        "[[outputs]]\nfrom = 'bump'\nto = 'pressure'\nchannel = 'note'\n"
        "[[outputs]]\nfrom = 'bump'\nto = 'cc11'\nbits = 14\nchannel = 'note'\n",
    "[trigger]\nfrom = 'clock'\nbeats = 0.25\n" + kDin +
        "[curves.drop]\ndegree = 1\npoints = [1, 0]\n"
        "[envelopes.drop]\ncurve = 'drop'\nseconds = 0.1\n"
        "[[outputs]]\nfrom = 'drop'\nto = 'bend'\nrange = [-8192, 8191]\nchannel = 16\n"
        "[[outputs]]\nfrom = 'drop'\nto = 'osc'\naddress = '/saw'\n"
        "[[events]]\nenvelope = 'drop'\nat = 'end'\nnote = 37\nchannel = 10\n"};

TEST(EnvelopeGenerator, AnySplitGivesTheSameMessages) {
  EnvelopeGeneratorConfig config;
  config.thru = true;
  const std::vector<Script> script = storm(support::test_seed(), 90000);
  Rig whole(kBusy, config);
  whole.play(script, 96000, 96000);
  EXPECT_GT(whole.kept.messages.size(), 500u);
  EXPECT_GT(whole.kept.numbers.size(), 50u);
  for (const std::int64_t block : {1, 7, 13, 31, 63, 64, 480}) {
    Rig split(kBusy, config);
    split.play(script, 96000, block);
    ASSERT_EQ(split.kept.messages.size(), whole.kept.messages.size()) << "blocks of " << block;
    for (std::size_t i = 0; i < whole.kept.messages.size(); ++i) {
      // Ports are asked one after another, so only the order within one is kept.
      ASSERT_EQ(split.kept.messages[i], whole.kept.messages[i])
          << "blocks of " << block << ", " << i;
    }
    EXPECT_EQ(split.kept.numbers, whole.kept.numbers);
  }
}

TEST(EnvelopeGenerator, NothingIsAllocatedWhileItPlays) {
  EnvelopeGeneratorConfig config;
  config.thru = true;
  Rig rig(kBusy, config);
  const std::vector<Script> script = storm(3, 40000);
  std::vector<MidiEvent> events;
  for (const Script& s : script) events.push_back(Rig::event_of(s));
  const std::int64_t before = support::allocation_count();
  std::size_t next = 0;
  for (std::int64_t end = 64; end < 48000; end += 64) {
    for (; next < events.size() && events[next].time.sample < end; ++next) {
      rig.generator->handle(events[next]);
    }
    rig.generator->advance(end, rig.kept);
  }
  rig.generator->go_to_rest();
  for (std::int64_t end = 48000; end < 96000; end += 64) rig.generator->advance(end, rig.kept);
  EXPECT_EQ(support::allocation_count(), before);
  EXPECT_TRUE(rig.generator->is_at_rest());
}

TEST(EnvelopeGenerator, EverythingComesToRestAndEveryNoteEnds) {
  EnvelopeGeneratorConfig config;
  config.thru = true;
  for (int seed = 1; seed <= support::test_count(20); ++seed) {
    Rig rig(kBusy, config);
    std::vector<Script> script = storm(static_cast<std::uint64_t>(seed), 30000);
    script.push_back({30000, 0x92, 70, 100});
    script.push_back({30001, 0xB2, 64, 127});
    rig.play(script, 30100);
    ASSERT_TRUE(rig.rests()) << seed;
    std::map<std::pair<int, int>, int> sounding, controls;
    std::map<int, int> pressures, bends;
    for (const Told& told : rig.kept.messages) {
      const int channel = told.event.channel(), one = told.event.bytes[1],
                two = told.event.bytes[2];
      switch (told.event.bytes[0] & 0xF0) {
        case 0x90:
          sounding[{channel, one}] += two == 0 ? -sounding[{channel, one}] : 1;
          break;
        case 0x80:
          sounding[{channel, one}] = 0;
          break;
        case 0xB0:
          controls[{channel, one}] = two;
          break;
        case 0xD0:
          pressures[channel] = one;
          break;
        case 0xE0:
          bends[channel] = two * 128 + one;
          break;
        default:
          break;
      }
    }
    for (const auto& [key, count] : sounding) {
      EXPECT_EQ(count, 0) << "seed " << seed << ": channel " << key.first << " key " << key.second;
    }
    // Channels 1 to 3 have what was passed through.
    for (const auto& [key, value] : controls) {
      if (key.first <= 2) continue;
      EXPECT_EQ(value, 0) << "channel " << key.first << " cc " << key.second;
    }
    EXPECT_EQ((controls[{2, 64}]), 0) << "the pedal that was passed through";
    for (const auto& [channel, value] : pressures) {
      if (channel <= 2) continue;
      EXPECT_EQ(value, 0) << "channel " << channel;
    }
    EXPECT_EQ(bends[15], 8192);
    EXPECT_EQ(rig.generator->port_counters(0).lost, 0);
  }
}

TEST(EnvelopeGenerator, EveryShippedPatchPlaysAndComesToRest) {
  const std::string folder = std::string(KNOTWAVE_SOURCE_DIR) + "/examples/envelopes";
  int patches = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(file.path().string());
    const auto spec = read_envelope_patch(file.path().string());
    ASSERT_TRUE(spec) << spec.error().to_string();
    const auto program = EnvelopePatchProgram::create(*spec);
    ASSERT_TRUE(program) << program.error().to_string();
    const EnvelopePatchProgram* all[] = {program->get()};
    auto generator = EnvelopeGenerator::create({}, all);
    ASSERT_TRUE(generator) << generator.error().to_string();
    Kept kept;
    for (int channel = 0; channel < 16; ++channel) {
      (*generator)->handle(Rig::event_of({100, 0x90 | channel, 40, 100}));
      (*generator)->handle(Rig::event_of({200, 0x90 | channel, 60, 100}));
    }
    (*generator)->advance(24000, kept);
    const bool has_voltages_only = std::ranges::all_of(
        spec->outputs, [](const OutputSpec& output) { return output.kind == OutputKind::voltage; });
    EXPECT_EQ(kept.messages.empty(), has_voltages_only);
    (*generator)->go_to_rest();
    for (int i = 0; i < 1000 && !(*generator)->is_at_rest(); ++i) {
      (*generator)->advance((*generator)->now() + 64, kept);
    }
    EXPECT_TRUE((*generator)->is_at_rest());
    ++patches;
  }
  EXPECT_GE(patches, 6);
}

TEST(EnvelopeGenerator, ThruIsMergedWithNothingChangedAndClocksFirst) {
  EnvelopeGeneratorConfig config;
  config.thru = true;
  Rig rig({ramp_to("to = 'bend'\nrange = [0, 8191]\nchannel = 5\n", 0.3)}, config);
  std::vector<Script> script;
  for (int i = 0; i < 200; ++i) {
    const double t = 1000.5 + i * 150;
    script.push_back({t, 0xF8, 0, 0});
    script.push_back({t, i % 2 == 0 ? 0x90 : 0x80, 60, 40 + i % 50});
  }
  rig.play(script, 60000);
  std::vector<MidiEvent> passed;
  for (const Told& told : rig.kept.messages) {
    if (told.event.bytes[0] != 0xE4) passed.push_back(told.event);
  }
  ASSERT_EQ(passed.size(), script.size());
  for (std::size_t i = 0; i < script.size(); ++i) {
    const MidiEvent in = Rig::event_of(script[i]);
    EXPECT_EQ(0, std::memcmp(in.bytes, passed[i].bytes, 3)) << i;
    EXPECT_GE(passed[i].time, in.time);
    EXPECT_LT(static_cast<double>(passed[i].time.sample - in.time.sample), 2 * 46.1)
        << "one message of the lane at most comes before it";
  }
  EXPECT_GT(rig.kept.messages.size(), passed.size() + 100);
}

TEST(EnvelopeGenerator, AMidiClockSetsTheTempoOfAClockDivision) {
  EnvelopeGeneratorConfig config;
  Rig rig({"[trigger]\nfrom = 'clock'\nbeats = 1\n" + kDin +
           "[curves.drop]\ndegree = 1\npoints = [1, 0]\n"
           "[envelopes.drop]\ncurve = 'drop'\nseconds = 0.05\n"
           "[[outputs]]\nfrom = 'drop'\nto = 'cc1'\n"
           "[[events]]\nenvelope = 'drop'\nat = 'end'\nnote = 37\nchannel = 10\n"},
          config);
  std::vector<Script> script = {{0, 0xFA, 0, 0}};
  const double clock = kRate * 60 / 90 / 24;  // 90 bpm
  for (int i = 0; i < 24 * 16; ++i) script.push_back({10 + i * clock, 0xF8, 0, 0});
  rig.play(script, static_cast<std::int64_t>(clock * 24 * 16));
  std::vector<double> ends;
  for (const Told& told : rig.kept.messages) {
    if (told.event.bytes[0] == 0x99 && told.event.bytes[2] > 0) ends.push_back(told.seconds());
  }
  ASSERT_GE(ends.size(), 14u);
  for (std::size_t i = ends.size() / 2; i < ends.size(); ++i) {
    EXPECT_NEAR(ends[i] - ends[i - 1], 60.0 / 90, 0.003);
    // The song began with the first clock, although the tempo was known half a quarter later.
    const double beat = std::round((ends[i] - 0.05) * 90 / 60);
    EXPECT_NEAR(ends[i], beat * 60 / 90 + 0.05, 0.004);
  }
  EXPECT_NEAR(rig.generator->clock_status().bpm, 90, 0.01);
}

TEST(EnvelopeGenerator, OnAChannelOfItsOwnTheFirstValueIsThereWithItsNote) {
  Rig rig({"mode = 'poly'\npolyphony = 3\nnotes = 'mpe'\n" +
           ramp_to("to = 'pressure'\nrange = [20, 120]\nchannel = 'note'\n", 0.5)});
  rig.play({{4800, 0x90, 60, 100}, {9600, 0x90, 64, 100}}, 14400);
  std::map<int, double> first_value_s, note_s;
  for (const Told& told : rig.kept.messages) {
    const int channel = told.event.channel();
    if (told.event.status() == base::MidiStatus::channel_pressure) {
      first_value_s.try_emplace(channel, told.seconds() + 2 / kDinBytesPerSecond);
      EXPECT_GE(told.event.bytes[1], 20);
    }
    if (told.event.status() == base::MidiStatus::note_on) note_s[channel] = told.seconds();
  }
  ASSERT_EQ(note_s.size(), 2u);
  ASSERT_EQ(first_value_s.size(), 2u) << "nothing is said to channels that have no note";
  for (const auto& [channel, time] : note_s) {
    EXPECT_NEAR(first_value_s[channel], time, 3.1 / kDinBytesPerSecond) << channel;
  }
  EXPECT_NEAR(first_value_s.begin()->second, 0.1, 1e-6);
}

/// Values of a controller in the order in which they went out, and where among them the note was.
struct AroundNote {
  std::vector<int> values;
  std::size_t values_before_note = 0;
};
AroundNote around_note(const std::vector<Told>& messages, int control) {
  AroundNote around;
  for (const Told& told : messages) {
    if (told.event.status() == base::MidiStatus::note_on) {
      around.values_before_note = around.values.size();
    }
    if (told.event.status() == base::MidiStatus::control_change && told.event.bytes[1] == control) {
      around.values.push_back(told.event.bytes[2]);
    }
  }
  return around;
}

TEST(EnvelopeGenerator, OnTheNotesOwnChannelNoRestValueComesBetweenTheNoteAndItsCurve) {
  for (const std::string wire : {"din", "usb", "none"}) {
    for (const std::string mode : {"mono", "poly"}) {
      SCOPED_TRACE(wire + " " + mode);
      Rig rig({"mode = '" + mode + "'\nnotes = 'thru'\n" +
               ramp_to("to = 'cc74'\nrange = [10, 50]\nrest = 64\nchannel = 'note'\n", 0.5, "",
                       "[ports.synth]\nwire = '" + wire + "'\n")});
      rig.play({{4800, 0x90, 60, 100}}, 48000);
      const AroundNote around = around_note(rig.kept.messages, 74);
      ASSERT_FALSE(around.values.empty());
      EXPECT_LE(around.values_before_note, 1u);
      EXPECT_EQ(around.values.front(), 10);
      EXPECT_TRUE(std::is_sorted(around.values.begin(), around.values.end()))
          << testing::PrintToString(around.values);
      EXPECT_EQ(around.values.back(), 50);
    }
  }
}

TEST(EnvelopeGenerator, ANoteDoesNotHearWhatItsVoiceDidOnAnotherChannel) {
  Rig rig({"mode = 'poly'\npolyphony = 1\nnotes = 'thru'\n" + kDin +
           "[curves.fall]\ndegree = 1\npoints = [1, 0.5]\n"
           "[envelopes.fall]\ncurve = 'fall'\nseconds = 0.5\nvelocity_time = 0\n"
           "[[maps]]\nfrom = ['fall', 'velocity']\nsurface = 'product'\nto = 'free.x'\n"
           "[surfaces.product]\ndegree_u = 1\ndegree_v = 1\npoints = [[0, 0], [0, 1]]\n"
           "[[outputs]]\nfrom = 'free.x'\nto = 'cc74'\nchannel = 'note'\n"});
  rig.play({{4800, 0x90, 60, 127}, {9600, 0x91, 62, 40}}, 48000);
  int most = 0;
  for (const Told& told : rig.kept.messages) {
    if (told.event.bytes[0] == 0xB1) most = std::max(most, int{told.event.bytes[2]});
  }
  EXPECT_EQ(most, 40) << "the first note's 127 belongs to channel 1";
}

TEST(EnvelopeGenerator, WhileItIsStillNothingIsSent) {
  const std::string nrpn = ramp_to(
      "to = 'nrpn5'\n[[outputs]]\nfrom = 'climb'\nto = 'osc'\n"
      "address = '/x'\nrate_hz = 10\n"
      "[[events]]\nenvelope = 'climb'\nnote = 40\nseconds = 0.9\n",
      0.1);
  Rig rig({nrpn});
  EXPECT_FALSE(rig.generator->is_still()) << "rest values have not been sent";
  rig.play({}, 96000);
  EXPECT_TRUE(rig.generator->is_still());
  rig.generator->handle(Rig::event_of({96000, 0x90, 60, 100}));
  EXPECT_FALSE(rig.generator->is_still());
  rig.play({{96480, 0x80, 60, 0}}, 97000);
  EXPECT_FALSE(rig.generator->is_still());
  int stills = 0;
  for (std::int64_t end = 97000; end < 240000; end += 64) {
    const bool is_still = rig.generator->is_still();
    const std::size_t sent = rig.kept.messages.size() + rig.kept.numbers.size();
    rig.play({}, end);
    if (!is_still) continue;
    ++stills;
    ASSERT_EQ(rig.kept.messages.size() + rig.kept.numbers.size(), sent) << end;
  }
  EXPECT_GT(stills, 1000);
  EXPECT_TRUE(rig.kept.messages.back().is(0x80, 40, 64)) << "0.9 s after the end of the envelope";
  Rig moving({"[lfos.l]\ncurve = 'sine'\n[[outputs]]\nfrom = 'l'\nof = [-1, 1]\nto = 'cc1'\n"});
  moving.play({{480, 0x90, 60, 100}, {960, 0x80, 60, 0}}, 96000);
  EXPECT_FALSE(moving.generator->is_still());
}

TEST(EnvelopeGenerator, OscHasItsRateAtMostAndTheLastValueAlways) {
  Rig rig({ramp_to("to = 'osc'\naddress = '/filter/cutoff'\nrange = [20, 2000]\nrate_hz = 100\n",
                   0.5, "", "")});
  rig.play({{4800, 0x90, 60, 100}}, 60000);
  const auto& sent = rig.kept.numbers;
  ASSERT_GT(sent.size(), 45u);
  EXPECT_EQ(sent.front().sample, 0);
  EXPECT_EQ(sent.back().value, 2000);
  for (std::size_t i = 1; i < sent.size(); ++i) {
    EXPECT_GE(sent[i].sample - sent[i - 1].sample, 480);
  }
  EXPECT_LE(sent.size(), 53u);
}

TEST(EnvelopeGenerator, PatchesShareAPortByItsName) {
  Rig rig({ramp_to("to = 'cc74'\n", 0.1), ramp_to("to = 'cc75'\n", 0.1),
           ramp_to("to = 'cc1'\n", 0.1, "", "[ports.other]\nwire = 'usb'\n"),
           ramp_to("to = 'cc2'\n", 0.1, "", "")});
  ASSERT_EQ(rig.generator->ports().size(), 3u);
  EXPECT_EQ(rig.generator->ports()[0].name, "synth");
  EXPECT_EQ(rig.generator->ports()[1].name, "other");
  EXPECT_EQ(rig.generator->ports()[2].name, "");
  rig.play({{480, 0x90, 60, 100}}, 9600);
  for (const auto& [number, port] : {std::pair{74, 0}, {75, 0}, {1, 1}, {2, 2}}) {
    const bool is_there =
        std::ranges::any_of(rig.kept.messages, [number = number, port = port](const Told& told) {
          return told.port == port && told.is(0xB0, number, 127);
        });
    EXPECT_TRUE(is_there) << "cc " << number;
  }
}

TEST(EnvelopeGenerator, WhatCannotGoTogetherIsRefused) {
  const auto error = [](const std::string& a, const std::string& b,
                        EnvelopeGeneratorConfig config = {}) {
    const auto one = envelope_program("name = 'One'\n" + a),
               two = envelope_program("name = 'Two'\n" + b);
    const EnvelopePatchProgram* all[] = {one.get(), two.get()};
    const auto made = EnvelopeGenerator::create(config, all);
    return made ? std::string("none") : made.error().to_string();
  };
  const std::string cc74 = ramp_to("to = 'cc74'\n", 0.1);
  EXPECT_NE(error(cc74, cc74).find("output 1 of 'Two' and output 1 of 'One' go to the same"),
            std::string::npos)
      << error(cc74, cc74);
  EXPECT_NE(error(ramp_to("to = 'cc1'\nbits = 14\n", 0.1), ramp_to("to = 'cc33'\n", 0.1)), "none");
  EXPECT_NE(error(cc74, ramp_to("to = 'cc75'\n", 0.1, "", "[ports.synth]\nwire = 'usb'\n"))
                .find("port 'synth'"),
            std::string::npos);
  EXPECT_EQ(error(cc74, ramp_to("to = 'cc74'\nchannel = 2\n", 0.1)), "none");
  for (const auto& wrong : {EnvelopeGeneratorConfig{.rate_hz = 1}, {.bpm = 0}, {.lead_s = 1}}) {
    EXPECT_NE(error(cc74, ramp_to("to = 'cc75'\n", 0.1), wrong), "none");
  }
}

/// What is said of two patches together: "none" where they go together.
std::string fault_of(const std::string& a, const std::string& b) {
  const auto one = envelope_program("name = 'One'\n" + a),
             two = envelope_program("name = 'Two'\n" + b);
  const EnvelopePatchProgram* all[] = {one.get(), two.get()};
  const auto made = EnvelopeGenerator::create({}, all);
  return made ? std::string("none") : made.error().to_string();
}

TEST(EnvelopeGenerator, ControllersThatSetParametersAreRefusedBesideAnNrpnOfTheirChannel) {
  const std::string nrpn = ramp_to("to = 'nrpn300'\nchannel = 2\n", 0.1);
  for (const int number : {6, 38, 96, 97, 98, 99, 100, 101}) {
    const std::string control = ramp_to("to = 'cc" + std::to_string(number) + "'\nchannel = ", 0.1);
    const std::string fault = fault_of(nrpn, control + "2\n");
    EXPECT_NE(fault.find("output 1 of 'One' is an NRPN"), std::string::npos) << fault;
    EXPECT_NE(fault.find("output 1 of 'Two' is controller " + std::to_string(number) + " there"),
              std::string::npos)
        << fault;
    EXPECT_NE(fault_of(control + "2\n", nrpn), "none");
    EXPECT_NE(fault_of(control + "'note'\n", nrpn), "none");
    EXPECT_EQ(fault_of(nrpn, control + "3\n"), "none");
  }
  EXPECT_EQ(fault_of(nrpn, ramp_to("to = 'cc7'\nchannel = 2\n", 0.1)), "none");
  EXPECT_EQ(fault_of(nrpn, ramp_to("to = 'nrpn301'\nchannel = 2\n", 0.1)), "none");
  EXPECT_NE(fault_of(nrpn, ramp_to("to = 'nrpn300'\nbits = 14\nchannel = 2\n", 0.1)), "none");
  EXPECT_NE(fault_of("[trigger]\nprogram = 1\n" + nrpn,
                     "[trigger]\nprogram = 2\n" + ramp_to("to = 'cc6'\nchannel = 2\n", 0.1)),
            "none")
      << "a parameter stays chosen for a while when the program changes";
}

TEST(EnvelopeGenerator, AnOutputOnTheNotesChannelMeetsWhatIsFixedWhereTheNoteMayBe) {
  const auto patch = [](const std::string& to, const std::string& channel,
                        const std::string& trigger = "", const std::string& top = "") {
    return top + ramp_to("to = '" + to + "'\nchannel = " + channel + "\n", 0.1, trigger);
  };
  const std::string fifth = "[trigger]\nchannel = 5\n", sixth = "[trigger]\nchannel = 6\n";
  for (const std::string to : {"cc74", "pressure", "bend", "nrpn5"}) {
    SCOPED_TRACE(to);
    EXPECT_NE(
        fault_of(patch(to, "'note'"), patch(to, "5")).find("the note's channel may be the other's"),
        std::string::npos);
    EXPECT_NE(fault_of(patch(to, "5"), patch(to, "'note'")), "none");
    EXPECT_NE(fault_of(patch(to, "5"), patch(to, "'note'", fifth)), "none");
    EXPECT_EQ(fault_of(patch(to, "5"), patch(to, "'note'", sixth)), "none");
    EXPECT_EQ(fault_of(patch(to, "'note'", fifth), patch(to, "'note'", sixth)), "none");
    EXPECT_NE(fault_of(patch(to, "'note'", fifth), patch(to, "'note'")), "none");
    const std::string mpe = "mode = 'poly'\nnotes = 'mpe'\n";
    EXPECT_EQ(fault_of(patch(to, "1"), patch(to, "'note'", "", mpe)), "none");
    EXPECT_NE(fault_of(patch(to, "2"), patch(to, "'note'", "", mpe)), "none");
  }
  const std::string low = "[trigger]\nkeys = [0, 59]\n", high = "[trigger]\nkeys = [60, 127]\n";
  EXPECT_EQ(fault_of(patch("poly_pressure", "3", low), patch("poly_pressure", "3", high)), "none");
  EXPECT_NE(fault_of(patch("poly_pressure", "3", low), patch("poly_pressure", "3")), "none");
  EXPECT_NE(fault_of(patch("cc74", "3", low), patch("cc74", "3", high)), "none");
}

TEST(EnvelopeGenerator, ProgramsChooseWhichPatchHasADestination) {
  const auto patch = [](int program, const std::string& points) {
    return "[trigger]\nfrom = 'note'\nprogram = " + std::to_string(program) + "\n" + kDin +
           "[curves.c]\ndegree = 1\npoints = " + points +
           "\n[envelopes.c]\ncurve = 'c'\nseconds = 0.1\n[[outputs]]\nfrom = 'c'\nto = 'cc74'\n";
  };
  Rig rig({patch(1, "[0, 0.5]"), patch(2, "[0, 1]")});
  rig.play({{100, 0xC0, 1, 0}, {200, 0x90, 60, 9}, {9000, 0x80, 60, 0}}, 9600);
  EXPECT_TRUE(rig.kept.messages.back().is(0xB0, 74, 63))
      << testing::PrintToString(rig.kept.messages.back());
  rig.play({{9700, 0xC0, 2, 0}, {9800, 0x90, 60, 9}}, 24000);
  EXPECT_TRUE(rig.kept.messages.back().is(0xB0, 74, 127));
}

TEST(EnvelopeGenerator, WhoComesBackIsToldEveryValueOnceMore) {
  Rig rig(
      {ramp_to("to = 'cc74'\n[[outputs]]\nfrom = 'climb'\nto = 'bend'\nrange = [0, 8191]\n"
               "[[outputs]]\nfrom = 'climb'\nto = 'nrpn300'\nchannel = 2\n",
               0.2)});
  rig.play({{480, 0x90, 60, 100}}, 96000);
  const std::size_t told = rig.kept.messages.size();
  rig.play({}, 144000);
  ASSERT_EQ(rig.kept.messages.size(), told) << "nothing moves";
  rig.generator->say_again(0);
  rig.play({}, 240000);
  std::vector<std::string> again;
  for (std::size_t i = told; i < rig.kept.messages.size(); ++i) {
    const auto& bytes = rig.kept.messages[i].event.bytes;
    again.push_back(std::to_string(bytes[0]) + " " + std::to_string(bytes[1]) + " " +
                    std::to_string(bytes[2]));
  }
  std::sort(again.begin(), again.end());
  EXPECT_EQ(again, (std::vector<std::string>{"176 74 127", "177 100 127", "177 101 127",
                                             "177 6 127", "177 98 44", "177 99 2", "224 127 127"}));
}

TEST(EnvelopeGenerator, AtRestNoParameterIsSelected) {
  Rig rig({ramp_to("to = 'nrpn300'\nbits = 14\nchannel = 2\n", 2)});
  rig.play({{480, 0x90, 60, 100}}, 48000);
  ASSERT_TRUE(rig.rests());
  ASSERT_GT(rig.kept.messages.size(), 2u);
  EXPECT_TRUE(rig.kept.messages[rig.kept.messages.size() - 2].is(0xB1, 101, 127));
  EXPECT_TRUE(rig.kept.messages.back().is(0xB1, 100, 127));
}

TEST(EnvelopeGenerator, RoutesTellWhatTheySendAndWhatItCosts) {
  Rig rig({ramp_to("to = 'bend'\nrange = [-8192, 8191]\n", 4.0) +
           "[[outputs]]\nfrom = 'climb'\nto = 'osc'\naddress = '/x'\nrange = [0, 10]\n"
           "[[outputs]]\nfrom = 'climb'\nto = 'cv'\nrange = [0, 5]\n"});
  rig.play({{0, 0x90, 60, 100}}, 144000);
  const auto routes = rig.generator->routes();
  ASSERT_EQ(routes.size(), 3u);
  EXPECT_EQ(routes[0].port, 0);
  EXPECT_NEAR(routes[0].value, -8192 + 16383 * 0.75, 40);
  EXPECT_NEAR(routes[0].bytes_per_second, 3125, 200);
  EXPECT_NEAR(routes[0].share, 1, 0.07);
  EXPECT_EQ(routes[1].port, -1);
  EXPECT_NEAR(routes[1].value, 7.5, 0.1);
  EXPECT_NEAR(routes[2].value, 3.75, 0.1);
  EXPECT_GT(rig.generator->port_counters(0).use, 0.9);
}

TEST(EnvelopeGenerator, AFloodFillsTheQueueAndLosesNoEndOfANote) {
  Rig rig({ramp_to("to = 'cc74'\n", 0.1)});
  std::size_t taken = 0;
  for (int i = 0; i < 1000000; ++i) {
    taken += rig.generator->handle(Rig::event_of({0, 0x90, i % 128, 100}));
  }
  EXPECT_EQ(taken, EnvelopeGenerator::kMostEvents);
  for (int key = 0; key < 128; ++key) {
    EXPECT_TRUE(rig.generator->handle(Rig::event_of({1, 0x80, key, 0})));
  }
  EXPECT_EQ(rig.generator->lost(), 1000000 - static_cast<std::int64_t>(taken));
  rig.play({}, 4800);
  EXPECT_TRUE(rig.rests());
}

}  // namespace
}  // namespace knotwave::engine

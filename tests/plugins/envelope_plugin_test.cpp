// SPDX-License-Identifier: MIT
// Knotwave Envelope: the same bits as knotwave-env --dry-run, and what a host may do to it.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/envelope_player.h"
#include "knotwave/io/midi_file.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

#include "cv_player.h"
#include "dry_run.h"
#include "effect_host.h"
#include "support/seed.h"

namespace knotwave::plugins {
namespace {

using engine::Event;
using support::place_of;

constexpr std::size_t kVoltages = 8;

/// A message as it was sent, on the clock of the piece.
struct Sent {
  base::SampleTime time;
  std::array<std::uint8_t, 3> bytes{};
  friend bool operator==(const Sent&, const Sent&) = default;
  friend void PrintTo(const Sent& sent, std::ostream* out) {
    *out << sent.time.sample << "+" << sent.time.fraction << std::hex;
    for (const int byte : sent.bytes) *out << " " << byte;
    *out << std::dec;
  }
};

/// A host of MIDI and voltages.
class Host {
 public:
  explicit Host(double rate_hz = 48000) : plugin_(envelope_info().create()) {
    const auto active = plugin_->activate(rate_hz);
    EXPECT_TRUE(active) << (active ? "" : active.error().to_string());
  }
  Plugin& plugin() { return *plugin_; }
  void load(const std::string& text) {
    const auto loaded = plugin_->load_state(text);
    ASSERT_TRUE(loaded) << loaded.error().to_string();
    ASSERT_TRUE(plugin_->activate(rate_hz_));
  }
  void activate(double rate_hz) {
    rate_hz_ = rate_hz;
    ASSERT_TRUE(plugin_->activate(rate_hz));
  }
  void set(const std::string& word, double value) {
    plugin_->set_parameter(place_of(envelope_info(), word), value);
  }

  /// In order of time; fractions stay.
  void at(base::SampleTime time, Event event) {
    events_.push_back({time.sample, [event, time](Plugin& plugin, std::int64_t offset) {
                         Event told = event;
                         told.midi.time = {offset, time.fraction};
                         plugin.add(told);
                       }});
  }
  void midi(std::int64_t sample, int status, int one, int two) {
    Event event;
    event.midi.bytes[0] = static_cast<std::uint8_t>(status);
    event.midi.bytes[1] = static_cast<std::uint8_t>(one);
    event.midi.bytes[2] = static_cast<std::uint8_t>(two);
    at({sample, 0}, event);
  }
  void act(support::HostAction action) { events_.push_back(std::move(action)); }

  /// Blocks of `block` samples up to sample `until`.
  void play(std::int64_t until, std::int64_t block) {
    while (now_ < until) {
      const std::int64_t frames = std::min(block, until - now_);
      const auto n = static_cast<std::size_t>(frames);
      std::array<std::vector<float>, 2 + kVoltages> out;
      std::array<float*, 2 + kVoltages> to{};
      for (std::size_t c = 0; c < out.size(); ++c) {
        out[c].assign(n, 99);
        to[c] = out[c].data();
      }
      audio_.resize(std::max(audio_.size(), static_cast<std::size_t>(now_ + frames)));
      const std::array<const float*, 2> from{audio_.data() + now_, audio_.data() + now_};
      plugin_->begin({from, to, n});
      for (; next_ < events_.size() && events_[next_].sample < now_ + frames; ++next_) {
        events_[next_].act(*plugin_, events_[next_].sample - now_);
      }
      plugin_->render();
      base::SampleTime before;
      for (const base::MidiEvent& event : plugin_->midi_out()) {
        EXPECT_GE(event.time, before) << "out of order";
        EXPECT_LT(event.time.sample, frames);
        before = event.time;
        sent.push_back({{event.time.sample + now_, event.time.fraction},
                        {event.bytes[0], event.bytes[1], event.bytes[2]}});
      }
      for (std::size_t c = 0; c < kVoltages; ++c) {
        volts[c].insert(volts[c].end(), out[2 + c].begin(), out[2 + c].end());
      }
      through.insert(through.end(), out[1].begin(), out[1].end());
      now_ += frames;
    }
  }
  void hear(std::vector<float> audio) { audio_ = std::move(audio); }
  std::int64_t now() const { return now_; }

  std::vector<Sent> sent;
  std::array<std::vector<float>, kVoltages> volts;
  std::vector<float> through;

 private:
  std::unique_ptr<Plugin> plugin_;
  double rate_hz_ = 48000;
  std::vector<support::HostAction> events_;
  std::size_t next_ = 0;
  std::int64_t now_ = 0;
  std::vector<float> audio_;
};

std::string patch_text(const std::string& preset) {
  return std::string(factory_text("envelopes/" + preset + ".toml"));
}

void add_song(Host& host, const io::Song& song, double rate_hz) {
  const auto scaled = [rate_hz](base::SampleTime time) {
    if (rate_hz == 48000) return time;
    const double samples =
        (static_cast<double>(time.sample) + static_cast<double>(time.fraction) * 0x1p-32) *
        rate_hz / 48000;
    const double whole = std::floor(samples);
    return base::SampleTime{static_cast<std::int64_t>(whole),
                            static_cast<std::uint32_t>((samples - whole) * 0x1p32)};
  };
  env::play_song(
      song,
      [&](base::SampleTime time, std::uint32_t tempo) {
        Event event;
        event.kind = Event::Kind::tempo;
        event.microseconds_per_quarter = tempo;
        host.at(scaled(time), event);
      },
      [&](const base::MidiEvent& midi) {
        Event event;
        event.midi = midi;
        host.at(scaled(midi.time), event);
      });
}

struct Piece {
  const char* preset;
  const char* score;
};
constexpr Piece kPieces[] = {
    {"filter-swell", "petzold_minuet"},  {"drum-duck", "groove"},
    {"tempo-tremolo", "groove"},         {"mpe-pressure", "bwv846_prelude"},
    {"four-voltages", "bwv846_prelude"}, {"pitch-adsr", "petzold_minuet"}};

/// Its first samples at 48 kHz.
io::Song song_of(const char* score, std::int64_t samples) {
  auto song =
      io::read_midi_file(std::string(KNOTWAVE_SOURCE_DIR "/examples/scores/") + score + ".mid");
  EXPECT_TRUE(song);
  io::TickClock clock(*song, 48000);
  std::erase_if(song->events,
                [&](const io::SongEvent& event) { return clock.at(event.tick).sample >= samples; });
  song->length_ticks = song->events.back().tick + 1;
  return *std::move(song);
}

/// What knotwave-env --dry-run --latency 0 sends before sample `until`.
std::vector<Sent> dry(const Piece& piece, const io::Song& song, std::int64_t until,
                      std::vector<std::vector<float>>* volts) {
  env::EnvOptions options;
  options.patches = {std::string(KNOTWAVE_SOURCE_DIR "/examples/envelopes/") + piece.preset +
                     ".toml"};
  options.latency_ms = 0;
  const auto input = env::read_input(options);
  EXPECT_TRUE(input) << (input ? "" : input.error().to_string());
  const auto run = env::dry_run(options, *input, song);
  EXPECT_TRUE(run);
  std::vector<Sent> sent;
  for (const env::SentMessage& message : run->sent.messages()) {
    if (message.time.sample >= until) break;
    sent.push_back({message.time, {message.bytes[0], message.bytes[1], message.bytes[2]}});
  }
  if (input->voltage_patches().empty()) return sent;
  engine::VoltageConfig voltage;
  voltage.direct_current = true;
  voltage.ramp_s = 0.001;
  auto player = env::CvPlayer::create(voltage, options.seed, input->voltage_patches());
  EXPECT_TRUE(player);
  volts->resize(player->channels());
  const auto play_until = [&](std::int64_t end) {
    while (player->now() < std::min(end, until)) {
      const auto n = static_cast<std::size_t>(std::min<std::int64_t>(
          std::min(end, until) - player->now(), env::CvPlayer::kMostSamples));
      std::vector<float*> to;
      for (auto& channel : *volts) {
        channel.resize(channel.size() + n);
        to.push_back(channel.data() + channel.size() - n);
      }
      player->render(n, to);
    }
  };
  Event event;
  env::play_song(
      song,
      [&](base::SampleTime time, std::uint32_t tempo) {
        play_until(base::first_sample(time));
        event.kind = Event::Kind::tempo;
        event.midi = {};
        event.midi.time = time;
        event.microseconds_per_quarter = tempo;
        player->handle(event);
      },
      [&](const base::MidiEvent& midi) {
        play_until(base::first_sample(midi.time));
        event.kind = Event::Kind::midi;
        event.midi = midi;
        player->handle(event);
      });
  play_until(until);
  return sent;
}

TEST(EnvelopePlugin, SendsTheBitsOfTheDryRunInBlocksOfAnySize) {
  constexpr std::int64_t kLong = 4 * 48000, kShort = 6000;
  for (const Piece& piece : kPieces) {
    const io::Song song = song_of(piece.score, kLong);
    std::vector<std::vector<float>> volts;
    const std::vector<Sent> wanted = dry(piece, song, kLong, &volts);
    EXPECT_FALSE(wanted.empty() && volts.empty()) << piece.preset;
    for (const std::int64_t block : {1, 7, 64, 1023, 8192}) {
      const std::int64_t until = block < 64 ? kShort : kLong;
      Host host;
      host.load(patch_text(piece.preset));
      add_song(host, song, 48000);
      host.play(until, block);
      std::vector<Sent> part = wanted;
      std::erase_if(part, [until](const Sent& sent) { return sent.time.sample >= until; });
      for (std::size_t i = 0; i < std::min(part.size(), host.sent.size()); ++i) {
        ASSERT_EQ(host.sent[i], part[i]) << piece.preset << " " << i << " in blocks of " << block;
      }
      ASSERT_EQ(host.sent.size(), part.size()) << piece.preset << " in blocks of " << block;
      constexpr std::size_t kRamp = 48;  // of the dry run's file
      for (std::size_t c = 0; c < volts.size(); ++c) {
        for (std::size_t i = kRamp; i < static_cast<std::size_t>(until); ++i) {
          ASSERT_EQ(std::bit_cast<std::uint32_t>(host.volts[c][i]),
                    std::bit_cast<std::uint32_t>(volts[c][i]))
              << piece.preset << " channel " << c << " sample " << i << " block " << block;
        }
      }
      for (std::size_t c = volts.size(); c < kVoltages; ++c) {
        EXPECT_EQ(std::count(host.volts[c].begin(), host.volts[c].end(), 0.0F), until);
      }
    }
  }
}

class Kept final : public engine::GeneratorSink {
 public:
  void midi(int, const base::MidiEvent& event) KNOTWAVE_RT override {
    sent.push_back({event.time, {event.bytes[0], event.bytes[1], event.bytes[2]}});
  }
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override {}
  std::vector<Sent> sent;
};

TEST(EnvelopePlugin, SendsTheBitsOfTheGeneratorAtOtherRates) {
  for (const double rate_hz : {8000.0, 44100.0, 192000.0}) {
    const auto until = static_cast<std::int64_t>(rate_hz);
    Host host;
    host.load(patch_text("filter-swell"));
    host.activate(rate_hz);
    const auto spec = engine::parse_envelope_patch(patch_text("filter-swell"), "p.toml");
    const auto program = engine::EnvelopePatchProgram::create(*spec);
    const engine::EnvelopePatchProgram* patches[] = {program->get()};
    engine::EnvelopeGeneratorConfig config;
    config.rate_hz = rate_hz;
    config.lead_s = 0;
    auto generator = engine::EnvelopeGenerator::create(config, patches);
    ASSERT_TRUE(generator);
    Kept kept;
    const base::RandomStream random{support::test_seed(), 0, 31};
    for (std::uint64_t i = 0; i < 12; ++i) {
      base::MidiEvent note;
      note.time.sample = static_cast<std::int64_t>(static_cast<double>(i) * rate_hz / 13);
      note.bytes[0] = i % 3 == 2 ? 0x80 : 0x90;
      note.bytes[1] = static_cast<std::uint8_t>(60 + i % 2);
      note.bytes[2] = static_cast<std::uint8_t>(1 + random.bits(i) % 127);
      (*generator)->handle(note);
      host.midi(note.time.sample, note.bytes[0], note.bytes[1], note.bytes[2]);
    }
    (*generator)->advance(until, kept);
    host.play(until, 333);
    EXPECT_GT(kept.sent.size(), 100u);
    EXPECT_EQ(host.sent, kept.sent) << rate_hz;
  }
}

// Gates.

const std::string kStep =
    "format = 1\nkind = 'envelope'\nmode = 'mono'\n[curves.step]\ndegree = 1\n"
    "points = [1, 1, 0]\n[envelopes.step]\ncurve = 'step'\nseconds = 0.01\nsustain_at = 0.4\n"
    "[[outputs]]\nfrom = 'step'\nto = 'cv'\nrange = [0, 10]\n";

TEST(EnvelopePlugin, ASideChainHasItsThresholdBeforeAnybodyMovesIt) {
  Host host;
  host.load(kStep);
  host.set("gate_source", 1);
  std::vector<float> audio(2000);
  audio[100] = 0.0625F;   // below -24 dB
  audio[1000] = 0.0640F;  // above
  host.hear(audio);
  host.play(2000, 64);
  EXPECT_EQ(host.volts[0][999], 0);
  EXPECT_NEAR(host.volts[0][1000], 1, 1e-6);
}

TEST(EnvelopePlugin, ASideChainOpensTheGateAtItsSampleAndHoldsIt) {
  for (const std::int64_t block : {1, 64, 1000}) {
    Host host;
    host.load(kStep);
    host.set("gate_source", 1);
    host.set("threshold", -20);
    host.set("hysteresis", 6);
    host.set("hold", 10);  // 480 samples
    std::vector<float> audio(6000);
    audio[100] = 0.099F;  // below -20 dB
    audio[1000] = -0.101F;
    audio[1200] = 0.0511F;  // above -26 dB: holds on
    audio[1300] = 0.0499F;  // below
    audio[1301] = std::numeric_limits<float>::quiet_NaN();
    host.hear(audio);
    host.midi(500, 0x90, 60, 100);  // the patch's own trigger is not heard
    host.play(6000, block);
    const auto& volts = host.volts[0];
    for (std::size_t i = 0; i < 6000; ++i) {
      if (i < 1000) {
        ASSERT_EQ(volts[i], 0) << i;
      }
      if (i >= 1000 && i <= 1200 + 480) {
        ASSERT_NEAR(volts[i], 1, 1e-6) << i;
      }
      if (i > 1200 + 481 + 480) {
        ASSERT_EQ(volts[i], 0) << i;
      }
    }
    EXPECT_LT(volts[1200 + 481 + 240], 1);
    EXPECT_EQ(host.through[1301], 0) << "NaN goes no further";
    EXPECT_EQ(host.through[1000], audio[1000]);
  }
}

TEST(EnvelopePlugin, AutomationAndTheSongOpenTheGateAtTheirSamples) {
  Host host;
  host.load(kStep);
  host.set("gate_source", 3);
  host.act(support::set_at(700, place_of(envelope_info(), "gate"), 1));
  host.act(support::set_at(1500, place_of(envelope_info(), "gate"), 0));
  host.act(support::set_at(3000, place_of(envelope_info(), "gate_source"), 2));
  host.act(support::transport_at(3333, {.quarters = 0, .is_playing = true, .has_position = true}));
  host.act(support::transport_at(4000, {.quarters = 0, .is_playing = false, .has_position = true}));
  host.play(6000, 100);
  const auto& volts = host.volts[0];
  EXPECT_EQ(volts[699], 0);
  EXPECT_NEAR(volts[700], 1, 1e-6);
  EXPECT_NEAR(volts[1500], 1, 1e-6);
  EXPECT_EQ(volts[3332], 0);
  EXPECT_NEAR(volts[3333], 1, 1e-6);
  EXPECT_EQ(volts[5000], 0);
}

// The song.

const std::string kClocked =
    "format = 1\nkind = 'envelope'\n[trigger]\nfrom = 'clock'\nbeats = 1\n[curves.fall]\n"
    "degree = 1\npoints = [1, 0]\n[envelopes.fall]\ncurve = 'fall'\nbeats = 1\n"
    "retrigger = 'restart'\n[[outputs]]\nfrom = 'fall'\nto = 'cv'\nrange = [0, 10]\n"
    "[curves.hill]\ndegree = 1\npoints = [0, 0.9, 0]\n[lfos.hill]\ncurve = 'hill'\nbeats = 4\n"
    "mode = 'free'\n[[outputs]]\nfrom = 'hill'\nto = 'cv'\ncv_channel = 2\nrange = [0, 10]\n";

TEST(EnvelopePlugin, ClocksAndLfosAreWhereTheSongIsAfterJumpsAndLoops) {
  Host host;
  host.load(kClocked);
  const Transport stands{.beats_per_minute = 120, .is_playing = false, .has_position = true};
  const auto plays = [](double quarters) {
    return Transport{
        .beats_per_minute = 120, .quarters = quarters, .is_playing = true, .has_position = true};
  };
  host.act(support::transport_at(0, stands));
  struct From {
    std::int64_t sample;
    double quarters;
  };
  const std::vector<From> jumps = {{5000, 2.75}, {40000, 0.9}, {70000, 5.5}};
  for (const From& jump : jumps) {
    host.act(support::transport_at(jump.sample, plays(jump.quarters)));
  }
  host.act(support::transport_at(100000, stands));
  host.play(130000, 512);
  for (std::size_t j = 0; j < jumps.size(); ++j) {
    const std::int64_t end = j + 1 < jumps.size() ? jumps[j + 1].sample : 100000;
    const double first = std::ceil(jumps[j].quarters);
    for (std::int64_t n = jumps[j].sample; n < end; ++n) {
      const double quarters = jumps[j].quarters + static_cast<double>(n - jumps[j].sample) / 24000;
      const auto i = static_cast<std::size_t>(n);
      if (quarters > first + 0.001 && quarters - std::floor(quarters) > 0.001) {
        ASSERT_NEAR(host.volts[0][i], 1 - (quarters - std::floor(quarters)), 1e-3) << n;
      }
      const double cycle = quarters / 4 - std::floor(quarters / 4);
      if (quarters > first) {
        const double hill = 0.9 * (cycle < 0.5 ? 2 * cycle : 2 - 2 * cycle);
        ASSERT_NEAR(host.volts[1][i], hill, 1e-3) << n << " " << quarters;
      }
    }
  }
  EXPECT_EQ(host.volts[0].back(), 0) << "no gate opens while the song stands";
}

// Parameters.

TEST(EnvelopePlugin, DepthsOffsetsAndMacrosReachTheirOutputs) {
  Host plain, host;
  const std::string patch =
      "format = 1\nkind = 'envelope'\n[trigger]\nfrom = 'loop'\n[curves.one]\ndegree = 1\n"
      "points = [0.5, 0.5]\n[envelopes.one]\ncurve = 'one'\nsustain_at = 0.5\n[[maps]]\n"
      "from = 'one'\nto = 'free.x'\n[[outputs]]\nfrom = 'free.x'\nto = 'cv'\nof = [-2, 2]\n"
      "range = [-2, 2]\n[[outputs]]\nfrom = 'one'\nto = 'cv'\ncv_channel = 2\nrange = [0, 4]\n";
  plain.load(patch);
  host.load(patch);
  host.set("macro.1", 0.75);
  host.set("depth.2", 0.5);
  host.set("offset.2", 0.25);
  plain.play(2000, 64);
  host.play(2000, 64);
  EXPECT_NEAR(plain.volts[0][1000], 0.05, 1e-7);
  EXPECT_NEAR(plain.volts[1][1000], 0.2, 1e-7);
  EXPECT_NEAR(host.volts[0][1000], 0.125, 1e-7);
  EXPECT_NEAR(host.volts[1][1000], 0.5 * 0.2 + 0.25 * 0.4, 1e-7);
}

// Patches and states.

TEST(EnvelopePlugin, EveryPresetLoadsAndItsStateIsTheSameAgain) {
  const auto plugin = envelope_info().create();
  for (std::size_t preset = 0; preset < envelope_info().presets.size(); ++preset) {
    ASSERT_TRUE(plugin->load_preset(preset)) << preset;
    plugin->set_parameter(preset, 1);
    const std::string state = plugin->state();
    const auto other = envelope_info().create();
    const auto loaded = other->load_state(state);
    ASSERT_TRUE(loaded) << loaded.error().to_string();
    EXPECT_EQ(other->state(), state);
  }
  EXPECT_FALSE(plugin->load_preset(envelope_info().presets.size()));
}

TEST(EnvelopePlugin, AStateHoldsEveryFileItsPatchNames) {
  const auto plugin = envelope_info().create();
  std::string patch =
      "format = 1\nkind = \"plugin\"\nplugin = \"envelope\"\npatch = \"p/a.toml\"\n"
      "[parameters]\ntime = -0.5\ngate_source = \"Song\"\n"
      "[[files]]\npath = \"p/a.toml\"\ntext = '''\nformat = 1\nkind = \"envelope\"\n"
      "name = \"a \\\\ \\\" \\u00E4\"\n[curves.c]\ncurve_file = \"b.toml\"\n[envelopes.e]\n"
      "curve = \"c\"\n[[outputs]]\nfrom = \"e\"\nto = \"cc1\"\n'''\n"
      "[[files]]\npath = \"p/b.toml\"\ntext = \"format = 1\\nkind = 'curve'\\r\\n[curves.c]\\n"
      "degree = 1\\npoints = [0, 1]\\n\"\n";
  const auto loaded = plugin->load_state(patch);
  ASSERT_TRUE(loaded) << loaded.error().to_string();
  EXPECT_EQ(plugin->parameter(place_of(envelope_info(), "time")), -0.5);
  EXPECT_EQ(plugin->parameter(place_of(envelope_info(), "gate_source")), 2);
  const std::string state = plugin->state();
  const auto other = envelope_info().create();
  ASSERT_TRUE(other->load_state(state));
  EXPECT_EQ(other->state(), state);
  EXPECT_THAT(state, testing::HasSubstr("p/b.toml"));
}

TEST(EnvelopePlugin, ADamagedStateIsRefusedWholeWithItsPlace) {
  const auto plugin = envelope_info().create();
  ASSERT_TRUE(plugin->load_preset(3));
  plugin->set_parameter(0, 0.25);
  const std::string kept = plugin->state();
  for (std::size_t cut = 0; cut + 5 < kept.size(); cut += 1 + cut / 16) {
    const auto loaded = plugin->load_state(std::string_view(kept).substr(0, cut));
    ASSERT_FALSE(loaded) << cut;
    ASSERT_EQ(plugin->state(), kept) << cut;
  }
  const auto refused = [&](std::string state, const char* from, const char* to,
                           const std::string& message) {
    state.replace(state.find(from), std::strlen(from), to);
    const auto loaded = plugin->load_state(state);
    ASSERT_FALSE(loaded) << to;
    EXPECT_THAT(loaded.error().to_string(), testing::HasSubstr(message));
    EXPECT_EQ(plugin->state(), kept);
  };
  refused(kept, "time = 0.25", "time = 99", "the plugin's state:8:8: error:");
  refused(kept, "time = 0.25", "tine = 1", "tine");
  refused(kept, "\"envelope\"\n", "\"shaper\"\n", "plugin is 'shaper'");
  refused(kept, "degree  = 4", "degree  = 40", "four-voltages.toml:10:");
}

TEST(EnvelopePlugin, WhatAPluginCannotSendIsRefusedInWords) {
  const auto plugin = envelope_info().create();
  const std::string kept = plugin->state();
  const auto message = [&](const std::string& output) {
    std::string patch = kStep;
    patch += "[[outputs]]\nfrom = 'step'\n" + output;
    const auto loaded = plugin->load_state(patch);
    EXPECT_FALSE(loaded) << output;
    EXPECT_EQ(plugin->state(), kept);
    return loaded ? std::string() : loaded.error().message;
  };
  EXPECT_THAT(message("to = 'osc'\naddress = '/a'\n"),
              testing::HasSubstr("output 2 of '' goes to the OSC address /a: a plugin sends"));
  EXPECT_THAT(message("to = 'cv'\ncv_channel = 9\n"),
              testing::HasSubstr("audio channel 9; the plugin has 8 control voltages"));
  EXPECT_THAT(message("to = 'cc1'\n[[events]]\nenvelope = 'step'\ngate = 12\n"),
              testing::HasSubstr("event 1 of '' goes to audio channel 12"));
  EXPECT_FALSE(plugin->activate(7999));
  EXPECT_FALSE(plugin->activate(std::nan("")));
  EXPECT_FALSE(plugin->is_active());
}

// Ends.

/// What a receiver would hold: notes that are on, and the last value of each controller.
struct Receiver {
  explicit Receiver(const std::vector<Sent>& sent) {
    for (const Sent& message : sent) {
      const auto& [status, one, two] = message.bytes;
      const std::pair<int, int> key(status & 15, one);
      if ((status & 0xF0) == 0x90 && two != 0) ++notes[key];
      if ((status & 0xF0) == 0x80 || ((status & 0xF0) == 0x90 && two == 0)) --notes[key];
      if ((status & 0xF0) == 0xB0) controllers[key] = two;
      if ((status & 0xF0) == 0xE0) bends[status & 15] = (two << 7 | one) - 8192;
    }
    std::erase_if(notes, [](const auto& note) { return note.second == 0; });
  }
  std::map<std::pair<int, int>, int> notes, controllers;
  std::map<int, int> bends;
};

TEST(EnvelopePlugin, AResetEndsNotesAndBringsValuesToRest) {
  Host host;
  host.load(patch_text("filter-swell"));
  host.midi(0, 0x90, 60, 127);
  host.play(24000, 64);
  EXPECT_EQ(Receiver(host.sent).notes.size(), 1u);
  EXPECT_NE((Receiver(host.sent).controllers[{0, 74}]), 64);
  host.plugin().reset();
  host.play(25000, 64);
  EXPECT_TRUE(Receiver(host.sent).notes.empty());
  EXPECT_EQ((Receiver(host.sent).controllers[{0, 74}]), 64);
}

TEST(EnvelopePlugin, APatchThatIsReplacedEndsItsNotesAndRestsBesideTheNewOne) {
  Host host;
  host.load(patch_text("pitch-adsr"));
  host.midi(0, 0x90, 60, 100);
  host.play(2000, 64);
  ASSERT_EQ(Receiver(host.sent).notes.size(), 1u);
  ASSERT_TRUE(host.plugin().load_state(patch_text("filter-swell")));
  host.midi(2100, 0x90, 64, 100);
  host.play(50000, 64);
  const Receiver now(host.sent);
  EXPECT_EQ(now.notes, (std::map<std::pair<int, int>, int>{{{0, 64}, 1}}));
  EXPECT_EQ(now.bends, (std::map<int, int>{{0, 0}})) << "in tune";
  EXPECT_EQ(now.controllers.count({0, 74}), 1u);
  host.plugin().collect();
  // Values that both patches send are those of the new one.
  ASSERT_TRUE(host.plugin().load_state(
      "format = 1\nkind = 'envelope'\n[trigger]\nfrom = 'loop'\n[curves.c]\ndegree = 1\n"
      "points = [1, 1]\n[envelopes.c]\ncurve = 'c'\nsustain_at = 0.5\n[[outputs]]\nfrom = 'c'\n"
      "to = 'cc74'\nrange = [0, 99]\n"));
  host.play(150000, 64);
  EXPECT_EQ((Receiver(host.sent).controllers[{0, 74}]), 99);
  EXPECT_TRUE(Receiver(host.sent).notes.empty());
}

TEST(EnvelopePlugin, NoNoteHangsWhereItIsSwitchedOffAndOn) {
  for (const char* const preset : {"filter-swell", "mpe-pressure", "pitch-adsr"}) {
    for (const double rate_hz : {48000.0, 96000.0}) {
      Host host;
      host.load(patch_text(preset));
      host.midi(0, 0x90, 60, 100);
      host.play(4800, 64);
      ASSERT_EQ(Receiver(host.sent).notes.size(), 1u) << preset;
      host.plugin().deactivate();
      ASSERT_TRUE(host.plugin().activate(8000));  // and plays nothing there
      ASSERT_TRUE(host.plugin().activate(rate_hz));
      host.midi(4900, 0x80, 60, 0);
      host.play(60000, 64);
      EXPECT_TRUE(Receiver(host.sent).notes.empty()) << preset;
    }
  }
}

TEST(EnvelopePlugin, AtRestTheShippedPatchesOfKeysSendNothing) {
  for (const char* const preset : {"filter-swell", "mpe-pressure", "pitch-adsr"}) {
    Host host;
    host.load(patch_text(preset));
    host.midi(0, 0x90, 60, 100);
    host.midi(48000, 0x80, 60, 0);
    host.play(5 * 48000, 512);
    const std::size_t before = host.sent.size();
    EXPECT_GT(before, 20u);
    host.play(10 * 48000, 512);
    EXPECT_EQ(host.sent.size(), before) << preset;
  }
}

TEST(EnvelopePlugin, AStormOfEverythingLeavesNoNoteAndNoNaN) {
  Host host;
  const base::RandomStream random{support::test_seed(), 0, 9};
  std::uint64_t draw = 0;
  const auto bits = [&] { return random.bits(draw++); };
  std::vector<float> audio(80000);
  for (float& sample : audio) {
    sample = bits() % 50 == 0 ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(random.bipolar(draw++));
  }
  host.hear(audio);
  for (int turn = 0; turn < 150; ++turn) {
    const std::int64_t begin = host.now();
    std::int64_t at = begin;
    for (int i = 0; i < 12; ++i) {
      at += static_cast<std::int64_t>(bits() % 40);
      const std::uint64_t what = bits() % 8;
      if (what < 4) {
        constexpr std::array<int, 6> kStatus = {0x90, 0x90, 0x80, 0xB0, 0xD0, 0xE0};
        host.midi(at, kStatus[bits() % 6] | static_cast<int>(bits() % 3),
                  static_cast<int>(bits() % 128), static_cast<int>(bits() % 128));
      } else if (what < 7) {
        const double value = bits() % 20 == 0 ? std::nan("") : 130 * random.bipolar(draw++);
        host.act(support::set_at(at, bits() % 40, value));
      } else {
        host.act(support::transport_at(at, {.beats_per_minute = 300 * random.unit(draw++),
                                            .quarters = 20 * random.bipolar(draw++),
                                            .is_playing = bits() % 2 == 0,
                                            .has_position = bits() % 4 != 0}));
      }
    }
    if (turn % 10 == 9) {
      ASSERT_TRUE(host.plugin().load_preset(bits() % envelope_info().presets.size()));
    }
    if (turn % 17 == 16) host.plugin().reset();
    host.play(begin + 512, 1 + static_cast<std::int64_t>(bits() % 200));
  }
  host.set("gate_source", 3);
  host.set("gate", 0);
  host.plugin().reset();
  host.play(host.now() + 60000, 512);
  EXPECT_TRUE(Receiver(host.sent).notes.empty());
  for (const auto& channel : host.volts) {
    for (const float sample : channel) ASSERT_LE(std::abs(sample), 1);
  }
  for (const Sent& sent : host.sent) {
    ASSERT_GE(sent.bytes[0], 0x80);
    ASSERT_LT(sent.bytes[1] | sent.bytes[2], 0x80);
  }
  EXPECT_GT(host.sent.size(), 300u);
}

TEST(EnvelopePlugin, InstancesComeAndGoInAnyOrder) {
  std::vector<std::unique_ptr<Plugin>> all;
  for (std::size_t i = 0; i < 24; ++i) {
    all.push_back(envelope_info().create());
    if (i % 2 == 0) {
      ASSERT_TRUE(all.back()->activate(44100));
    }
    ASSERT_TRUE(all.back()->load_preset(i % envelope_info().presets.size()));
  }
  while (!all.empty()) all.erase(all.begin() + static_cast<std::ptrdiff_t>(all.size() / 3));
}

}  // namespace
}  // namespace knotwave::plugins

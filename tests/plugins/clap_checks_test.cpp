// SPDX-License-Identifier: MIT
// What any CLAP host may do to any of the plugins: the list of checks of clap-validator
// (github.com/free-audio/clap-validator), made anew.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include <clap/ext/note-ports.h>
#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/plugins/plugin_list.h"

#include "clap_host.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

constexpr std::size_t kBlockSizes[] = {1, 10, 17, 256, 1536, 2027, 16384};
constexpr double kRates[] = {8000,  11025, 22050,  44100,  48000,
                             88200, 96000, 192000, 384000, 768000};

const ClapLibrary& library() {
  static const ClapLibrary opened(KNOTWAVE_BIN_DIR "/../plugins/clap/knotwave.clap");
  return opened;
}

class ClapChecks : public testing::TestWithParam<const plugins::PluginInfo*> {
 protected:
  std::string id() const { return "org.knotwave." + std::string(GetParam()->key); }
  std::unique_ptr<ClapPlugin> made() const {
    return std::make_unique<ClapPlugin>(library().factory(), id().c_str());
  }
  std::unique_ptr<ClapPlugin> started(double rate_hz = 48000) const {
    auto plugin = made();
    EXPECT_TRUE(plugin->start(rate_hz, 16384));
    return plugin;
  }
  const plugins::ParameterTable& table() const { return *GetParam()->parameters; }

  double draw() { return random_.unit(draws_++); }
  int draw(int below) {
    return static_cast<int>(random_.bits(draws_++) % static_cast<unsigned>(below));
  }
  Channels noise(const ClapPlugin& plugin, std::size_t frames, double level = 1) {
    Channels all(plugin.channels(true), std::vector<float>(frames));
    for (auto& channel : all) {
      for (float& sample : channel) sample = static_cast<float>(level * random_.bipolar(draws_++));
    }
    return all;
  }
  /// Notes as they should be: each that begins ends.
  std::vector<ClapEvent> some_notes(std::size_t frames) {
    std::vector<ClapEvent> events;
    for (std::uint32_t at = 0; at < frames; at += static_cast<std::uint32_t>(1 + frames / 4)) {
      events.push_back(clap_note(at, draw(2) == 0 ? CLAP_EVENT_NOTE_ON : CLAP_EVENT_NOTE_OFF,
                                 draw(16), draw(128), draw()));
    }
    return events;
  }
  /// Anything at all, wildcards and numbers nobody gave included.
  std::vector<ClapEvent> any_notes(std::size_t frames) {
    constexpr int kTypes[] = {CLAP_EVENT_NOTE_ON, CLAP_EVENT_NOTE_OFF, CLAP_EVENT_NOTE_CHOKE};
    std::vector<ClapEvent> events;
    for (std::uint32_t at = 0; at < frames; at += static_cast<std::uint32_t>(1 + frames / 16)) {
      const int channel = draw(18) - 1, key = draw(130) - 1;
      if (draw(4) == 0) {
        events.push_back(
            clap_expression(at, draw(9) - 1, draw(40) - 1, channel, key, draw() * 200 - 100));
      } else {
        events.push_back(
            clap_numbered(at, kTypes[draw(3)], draw(40) - 1, channel, key, draw() * 2 - 0.5));
      }
    }
    return events;
  }
  std::vector<ClapEvent> any_parameters() {
    std::vector<ClapEvent> events;
    for (const plugins::Parameter& parameter : table().all()) {
      events.push_back(
          clap_value(0, parameter.id, parameter.low + draw() * (parameter.high - parameter.low)));
    }
    return events;
  }
  static void expect_sound(const Channels& channels, const std::string& what) {
    for (const auto& channel : channels) {
      for (const float sample : channel) {
        ASSERT_TRUE(std::isfinite(sample)) << what;
        ASSERT_FALSE(std::fpclassify(sample) == FP_SUBNORMAL) << what;
      }
    }
  }

 private:
  const base::RandomStream random_{support::test_seed(), 0, 6001};
  std::uint64_t draws_ = 0;
};

TEST_P(ClapChecks, IsDescribedAndMadeByItsIdOnly) {
  const clap_plugin_factory* factory = library().factory();
  std::set<std::string> ids;
  bool is_there = false;
  for (std::uint32_t i = 0; i < factory->get_plugin_count(factory); ++i) {
    const clap_plugin_descriptor* descriptor = factory->get_plugin_descriptor(factory, i);
    ASSERT_NE(descriptor, nullptr);
    ids.insert(descriptor->id);
    if (descriptor->id != id()) continue;
    is_there = true;
    EXPECT_EQ(descriptor->name, GetParam()->name);
    EXPECT_STRNE(descriptor->vendor, "");
    EXPECT_STRNE(descriptor->version, "");
    EXPECT_STRNE(descriptor->description, "");
    ASSERT_NE(descriptor->features[0], nullptr);
    const std::string kind = descriptor->features[0];
    EXPECT_TRUE(kind == "instrument" || kind == "audio-effect" || kind == "note-effect") << kind;
  }
  EXPECT_TRUE(is_there);
  EXPECT_EQ(ids.size(), factory->get_plugin_count(factory));
  EXPECT_EQ(factory->get_plugin_descriptor(factory, 1000), nullptr);
  EXPECT_EQ(made()->get()->get_extension(made()->get(), "org.knotwave.nothing"), nullptr);
  clap_host host{};
  host.clap_version = CLAP_VERSION;
  EXPECT_EQ(factory->create_plugin(factory, &host, "org.knotwave.nobody"), nullptr);
}

TEST_P(ClapChecks, PortsAreThoseItSaysItHas) {
  const auto plugin = made();
  const auto* ports = plugin->extension<clap_plugin_audio_ports>(CLAP_EXT_AUDIO_PORTS);
  ASSERT_NE(ports, nullptr);
  for (const bool is_input : {true, false}) {
    std::set<clap_id> ids;
    const std::uint32_t count = ports->count(plugin->get(), is_input);
    for (std::uint32_t i = 0; i < count; ++i) {
      clap_audio_port_info info{};
      ASSERT_TRUE(ports->get(plugin->get(), i, is_input, &info));
      ids.insert(info.id);
      EXPECT_STRNE(info.name, "");
      EXPECT_EQ((info.flags & CLAP_AUDIO_PORT_IS_MAIN) != 0, i == 0);
      EXPECT_STREQ(info.port_type, info.channel_count == 2 ? CLAP_PORT_STEREO : CLAP_PORT_MONO);
    }
    EXPECT_EQ(ids.size(), count);
    clap_audio_port_info info{};
    EXPECT_FALSE(ports->get(plugin->get(), count, is_input, &info));
  }
  const auto* notes = plugin->extension<clap_plugin_note_ports>(CLAP_EXT_NOTE_PORTS);
  EXPECT_EQ(notes != nullptr, GetParam()->takes_midi || GetParam()->gives_midi);
  if (notes == nullptr) return;
  for (const bool is_input : {true, false}) {
    for (std::uint32_t i = 0; i < notes->count(plugin->get(), is_input); ++i) {
      clap_note_port_info info{};
      ASSERT_TRUE(notes->get(plugin->get(), i, is_input, &info));
      EXPECT_NE(info.supported_dialects & info.preferred_dialect, 0u);
    }
  }
}

TEST_P(ClapChecks, InPlaceAndOutOfPlaceAreTheSame) {
  const auto apart = started(), shared = started();
  for (int i = 0; i < 20; ++i) {
    const auto events = some_notes(512);
    const Channels in = noise(*apart, 512);
    Channels one, other;
    ASSERT_NE(apart->process(events, 512, in, one), CLAP_PROCESS_ERROR);
    ASSERT_NE(shared->process(events, 512, in, other, nullptr, true), CLAP_PROCESS_ERROR);
    ASSERT_EQ(one, other) << i;
    expect_sound(one, "block " + std::to_string(i));
  }
}

TEST_P(ClapChecks, AnyBlockSizeAndRateGivesSound) {
  for (const double rate_hz : kRates) {
    const auto plugin = started(rate_hz);
    for (const std::size_t frames : kBlockSizes) {
      Channels out;
      ASSERT_NE(plugin->process(some_notes(frames), frames, noise(*plugin, frames), out),
                CLAP_PROCESS_ERROR);
      expect_sound(out, std::to_string(rate_hz) + " Hz, " + std::to_string(frames));
    }
  }
  for (const double rate_hz : {1234.5678, 0.0, -48000.0, 1e9, std::nan("")}) {
    EXPECT_FALSE(made()->start(rate_hz, 512)) << rate_hz;
  }
  EXPECT_TRUE(made()->start(12345.678, 512));
}

TEST_P(ClapChecks, DenormalAndHostileInputGivesSound) {
  for (const float hostile : {1e-40F, -1e-40F, std::numeric_limits<float>::infinity(),
                              std::numeric_limits<float>::quiet_NaN(), 1e30F}) {
    const auto plugin = started();
    Channels in(plugin->channels(true), std::vector<float>(256, hostile)), out;
    for (int i = 0; i < 5; ++i) {
      ASSERT_NE(plugin->process(some_notes(256), 256, in, out), CLAP_PROCESS_ERROR);
      expect_sound(out, std::to_string(hostile));
    }
    // What came in is forgotten: an hour later all is as it would be.
    for (auto& channel : in) std::fill(channel.begin(), channel.end(), 0.0F);
    for (int i = 0; i < 400; ++i) plugin->process({}, 256, in, out);
    expect_sound(out, "after " + std::to_string(hostile));
  }
}

TEST_P(ClapChecks, NotesThatMakeNoSenseDoNoHarm) {
  const auto plugin = started();
  Channels out;
  for (int i = 0; i < 100; ++i) {
    ASSERT_NE(plugin->process(any_notes(256), 256, noise(*plugin, 256), out), CLAP_PROCESS_ERROR);
    expect_sound(out, std::to_string(i));
  }
}

TEST_P(ClapChecks, FiftySetsOfParametersGiveSound) {
  const auto plugin = started();
  Channels out;
  for (int set = 0; set < 50; ++set) {
    auto events = any_parameters();
    for (int i = 0; i < 5; ++i) {
      ASSERT_NE(plugin->process(events, 256, noise(*plugin, 256), out), CLAP_PROCESS_ERROR);
      expect_sound(out, "set " + std::to_string(set));
      events = some_notes(256);
    }
  }
}

TEST_P(ClapChecks, AfterDeactivationAllIsAsItWasAtFirst) {
  const auto plugin = started();
  const auto events = some_notes(1024);
  const Channels in = noise(*plugin, 1024);
  Channels first, again;
  ASSERT_NE(plugin->process(events, 1024, in, first), CLAP_PROCESS_ERROR);
  ASSERT_TRUE(plugin->start(48000, 1024));
  ASSERT_NE(plugin->process(events, 1024, in, again), CLAP_PROCESS_ERROR);
  EXPECT_EQ(first, again);
}

TEST_P(ClapChecks, ResetEndsWhatSounds) {
  const auto plugin = started();
  Channels out, silence(plugin->channels(true), std::vector<float>(512));
  for (int i = 0; i < 4; ++i) plugin->process(some_notes(512), 512, noise(*plugin, 512), out);
  plugin->get()->reset(plugin->get());
  // An effect with a curve that is not 0 at 0 gives that, and no more than that.
  const auto fresh = started();
  Channels expected;
  ASSERT_NE(plugin->process({}, 512, silence, out), CLAP_PROCESS_ERROR);
  ASSERT_NE(fresh->process({}, 512, silence, expected), CLAP_PROCESS_ERROR);
  EXPECT_EQ(out, expected);
}

TEST_P(ClapChecks, ParametersAreTheTablesAndReadBack) {
  const auto plugin = made();
  const auto* parameters = plugin->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  ASSERT_EQ(parameters->count(plugin->get()), table().size());
  std::set<clap_id> ids;
  for (std::uint32_t i = 0; i < table().size(); ++i) {
    clap_param_info info{};
    ASSERT_TRUE(parameters->get_info(plugin->get(), i, &info));
    ids.insert(info.id);
    EXPECT_LE(info.min_value, info.default_value);
    EXPECT_LE(info.default_value, info.max_value);
    double value = 0;
    ASSERT_TRUE(parameters->get_value(plugin->get(), info.id, &value));
    EXPECT_EQ(value, info.default_value);
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const double wanted =
          plugins::held(table()[i], info.min_value + part * (info.max_value - info.min_value));
      char text[128];
      ASSERT_TRUE(parameters->value_to_text(plugin->get(), info.id, wanted, text, sizeof text));
      ASSERT_TRUE(parameters->text_to_value(plugin->get(), info.id, text, &value)) << text;
      EXPECT_NEAR(value, wanted, 0.0005) << text;
    }
    EXPECT_FALSE(parameters->text_to_value(plugin->get(), info.id, "no number at all", &value));
  }
  EXPECT_EQ(ids.size(), table().size());
  clap_param_info info{};
  EXPECT_FALSE(
      parameters->get_info(plugin->get(), static_cast<std::uint32_t>(table().size()), &info));
  double value = 0;
  EXPECT_FALSE(parameters->get_value(plugin->get(), 0x7FFFFFFE, &value));
}

TEST_P(ClapChecks, AStateComesBackToTheByteAlsoInPiecesOf17) {
  const auto plugin = started();
  Channels out;
  plugin->process(any_parameters(), 256, noise(*plugin, 256), out);
  const std::string state = plugin->save();
  EXPECT_EQ(plugin->save(17), state);
  const auto other = made();
  ASSERT_TRUE(other->load(state, 17));
  EXPECT_EQ(other->save(), state);
  const auto* parameters = plugin->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  for (const plugins::Parameter& parameter : table().all()) {
    double one = 0, two = 1;
    ASSERT_TRUE(parameters->get_value(plugin->get(), parameter.id, &one));
    ASSERT_TRUE(parameters->get_value(other->get(), parameter.id, &two));
    EXPECT_EQ(one, two) << parameter.word;
  }
}

TEST_P(ClapChecks, NoStateAndRandomStatesAreRefused) {
  const auto plugin = started();
  const std::string before = plugin->save();
  EXPECT_FALSE(plugin->load(""));
  for (int i = 0; i < 3; ++i) {
    std::string bytes(1 << 20, '\0');
    for (char& byte : bytes) byte = static_cast<char>(draw(256));
    EXPECT_FALSE(plugin->load(bytes));
  }
  EXPECT_FALSE(plugin->load(before.substr(0, before.size() / 2)));
  EXPECT_EQ(plugin->save(), before);
}

TEST_P(ClapChecks, AnyTransportDoesNoHarm) {
  const auto plugin = started();
  Channels out;
  const double tempos[] = {
      0, -1, 120, 1e9, 1e-9, std::nan(""), std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 200; ++i) {
    clap_event_transport transport{};
    transport.header = {sizeof transport, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_TRANSPORT, 0};
    transport.flags = static_cast<std::uint32_t>(draw(256));
    transport.tempo = tempos[draw(7)];
    transport.song_pos_beats = (draw(2) == 0 ? 1 : -1) * (std::int64_t{1} << draw(62));
    transport.song_pos_seconds = -transport.song_pos_beats;
    transport.tsig_num = static_cast<std::uint16_t>(draw(5));
    transport.tsig_denom = static_cast<std::uint16_t>(draw(5));
    ASSERT_NE(plugin->process(some_notes(256), 256, noise(*plugin, 256), out,
                              draw(4) == 0 ? nullptr : &transport),
              CLAP_PROCESS_ERROR);
    expect_sound(out, std::to_string(i));
  }
}

TEST_P(ClapChecks, ParametersAreFlushedWhileItSleeps) {
  const auto plugin = made();
  const auto* parameters = plugin->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  auto events = any_parameters();
  events.push_back(clap_value(0, 0x7FFFFFFE, 1));
  const clap_input_events in{
      &events,
      [](const clap_input_events* list) {
        return static_cast<std::uint32_t>(static_cast<std::vector<ClapEvent>*>(list->ctx)->size());
      },
      [](const clap_input_events* list, std::uint32_t i) -> const clap_event_header* {
        return &(*static_cast<std::vector<ClapEvent>*>(list->ctx))[i].header;
      }};
  const clap_output_events out{
      nullptr, [](const clap_output_events*, const clap_event_header*) { return true; }};
  parameters->flush(plugin->get(), &in, &out);
  for (std::size_t i = 0; i < table().size(); ++i) {
    double value = 0;
    ASSERT_TRUE(parameters->get_value(plugin->get(), table()[i].id, &value));
    EXPECT_EQ(value, plugins::held(table()[i], events[i].value.value));
  }
}

// Made, played, saved and destroyed in any order, by two threads at once.
TEST_P(ClapChecks, ManyInstancesOnTwoThreadsShareNothing) {
  const auto events = some_notes(256);
  const Channels in = noise(*made(), 256);
  const auto play = [&](ClapPlugin& plugin) {
    Channels out;
    EXPECT_TRUE(plugin.start(48000, 256));
    for (int i = 0; i < 4; ++i) plugin.process(events, 256, in, out);
    return out;
  };
  const Channels expected = play(*made());
  const std::string state = made()->save();
  const auto run = [&](int first) {
    std::vector<std::unique_ptr<ClapPlugin>> all;
    for (int i = 0; i < 32; ++i) {
      all.push_back(made());
      if ((i + first) % 3 == 0) {
        EXPECT_TRUE(all.back()->load(state));
      }
      EXPECT_EQ(play(*all.back()), expected);
      EXPECT_EQ(all.back()->save(), state);
      if (i % 2 == first) all.erase(all.begin() + i % static_cast<int>(all.size()));
    }
  };
  std::thread other(run, 1);
  run(0);
  other.join();
}

INSTANTIATE_TEST_SUITE_P(Plugins, ClapChecks,
                         testing::ValuesIn(plugins::all_plugins().begin(),
                                           plugins::all_plugins().end()),
                         [](const auto& tested) { return std::string(tested.param->key); });

}  // namespace
}  // namespace knotwave::test

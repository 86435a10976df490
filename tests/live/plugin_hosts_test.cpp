// SPDX-License-Identifier: MIT
// The plugins in hosts under a JACK server, LV2 in jalv and VST3 in Ardour: what is heard is what
// the engine gives for the same notes. Debian packages: jalv lv2-dev sordi lilv-utils ardour.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/plugins/instrument.h"
#include "knotwave/plugins/plugin_list.h"

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

Heard rendered(double pan = 0) {
  plugins::Instrument instrument;
  instrument.set_parameter(plugins::Instrument::table().of_word("pan"), pan);
  EXPECT_TRUE(instrument.activate(48000));
  std::vector<float> before(4800), too(4800);  // pan glides to its place
  instrument.begin(before, too);
  instrument.render();
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

bool comes(const std::string& port, int seconds) {
  for (int i = 0; i < seconds * 10; ++i) {
    const JackMidiSender probe(port, {});
    if (probe.is_connected()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

/// Plays notes() into one port, and hears `expected` at the very sample at two others.
void expect_heard(const std::string& notes_in, const std::string& left_out,
                  const std::string& right_out, const Heard& expected) {
  JackCapture capture({left_out, right_out}, 48000 * 20);
  ASSERT_TRUE(capture.is_connected());
  JackMidiSender sender(notes_in, notes());
  ASSERT_TRUE(sender.is_connected());
  ASSERT_TRUE(sender.wait_until_sent(20));
  const std::size_t begin = sender.begin_frame_time() - capture.first_frame_time();
  ASSERT_TRUE(capture.wait_for(begin + kFrames, 20));
  const std::vector<float> left = capture.channel(0), right = capture.channel(1);
  EXPECT_GT(*std::ranges::max_element(expected.left), 0.01F);
  for (std::size_t i = 0; i < kFrames; ++i) {
    ASSERT_EQ(left[begin + i], expected.left[i]) << i;
    ASSERT_EQ(right[begin + i], expected.right[i]) << i;
  }
}

TEST(PluginHosts, JalvGivesTheVerySamplesOfTheEngine) {
  JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  const support::SetVariable path("LV2_PATH", KNOTWAVE_BIN_DIR "/../plugins/lv2");
  const support::ScratchFolder folder;
  const BackgroundProgram jalv(
      {"sh", "-c", "sleep 60 | exec jalv -x -n plugin urn:knotwave:instrument"},
      folder.file("jalv.log"));
  ASSERT_TRUE(comes("plugin:lv2_events_in", 10))
      << *base::read_file(folder.file("jalv.log"), 1 << 20);
  expect_heard("plugin:lv2_events_in", "plugin:lv2_audio_out_1", "plugin:lv2_audio_out_2",
               rendered());
}

// What it finds wrong is vocabulary that is not installed: mod:brand and mod:label of MOD's
// devices.
TEST(PluginHosts, TheLv2ValidatorFindsNothingOfOursWrong) {
  const auto run = support::run_program(
      {"/bin/sh", "-c", "lv2_validate " KNOTWAVE_BIN_DIR "/../plugins/lv2/*.lv2/*.ttl 2>&1"});
  std::size_t found = 0, of_mod = 0, place = run.out.find("error: ");
  ASSERT_NE(run.out.find("restrictions)"), std::string::npos)
      << run.out << "apt-get install lv2-dev sordi";
  while (place != std::string::npos) {
    const std::size_t next = run.out.find("error: ", place + 1);
    const std::string error = run.out.substr(place, next - place);
    ++found;
    of_mod += error.find("http://moddevices.com/ns/mod#") != std::string::npos;
    place = next;
  }
  EXPECT_EQ(found, of_mod) << run.out;
}

TEST(PluginHosts, LilvListsThePluginsAndTheirPresets) {
  const support::SetVariable path("LV2_PATH", KNOTWAVE_BIN_DIR "/../plugins/lv2");
  for (const plugins::PluginInfo* info : plugins::all_plugins()) {
    const auto run =
        support::run_program({"/usr/bin/lv2info", "urn:knotwave:" + std::string(info->key)});
    EXPECT_EQ(run.exit_code, 0) << run.err << "apt-get install lilv-utils";
    EXPECT_EQ(run.err, "");
    for (const std::string& preset : info->presets) {
      EXPECT_NE(run.out.find(preset), std::string::npos) << preset;
    }
  }
}

/// Ardour without a window: its Lua sessions, with a home of their own and only our module in it.
class Ardour {
 public:
  Ardour() : home_("HOME", folder_.path()) {
    const std::string modules = folder_.file("vst3"), config = folder_.file(".config/ardour7");
    std::filesystem::create_directories(modules);
    std::filesystem::create_directories(config);
    std::filesystem::copy(KNOTWAVE_BIN_DIR "/../plugins/vst3/knotwave.vst3",
                          modules + "/knotwave.vst3", std::filesystem::copy_options::recursive);
    // What is not older than the scanner's notes on it, Ardour 7.3 stumbles over.
    for (const auto& entry : std::filesystem::recursive_directory_iterator(modules)) {
      std::filesystem::last_write_time(
          entry, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
    }
    EXPECT_TRUE(
        base::write_file(config + "/config",
                         "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Ardour><Config>\n<Option "
                         "name=\"port-resampler-quality\" value=\"0\"/>\n<Option name=\"use-vst3\" "
                         "value=\"1\"/>\n<Option name=\"plugin-path-vst3\" value=\"" +
                             modules + "\"/>\n</Config></Ardour>\n"));
  }
  support::ProgramRun scan() const {
    return support::run_program(
        {"/bin/sh", "-c",
         "LD_LIBRARY_PATH=/usr/lib/ardour7 exec /usr/lib/ardour7/ardour-vst3-scanner -f -v " +
             folder_.file("vst3/knotwave.vst3")});
  }
  /// Runs a Lua script.
  std::unique_ptr<BackgroundProgram> run(const std::string& script) const {
    EXPECT_TRUE(base::write_file(folder_.file("session.lua"), script));
    return std::make_unique<BackgroundProgram>(
        std::vector<std::string>{"ardour7-lua", folder_.file("session.lua")},
        folder_.file("ardour.log"));
  }
  std::string session() const { return folder_.file("session"); }
  /// What a script does in the end: says so, and stays.
  std::string ready(int seconds) const {
    return "io.open('" + folder_.file("ready") + "', 'w'):close()\nos.execute('sleep " +
           std::to_string(seconds) + "')\n";
  }
  bool is_ready() const {
    for (int i = 0; i < 300 && !std::filesystem::exists(folder_.file("ready")); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return std::filesystem::remove(folder_.file("ready"));
  }
  std::string log() const { return *base::read_file(folder_.file("ardour.log"), 1 << 20); }

 private:
  support::ScratchFolder folder_;
  support::SetVariable home_;
};

/// Ardour's number of it, behind 16 x 130 controllers.
std::size_t ardours_pan() { return 2080 + plugins::Instrument::table().of_word("pan"); }
constexpr double kPan = 0.125;
/// Ardour sets and saves on threads of its own.
const std::string kWait = "ARDOUR.LuaAPI.usleep(1000000)\n";

/// A track with our instrument at unity gain and its panner off, the input heard.
std::string new_session(const std::string& folder) {
  return "AudioEngine:set_backend('JACK', 'ardour', '')\nAudioEngine:start(false)\n"
         "local s = create_session('" +
         folder + R"(', 'session', 48000)
for i in ARDOUR.LuaAPI.list_plugins():iter() do end
local midi = ARDOUR.ChanCount(ARDOUR.DataType('midi'), 1)
local stereo = ARDOUR.ChanCount(ARDOUR.DataType('audio'), 2)
local t = s:new_midi_track(midi, stereo, true, ARDOUR.PluginInfo(), nil, nil, 1, 'synth',
  ARDOUR.PresentationInfo.max_order, ARDOUR.TrackMode.Normal, true):front()
local p = ARDOUR.LuaAPI.new_plugin(s, 'Knotwave', ARDOUR.PluginType.VST3, '')
t:add_processor_by_index(p, 0, nil, true)
t:monitoring_control():set_value(1, PBD.GroupControlDisposition.NoGroup)
t:panner_shell():set_bypassed(true)
)" + "ARDOUR.LuaAPI.set_processor_param(t:nth_plugin(0), " +
         std::to_string(ardours_pan()) + ", " + std::to_string(kPan) + ")\n" + kWait +
         "s:save_state('')\n" + kWait;
}
/// Says what the parameter is in the plugin of a session that was saved.
std::string old_session(const std::string& folder) {
  return "AudioEngine:set_backend('JACK', 'ardour', '')\nAudioEngine:start(false)\n"
         "local s = load_session('" +
         folder + "', 'session')\nlocal p = s:route_by_name('synth'):nth_plugin(0)\n" + kWait +
         "print('pan is ' .. ARDOUR.LuaAPI.get_processor_param(p, " +
         std::to_string(ardours_pan()) + "))\nio.flush()\n";
}

TEST(PluginHosts, ArdoursScannerTakesTheModule) {
  const Ardour ardour;
  const auto scanned = ardour.scan();
  EXPECT_EQ(scanned.exit_code, 0) << scanned.err;
  EXPECT_NE((scanned.out + scanned.err).find("Found Plugin: Knotwave"), std::string::npos)
      << scanned.out << scanned.err;
}

TEST(PluginHosts, ArdourGivesTheVerySamplesOfTheEngineAndKeepsParametersInItsSession) {
  const Ardour ardour;
  ASSERT_EQ(ardour.scan().exit_code, 0);
  {
    JackServer server;
    ASSERT_TRUE(server.runs()) << server.log();
    const auto running = ardour.run(new_session(ardour.session()) + ardour.ready(8));
    ASSERT_TRUE(ardour.is_ready()) << ardour.log();
    expect_heard("ardour:synth/midi_in 1", "ardour:synth/audio_out 1", "ardour:synth/audio_out 2",
                 rendered(kPan));
  }
  JackServer server;
  ASSERT_TRUE(server.runs()) << server.log();
  const auto running = ardour.run(old_session(ardour.session()) + ardour.ready(1));
  ASSERT_TRUE(ardour.is_ready()) << ardour.log();
  EXPECT_NE(ardour.log().find("pan is 0.125"), std::string::npos) << ardour.log();
}

}  // namespace
}  // namespace knotwave

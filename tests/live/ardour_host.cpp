// SPDX-License-Identifier: MIT
#include "ardour_host.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"

#include "plugin_sound.h"
#include "support/jack_server.h"

namespace knotwave::support {
namespace {

const char* const kFormat = R"(<?xml version="1.0" encoding="UTF-8"?>
<ExportFormatSpecification name="Floats" id="6b6e6f74-7761-7665-0000-000000000001" with-cue="0" with-toc="0">
<Encoding id="F_WAV" type="T_Sndfile" extension="wav" name="WAV" has-sample-format="1" channel-limit="256"/>
<SampleRate rate="1"/><SRCQuality quality="SRC_SincBest"/>
<EncodingOptions><Option name="sample-format" value="SF_Float"/><Option name="dithering" value="D_None"/>
<Option name="tag-metadata" value="0"/><Option name="tag-support" value="0"/>
<Option name="broadcast-info" value="0"/></EncodingOptions>
<Processing><Normalize enabled="0" loudness="no" dbfs="0" lufs="-23" dbtp="-1"/>
<Silence><Start><Trim enabled="0"/><Add enabled="0"><Duration format="Timecode" hours="0" minutes="0" seconds="0" frames="0"/></Add></Start>
<End><Trim enabled="0"/><Add enabled="0"><Duration format="Timecode" hours="0" minutes="0" seconds="0" frames="0"/></Add></End></Silence>
</Processing></ExportFormatSpecification>
)";
const char* const kPreset = R"(<?xml version="1.0" encoding="UTF-8"?>
<ExportPreset id="6b6e6f74-7761-7665-0000-000000000002" name="Floats">
<ExportFormat id="6b6e6f74-7761-7665-0000-000000000001"/>
<ExportFilename><Folder relative="1" path="export"/><Field name="label" enabled="0"/>
<Field name="session" enabled="0"/><Field name="snapshot" enabled="0"/><Field name="timespan" enabled="1"/>
<Field name="revision" enabled="0"/><Field name="time" enabled="0" value="T_None"/>
<Field name="date" enabled="0" value="D_None"/></ExportFilename></ExportPreset>
)";

/// A plugin in Ardour's Lua that plays plugin_notes().
std::string notes_plugin() {
  std::string notes;
  for (const auto& note : plugin_notes()) {
    notes += "{" + std::to_string(note.after) + ", {";
    for (const int byte : note.bytes) notes += std::to_string(byte) + ", ";
    notes += "}}, ";
  }
  return R"(ardour { ["type"] = "dsp", name = "Notes", category = "Utility", license = "MIT",
  author = "Knotwave", description = [[Notes at samples of the song]] }
local notes = {)" +
         notes + R"(}
function dsp_ioconfig() return {{midi_in = 1, midi_out = 1, audio_in = 0, audio_out = 0}} end
function dsp_run(_, _, count)
  if not Session:transport_rolling() then return end
  local now, i = Session:transport_sample(), 1
  for _, note in ipairs(notes) do
    local at = note[1] + )" +
         std::to_string(kFramesBefore) + R"( - now
    if at >= 0 and at < count then midiout[i] = {time = at + 1, data = note[2]} i = i + 1 end
  end
end
)";
}

/// Ardour sets and saves on threads of its own.
const char* const kWait = "ARDOUR.LuaAPI.usleep(1000000)\n";

/// `name` is that of the client; with one the dummy exports silence.
std::string on_engine(const std::string& backend, const std::string& name) {
  return "AudioEngine:set_backend('" + backend + "', '" + name +
         "', '')\nAudioEngine:start(false)\n";
}

/// For 30 s at most.
void wait_while(const std::function<bool()>& is_so) {
  for (int i = 0; i < 600 && is_so(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

Ardour::Ardour() : home_("HOME", folder_.path()) {
  const std::string modules = folder_.file("vst3");
  std::filesystem::create_directories(modules);
  std::filesystem::copy(KNOTWAVE_BIN_DIR "/../plugins/vst3/knotwave.vst3",
                        modules + "/knotwave.vst3", std::filesystem::copy_options::recursive);
  // What is not older than the scanner's notes on it, Ardour 7.3 stumbles over.
  for (const auto& entry : std::filesystem::recursive_directory_iterator(modules)) {
    std::filesystem::last_write_time(
        entry, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  }
  write_configuration();
}

void Ardour::write_configuration() const {
  const std::string config = folder_.file(".config/ardour7");
  std::filesystem::create_directories(config + "/scripts");
  std::filesystem::create_directories(config + "/export");
  EXPECT_TRUE(base::write_file(config + "/export/floats.format", kFormat));
  EXPECT_TRUE(base::write_file(config + "/export/floats.preset", kPreset));
  EXPECT_TRUE(base::write_file(config + "/scripts/notes.lua", notes_plugin()));
  EXPECT_TRUE(
      base::write_file(config + "/config",
                       "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Ardour><Config>\n<Option "
                       "name=\"port-resampler-quality\" value=\"0\"/>\n<Option name=\"use-vst3\" "
                       "value=\"1\"/>\n<Option name=\"plugin-path-vst3\" value=\"" +
                           folder_.file("vst3") + "\"/>\n</Config></Ardour>\n"));
}

ProgramRun Ardour::scan() const {
  return run_program(
      {"/bin/sh", "-c",
       "LD_LIBRARY_PATH=/usr/lib/ardour7 exec /usr/lib/ardour7/ardour-vst3-scanner -f -v " +
           folder_.file("vst3/knotwave.vst3")});
}

std::string Ardour::log() const {
  const auto text = base::read_file(folder_.file("ardour.log"), 16 << 20);
  return text ? *text : "";
}

bool Ardour::run(const std::string& script, const std::vector<std::string>& fresh) {
  const std::string path = folder_.file("session.lua");
  EXPECT_TRUE(base::write_file(path, on_engine("None (Dummy)", "") + script + "print('done')\n"));
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    for (const std::string& made : fresh) std::filesystem::remove_all(made);
    const ProgramRun ran =
        run_program({"/bin/sh", "-c", "exec ardour7-lua " + path + " 2>&1"}, {.timeout_s = 60});
    EXPECT_TRUE(base::write_file(folder_.file("ardour.log"), ran.out));
    if (ran.out.find("\ndone\n") != std::string::npos) return true;
    if (ran.exit_code <= 128) return false;  // no signal ended it: the script is wrong
  }
  return false;
}

bool Ardour::run_under_jack(const std::string& script, const std::vector<std::string>& fresh,
                            const std::function<void()>& then) {
  const std::string path = folder_.file("session.lua"), ready = folder_.file("ready");
  // Ardour ends by itself: JACK waits ten seconds for a client that was killed.
  EXPECT_TRUE(base::write_file(path, on_engine("JACK", "ardour") + script + "io.open('" + ready +
                                         "', 'w'):close()\nfor i = 1, 1200 do\n"
                                         "  local f = io.open('" +
                                         ready +
                                         "')\n  if not f then break end\n  f:close()\n"
                                         "  ARDOUR.LuaAPI.usleep(50000)\nend\n"));
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    for (const std::string& made : fresh) std::filesystem::remove_all(made);
    std::filesystem::remove(folder_.file("ardour.log"));
    JackServer server;
    if (!server.runs()) return false;
    BackgroundProgram program({"ardour7-lua", path}, folder_.file("ardour.log"));
    wait_while([&] { return program.runs() && !std::filesystem::exists(ready); });
    const bool is_well = program.runs() && log().find("JACK HALTED") == std::string::npos;
    if (is_well) then();
    std::filesystem::remove(ready);
    wait_while([&] { return program.runs(); });
    if (is_well) return true;
  }
  return false;
}

std::string Ardour::new_session(std::size_t parameter, double value) const {
  return "local s = create_session('" + session() + R"(', 'session', 48000)
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
         std::to_string(parameter) + ", " + std::to_string(value) + ")\n" + kWait +
         "s:save_state('')\n" + kWait;
}

std::string Ardour::old_session() const {
  return "local s = load_session('" + session() +
         "', 'session')\nlocal t = s:route_by_name('synth')\n" + kWait;
}

std::string Ardour::print_value(std::size_t parameter) {
  return "print('value is ' .. ARDOUR.LuaAPI.get_processor_param(t:nth_plugin(0), " +
         std::to_string(parameter) + "))\nio.flush()\n";
}

std::string Ardour::notes_in_song() {
  return "t:monitoring_control():set_value(0, PBD.GroupControlDisposition.NoGroup)\n"
         "t:add_processor_by_index(ARDOUR.LuaAPI.new_luaproc(s, 'Notes'), 0, nil, true)\n";
}

std::string Ardour::export_song(const std::string& name) const {
  return "local e = s:simple_export()\ne:set_folder('" + folder_.path() + "')\ne:set_name('" +
         name + "')\ne:set_range(" + std::to_string(kFramesBefore) + ", " +
         std::to_string(kFramesBefore + kHeardFrames) +
         ")\nassert(e:set_preset('6b6e6f74-7761-7665-0000-000000000002'))\n"
         "assert(e:run_export())\n";
}

}  // namespace knotwave::support

// SPDX-License-Identifier: MIT
// The VST3 instrument in Ardour: what is heard and exported is what the engine gives for the same
// notes, and stays so when the session is opened again.
#include <algorithm>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/engine/journal.h"
#include "knotwave/io/sound_file.h"
#include "knotwave/plugins/instrument.h"

#include "ardour_host.h"
#include "plugin_sound.h"

namespace knotwave {
namespace {

using support::Ardour;

/// Ardour counts from 0 what is not hidden.
std::size_t pan() { return plugins::Instrument::table().of_word("pan"); }
constexpr double kPan = 0.125;

TEST(PluginHosts, ArdoursScannerTakesTheModule) {
  const Ardour ardour;
  const auto scanned = ardour.scan();
  EXPECT_EQ(scanned.exit_code, 0) << scanned.err;
  EXPECT_NE((scanned.out + scanned.err).find("Found Plugin: Knotwave"), std::string::npos)
      << scanned.out << scanned.err;
}

void expect_live_sound() {
  support::expect_heard("ardour:synth/midi_in 1", "ardour:synth/audio_out 1",
                        "ardour:synth/audio_out 2", support::rendered(kPan));
}

TEST(PluginHosts, ArdourGivesTheVerySamplesOfTheEngineAlsoInASessionOpenedAgain) {
  Ardour ardour;
  ASSERT_EQ(ardour.scan().exit_code, 0);
  ASSERT_TRUE(
      ardour.run_under_jack(ardour.new_session(pan(), kPan), {ardour.session()}, expect_live_sound))
      << ardour.log();
  ASSERT_TRUE(ardour.run_under_jack(ardour.old_session() + Ardour::print_value(pan()), {},
                                    expect_live_sound))
      << ardour.log();
  EXPECT_NE(ardour.log().find("value is 0.125"), std::string::npos) << ardour.log();
}

/// The sound of knotwave-render for the same notes, from where they begin.
std::vector<float> rendered_by_program() {
  const support::ScratchFolder folder;
  plugins::Instrument instrument;
  instrument.set_parameter(pan(), kPan);
  engine::Journal journal = *engine::read_journal(instrument.state(), "state");
  journal.rate_hz = 48000;
  journal.end = static_cast<std::int64_t>(support::kFramesBefore + support::kHeardFrames);
  for (const auto& note : support::plugin_notes()) {
    engine::JournalRecord record;
    record.time.sample = static_cast<std::int64_t>(support::kFramesBefore) + note.after;
    std::copy(note.bytes.begin(), note.bytes.end(), record.bytes);
    journal.records.push_back(record);
  }
  EXPECT_TRUE(base::write_file(folder.file("take.journal"), engine::write_journal(journal)));
  const auto run =
      support::run_program({"knotwave-render", "--journal", folder.file("take.journal"), "--bits",
                            "32f", "-o", folder.file("take.wav")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto sound = io::read_sound(folder.file("take.wav"));
  if (!sound) return {};
  const auto first = static_cast<std::ptrdiff_t>(2 * support::kFramesBefore);
  return {sound->samples.begin() + first, sound->samples.end()};
}

std::vector<float> samples_of(const std::string& path) {
  const auto sound = io::read_sound(path);
  EXPECT_TRUE(sound) << path;
  return sound ? sound->samples : std::vector<float>();
}

/// The plugin's own state in a session, as Ardour writes it.
std::string chunk_of(const std::string& session) {
  const auto text = base::read_file(session, 64 << 20);
  if (!text) return "";
  const std::size_t begin = text->find("<chunk>"), end = text->find("</chunk>");
  return end == std::string::npos ? "" : text->substr(begin, end - begin);
}

TEST(PluginHosts, AnExportOfArdourIsKnotwaveRenderToTheBitAlsoOfASessionOpenedAgain) {
  Ardour ardour;
  ASSERT_EQ(ardour.scan().exit_code, 0);
  const std::string session = ardour.session() + "/session.ardour";
  ASSERT_TRUE(ardour.run(
      ardour.new_session(pan(), kPan) + Ardour::notes_in_song() + ardour.export_song("first"),
      {ardour.session(), ardour.exported("first")}))
      << ardour.log();
  const std::vector<float> expected = rendered_by_program();
  ASSERT_EQ(expected.size(), 2 * support::kHeardFrames);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.01F);
  EXPECT_TRUE(samples_of(ardour.exported("first")) == expected);

  ASSERT_TRUE(ardour.run(ardour.old_session() + Ardour::notes_in_song() +
                             ardour.export_song("second") + "s:save_state('again')\n",
                         {ardour.exported("second")}))
      << ardour.log();
  EXPECT_TRUE(samples_of(ardour.exported("second")) == expected);
  ASSERT_NE(chunk_of(session), "");
  EXPECT_EQ(chunk_of(ardour.session() + "/again.ardour"), chunk_of(session));
}

}  // namespace
}  // namespace knotwave

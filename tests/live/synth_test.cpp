// SPDX-License-Identifier: MIT
// knotwave-synth as a player and as a service meet it: under a real JACK server, at a terminal,
// and without either.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lo/lo.h>
#include <termios.h>
#include <unistd.h>

#include "knotwave/base/file.h"
#include "knotwave/engine/journal.h"
#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_file.h"
#include "knotwave/io/sound_file.h"

#include "live/synth_scene.h"

namespace knotwave::synth {
namespace {

using testing::HasSubstr;
using testing::Not;

/// That the take renders again to the samples that were heard.
class SynthTake : public SynthProgram {
 protected:
  void expect_rendered_again(const std::string& take, const std::string& told) {
    support::ProgramOptions options;
    options.folder = folder_.path();
    const auto done = support::run_program(
        {"knotwave-render", "--journal", take + ".journal", "-o", "again.wav"}, options);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    ASSERT_EQ(render::hash_in(told).size(), 64u) << told;
    EXPECT_EQ(render::hash_in(done.out), render::hash_in(told)) << done.out << told;
  }
};

/// The same under a server.
class SynthUnderJack : public SynthTake {
 protected:
  void SetUp() override { ASSERT_TRUE(server_.runs()) << server_.log(); }

  JackServer server_{256};
};

std::vector<float> channel_of(const io::Sound& sound, std::size_t channel) {
  std::vector<float> samples;
  for (std::size_t i = channel; i < sound.samples.size(); i += 2) {
    samples.push_back(sound.samples[i]);
  }
  return samples;
}

TEST_F(SynthUnderJack, AScoreIsHeardSampleForSampleAndItsTakeRendersAgainToTheSameHash) {
  SynthProcess synth({"small.toml", "--json-status", "--record", "take.wav"}, here());
  ASSERT_TRUE(synth.says("recording take.wav")) << synth.err();
  JackCapture capture({kOut1, kOut2}, 5 * 48000);
  ASSERT_TRUE(capture.is_connected());
  std::vector<JackMidiSender::Message> score;
  for (int i = 0; i < 8; ++i) {
    const auto key = static_cast<std::uint8_t>(60 + 2 * i);
    score.push_back(at(6000 * i + 7 * i, {0x90, key, 100}));
    score.push_back(at(6000 * i + 3000 + 5 * i, {0x80, key, 0}));
  }
  JackMidiSender sender(kMidiIn, score);
  ASSERT_TRUE(sender.is_connected());
  ASSERT_TRUE(sender.wait_until_sent(20));
  ASSERT_TRUE(capture.wait_for(2 * 48000, 20));
  const std::vector<float> heard[2] = {capture.channel(0), capture.channel(1)};
  synth.signal(SIGINT);
  EXPECT_EQ(synth.exit_code(), 130) << synth.err();

  const auto take = io::read_sound(file("take.wav"));
  ASSERT_TRUE(take.has_value()) << take.error().to_string();
  for (std::size_t c = 0; c < 2; ++c) {
    const std::vector<float> recorded = channel_of(*take, c);
    const std::size_t in_take = onset(recorded), in_capture = onset(heard[c]);
    ASSERT_LT(in_capture, heard[c].size()) << "nothing was heard";
    const std::size_t count =
        std::min<std::size_t>(heard[c].size() - in_capture, recorded.size() - in_take);
    ASSERT_GT(count, 48000u);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(heard[c][in_capture + i], recorded[in_take + i]) << c << " " << i;
    }
  }
  expect_rendered_again("take", synth.err());
  const auto song = io::read_midi_file(file("take.mid"));
  ASSERT_TRUE(song.has_value()) << song.error().to_string();
  EXPECT_EQ(song->events.size(), score.size());
}

TEST_F(SynthUnderJack, KeyboardsOfJackAreConnectedByItselfAndHeardExactToTheSample) {
  SynthProcess synth({"small.toml", "--json-status", "--record", "take.wav"}, here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  std::vector<JackMidiSender::Message> score;
  for (int i = 0; i < 40; ++i) {
    score.push_back(at(1000 + 1237 * i, {0x90, 60, 100}));
    score.push_back(at(1000 + 1237 * i + 611, {0x80, 60, 0}));
  }
  for (int round = 0; round < 2; ++round) {
    JackMidiSender sender(kMidiIn, score, JackMidiSender::Connects::by_others);
    ASSERT_TRUE(sender.is_connected()) << synth.err();
    ASSERT_TRUE(synth.says("\"name\": \"sender:out\", \"open\": true"));
    seconds_until([&] { return synth.says("MIDI input 'sender:out' (jack) is open", 0); }, 10);
    ASSERT_TRUE(sender.wait_until_sent(20));
    seconds_until([&] { return synth.number("voices") == 0; }, 5);
  }
  ASSERT_TRUE(synth.says("'sender:out' was unplugged"));
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
  const auto song = io::read_midi_file(file("take.mid"));
  ASSERT_TRUE(song.has_value()) << song.error().to_string();
  // The first may have come before the listener of the MIDI ports was left out; each once, though.
  ASSERT_EQ(song->events.size(), 2 * score.size());
  for (std::size_t round = 0; round < 2; ++round) {
    const auto* events = &song->events[round * score.size()];
    for (std::size_t i = 1; i < score.size(); ++i) {
      EXPECT_EQ(static_cast<std::int64_t>(events[i].tick - events[0].tick),
                score[i].after - score[0].after);
    }
  }
}

TEST_F(SynthUnderJack, AClocksSongIsTakenUpAtTheFrameOfItsClock) {
  SynthProcess synth({"small.toml", "--json-status", "--record", "take.wav"}, here());
  ASSERT_TRUE(synth.says("recording take.wav")) << synth.err();
  std::vector<JackMidiSender::Message> score;
  const auto note = [&](std::int64_t frame) { score.push_back(at(frame, {0x90, 60, 100})); };
  for (std::int64_t clock = 0; clock < 96; ++clock) {  // 1000 frames each: 120 quarters a minute
    const std::int64_t frame = 1000 * clock;
    if (clock == 20) score.push_back(at(frame - 300, {0xFA}));
    if (clock == 50) score.push_back(at(frame - 300, {0xFC}));
    if (clock == 60) score.push_back(at(frame - 300, {0xFB}));
    if (clock == 70) score.push_back(at(frame - 300, {0xFC}));
    if (clock == 70) score.push_back(at(frame - 200, {0xF2, 16, 1}));
    if (clock == 80) score.push_back(at(frame - 300, {0xFB}));
    if (clock == 20 || clock == 60 || clock == 80) note(frame);
    score.push_back(at(frame, {0xF8}));
  }
  JackMidiSender sender(kMidiIn, score);
  ASSERT_TRUE(sender.is_connected());
  ASSERT_TRUE(sender.wait_until_sent(20));
  EXPECT_LT(seconds_until([&] { return synth.number("clock_bpm") > 0; }, 5), 5);
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
  expect_rendered_again("take", synth.err());

  const auto text = base::read_file(file("take.journal"), std::size_t{1} << 26);
  ASSERT_TRUE(text.has_value()) << text.error().to_string();
  const auto journal = engine::read_journal(*text, "take.journal");
  ASSERT_TRUE(journal.has_value()) << journal.error().to_string();
  std::vector<std::pair<std::int64_t, double>> notes_and_positions;
  std::int64_t note_sample = 0;
  for (const engine::JournalRecord& record : journal->records) {
    if (record.kind == engine::Event::Kind::midi) note_sample = record.time.sample;
    if (record.kind != engine::Event::Kind::position) continue;
    EXPECT_EQ(record.time.fraction, 0U);
    notes_and_positions.emplace_back(record.time.sample - note_sample, record.number);
  }
  EXPECT_THAT(notes_and_positions, testing::ElementsAre(testing::Pair(0, 0), testing::Pair(0, 30),
                                                        testing::Pair(0, 6 * (16 + 128))));
}

TEST_F(SynthUnderJack, OnlyTheInputsThatWereNamedAreConnected) {
  JackMidiSender first("", {}), second("", {});
  SynthProcess synth({"small.toml", "--json-status", "--midi-in", "sender-01"}, here());
  EXPECT_LT(seconds_until([&] { return second.is_connected_to(kMidiIn); }, 20), 20) << synth.err();
  EXPECT_FALSE(first.is_connected_to(kMidiIn));
  EXPECT_TRUE(synth.says("\"name\": \"sender-01:out\", \"open\": true")) << synth.err();
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
}

TEST_F(SynthUnderJack, AConnectionThatWasTakenAwayStaysAwayUntilItsSourceComesAgain) {
  auto first = std::make_unique<JackMidiSender>("", std::vector<JackMidiSender::Message>());
  SynthProcess synth({"small.toml", "--json-status"}, here());
  const auto is_connected = [&] { return first->is_connected_to(kMidiIn); };
  ASSERT_LT(seconds_until(is_connected, 20), 20) << synth.err();
  first->disconnect_from(kMidiIn);
  ASSERT_TRUE(synth.says("'sender:out' was unplugged")) << synth.err();
  for (int round = 0; round < 2; ++round) {  // ports of others come and go
    const JackMidiSender second("", {});
    ASSERT_LT(seconds_until([&] { return second.is_connected_to(kMidiIn); }, 20), 20);
    EXPECT_FALSE(is_connected());
  }
  first.reset();
  first = std::make_unique<JackMidiSender>("", std::vector<JackMidiSender::Message>());
  EXPECT_LT(seconds_until(is_connected, 20), 20) << synth.err();
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
}

TEST_F(SynthUnderJack, ASongIsPlayedAndRecordedToTheVerySamplesOfItsRender) {
  ASSERT_EQ(run({"small.toml", "small.mid", "-o", "render.wav", "--bits", "32f", "--tail", "1"})
                .exit_code,
            0);
  const auto render = io::read_sound(file("render.wav"));
  ASSERT_TRUE(render.has_value()) << render.error().to_string();
  const std::string seconds = std::to_string(static_cast<double>(render->frames) / 48000);
  for (const char* api : {"jack", "none"}) {
    const std::string take = std::string(api) + ".wav";
    SynthProcess synth({"small.toml", "--song", "small.mid", "--audio-api", api, "--record", take,
                        "--duration", seconds},
                       here());
    EXPECT_EQ(synth.exit_code(), 0) << synth.err();
    EXPECT_THAT(synth.err(), HasSubstr("the song is over: small.mid"));
    const auto heard = io::read_sound(file(take));
    ASSERT_TRUE(heard.has_value()) << heard.error().to_string();
    EXPECT_EQ(heard->frames, render->frames) << "as long as --duration says";
    EXPECT_EQ(heard->samples, render->samples) << api;
  }
  ASSERT_LT(onset(render->samples), 2000u);
}

TEST_F(SynthUnderJack, ASavedPatchIsHeardAndABrokenOneToldWhileTheOldOnePlaysOn) {
  SynthProcess synth({"small.toml", "--json-status", "--record", "take.wav"}, here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  JackMidiSender sender(kMidiIn, held_note());
  ASSERT_TRUE(sender.is_connected());
  seconds_until([&] { return synth.number("peak_left_dbfs") > -30; }, 20);
  const double loud_dbfs = synth.number("peak_left_dbfs");
  ASSERT_GT(loud_dbfs, -30) << synth.out();

  const std::string patch = render::kSmallPatch;
  write("small.toml", patch + "no_such_key = 1\n");
  ASSERT_TRUE(synth.says("small.toml:15:1: error: ")) << synth.err();
  EXPECT_TRUE(synth.says("the old sound plays on"));
  const double from = synth.number("seconds");
  seconds_until([&] { return synth.number("seconds") > from + 1.5; }, 20);
  EXPECT_NEAR(synth.number("peak_left_dbfs"), loud_dbfs, 0.1);

  std::string quiet = patch;
  quiet.insert(quiet.find("[curves"), "gain_db = -20\n");
  write("small.toml", quiet);
  ASSERT_TRUE(synth.says("now playing small.toml")) << synth.err();
  seconds_until([&] { return synth.number("peak_left_dbfs") < loud_dbfs - 19; }, 20);
  EXPECT_NEAR(synth.number("peak_left_dbfs"), loud_dbfs - 20, 0.2) << "of the same held note";
  synth.signal(SIGINT);
  EXPECT_EQ(synth.exit_code(), 130);
  write("small.toml", "the journal knows what was in it");
  expect_rendered_again("take", synth.err());
}

TEST_F(SynthUnderJack, AKnobIsLearntByMovingItAndKept) {
  write("mod.toml",
        std::string(render::kSmallPatch) + "[[maps]]\nfrom = \"mod\"\nto = \"pitch\"\n");
  SynthProcess synth({"mod.toml", "--midi-learn", "desk.toml"}, at_terminal());
  ASSERT_TRUE(synth.says("octave 4")) << synth.out();
  synth.type("m");
  ASSERT_TRUE(synth.says("move a knob: it will stand for the patch's controller 1"));
  JackMidiSender sender(
      kMidiIn, {at(0, {0xB0, 21, 10}), at(480, {0xB0, 21, 20}), at(48000, {0xB0, 21, 30})});
  ASSERT_TRUE(sender.is_connected());
  EXPECT_TRUE(synth.says("controller 21 stands for 1 now; kept in desk.toml")) << synth.out();
  EXPECT_TRUE(synth.says("controller 1: 30, channel 1")) << "what the engine hears";
  EXPECT_THAT(read("desk.toml"), HasSubstr("from = 21"));
  synth.type("q");
  EXPECT_EQ(synth.exit_code(), 0);
}

TEST_F(SynthUnderJack, CtrlCFadesOut) {
  SynthProcess synth({"small.toml", "--json-status"}, here());
  ASSERT_TRUE(synth.says("\"state\": \"running\"")) << synth.err();
  JackMidiSender sender(kMidiIn, held_note());
  ASSERT_TRUE(sender.wait_until_sent(10));
  seconds_until([&] { return synth.number("peak_left_dbfs") > -30; }, 20);
  JackCapture capture({kOut1}, 20 * 48000);
  // It captures before it is connected.
  seconds_until([&] { return onset(capture.channel(0)) + 9600 < capture.frames(); }, 10);
  synth.signal(SIGINT);
  EXPECT_EQ(synth.exit_code(), 130);
  const std::vector<float> heard = capture.channel(0);
  const auto last = std::find_if(heard.rbegin(), heard.rend(), [](float x) { return x != 0; });
  const auto end = static_cast<std::size_t>(heard.rend() - last);
  const auto peak = [&](std::size_t from, std::size_t to) {
    float most = 0;
    for (std::size_t i = from; i < to; ++i) most = std::max(most, std::abs(heard[i]));
    return most;
  };
  ASSERT_GT(end, 7200u);
  const float before = peak(end - 7200, end - 4800);
  EXPECT_GT(before, 0.05f);
  EXPECT_LT(peak(end - 100, end), 0.06f * before) << "the last 2 ms of 50";
  EXPECT_GT(peak(end - 2400, end - 1900), 0.5f * before) << "not cut before that";
}

TEST_F(SynthProgram, RunsHeadlessWithoutStandardInputAndEndsAsAServiceIsEnded) {
  SynthProcess::Options options = here();
  options.is_stdin_closed = true;
  SynthProcess synth({"small.toml", "--audio-api", "none", "--plain"}, options);
  ASSERT_TRUE(synth.says("running, small.toml")) << synth.err();
  synth.signal(SIGTERM);
  EXPECT_EQ(synth.exit_code(), 0);
  EXPECT_THAT(synth.out(), Not(HasSubstr("\x1b"))) << "no page where there is no terminal";
}

TEST_F(SynthProgram, EndsByItselfAfterItsDuration) {
  SynthProcess synth({"small.toml", "--audio-api", "none", "--duration", "0.3"}, here());
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
}

TEST_F(SynthProgram, WithoutADeviceSaysWhatToDoAndRecordsAllTheSame) {
  support::NoJackServer none;
  SynthProcess refused({"small.toml"}, here());
  EXPECT_EQ(refused.exit_code(), 1);
  EXPECT_THAT(refused.err(), HasSubstr("no sound device"));
  EXPECT_THAT(refused.err(), HasSubstr("--record FILE"));
  SynthProcess synth({"small.toml", "--record", "a.wav", "--duration", "0.3"}, here());
  EXPECT_EQ(synth.exit_code(), 0) << synth.err();
  EXPECT_THAT(synth.err(), HasSubstr("playing without a device"));
  EXPECT_THAT(synth.err(), testing::Not(HasSubstr("--record"))) << "it is given";
  EXPECT_GT(io::read_sound(file("a.wav"))->frames, 4800);
}

TEST_F(SynthProgram, PlaysWhatOscSaysAndTellsWhatItDoesNotUnderstandOnce) {
  SynthProcess synth({"small.toml", "--audio-api", "none", "--json-status", "--osc", osc_port()},
                     here());
  ASSERT_TRUE(synth.says("\"osc\": \"127.0.0.1:" + osc_port() + "\"")) << synth.err();
  lo_address to = lo_address_new("127.0.0.1", osc_port().c_str());
  lo_send(to, "/note", "ii", 69, 127);
  seconds_until([&] { return synth.number("voices") == 1; }, 20);
  EXPECT_EQ(synth.number("voices"), 1);
  EXPECT_EQ(synth.field("last_midi"), "note on A4 (69), velocity 127, channel 1");
  seconds_until([&] { return synth.number("peak_left_dbfs") > -30; }, 20);
  const double loud_dbfs = synth.number("peak_left_dbfs");
  lo_send(to, "/target/amp", "f", -20.f);
  seconds_until([&] { return synth.number("peak_left_dbfs") < loud_dbfs - 19; }, 20);
  EXPECT_NEAR(synth.number("peak_left_dbfs"), loud_dbfs - 20, 0.2);
  lo_send(to, "/target/amb", "f", -20.f);
  EXPECT_TRUE(synth.says("OSC /target/amb: ")) << synth.err();
  for (int i = 0; i < 3; ++i) lo_send(to, "/nota", "");
  ASSERT_TRUE(synth.says("OSC /nota means nothing here; did you mean '/note'?"));
  write("other.toml", render::kSmallPatch);
  lo_send(to, "/patch", "s", "other.toml");
  ASSERT_TRUE(synth.says("now playing other.toml"));
  lo_send(to, "/panic", "");
  seconds_until([&] { return synth.number("voices") == 0; }, 20);
  EXPECT_EQ(synth.number("voices"), 0);
  const std::string told = synth.err();
  EXPECT_EQ(told.find("OSC /nota"), told.rfind("OSC /nota")) << told;
  lo_address_free(to);

  SynthProcess second({"small.toml", "--audio-api", "none", "--osc", osc_port()}, here());
  EXPECT_EQ(second.exit_code(), 1);
  EXPECT_THAT(second.err(), HasSubstr("OSC at 127.0.0.1:" + osc_port() + ": the port is in use"));
}

TEST_F(SynthProgram, KeysOfATerminalPlayAndTheTerminalIsPutBack) {
  write("z.toml", render::kSmallPatch);
  SynthProcess synth({"small.toml", "--audio-api", "none"}, at_terminal());
  termios during{}, after{};
  ASSERT_TRUE(synth.says("octave 4")) << synth.out();
  tcgetattr(synth.terminal(), &during);
  EXPECT_EQ(during.c_lflag & static_cast<tcflag_t>(ICANON | ECHO), 0u);
  synth.type("h");
  EXPECT_TRUE(synth.says("note on A4 (69), velocity 96"));
  EXPECT_TRUE(synth.says("note off A4 (69)")) << "by itself, as terminals tell no key-ups";
  synth.type("+h");
  EXPECT_TRUE(synth.says("note on A5 (81), velocity 96"));
  synth.type("\t");
  EXPECT_TRUE(synth.says("now playing z.toml")) << synth.out();
  synth.type("r");
  EXPECT_TRUE(synth.says("recording take.wav"));
  synth.type("r");
  EXPECT_TRUE(synth.says("take.wav: 0:0"));
  EXPECT_TRUE(std::filesystem::exists(file("take.wav")));
  synth.type("?");
  EXPECT_TRUE(synth.says("letters are white keys"));
  synth.type("q");
  EXPECT_EQ(synth.exit_code(), 0);
  tcgetattr(synth.terminal(), &after);
  EXPECT_EQ(after.c_lflag & static_cast<tcflag_t>(ICANON | ECHO),
            static_cast<tcflag_t>(ICANON | ECHO));
  EXPECT_TRUE(synth.says("\x1b[?25h")) << "the cursor is shown again";
  EXPECT_TRUE(synth.says("\x1b[?1049l"));
}

TEST_F(SynthProgram, TheTerminalIsPutBackWhenASignalKillsIt) {
  for (const int signal : {SIGTERM, SIGQUIT, SIGABRT}) {
    SynthProcess synth({"small.toml", "--audio-api", "none"}, at_terminal());
    ASSERT_TRUE(synth.says("octave 4"));
    synth.signal(signal);
    EXPECT_EQ(synth.exit_code(), signal == SIGTERM ? 0 : 128 + signal);
    termios after{};
    tcgetattr(synth.terminal(), &after);
    EXPECT_NE(after.c_lflag & static_cast<tcflag_t>(ECHO), 0u) << signal;
    EXPECT_TRUE(synth.says("\x1b[?1049l")) << signal;
  }
}

}  // namespace
}  // namespace knotwave::synth

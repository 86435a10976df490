// SPDX-License-Identifier: MIT
// The CLAP plugin as a host has it.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/base/sha256.h"
#include "knotwave/engine/journal.h"
#include "knotwave/plugins/instrument.h"

#include "clap_host.h"
#include "support/program.h"

namespace knotwave::test {
namespace {

constexpr const char* kPath = KNOTWAVE_BIN_DIR "/../plugins/clap/knotwave.clap";
constexpr const char* kId = "org.knotwave.instrument";

const ClapLibrary& library() {
  static const ClapLibrary opened(kPath);
  return opened;
}
std::unique_ptr<ClapPlugin> plugin() {
  return std::make_unique<ClapPlugin>(library().factory(), kId);
}

clap_id id_of(std::string_view word) {
  return plugins::Instrument::table()[plugins::Instrument::table().of_word(word)].id;
}

/// A chord, a pedal, a bend, a parameter that moves, then all ends.
std::vector<ClapEvent> music() {
  std::vector<ClapEvent> events;
  for (const int key : {48, 60, 64, 67}) {
    events.push_back(
        clap_note(100u + static_cast<std::uint32_t>(key), CLAP_EVENT_NOTE_ON, 0, key, 100 / 127.0));
  }
  events.push_back(clap_midi(3000, 0xB0, 64, 127));
  events.push_back(clap_midi(4001, 0xE0, 0, 80));
  for (std::uint32_t i = 0; i < 64; ++i) {
    events.push_back(clap_value(5000 + 37 * i, id_of("cutoff"), -0.5 * i));
  }
  events.push_back(clap_note(9000, CLAP_EVENT_NOTE_OFF, 0, 64, 0.5));
  events.push_back(clap_note(9001, CLAP_EVENT_NOTE_ON, 3, 72, 1));
  events.push_back(clap_midi(12000, 0xB0, 64, 0));
  events.push_back(clap_note(20000, CLAP_EVENT_NOTE_OFF, -1, -1, 0));
  return events;
}

/// The same as a journal: the plugin's own state, and what happened then.
engine::Journal journal_of(const std::vector<ClapEvent>& events, const std::string& state,
                           double rate_hz, std::size_t frames) {
  engine::Journal journal = *engine::read_journal(state, "state");
  journal.rate_hz = rate_hz;
  journal.end = static_cast<std::int64_t>(frames);
  for (const ClapEvent& event : events) {
    engine::JournalRecord record;
    record.time.sample = event.header.time;
    const auto add = [&](int status, int one, int two) {
      record.bytes[0] = static_cast<std::uint8_t>(status);
      record.bytes[1] = static_cast<std::uint8_t>(one);
      record.bytes[2] = static_cast<std::uint8_t>(two);
      journal.records.push_back(record);
    };
    const auto& note = event.note;
    const int velocity = static_cast<int>(std::lround(note.velocity * 127));
    if (event.header.type == CLAP_EVENT_MIDI) {
      add(event.midi.data[0], event.midi.data[1], event.midi.data[2]);
    } else if (event.header.type == CLAP_EVENT_NOTE_ON) {
      add(0x90 | note.channel, note.key, velocity);
    } else if (event.header.type == CLAP_EVENT_NOTE_OFF && note.key >= 0) {
      add(0x80 | note.channel, note.key, velocity);
    } else if (event.header.type == CLAP_EVENT_NOTE_OFF) {
      for (int channel = 0; channel < 16; ++channel) add(0xB0 | channel, 123, 0);
    } else {
      record.kind = engine::Event::Kind::set_target;
      record.every_channel = true;
      const auto& all = plugins::Instrument::table();
      record.index = static_cast<std::uint32_t>(
          all[plugins::Instrument::table().of_id(event.value.param_id)].slot);
      record.number = event.value.value;
      journal.records.push_back(record);
    }
  }
  return journal;
}

const StereoSound kSilence{std::vector<float>(512), std::vector<float>(512)};

std::string hash_of(const StereoSound& sound) {
  base::Sha256 hash;
  for (std::size_t i = 0; i < sound.left.size(); ++i) {
    const float frame[] = {sound.left[i], sound.right[i]};
    hash.update(std::span<const float>(frame));
  }
  return hash.finish_hex();
}

TEST(Clap, SoundsAsKnotwaveRenderOfTheSameEventsToTheBit) {
  constexpr std::size_t kFrames = 48000;
  for (const double rate_hz : {44100.0, 48000.0, 96000.0}) {
    const auto played = plugin();
    ASSERT_TRUE(played->start(rate_hz, 512));
    const StereoSound sound = played->play(music(), kFrames, 480);
    EXPECT_GT(*std::ranges::max_element(sound.left), 0.01F);
    const support::ScratchFolder folder;
    engine::Journal journal = journal_of(music(), played->save(), rate_hz, kFrames);
    // What the state says of the parameters is what they came to in the end.
    std::erase_if(journal.records, [](const engine::JournalRecord& record) {
      return record.kind == engine::Event::Kind::set_target && record.time.sample == 0;
    });
    journal.sha256 = hash_of(sound);
    ASSERT_TRUE(base::write_file(folder.file("take.journal"), engine::write_journal(journal)));
    const auto run =
        support::run_program({"knotwave-render", "--journal", folder.file("take.journal"), "-o",
                              folder.file("take.wav")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find(journal.sha256), std::string::npos) << run.out << journal.sha256;
  }
}

std::string song_patch() {
  return R"(format = 1
kind = "patch"
name = "wobble"
[curves.gate]
degree = 1
points = [1, 1]
[curves.wave]
degree = 2
periodic = true
points = [0, 1, 0, -1]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
[lfos.slow]
curve = "wave"
beats = 1
mode = "free"
[[maps]]
from = "slow"
to = "pitch"
depth = 3
)";
}

clap_event_transport transport(double bpm, double quarters, bool is_playing) {
  clap_event_transport told{};
  told.header = {sizeof told, 0, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_TRANSPORT, 0};
  told.flags = CLAP_TRANSPORT_HAS_TEMPO | CLAP_TRANSPORT_HAS_BEATS_TIMELINE |
               (is_playing ? std::uint32_t{CLAP_TRANSPORT_IS_PLAYING} : 0u);
  told.tempo = bpm;
  told.song_pos_beats = static_cast<clap_beattime>(std::llround(quarters * CLAP_BEATTIME_FACTOR));
  return told;
}

TEST(Clap, TheHostsTempoAndPlaceInTheSongMoveWhatCountsBeats) {
  constexpr std::size_t kBlock = 480, kBlocks = 100;
  engine::Journal journal;
  journal.banks.push_back({"wobble.toml", {{"wobble.toml", song_patch()}}, {}});
  const auto played = plugin();
  ASSERT_TRUE(played->load(engine::write_journal(journal)));
  ASSERT_TRUE(played->start(48000, kBlock));
  StereoSound all, part;
  const double quarters_a_block = kBlock / 48000.0 * 150 / 60;
  for (std::size_t i = 0; i < kBlocks; ++i) {  // begins to play in block 10 and goes back in 50
    const double at = i < 50 ? 2.51 + (static_cast<double>(i) - 10) * quarters_a_block
                             : 0.25 + (static_cast<double>(i) - 50) * quarters_a_block;
    const clap_event_transport now = transport(150, i < 10 ? 2.51 : at, i >= 10);
    std::vector<ClapEvent> events;
    if (i == 3) events.push_back(clap_note(7, CLAP_EVENT_NOTE_ON, 0, 60, 1));
    ASSERT_NE(played->process(events, kBlock, part, &now), CLAP_PROCESS_ERROR);
    all.left.insert(all.left.end(), part.left.begin(), part.left.end());
    all.right.insert(all.right.end(), part.right.begin(), part.right.end());
  }
  const auto add = [&](engine::Event::Kind kind, double sample) -> engine::JournalRecord& {
    engine::JournalRecord& record = journal.records.emplace_back();
    record.kind = kind;
    record.time.sample = static_cast<std::int64_t>(sample);
    record.time.fraction = static_cast<std::uint32_t>((sample - std::floor(sample)) * 4294967296.0);
    return record;
  };
  add(engine::Event::Kind::tempo, 0).number = 400000;
  engine::JournalRecord& note = add(engine::Event::Kind::midi, 3 * kBlock + 7);
  note.bytes[0] = 0x90;
  note.bytes[1] = 60;
  note.bytes[2] = 127;
  // 61 / 24 is the first clock at or after 2.51, and so is 6 / 24 of 0.25.
  const double rounded = std::llround(2.51 * 0x1p31) * 0x1p-31;
  add(engine::Event::Kind::position, 10 * kBlock + (61 / 24.0 - rounded) * 19200).number = 61;
  add(engine::Event::Kind::position, 50 * kBlock).number = 6;
  journal.end = kBlock * kBlocks;
  journal.sha256 = hash_of(all);
  const support::ScratchFolder folder;
  ASSERT_TRUE(base::write_file(folder.file("song.journal"), engine::write_journal(journal)));
  const auto run = support::run_program(
      {"knotwave-render", "--journal", folder.file("song.journal"), "-o", folder.file("song.wav")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find(journal.sha256), std::string::npos) << run.out << journal.sha256;
}

TEST(Clap, BlocksOfAnySizeGiveTheSameSamples) {
  constexpr std::size_t kFrames = 24000;
  const auto sound = [](std::size_t block) {
    const auto played = plugin();
    EXPECT_TRUE(played->start(48000, 16384));
    return played->play(music(), kFrames, block);
  };
  const StereoSound whole = sound(kFrames);
  for (const std::size_t block : {1u, 10u, 17u, 256u, 1536u, 2027u, 16384u}) {
    EXPECT_TRUE(sound(block) == whole) << block;
  }
}

TEST(Clap, ManyEventsAtOneSampleAreAllPlayed) {
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  std::vector<ClapEvent> events;
  events.reserve(5002);
  for (int i = 0; i < 5000; ++i) events.push_back(clap_value(0, id_of("pan"), 0.001 * (i % 900)));
  events.push_back(clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, 1));
  events.push_back(clap_note(0, CLAP_EVENT_NOTE_OFF, 0, 60, 1));
  StereoSound sound;
  played->process(events, 512, sound);
  double value = 0;
  const auto* params = played->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  ASSERT_TRUE(params->get_value(played->get(), id_of("pan"), &value));
  EXPECT_EQ(value, 0.001 * (4999 % 900));
  for (int i = 0; i < 1000; ++i) played->process({}, 512, sound);
  EXPECT_EQ(sound, kSilence) << "a note hangs";
}

TEST(Clap, AStateComesBackWholeAlsoInPiecesOf17Bytes) {
  const auto one = plugin();
  const auto* params = one->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  ASSERT_TRUE(one->start(48000, 512));
  one->play({clap_value(0, id_of("cutoff"), -12.345), clap_value(9, id_of("free.3"), 0.1)}, 64, 64);
  const std::string state = one->save();
  EXPECT_EQ(state, one->save(17));
  const auto two = plugin();
  ASSERT_TRUE(two->load(state, 17));
  EXPECT_EQ(two->calls().rescans, 1);
  EXPECT_EQ(two->save(), state);
  double value = 0;
  ASSERT_TRUE(params->get_value(two->get(), id_of("cutoff"), &value));
  EXPECT_EQ(value, -12.345);
  ASSERT_TRUE(two->start(48000, 512));
  const auto three = plugin();
  ASSERT_TRUE(three->start(48000, 512));
  ASSERT_TRUE(three->load(state));  // while it is active
  const std::vector<ClapEvent> notes = {clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, 1)};
  EXPECT_EQ(two->play(notes, 4800, 480), three->play(notes, 4800, 480));
}

// States of sessions load for ever: files are added, none changes.
TEST(Clap, EveryStateThatWasEverWrittenIsRead) {
  const auto text =
      base::read_file(KNOTWAVE_SOURCE_DIR "/tests/plugins/states/version_0_1_0.journal", 1 << 20);
  ASSERT_TRUE(text) << text.error().message;
  const auto played = plugin();
  ASSERT_TRUE(played->load(*text));
  EXPECT_EQ(played->save(), *text);
  double value = 0;
  played->extension<clap_plugin_params>(CLAP_EXT_PARAMS)
      ->get_value(played->get(), id_of("moved.32"), &value);
  EXPECT_EQ(value, 0.5);
}

TEST(Clap, ADamagedStateIsRefusedAndNothingChanges) {
  const auto played = plugin();
  const std::string state = played->save();
  std::vector<std::string> broken = {"", "x", std::string(1 << 20, '\0'), state + "x",
                                     state.substr(0, state.size() / 2)};
  for (const char* line : {"1 target every amp 3\n", "0 midi 90 3c 64\n", "0 target 1 amp 3\n",
                           "0 target every noise.pitch 3\n"}) {
    std::string added = state;
    broken.push_back(added.insert(added.rfind("end\n"), line));
  }
  for (const std::string& text : broken) {
    EXPECT_FALSE(played->load(text)) << text.substr(0, 40);
    EXPECT_EQ(played->save(), state);
  }
}

TEST(Clap, EveryParameterIsToldAndReadBack) {
  const auto played = plugin();
  const auto* params = played->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  ASSERT_EQ(params->count(played->get()), plugins::Instrument::table().size());
  for (std::uint32_t i = 0; i < params->count(played->get()); ++i) {
    clap_param_info info{};
    ASSERT_TRUE(params->get_info(played->get(), i, &info));
    for (const double part : {0.0, 0.25, 0.5, 0.77, 1.0}) {
      const double value = info.min_value + part * (info.max_value - info.min_value);
      char text[64] = {};
      double read = 0;
      ASSERT_TRUE(params->value_to_text(played->get(), info.id, value, text, sizeof text));
      ASSERT_TRUE(params->text_to_value(played->get(), info.id, text, &read)) << text;
      EXPECT_NEAR(read, value, 0.0005 + 1e-9) << text;
    }
  }
  clap_param_info info{};
  double value = 0;
  EXPECT_FALSE(params->get_info(played->get(), 1000, &info));
  EXPECT_FALSE(params->get_value(played->get(), 12345, &value));
  EXPECT_FALSE(params->text_to_value(played->get(), id_of("amp"), "loud", &value));
}

TEST(Clap, WhatIsNotActiveIsNotPlayed) {
  const auto played = plugin();
  StereoSound sound;
  EXPECT_EQ(played->process({}, 512, sound), CLAP_PROCESS_ERROR);
}

TEST(Clap, ResetEndsEveryNoteAndKeepsParameters) {
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  StereoSound sound;
  played->process({clap_value(0, id_of("pan"), -1), clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, 1)},
                  512, sound);
  played->get()->reset(played->get());
  EXPECT_EQ(played->process({}, 512, sound), CLAP_PROCESS_CONTINUE) << "its noise and LFOs go on";
  EXPECT_EQ(sound, kSilence);
  double value = 0;
  played->extension<clap_plugin_params>(CLAP_EXT_PARAMS)
      ->get_value(played->get(), id_of("pan"), &value);
  EXPECT_EQ(value, -1);
}

TEST(Clap, ANoteHeldWhileThePatchOrTheRateChangesEndsAsItShould) {
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  engine::Journal other;
  other.banks.push_back({"wobble.toml", {{"wobble.toml", song_patch()}}, {}});
  StereoSound out;
  const auto run = [&](const std::vector<ClapEvent>& events) {
    EXPECT_NE(played->process(events, 512, out), CLAP_PROCESS_ERROR);
    for (const float sample : out.left) EXPECT_TRUE(std::isfinite(sample));
    return *std::ranges::max_element(out.left);
  };
  run({clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, 1)});
  ASSERT_TRUE(played->load(engine::write_journal(other)));
  for (int i = 0; i < 20; ++i) EXPECT_GT(run({}), 0.001F) << i;
  run({clap_note(0, CLAP_EVENT_NOTE_OFF, 0, 60, 0)});
  for (int i = 0; i < 200; ++i) run({});
  run({});
  EXPECT_EQ(out, kSilence);
  // A new rate begins in silence: the host has let go of its notes.
  run({clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, 1)});
  ASSERT_TRUE(played->start(96000, 512));
  EXPECT_EQ(run({}), 0.0F);
  EXPECT_EQ(run({clap_note(0, CLAP_EVENT_NOTE_OFF, 0, 60, 0)}), 0.0F);
}

TEST(Clap, RatesFrom8000To768000AndOddOnes) {
  for (const double rate_hz : {8000.0, 11025.0, 1234.5678 * 10, 192000.0, 768000.0}) {
    const auto played = plugin();
    ASSERT_TRUE(played->start(rate_hz, 512)) << rate_hz;
    const StereoSound sound = played->play(music(), 24000, 512);
    for (const float x : sound.left) ASSERT_TRUE(std::isfinite(x) && std::abs(x) < 4);
  }
  const auto played = plugin();
  EXPECT_FALSE(played->start(1234.5678, 512));
  EXPECT_TRUE(played->start(48000, 512));
}

TEST(Clap, ShowsNothingButItsEntry) {
  const auto run = support::run_program({"/usr/bin/nm", "-D", "--defined-only", kPath});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(run.out.ends_with(" clap_entry\n")) << run.out;
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1) << run.out;
}

TEST(Clap, RandomEventsOfAnyKindLeaveNoNoteAndNoNan) {
  const auto played = plugin();
  ASSERT_TRUE(played->start(48000, 512));
  std::uint64_t state = 12345;
  const auto draw = [&](std::uint64_t below) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (state >> 33) % below;
  };
  StereoSound sound;
  for (int block = 0; block < 200; ++block) {
    std::vector<ClapEvent> events;
    for (std::uint32_t time = 0; time < 512; time += static_cast<std::uint32_t>(draw(40))) {
      ClapEvent event{};
      for (std::size_t i = 0; i < sizeof event; ++i) {
        reinterpret_cast<unsigned char*>(&event)[i] = static_cast<unsigned char>(draw(256));
      }
      event.header.time = time;
      event.header.size = draw(4) == 0 ? sizeof(clap_event_header) : sizeof(ClapEvent);
      event.header.space_id = static_cast<std::uint16_t>(draw(8) == 0);
      event.header.type = static_cast<std::uint16_t>(draw(12));
      if (event.header.type == CLAP_EVENT_PARAM_VALUE && draw(2) == 0) {
        event.value.param_id =
            plugins::Instrument::table()[draw(plugins::Instrument::table().size())].id;
      }
      if (event.header.type == CLAP_EVENT_NOTE_ON) {
        event.note.channel = static_cast<std::int16_t>(draw(18)) - 1;
        event.note.key = static_cast<std::int16_t>(draw(130)) - 1;
      }
      if (event.header.type == CLAP_EVENT_MIDI_SYSEX) continue;  // its pointer would be random
      events.push_back(event);
    }
    ASSERT_NE(played->process(events, 512, sound), CLAP_PROCESS_ERROR);
    for (const float x : sound.left) ASSERT_TRUE(std::isfinite(x));
  }
  std::vector<ClapEvent> end;
  end.reserve(17);
  for (int channel = 0; channel < 16; ++channel) {
    end.push_back(clap_midi(0, 0xB0 | channel, 121, 0));
  }
  end.push_back(clap_note(0, CLAP_EVENT_NOTE_CHOKE, -1, -1, 0));
  played->process(end, 512, sound);
  played->process({}, 512, sound);
  EXPECT_EQ(sound, kSilence);
}

TEST(Clap, SixtyFourInstancesPlayTheSame) {
  std::vector<std::unique_ptr<ClapPlugin>> all;
  for (int i = 0; i < 64; ++i) {
    all.push_back(plugin());
    ASSERT_TRUE(all.back()->start(48000, 512));
  }
  const StereoSound first = all[0]->play(music(), 4800, 480);
  for (int i = 63; i > 0; i -= 9) {
    EXPECT_TRUE(all[static_cast<std::size_t>(i)]->play(music(), 4800, 480) == first);
  }
  while (!all.empty()) all.erase(all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2));
}

}  // namespace
}  // namespace knotwave::test

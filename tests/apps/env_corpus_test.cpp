// SPDX-License-Identifier: MIT
// Dry runs of many songs, hostile ones among them, through every shipped envelope patch: the same
// hash each time, a MIDI file that three readers agree on, and notes that pass through unaltered.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "knotwave/io/midi_file.h"

#include "io/midi_lines.h"
#include "support/corpus.h"
#include "support/program.h"

namespace knotwave::env {
namespace {

using support::ProgramRun;
using support::run_program;
using support::ScratchFolder;

const std::string kSource = KNOTWAVE_SOURCE_DIR;
constexpr int kClock = 48000;                // ticks a second of what is written
constexpr double kDinByte = 48000 / 3125.0;  // ticks

std::vector<std::string> shipped_patches() {
  std::vector<std::string> patches;
  for (const auto& entry : std::filesystem::directory_iterator(kSource + "/examples/envelopes")) {
    if (entry.path().extension() == ".toml") patches.push_back(entry.path().string());
  }
  std::sort(patches.begin(), patches.end());
  return patches;
}

std::string hash_in(const std::string& line) {
  const std::size_t at = line.rfind("sha256 ");
  return at == std::string::npos ? "" : line.substr(at + 7, 64);
}

struct Note {
  double tick = 0;  ///< of 48 kHz
  std::array<std::uint8_t, 3> bytes{};
};

bool is_note(const io::SongEvent& event) { return (event.bytes[0] & 0xE0) == 0x80; }

bool ends_all(const io::SongEvent& event) {
  const int number = event.bytes[1];
  return (event.bytes[0] & 0xF0) == 0xB0 && (number == 120 || number >= 123);
}

double samples_at(io::TickClock& clock, std::uint64_t tick) {
  const base::SampleTime time = clock.at(tick);
  return static_cast<double>(time.sample) + time.fraction * 0x1p-32;
}

/// Notes in order, with the times of a clock of 48 kHz.
std::vector<Note> notes_of(const io::Song& song) {
  io::TickClock clock(song, kClock);
  std::vector<Note> notes;
  for (const io::SongEvent& event : song.events) {
    if (!is_note(event)) continue;
    notes.push_back(
        {samples_at(clock, event.tick), {event.bytes[0], event.bytes[1], event.bytes[2]}});
  }
  return notes;
}

/// What must come through of keys low..high: every note on, and as many ends of a key as it had
/// beginnings. An end is a note off; all notes off ends each key once.
std::vector<Note> notes_through(const io::Song& song, int low, int high) {
  io::TickClock clock(song, kClock);
  std::vector<Note> notes;
  std::array<std::array<int, 128>, 16> on{};
  for (const io::SongEvent& event : song.events) {
    const double tick = samples_at(clock, event.tick);
    const std::uint8_t key = event.bytes[1], channel = event.bytes[0] & 15;
    const auto end = static_cast<std::uint8_t>(0x80 | channel);
    if (ends_all(event)) {
      for (std::size_t k = 0; k < 128; ++k) {
        if (on[channel][k] > 0) notes.push_back({tick, {end, static_cast<std::uint8_t>(k), 64}});
        on[channel][k] = 0;
      }
    } else if (is_note(event) && key >= low && key <= high) {
      const bool is_end = (event.bytes[0] & 0x10) == 0 || event.bytes[2] == 0;
      // A note on of velocity 0 is a note off of velocity 64 (MIDI 1.0).
      const bool is_plain = (event.bytes[0] & 0x10) == 0;
      if (!is_end) {
        ++on[channel][key];
        notes.push_back({tick, {event.bytes[0], key, event.bytes[2]}});
      } else if (on[channel][key] > 0) {
        --on[channel][key];
        notes.push_back({tick, {end, key, is_plain ? event.bytes[2] : std::uint8_t{64}}});
      }
    }
  }
  return notes;
}

/// When each note goes at the latest over a cable on which a note takes `each` ticks, and what was
/// on its way before it `before`.
std::vector<double> latest_begins(const std::vector<Note>& notes, double each, double before) {
  std::vector<double> begins;
  double free_at = 0;
  for (const Note& note : notes) {
    begins.push_back(std::max(note.tick + before, free_at));
    free_at = begins.back() + each;
  }
  return begins;
}

class EnvCorpus : public testing::Test {
 protected:
  ProgramRun dry(const std::string& patch, const std::string& song,
                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"knotwave-env", patch, "--dry-run", song, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    support::ProgramOptions options;
    options.timeout_s = 600;
    return run_program(words, options);
  }

  /// Every shipped patch plays the song.
  void play(const std::string& song) {
    for (const std::string& patch : shipped_patches()) {
      SCOPED_TRACE(song + " through " + patch);
      const std::string sent = folder_.file("sent.mid");
      const ProgramRun first = dry(patch, song, {"-o", sent}), second = dry(patch, song);
      ASSERT_EQ(first.exit_code, second.exit_code);
      ++runs_;
      if (first.exit_code != 0) {
        EXPECT_THAT(first.err, testing::HasSubstr(song)) << "what cannot be read is told";
        EXPECT_FALSE(io::read_midi_file(song).has_value()) << first.err;
        ++refused_;
        return;
      }
      EXPECT_EQ(hash_in(first.out).size(), 64u) << first.out;
      EXPECT_EQ(hash_in(first.out), hash_in(second.out));
      EXPECT_THAT(first.out, Not(testing::HasSubstr("not at rest")));
      const auto written = io::read_midi_file(sent);
      ASSERT_TRUE(written.has_value()) << written.error().to_string();
      EXPECT_TRUE(written->warnings.empty());
      expect_others_agree(sent, *written);
      const auto played = io::read_midi_file(song);
      ASSERT_TRUE(played.has_value());
      expect_notes(patch, first.out, *played, *written);
    }
    ++songs_;
  }

  void say() const {
    std::printf(
        "%d songs, %d runs, %d refused; %zu messages as midicsv and mido read them, "
        "%zu notes through\n",
        songs_, runs_, refused_, messages_, notes_);
  }

 private:
  void expect_others_agree(const std::string& path, const io::Song& song) {
    const auto csv = run_program({"/usr/bin/env", "midicsv", path});
    ASSERT_EQ(csv.exit_code, 0) << csv.err << " (apt-get install midicsv)";
    // Two equal lists of a million lines are not printed.
    ASSERT_TRUE(io::our_lines(song) == io::midicsv_lines(csv.out));
    const auto mido =
        run_program({"/usr/bin/python3", kSource + "/tests/apps/mido_lines.py", path});
    ASSERT_EQ(mido.exit_code, 0) << mido.err << " (apt-get install python3-mido)";
    ASSERT_TRUE(mido_words(song) == mido.out);
    messages_ += song.events.size();
  }

  static std::string mido_words(const io::Song& song) {
    std::vector<io::SongEvent> events = song.events;
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& a, const auto& b) { return a.track < b.track; });
    std::string text;
    const auto add = [&text](int byte) {
      constexpr const char* kDigits = "0123456789ABCDEF";
      text += {kDigits[byte >> 4], kDigits[byte & 15]};
    };
    for (const io::SongEvent& event : events) {
      text += std::to_string(event.track) + " " + std::to_string(event.tick) + " ";
      const int bytes = event.bytes[0] == 0xF0 ? 1 : (event.bytes[0] & 0xE0) == 0xC0 ? 2 : 3;
      for (int i = 0; i < bytes; ++i) add(event.bytes[i]);
      for (std::uint32_t i = 0; i < event.sysex_size; ++i) {
        add(song.sysex_bytes[event.sysex_begin + i]);
      }
      if (event.bytes[0] == 0xF0) add(0xF7);
      text += '\n';
    }
    return text;
  }

  /// What goes in comes out, in order, byte for byte and in time; then only ends of notes.
  void expect_notes(const std::string& patch, const std::string& line, const io::Song& played,
                    const io::Song& written) {
    const bool is_swell = patch.ends_with("filter-swell.toml");
    const bool is_adsr = patch.ends_with("pitch-adsr.toml");
    if (!is_swell && !is_adsr) return;
    if (line.find(" lost for want of room") != std::string::npos) {
      std::printf("%s: %s", patch.c_str(), line.c_str());
      return;
    }
    const std::vector<Note> in =
        is_adsr ? notes_through(played, 36, 84) : notes_through(played, 0, 127);
    const std::vector<Note> out = notes_of(written);
    ASSERT_GE(out.size(), in.size());
    // A controller of 3 bytes may be on its way already; USB has 16 messages a millisecond.
    const auto latest =
        is_swell ? latest_begins(in, 3 * kDinByte, 3 * kDinByte) : latest_begins(in, 3, 48);
    for (std::size_t i = 0; i < in.size(); ++i) {
      ASSERT_EQ(in[i].bytes, out[i].bytes) << "note " << i;
      ASSERT_GE(out[i].tick, in[i].tick - 0.51) << "note " << i;
      ASSERT_LE(out[i].tick, latest[i] + 0.51) << "note " << i;
    }
    for (std::size_t i = in.size(); i < out.size(); ++i) {
      EXPECT_EQ(out[i].bytes[0] & 0xF0, 0x80) << "note " << i;
    }
    notes_ += in.size();
  }

  ScratchFolder folder_;
  int songs_ = 0, runs_ = 0, refused_ = 0;
  std::size_t messages_ = 0, notes_ = 0;
};

/// Everything that a song should not do, at once.
std::vector<std::uint8_t> hostile_song() {
  io::Song song;
  song.track_count = 2;
  song.time_base.ticks_per_quarter = 96;
  const auto add = [&song](std::uint64_t tick, int a, int b, int c) {
    song.events.push_back(
        {tick,
         0,
         {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)},
         0,
         0});
  };
  song.tempos = {{0, 500'000}, {96, 16'777'215}, {97, 1000}, {480, 250'000}};
  add(0, 0x80, 60, 64);                                        // an end without a note
  for (int i = 0; i < 20; ++i) add(1, 0x90, 60, 1 + i);        // one key twenty times
  for (int key = 0; key < 128; ++key) add(2, 0x91, key, 127);  // all keys at once
  add(2, 0xB1, 123, 0);                                        // all notes off
  add(3, 0x90, 64, 100);
  add(3, 0x90, 64, 0);  // no length
  add(4, 0xB0, 64, 127);
  add(4, 0xE0, 127, 127);
  add(5, 0xC0, 5, 0);
  song.sysex_bytes.assign(3000, 0x55);
  song.events.push_back({6, 0, {0xF0, 0, 0}, 0, 3000});
  for (std::uint64_t tick = 7; tick < 1000; tick += 13) {
    add(tick, 0x99, 36, 1 + static_cast<int>(tick % 127));
    add(tick, 0xB0, 1, static_cast<int>(tick % 128));
  }
  add(1000, 0xB9, 120, 0);
  add(1001, 0x92, 61, 5);  // and never let go
  std::stable_sort(song.events.begin(), song.events.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  song.length_ticks = 1010;
  return io::write_midi(song);
}

TEST_F(EnvCorpus, ShippedScoresAndAHostileOneKeepTheirNotesAndAreReadByOthers) {
  const ScratchFolder folder;
  const auto hostile = hostile_song();
  const auto write = [&folder](const std::string& name, std::span<const std::uint8_t> bytes) {
    std::ofstream(folder.file(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return folder.file(name);
  };
  play(write("hostile.mid", hostile));
  play(write("cut.mid", std::span(hostile).first(hostile.size() / 2)));
  play(write("nothing.mid", std::span(hostile).first(10)));
  for (const char* name : {"first-light", "groove"}) {
    play(kSource + "/examples/scores/" + name + ".mid");
  }
  say();
}

/// Every n-th, so that all folders have their share.
std::vector<std::string> spread(std::vector<std::string> files, std::size_t count) {
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < count && !files.empty(); ++i) {
    chosen.push_back(files[i * files.size() / count]);
  }
  return chosen;
}

/// Below a minute.
bool is_short(const std::string& file) {
  const auto song = io::read_midi_file(file);
  if (!song) return false;
  io::TickClock clock(*song, kClock);
  return samples_at(clock, song->length_ticks) < 60.0 * kClock;
}

using EnvCorpusStress = EnvCorpus;

TEST_F(EnvCorpusStress, FiftySongsOfTheCorpusKeepTheirNotesAndAreReadByOthers) {
  auto songs = support::corpus_files("midi", {".mid"});
  std::erase_if(songs, [](const std::string& file) { return !is_short(file); });
  auto files = spread(songs, 38);
  for (auto& bad : spread(support::corpus_files("midi_bad", {".mid"}), 12)) files.push_back(bad);
  std::printf("corpus: %zu files of midi and midi_bad\n", files.size());
  if (files.empty()) GTEST_SKIP() << "KNOTWAVE_CORPUS names no midi: no file was read";
  for (const std::string& file : files) play(file);
  say();
}

}  // namespace
}  // namespace knotwave::env

// SPDX-License-Identifier: MIT
// A journal's text says all of it, what is wrong with a text is told with its place, and a bank
// plays again from the texts that were kept.
#include "knotwave/engine/journal.h"

#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "knotwave/base/file.h"
#include "knotwave/base/random.h"
#include "knotwave/engine/map_slots.h"

#include "scenes.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

bool is_same(const JournalRecord& a, const JournalRecord& b) {
  return a.time == b.time && a.kind == b.kind && std::memcmp(a.bytes, b.bytes, 3) == 0 &&
         a.sysex_size == b.sysex_size && a.every_channel == b.every_channel && a.index == b.index &&
         a.note == b.note && a.is_expression == b.is_expression && a.sysex == b.sysex &&
         std::bit_cast<std::uint64_t>(a.number) == std::bit_cast<std::uint64_t>(b.number);
}

JournalRecord random_record(const base::RandomStream& random, std::uint64_t& draw) {
  JournalRecord record;
  const std::uint64_t bits = random.bits(draw++);
  record.kind = static_cast<Event::Kind>(bits % 8);
  if ((bits >> 8 & 3) == 0) record.time.fraction = static_cast<std::uint32_t>(bits >> 32);
  switch (record.kind) {
    case Event::Kind::midi:
      for (int i = 0; i < 3; ++i) record.bytes[i] = static_cast<std::uint8_t>(bits >> (16 + 8 * i));
      if ((bits >> 58 & 3) == 0) record.note = static_cast<std::int32_t>(bits >> 33 & 0x7FFFFFFF);
      if (record.bytes[0] == 0xF0) record.sysex_size = static_cast<std::uint8_t>(bits >> 60 & 15);
      for (std::size_t i = 0; i < record.sysex_size; ++i) {
        record.sysex[i] = static_cast<std::uint8_t>(random.bits(draw++));
      }
      break;
    case Event::Kind::tempo:
      record.number = static_cast<double>(bits >> 40);
      break;
    case Event::Kind::position:
      record.number = static_cast<double>(bits >> 11);
      break;
    case Event::Kind::install_bank:
      record.index = static_cast<std::uint32_t>(bits >> 20 & 1);
      break;
    case Event::Kind::all_notes_off:
      break;
    case Event::Kind::choke:
      if ((bits >> 26 & 1) != 0) {
        record.note = static_cast<std::int32_t>(bits >> 33);
        break;
      }
      record.every_channel = (bits >> 24 & 1) != 0;
      if (!record.every_channel) record.bytes[0] = static_cast<std::uint8_t>(bits >> 20 & 15);
      record.bytes[1] = static_cast<std::uint8_t>(bits >> 56 & 0xFF);
      if (record.bytes[1] > 127) record.bytes[1] = Event::kEveryKey;
      break;
    case Event::Kind::set_note:
      record.is_expression = (bits >> 25 & 1) != 0;
      record.index = static_cast<std::uint32_t>(bits >> 30) % (kSlotCount + 2);
      if (record.index == kSlotCount) record.index = Event::kNotePressure;
      if (record.index == kSlotCount + 1) record.index = Event::kNoteTimbre;
      record.number = static_cast<double>(bits >> 20 & 0xFFFF) / 100;
      if ((bits >> 26 & 1) != 0) {
        record.note = static_cast<std::int32_t>(bits >> 33);
      } else {
        record.every_channel = (bits >> 24 & 1) != 0;
        if (!record.every_channel) record.bytes[0] = static_cast<std::uint8_t>(bits >> 20 & 15);
        const auto key = static_cast<std::uint8_t>(bits >> 56 & 0xFF);
        record.bytes[1] = key > 127 ? std::uint8_t{Event::kEveryKey} : key;
      }
      break;
    case Event::Kind::set_target:
      record.every_channel = (bits >> 24 & 1) != 0;
      if (!record.every_channel) record.bytes[0] = static_cast<std::uint8_t>(bits >> 20 & 15);
      record.index = static_cast<std::uint32_t>(bits >> 30) % (kSlotCount + 2);
      if (record.index == kSlotCount + 1) record.index = Event::kEverySlot;
      record.number = std::bit_cast<double>(random.bits(draw++));
      if (record.number != record.number) record.number = -0.0;
      break;
  }
  return record;
}

Journal small_journal() {
  Journal journal;
  journal.rate_hz = 44100;
  journal.volume_db = -0.1;
  journal.seed = std::numeric_limits<std::uint64_t>::max();
  journal.first = 5;
  journal.end = 480000;
  journal.sha256 = std::string(64, 'a');
  journal.banks.push_back({"a bank.toml",
                           {{"a bank.toml", "one\r\n|two\n\nend\n"}, {"", ""}, {"b\nc", "\n"}},
                           {{"sound | 1.wav", std::string(64, '0')}}});
  journal.banks.push_back({"other", {}, {}});
  return journal;
}

TEST(Journal, ReadsBackAsItWasWritten) {
  const base::RandomStream random{support::test_seed(), 0, 4001};
  Journal journal = small_journal();
  std::uint64_t draw = 0;
  std::int64_t sample = 0;
  for (int i = 0; i < 20000; ++i) {
    journal.records.push_back(random_record(random, draw));
    sample += static_cast<std::int64_t>(random.bits(draw++) % 100) + 1;
    journal.records.back().time.sample = sample;
  }
  const std::string text = write_journal(journal);
  const auto read = read_journal(text, "take.journal");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->rate_hz, journal.rate_hz);
  EXPECT_EQ(read->max_voices, journal.max_voices);
  EXPECT_EQ(read->seed, journal.seed);
  EXPECT_EQ(read->volume_db, journal.volume_db);
  EXPECT_EQ(read->first, 5);
  EXPECT_EQ(read->end, 480000);
  EXPECT_EQ(read->sha256, journal.sha256);
  ASSERT_EQ(read->banks.size(), 2u);
  EXPECT_EQ(read->banks[0].path, "a bank.toml");
  ASSERT_EQ(read->banks[0].files.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read->banks[0].files[i].path, journal.banks[0].files[i].path);
    EXPECT_EQ(read->banks[0].files[i].bytes, journal.banks[0].files[i].bytes);
  }
  EXPECT_EQ(read->banks[0].sounds.at(0).path, "sound | 1.wav");
  ASSERT_EQ(read->records.size(), journal.records.size());
  for (std::size_t i = 0; i < read->records.size(); ++i) {
    ASSERT_TRUE(is_same(read->records[i], journal.records[i])) << i;
  }
  EXPECT_EQ(write_journal(*read), text);
}

TEST(Journal, IsTheTextThatTheDocumentShows) {
  Journal journal;
  journal.end = 96000;
  journal.banks.push_back({"beep.toml", {{"beep.toml", "format = 1\nkind = \"patch\"\n"}}, {}});
  JournalRecord record;
  record.time = {512, 0x80000000u};
  record.bytes[0] = 0x90;
  record.bytes[1] = 60;
  record.bytes[2] = 100;
  journal.records.push_back(record);
  record = {};
  record.time.sample = 1000;
  record.kind = Event::Kind::set_target;
  record.index = kSlotSourceLevel;
  record.number = -6.5;
  journal.records.push_back(record);
  record.every_channel = true;
  record.index = kSlotPan;
  journal.records.push_back(record);
  record = {};
  record.time.sample = 2000;
  record.note = 17;
  record.bytes[0] = 0x90;
  record.bytes[1] = 64;
  record.bytes[2] = 100;
  journal.records.push_back(record);
  record.kind = Event::Kind::set_note;
  record.is_expression = true;
  record.index = kSlotPitch;
  record.number = 0.5;
  journal.records.push_back(record);
  record = {};
  record.time.sample = 3000;
  record.kind = Event::Kind::set_note;
  record.bytes[0] = 2;
  record.bytes[1] = 60;
  record.index = Event::kNotePressure;
  record.number = 0.75;
  journal.records.push_back(record);
  record.time.sample = 4000;
  record.kind = Event::Kind::choke;
  record.bytes[1] = Event::kEveryKey;
  journal.records.push_back(record);
  record = {};
  record.time.sample = 24000;
  record.kind = Event::Kind::position;
  record.number = 96;
  journal.records.push_back(record);
  record = {};
  record.time.sample = 48000;
  record.kind = Event::Kind::all_notes_off;
  journal.records.push_back(record);
  EXPECT_EQ(write_journal(journal), R"(knotwave-journal 1
rate_hz 48000
max_voices 128
seed 1
volume_db 0
take 0 96000 -
bank
|beep.toml
file
|beep.toml
holds
|format = 1
|kind = "patch"
|
events
512+2147483648 midi 90 3c 64
1000 target 1 oscillator.1.level -6.5
1000 target every pan -6.5
2000 numbered 17 90 40 64
2000 expression note 17 pitch 0.5
3000 modulation 3 60 pressure 0.75
4000 choke 3 every
24000 position 96
48000 notes_off
end
)");
}

TEST(Journal, TellsWhatIsWrongAndWhere) {
  const std::string head =
      "knotwave-journal 1\nrate_hz 48000\nmax_voices 128\nseed 1\nvolume_db 0\n";
  const std::string whole = head + "take 0 10 -\nbank\n|a\nevents\n";
  const std::pair<std::string, std::string> cases[] = {
      {"", "t:1:1: error: the journal ends before its line 'end'"},
      {"knotwave-journal 1", "t:1:1: error: the last line has no end: the journal was cut off"},
      {"knotwave-", "t:1:1: error: the last line has no end: the journal was cut off"},
      {"MThd without a line",
       "t:1:1: error: this is no journal: one begins with 'knotwave-journal'"},
      {"knotwave 1\n", "t:1:1: error: this is no journal: one begins with 'knotwave-journal'"},
      {"knotwave-journal 2\n", "t:1:18: error: this program reads journals of version 1, not '2'"},
      {"knotwave-journal 1\nrate_hz fast\n", "t:2:9: error: the rate must be a number here"},
      {"knotwave-journal 1\nrate_hz 48000\nmax_voices 0\n",
       "t:3:12: error: the number of voices must be 1 to 4096"},
      {head + "take 9 3 -\n", "t:6:8: error: the take's end must be 9 to 4611686018427387904"},
      {head + "take 0 3 xyz\n", "t:6:10: error: a SHA-256 in 64 hexadecimal digits must be here"},
      {head + "take 0 3 - -\n", "t:6:10: error: a SHA-256 in 64 hexadecimal digits must be here"},
      {head + "take 0 3 -\nfile\n", "t:7:1: error: 'bank' or 'events' must be here"},
      {head + "take 0 3 -\nbank\na\n", "t:8:1: error: a line that begins with '|' must be here"},
      {whole, "t:10:1: error: the journal ends before its line 'end'"},
      {whole + "end\nx\n", "t:11:1: error: there is more after the journal's end"},
      {whole + "x midi\n",
       "t:10:1: error: a time must be here: a sample, or SAMPLE+FRACTION in 2^-32"},
      {whole + "-1 notes_off\n",
       "t:10:1: error: a time must be here: a sample, or SAMPLE+FRACTION in 2^-32"},
      {whole + "1 play\n",
       "t:10:3: error: 'midi', 'numbered', 'tempo', 'position', 'bank', 'notes_off', 'target', "
       "'modulation', 'expression' or 'choke' must be here after a time"},
      {whole + "1 midi 90 3c\n", "t:10:13: error: a byte in two hexadecimal digits must be here"},
      {whole + "1 midi 90  3c 40\n",
       "t:10:11: error: a byte in two hexadecimal digits must be here"},
      {whole + "1 notes_off now\n", "t:10:13: error: there is more on the line than belongs there"},
      {whole + "9 notes_off\n8 notes_off\n", "t:11:1: error: this is earlier than the line before"},
      {whole + "1 position -6\n",
       "t:10:12: error: the song position in MIDI clocks must be 0 to 9007199254740992"},
      {whole + "1 bank 1\n",
       "t:10:8: error: there is no bank 1; the journal holds 1, counted from 0"},
      {whole + "1 target 17 amp 0\n", "t:10:10: error: a channel must be 1 to 16"},
      {whole + "1 target 1 loud 0\n",
       "t:10:12: error: a target must be here, such as amp or oscillator.1.level"},
  };
  for (const auto& [text, message] : cases) {
    const auto read = read_journal(text, "t");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().to_string(), message) << text;
  }
}

TEST(Journal, WhateverTheTextIsItIsReadOrRefused) {
  const base::RandomStream random{support::test_seed(), 0, 4002};
  Journal journal = small_journal();
  std::uint64_t draw = 0;
  for (int i = 0; i < 40; ++i) {
    journal.records.push_back(random_record(random, draw));
    journal.records.back().time = {100 * i, 0};
  }
  const std::string text = write_journal(journal);
  int refused = 0;
  const int count = support::test_count(20000);
  for (int i = 0; i < count; ++i) {
    std::string bent = text;
    for (std::uint64_t k = random.bits(draw++) % 3 + 1; k > 0; --k) {
      const std::size_t at = random.bits(draw++) % bent.size();
      const std::uint64_t how = random.bits(draw++);
      if (how % 3 == 0) bent[at] = static_cast<char>(how >> 8);
      if (how % 3 == 1) bent.erase(at, (how >> 8) % 40);
      if (how % 3 == 2) bent.insert(at, bent, (how >> 20) % bent.size(), (how >> 8) % 40);
    }
    const auto read = read_journal(bent, "bent");
    if (!read) {
      ++refused;
      EXPECT_GT(read.error().line, 0);
      EXPECT_GT(read.error().column, 0);
    } else {
      const std::string again = write_journal(*read);
      const auto twice = read_journal(again, "again");
      ASSERT_TRUE(twice) << twice.error().to_string();
      EXPECT_EQ(write_journal(*twice), again);
    }
  }
  EXPECT_GT(refused, count / 4);
}

TEST(ReadBank, FromTheTextsThatWereKeptIsTheSameBankWithoutItsFiles) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("knotwave_texts_" + std::to_string(::getpid()));
  fs::create_directories(folder / "patches");
  const auto put = [&](const char* name, std::string_view text) {
    ASSERT_TRUE(base::write_file((folder / name).string(), text));
  };
  put("bank.toml", R"(format = 1
kind = "bank"
[[programs]]
program = 0
patch = "patches/one.toml"
[[programs]]
program = 1
patch = "patches/two.toml"
)");
  const std::string named = R"(format = 1
kind = "patch"
name = "One"
[curves.gate]
curve_file = "../gates.toml"
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.06
)";
  put("patches/one.toml", named);
  put("patches/two.toml", kPlain);
  put("gates.toml", "format = 1\nkind = \"curve\"\n[curves.gate]\ndegree = 1\npoints = [1, 0]\n");
  const std::string path = (folder / "bank.toml").string();
  const auto first = read_bank(path);
  ASSERT_TRUE(first) << first.error().to_string();
  EXPECT_EQ(first->texts.size(), 4u);
  put("patches/one.toml", "broken");
  fs::remove(folder / "gates.toml");
  EXPECT_FALSE(read_bank(path));
  const auto again = read_bank(path, first->texts);
  ASSERT_TRUE(again) << again.error().to_string();
  EXPECT_EQ(again->files, first->files);
  const auto sound = [](const BankSpec& spec) {
    const auto bank = BankProgram::create(spec);
    EXPECT_TRUE(bank);
    return play(*engine_for(**bank), {on(0, 0, 60)}, 4800);
  };
  EXPECT_TRUE(sound(*first) == sound(*again));
  auto fewer = first->texts;
  fewer.pop_back();
  const auto missing = read_bank(path, fewer);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::file_not_found);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace knotwave::engine

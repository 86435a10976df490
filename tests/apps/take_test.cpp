// SPDX-License-Identifier: MIT
// A take is played again by knotwave-render from its journal alone, and its MIDI part lies under
// it.
#include "take/take.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "knotwave/base/file.h"
#include "knotwave/base/sha256.h"
#include "knotwave/engine/live_engine.h"
#include "knotwave/io/sound_file.h"

#include "support/program.h"
#include "take/take_midi.h"
#include "take/take_player.h"

namespace knotwave::take {
namespace {

constexpr const char* kPatch = R"(format = 1
kind   = "patch"
name   = "small"
[curves.gate]
degree = 1
points = [0, 1, 1, 0]
knots  = [0,0, 0.01, 0.02, 0.05,0.05]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.05
sustain_at = 0.02
release_at = 0.02
)";

engine::LiveMessage message(int status, int one, int two) {
  engine::LiveMessage out;
  out.bytes[0] = static_cast<std::uint8_t>(status);
  out.bytes[1] = static_cast<std::uint8_t>(one);
  out.bytes[2] = static_cast<std::uint8_t>(two);
  return out;
}

/// A take of a second, begun a quarter of a second in, over a change of the patch.
struct Session {
  explicit Session(const std::string& patch_path) {
    install(patch_path, kPatch);
    auto made = engine::LiveEngine::create({}, std::move(input.program), source);
    EXPECT_TRUE(made);
    live = *std::move(made);
    live->push(0, message(0x90, 60, 100));
    blocks(48);
    live->set_tap(true);
    journal.first = 48 * 256;
    live->push(0, message(0x90, 67, 80));
    blocks(80);
    live->push(0, message(0x80, 60, 0));
    install(patch_path, std::string(kPatch) + "[filter]\ncutoff_hz = 300\n");
    live->install(std::move(input.program), source);
    blocks(108);
    live->take_journal(journal);
    journal.end = journal.first + static_cast<std::int64_t>(samples.size() / 2);
    base::Sha256 hash;
    hash.update(std::span<const float>(samples));
    journal.sha256 = hash.finish_hex();
  }
  void install(const std::string& path, const std::string& text) {
    EXPECT_TRUE(base::write_file(path, text));
    auto read = bank_input::read(path);
    EXPECT_TRUE(read) << read.error().to_string();
    input = *std::move(read);
    auto kept = journal_bank(input);
    EXPECT_TRUE(kept);
    source = *std::move(kept);
  }
  void blocks(int count) {
    std::array<float, 256> left, right;
    std::array<float, 512> part;
    for (int i = 0; i < count; ++i) {
      live->process(time_ns += 5'333'333, {}, left, right);
      const auto tap = live->take_tap(part);
      samples.insert(samples.end(), part.begin(),
                     part.begin() + static_cast<std::ptrdiff_t>(2 * tap.frames));
    }
  }

  std::unique_ptr<engine::LiveEngine> live;
  bank_input::BankInput input;
  engine::JournalBank source;
  engine::Journal journal;
  std::int64_t time_ns = 1'000'000'000;
  std::vector<float> samples;
};

TEST(Take, IsRenderedAgainToTheSameSamplesThoughItsPatchIsGone) {
  const support::ScratchFolder folder;
  Session session(folder.file("small.toml"));
  ASSERT_EQ(session.journal.banks.size(), 2u);
  ASSERT_TRUE(write_take(folder.file("a.journal"), session.journal));
  std::filesystem::remove(folder.file("small.toml"));
  for (const char* block : {"1", "256", "5000"}) {
    const auto run = support::run_program({"knotwave-render", "--journal", folder.file("a.journal"),
                                           "-o", folder.file("a.wav"), "--block", block});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("1.003 s"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("sha256 " + session.journal.sha256), std::string::npos) << run.out;
  }
  EXPECT_TRUE(std::filesystem::exists(folder.file("a.wav")));
}

TEST(Take, ThatSoundsDifferentIsAnErrorWithBothHashesAndNoFile) {
  const support::ScratchFolder folder;
  Session session(folder.file("small.toml"));
  const std::string right = session.journal.sha256;
  session.journal.sha256 = std::string(64, 'b');
  ASSERT_TRUE(write_take(folder.file("a.journal"), session.journal));
  const auto run = support::run_program(
      {"knotwave-render", "--journal", folder.file("a.journal"), "-o", folder.file("a.wav")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find(right), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(session.journal.sha256), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.wav")));
}

TEST(Take, WordsThatDoNotGoWithAJournalAreTold) {
  const auto run = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"knotwave-render", "--journal", "a.journal", "-o", "a.wav"});
    const auto ran = support::run_program(words);
    EXPECT_EQ(ran.exit_code, 2);
    return ran.err;
  };
  EXPECT_NE(run({"--seed", "1"}).find("--journal plays the take as it was; leave out --seed"),
            std::string::npos);
  EXPECT_NE(run({"a.toml"}).find("--journal has its own patches; leave out 'a.toml'"),
            std::string::npos);
  const auto none =
      support::run_program({"knotwave-render", "--journal", "nowhere.journal", "-o", "a.wav"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("nowhere.journal"), std::string::npos) << none.err;
}

TEST(TakeMidi, HasOneTickASample) {
  for (const double rate_hz : {8000.0, 11025.0, 22050.0, 44100.0, 48000.0, 88200.0, 96000.0,
                               176400.0, 192000.0, 384000.0, 768000.0}) {
    engine::Journal journal;
    journal.rate_hz = rate_hz;
    journal.end = 100'000'000;
    for (const std::int64_t sample : {0LL, 1LL, 12345LL, 99'999'999LL}) {
      engine::JournalRecord record;
      record.time.sample = sample;
      record.bytes[0] = 0x90;
      record.bytes[1] = record.bytes[2] = 64;
      journal.records.push_back(record);
    }
    const auto song = midi_song(journal);
    ASSERT_TRUE(song) << rate_hz << ": " << song.error().to_string();
    const auto bytes = io::write_midi(*song);
    const auto read = io::parse_midi(std::as_bytes(std::span(bytes)), "take.mid");
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->warnings.empty());
    ASSERT_EQ(read->events.size(), journal.records.size());
    io::TickClock clock(*read, static_cast<std::uint32_t>(rate_hz));
    for (std::size_t i = 0; i < read->events.size(); ++i) {
      EXPECT_EQ(clock.at(read->events[i].tick).sample, journal.records[i].time.sample) << rate_hz;
      EXPECT_EQ(clock.at(read->events[i].tick).fraction, 0u) << rate_hz;
    }
    EXPECT_EQ(clock.at(read->length_ticks).sample, journal.end);
  }
}

TEST(TakeMidi, OfARateNoTimeBaseGivesIsRefused) {
  engine::Journal journal;
  for (const double rate_hz : {48001.0, 44100.5}) {
    journal.rate_hz = rate_hz;
    const auto song = midi_song(journal);
    ASSERT_FALSE(song);
    EXPECT_EQ(song.error().code, ErrorCode::unsupported);
  }
}

TEST(TakeMidi, BeginsWithWhatWasPlayedBeforeButNotWithNotesThatHadEnded) {
  engine::Journal journal;
  journal.first = 1000;
  journal.end = 2000;
  const auto add = [&](std::int64_t sample, std::uint8_t status, std::uint8_t one,
                       std::uint8_t two) {
    engine::JournalRecord record;
    record.time.sample = sample;
    record.bytes[0] = status;
    record.bytes[1] = one;
    record.bytes[2] = two;
    journal.records.push_back(record);
  };
  add(10, 0xC0, 5, 0);
  add(20, 0x90, 60, 100);  // ends before the take
  add(30, 0x90, 62, 100);  // sounds on
  add(40, 0x90, 60, 0);
  add(1500, 0x80, 62, 0);
  add(2001, 0x90, 64, 100);  // after it
  const auto song = midi_song(journal);
  ASSERT_TRUE(song);
  std::vector<std::array<int, 3>> events;
  for (const io::SongEvent& event : song->events) {
    events.push_back({static_cast<int>(event.tick), event.bytes[0], event.bytes[1]});
  }
  EXPECT_EQ(events,
            (std::vector<std::array<int, 3>>{{0, 0xC0, 5}, {0, 0x90, 62}, {500, 0x80, 62}}));
  EXPECT_EQ(song->length_ticks, 1000u);
}

TEST(TakeMidi, EndsWhatAChokeCut) {
  engine::Journal journal;
  journal.end = 1000;
  engine::JournalRecord on;
  on.note = 7;
  on.bytes[0] = 0x92;
  on.bytes[1] = 60;
  on.bytes[2] = 100;
  journal.records.push_back(on);
  const auto choke = [&](std::int64_t sample, std::int32_t note, int channel, int key) {
    engine::JournalRecord record;
    record.time.sample = sample;
    record.kind = engine::Event::Kind::choke;
    record.note = note;
    record.bytes[0] = static_cast<std::uint8_t>(channel);
    record.bytes[1] = static_cast<std::uint8_t>(key);
    journal.records.push_back(record);
  };
  choke(100, 7, 0, 0);
  choke(200, -1, 3, 64);
  choke(300, -1, 4, engine::Event::kEveryKey);
  const auto song = midi_song(journal);
  ASSERT_TRUE(song);
  std::vector<std::array<int, 3>> events;
  for (const io::SongEvent& event : song->events) {
    events.push_back({static_cast<int>(event.tick), event.bytes[0], event.bytes[1]});
  }
  EXPECT_EQ(events, (std::vector<std::array<int, 3>>{
                        {0, 0x92, 60}, {100, 0x82, 60}, {200, 0x83, 64}, {300, 0xB4, 120}}));
}

TEST(TakeMidi, RendersToTheSameSamplesAsTheJournalWhereTheTakeBeginsAtTheStart) {
  const support::ScratchFolder folder;
  Session session(folder.file("small.toml"));
  session.journal.first = 0;
  std::erase_if(session.journal.records, [](const engine::JournalRecord& record) {
    return record.kind != engine::Event::Kind::midi;
  });
  const auto song = midi_song(session.journal);
  ASSERT_TRUE(song);
  const auto bytes = io::write_midi(*song);
  ASSERT_TRUE(base::write_file(folder.file("a.mid"),
                               {reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
  ASSERT_TRUE(base::write_file(folder.file("small.toml"), kPatch));
  const auto from_midi = support::run_program({"knotwave-render", folder.file("small.toml"),
                                               folder.file("a.mid"), "-o", "-", "--tail", "0"});
  ASSERT_EQ(from_midi.exit_code, 0) << from_midi.err;
  auto player = TakePlayer::create(session.journal, 1);
  ASSERT_TRUE(player);
  const auto frames = static_cast<std::size_t>(session.journal.end);
  std::vector<float> left(frames), right(frames), both;
  ASSERT_TRUE((*player)->play(left, right));
  for (std::size_t i = 0; i < frames; ++i) both.insert(both.end(), {left[i], right[i]});
  ASSERT_EQ(from_midi.out.size(), both.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(from_midi.out.data(), both.data(), from_midi.out.size()), 0);
}

TEST(Take, WithAnotherSoundFileThanItWasPlayedWithIsRefused) {
  const support::ScratchFolder folder;
  const auto put_sound = [&](float level) {
    auto writer = io::SoundWriter::create({.path = folder.file("cycle.wav"),
                                           .rate_hz = 48000,
                                           .channels = 1,
                                           .format = io::SampleFormat::float32,
                                           .expected_frames = 256});
    ASSERT_TRUE(writer);
    std::vector<float> samples(256);
    for (std::size_t i = 0; i < 256; ++i) samples[i] = i < 128 ? level : -level;
    ASSERT_TRUE(writer->write(samples));
    ASSERT_TRUE(writer->finish());
  };
  put_sound(0.5F);
  std::string patch = kPatch;
  patch.replace(patch.find("wave = \"sine\""), 13, "wave_file = \"cycle.wav\"");
  ASSERT_TRUE(base::write_file(folder.file("sampled.toml"), patch));
  const auto input = bank_input::read(folder.file("sampled.toml"));
  ASSERT_TRUE(input) << input.error().to_string();
  const auto kept = journal_bank(*input);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->sounds.size(), 1u);
  EXPECT_TRUE(read_kept(*kept));
  put_sound(0.25F);
  const auto other = read_kept(*kept);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().source, folder.file("cycle.wav"));
  EXPECT_NE(other.error().message.find(kept->sounds[0].sha256), std::string::npos);
}

}  // namespace
}  // namespace knotwave::take

// SPDX-License-Identifier: MIT
// Every note on is told once when its note is heard no more, whatever ends it; and a choke cuts
// what it means and nothing else.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/journal.h"

#include "scenes.h"
#include "support/seed.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

/// Heard for 60 ms, however long its key is down.
std::string struck(std::string_view lines = "") {
  std::string text(kPlain);
  text.resize(text.find("sustain_at"));
  return with(text, lines);
}

Event numbered(Event event, std::int32_t note) {
  event.note = note;
  return event;
}
Event choke_note(std::int64_t sample, std::int32_t note) {
  Event event = of_kind(sample, Event::Kind::choke);
  event.midi.bytes[1] = Event::kEveryKey;
  event.every_channel = true;
  event.note = note;
  return event;
}
/// -1: of every one.
Event choke_key(std::int64_t sample, int channel, int key) {
  Event event = choke_note(sample, Event::kNoNote);
  event.every_channel = channel < 0;
  event.midi.bytes[0] = static_cast<std::uint8_t>(std::max(channel, 0));
  if (key >= 0) event.midi.bytes[1] = static_cast<std::uint8_t>(key);
  return event;
}

using Ends = std::multiset<std::tuple<std::int32_t, int, int>>;  // number, channel, key

class NoteEnds : public testing::Test {
 protected:
  void use(std::string_view patch, int max_voices = 16) {
    bank_ = bank_from(patch);
    engine_ = engine_for(*bank_, {.max_voices = max_voices});
  }
  /// What is told from now to `seconds` after these events, whose times are offsets.
  Ends after(std::vector<Event> events, double seconds = 0.3) {
    for (Event& event : events) event.midi.time.sample += engine_->now();
    Ends told;
    std::vector<float> left(480), right(480);
    const auto blocks = static_cast<int>(seconds * 100);
    for (int block = 0; block < blocks; ++block) {
      const std::int64_t end = engine_->now() + 480;
      const auto due = std::find_if(events.begin(), events.end(),
                                    [&](const Event& event) { return event.time().sample >= end; });
      engine_->process(std::span(events.begin(), due), left, right);
      events.erase(events.begin(), due);
      for (const EndedNote& note : engine_->ended_notes()) {
        told.insert({note.note, note.channel, note.key});
      }
    }
    return told;
  }
  std::unique_ptr<const BankProgram> bank_;
  std::unique_ptr<Engine> engine_;
};

TEST_F(NoteEnds, AMonophonicNoteThatFellSilentUnderItsKeyIsToldOnceWhenTheKeyGoesUp) {
  use(struck("mode = \"mono\""));
  EXPECT_EQ(after({numbered(on(0, 0, 60), 5)}), Ends{});
  EXPECT_EQ(engine_->counters().voices_now, 0);
  EXPECT_EQ(after({numbered(off(0, 0, 60), 5)}), (Ends{{5, 0, 60}}));
  EXPECT_EQ(after({numbered(off(0, 0, 60), 5)}), Ends{});
}

TEST_F(NoteEnds, APolyphonicNoteIsToldWhenItFallsSilentUnderItsKey) {
  use(struck());
  EXPECT_EQ(after({numbered(on(0, 0, 60), 5)}), (Ends{{5, 0, 60}}));
  EXPECT_EQ(after({numbered(off(0, 0, 60), 5)}), Ends{});
}

TEST_F(NoteEnds, AMonophonicKeyPressedAgainEndsTheNoteBefore) {
  use(with(kPlain, "mode = \"legato\""));
  EXPECT_EQ(after({numbered(on(0, 0, 60), 1), numbered(on(9, 0, 64), 2), numbered(on(99, 0, 60), 3),
                   numbered(on(999, 0, 60), 4)}),
            (Ends{{1, 0, 60}, {3, 0, 60}}));
  EXPECT_EQ(after({numbered(off(0, 0, 60), 4), off(9, 0, 64)}), (Ends{{4, 0, 60}, {2, 0, 64}}));
}

TEST_F(NoteEnds, KeysThatOnlyThePedalHeldAreToldWhenItGoesUp) {
  use(with(kPlain, "mode = \"mono\""));
  EXPECT_EQ(after({control(0, 0, kSustain, 127), numbered(on(1, 0, 60), 1), off(2, 0, 60),
                   numbered(on(3, 0, 64), 2), off(4, 0, 64)}),
            Ends{});
  EXPECT_EQ(after({control(0, 0, kSustain, 0)}), (Ends{{1, 0, 60}, {2, 0, 64}}));
}

TEST_F(NoteEnds, ANoteWithoutANumberIsToldByItsKey) {
  use(kPlain);
  EXPECT_EQ(after({on(0, 3, 60), on(5, 3, 60), off(9, 3, 60), off(99, 3, 60)}),
            (Ends{{Event::kNoNote, 3, 60}, {Event::kNoNote, 3, 60}}));
}

TEST_F(NoteEnds, ANoteThatFindsNoPlaceIsToldAtOnce) {
  use(kPlain, 1);
  const Ends told = after(
      {numbered(on(0, 0, 60), 1), numbered(on(0, 0, 61), 2), numbered(on(0, 0, 62), 3)}, 0.01);
  EXPECT_EQ(told, (Ends{{1, 0, 60}, {3, 0, 62}}));
  EXPECT_EQ(engine_->counters().notes_dropped, 1);
}

TEST_F(NoteEnds, HeldKeysWithoutAVoiceAreToldWhenAllSoundGoesOff) {
  use(with(kPlain, "mode = \"mono\""));
  EXPECT_EQ(after({numbered(on(0, 0, 60), 1), numbered(on(9, 0, 64), 2),
                   control(99, 0, kAllSoundOff, 0)}),
            (Ends{{1, 0, 60}, {2, 0, 64}}));
}

/// Poly, mono, legato, struck and mono, two voices at most; beyond program 4 nothing.
std::unique_ptr<const BankProgram> mixed_bank() {
  const std::string patches[] = {std::string(kPlain), with(kPlain, "mode = \"mono\""),
                                 with(kPlain, "mode = \"legato\"\npriority = \"low\""),
                                 struck("mode = \"mono\""), with(kPlain, "polyphony = 2")};
  BankSpec spec;
  spec.drum_channel = 0;
  for (const std::string& text : patches) {
    const auto number = static_cast<int>(spec.patches.size());
    spec.patches.push_back(*parse_patch(text, "scene.toml"));
    BankEntry entry;
    entry.program_low = entry.program_high = number;
    spec.entries.push_back(entry);
    spec.entry_patch.push_back(number);
  }
  auto bank = BankProgram::create(spec);
  EXPECT_TRUE(bank) << bank.error().to_string();
  return *std::move(bank);
}

/// What a host or a player may do, at random.
class Player {
 public:
  Player(std::uint64_t seed, const BankProgram* one, const BankProgram* two)
      : random_{seed, 0, 9173}, banks_{one, two} {}

  int draw(int below) { return static_cast<int>(random_.unit(draw_++) * below); }

  Event next(std::int64_t sample) {
    const int channel = draw(3), key = 60 + draw(6), kind = draw(40);
    if (kind < 14) {
      return numbered(on(sample, channel, key), draw(3) == 0 ? Event::kNoNote : next_number_++);
    }
    if (kind < 23) {
      return numbered(off(sample, channel, key), draw(2) == 0 ? Event::kNoNote : some_number());
    }
    if (kind < 25) return choke_note(sample, some_number());
    if (kind < 28) return choke_key(sample, draw(4) - 1, draw(3) == 0 ? -1 : key);
    if (kind < 31) return control(sample, channel, kSustain, 127 * draw(2));
    if (kind < 33) return control(sample, channel, kSostenuto, 127 * draw(2));
    if (kind < 36) return midi(sample, 0xC0 | channel, draw(6), 0);
    if (kind < 38) {
      constexpr int kModes[] = {kAllSoundOff, kResetControllers, kAllNotesOff,
                                kMonoOn,      kPolyOn,           84};
      return control(sample, channel, kModes[draw(6)], draw(2) * 60);
    }
    if (kind == 38) return rare(sample);
    Event install = of_kind(sample, Event::Kind::install_bank);
    install.bank = banks_[draw(2)];
    return install;
  }

 private:
  std::int32_t some_number() { return std::max(next_number_ - 1 - draw(12), 0); }
  Event rare(std::int64_t sample) {
    static constexpr std::uint8_t kGeneralMidiOn[] = {0x7E, 0x7F, 0x09, 0x01};
    if (draw(2) == 0) return of_kind(sample, Event::Kind::all_notes_off);
    Event reset = midi(sample, 0xF0, 0, 0);
    reset.midi.sysex = kGeneralMidiOn;
    reset.midi.sysex_size = sizeof kGeneralMidiOn;
    return reset;
  }

  base::RandomStream random_;
  std::uint64_t draw_ = 0;
  const BankProgram* banks_[2];
  std::int32_t next_number_ = 0;
};

TEST_F(NoteEnds, EveryNoteIsToldOnceWhateverIsPlayed) {
  const auto one = mixed_bank(), two = mixed_bank();
  const int rounds = support::test_count(40);
  const std::uint64_t seed = support::test_seed();
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    engine_ = engine_for(*one, {.max_voices = 5});
    Player player(seed * 1000 + static_cast<std::uint64_t>(round), one.get(), two.get());
    Ends alive;
    std::vector<float> left(4800), right(4800);
    const auto process = [&](const std::vector<Event>& events, std::size_t frames) {
      engine_->process(events, std::span(left).first(frames), std::span(right).first(frames));
      for (const EndedNote& note : engine_->ended_notes()) {
        const auto found = alive.find({note.note, note.channel, note.key});
        ASSERT_NE(found, alive.end()) << "note " << note.note << " of key " << note.key
                                      << " was told before it began, or twice";
        alive.erase(found);
      }
      ASSERT_GE(static_cast<int>(alive.size()), engine_->counters().voices_now);
    };
    for (int block = 0; block < 120; ++block) {
      const auto frames =
          static_cast<std::size_t>(1 + player.draw(player.draw(4) == 0 ? 4000 : 400));
      std::vector<Event> events;
      for (int i = player.draw(6); i > 0; --i) {
        const int at = player.draw(static_cast<int>(frames));
        events.push_back(player.next(engine_->now() + at));
        const base::MidiEvent& midi = events.back().midi;
        if (events.back().kind == Event::Kind::midi && midi.status() == base::MidiStatus::note_on) {
          alive.insert({events.back().note, midi.channel(), midi.bytes[1]});
        }
      }
      std::stable_sort(events.begin(), events.end(),
                       [](const Event& a, const Event& b) { return a.time() < b.time(); });
      process(events, frames);
      if (HasFatalFailure()) return;
    }
    process({of_kind(engine_->now(), Event::Kind::all_notes_off)}, 1);
    for (int i = 0; i < 4; ++i) process({}, 4800);
    ASSERT_FALSE(HasFatalFailure());
    ASSERT_TRUE(engine_->is_idle());
    ASSERT_EQ(alive, Ends{});
    engine_.reset();
  }
}

// Choke.

constexpr std::int64_t kCut = 6000;
constexpr std::size_t kFrames = 12000, kFade = 240;  // 5 ms

Sound rendered(std::string_view patch, const std::vector<Event>& events, std::size_t block = 256) {
  const auto bank = bank_from(patch);
  return play(*engine_for(*bank), events, kFrames, block);
}

TEST(Choke, OfEverythingIsAllSoundOffToTheBit) {
  const std::vector<Event> notes = {control(0, 0, kSustain, 127), on(0, 0, 60), on(3, 1, 64),
                                    on(5, 0, 67), off(9, 0, 67)};
  for (const char* const mode : {"poly", "mono", "legato"}) {
    const std::string patch = with(kPlain, std::string("mode = \"") + mode + "\"");
    std::vector<Event> choked = notes, off = notes;
    choked.push_back(choke_key(kCut, -1, -1));
    off.push_back(control(kCut, 0, kAllSoundOff, 0));
    off.push_back(control(kCut, 1, kAllSoundOff, 0));
    const Sound sound = rendered(patch, choked);
    EXPECT_EQ(sound, rendered(patch, off)) << mode;
    EXPECT_EQ(sound, rendered(patch, choked, 7)) << mode;
    EXPECT_EQ(peak(sound.left, kCut + kFade + 1), 0) << mode;
  }
}

TEST(Choke, CutsTheNotesItMeansInFiveMillisecondsAndNoOthers) {
  const Event one = numbered(on(0, 0, 60), 7), two = numbered(on(0, 0, 60, 50), 8);
  const Event three = on(0, 1, 60), four = on(0, 0, 64);
  const Event pedal = control(0, 0, kSustain, 127);
  const auto left_of = [&](const Event& choke, const std::vector<Event>& rest) {
    const Sound sound = rendered(kPlain, {pedal, one, two, three, four, choke});
    const Sound expected = rendered(kPlain, rest);
    for (std::size_t i = kCut + kFade + 1; i < kFrames; ++i) {
      ASSERT_NEAR(sound.left[i], expected.left[i], 1e-7) << i;
    }
  };
  left_of(choke_note(kCut, 7), {pedal, two, three, four});
  left_of(choke_note(kCut, 99), {pedal, one, two, three, four});
  left_of(choke_key(kCut, 0, 60), {pedal, three, four});
  left_of(choke_key(kCut, -1, 60), {pedal, four});
  left_of(choke_key(kCut, 1, -1), {pedal, one, two, four});
}

/// The largest second difference: of a 262 Hz sine of this loudness it is 0.0002.
double bend(const Sound& sound) {
  double most = 0;
  for (std::size_t i = 2; i < sound.left.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(sound.left[i]) - 2.0 * sound.left[i - 1] +
                                   sound.left[i - 2]));
  }
  return most;
}

TEST(Choke, DoesNotClick) {
  for (const char* const mode : {"poly", "mono", "legato"}) {
    const std::string patch = with(kPlain, std::string("mode = \"") + mode + "\"");
    const double held = bend(rendered(patch, {on(0, 0, 60)}));
    for (int at = 0; at < 180; at += 20) {
      EXPECT_LT(bend(rendered(patch, {on(0, 0, 60), choke_key(kCut + at, 0, 60)})), 1.5 * held);
    }
  }
}

TEST(Choke, OfAMonophonicNoteDoesNotBringAHeldOneBack) {
  for (const char* const mode : {"mono", "legato"}) {
    const std::string patch = with(kPlain, std::string("mode = \"") + mode + "\"");
    const std::vector<Event> notes = {numbered(on(0, 0, 60), 1), numbered(on(99, 0, 64), 2)};
    std::vector<Event> events = notes;
    events.push_back(choke_note(kCut, 2));
    EXPECT_EQ(peak(rendered(patch, events).left, kCut + kFade + 1), 0) << mode;
    // The one that waits leaves without a sound.
    events.back() = choke_note(kCut, 1);
    EXPECT_EQ(rendered(patch, events), rendered(patch, notes)) << mode;
    events.push_back(numbered(off(kCut + 9, 0, 64), 2));
    EXPECT_LT(peak(rendered(patch, events).left, kCut + 4800), 1e-7) << mode;
  }
}

TEST(Choke, OfAJournalGivesTheSameSamples) {
  const std::vector<Event> events = {
      numbered(on(0, 0, 60), 7), on(0, 1, 64),           on(0, 2, 67),
      choke_note(3000, 7),       choke_key(4000, 1, -1), choke_key(5000, -1, 67)};
  Journal journal;
  journal.end = kFrames;
  journal.banks.push_back({"scene.toml", {{"scene.toml", std::string(kPlain)}}, {}});
  for (const Event& event : events) {
    JournalRecord record;
    record.time = event.time();
    record.kind = event.kind;
    std::copy_n(event.midi.bytes, 3, record.bytes);
    record.note = event.note;
    record.every_channel = event.every_channel;
    journal.records.push_back(record);
  }
  const std::string text = write_journal(journal);
  for (const char* const line :
       {"\n3000 choke note 7\n", "\n4000 choke 2 every\n", "\n5000 choke every 67\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << text;
  }
  const auto read = read_journal(text, "take.journal");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(rendered(kPlain, journal_events(*read)), rendered(kPlain, events));
}

}  // namespace
}  // namespace knotwave::engine

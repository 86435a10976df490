// SPDX-License-Identifier: MIT
// Notes that a CLAP host numbers, bends and modulates one by one, against the engine that is told
// the same as events.
#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/journal.h"
#include "knotwave/engine/map_slots.h"
#include "knotwave/plugins/instrument.h"

#include "clap_host.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using engine::Event;
using plugins::Instrument;

constexpr std::size_t kFrames = 24000, kBlock = 480;

const ClapLibrary& library() {
  static const ClapLibrary opened(KNOTWAVE_BIN_DIR "/../plugins/clap/knotwave.clap");
  return opened;
}
std::unique_ptr<ClapPlugin> instrument() {
  auto made = std::make_unique<ClapPlugin>(library().factory(), "org.knotwave.instrument");
  EXPECT_TRUE(made->start(48000, 4096));
  return made;
}
clap_id cutoff() { return Instrument::table()[Instrument::table().of_word("cutoff")].id; }

Event note_event(std::int64_t sample, int status, int channel, int key, std::int32_t note) {
  Event event;
  event.midi.time.sample = sample;
  event.midi.bytes[0] = static_cast<std::uint8_t>(status | channel);
  event.midi.bytes[1] = static_cast<std::uint8_t>(key);
  event.midi.bytes[2] = 100;
  event.note = note;
  return event;
}
Event said(std::int64_t sample, std::int32_t note, int slot, double number, bool is_expression) {
  Event event;
  event.kind = Event::Kind::set_note;
  event.midi.time.sample = sample;
  event.midi.bytes[1] = Event::kEveryKey;
  event.every_channel = true;
  event.note = note;
  event.slot = static_cast<std::uint16_t>(slot);
  event.number = number;
  event.is_expression = is_expression;
  return event;
}

StereoSound rendered(const std::vector<Event>& events) {
  Instrument instrument;
  EXPECT_TRUE(instrument.activate(48000));
  StereoSound sound{std::vector<float>(kFrames), std::vector<float>(kFrames)};
  instrument.begin(sound.left, sound.right);
  for (const Event& event : events) instrument.add(event);
  instrument.render();
  return sound;
}

constexpr double kVelocity = 100 / 127.0;

TEST(ClapNotes, AreExpressedAndModulatedOneByOneToTheBit) {
  const std::vector<ClapEvent> told = {
      clap_numbered(0, CLAP_EVENT_NOTE_ON, 11, 0, 60, kVelocity),
      clap_numbered(0, CLAP_EVENT_NOTE_ON, 12, 0, 60, kVelocity),
      clap_expression(0, CLAP_NOTE_EXPRESSION_TUNING, 11, -1, -1, 0.25),
      clap_expression(3000, CLAP_NOTE_EXPRESSION_PAN, 12, -1, -1, 1),
      clap_expression(4001, CLAP_NOTE_EXPRESSION_VOLUME, 11, -1, -1, 0.5),
      clap_modulation(5000, cutoff(), 12, -1, -1, 12),
      clap_expression(6000, CLAP_NOTE_EXPRESSION_EXPRESSION, 12, -1, -1, 0.5),
      clap_expression(7000, CLAP_NOTE_EXPRESSION_PRESSURE, 12, -1, -1, 0.5),
      clap_expression(8000, CLAP_NOTE_EXPRESSION_BRIGHTNESS, 11, -1, -1, 0.75),
      clap_expression(9000, CLAP_NOTE_EXPRESSION_VIBRATO, 11, -1, -1, 1),
      clap_numbered(12000, CLAP_EVENT_NOTE_OFF, 12, -1, -1, kVelocity),
  };
  std::vector<Event> same = {
      note_event(0, 0x90, 0, 60, 11),
      note_event(0, 0x90, 0, 60, 12),
      said(0, 11, engine::kSlotPitch, 0.25, true),
      said(3000, 12, engine::kSlotPan, 0.5, true),
      said(4001, 11, engine::kSlotAmp, -6.0205999132796239, true),
      said(5000, 12, engine::kSlotCutoff, 12, false),
      said(6000, 12, engine::kSlotGain, -0.75, true),
      said(7000, 12, Event::kNotePressure, 0.5, true),
      said(8000, 11, Event::kNoteTimbre, 0.75, true),
  };
  for (int channel = 0; channel < 16; ++channel) {
    same.push_back(note_event(12000, 0x80, channel, 0, 12));
  }
  const StereoSound played = instrument()->play(told, kFrames, kBlock);
  EXPECT_EQ(played, rendered(same));
  EXPECT_NE(played, rendered({same[0], same[1]}));
}

TEST(ClapNotes, OfAKeyAreReachedByChannelAndKey) {
  const std::vector<ClapEvent> told = {
      clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, kVelocity),
      clap_note(0, CLAP_EVENT_NOTE_ON, 0, 64, kVelocity),
      clap_expression(3000, CLAP_NOTE_EXPRESSION_VOLUME, -1, 0, 60, 0),
  };
  const StereoSound played = instrument()->play(told, kFrames, kBlock);
  const StereoSound left = rendered({note_event(0, 0x90, 0, 64, -1)});
  for (std::size_t i = 4000; i < kFrames; ++i) ASSERT_NEAR(played.left[i], left.left[i], 1e-7) << i;
}

TEST(ClapNotes, ModulationOfAllAddsToTheParameterAndIsNotKept) {
  const auto modulated = instrument(), automated = instrument();
  std::vector<ClapEvent> one = {clap_note(0, CLAP_EVENT_NOTE_ON, 0, 60, kVelocity),
                                clap_value(0, cutoff(), -4),
                                clap_modulation(2000, cutoff(), -1, -1, -1, -8)};
  std::vector<ClapEvent> other = {one[0], one[1], clap_value(2000, cutoff(), -12)};
  EXPECT_EQ(modulated->play(one, kFrames, kBlock), automated->play(other, kFrames, kBlock));
  const auto* parameters = modulated->extension<clap_plugin_params>(CLAP_EXT_PARAMS);
  double value = 0;
  ASSERT_TRUE(parameters->get_value(modulated->get(), cutoff(), &value));
  EXPECT_EQ(value, -4);
}

TEST(ClapNotes, EndAreTold) {
  const auto played = instrument();
  std::multiset<std::int32_t> ended;
  StereoSound out;
  const auto run = [&](const std::vector<ClapEvent>& events) {
    EXPECT_NE(played->process(events, kBlock, out), CLAP_PROCESS_ERROR);
    for (const ClapEvent& event : played->given()) {
      EXPECT_EQ(event.header.type, CLAP_EVENT_NOTE_END);
      EXPECT_LT(event.header.time, kBlock);
      EXPECT_EQ(event.note.key, 48 + event.note.note_id);
      ended.insert(event.note.note_id);
    }
  };
  std::vector<ClapEvent> ons, offs;
  for (int i = 0; i < 8; ++i) {
    ons.push_back(clap_numbered(0, CLAP_EVENT_NOTE_ON, i, 0, 48 + i, kVelocity));
    offs.push_back(clap_numbered(0, CLAP_EVENT_NOTE_OFF, i, 0, 48 + i, 0));
  }
  run(ons);
  for (int i = 0; i < 20; ++i) run({});
  EXPECT_TRUE(ended.empty());
  run(offs);
  for (int i = 0; i < 3000 && ended.size() < 8; ++i) run({});
  EXPECT_EQ(ended, (std::multiset<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

// Chokes.

constexpr std::uint32_t kCut = 12000;
constexpr std::size_t kFade = 240;  // 5 ms

TEST(ClapNotes, AChokeCutsTheNotesItMeansAtOnceWhateverThePedalHolds) {
  const ClapEvent pedal = clap_midi(0, 0xB0, engine::kSustain, 127);
  const ClapEvent one = clap_numbered(0, CLAP_EVENT_NOTE_ON, 5, 0, 60, kVelocity);
  const ClapEvent two = clap_numbered(0, CLAP_EVENT_NOTE_ON, 6, 0, 60, kVelocity);
  const ClapEvent three = clap_note(0, CLAP_EVENT_NOTE_ON, 1, 64, kVelocity);
  const auto left_of = [&](std::int32_t note, int channel, int key,
                           const std::vector<ClapEvent>& rest) {
    const ClapEvent choke = clap_numbered(kCut, CLAP_EVENT_NOTE_CHOKE, note, channel, key, 0);
    const auto plugin = instrument(), other = instrument();
    const StereoSound cut = plugin->play({pedal, one, two, three, choke}, kFrames, kBlock);
    const StereoSound expected = other->play(rest, kFrames, kBlock);
    for (std::size_t i = kCut + kFade + 1; i < kFrames; ++i) {
      ASSERT_NEAR(cut.left[i], expected.left[i], 1e-7) << i;
    }
  };
  left_of(5, -1, -1, {pedal, two, three});
  left_of(5, 0, 60, {pedal, two, three});
  left_of(-1, 0, 60, {pedal, three});
  left_of(-1, 1, -1, {pedal, one, two});
  left_of(-1, -1, 60, {pedal, three});
  left_of(-1, -1, -1, {});
}

// Ends.

/// A patch as the state of a plugin.
std::string state_of(const std::string& lines) {
  engine::Journal journal;
  const std::string text = "format = 1\nkind = \"patch\"\n" + lines + R"(
name = "Test"
[curves.gate]
degree = 2
points = [0, 1, 1, 1, 0, 0]
knots = [0,0,0, 0.01,0.01, 0.035, 0.06,0.06,0.06]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.06
)";
  const bool is_held = lines.find("struck") == std::string::npos;
  const std::string held = is_held ? "sustain_at = 0.01\nrelease_at = 0.01\n" : "";
  journal.banks.push_back({"test.toml", {{"test.toml", text + held}}, {}});
  return engine::write_journal(journal);
}

/// What a host keeps of its notes: a voice from NOTE_ON to NOTE_END.
class VoicesOfAHost {
 public:
  explicit VoicesOfAHost(ClapPlugin& plugin) : plugin_(plugin) {}

  void process(const std::vector<ClapEvent>& events, std::size_t frames) {
    for (const ClapEvent& event : events) {
      if (event.header.type == CLAP_EVENT_NOTE_ON) alive_.insert(key_of(event.note));
    }
    StereoSound out;
    ASSERT_NE(plugin_.process(events, frames, out), CLAP_PROCESS_ERROR);
    std::uint32_t last = 0;
    for (const ClapEvent& event : plugin_.given()) {
      ASSERT_EQ(event.header.type, CLAP_EVENT_NOTE_END);
      ASSERT_LT(event.header.time, frames);
      ASSERT_GE(event.header.time, last);
      last = event.header.time;
      const auto found = alive_.find(key_of(event.note));
      ASSERT_NE(found, alive_.end()) << "note " << event.note.note_id << " on key "
                                     << event.note.key << " ended without having begun, or twice";
      alive_.erase(found);
    }
  }
  void forget() { alive_.clear(); }
  std::size_t count() const { return alive_.size(); }

 private:
  using Key = std::tuple<std::int32_t, std::int16_t, std::int16_t>;
  static Key key_of(const clap_event_note& note) { return {note.note_id, note.channel, note.key}; }

  ClapPlugin& plugin_;
  std::multiset<Key> alive_;
};

/// Any event of notes or pedals that a host may send.
class Storm {
 public:
  explicit Storm(std::uint64_t seed) : random_{seed, 0, 5517} {}

  int draw(int below) { return static_cast<int>(random_.unit(draw_++) * below); }
  ClapEvent next(std::uint32_t at) {
    const int channel = draw(2), key = 60 + draw(5), kind = draw(24);
    if (kind < 10) {
      const std::int32_t note = draw(3) == 0 ? -1 : next_++;
      return clap_numbered(at, CLAP_EVENT_NOTE_ON, note, channel, key, draw(3) / 2.0);
    }
    const std::int32_t note = draw(2) == 0 ? -1 : std::max(next_ - 1 - draw(9), 0);
    const int any_channel = draw(4) == 0 ? -1 : channel, any_key = draw(4) == 0 ? -1 : key;
    if (kind < 19) return clap_numbered(at, CLAP_EVENT_NOTE_OFF, note, any_channel, any_key, 0.5);
    if (kind < 22) return clap_numbered(at, CLAP_EVENT_NOTE_CHOKE, note, any_channel, any_key, 0);
    return clap_midi(at, 0xB0 | channel, engine::kSustain, 127 * draw(2));
  }

 private:
  base::RandomStream random_;
  std::uint64_t draw_ = 0;
  std::int32_t next_ = 0;
};

std::vector<ClapEvent> everything_up() {
  std::vector<ClapEvent> events;
  for (int channel = 0; channel < 16; ++channel) {
    events.push_back(clap_midi(0, 0xB0 | channel, engine::kSustain, 0));
  }
  events.push_back(clap_note(0, CLAP_EVENT_NOTE_OFF, -1, -1, 0));
  return events;
}

TEST(ClapNotes, AreEndedOnceEachWhateverTheHostSends) {
  const std::string states[] = {state_of(""), state_of("mode = \"mono\""),
                                state_of("mode = \"legato\"\npriority = \"high\""),
                                state_of("mode = \"mono\" # struck"), state_of("polyphony = 2")};
  Storm storm(support::test_seed());
  const auto plugin = instrument();
  VoicesOfAHost host(*plugin);
  const int blocks = support::test_count(1500);
  for (int block = 0; block < blocks; ++block) {
    SCOPED_TRACE("block " + std::to_string(block));
    if (storm.draw(20) == 0) {
      ASSERT_TRUE(plugin->load(states[storm.draw(5)]));
    }
    if (storm.draw(200) == 0) {  // it kills every voice
      (*plugin)->reset(plugin->get());
      host.forget();
    }
    const auto frames = static_cast<std::size_t>(1 + storm.draw(storm.draw(3) == 0 ? 4000 : 300));
    std::vector<ClapEvent> events;
    for (int i = storm.draw(7); i > 0; --i) {
      events.push_back(
          storm.next(static_cast<std::uint32_t>(storm.draw(static_cast<int>(frames)))));
    }
    std::stable_sort(events.begin(), events.end(), [](const ClapEvent& a, const ClapEvent& b) {
      return a.header.time < b.header.time;
    });
    host.process(events, frames);
    if (HasFatalFailure()) return;
  }
  host.process(everything_up(), 480);
  for (int i = 0; i < 20; ++i) host.process({}, 480);
  EXPECT_EQ(host.count(), 0U);
}

TEST(ClapNotes, AreEndedOnceEachWhereABlockHasMoreEventsThanThereIsRoomFor) {
  constexpr int kNotes = 5 * static_cast<int>(Instrument::kEventsAtOnce) / 2;
  const auto plugin = instrument();
  ASSERT_TRUE(plugin->load(state_of("mode = \"mono\"")));
  VoicesOfAHost host(*plugin);
  for (const std::uint32_t spread : {1U, 20U}) {  // the last sample alone, and the last 20
    std::vector<ClapEvent> events;
    for (int i = 0; i < kNotes / 2; ++i) {
      const auto at = static_cast<std::uint32_t>(
          kBlock - spread + static_cast<std::uint32_t>(i) * spread / (kNotes / 2));
      events.push_back(clap_numbered(at, CLAP_EVENT_NOTE_ON, i, i % 16, 36 + i % 61, kVelocity));
      events.push_back(clap_numbered(at, CLAP_EVENT_NOTE_OFF, i, i % 16, 36 + i % 61, 0));
    }
    host.process(events, kBlock);
    for (int i = 0; i < 20 && !HasFatalFailure(); ++i) host.process({}, kBlock);
    EXPECT_EQ(host.count(), 0U) << spread;
  }
}

}  // namespace
}  // namespace knotwave::test

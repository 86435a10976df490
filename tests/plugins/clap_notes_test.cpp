// SPDX-License-Identifier: MIT
// Notes that a CLAP host numbers, bends and modulates one by one, against the engine that is told
// the same as events.
#include <algorithm>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "knotwave/engine/map_slots.h"
#include "knotwave/plugins/instrument.h"

#include "clap_host.h"

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

}  // namespace
}  // namespace knotwave::test

// SPDX-License-Identifier: MIT
// What is held down or set by a performance: by a cable, and for a start anew.
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "held_state.h"
#include "port_notes.h"
#include "resume.h"

namespace knotwave::synth {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Bytes = std::vector<int>;

engine::JournalRecord record(int a, int b, int c) {
  engine::JournalRecord record;
  record.bytes[0] = static_cast<std::uint8_t>(a);
  record.bytes[1] = static_cast<std::uint8_t>(b);
  record.bytes[2] = static_cast<std::uint8_t>(c);
  return record;
}

std::vector<Bytes> messages_of(const HeldState& state) {
  std::vector<Bytes> messages;
  for (const auto& m : state.messages()) messages.push_back({m.bytes[0], m.bytes[1], m.bytes[2]});
  return messages;
}

std::vector<Bytes> after(const std::vector<Bytes>& played) {
  HeldState state;
  for (const Bytes& bytes : played) state.add(record(bytes[0], bytes[1], bytes[2]));
  return messages_of(state);
}

TEST(HeldState, IsTheLastOfEachControllerAndTheKeysThatAreDown) {
  EXPECT_THAT(after({{0x90, 60, 90}, {0x90, 64, 80}, {0x80, 60, 0}, {0xB0, 7, 50}, {0xB0, 7, 90}}),
              ElementsAre(Bytes{0xB0, 7, 90}, Bytes{0x90, 64, 80}));
  EXPECT_THAT(after({{0x90, 60, 90}, {0x90, 60, 0}}), IsEmpty()) << "velocity 0 is a note-off";
}

TEST(HeldState, BanksComeBeforeProgramsAndAllBeforeNotes) {
  EXPECT_THAT(after({{0x92, 60, 90}, {0xB2, 0, 1}, {0xC2, 5, 0}, {0xE2, 0, 80}, {0xD2, 9, 0}}),
              ElementsAre(Bytes{0xB2, 0, 1}, Bytes{0xC2, 5, 0}, Bytes{0xE2, 0, 80},
                          Bytes{0xD2, 9, 0}, Bytes{0x92, 60, 90}));
}

TEST(HeldState, RegisteredParametersAreSetAgainAsTheyWere) {
  EXPECT_THAT(after({{0xB0, 101, 0}, {0xB0, 100, 0}, {0xB0, 6, 12}, {0xB0, 38, 3}}),
              ElementsAre(Bytes{0xB0, 101, 0}, Bytes{0xB0, 100, 0}, Bytes{0xB0, 6, 12},
                          Bytes{0xB0, 38, 3}));
}

TEST(HeldState, WhatEndsNotesEndsThemHere) {
  for (const int controller : {120, 123, 124, 125, 126, 127}) {
    EXPECT_THAT(after({{0x90, 60, 90}, {0xB0, controller, 0}}), IsEmpty()) << controller;
  }
  HeldState state;
  state.add(record(0x95, 60, 90));
  engine::JournalRecord off;
  off.kind = engine::Event::Kind::all_notes_off;
  state.add(off);
  EXPECT_THAT(messages_of(state), IsEmpty());
}

TEST(HeldState, ResetControllersKeepsVolumePanAndBank) {
  EXPECT_THAT(after({{0xB0, 7, 90}, {0xB0, 1, 5}, {0xB0, 64, 127}, {0xE0, 0, 0}, {0xB0, 121, 0}}),
              ElementsAre(Bytes{0xB0, 7, 90}));
}

TEST(HeldState, TargetsAndTempoComeBackAsText) {
  HeldState state;
  engine::JournalRecord target = record(3, 0, 0);
  target.kind = engine::Event::Kind::set_target;
  target.index = 17;
  target.number = -0.1;
  state.add(target);
  engine::JournalRecord tempo;
  tempo.kind = engine::Event::Kind::tempo;
  tempo.number = 500000;
  state.add(tempo);
  state.add(record(0x93, 60, 90));
  const auto again = messages_in(text_of(state.messages()));
  ASSERT_EQ(again.size(), 3u);
  using Kind = engine::LiveMessage::Kind;
  EXPECT_EQ(again[0].kind, Kind::tempo);
  EXPECT_EQ(again[0].number, 500000);
  EXPECT_EQ(again[2].kind, Kind::midi);
  EXPECT_EQ(again[2].bytes[1], 60);
  EXPECT_EQ(again[1].kind, Kind::set_target);
  EXPECT_EQ(again[1].index, 17);
  EXPECT_EQ(again[1].number, -0.1) << "every digit";
  EXPECT_EQ(again[1].bytes[0], 3);
}

TEST(HeldState, WordsThatAreNoMessagesAreLeftOut) {
  EXPECT_THAT(messages_in(""), IsEmpty());
  EXPECT_THAT(messages_in("x\n0 1 2\n9 144 60 90 0 0\n0 144 -60 90 0 0\n0 144 60 90 0 nan\n"),
              IsEmpty());
}

TEST(Resume, ComesBackThroughTheEnvironmentAndLeavesItClean) {
  Resume resume;
  resume.patch = "a b/\xff.toml";
  resume.demo_file = "/patches/bell.toml";
  resume.program_entry = 7;
  resume.song_s = 1.0 / 3;
  resume.takes = 2;
  resume.api = "alsa";
  resume.rate_hz = 44100;
  leave_resume(resume);
  const Resume again = take_resume();
  EXPECT_EQ(again.patch, resume.patch);
  EXPECT_EQ(again.demo_file, resume.demo_file);
  EXPECT_EQ(again.program_entry, 7);
  EXPECT_EQ(again.song_s, 1.0 / 3) << "every digit";
  EXPECT_EQ(again.takes, 2);
  EXPECT_EQ(again.api, "alsa");
  EXPECT_EQ(again.rate_hz, 44100);
  EXPECT_FALSE(again.is_first_start());
  const Resume first = take_resume();
  EXPECT_TRUE(first.is_first_start());
  EXPECT_TRUE(first.patch.empty() && first.demo_file.empty());
  EXPECT_LT(first.song_s, 0);
}

base::MidiEvent event(int a, int b, int c) {
  base::MidiEvent event;
  event.bytes[0] = static_cast<std::uint8_t>(a);
  event.bytes[1] = static_cast<std::uint8_t>(b);
  event.bytes[2] = static_cast<std::uint8_t>(c);
  return event;
}

std::vector<Bytes> released(PortNotes& notes) {
  std::vector<Bytes> messages;
  notes.release([&](int a, int b, int c) { messages.push_back({a, b, c}); });
  return messages;
}

TEST(PortNotes, EndWhatTheCableHeldAndNothingElse) {
  PortNotes notes;
  for (const auto& heard :
       {event(0x90, 0, 1), event(0x9F, 127, 1), event(0x90, 64, 1), event(0x90, 64, 0),
        event(0xB3, 64, 127), event(0xB3, 66, 127), event(0xB3, 66, 0), event(0xB3, 1, 127)}) {
    notes.heard(heard);
  }
  EXPECT_THAT(released(notes),
              ElementsAre(Bytes{0x80, 0, 64}, Bytes{0xB3, 64, 0}, Bytes{0x8F, 127, 64}));
  EXPECT_THAT(released(notes), IsEmpty()) << "once";
}

}  // namespace
}  // namespace knotwave::synth

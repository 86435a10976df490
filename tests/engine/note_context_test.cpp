// SPDX-License-Identifier: MIT
#include "note_context.h"

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

struct Player {
  ChannelState member, master;
  NoteContext note;
  Player() {
    note.channel = &member;
    note.master = &master;
  }
};

TEST(NoteContext, SourcesReadWhatThePlayerDoes) {
  Player player;
  player.note.master = &player.member;
  player.note.velocity = 127;
  player.note.release_velocity = 0;
  player.note.note = 72;
  player.member.control_change(1, 127);
  player.member.channel_pressure(127);
  EXPECT_EQ(source_value(player.note, MapSource::constant, 0), 1.0);
  EXPECT_EQ(source_value(player.note, MapSource::velocity, 0), 1.0);
  EXPECT_EQ(source_value(player.note, MapSource::release_velocity, 0), 0.0);
  EXPECT_EQ(source_value(player.note, MapSource::key, 0), 72 / 127.0);
  EXPECT_EQ(source_value(player.note, MapSource::key_octaves, 0), 1.0);
  EXPECT_EQ(source_value(player.note, MapSource::control, 1), 1.0);
  EXPECT_EQ(source_value(player.note, MapSource::channel_pressure, 0), 1.0);
}

TEST(NoteContext, PressureIsTheLargerOfChannelKeyAndMaster) {
  Player player;
  player.note.key = 60;
  player.member.poly_pressure(60, 127);
  player.member.poly_pressure(61, 3);
  player.master.channel_pressure(64);
  EXPECT_EQ(source_value(player.note, MapSource::pressure, 0), 1.0);
  EXPECT_EQ(source_value(player.note, MapSource::poly_pressure, 0), 1.0);
  EXPECT_EQ(source_value(player.note, MapSource::channel_pressure, 0), 64 / 127.0);
}

TEST(NoteContext, TimbreIsTheNotesOwnOnceItWasSent) {
  Player player;
  player.master.control_change(kTimbre, 100);
  EXPECT_EQ(source_value(player.note, MapSource::timbre, 0), 100 / 127.0);
  player.member.control_change(kTimbre, 7);
  EXPECT_EQ(source_value(player.note, MapSource::timbre, 0), 7 / 127.0);
}

TEST(NoteContext, UnderMpeTheNotesBendAndTheZonesBendAddUp) {
  Player player;
  player.member.pitch_bend(127, 127);
  player.master.pitch_bend(0, 0);
  EXPECT_EQ(bend_semitones(player.note, 12), 48.0 - 2.0);
  player.note.master = &player.member;  // not under MPE: the patch's own range
  EXPECT_EQ(bend_semitones(player.note, 12), 12.0);
}

TEST(NoteContext, RandomIsOneNumberANote) {
  Player player;
  player.note.random = {5, 1, base::kRandomMap};
  const double first = source_value(player.note, MapSource::random, 0);
  EXPECT_EQ(source_value(player.note, MapSource::random, 0), first);
  player.note.random.voice = 2;
  EXPECT_NE(source_value(player.note, MapSource::random, 0), first);
}

}  // namespace
}  // namespace knotwave::engine

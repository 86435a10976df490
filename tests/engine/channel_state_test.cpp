// SPDX-License-Identifier: MIT
#include "knotwave/engine/channel_state.h"

#include <cmath>

#include <gtest/gtest.h>

namespace knotwave::engine {
namespace {

using Effect = ChannelState::Effect;

void select_rpn(ChannelState& channel, int number) {
  channel.control_change(kRpnMsb, number >> 7);
  channel.control_change(kRpnLsb, number & 127);
}

TEST(ChannelState, PowerOnValuesAreThoseOfGeneralMidi) {
  const ChannelState channel;
  EXPECT_EQ(channel.control(kVolume), 100 / 127.0);
  EXPECT_EQ(channel.control(kExpression), 1.0);
  EXPECT_EQ(channel.pan_position(), 0.5);
  EXPECT_EQ(channel.bend(), 0.0);
  EXPECT_EQ(channel.bend_range_semitones(2), 2.0);
  EXPECT_EQ(channel.tuning_semitones(), 0.0);
  EXPECT_EQ(channel.program(), 0);
  EXPECT_FALSE(channel.sustain());
}

TEST(ChannelState, VolumeFollowsFortyLogTen) {
  ChannelState channel;
  for (const int value : {1, 32, 64, 100, 127}) {
    channel.control_change(kVolume, value);
    EXPECT_NEAR(20 * std::log10(channel.volume_gain()), 40 * std::log10(value / 127.0), 1e-9);
  }
  channel.control_change(kVolume, 0);
  EXPECT_EQ(channel.volume_gain(), 0.0);
}

TEST(ChannelState, VolumeAndExpressionMultiply) {
  ChannelState channel;
  channel.control_change(kVolume, 127);
  channel.control_change(kExpression, 64);
  EXPECT_NEAR(channel.volume_gain(), (64 / 127.0) * (64 / 127.0), 1e-15);
}

TEST(ChannelState, PanReachesBothEndsAndTheExactCentre) {
  ChannelState channel;
  const auto at = [&](int value) {
    channel.control_change(kPan, value);
    return channel.pan_position();
  };
  EXPECT_EQ(at(0), 0.0);
  EXPECT_EQ(at(1), 0.0);
  EXPECT_EQ(at(64), 0.5);
  EXPECT_EQ(at(127), 1.0);
}

TEST(ChannelState, AControllerHasFourteenBitsOnceItsFineHalfWasHeard) {
  ChannelState channel;
  channel.control_change(1, 127);
  EXPECT_EQ(channel.control(1), 1.0);
  channel.control_change(1, 64);
  channel.control_change(33, 5);
  EXPECT_EQ(channel.control(1), (64 * 128 + 5) / 16383.0);
  channel.control_change(33, 127);
  channel.control_change(1, 127);  // a coarse value sets the fine half to 0
  EXPECT_EQ(channel.control(1), 127 * 128 / 16383.0);
  channel.control_change(33, 127);
  EXPECT_EQ(channel.control(1), 1.0);
}

TEST(ChannelState, BendIsExactAtBothEndsAndTheCentre) {
  ChannelState channel;
  channel.pitch_bend(0, 0);
  EXPECT_EQ(channel.bend(), -1.0);
  channel.pitch_bend(127, 127);
  EXPECT_EQ(channel.bend(), 1.0);
  channel.pitch_bend(0, 64);
  EXPECT_EQ(channel.bend(), 0.0);
}

TEST(ChannelState, BendRangeIsSetBySemitonesAndCents) {
  ChannelState channel;
  select_rpn(channel, 0);
  channel.control_change(kDataEntryMsb, 12);
  EXPECT_EQ(channel.bend_range_semitones(2), 12.0);
  channel.control_change(kDataEntryLsb, 50);
  EXPECT_EQ(channel.bend_range_semitones(2), 12.5);
}

TEST(ChannelState, CentsAndStepsStartFromTheRangeInForce) {
  ChannelState cents, up, down;
  for (ChannelState* channel : {&cents, &up, &down}) select_rpn(*channel, 0);
  EXPECT_EQ(cents.control_change(kDataEntryLsb, 50, 12), Effect::bend_range);
  EXPECT_EQ(cents.bend_range_semitones(12), 12.5);
  EXPECT_EQ(up.control_change(kDataIncrement, 0, 48), Effect::bend_range);
  EXPECT_EQ(up.bend_range_semitones(48), 48.01);
  EXPECT_EQ(down.control_change(kDataDecrement, 0, 12.25), Effect::bend_range);
  EXPECT_EQ(down.bend_range_semitones(12.25), 12.24);
  for (int i = 0; i < 1300; ++i) down.control_change(kDataDecrement, 0);
  EXPECT_EQ(down.bend_range_semitones(12.25), 0.0);
}

TEST(ChannelState, DataIncrementStepsBendRangeByCentsAndCoarseTuningBySemitones) {
  ChannelState channel;
  select_rpn(channel, 0);
  channel.control_change(kDataEntryMsb, 2);
  for (int i = 0; i < 101; ++i) channel.control_change(kDataIncrement, 0);
  EXPECT_NEAR(channel.bend_range_semitones(2), 3.01, 1e-12);
  channel.control_change(kDataDecrement, 0);
  EXPECT_NEAR(channel.bend_range_semitones(2), 3.00, 1e-12);
  select_rpn(channel, 2);
  channel.control_change(kDataDecrement, 0);
  EXPECT_EQ(channel.tuning_semitones(), -1.0);
  select_rpn(channel, 1);
  channel.control_change(kDataIncrement, 0);
  EXPECT_EQ(channel.tuning_semitones(), -1.0 + 1 / 8192.0);
}

TEST(ChannelState, FineTuningSpansASemitoneEitherWay) {
  ChannelState channel;
  select_rpn(channel, 1);
  channel.control_change(kDataEntryMsb, 0);
  EXPECT_EQ(channel.tuning_semitones(), -1.0);
  channel.control_change(kDataEntryMsb, 127);
  channel.control_change(kDataEntryLsb, 127);
  EXPECT_EQ(channel.tuning_semitones(), 8191 / 8192.0);
}

TEST(ChannelState, TheNullParameterAndUnregisteredOnesTakeNoData) {
  ChannelState channel;
  select_rpn(channel, 0);
  select_rpn(channel, 0x3FFF);
  channel.control_change(kDataEntryMsb, 24);
  EXPECT_EQ(channel.bend_range_semitones(2), 2.0);
  select_rpn(channel, 0);
  channel.control_change(kNrpnMsb, 0);
  channel.control_change(kNrpnLsb, 0);
  channel.control_change(kDataEntryMsb, 24);
  channel.control_change(kDataIncrement, 0);
  EXPECT_EQ(channel.bend_range_semitones(2), 2.0);
}

TEST(ChannelState, ABankTakesEffectWithTheNextProgram) {
  ChannelState channel;
  channel.control_change(kBankMsb, 3);
  channel.control_change(kBankLsb, 7);
  EXPECT_EQ(channel.bank_msb(), 0);
  channel.program_change(42);
  EXPECT_EQ(channel.program(), 42);
  EXPECT_EQ(channel.bank_msb(), 3);
  EXPECT_EQ(channel.bank_lsb(), 7);
}

TEST(ChannelState, ResetAllControllersKeepsVolumePanBankProgramAndTuning) {
  ChannelState channel;
  select_rpn(channel, 2);
  channel.control_change(kDataEntryMsb, 66);
  channel.control_change(kVolume, 12);
  channel.control_change(kPan, 1);
  channel.control_change(kTimbre, 99);
  channel.program_change(5);
  channel.control_change(1, 90);
  channel.control_change(kExpression, 3);
  channel.control_change(kSustain, 127);
  channel.control_change(kSostenuto, 127);
  channel.control_change(kSoft, 127);
  channel.pitch_bend(1, 2);
  channel.channel_pressure(9);
  channel.poly_pressure(60, 9);
  EXPECT_EQ(channel.control_change(kResetControllers, 0), Effect::pedals);
  EXPECT_EQ(channel.control(1), 0.0);
  EXPECT_EQ(channel.control(kExpression), 1.0);
  EXPECT_FALSE(channel.sustain() || channel.sostenuto() || channel.soft());
  EXPECT_EQ(channel.bend(), 0.0);
  EXPECT_EQ(channel.pressure(), 0.0);
  EXPECT_EQ(channel.poly_pressure(60), 0.0);
  channel.control_change(kDataEntryMsb, 70);  // the selection is null again
  EXPECT_EQ(channel.tuning_semitones(), 2.0);
  EXPECT_EQ(channel.control(kVolume), 12 / 127.0);
  EXPECT_EQ(channel.pan_position(), 0.0);
  EXPECT_EQ(channel.control(kTimbre), 99 / 127.0);
  EXPECT_EQ(channel.program(), 5);
}

TEST(ChannelState, ChannelModeMessagesAskForWhatTheySay) {
  ChannelState channel;
  EXPECT_EQ(channel.control_change(kAllSoundOff, 0), Effect::all_sound_off);
  for (const int mode : {123, 124, 125}) {
    EXPECT_EQ(channel.control_change(mode, 0), Effect::all_notes_off) << mode;
  }
  EXPECT_EQ(channel.note_mode(), ChannelState::NoteMode::as_patch);
  EXPECT_EQ(channel.control_change(kMonoOn, 4), Effect::note_mode);
  EXPECT_EQ(channel.note_mode(), ChannelState::NoteMode::mono);
  EXPECT_EQ(channel.mono_channels(), 4);
  EXPECT_EQ(channel.control_change(kPolyOn, 0), Effect::note_mode);
  EXPECT_EQ(channel.note_mode(), ChannelState::NoteMode::poly);
  EXPECT_EQ(channel.mono_channels(), 1);
  EXPECT_EQ(channel.control_change(kSustain, 127), Effect::pedals);
  EXPECT_EQ(channel.control_change(kSostenuto, 0), Effect::pedals);
  EXPECT_EQ(channel.control_change(1, 3), Effect::none);
  select_rpn(channel, 6);
  EXPECT_EQ(channel.control_change(kDataEntryMsb, 7), Effect::mpe_zone);
  EXPECT_EQ(channel.mpe_members(), 7);
}

TEST(ChannelState, PortamentoTimeIsFiveSecondsTimesTheCube) {
  ChannelState channel;
  EXPECT_EQ(channel.portamento_seconds(0.3), 0.3);
  channel.control_change(kPortamentoTime, 127);
  EXPECT_EQ(channel.portamento_seconds(0.3), 5.0);
  channel.control_change(kPortamentoTime, 0);
  EXPECT_EQ(channel.portamento_seconds(0.3), 0.0);
  channel.control_change(kPortamentoTime, 64);
  EXPECT_NEAR(channel.portamento_seconds(0.3), 0.6399, 1e-4);
  channel.control_change(kPortamentoTime + 32, 1);  // 14 bits now
  const double place = (64 * 128 + 1) / 16383.0;
  EXPECT_NEAR(channel.portamento_seconds(0.3), 5 * place * place * place, 1e-15);
}

TEST(ChannelState, ResetAllControllersTakesBackPortamentoButNeitherItsTimeNorTheNoteMode) {
  ChannelState channel;
  EXPECT_EQ(channel.portamento(), ChannelState::Portamento::as_patch);
  channel.control_change(kPortamento, 64);
  EXPECT_EQ(channel.portamento(), ChannelState::Portamento::on);
  channel.control_change(kPortamento, 63);
  EXPECT_EQ(channel.portamento(), ChannelState::Portamento::off);
  channel.control_change(kPortamentoTime, 127);
  channel.control_change(kPortamentoControl, 60);
  channel.control_change(kMonoOn, 1);
  channel.control_change(kResetControllers, 0);
  EXPECT_EQ(channel.portamento(), ChannelState::Portamento::as_patch);
  EXPECT_EQ(channel.take_portamento_source(), -1);
  EXPECT_EQ(channel.portamento_seconds(0), 5.0);
  EXPECT_EQ(channel.note_mode(), ChannelState::NoteMode::mono);
  channel.reset();
  EXPECT_EQ(channel.portamento_seconds(0), 0.0);
  EXPECT_EQ(channel.note_mode(), ChannelState::NoteMode::as_patch);
}

TEST(ChannelState, APortamentoSourceIsTakenOnce) {
  ChannelState channel;
  EXPECT_EQ(channel.take_portamento_source(), -1);
  channel.control_change(kPortamentoControl, 0);
  EXPECT_EQ(channel.take_portamento_source(), 0);
  EXPECT_EQ(channel.take_portamento_source(), -1);
}

TEST(ChannelState, BytesAboveSevenBitsAreCut) {
  ChannelState channel;
  channel.control_change(0x80 | 1, 0xFF);
  EXPECT_EQ(channel.control(1), 1.0);
  channel.poly_pressure(0xFF, 0xFF);
  EXPECT_EQ(channel.poly_pressure(127), 1.0);
  channel.pitch_bend(0xFF, 0xFF);
  EXPECT_EQ(channel.bend(), 1.0);
}

}  // namespace
}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Sources: MIDI 1.0 Detailed Specification 4.2.1; MMA RP-015 (reset all controllers), RP-018 (data
// increment and decrement); General MIDI Level 2 (volume law, pan). MIDI 1.0 gives portamento time
// no unit; the cubic is ours.
#include "knotwave/engine/channel_state.h"

#include <algorithm>
#include <cmath>

namespace knotwave::engine {
namespace {

constexpr int kRpnBendRange = 0;
constexpr int kRpnFineTuning = 1;
constexpr int kRpnCoarseTuning = 2;
constexpr int kRpnMpe = 6;
constexpr double kLongestPortamento = 5;  // seconds

}  // namespace

void ChannelState::reset() KNOTWAVE_RT {
  coarse_.fill(0);
  fine_.fill(0);
  has_fine_.fill(false);
  coarse_[kVolume] = 100;
  coarse_[kPan] = 64;
  coarse_[8] = 64;  // balance
  for (std::size_t sound = 70; sound <= 79; ++sound) coarse_[sound] = 64;
  program_ = bank_msb_ = bank_lsb_ = 0;
  bend_range_cents_ = -1;
  fine_tuning_ = 8192;
  coarse_tuning_ = 64;
  mpe_members_ = 0;
  timbre_sent_ = false;
  has_portamento_time_ = false;
  note_mode_ = NoteMode::as_patch;
  mono_channels_ = 1;
  reset_controllers();
}

void ChannelState::reset_controllers() KNOTWAVE_RT {
  for (const int controller : {1, 2, 4}) store(controller, 0);
  for (const int controller : {1, 2, 4, kExpression}) {
    fine_[static_cast<std::size_t>(controller)] = 0;
    has_fine_[static_cast<std::size_t>(controller)] = false;
  }
  coarse_[kExpression] = 127;
  for (int pedal = kSustain; pedal <= 69; ++pedal) store(pedal, 0);
  portamento_ = Portamento::as_patch;
  portamento_source_ = -1;
  poly_pressure_.fill(0);
  channel_pressure_ = 0;
  bend_ = 8192;
  parameter_ = kNoParameter;
  registered_ = true;
}

void ChannelState::store(int controller, int value) KNOTWAVE_RT {
  coarse_[static_cast<std::size_t>(controller)] = static_cast<std::uint8_t>(value);
  if (controller < 32) fine_[static_cast<std::size_t>(controller)] = 0;
}

ChannelState::Effect ChannelState::control_change(int controller, int value,
                                                  double own_bend_range) KNOTWAVE_RT {
  controller &= 127;
  value &= 127;
  switch (controller) {
    case kDataEntryMsb:
      return data_entry(true, value, own_bend_range);
    case kDataEntryLsb:
      return data_entry(false, value, own_bend_range);
    case kDataIncrement:
      return step_data(1, own_bend_range);
    case kDataDecrement:
      return step_data(-1, own_bend_range);
    case kNrpnLsb:
    case kNrpnMsb:
    case kRpnLsb:
    case kRpnMsb:
      select_parameter(controller, value);
      return Effect::none;
    case kAllSoundOff:
      return Effect::all_sound_off;
    case kResetControllers:
      reset_controllers();
      return Effect::pedals;
    case kAllNotesOff:
    case kOmniOff:
    case kOmniOn:
      return Effect::all_notes_off;
    case kMonoOn:
    case kPolyOn:
      note_mode_ = controller == kMonoOn ? NoteMode::mono : NoteMode::poly;
      mono_channels_ = controller == kMonoOn ? value : 1;
      return Effect::note_mode;
    case kTimbre:
      timbre_sent_ = true;
      break;
    case kPortamentoTime:
      has_portamento_time_ = true;
      break;
    case kPortamento:
      portamento_ = value >= 64 ? Portamento::on : Portamento::off;
      break;
    case kPortamentoControl:
      portamento_source_ = value;
      break;
    default:
      break;
  }
  if (controller >= 32 && controller < 64) {
    fine_[static_cast<std::size_t>(controller - 32)] = static_cast<std::uint8_t>(value);
    has_fine_[static_cast<std::size_t>(controller - 32)] = true;
    if (controller - 32 == kPortamentoTime) has_portamento_time_ = true;
    return Effect::none;
  }
  store(controller, value);
  return controller == kSustain || controller == kSostenuto ? Effect::pedals : Effect::none;
}

void ChannelState::select_parameter(int controller, int value) KNOTWAVE_RT {
  const bool high = controller == kNrpnMsb || controller == kRpnMsb;
  registered_ = controller >= kRpnLsb;
  parameter_ = high ? (value << 7) | (parameter_ & 127) : (parameter_ & ~127) | value;
}

int ChannelState::bend_range_cents(double own_bend_range) const KNOTWAVE_RT {
  return bend_range_cents_ >= 0 ? bend_range_cents_
                                : static_cast<int>(std::floor(own_bend_range * 100 + 0.5));
}

ChannelState::Effect ChannelState::data_entry(bool coarse, int value,
                                              double own_bend_range) KNOTWAVE_RT {
  if (!registered_) return Effect::none;
  switch (parameter_) {
    case kRpnBendRange:
      bend_range_cents_ =
          coarse ? value * 100 : bend_range_cents(own_bend_range) / 100 * 100 + std::min(value, 99);
      return Effect::bend_range;
    case kRpnFineTuning:
      fine_tuning_ = coarse ? (value << 7) | (fine_tuning_ & 127) : (fine_tuning_ & ~127) | value;
      break;
    case kRpnCoarseTuning:
      if (coarse) coarse_tuning_ = value;
      break;
    case kRpnMpe:
      if (!coarse) break;
      mpe_members_ = std::min(value, 15);
      return Effect::mpe_zone;
    default:
      break;
  }
  return Effect::none;
}

ChannelState::Effect ChannelState::step_data(int step, double own_bend_range) KNOTWAVE_RT {
  if (!registered_) return Effect::none;
  switch (parameter_) {
    case kRpnBendRange:
      bend_range_cents_ = std::clamp(bend_range_cents(own_bend_range) + step, 0, 12799);
      return Effect::bend_range;
    case kRpnFineTuning:
      fine_tuning_ = std::clamp(fine_tuning_ + step, 0, 16383);
      break;
    case kRpnCoarseTuning:
      coarse_tuning_ = std::clamp(coarse_tuning_ + step, 0, 127);
      break;
    default:
      break;
  }
  return Effect::none;
}

void ChannelState::program_change(int program) KNOTWAVE_RT {
  program_ = program & 127;
  bank_msb_ = coarse_[kBankMsb];
  bank_lsb_ = fine_[kBankMsb];
}

void ChannelState::poly_pressure(int key, int value) KNOTWAVE_RT {
  poly_pressure_[static_cast<std::size_t>(key & 127)] = static_cast<std::uint8_t>(value & 127);
}

double ChannelState::control(int controller) const KNOTWAVE_RT {
  const auto index = static_cast<std::size_t>(controller & 127);
  if (index < 32 && has_fine_[index]) return (coarse_[index] * 128 + fine_[index]) / 16383.0;
  if (index >= 32 && index < 64) return fine_[index - 32] / 127.0;
  return coarse_[index] / 127.0;
}

double ChannelState::portamento_seconds(double fallback) const KNOTWAVE_RT {
  if (!has_portamento_time_) return fallback;
  const double place = control(kPortamentoTime);
  return kLongestPortamento * place * place * place;
}

int ChannelState::take_portamento_source() KNOTWAVE_RT {
  const int source = portamento_source_;
  portamento_source_ = -1;
  return source;
}

double ChannelState::bend() const KNOTWAVE_RT {
  const double offset = bend_ - 8192;
  return offset < 0 ? offset / 8192 : offset / 8191;
}

double ChannelState::tuning_semitones() const KNOTWAVE_RT {
  return (coarse_tuning_ - 64) + (fine_tuning_ - 8192) / 8192.0;
}

double ChannelState::volume_gain() const KNOTWAVE_RT {
  const double both = control(kVolume) * control(kExpression);
  return both * both;
}

double ChannelState::pan_position() const KNOTWAVE_RT {
  const double place = coarse_[kPan] + fine_[kPan] / 128.0;
  return std::clamp((place - 1) / 126, 0.0, 1.0);
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "knotwave/engine/midi_learn.h"

#include <cstdlib>

#include "knotwave/engine/channel_state.h"

#include "learn_check.h"

namespace knotwave::engine {
namespace {

constexpr int kStep = 128;  // of 7 bits, in 14

constexpr std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// The channel a knob speaks on, 0..15, when it was moved on `channel`.
int target_channel(const LearnedKnob& knob, int channel) {
  return knob.to_channel == 0 ? channel : knob.to_channel - 1;
}

MidiLearn::PickUp compare(int position, int in_force) {
  if (position < 0) return MidiLearn::PickUp::unknown;
  if (in_force < 0 || std::abs(position - in_force) <= kStep) return MidiLearn::PickUp::held;
  return position < in_force ? MidiLearn::PickUp::too_low : MidiLearn::PickUp::too_high;
}

/// As ChannelState::reset() has it.
int power_on_value(int controller) {
  switch (controller) {
    case kVolume:
      return 100;
    case kExpression:
      return 127;
    case kPan:
    case kTimbre:
      return 64;
    default:
      return 0;
  }
}

/// Whether a knob that goes from `before` to `now` met `value`.
bool meets(int before, int now, int value) {
  if (value < 0 || std::abs(now - value) <= kStep) return true;
  if (before < 0) return false;
  return std::abs(before - value) <= kStep || (before < value) == (value < now);
}

base::MidiEvent control_change(const base::MidiEvent& like, int channel, int controller,
                               int value) {
  base::MidiEvent event = like;
  event.bytes[0] = static_cast<std::uint8_t>(0xB0 | channel);
  event.bytes[1] = static_cast<std::uint8_t>(controller);
  event.bytes[2] = static_cast<std::uint8_t>(value);
  return event;
}

}  // namespace

bool is_learnable(int controller) KNOTWAVE_RT {
  const bool selects = controller == kBankMsb || controller == kBankLsb ||
                       controller == kDataEntryMsb || controller == kDataEntryLsb ||
                       (controller >= kDataIncrement && controller <= kRpnMsb);
  return controller >= 0 && controller < kAllSoundOff && !selects;
}

Result<MidiLearn> MidiLearn::create(const LearnSpec& spec) {
  if (auto fault = learn_fault(spec)) return fault->error;
  MidiLearn learn;
  learn.about_ = spec.about;
  for (const LearnedKnob& knob : spec.knobs) learn.knobs_[at(learn.size_++)].learned = knob;
  return learn;
}

LearnSpec MidiLearn::spec() {
  LearnSpec spec;
  spec.about = about_;
  for (int i = 0; i < size_; ++i) spec.knobs.push_back(knob(i).learned);
  has_changed_ = false;
  return spec;
}

MidiLearn::Out MidiLearn::translate(const base::MidiEvent& event) KNOTWAVE_RT {
  const int controller = event.bytes[1] & 127;
  const int channel = event.channel();
  if (event.status() != base::MidiStatus::control_change || !is_learnable(controller)) {
    if (event.status() == base::MidiStatus::control_change && controller == kResetControllers) {
      reset_controllers(channel);
    }
    return {1, {event}};
  }
  const bool is_pedal = controller >= 64 && controller <= 69;
  if (learns_ && !is_pedal) {
    catch_moved(event);
    return {};
  }
  if (Knob* knob = knob_from(channel, controller)) return move(*knob, event, false);
  if (controller >= 32 && controller < 64) {
    if (Knob* knob = knob_from(channel, controller - 32)) return move(*knob, event, true);
  }
  heed(event);
  return {1, {event}};
}

MidiLearn::Knob* MidiLearn::knob_from(int channel, int controller) KNOTWAVE_RT {
  Knob* any_channel = nullptr;
  for (int i = 0; i < size_; ++i) {
    Knob& knob = knobs_[at(i)];
    if (knob.learned.from != controller) continue;
    if (knob.learned.from_channel == channel + 1) return &knob;
    if (knob.learned.from_channel == 0) any_channel = &knob;
  }
  return any_channel;
}

MidiLearn::Out MidiLearn::move(Knob& knob, const base::MidiEvent& event, bool is_fine) KNOTWAVE_RT {
  const int value = event.bytes[2] & 127;
  const int channel = target_channel(knob.learned, event.channel());
  const int to = knob.learned.to;
  const bool takes_fine = to < 32;
  if (is_fine && (!takes_fine || knob.position < 0)) return {};
  const int before = knob.position;
  const bool was_held = knob.pick_up == PickUp::held;
  knob.position = is_fine ? (before & ~127) | value : value << 7;
  knob.in_force = in_force_[at(channel)][at(to)];
  if (knob.learned.is_soft && !was_held && !meets(before, knob.position, knob.in_force)) {
    knob.pick_up = compare(knob.position, knob.in_force);
    return {};
  }
  knob.pick_up = PickUp::held;
  in_force_[at(channel)][at(to)] = static_cast<std::int16_t>(knob.position);
  refresh(channel, to);
  Out out;
  if (!is_fine || !was_held) {
    out.messages[at(out.count++)] = control_change(event, channel, to, knob.position >> 7);
  }
  if (is_fine) out.messages[at(out.count++)] = control_change(event, channel, to + 32, value);
  return out;
}

/// A controller that goes through as it is: those who stand for it may have to meet it anew.
void MidiLearn::heed(const base::MidiEvent& event) KNOTWAVE_RT {
  const int controller = event.bytes[1] & 127, value = event.bytes[2] & 127;
  const int channel = event.channel();
  set_in_force(channel, controller, value << 7);
  if (controller < 32 || controller >= 64) return;
  const int coarse = in_force_[at(channel)][at(controller - 32)];
  if (coarse >= 0) set_in_force(channel, controller - 32, (coarse & ~127) | value);
}

void MidiLearn::set_in_force(int channel, int controller, int value) KNOTWAVE_RT {
  if (channel < 0 || channel > 15 || !is_learnable(controller)) return;
  const int cut = value < 0 ? -1 : value > 16383 ? 16383 : value;
  in_force_[at(channel)][at(controller)] = static_cast<std::int16_t>(cut);
  refresh(channel, controller);
}

/// Knobs that stand for a controller whose value changed.
void MidiLearn::refresh(int channel, int controller) KNOTWAVE_RT {
  for (int i = 0; i < size_; ++i) {
    Knob& knob = knobs_[at(i)];
    const bool is_here = knob.learned.to_channel == 0 || knob.learned.to_channel == channel + 1;
    if (knob.learned.to != controller || !is_here) continue;
    knob.in_force = in_force_[at(channel)][at(controller)];
    knob.pick_up = knob.learned.is_soft || knob.position < 0 ? compare(knob.position, knob.in_force)
                                                             : PickUp::held;
  }
}

void MidiLearn::controllers_went_back() KNOTWAVE_RT {
  for (int channel = 0; channel < 16; ++channel) {
    for (int controller = 0; controller < kAllSoundOff; ++controller) {
      if (in_force_[at(channel)][at(controller)] < 0) continue;
      set_in_force(channel, controller, power_on_value(controller) << 7);
    }
  }
}

/// As MMA RP-015 has it, and ChannelState with it.
void MidiLearn::reset_controllers(int channel) KNOTWAVE_RT {
  set_in_force(channel, 1, 0);
  set_in_force(channel, kExpression, 127 << 7);
  for (const int pedal : {kSustain, kSostenuto, kSoft}) set_in_force(channel, pedal, 0);
  set_in_force(channel, kPortamento, -1);
}

bool MidiLearn::learn(int to, int to_channel) KNOTWAVE_RT {
  const bool is_full = size_ == kMaxLearnedKnobs;
  if (!is_learnable(to) || to_channel < 0 || to_channel > 16 || is_full) return false;
  learns_ = true;
  wanted_ = {.to_channel = to_channel, .to = to};
  heard_.fill(kNothing);
  return true;
}

/// A controller some keyboard keeps sending does not move; one that sends two values does.
void MidiLearn::catch_moved(const base::MidiEvent& event) KNOTWAVE_RT {
  const int controller = event.bytes[1] & 127, value = event.bytes[2] & 127;
  const int channel = event.channel();
  std::int16_t& heard = heard_[at(channel)][at(controller)];
  const bool has_moved = heard >= 0 && heard != value;
  heard = static_cast<std::int16_t>(value);
  if (!has_moved) return;
  wanted_.from_channel = channel + 1;
  // The fine half moves more often than its coarse one; together they are one knob.
  const bool is_fine = controller >= 32 && controller < 64 && is_learnable(controller - 32) &&
                       heard_[at(channel)][at(controller - 32)] >= 0;
  wanted_.from = is_fine ? controller - 32 : controller;
  forget(wanted_.to, wanted_.to_channel);
  for (int i = size_ - 1; i >= 0; --i) {
    const LearnedKnob& other = knob(i).learned;
    const bool is_same = other.from_channel == 0 || other.from_channel == wanted_.from_channel;
    if (other.from == wanted_.from && is_same) erase(i);
  }
  Knob& learned = knobs_[at(size_++)];
  learned = {.learned = wanted_};
  const int target = target_channel(wanted_, channel);
  learned.in_force = in_force_[at(target)][at(wanted_.to)];
  learned.position = (wanted_.from == controller ? value : heard_[at(channel)][at(wanted_.from)])
                     << 7;
  learned.pick_up = compare(learned.position, learned.in_force);
  learns_ = false;
  has_changed_ = true;
}

bool MidiLearn::forget(int to, int to_channel) KNOTWAVE_RT {
  bool has_forgotten = false;
  for (int i = size_ - 1; i >= 0; --i) {
    const LearnedKnob& learned = knob(i).learned;
    if (learned.to != to || learned.to_channel != to_channel) continue;
    erase(i);
    has_forgotten = has_changed_ = true;
  }
  return has_forgotten;
}

void MidiLearn::erase(int index) KNOTWAVE_RT {
  for (int i = index; i + 1 < size_; ++i) knobs_[at(i)] = knobs_[at(i + 1)];
  knobs_[at(--size_)] = {};
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Notes: which voice plays them, what is stolen, how a monophonic instrument moves between keys.
#include <algorithm>
#include <span>

#include "performance.h"

namespace knotwave::engine {

void Performance::note_on(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT {
  ++serial_;
  const int master = zones_.master_of(channel);
  const int source = channels_[static_cast<std::size_t>(channel)].take_portamento_source();
  const ChannelState& programs = channels_[static_cast<std::size_t>(master)];
  const BankProgram::Choice choice =
      bank_->choose(master, programs.bank_msb(), programs.bank_lsb(), programs.program(), key);
  if (choice.patch == nullptr) {
    count_missing({master, programs.bank_msb(), programs.bank_lsb(), programs.program(),
                   choice.drum ? key : -1});
    tell_end(channel, key, number_);
    return;
  }
  channels_[static_cast<std::size_t>(channel)].forget_poly_pressure(key);
  targets_[static_cast<std::size_t>(channel)].forget_rested(base::first_sample(time));
  ++counters_.notes;
  Mono& mono = monos_[static_cast<std::size_t>(channel)];
  const bool is_mono = play_mode(channel, choice) != PlayMode::poly;
  if (mono.patch != nullptr && mono.patch != choice.patch) {  // the program changed under held keys
    mono.stack.clear();
    settle_mono(channel, time, 64);
    mono.slot = -1;
    mono.patch = nullptr;
  }
  if (is_mono) {
    play_mono(channel, key, velocity, choice, source, time);
  } else {
    play_poly(channel, key, velocity, choice, source, time);
  }
}

void Performance::count_missing(const MissingPatch& missing) KNOTWAVE_RT {
  ++counters_.notes_without_patch;
  const auto named =
      std::span(counters_.missing).first(static_cast<std::size_t>(counters_.missing_count));
  if (named.size() == counters_.missing.size()) return;
  if (std::find(named.begin(), named.end(), missing) != named.end()) return;
  counters_.missing[named.size()] = missing;
  ++counters_.missing_count;
}

void Performance::note_off(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT {
  channel = channel_of(number_, channel);
  Mono& mono = monos_[static_cast<std::size_t>(channel)];
  if (mono.stack.lift(key, sustains(channel), number_)) {
    settle_mono(channel, time, velocity);
    return;
  }
  const int index =
      number_ < 0 ? slots_.oldest_down(channel, key) : slots_.down(number_, channel, key);
  if (index < 0) return;
  VoiceSlot& slot = slots_.at(index);
  slot.key_down = false;
  slot.pedal_held = sustains(channel) || slot.sostenuto;
  if (!slot.pedal_held) release(index, time, velocity);
}

void Performance::release(int index, base::SampleTime time, int velocity) KNOTWAVE_RT {
  VoiceSlot& slot = slots_.at(index);
  slot.key_down = slot.pedal_held = slot.sostenuto = false;
  release_times_[static_cast<std::size_t>(index)] = time;
  brought(index).release(time, velocity);
}

Voice& Performance::brought(int index) KNOTWAVE_RT {
  upkeep_->bring(index);
  return voice(index);
}

// Of those whose key is up the quietest goes first: their levels must be those of now.
int Performance::victim(int bus, const PatchProgram* patch) KNOTWAVE_RT {
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    const VoiceSlot& slot = slots_.at(i);
    if (slot.is_sounding() && !slot.gate_is_open()) upkeep_->bring(i);
  }
  return slots_.victim(bus, patch);
}

void Performance::fade(int index, base::SampleTime time, double seconds) KNOTWAVE_RT {
  VoiceSlot& slot = slots_.at(index);
  slot.key_down = slot.pedal_held = slot.sostenuto = false;
  slot.state = VoiceSlot::State::fading;
  brought(index).fade_out(base::first_sample(time), seconds);
}

NoteContext Performance::context(int channel, int key, int velocity,
                                 const BankProgram::Choice& choice,
                                 std::uint32_t number) const KNOTWAVE_RT {
  NoteContext note;
  note.channel = &channels_[static_cast<std::size_t>(channel)];
  const auto master = static_cast<std::size_t>(zones_.master_of(channel));
  note.master = &channels_[master];
  note.targets = {&every_channel_, &targets_[static_cast<std::size_t>(channel)],
                  note.is_mpe() ? &targets_[master] : nullptr};
  note.note = choice.note;
  note.key = key;
  note.velocity = velocity;
  note.number = number_;
  note.serial = serial_;
  note.random = {choice.patch->spec().seed ^ config_.seed, number, base::kRandomMap};
  return note;
}

int Performance::begin(int channel, const NoteContext& note, const BankProgram::Choice& choice,
                       base::SampleTime time, const Portamento& portamento) KNOTWAVE_RT {
  const int index = slots_.free_place();
  if (index < 0) {
    ++counters_.notes_dropped;
    return -1;
  }
  const int bus = zones_.master_of(channel);
  int stolen = -1;
  if (slots_.sounding_count(bus, choice.patch) >= choice.patch->spec().polyphony) {
    stolen = victim(bus, choice.patch);
  } else if (slots_.sounding_count() >= slots_.max_voices()) {
    stolen = victim(bus, nullptr);
  }
  if (stolen >= 0) {
    fade(stolen, time, kStealFadeSeconds);
    ++counters_.voices_stolen;
  }
  VoiceSlot& slot = slots_.at(index);
  slot = {};
  slot.state = VoiceSlot::State::sounding;
  slot.key_down = true;
  slot.channel = channel;
  slot.bus = bus;
  slot.key = note.key;
  slot.choke_group = choice.choke_group;
  slot.patch = choice.patch;
  slot.bank = bank_;
  slot.age = next_note_;
  slot.number = note.number;
  slot.serial = note.serial;
  note_targets_[static_cast<std::size_t>(index)].modulation.reset(config_.rate_hz);
  note_targets_[static_cast<std::size_t>(index)].expression.reset(config_.rate_hz);
  Voice::Start start;
  start.patch = choice.patch;
  start.note = note;
  own_targets(index, start.note);
  start.time = time;
  start.gain_lin = choice.gain_lin * bank_->gain_lin();
  start.rate_hz = config_.rate_hz;
  start.portamento = portamento;
  LastPitch& last = last_pitch_[static_cast<std::size_t>(channel)];
  if (!portamento.from && last.known) start.portamento.from = last.semitones;
  voice(index).start(start, tempo_);
  upkeep_->add(index);
  last = {true, voice(index).pitch_target()};
  counters_.voices_peak = std::max(counters_.voices_peak, slots_.sounding_count());
  return index;
}

void Performance::play_poly(int channel, int key, int velocity, const BankProgram::Choice& choice,
                            int source, base::SampleTime time) KNOTWAVE_RT {
  if (tie_to_source(channel, key, velocity, choice, source, time)) return;
  const bool is_member = zones_.is_member(channel);
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    const VoiceSlot& slot = slots_.at(i);
    if (!slot.is_sounding() || slot.channel != channel) continue;
    if (choice.choke_group != 0 && slot.choke_group == choice.choke_group) {
      fade(i, time, kStealFadeSeconds);
    } else if (slot.key == key && slot.pedal_held && !slot.is_mono) {
      release(i, time, 64);  // struck again: the pedal need not hold the old one as well
    } else if (is_member && !slot.gate_is_open()) {
      brought(i).detach();
    }
  }
  const auto number = static_cast<std::uint32_t>(next_note_);
  const int index = begin(channel, context(channel, key, velocity, choice, number), choice, time,
                          portamento(channel, choice, key, source, true));
  if (index < 0) tell_end(channel, key, number_);
  ++next_note_;
}

bool Performance::mono_sounds(const Mono& mono, int channel) const KNOTWAVE_RT {
  if (mono.slot < 0) return false;
  const VoiceSlot& slot = slots_.at(mono.slot);
  return slot.is_sounding() && slot.is_mono && slot.channel == channel && slot.patch == mono.patch;
}

void Performance::play_mono(int channel, int key, int velocity, const BankProgram::Choice& choice,
                            int source, base::SampleTime time) KNOTWAVE_RT {
  Mono& mono = monos_[static_cast<std::size_t>(channel)];
  mono.patch = choice.patch;
  mono.mode = play_mode(channel, choice);
  mono.is_drum = choice.drum;
  mono.stack.press(key, velocity, number_, serial_);
  const NoteStack::Entry* chosen = mono.stack.choose(choice.patch->spec().priority);
  const bool sounds = mono_sounds(mono, channel);
  if (sounds && chosen->key != key) return;  // an older key has priority
  const auto number = static_cast<std::uint32_t>(next_note_++);
  NoteContext note = context(channel, key, velocity, choice, number);
  if (!sounds) {
    mono.slot = begin(channel, note, choice, time,
                      portamento(channel, choice, key, source, mono.mode == PlayMode::mono));
    if (mono.slot >= 0) slots_.at(mono.slot).is_mono = true;
    return;
  }
  VoiceSlot& slot = slots_.at(mono.slot);
  const bool tied = slot.gate_is_open();
  const bool is_source = tied && slot.key == source;  // then it goes on from where it sounds
  const bool joins = !is_source && (mono.mode == PlayMode::mono || !tied);
  const Portamento path =
      portamento(channel, choice, key, source, !joins || mono.mode == PlayMode::mono);
  slot.key_down = true;
  renumber(mono.slot, note, base::first_sample(time));
  brought(mono.slot).play(note, time, joins, is_source ? Portamento{path.seconds, {}} : path,
                          tempo_);
  last_pitch_[static_cast<std::size_t>(channel)] = {true, voice(mono.slot).pitch_target()};
}

void Performance::settle_mono(int channel, base::SampleTime time,
                              int release_velocity) KNOTWAVE_RT {
  Mono& mono = monos_[static_cast<std::size_t>(channel)];
  if (!mono_sounds(mono, channel)) return;
  VoiceSlot& slot = slots_.at(mono.slot);
  if (!slot.gate_is_open()) return;  // released already
  const NoteStack::Entry* chosen = mono.stack.choose(mono.patch->spec().priority);
  if (chosen == nullptr) {
    release(mono.slot, time, release_velocity);
    return;
  }
  slot.key_down = true;
  if (chosen->key == slot.key) return;
  NoteContext note = voice(mono.slot).begun().note;
  note.note += chosen->key - slot.key;
  note.key = chosen->key;
  note.velocity = chosen->velocity;
  note.number = chosen->number;
  note.serial = chosen->serial;
  renumber(mono.slot, note, base::first_sample(time));
  brought(mono.slot).play(note, time, mono.mode == PlayMode::mono,
                          portamento(channel, *mono.patch, mono.is_drum, true), tempo_);
  last_pitch_[static_cast<std::size_t>(channel)] = {true, voice(mono.slot).pitch_target()};
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Notes and controllers to gates: which voice a note gets, what keeps its gate open, which channel
// it goes out on.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "envelope_player_state.h"

namespace knotwave::engine {
// A zone's master speaks for its members.
bool EnvelopePlayer::State::hears(int channel) const KNOTWAVE_RT {
  return trigger.channel == 0 || speaks_for(trigger.channel - 1, channel);
}

bool EnvelopePlayer::State::is_selected(int channel) const KNOTWAVE_RT {
  const auto master = static_cast<std::size_t>(zones.master_of(channel));
  return trigger.program < 0 || channels[master].program() == trigger.program;
}

NoteContext EnvelopePlayer::State::context(int channel, int key, int velocity,
                                           std::uint64_t number) const KNOTWAVE_RT {
  NoteContext note;
  note.channel = &channels[static_cast<std::size_t>(channel)];
  note.master = &channels[static_cast<std::size_t>(zones.master_of(channel))];
  note.targets = {&targets, nullptr, nullptr};
  note.note = key;
  note.key = key;
  note.velocity = velocity;
  note.random = {spec.patch.seed ^ config.seed, static_cast<std::uint32_t>(number),
                 base::kRandomMap};
  return note;
}

void EnvelopePlayer::State::open(std::size_t voice, const NoteContext& note, base::SampleTime time,
                                 bool joins) KNOTWAVE_RT {
  ++notes;
  voices[voice].open(program, note, notes, time, config.rate_hz, tempo, joins);
  out_channels[voice] = static_cast<int>(note.channel - channels.data()) + 1;
}

void EnvelopePlayer::State::close(std::size_t voice, base::SampleTime time,
                                  int release_velocity) KNOTWAVE_RT {
  VoiceSlot& slot = slots[voice];
  slot.key_down = slot.pedal_held = slot.sostenuto = false;
  if (!voices[voice].gate_is_open()) return;
  voices[voice].close(program, time, release_velocity);
  if (spec.notes != NoteOutput::mpe) return;
  emit_midi(0x80, out_channels[voice] - 1, slot.key, release_velocity, time);
  members.free(out_channels[voice]);
}

void EnvelopePlayer::State::note_on(int channel, int key, int velocity,
                                    base::SampleTime time) KNOTWAVE_RT {
  if (!hears(channel)) return;
  channels[static_cast<std::size_t>(channel)].forget_poly_pressure(key);
  const bool is_note = trigger.kind == TriggerSpec::Kind::note;
  if (is_note && (key < trigger.key_low || key > trigger.key_high || !is_selected(channel))) return;
  if (spec.notes == NoteOutput::thru) pass_on(channel, key, velocity, time);
  if (!is_note || is_by_hand) return;
  if (is_poly) {
    play_poly(channel, key, velocity, time);
  } else {
    play_mono(channel, key, velocity, time);
  }
}

void EnvelopePlayer::State::note_off(int channel, int key, int velocity,
                                     base::SampleTime time) KNOTWAVE_RT {
  pass_off(channel, key, velocity, time);
  if (trigger.kind != TriggerSpec::Kind::note || is_by_hand) return;
  if (!is_poly) {
    if (stacks[static_cast<std::size_t>(channel)].lift(key, sustains(channel))) {
      settle_mono(time, velocity);
    }
    return;
  }
  std::size_t oldest = slots.size();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const VoiceSlot& slot = slots[i];
    if (!slot.key_down || slot.channel != channel || slot.key != key) continue;
    if (oldest == slots.size() || slot.age < slots[oldest].age) oldest = i;
  }
  if (oldest == slots.size()) return;
  VoiceSlot& slot = slots[oldest];
  slot.key_down = false;
  slot.pedal_held = sustains(channel) || slot.sostenuto;
  if (!slot.pedal_held) close(oldest, time, velocity);
}

void EnvelopePlayer::State::pass_on(int channel, int key, int velocity,
                                    base::SampleTime time) KNOTWAVE_RT {
  std::uint8_t& count = passed[static_cast<std::size_t>(channel)][static_cast<std::size_t>(key)];
  count = static_cast<std::uint8_t>(std::min(count + 1, 255));
  emit_midi(0x90, channel, key, velocity, time);
}

void EnvelopePlayer::State::pass_off(int channel, int key, int velocity,
                                     base::SampleTime time) KNOTWAVE_RT {
  std::uint8_t& count = passed[static_cast<std::size_t>(channel)][static_cast<std::size_t>(key)];
  if (count == 0) return;
  --count;
  emit_midi(0x80, channel, key, velocity, time);
}

void EnvelopePlayer::State::end_passed(int channel, base::SampleTime time) KNOTWAVE_RT {
  for (int key = 0; key < 128; ++key) end_passed(channel, key, time);
}

void EnvelopePlayer::State::end_passed(int channel, int key, base::SampleTime time) KNOTWAVE_RT {
  if (spec.notes != NoteOutput::thru) return;
  pass_off(channel, key, 64, time);
  passed[static_cast<std::size_t>(channel)][static_cast<std::size_t>(key)] = 0;
}

// What a new note may take: a voice that has ended, then one let go, one a pedal holds, one a key
// holds; of each the oldest.
int EnvelopePlayer::State::place_for_note() const KNOTWAVE_RT {
  const auto order = [&](std::size_t i) {
    const VoiceSlot& slot = slots[i];
    const int kept = slot.key_down ? 3 : slot.pedal_held ? 2 : voices[i].is_active(program) ? 1 : 0;
    return std::tuple(kept, slot.age);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < slots.size(); ++i) {
    if (order(i) < order(best)) best = i;
  }
  return static_cast<int>(best);
}

void EnvelopePlayer::State::play_poly(int channel, int key, int velocity,
                                      base::SampleTime time) KNOTWAVE_RT {
  const bool is_member = zones.is_member(channel);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const VoiceSlot& slot = slots[i];
    if (slot.channel != channel || !voices[i].has_begun()) continue;
    if (slot.key == key && slot.pedal_held) {
      close(i, time, 64);  // struck again: the pedal need not hold the old one as well
    } else if (is_member && !voices[i].gate_is_open()) {
      voices[i].detach();
    }
  }
  const auto index = static_cast<std::size_t>(place_for_note());
  close(index, time, 64);
  VoiceSlot& slot = slots[index];
  slot = {};
  slot.key_down = true;
  slot.channel = channel;
  slot.key = key;
  open(index, context(channel, key, velocity, notes + 1), time, false);
  slot.age = notes;
  if (spec.notes != NoteOutput::mpe) return;
  std::uint32_t taken = 0;
  for (std::size_t i = 0; i < voices.size(); ++i) {
    if (i != index && voices[i].is_active(program)) taken |= 1U << out_channels[i];
  }
  out_channels[index] = members.oldest_free(taken);
  emit_midi(0x90, out_channels[index] - 1, key, velocity, time);
}

// The key that has the gate: of each channel's the one with priority; keys that are down go before
// those a pedal holds.
EnvelopePlayer::State::Chosen EnvelopePlayer::State::choose() const KNOTWAVE_RT {
  const NotePriority priority = spec.patch.priority;
  const auto rank = [&](const Chosen& chosen) {
    const auto c = static_cast<std::size_t>(chosen.channel);
    const NoteStack::Entry& entry = *chosen.entry;
    const std::uint64_t when = pressed[c][entry.key];
    const int by_key = priority == NotePriority::low    ? -entry.key
                       : priority == NotePriority::high ? entry.key
                                                        : 0;
    return std::tuple(entry.key_down, by_key, when);
  };
  Chosen best;
  for (int channel = 0; channel < 16; ++channel) {
    const Chosen one{channel, stacks[static_cast<std::size_t>(channel)].choose(priority)};
    if (one.entry != nullptr && (best.entry == nullptr || rank(best) < rank(one))) best = one;
  }
  return best;
}

void EnvelopePlayer::State::play_mono(int channel, int key, int velocity,
                                      base::SampleTime time) KNOTWAVE_RT {
  stacks[static_cast<std::size_t>(channel)].press(key, velocity);
  pressed[static_cast<std::size_t>(channel)][static_cast<std::size_t>(key)] = ++presses;
  const bool is_open = voices[0].gate_is_open();
  const Chosen chosen = choose();
  if (is_open && (chosen.channel != channel || chosen.entry->key != key)) return;
  VoiceSlot& slot = slots[0];
  slot.channel = channel;
  slot.key = key;
  if (is_open && spec.patch.mode == PlayMode::legato) {
    voices[0].move_to(context(channel, key, velocity, notes));
    out_channels[0] = channel + 1;
  } else {
    open(0, context(channel, key, velocity, notes + 1), time, true);
  }
}

void EnvelopePlayer::State::settle_mono(base::SampleTime time, int release_velocity) KNOTWAVE_RT {
  if (trigger.kind != TriggerSpec::Kind::note || is_poly || is_by_hand) return;
  if (!voices[0].gate_is_open()) return;
  const Chosen chosen = choose();
  if (chosen.entry == nullptr) {
    close(0, time, release_velocity);
    return;
  }
  VoiceSlot& slot = slots[0];
  if (chosen.channel == slot.channel && chosen.entry->key == slot.key) return;
  slot.channel = chosen.channel;
  slot.key = chosen.entry->key;
  if (spec.patch.mode == PlayMode::legato) {
    voices[0].move_to(context(slot.channel, slot.key, chosen.entry->velocity, notes));
    out_channels[0] = slot.channel + 1;
  } else {
    open(0, context(slot.channel, slot.key, chosen.entry->velocity, notes + 1), time, true);
  }
}

bool EnvelopePlayer::State::sustains(int channel) const KNOTWAVE_RT {
  const int master = zones.master_of(channel);
  return channels[static_cast<std::size_t>(channel)].sustain() ||
         channels[static_cast<std::size_t>(master)].sustain();
}

bool EnvelopePlayer::State::holds_sostenuto(int channel) const KNOTWAVE_RT {
  const int master = zones.master_of(channel);
  return channels[static_cast<std::size_t>(channel)].sostenuto() ||
         channels[static_cast<std::size_t>(master)].sostenuto();
}

void EnvelopePlayer::State::update_pedals(int channel, base::SampleTime time) KNOTWAVE_RT {
  const auto c = static_cast<std::size_t>(channel);
  const bool sustain = sustains(channel), sostenuto = holds_sostenuto(channel);
  const bool caught = sostenuto && !sostenuto_was_on[c];
  const bool dropped = !sostenuto && sostenuto_was_on[c];
  sustain_was_on[c] = sustain;
  sostenuto_was_on[c] = sostenuto;
  if (trigger.kind != TriggerSpec::Kind::note || is_by_hand) return;
  if (!is_poly) {
    if (caught) stacks[c].catch_sostenuto();
    if (dropped) stacks[c].drop_sostenuto(sustain);
    if (!sustain) stacks[c].drop_sustain();
    return;
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    VoiceSlot& slot = slots[i];
    if (slot.channel != channel) continue;
    if (caught && slot.key_down) slot.sostenuto = true;
    if (dropped) slot.sostenuto = false;
    if (slot.pedal_held && !sustain && !slot.sostenuto) close(i, time, 64);
  }
}

void EnvelopePlayer::State::lift_keys(int channel, base::SampleTime time) KNOTWAVE_RT {
  end_passed(channel, time);
  if (trigger.kind != TriggerSpec::Kind::note || is_by_hand) return;
  const bool sustain = sustains(channel);
  if (!is_poly) {
    stacks[static_cast<std::size_t>(channel)].lift_all(sustain);
    return;
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    VoiceSlot& slot = slots[i];
    if (slot.channel != channel || !slot.key_down) continue;
    slot.key_down = false;
    slot.pedal_held = sustain || slot.sostenuto;
    if (!slot.pedal_held) close(i, time, 64);
  }
}

// Whatever pedals hold.
void EnvelopePlayer::State::silence(int channel, base::SampleTime time) KNOTWAVE_RT {
  end_passed(channel, time);
  if (trigger.kind != TriggerSpec::Kind::note || is_by_hand) return;
  stacks[static_cast<std::size_t>(channel)].clear();
  for (std::size_t i = 0; is_poly && i < slots.size(); ++i) {
    if (slots[i].channel == channel) close(i, time, 64);
  }
}

// Notes have no numbers here: those of the channel and key are meant, whatever holds them. A key
// that is down does not sound again.
void EnvelopePlayer::State::choke(const Event& event, base::SampleTime time) KNOTWAVE_RT {
  const int key = event.midi.bytes[1];
  const auto is_meant = [&](int channel, int of) {
    return (event.every_channel || channel == event.midi.channel()) &&
           (key == Event::kEveryKey || of == key);
  };
  for (int channel = 0; channel < 16; ++channel) {
    for (int of = 0; of < 128; ++of) {
      if (is_meant(channel, of)) end_passed(channel, of, time);
    }
    if (event.every_channel || channel == event.midi.channel()) {
      stacks[static_cast<std::size_t>(channel)].remove(key, Event::kNoNote);
    }
  }
  if (trigger.kind != TriggerSpec::Kind::note || is_by_hand) return;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (is_meant(slots[i].channel, slots[i].key)) close(i, time, 64);
  }
}

// The gate is open while the controller is up on any channel that is heard; the first says whose
// it is.
void EnvelopePlayer::State::follow_gate(int channel, base::SampleTime time) KNOTWAVE_RT {
  if (trigger.kind != TriggerSpec::Kind::gate || is_by_hand || !hears(channel)) return;
  const int value = channels[static_cast<std::size_t>(channel)].seven_bits(trigger.control);
  const std::uint32_t bit = 1U << channel, before = open_channels;
  if (value < trigger.threshold) {
    open_channels &= ~bit;
  } else if ((before & bit) == 0 && is_selected(channel)) {
    open_channels |= bit;
  }
  if (before == 0 && open_channels != 0) {
    open(0, context(channel, kGateKey, value, notes + 1), time, true);
  } else if (before != 0 && open_channels == 0) {
    close(0, time, 64);
  }
}

void EnvelopePlayer::State::follow_loop(base::SampleTime time) KNOTWAVE_RT {
  if (trigger.kind != TriggerSpec::Kind::loop || is_by_hand) return;
  const int channel = std::max(trigger.channel - 1, 0);
  const bool should_run = is_selected(channel) && !is_halted;
  if (should_run && !voices[0].gate_is_open()) {
    open(0, context(channel, kGateKey, kGateVelocity, notes + 1), time, true);
  } else if (!should_run) {
    close(0, time, 64);
  }
}

// Keys that are down when the trigger comes back were not heard: they open nothing.
void EnvelopePlayer::State::take_trigger(bool by_hand, base::SampleTime time) KNOTWAVE_RT {
  if (by_hand == is_by_hand) return;
  for (NoteStack& stack : stacks) stack.clear();
  for (std::size_t i = 0; i < voices.size(); ++i) close(i, time, 64);
  is_by_hand = by_hand;
  hand_is_open = false;
  open_channels = 0;
  if (by_hand) return;
  clock.seek(tempo.beats_at(time));
  follow_loop(time);
  for (int channel = 0; channel < 16; ++channel) follow_gate(channel, time);
}

void EnvelopePlayer::State::move_gate(double velocity, base::SampleTime time) KNOTWAVE_RT {
  const bool opens = velocity > 0;
  if (!is_by_hand || opens == hand_is_open) return;
  hand_is_open = opens;
  if (!opens) {
    for (std::size_t i = 0; i < voices.size(); ++i) close(i, time, 64);
    return;
  }
  const int channel = std::max(trigger.channel - 1, 0);
  const int strength = static_cast<int>(std::clamp(std::floor(velocity + 0.5), 1.0, 127.0));
  if (is_poly) {
    play_poly(channel, kGateKey, strength, time);
  } else {
    slots[0].channel = channel;
    slots[0].key = kGateKey;
    open(0, context(channel, kGateKey, strength, notes + 1), time, true);
  }
}

}  // namespace knotwave::engine

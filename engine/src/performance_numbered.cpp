// SPDX-License-Identifier: MIT
// Notes that the player names by numbers of his own, and what he says of one note alone.
#include <algorithm>

#include "performance.h"

namespace knotwave::engine {
namespace {

bool means(const Event& event, const VoiceSlot& slot) KNOTWAVE_RT {
  if (!slot.is_sounding()) return false;
  if (event.note >= 0) return slot.number == event.note;
  const bool is_key = event.midi.bytes[1] == Event::kEveryKey || slot.key == event.midi.bytes[1];
  return is_key && (event.every_channel || slot.channel == event.midi.channel());
}

}  // namespace

void Performance::own_targets(int index, NoteContext& note) const KNOTWAVE_RT {
  const NoteTargets& own = note_targets_[static_cast<std::size_t>(index)];
  note.targets[3] = &own.modulation;
  note.targets[4] = &own.expression;
}

void Performance::renumber(int index, NoteContext& note, std::int64_t sample) KNOTWAVE_RT {
  VoiceSlot& slot = slots_.at(index);
  NoteTargets& own = note_targets_[static_cast<std::size_t>(index)];
  upkeep_->bring(index);
  own.modulation.go_back(sample);
  own.expression.go_back(sample);
  own_targets(index, note);
  note.pressure = 0;
  note.timbre = -1;
  if (slot.serial != note.serial) part_from(slot);
  slot.key = note.key;
  slot.number = note.number;
  slot.serial = note.serial;
}

int Performance::channel_of(std::int32_t number, int channel) const KNOTWAVE_RT {
  for (int c = 0; number >= 0 && c < kChannels; ++c) {
    if (monos_[static_cast<std::size_t>(c)].stack.is_down(number)) return c;
  }
  return channel;
}

void Performance::choke(const Event& event, base::SampleTime time) KNOTWAVE_RT {
  for (int channel = 0; channel < kChannels; ++channel) {
    if (event.note < 0 && !event.every_channel && channel != event.midi.channel()) continue;
    monos_[static_cast<std::size_t>(channel)].stack.remove(event.midi.bytes[1], event.note);
  }
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    if (means(event, slots_.at(i))) fade(i, time, kStealFadeSeconds);
  }
}

void Performance::set_note(const Event& event, base::SampleTime time) KNOTWAVE_RT {
  const bool is_source = event.slot == Event::kNotePressure || event.slot == Event::kNoteTimbre;
  if (event.slot >= kSlotCount && !is_source) {
    ++counters_.events_unknown;
    return;
  }
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    if (means(event, slots_.at(i))) set_note(i, event, base::first_sample(time));
  }
}

void Performance::set_note(int index, const Event& event, std::int64_t sample) KNOTWAVE_RT {
  Voice& sounding = brought(index);
  if (event.slot < kSlotCount) {
    NoteTargets& own = note_targets_[static_cast<std::size_t>(index)];
    SlotTargets& targets = event.is_expression ? own.expression : own.modulation;
    const bool glides = base::first_sample(sounding.begun().time) != sample;
    targets.forget_rested(sample);
    if (!targets.set(event.slot, event.number, sample, glides)) ++counters_.events_unknown;
    return;
  }
  if (event.number != event.number) return;
  const double value = std::clamp(event.number, 0.0, 1.0);
  (event.slot == Event::kNotePressure ? sounding.note().pressure : sounding.note().timbre) = value;
}

}  // namespace knotwave::engine

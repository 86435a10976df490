// SPDX-License-Identifier: MIT
// Notes that go over to a new bank. While one does, two voices sound: so that a full house does not
// cost twice as much in one block, notes go over in groups, one after the other.
#include <algorithm>

#include "performance.h"

namespace knotwave::engine {
namespace {

/// Fewer than this go over at once.
constexpr int kLeastGroup = 8;
/// So many groups, kInstallStepSeconds apart: with a fade of four steps, half as many voices again
/// sound at most.
constexpr int kMostGroups = 8;
constexpr double kInstallStepSeconds = kInstallFadeSeconds / 4;

}  // namespace

bool Performance::is_left_behind(const VoiceSlot& slot) const KNOTWAVE_RT {
  return slot.is_sounding() && slot.bank != bank_;
}

void Performance::install(const BankProgram* bank, base::SampleTime time) KNOTWAVE_RT {
  if (bank == nullptr || bank == bank_) return;
  bank_ = bank;
  // Monophonic ones at once: their channels go on with the new patch.
  const int count = static_cast<int>(slots_.all().size());
  for (int i = 0; i < count; ++i) {
    if (is_left_behind(slots_.at(i)) && slots_.at(i).is_mono) carry_over(i, time);
  }
  // No patch of the old bank may be remembered: a later one may come to lie at the same address.
  for (int channel = 0; channel < kChannels; ++channel) {
    Mono& mono = monos_[static_cast<std::size_t>(channel)];
    if (mono.patch == nullptr || mono_sounds(mono, channel)) continue;
    mono.stack.clear();
    mono.slot = -1;
    mono.patch = nullptr;
  }
  const auto slots = slots_.all();
  const auto left = static_cast<int>(std::count_if(
      slots.begin(), slots.end(), [&](const VoiceSlot& s) { return is_left_behind(s); }));
  if (left == 0) return;
  group_ = std::max(kLeastGroup, (left + kMostGroups - 1) / kMostGroups);
  next_group_ = std::max(next_group_start_, base::first_sample(time));
  if (next_group_ == base::first_sample(time)) carry_group_over();
}

void Performance::carry_group_over(std::int64_t now, VoiceUpkeep& upkeep) KNOTWAVE_RT {
  upkeep_ = &upkeep;
  next_group_ = now;
  carry_group_over();
  tell_gone();
}

void Performance::carry_group_over() KNOTWAVE_RT {
  const base::SampleTime time{next_group_, 0};
  next_group_start_ =
      next_group_ + static_cast<std::int64_t>(kInstallStepSeconds * config_.rate_hz + 0.5);
  next_group_ = kNever;
  int carried = 0;
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    if (!is_left_behind(slots_.at(i))) continue;
    if (carried++ == group_) {
      next_group_ = next_group_start_;
      return;
    }
    carry_over(i, time);
  }
}

// The new voice is the same note, begun when the old one began, so that its envelopes stand where
// they would: only its oscillators start afresh, under the crossfade.
void Performance::carry_over(int index, base::SampleTime time) KNOTWAVE_RT {
  const VoiceSlot old = slots_.at(index);
  Voice::Start start = voice(index).begun();
  fade(index, time, kInstallFadeSeconds);
  Mono& mono = monos_[static_cast<std::size_t>(old.channel)];
  const bool was_mono = old.is_mono && mono.slot == index;
  if (was_mono) mono.slot = -1;
  const ChannelState& programs = channels_[static_cast<std::size_t>(old.bus)];
  const BankProgram::Choice choice =
      bank_->choose(old.bus, programs.bank_msb(), programs.bank_lsb(), programs.program(), old.key);
  const int fresh = slots_.free_place();
  if (choice.patch == nullptr) return;
  if (fresh < 0) {
    ++counters_.notes_dropped;
    return;
  }
  start.patch = choice.patch;
  start.gain_lin = choice.gain_lin * bank_->gain_lin();
  start.note.note = choice.note;
  start.note.random.seed = choice.patch->spec().seed ^ config_.seed;
  start.portamento = {};
  VoiceSlot& slot = slots_.at(fresh);
  slot = old;
  slot.patch = choice.patch;
  slot.bank = bank_;
  slot.choke_group = choice.choke_group;
  slot.is_mono = was_mono && play_mode(old.channel, choice) != PlayMode::poly;
  note_targets_[static_cast<std::size_t>(fresh)] = note_targets_[static_cast<std::size_t>(index)];
  own_targets(fresh, start.note);
  slots_.at(index).serial = 0;  // it goes on
  voice(fresh).start(start, tempo_);
  upkeep_->add(fresh);
  voice(fresh).fade_in(base::first_sample(time), kInstallFadeSeconds);
  if (slot.is_mono) {
    mono.slot = fresh;
    mono.patch = choice.patch;
    mono.mode = play_mode(old.channel, choice);
  } else if (was_mono) {
    const NoteStack::Entry* held = mono.stack.choose(mono.patch->spec().priority);
    slot.key_down = held != nullptr && held->key_down;
    slot.pedal_held = held != nullptr && !held->key_down;
    mono.stack.clear();
    mono.patch = nullptr;
  }
  release_times_[static_cast<std::size_t>(fresh)] = release_times_[static_cast<std::size_t>(index)];
  if (!slot.gate_is_open()) {
    voice(fresh).release(release_times_[static_cast<std::size_t>(index)],
                         start.note.release_velocity);
  }
}

}  // namespace knotwave::engine

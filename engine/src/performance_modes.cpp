// SPDX-License-Identifier: MIT
// What messages say in place of the patch: portamento (CC 5, 65, 84), mono and poly (CC 126, 127).
// Source: MIDI 1.0 Detailed Specification 4.2.1, channel mode messages and portamento control.
#include <algorithm>

#include "performance.h"

namespace knotwave::engine {

PlayMode Performance::play_mode(int channel, const BankProgram::Choice& choice) const KNOTWAVE_RT {
  const PlayMode own = choice.patch->spec().mode;
  if (choice.drum) return own;
  switch (channels_[static_cast<std::size_t>(zones_.master_of(channel))].note_mode()) {
    case ChannelState::NoteMode::as_patch:
      break;
    case ChannelState::NoteMode::mono:
      return own == PlayMode::poly ? PlayMode::mono : own;
    case ChannelState::NoteMode::poly:
      return PlayMode::poly;
  }
  return own;
}

// CC 126 speaks for the channels it counts, and what it counted before goes back to poly with CC
// 127 or a shorter count. Under MPE the master's mode is that of its members.
void Performance::set_note_mode(int channel, base::SampleTime time) KNOTWAVE_RT {
  const ChannelState& state = channels_[static_cast<std::size_t>(channel)];
  const ChannelState::NoteMode mode = state.note_mode();
  const int left = kChannels - channel;
  const int count = state.mono_channels() == 0 ? left : std::min(state.mono_channels(), left);
  int& span = mono_spans_[static_cast<std::size_t>(channel)];
  for (int i = 0; i < std::max(count, span); ++i) {
    const int other = channel + i;
    channels_[static_cast<std::size_t>(other)].set_note_mode(
        i < count ? mode : ChannelState::NoteMode::poly);
    for (int member = 0; member < kChannels; ++member) {
      if (speaks_for(other, member)) lift_keys(member, time);
    }
  }
  span = mode == ChannelState::NoteMode::mono ? count : 0;
}

Portamento Performance::portamento(int channel, const PatchProgram& patch, bool is_drum,
                                   bool glides) const KNOTWAVE_RT {
  const PatchSpec& spec = patch.spec();
  const ChannelState& said = channels_[static_cast<std::size_t>(zones_.master_of(channel))];
  const bool own = glides && spec.glide_s > 0;
  if (is_drum) return {own ? spec.glide_s : 0, {}};
  const bool on = said.portamento() == ChannelState::Portamento::as_patch
                      ? own
                      : said.portamento() == ChannelState::Portamento::on;
  return {on ? said.portamento_seconds(spec.glide_s) : 0, {}};
}

Portamento Performance::portamento(int channel, const BankProgram::Choice& choice, int key,
                                   int source, bool glides) const KNOTWAVE_RT {
  if (source < 0 || choice.drum) return portamento(channel, *choice.patch, choice.drum, glides);
  const ChannelState& said = channels_[static_cast<std::size_t>(zones_.master_of(channel))];
  return {said.portamento_seconds(choice.patch->spec().glide_s),
          choice.patch->tuning().midi_pitch(source + (choice.note - key))};
}

// Where the source note still sounds, its voice goes on to the new note's pitch and no other
// begins. The oldest where there are several.
bool Performance::tie_to_source(int channel, int key, int velocity,
                                const BankProgram::Choice& choice, int source,
                                base::SampleTime time) KNOTWAVE_RT {
  if (source < 0 || choice.drum) return false;
  int tied = -1;
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    const VoiceSlot& slot = slots_.at(i);
    if (!slot.is_sounding() || slot.is_mono || !slot.gate_is_open() || slot.channel != channel ||
        slot.key != source || slot.patch != choice.patch)
      continue;
    if (tied < 0 || slot.age < slots_.at(tied).age) tied = i;
  }
  if (tied < 0) return false;
  VoiceSlot& slot = slots_.at(tied);
  slot.key_down = true;
  slot.pedal_held = false;
  const double seconds = portamento(channel, choice, key, source, true).seconds;
  const auto number = static_cast<std::uint32_t>(slot.age);
  NoteContext note = context(channel, key, velocity, choice, number);
  renumber(tied, note, base::first_sample(time));
  brought(tied).play(note, time, false, {seconds, {}}, tempo_);
  last_pitch_[static_cast<std::size_t>(channel)] = {true, voice(tied).pitch_target()};
  return true;
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
// Messages. Notes are in performance_notes.cpp, portamento and note modes in performance_modes.cpp.
#include "performance.h"

#include <algorithm>
#include <cstring>

namespace knotwave::engine {
namespace {

constexpr int kMiddleKey = 60;             // stands for all keys of a channel
constexpr double kUsualBendSemitones = 2;  // where no patch says otherwise

}  // namespace

Performance::Performance(const EngineConfig& config)
    : config_(config),
      slots_(config.max_voices),
      voices_(2 * static_cast<std::size_t>(config.max_voices)),
      note_targets_(voices_.size()),
      ended_notes_(voices_.size() + kChannels * 128 + Engine::kMostNotesAtOnce),
      release_times_(voices_.size()) {}

void Performance::reset(const BankProgram* bank) KNOTWAVE_RT {
  bank_ = bank;
  for (ChannelState& channel : channels_) channel.reset();
  for (SlotTargets& targets : targets_) targets.reset(config_.rate_hz);
  every_channel_.reset(config_.rate_hz);
  zones_.reset();
  for (Mono& mono : monos_) {
    mono.stack.clear();
    mono.stack.forget_gone();
    mono.slot = -1;
    mono.patch = nullptr;
  }
  sustain_was_on_.fill(false);
  sostenuto_was_on_.fill(false);
  last_pitch_.fill({});
  mono_spans_.fill(0);
  tempo_.reset(config_.rate_hz);
  master_gain_ = 1;
  next_note_ = 0;
  ended_count_ = 0;
  serial_ = 0;
  next_group_ = kNever;
  next_group_start_ = 0;
  slots_.clear();
  counters_ = {};
}

Performance::Reach Performance::reach_of(const Event& event) const KNOTWAVE_RT {
  using Voices = Reach::Voices;
  const Reach everything{Voices::all, true, 0, 0};
  const int channel = event.midi.channel(), one = event.midi.bytes[1] & 127;
  if (event.kind == Event::Kind::set_target) {
    return {event.every_channel ? Voices::all : Voices::channel, false, channel, 0};
  }
  // These bring those they change.
  if (event.kind == Event::Kind::set_note || event.kind == Event::Kind::choke) return {};
  if (event.kind != Event::Kind::midi) return everything;
  switch (event.midi.status()) {
    case base::MidiStatus::note_on: {
      const auto c = static_cast<std::size_t>(channel);
      if (!targets_[c].is_empty()) return {Voices::channel, false, channel, 0};
      return {channels_[c].poly_pressure(one) != 0 ? Voices::key : Voices::none, false, channel,
              one};
    }
    case base::MidiStatus::poly_pressure:
      return {Voices::key, false, channel, one};
    case base::MidiStatus::channel_pressure:
    case base::MidiStatus::pitch_bend:
      return {Voices::channel, false, channel, 0};
    case base::MidiStatus::control_change:
      // Those that speak for other channels, or may.
      if (one >= kAllSoundOff || one == kDataEntryMsb || one == kDataEntryLsb ||
          (one >= kDataIncrement && one <= kRpnMsb))
        return everything;
      return {Voices::channel, true, channel, 0};
    case base::MidiStatus::system:
      return everything;
    case base::MidiStatus::note_off:
    case base::MidiStatus::program_change:
    default:
      return {};
  }
}

void Performance::handle(const Event& event, base::SampleTime time,
                         VoiceUpkeep& upkeep) KNOTWAVE_RT {
  upkeep_ = &upkeep;
  number_ = std::max(event.note, Event::kNoNote);
  switch (event.kind) {
    case Event::Kind::midi:
      handle_midi(event.midi, time);
      break;
    case Event::Kind::tempo:
      tempo_.set_tempo(time, event.microseconds_per_quarter);
      break;
    case Event::Kind::install_bank:
      install(event.bank, time);
      break;
    case Event::Kind::all_notes_off:
      release_everything(time);
      break;
    case Event::Kind::set_target:
      set_target(event, time);
      break;
    case Event::Kind::set_note:
      set_note(event, time);
      break;
    case Event::Kind::choke:
      choke(event, time);
      break;
    case Event::Kind::position:
      tempo_.set_position(time, static_cast<double>(event.song_clocks) / kSongClocksPerQuarter);
      break;
  }
  tell_gone();
}

void Performance::set_target(const Event& event, base::SampleTime time) KNOTWAVE_RT {
  SlotTargets& targets = event.every_channel
                             ? every_channel_
                             : targets_[static_cast<std::size_t>(event.midi.channel())];
  const std::int64_t sample = base::first_sample(time);
  targets.forget_rested(sample);
  if (event.slot < kSlotCount) {
    targets.set(event.slot, event.number, sample);
  } else if (event.slot == Event::kEverySlot) {
    targets.go_back(sample);
  } else {
    ++counters_.events_unknown;
  }
}

void Performance::handle_midi(const base::MidiEvent& midi, base::SampleTime time) KNOTWAVE_RT {
  const int channel = midi.channel();
  const int one = midi.bytes[1] & 127, two = midi.bytes[2] & 127;
  ChannelState& state = channels_[static_cast<std::size_t>(channel)];
  if (midi.status() != base::MidiStatus::system && ((midi.bytes[1] | midi.bytes[2]) & 0x80) != 0) {
    ++counters_.events_unknown;
    return;
  }
  switch (midi.status()) {
    case base::MidiStatus::note_off:
      note_off(channel, one, two, time);
      break;
    case base::MidiStatus::note_on:
      two == 0 ? note_off(channel, one, 64, time) : note_on(channel, one, two, time);
      break;
    case base::MidiStatus::poly_pressure:
      state.poly_pressure(one, two);
      break;
    case base::MidiStatus::control_change:
      handle_control(channel, one, two, time);
      break;
    case base::MidiStatus::program_change:
      state.program_change(one);
      break;
    case base::MidiStatus::channel_pressure:
      state.channel_pressure(one);
      break;
    case base::MidiStatus::pitch_bend:
      state.pitch_bend(one, two);
      break;
    case base::MidiStatus::system:
      handle_system(midi, time);
      break;
    default:
      ++counters_.events_unknown;
      break;
  }
}

void Performance::handle_control(int channel, int controller, int value,
                                 base::SampleTime time) KNOTWAVE_RT {
  ChannelState& state = channels_[static_cast<std::size_t>(channel)];
  const bool is_data =
      controller == kDataEntryLsb || controller == kDataIncrement || controller == kDataDecrement;
  switch (state.control_change(controller, value, is_data ? own_bend_range(channel) : 0)) {
    case ChannelState::Effect::none:
      break;
    case ChannelState::Effect::pedals:
      for (int other = 0; other < kChannels; ++other) {
        if (speaks_for(channel, other)) update_pedals(other, time);
      }
      break;
    case ChannelState::Effect::all_sound_off:
      for (int other = 0; other < kChannels; ++other) {
        if (speaks_for(channel, other)) silence(other, time);
      }
      break;
    case ChannelState::Effect::all_notes_off:
      for (int other = 0; other < kChannels; ++other) {
        if (speaks_for(channel, other)) lift_keys(other, time);
      }
      break;
    case ChannelState::Effect::note_mode:
      set_note_mode(channel, time);
      break;
    case ChannelState::Effect::mpe_zone:
      configure_mpe(channel, state.mpe_members(), time);
      break;
    case ChannelState::Effect::bend_range:
      share_bend_range(channel);
      break;
  }
}

// System exclusive that resets everything (General MIDI on and off, Roland GS, Yamaha XG) and the
// universal master volume. The device number is not looked at.
void Performance::handle_system(const base::MidiEvent& midi, base::SampleTime time) KNOTWAVE_RT {
  if (midi.bytes[0] == 0xFF) {
    reset_system(time);
    return;
  }
  if (midi.bytes[0] != 0xF0 || midi.sysex == nullptr) {
    const bool ignored = midi.bytes[0] >= 0xF8;  // clock and active sensing: nothing to do here
    if (!ignored) ++counters_.events_unknown;
    return;
  }
  const std::uint8_t* data = midi.sysex;
  const std::uint32_t size = midi.sysex_size;
  const auto is = [&](std::uint32_t at, std::initializer_list<int> bytes) {
    if (size < at + bytes.size()) return false;
    std::uint32_t i = at;
    for (const int byte : bytes) {
      if (data[i++] != byte) return false;
    }
    return true;
  };
  const bool general_midi = is(0, {0x7E}) && is(2, {0x09}) && size >= 4;
  const bool roland_gs = is(0, {0x41}) && is(2, {0x42, 0x12, 0x40, 0x00, 0x7F, 0x00});
  const bool yamaha_xg = is(0, {0x43}) && is(2, {0x4C, 0x00, 0x00, 0x7E, 0x00});
  if (general_midi || roland_gs || yamaha_xg) {
    reset_system(time);
  } else if (is(0, {0x7F}) && is(2, {0x04, 0x01}) && size >= 6) {
    const double volume = ((data[5] & 127) * 128 + (data[4] & 127)) / 16383.0;
    master_gain_ = volume * volume;
  } else {
    ++counters_.events_unknown;
  }
}

void Performance::reset_system(base::SampleTime time) KNOTWAVE_RT {
  for (int channel = 0; channel < kChannels; ++channel) silence(channel, time);
  for (ChannelState& channel : channels_) channel.reset();
  for (SlotTargets& targets : targets_) targets.go_back(base::first_sample(time));
  zones_.reset();
  sustain_was_on_.fill(false);
  sostenuto_was_on_.fill(false);
  last_pitch_.fill({});
  mono_spans_.fill(0);
  master_gain_ = 1;
}

void Performance::configure_mpe(int channel, int members, base::SampleTime time) KNOTWAVE_RT {
  const MpeZones before = zones_;
  if (!zones_.configure(channel, members)) return;
  for (int other = 0; other < kChannels; ++other) {
    if (before.master_of(other) == other && zones_.master_of(other) == other && other != channel)
      continue;
    ChannelState& state = channels_[static_cast<std::size_t>(other)];
    state.reset_controllers();
    state.forget_bend_range();
    update_pedals(other, time);
    lift_keys(other, time);
  }
}

double Performance::own_bend_range(int channel) const KNOTWAVE_RT {
  if (zones_.is_member(channel)) return kMpeMemberBendSemitones;
  if (zones_.is_master(channel)) return kMpeMasterBendSemitones;
  const ChannelState& state = channels_[static_cast<std::size_t>(channel)];
  const PatchProgram* patch =
      bank_->choose(channel, state.bank_msb(), state.bank_lsb(), state.program(), kMiddleKey).patch;
  return patch == nullptr ? kUsualBendSemitones : patch->spec().bend_semitones;
}

// What one member of a zone says of the bend range holds for all of them; the master has its own
// (M1-100-UM, 2.4).
void Performance::share_bend_range(int channel) KNOTWAVE_RT {
  if (!zones_.is_member(channel)) return;
  const int master = zones_.master_of(channel);
  for (int other = 0; other < kChannels; ++other) {
    if (other == master || zones_.master_of(other) != master) continue;
    channels_[static_cast<std::size_t>(other)].take_bend_range(
        channels_[static_cast<std::size_t>(channel)]);
  }
}

bool Performance::sustains(int channel) const KNOTWAVE_RT {
  const int master = zones_.master_of(channel);
  return channels_[static_cast<std::size_t>(channel)].sustain() ||
         channels_[static_cast<std::size_t>(master)].sustain();
}

bool Performance::holds_sostenuto(int channel) const KNOTWAVE_RT {
  const int master = zones_.master_of(channel);
  return channels_[static_cast<std::size_t>(channel)].sostenuto() ||
         channels_[static_cast<std::size_t>(master)].sostenuto();
}

void Performance::update_pedals(int channel, base::SampleTime time) KNOTWAVE_RT {
  const auto c = static_cast<std::size_t>(channel);
  const bool sustain = sustains(channel), sostenuto = holds_sostenuto(channel);
  const bool caught = sostenuto && !sostenuto_was_on_[c];
  const bool dropped = !sostenuto && sostenuto_was_on_[c];
  sustain_was_on_[c] = sustain;
  sostenuto_was_on_[c] = sostenuto;
  Mono& mono = monos_[c];
  if (caught) mono.stack.catch_sostenuto();
  if (dropped) mono.stack.drop_sostenuto(sustain);
  if (!sustain) mono.stack.drop_sustain();
  settle_mono(channel, time, 64);
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    VoiceSlot& slot = slots_.at(i);
    if (!slot.is_sounding() || slot.is_mono || slot.channel != channel) continue;
    if (caught && slot.key_down) slot.sostenuto = true;
    if (dropped) slot.sostenuto = false;
    if (slot.pedal_held && !sustain && !slot.sostenuto) release(i, time, 64);
  }
}

void Performance::lift_keys(int channel, base::SampleTime time) KNOTWAVE_RT {
  const bool sustain = sustains(channel);
  monos_[static_cast<std::size_t>(channel)].stack.lift_all(sustain);
  settle_mono(channel, time, 64);
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    VoiceSlot& slot = slots_.at(i);
    if (!slot.is_sounding() || slot.is_mono || slot.channel != channel || !slot.key_down) continue;
    slot.key_down = false;
    slot.pedal_held = sustain || slot.sostenuto;
    if (!slot.pedal_held) release(i, time, 64);
  }
}

void Performance::silence(int channel, base::SampleTime time) KNOTWAVE_RT {
  Mono& mono = monos_[static_cast<std::size_t>(channel)];
  mono.stack.clear();
  mono.slot = -1;
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    if (slots_.at(i).is_sounding() && slots_.at(i).channel == channel) {
      fade(i, time, kStealFadeSeconds);
    }
  }
}

void Performance::release_everything(base::SampleTime time) KNOTWAVE_RT {
  for (int channel = 0; channel < kChannels; ++channel) {
    channels_[static_cast<std::size_t>(channel)].release_pedals();
  }
  for (int channel = 0; channel < kChannels; ++channel) {
    update_pedals(channel, time);
    lift_keys(channel, time);
  }
}

Engine::Newest Performance::newest(std::int64_t sample) const KNOTWAVE_RT {
  int newest = -1;
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    const VoiceSlot& slot = slots_.at(i);
    if (!slot.is_sounding() || (newest >= 0 && slot.age < slots_.at(newest).age)) continue;
    newest = i;
  }
  if (newest < 0) return {};
  return {slots_.at(newest).patch,
          voices_[static_cast<std::size_t>(newest)].envelope_place(sample)};
}

void Performance::collect() KNOTWAVE_RT {
  counters_.voices_now = 0;
  for (int i = 0; i < static_cast<int>(slots_.all().size()); ++i) {
    if (slots_.at(i).state != VoiceSlot::State::free) collect(i);
    if (slots_.at(i).is_sounding()) ++counters_.voices_now;
  }
  counters_.voices_peak = std::max(counters_.voices_peak, counters_.voices_now);
}

void Performance::collect(int index) KNOTWAVE_RT {
  VoiceSlot& slot = slots_.at(index);
  slot.level = voice(index).level();
  counters_.joins_limited += voice(index).take_limited_joins();
  if (!voice(index).is_done()) return;
  slot.state = VoiceSlot::State::free;
  part_from(slot);
}

}  // namespace knotwave::engine

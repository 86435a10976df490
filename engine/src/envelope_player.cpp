// SPDX-License-Identifier: MIT
// Messages in, values and messages out. Notes are in envelope_player_notes.cpp, the song position
// in envelope_player_clock.cpp.
#include "knotwave/engine/envelope_player.h"

#include <algorithm>

#include "knotwave/base/document.h"

#include "envelope_player_state.h"

namespace knotwave::engine {

EnvelopePlayer::State::State(const EnvelopePlayerConfig& player_config,
                             const EnvelopePatchProgram& player_program)
    : config(player_config),
      program(player_program),
      spec(program.spec()),
      trigger(spec.trigger),
      clock(trigger) {
  tempo.reset(config.rate_hz);
  targets.reset(config.rate_hz);
  trims.reset(config.rate_hz);
  is_poly = trigger.kind == TriggerSpec::Kind::note && spec.patch.mode == PlayMode::poly;
  const auto count = is_poly ? static_cast<std::size_t>(spec.patch.polyphony) : std::size_t{1};
  voices.resize(count);
  slots.resize(count);
  out_channels.assign(count, std::max(trigger.channel, 1));
  row_length = kMostSamples + static_cast<std::size_t>(config.most_ahead_samples);
  values.resize(count * program.outputs().size() * row_length);
  fill_with_rest();
  follow_loop({0, 0});
}

void EnvelopePlayer::State::fill_with_rest() KNOTWAVE_RT {
  for (std::size_t row = 0; row * row_length < values.size(); ++row) {
    const double rest = program.outputs()[row % program.outputs().size()].spec.rest;
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(row * row_length), row_length, rest);
  }
}

Result<std::unique_ptr<EnvelopePlayer>> EnvelopePlayer::create(
    const EnvelopePlayerConfig& config, const EnvelopePatchProgram* program) {
  if (!(config.rate_hz >= 8000 && config.rate_hz <= 768000)) {
    return fail(ErrorCode::value_out_of_range, "the rate is " + base::number_text(config.rate_hz) +
                                                   " Hz; it must be from 8000 to 768000");
  }
  if (config.most_ahead_samples < 0 || config.most_ahead_samples > kMostAhead) {
    return fail(ErrorCode::value_out_of_range,
                "most_ahead_samples is " + std::to_string(config.most_ahead_samples) +
                    "; it must be from 0 to " + std::to_string(kMostAhead));
  }
  return std::unique_ptr<EnvelopePlayer>(
      new EnvelopePlayer(std::make_unique<State>(config, *program)));
}

EnvelopePlayer::EnvelopePlayer(std::unique_ptr<State> state) : state_(std::move(state)) {}
EnvelopePlayer::~EnvelopePlayer() = default;

// What was rendered already cannot change: a late event is heard at the next sample.
base::SampleTime EnvelopePlayer::State::heard_at(base::SampleTime time) const KNOTWAVE_RT {
  return base::first_sample(time) < now ? base::SampleTime{now, 0} : time;
}

void EnvelopePlayer::handle(const Event& event) KNOTWAVE_RT {
  State& s = *state_;
  s.forget_taken();
  const base::SampleTime time = s.heard_at(event.time());
  s.take_edges_until(time);
  s.tell_places(time);
  switch (event.kind) {
    case Event::Kind::midi:
      s.handle_midi(event.midi, time);
      break;
    case Event::Kind::tempo:
      s.tempo.set_tempo(time, event.microseconds_per_quarter);
      break;
    case Event::Kind::all_notes_off:
      for (ChannelState& channel : s.channels) channel.release_pedals();
      for (int channel = 0; channel < 16; ++channel) {
        s.update_pedals(channel, time);
        s.lift_keys(channel, time);
        s.follow_gate(channel, time);
      }
      s.settle_mono(time, 64);
      break;
    case Event::Kind::position:
      s.mend_song(static_cast<double>(event.song_clocks) / kSongClocksPerQuarter, time);
      break;
    case Event::Kind::set_target:
      s.set_target(event, time);
      break;
    case Event::Kind::choke:
      s.choke(event, time);
      break;
    case Event::Kind::install_bank:
    case Event::Kind::set_note:
      break;  // of the synth
  }
}

void EnvelopePlayer::State::handle_midi(const base::MidiEvent& midi,
                                        base::SampleTime time) KNOTWAVE_RT {
  const int channel = midi.channel();
  const int one = midi.bytes[1] & 127, two = midi.bytes[2] & 127;
  ChannelState& state = channels[static_cast<std::size_t>(channel)];
  if (midi.status() != base::MidiStatus::system && ((midi.bytes[1] | midi.bytes[2]) & 0x80) != 0)
    return;
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
      follow_loop(time);
      break;
    case base::MidiStatus::channel_pressure:
      state.channel_pressure(one);
      break;
    case base::MidiStatus::pitch_bend:
      state.pitch_bend(one, two);
      break;
    case base::MidiStatus::system:
      switch (midi.bytes[0]) {
        case 0xF2:
          place_song((two << 7 | one) / 4.0, time);  // in sixteenths
          break;
        case 0xF8:
          hear_clock(time);
          break;
        case 0xFA:
          start_song(time);
          break;
        case 0xFB:
          continue_song(time);
          break;
        case 0xFC:
          stop_song(time);
          break;
        case 0xFF:
          reset_system(time);
          break;
        default:
          break;
      }
      break;
    default:
      break;
  }
}

void EnvelopePlayer::State::handle_control(int channel, int controller, int value,
                                           base::SampleTime time) KNOTWAVE_RT {
  ChannelState& state = channels[static_cast<std::size_t>(channel)];
  const auto for_all = [&](void (State::*what)(int, base::SampleTime) KNOTWAVE_RT) {
    for (int other = 0; other < 16; ++other) {
      if (speaks_for(channel, other)) (this->*what)(other, time);
    }
  };
  switch (state.control_change(controller, value)) {
    case ChannelState::Effect::none:
    case ChannelState::Effect::bend_range:  // a bend is a source from -1 to 1, whatever its range
      break;
    case ChannelState::Effect::pedals:
      for_all(&State::update_pedals);
      break;
    case ChannelState::Effect::all_sound_off:
      for_all(&State::silence);
      break;
    case ChannelState::Effect::all_notes_off:
    case ChannelState::Effect::note_mode:
      for_all(&State::lift_keys);
      break;
    case ChannelState::Effect::mpe_zone:
      configure_mpe(channel, state.mpe_members(), time);
      break;
  }
  settle_mono(time, 64);
  follow_gate(channel, time);
}

void EnvelopePlayer::State::configure_mpe(int channel, int count,
                                          base::SampleTime time) KNOTWAVE_RT {
  const MpeZones before = zones;
  if (!zones.configure(channel, count)) return;
  for (int other = 0; other < 16; ++other) {
    if (before.master_of(other) == other && zones.master_of(other) == other && other != channel)
      continue;
    channels[static_cast<std::size_t>(other)].reset_controllers();
    update_pedals(other, time);
    lift_keys(other, time);
    follow_gate(other, time);
  }
  settle_mono(time, 64);
}

void EnvelopePlayer::State::reset_system(base::SampleTime time) KNOTWAVE_RT {
  for (int channel = 0; channel < 16; ++channel) silence(channel, time);
  settle_mono(time, 64);
  for (ChannelState& channel : channels) channel.reset();
  zones.reset();
  sustain_was_on.fill(false);
  sostenuto_was_on.fill(false);
  for (int channel = 0; channel < 16; ++channel) follow_gate(channel, time);
  follow_loop(time);
}

EnvelopeVoice::Rows EnvelopePlayer::State::rows(std::size_t voice, std::size_t offset) KNOTWAVE_RT {
  return {values.data() + voice * program.outputs().size() * row_length, row_length, offset};
}

void EnvelopePlayer::render(std::size_t n) KNOTWAVE_RT {
  state_->forget_taken();
  state_->render(std::min(n, kMostSamples));
}

void EnvelopePlayer::State::render(std::size_t n) KNOTWAVE_RT {
  rendered = n;
  ahead = 0;
  if (n == 0) return;
  if (is_clocked()) {
    advance_clocked(clock, voices[0], now, n, 0, true);
  } else {
    for (std::size_t i = 0; i < voices.size(); ++i) {
      render_voice(voices[i], now, n, rows(i, 0));
    }
  }
  now += static_cast<std::int64_t>(n);
  tell_places({now - 1, 0});
}

void EnvelopePlayer::State::render_voice(EnvelopeVoice& voice, std::int64_t first, std::size_t n,
                                         const EnvelopeVoice::Rows& rows) KNOTWAVE_RT {
  voice.render(program, tempo, first, n, scratch, rows);
  if (trims.is_empty() || !voice.has_begun()) return;
  for (std::size_t i = 0; i < program.outputs().size(); ++i) {
    trims.apply(i, program.outputs()[i].spec, first,
                {rows.first + i * rows.length + rows.offset, n});
  }
}

void EnvelopePlayer::predict(std::size_t n) KNOTWAVE_RT {
  state_->predict(std::min(n, static_cast<std::size_t>(state_->config.most_ahead_samples)));
}

void EnvelopePlayer::State::predict(std::size_t n) KNOTWAVE_RT {
  ahead = n;
  if (is_clocked()) {
    ClockGate gate = clock;
    ahead_voice.look_ahead_from(voices[0], program);
    advance_clocked(gate, ahead_voice, now, n, rendered, false);
    return;
  }
  for (std::size_t i = 0; i < voices.size(); ++i) {
    if (!voices[i].has_begun()) continue;
    ahead_voice.look_ahead_from(voices[i], program);
    for (std::size_t done = 0; done < n; done += kChunk) {
      render_voice(ahead_voice, now + static_cast<std::int64_t>(done), std::min(kChunk, n - done),
                   rows(i, rendered + done));
    }
  }
}

int EnvelopePlayer::voices() const KNOTWAVE_RT { return static_cast<int>(state_->voices.size()); }

EnvelopePlayer::VoiceState EnvelopePlayer::voice(int index) const KNOTWAVE_RT {
  const State& s = *state_;
  const auto i = static_cast<std::size_t>(index);
  const EnvelopeVoice& voice = s.voices[i];
  VoiceState told;
  told.is_active = voice.is_active(s.program);
  told.has_begun = voice.has_begun();
  told.channel = s.out_channels[i];
  told.key = voice.note().key;
  told.note = voice.number();
  return told;
}

int EnvelopePlayer::newest_voice() const KNOTWAVE_RT {
  int newest = -1;
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < state_->voices.size(); ++i) {
    if (state_->voices[i].number() <= number) continue;
    number = state_->voices[i].number();
    newest = static_cast<int>(i);
  }
  return newest;
}

std::span<const double> EnvelopePlayer::values(int voice, int output) const KNOTWAVE_RT {
  const State& s = *state_;
  const std::size_t row = static_cast<std::size_t>(voice) * s.program.outputs().size() +
                          static_cast<std::size_t>(output);
  return std::span(s.values).subspan(row * s.row_length, s.rendered + s.ahead);
}

std::span<const PlayerMessage> EnvelopePlayer::take_messages() KNOTWAVE_RT {
  state_->is_taken = true;
  return std::span(state_->messages).first(state_->message_count);
}

std::int64_t EnvelopePlayer::now() const KNOTWAVE_RT { return state_->now; }

bool EnvelopePlayer::is_still() const KNOTWAVE_RT {
  const State& s = *state_;
  if (s.is_clocked() || !s.trims.is_still(s.now)) return false;
  const bool sounds = std::any_of(s.sounding.begin(), s.sounding.end(),
                                  [](const State::Sounding& note) { return note.is_on; });
  return !sounds && std::all_of(s.voices.begin(), s.voices.end(), [&](const EnvelopeVoice& voice) {
    return !voice.gate_is_open() && voice.is_still(s.program, s.now);
  });
}

double EnvelopePlayer::place(int voice, int envelope) const KNOTWAVE_RT {
  const State& s = *state_;
  const EnvelopeVoice& from = s.voices[static_cast<std::size_t>(voice)];
  if (!from.has_begun()) return 0;
  return from.modulation().envelope(envelope).place_at(
      s.program.patch().envelopes()[static_cast<std::size_t>(envelope)].program, s.now);
}

void EnvelopePlayer::release_all() KNOTWAVE_RT {
  state_->forget_taken();
  state_->release_all();
}

void EnvelopePlayer::State::release_all() KNOTWAVE_RT {
  const base::SampleTime time{now, 0};
  tell_places(time);
  is_halted = true;
  let_all_go(time);
}

/// Gates, keys, pedals, and the notes of places.
void EnvelopePlayer::State::let_all_go(base::SampleTime time) KNOTWAVE_RT {
  open_channels = 0;
  hand_is_open = false;
  for (int channel = 0; channel < 16; ++channel) {
    channels[static_cast<std::size_t>(channel)].release_pedals();
    silence(channel, time);
  }
  for (std::size_t i = 0; i < voices.size(); ++i) close(i, time, 64);
  for (std::size_t i = 0; i < sounding.size(); ++i) {
    if (sounding[i].is_on) {
      sounding[i].end = time;
      end_place_note(i);
    }
  }
}

void EnvelopePlayer::end_all() KNOTWAVE_RT {
  state_->forget_taken();
  state_->end_all();
}

void EnvelopePlayer::State::end_all() KNOTWAVE_RT {
  const base::SampleTime time{now, 0};
  tell_places(time);
  let_all_go(time);
  for (EnvelopeVoice& voice : voices) voice.forget();
  fill_with_rest();
  if (is_clocked()) clock.seek(tempo.beats_at(time));
  follow_loop(time);
}

void EnvelopePlayer::State::set_target(const Event& event, base::SampleTime time) KNOTWAVE_RT {
  const std::int64_t sample = base::first_sample(time);
  targets.forget_rested(sample);
  if (event.slot == Event::kEverySlot) {
    targets.go_back(sample);
    trims.go_back(sample);
  } else if (event.slot < kSlotCount) {
    targets.set(event.slot, event.number, sample);
  } else if (OutputTrims::has(event.slot)) {
    trims.set(event.slot, event.number, sample);
  } else if (event.slot == kSlotGateByHand) {
    take_trigger(event.number != 0, time);
  } else if (event.slot == kSlotGate) {
    move_gate(event.number, time);
  } else if (event.slot == kSlotSong) {
    run_song(event.number, time);
  } else if (event.slot == kSlotSongStops) {
    stop_song(time);
  }
}

}  // namespace knotwave::engine

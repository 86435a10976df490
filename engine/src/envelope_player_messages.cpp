// SPDX-License-Identifier: MIT
// What a player tells at its time: notes that pass, notes and gates of places.
#include <algorithm>

#include "envelope_player_state.h"

namespace knotwave::engine {
namespace {

/// Free for what must go out: the ends of place notes.
constexpr std::size_t kKeptForEnds = 2 * std::size_t{kMaxPlaceEvents};

}  // namespace

void EnvelopePlayer::State::forget_taken() KNOTWAVE_RT {
  if (is_taken) message_count = 0;
  is_taken = false;
}

void EnvelopePlayer::State::emit(const PlayerMessage& message) KNOTWAVE_RT {
  if (message_count == messages.size()) return;
  std::size_t at = message_count++;
  for (; at > 0 && message.midi.time < messages[at - 1].midi.time; --at) {
    messages[at] = messages[at - 1];
  }
  messages[at] = message;
}

void EnvelopePlayer::State::emit_midi(int status, int channel, int key, int velocity,
                                      base::SampleTime time) KNOTWAVE_RT {
  PlayerMessage message;
  message.midi.time = time;
  message.midi.bytes[0] = static_cast<std::uint8_t>(status | (channel & 15));
  message.midi.bytes[1] = static_cast<std::uint8_t>(key);
  message.midi.bytes[2] = static_cast<std::uint8_t>(velocity);
  emit(message);
}

// Places passed and place notes that end up to `until` itself.
void EnvelopePlayer::State::tell_places(base::SampleTime until) KNOTWAVE_RT {
  if (spec.place_events.empty()) return;
  for (EnvelopeVoice& voice : voices) voice.watch(program, until, passages);
  for (const Passage& passage : passages.all()) tell_place(passage);
  passages.clear();
  for (std::size_t i = 0; i < spec.place_events.size(); ++i) {
    if (sounding[i].is_on && sounding[i].end <= until) end_place_note(i);
  }
}

void EnvelopePlayer::State::tell_place(const Passage& passage) KNOTWAVE_RT {
  const auto index = static_cast<std::size_t>(passage.event);
  const PlaceEventSpec& event = spec.place_events[index];
  Sounding& note = sounding[index];
  if (message_count + kKeptForEnds + 2 > messages.size()) return;
  if (note.is_on) {
    note.end = std::min(note.end, passage.time);
    end_place_note(index);
  }
  PlayerMessage message;
  message.place_event = passage.event;
  message.midi.time = passage.time;
  message.kind = PlayerMessage::Kind::place_gate;
  message.midi.bytes[2] = 1;
  if (event.kind == PlaceEventSpec::Kind::note) {
    message.kind = PlayerMessage::Kind::place_note;
    message.midi.bytes[0] = static_cast<std::uint8_t>(0x90 | (event.channel - 1));
    message.midi.bytes[1] = static_cast<std::uint8_t>(event.key);
    message.midi.bytes[2] = static_cast<std::uint8_t>(event.velocity);
  }
  emit(message);
  note = {true, time_after(passage.time, event.length_s * config.rate_hz)};
}

void EnvelopePlayer::State::end_place_note(std::size_t index) KNOTWAVE_RT {
  const PlaceEventSpec& event = spec.place_events[index];
  PlayerMessage message;
  message.place_event = static_cast<int>(index);
  message.midi.time = sounding[index].end;
  message.kind = PlayerMessage::Kind::place_gate;
  if (event.kind == PlaceEventSpec::Kind::note) {
    message.kind = PlayerMessage::Kind::place_note;
    message.midi.bytes[0] = static_cast<std::uint8_t>(0x80 | (event.channel - 1));
    message.midi.bytes[1] = static_cast<std::uint8_t>(event.key);
    message.midi.bytes[2] = 64;
  }
  sounding[index].is_on = false;
  emit(message);
}

}  // namespace knotwave::engine

// SPDX-License-Identifier: MIT
#include "clap_events.h"

#include <algorithm>
#include <cmath>

#include "knotwave/engine/channel_state.h"
#include "knotwave/plugins/parameters.h"

namespace knotwave::plugins {
namespace {

constexpr int kChannels = 16;

void add_midi(Instrument& instrument, std::int64_t sample, int status, int one,
              int two) KNOTWAVE_RT {
  engine::Event event;
  event.midi.time.sample = sample;
  event.midi.bytes[0] = static_cast<std::uint8_t>(status);
  event.midi.bytes[1] = static_cast<std::uint8_t>(one & 127);
  event.midi.bytes[2] = static_cast<std::uint8_t>(two & 127);
  instrument.add(event);
}

int seven_bits(double unit) KNOTWAVE_RT {
  return unit == unit ? static_cast<int>(std::floor(std::clamp(unit, 0.0, 1.0) * 127 + 0.5)) : 0;
}

/// A channel or key of -1 means all of them: keys are then lifted or silenced by the channel.
void end_notes(Instrument& instrument, const clap_event_note& note) KNOTWAVE_RT {
  const bool chokes = note.header.type == CLAP_EVENT_NOTE_CHOKE;
  const int first = note.channel < 0 ? 0 : note.channel;
  const int last = note.channel < 0 ? kChannels - 1 : note.channel;
  for (int channel = first; channel <= last && channel < kChannels; ++channel) {
    if (note.key >= 0 && note.key < 128) {
      add_midi(instrument, note.header.time, 0x80 | channel, note.key, seven_bits(note.velocity));
    } else if (note.key < 0) {
      add_midi(instrument, note.header.time, 0xB0 | channel,
               chokes ? engine::kAllSoundOff : engine::kAllNotesOff, 0);
    }
  }
}

/// A velocity of 0 is a note still.
void begin_note(Instrument& instrument, const clap_event_note& note) KNOTWAVE_RT {
  if (note.channel < 0 || note.channel >= kChannels || note.key < 0 || note.key > 127) return;
  add_midi(instrument, note.header.time, 0x90 | note.channel, note.key,
           std::max(seven_bits(note.velocity), 1));
}

void add_sysex(Instrument& instrument, const clap_event_midi_sysex& sysex) KNOTWAVE_RT {
  const std::uint8_t* bytes = sysex.buffer;
  std::uint32_t size = sysex.size;
  if (bytes == nullptr || size == 0) return;
  if (bytes[0] == 0xF0) (++bytes, --size);
  if (size > 0 && bytes[size - 1] == 0xF7) --size;
  engine::Event event;
  event.midi.time.sample = sysex.header.time;
  event.midi.bytes[0] = 0xF0;
  event.midi.sysex = bytes;
  event.midi.sysex_size = size;
  instrument.add(event);
}

std::size_t place_of(const clap_event_param_value& value) KNOTWAVE_RT {
  return parameter_of_id(value.param_id);
}

/// The event behind its header, null where it is shorter than it must be.
template <class Event>
const Event* as(const clap_event_header& header) KNOTWAVE_RT {
  return header.size < sizeof(Event) ? nullptr : reinterpret_cast<const Event*>(&header);
}

}  // namespace

void add_clap_transport(Instrument& instrument, const clap_event_transport& transport,
                        std::int64_t sample) KNOTWAVE_RT {
  Transport told;
  if ((transport.flags & CLAP_TRANSPORT_HAS_TEMPO) != 0) told.beats_per_minute = transport.tempo;
  told.has_position = (transport.flags & CLAP_TRANSPORT_HAS_BEATS_TIMELINE) != 0;
  told.quarters = static_cast<double>(transport.song_pos_beats) / CLAP_BEATTIME_FACTOR;
  told.is_playing = (transport.flags & CLAP_TRANSPORT_IS_PLAYING) != 0;
  instrument.add_transport(told, sample);
}

void add_clap_event(Instrument& instrument, const clap_event_header& header) KNOTWAVE_RT {
  if (header.space_id != CLAP_CORE_EVENT_SPACE_ID) return;
  switch (header.type) {
    case CLAP_EVENT_NOTE_ON:
      if (const auto* note = as<clap_event_note>(header)) begin_note(instrument, *note);
      break;
    case CLAP_EVENT_NOTE_OFF:
    case CLAP_EVENT_NOTE_CHOKE:
      if (const auto* note = as<clap_event_note>(header)) end_notes(instrument, *note);
      break;
    case CLAP_EVENT_PARAM_VALUE:
      if (const auto* value = as<clap_event_param_value>(header)) {
        instrument.add_parameter(place_of(*value), value->value, header.time);
      }
      break;
    case CLAP_EVENT_TRANSPORT:
      if (const auto* transport = as<clap_event_transport>(header)) {
        add_clap_transport(instrument, *transport, header.time);
      }
      break;
    case CLAP_EVENT_MIDI:
      if (const auto* midi = as<clap_event_midi>(header);
          midi != nullptr && midi->data[0] >= 0x80) {
        add_midi(instrument, header.time, midi->data[0], midi->data[1], midi->data[2]);
      }
      break;
    case CLAP_EVENT_MIDI_SYSEX:
      if (const auto* sysex = as<clap_event_midi_sysex>(header)) add_sysex(instrument, *sysex);
      break;
    default:
      break;
  }
}

void set_clap_parameters(Instrument& instrument, const clap_input_events& events) KNOTWAVE_RT {
  const std::uint32_t count = events.size(&events);
  for (std::uint32_t i = 0; i < count; ++i) {
    const clap_event_header* header = events.get(&events, i);
    if (header == nullptr || header->space_id != CLAP_CORE_EVENT_SPACE_ID ||
        header->type != CLAP_EVENT_PARAM_VALUE) {
      continue;
    }
    if (const auto* value = as<clap_event_param_value>(*header)) {
      instrument.set_parameter(place_of(*value), value->value);
    }
  }
}

}  // namespace knotwave::plugins

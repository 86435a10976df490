// SPDX-License-Identifier: MIT
#include "clap_events.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/elementary.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/map_slots.h"

namespace knotwave::plugins {
namespace {

constexpr int kChannels = 16;

engine::Event midi_event(std::int64_t sample, int status, int one, int two) KNOTWAVE_RT {
  engine::Event event;
  event.midi.time.sample = sample;
  event.midi.bytes[0] = static_cast<std::uint8_t>(status);
  event.midi.bytes[1] = static_cast<std::uint8_t>(one & 127);
  event.midi.bytes[2] = static_cast<std::uint8_t>(two & 127);
  return event;
}

int seven_bits(double unit) KNOTWAVE_RT {
  return unit == unit ? static_cast<int>(std::floor(std::clamp(unit, 0.0, 1.0) * 127 + 0.5)) : 0;
}

/// Of one number, or of a channel and a key, -1: of all.
void address(engine::Event& event, std::int32_t note, int channel, int key) KNOTWAVE_RT {
  event.midi.bytes[0] = static_cast<std::uint8_t>(std::max(channel, 0) & 15);
  event.midi.bytes[1] =
      key < 0 ? std::uint8_t{engine::Event::kEveryKey} : static_cast<std::uint8_t>(key & 127);
  event.every_channel = channel < 0;
  event.note = note;
}

bool is_address(int channel, int key) KNOTWAVE_RT { return channel < kChannels && key < 128; }

/// Keys of -1 are lifted by the channel.
void lift_notes(Plugin& plugin, const clap_event_note& note) KNOTWAVE_RT {
  if (!is_address(note.channel, note.key)) return;
  const bool is_one = note.note_id >= 0;
  const int first = std::max<int>(note.channel, 0);
  const int last = note.channel < 0 && !is_one ? kChannels - 1 : first;
  for (int channel = first; channel <= last; ++channel) {
    engine::Event event;
    if (is_one || note.key >= 0) {
      event = midi_event(note.header.time, 0x80 | channel, std::max<int>(note.key, 0),
                         seven_bits(note.velocity));
      event.note = note.note_id;
      event.every_channel = note.channel < 0;
    } else {
      event = midi_event(note.header.time, 0xB0 | channel, engine::kAllNotesOff, 0);
    }
    plugin.add(event);
  }
}

void choke_notes(Plugin& plugin, const clap_event_note& note) KNOTWAVE_RT {
  if (!is_address(note.channel, note.key)) return;
  engine::Event event;
  event.kind = engine::Event::Kind::choke;
  event.midi.time.sample = note.header.time;
  address(event, note.note_id, note.channel, note.key);
  plugin.add(event);
}

/// A velocity of 0 is a note still.
void begin_note(Plugin& plugin, const clap_event_note& note) KNOTWAVE_RT {
  if (note.channel < 0 || note.channel >= kChannels || note.key < 0 || note.key > 127) return;
  engine::Event event = midi_event(note.header.time, 0x90 | note.channel, note.key,
                                   std::max(seven_bits(note.velocity), 1));
  event.note = note.note_id;
  plugin.add(event);
}

void add_sysex(Plugin& plugin, const clap_event_midi_sysex& sysex) KNOTWAVE_RT {
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
  plugin.add(event);
}

/// What an expression says in the engine's own numbers: decibels of volume, the offset of a place
/// between the sides, the gain of an expression pedal (squared, as MIDI's).
struct Said {
  int slot = -1;
  double number = 0;
};
Said said(const clap_event_note_expression& expression) KNOTWAVE_RT {
  constexpr double kSilentDb = -200, kDbAnOctave = 6.0205999132796239;  // 20 log10(2)
  const double value = expression.value;
  if (value != value) return {};
  const double unit = std::clamp(value, 0.0, 1.0);
  switch (expression.expression_id) {
    case CLAP_NOTE_EXPRESSION_VOLUME:
      return {engine::kSlotAmp,
              value > 1e-10 ? kDbAnOctave * base::log2(std::min(value, 4.0)) : kSilentDb};
    case CLAP_NOTE_EXPRESSION_PAN:
      return {engine::kSlotPan, unit - 0.5};
    case CLAP_NOTE_EXPRESSION_TUNING:
      return {engine::kSlotPitch, std::clamp(value, -120.0, 120.0)};
    case CLAP_NOTE_EXPRESSION_EXPRESSION:
      return {engine::kSlotGain, unit * unit - 1};
    case CLAP_NOTE_EXPRESSION_BRIGHTNESS:
      return {engine::Event::kNoteTimbre, unit};
    case CLAP_NOTE_EXPRESSION_PRESSURE:
      return {engine::Event::kNotePressure, unit};
    default:
      return {};  // of vibrato a patch knows nothing
  }
}

void express(Plugin& plugin, const clap_event_note_expression& expression) KNOTWAVE_RT {
  const Said what = said(expression);
  if (what.slot < 0 || !is_address(expression.channel, expression.key)) return;
  engine::Event event;
  event.kind = engine::Event::Kind::set_note;
  event.midi.time.sample = expression.header.time;
  address(event, expression.note_id, expression.channel, expression.key);
  event.is_expression = true;
  event.slot = static_cast<std::uint16_t>(what.slot);
  event.number = what.number;
  plugin.add(event);
}

std::size_t place_of(const Plugin& plugin, const clap_event_param_value& value) KNOTWAVE_RT {
  return plugin.info().parameters->of_id(value.param_id);
}

/// The event behind its header, null where it is shorter than it must be.
template <class Event>
const Event* as(const clap_event_header& header) KNOTWAVE_RT {
  return header.size < sizeof(Event) ? nullptr : reinterpret_cast<const Event*>(&header);
}

}  // namespace

void add_clap_transport(Plugin& plugin, const clap_event_transport& transport,
                        std::int64_t sample) KNOTWAVE_RT {
  Transport told;
  if ((transport.flags & CLAP_TRANSPORT_HAS_TEMPO) != 0) told.beats_per_minute = transport.tempo;
  told.has_position = (transport.flags & CLAP_TRANSPORT_HAS_BEATS_TIMELINE) != 0;
  told.quarters = static_cast<double>(transport.song_pos_beats) / CLAP_BEATTIME_FACTOR;
  told.is_playing = (transport.flags & CLAP_TRANSPORT_IS_PLAYING) != 0;
  plugin.add_transport(told, sample);
}

void add_clap_event(Plugin& plugin, const clap_event_header& header) KNOTWAVE_RT {
  if (header.space_id != CLAP_CORE_EVENT_SPACE_ID) return;
  switch (header.type) {
    case CLAP_EVENT_NOTE_ON:
      if (const auto* note = as<clap_event_note>(header)) begin_note(plugin, *note);
      break;
    case CLAP_EVENT_NOTE_OFF:
      if (const auto* note = as<clap_event_note>(header)) lift_notes(plugin, *note);
      break;
    case CLAP_EVENT_NOTE_CHOKE:
      if (const auto* note = as<clap_event_note>(header)) choke_notes(plugin, *note);
      break;
    case CLAP_EVENT_PARAM_VALUE:
      if (const auto* value = as<clap_event_param_value>(header)) {
        plugin.add_parameter(place_of(plugin, *value), value->value, header.time);
      }
      break;
    case CLAP_EVENT_PARAM_MOD:
      if (const auto* mod = as<clap_event_param_mod>(header)) {
        plugin.add_modulation(plugin.info().parameters->of_id(mod->param_id), mod->amount,
                              {mod->note_id, mod->channel, mod->key}, header.time);
      }
      break;
    case CLAP_EVENT_NOTE_EXPRESSION:
      if (const auto* expression = as<clap_event_note_expression>(header)) {
        express(plugin, *expression);
      }
      break;
    case CLAP_EVENT_TRANSPORT:
      if (const auto* transport = as<clap_event_transport>(header)) {
        add_clap_transport(plugin, *transport, header.time);
      }
      break;
    case CLAP_EVENT_MIDI:
      if (const auto* midi = as<clap_event_midi>(header);
          midi != nullptr && midi->data[0] >= 0x80) {
        plugin.add(midi_event(header.time, midi->data[0], midi->data[1], midi->data[2]));
      }
      break;
    case CLAP_EVENT_MIDI_SYSEX:
      if (const auto* sysex = as<clap_event_midi_sysex>(header)) add_sysex(plugin, *sysex);
      break;
    default:
      break;
  }
}

void set_clap_parameters(Plugin& plugin, const clap_input_events& events) KNOTWAVE_RT {
  const std::uint32_t count = events.size(&events);
  for (std::uint32_t i = 0; i < count; ++i) {
    const clap_event_header* header = events.get(&events, i);
    if (header == nullptr || header->space_id != CLAP_CORE_EVENT_SPACE_ID ||
        header->type != CLAP_EVENT_PARAM_VALUE) {
      continue;
    }
    if (const auto* value = as<clap_event_param_value>(*header)) {
      plugin.set_parameter(place_of(plugin, *value), value->value);
    }
  }
}

void give_clap_ends(std::span<const engine::EndedNote> notes, std::uint32_t sample,
                    const clap_output_events& out) KNOTWAVE_RT {
  for (const engine::EndedNote& note : notes) {
    clap_event_note end{};
    end.header = {sizeof end, sample, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_NOTE_END, 0};
    end.note_id = note.note;
    end.channel = static_cast<std::int16_t>(note.channel);
    end.key = static_cast<std::int16_t>(note.key);
    out.try_push(&out, &end.header);
  }
}

void give_clap_events(std::span<const base::MidiEvent> events,
                      const clap_output_events& out) KNOTWAVE_RT {
  for (const base::MidiEvent& given : events) {
    const auto sample = static_cast<std::uint32_t>(std::max<std::int64_t>(given.time.sample, 0));
    if (given.sysex != nullptr) {
      const clap_event_midi_sysex sysex{
          {sizeof sysex, sample, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI_SYSEX, 0},
          0,
          given.sysex,
          given.sysex_size};
      out.try_push(&out, &sysex.header);
      continue;
    }
    clap_event_midi midi{};
    midi.header = {sizeof midi, sample, CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI, 0};
    std::copy_n(given.bytes, 3, midi.data);
    out.try_push(&out, &midi.header);
  }
}

}  // namespace knotwave::plugins

// SPDX-License-Identifier: MIT
#include "note_context.h"

#include <algorithm>

namespace knotwave::engine {

double source_value(const NoteContext& note, MapSource source, int index) KNOTWAVE_RT {
  const ChannelState& own = *note.channel;
  const ChannelState& master = *note.master;
  switch (source) {
    case MapSource::constant:
      return 1;
    case MapSource::velocity:
      return note.velocity / 127.0;
    case MapSource::release_velocity:
      return note.release_velocity / 127.0;
    case MapSource::key:
      return note.note / 127;
    case MapSource::key_octaves:
      return (note.note - 60) / 12;
    case MapSource::random:
      return note.random.unit(static_cast<std::uint64_t>(index));
    case MapSource::channel_pressure:
      return std::max(own.pressure(), master.pressure());
    case MapSource::poly_pressure:
      return std::max(note.pressure, own.poly_pressure(note.key));
    case MapSource::pressure:
      return std::max(
          {own.pressure(), master.pressure(), note.pressure, own.poly_pressure(note.key)});
    case MapSource::timbre:
      if (note.timbre >= 0) return note.timbre;
      return (own.timbre_was_sent() ? own : master).control(kTimbre);
    case MapSource::pitch_bend:
      return own.bend();
    case MapSource::control:
      return (index == kTimbre ? own : master).control(index);
    case MapSource::envelope:
    case MapSource::lfo:
    case MapSource::free_number:
      break;
  }
  return 0;
}

double bend_semitones(const NoteContext& note, double patch_range_semitones) KNOTWAVE_RT {
  const ChannelState& own = *note.channel;
  const ChannelState& master = *note.master;
  if (!note.is_mpe()) {
    return own.bend() * own.bend_range_semitones(patch_range_semitones) + own.tuning_semitones();
  }
  return own.bend() * own.bend_range_semitones(kMpeMemberBendSemitones) +
         master.bend() * master.bend_range_semitones(kMpeMasterBendSemitones) +
         own.tuning_semitones() + master.tuning_semitones();
}

}  // namespace knotwave::engine

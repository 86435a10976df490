// SPDX-License-Identifier: MIT
// Where a voice reads what the player does: its note, its channel, and under MPE the zone's master.
#pragma once
#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/mpe.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

struct NoteContext {
  const ChannelState* channel = nullptr;
  const ChannelState* master = nullptr;  ///< == channel outside MPE zones
  double note = 60;                      ///< what sounds, transposition included
  int key = 60;
  int velocity = 100;
  int release_velocity = 64;
  base::RandomStream random;  ///< of this note

  bool is_mpe() const KNOTWAVE_RT { return master != channel; }
};

/// The present value of a source that is neither an envelope, an LFO nor a free number. [audio]
double source_value(const NoteContext& note, MapSource source, int index) KNOTWAVE_RT;

/// Bend and channel tuning of the note in semitones. [audio]
double bend_semitones(const NoteContext& note, double patch_range_semitones) KNOTWAVE_RT;

}  // namespace knotwave::engine

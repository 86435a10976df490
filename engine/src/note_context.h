// SPDX-License-Identifier: MIT
// Where a voice reads what the player does: its note, its channel, and under MPE the zone's master.
#pragma once
#include <algorithm>
#include <array>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/mpe.h"
#include "knotwave/engine/patch.h"

#include "channel_targets.h"

namespace knotwave::engine {

struct NoteContext {
  const ChannelState* channel = nullptr;
  const ChannelState* master = nullptr;  ///< == channel outside MPE zones
  /// What set_target events said of all channels, of the channel, and of the zone's master where
  /// that is another; or null.
  std::array<const ChannelTargets*, 3> targets{};
  double note = 60;  ///< what sounds, transposition included
  int key = 60;
  int velocity = 100;
  int release_velocity = 64;
  base::RandomStream random;  ///< of this note

  bool is_mpe() const KNOTWAVE_RT { return master != channel; }
  bool has_targets() const KNOTWAVE_RT {
    return std::any_of(targets.begin(), targets.end(), [](const ChannelTargets* numbers) {
      return numbers != nullptr && !numbers->is_empty();
    });
  }
  /// A set_target event moves this slot.
  bool is_set(int slot) const KNOTWAVE_RT {
    return std::any_of(targets.begin(), targets.end(), [slot](const ChannelTargets* numbers) {
      return numbers != nullptr && numbers->is_set(slot);
    });
  }
};

/// The present value of a source that is neither an envelope, an LFO nor a free number. [audio]
double source_value(const NoteContext& note, MapSource source, int index) KNOTWAVE_RT;

/// Bend and channel tuning of the note in semitones. [audio]
double bend_semitones(const NoteContext& note, double patch_range_semitones) KNOTWAVE_RT;

}  // namespace knotwave::engine

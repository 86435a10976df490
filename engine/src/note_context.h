// SPDX-License-Identifier: MIT
// Where a voice reads what the player does: its note, its channel, and under MPE the zone's master.
#pragma once
#include <algorithm>
#include <array>

#include "knotwave/base/random.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/event.h"
#include "knotwave/engine/mpe.h"
#include "knotwave/engine/patch.h"

#include "slot_targets.h"

namespace knotwave::engine {

struct NoteContext {
  const ChannelState* channel = nullptr;
  const ChannelState* master = nullptr;  ///< == channel outside MPE zones
  /// What set_target events said of all channels, of the channel, and of the zone's master where
  /// that is another; and what set_note events said of the note, modulation and expression. Or
  /// null.
  std::array<const SlotTargets*, 5> targets{};
  double pressure = 0;  ///< the note's own, by set_note
  double timbre = -1;   ///< the note's own, by set_note; -1: the channel's
  std::int32_t number = Event::kNoNote;
  std::uint64_t serial = 0;  ///< of its note on: which note it is
  double note = 60;          ///< what sounds, transposition included
  int key = 60;
  int velocity = 100;
  int release_velocity = 64;
  base::RandomStream random;  ///< of this note

  bool is_mpe() const KNOTWAVE_RT { return master != channel; }
  bool has_targets() const KNOTWAVE_RT {
    return std::any_of(targets.begin(), targets.end(), [](const SlotTargets* numbers) {
      return numbers != nullptr && !numbers->is_empty();
    });
  }
  /// What they move rests from `first` on.
  bool targets_are_still(std::int64_t first) const KNOTWAVE_RT {
    return std::all_of(targets.begin(), targets.end(), [first](const SlotTargets* numbers) {
      return numbers == nullptr || numbers->is_still(first);
    });
  }
  /// A set_target or set_note event moves this slot.
  bool is_set(int slot) const KNOTWAVE_RT {
    return std::any_of(targets.begin(), targets.end(), [slot](const SlotTargets* numbers) {
      return numbers != nullptr && numbers->is_set(slot);
    });
  }
};

/// The present value of a source that is neither an envelope, an LFO nor a free number. [audio]
double source_value(const NoteContext& note, MapSource source, int index) KNOTWAVE_RT;

/// Bend and channel tuning of the note in semitones. [audio]
double bend_semitones(const NoteContext& note, double patch_range_semitones) KNOTWAVE_RT;

}  // namespace knotwave::engine

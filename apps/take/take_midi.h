// SPDX-License-Identifier: MIT
// The MIDI part of a take, for programs that know no journals.
#pragma once
#include "knotwave/engine/journal.h"
#include "knotwave/io/midi_file.h"

namespace knotwave::take {

/// One tick a sample from the take's first one on, so that it lies under the recorded sound. What
/// was played before comes at tick 0, without notes that had ended. Tempo changes, song positions,
/// banks and targets have no place in it. Errors: unsupported (a rate that no time base of a MIDI
/// file gives exactly).
Result<io::Song> midi_song(const engine::Journal& journal);

}  // namespace knotwave::take

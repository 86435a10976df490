// SPDX-License-Identifier: MIT
// What lies beside the sound of a take.
#pragma once
#include <string>
#include <vector>

#include "knotwave/engine/journal.h"

#include "recorder.h"

namespace knotwave::synth {

/// Which files of a take that is to be called `path` are there already: the sound, FILE.journal and
/// FILE.mid, in this order.
std::vector<std::string> take_files_there(const std::string& path);

/// Writes FILE.journal and FILE.mid beside FILE.wav. `journal` is everything since engine time 0.
/// Returns what went wrong, one line each.
std::vector<std::string> write_take_files(const Recorder::Take& take, engine::Journal journal);

}  // namespace knotwave::synth

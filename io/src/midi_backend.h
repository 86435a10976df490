// SPDX-License-Identifier: MIT
// What the ways of MIDI offer to midi_output.cpp, and what they share. [control]
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "knotwave/io/midi_output.h"

namespace knotwave::io {

/// A client of JACK of our own. Errors: those of MidiOutput::open().
Result<std::unique_ptr<MidiOutput>> open_jack_midi_output(const MidiOutputConfig& config);

/// The one name that is `part` or has it in it, in any case. Errors: unknown_name (none, several).
Result<std::string> one_output(const std::string& api, const std::vector<std::string>& names,
                               const std::string& part);

Error too_long(std::size_t bytes);
Error no_message();

}  // namespace knotwave::io

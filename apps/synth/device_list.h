// SPDX-License-Identifier: MIT
// What --list-devices prints.
#pragma once
#include <string>

#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_input.h"

namespace knotwave::synth {

/// Sound devices with their numbers, MIDI ports, and why an API has none, as a table.
/// `without_sound` says what the program does without a sound device.
std::string device_table(const io::AudioDeviceList& sound, const io::MidiPortList& midi,
                         const std::string& without_sound);
/// The same of this machine, just now.
std::string device_list();

}  // namespace knotwave::synth

// SPDX-License-Identifier: MIT
// What --list-devices prints.
#pragma once
#include <string>

#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_input.h"

namespace knotwave::synth {

/// Sound devices with their numbers, MIDI ports, and why an API has none, as a table.
std::string device_table(const io::AudioDeviceList& sound, const io::MidiPortList& midi);
/// The same of this machine, just now.
std::string device_list();

}  // namespace knotwave::synth

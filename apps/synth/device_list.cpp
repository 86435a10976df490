// SPDX-License-Identifier: MIT
#include "device_list.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/io/midi_file.h"

#include "wait_notice.h"

namespace knotwave::synth {
namespace {

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string notes(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "  " + io::printable(line, 300) + "\n";
  return text;
}

std::string ports(const char* title, const std::vector<io::MidiPortInfo>& list) {
  std::string text = std::string(title) + "\n";
  for (const auto& port : list) {
    text += "  " + padded(port.api, 8) + io::printable(port.name, 100) + "\n";
  }
  return text + (list.empty() ? "  none\n" : "");
}

}  // namespace

std::string device_table(const io::AudioDeviceList& sound, const io::MidiPortList& midi,
                         const std::string& without_sound) {
  std::string text = "Sound devices (--audio-device NUMBER or part of a name; --audio-api)\n";
  for (const auto& device : sound.devices) {
    text += padded((device.is_default ? "* " : "  ") + std::to_string(device.number), 5) +
            padded(device.api, 8) + padded(io::printable(device.name, 100), 40) + " " +
            std::to_string(device.outputs) + " channels, " +
            std::to_string(std::lround(device.rate_hz)) + " Hz\n";
  }
  if (sound.devices.empty()) {
    text += "  none; " + without_sound + "\n";
  } else {
    text += "  * is played to where its API is chosen and no device; the first *, without either\n";
  }
  text += notes(sound.notes);
  text += ports("MIDI inputs (--midi-in part of a name; --midi-api)", midi.inputs);
  text += ports("MIDI outputs", midi.outputs);
  return text + notes(midi.notes);
}

std::string device_list() {
  const WaitNotice notice("waiting for a sound server that does not answer yet");
  return device_table(io::list_audio_devices(), io::list_midi_ports(),
                      "--record FILE.wav plays into a file, --audio-api none for nobody");
}

}  // namespace knotwave::synth

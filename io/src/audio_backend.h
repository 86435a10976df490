// SPDX-License-Identifier: MIT
// What each way of sound offers to audio_device.cpp. A way that is not built in says so.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/io/audio_device.h"

namespace knotwave::io {

/// A device as found, and what its library calls it.
struct FoundDevice {
  AudioDeviceInfo info;
  int library_number = -1;
};
struct FoundDevices {
  std::vector<FoundDevice> devices;
  std::vector<std::string> notes;
};

inline constexpr const char* kPortAudioJack = "portaudio-jack";

enum class JackServer { none, runs, hangs };
/// Adds the devices of the JACK server, where one runs. [control]
JackServer find_jack_devices(FoundDevices& found);
/// Adds PortAudio's devices, those of its JACK API too if asked. [control]
void find_portaudio_devices(bool with_jack, FoundDevices& found);

/// ASCII only. [control]
std::string lower_case(std::string_view text);

/// The one device that config.api, in lower case, and config.device name. [control]
Result<FoundDevice> choose_device(const FoundDevices& found, const AudioConfig& config);

using OpenedStream = Result<std::unique_ptr<AudioStream>>;
OpenedStream open_paced_stream(const AudioConfig& config, AudioClient& client);
/// `device` without a name: to be left unconnected.
OpenedStream open_jack_stream(const AudioConfig& config, const FoundDevice& device,
                              AudioClient& client);
OpenedStream open_portaudio_stream(const AudioConfig& config, const FoundDevice& device,
                                   AudioClient& client);

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
#include "knotwave/io/audio_device.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "knotwave/base/document.h"

#include "audio_backend.h"
#include "patient_call.h"

namespace knotwave::io {
namespace {

constexpr std::size_t kMaxChannels = 64;
constexpr int kMaxDeviceChannel = 256;
constexpr double kMaxLatencySeconds = 10;

Error out_of_range(const std::string& what) { return fail(ErrorCode::value_out_of_range, what); }

Result<void> check_channels(const std::vector<int>& channels) {
  if (channels.empty() || channels.size() > kMaxChannels) {
    return out_of_range(std::to_string(channels.size()) + " channels are asked for; 1 to " +
                        std::to_string(kMaxChannels) + " are possible");
  }
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    if (*channel < 1 || *channel > kMaxDeviceChannel) {
      return out_of_range("device channel " + std::to_string(*channel) + " is not within 1 to " +
                          std::to_string(kMaxDeviceChannel));
    }
    if (std::find(channels.begin(), channel, *channel) != channel) {
      return out_of_range("device channel " + std::to_string(*channel) + " is asked for twice");
    }
  }
  return {};
}

// Written so that NaN is refused too.
Result<void> check(const AudioConfig& config) {
  if (config.rate_hz != 0 && !(config.rate_hz >= 8000 && config.rate_hz <= 768000)) {
    return out_of_range("a rate of " + base::number_text(config.rate_hz) +
                        " Hz is not within 8000 to 768000");
  }
  if (config.block_frames != 0 &&
      (config.block_frames < 16 || config.block_frames > kMaxAudioBlock)) {
    return out_of_range("a block of " + std::to_string(config.block_frames) +
                        " frames is not within 16 to " + std::to_string(kMaxAudioBlock));
  }
  if (!(config.latency_s >= 0 && config.latency_s <= kMaxLatencySeconds)) {
    return out_of_range("a latency of " + base::number_text(config.latency_s) +
                        " s is not within 0 to 10");
  }
  return check_channels(config.channels);
}

void count_devices(FoundDevices& found) {
  int number = 0;
  for (FoundDevice& device : found.devices) device.info.number = number++;
}

// PortAudio is a client of that server, too, whatever device it plays, and would wait for good.
Error server_hangs() {
  return fail(ErrorCode::unsupported, "the JACK server does not answer: end it or start it anew");
}

// A server that runs without a device of its own can be asked for by its name.
OpenedStream open_jack(const AudioConfig& config, AudioClient& client) {
  FoundDevices found;
  const JackServer server = find_jack_devices(found);
  if (server == JackServer::hangs) return server_hangs();
  count_devices(found);
  if (server == JackServer::runs && found.devices.empty() && config.device.empty()) {
    return open_jack_stream(config, {}, client);
  }
  const auto device = choose_device(found, config);
  if (!device) return device.error();
  return open_jack_stream(config, *device, client);
}

}  // namespace

std::int64_t steady_clock_ns() KNOTWAVE_RT {
  using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::steady_clock;
  return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

AudioDeviceList list_audio_devices() {
  FoundDevices found;
  if (find_jack_devices(found) == JackServer::hangs) {
    found.notes.emplace_back("portaudio: not asked, as it would wait for that server, too");
  } else {
    find_portaudio_devices(false, found);
  }
  count_devices(found);
  AudioDeviceList list;
  for (FoundDevice& device : found.devices) list.devices.push_back(std::move(device.info));
  list.notes = std::move(found.notes);
  return list;
}

OpenedStream AudioStream::open(const AudioConfig& asked, AudioClient& client) {
  if (const auto checked = check(asked); !checked) return checked.error();
  AudioConfig config = asked;
  config.api = lower_case(asked.api);
  if (config.api == "none") return open_paced_stream(config, client);
  if (config.api == "jack") return open_jack(config, client);
  FoundDevices found;
  if (find_jack_devices(found) == JackServer::hangs) return server_hangs();
  const bool jack_is_default =
      config.api.empty() && config.device.empty() && !found.devices.empty();
  if (!jack_is_default) find_portaudio_devices(config.api == kPortAudioJack, found);
  count_devices(found);
  const auto device = choose_device(found, config);
  if (!device) return device.error();
  if (device->info.api == "jack") return open_jack_stream(config, *device, client);
  return open_portaudio_stream(config, *device, client);
}

void AudioStream::connect_midi(const std::vector<std::string>& /*sources*/) {}

bool AudioStream::is_poisoned() noexcept {
  return jack_calls().is_stuck() || portaudio_calls().is_stuck();
}

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
#include "library_silence.h"
#include "portaudio_library.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::seconds kAnswersWithin{5};

std::string api_name(const PaHostApiInfo& api) {
  return api.type == paJACK ? kPortAudioJack : lower_case(api.name);
}

AudioDeviceInfo described(const PaDeviceInfo& device, const PaHostApiInfo& api, bool is_default) {
  AudioDeviceInfo info;
  info.api = api_name(api);
  info.name = device.name;
  info.outputs = device.maxOutputChannels;
  info.rate_hz = device.defaultSampleRate;
  info.latency_s = device.defaultLowOutputLatency;
  info.is_default = is_default;
  return info;
}

void add_devices_of(const PaHostApiInfo& api, PaHostApiIndex api_number, FoundDevices& found) {
  const std::size_t before = found.devices.size();
  for (int i = 0; i < api.deviceCount; ++i) {
    const PaDeviceIndex number = Pa_HostApiDeviceIndexToDeviceIndex(api_number, i);
    const PaDeviceInfo* const device = Pa_GetDeviceInfo(number);
    if (device == nullptr || device->maxOutputChannels < 1) continue;
    found.devices.push_back({described(*device, api, number == api.defaultOutputDevice), number});
  }
  if (found.devices.size() == before) {
    found.notes.push_back(api_name(api) + ": no device with outputs");
  }
}

void ask_library(bool with_jack, FoundDevices& found) {
  const PortAudioUse use;
  silence_alsa();  // PortAudio may have loaded it only now
  if (use.error() != paNoError) {
    found.notes.push_back(std::string("portaudio: ") + Pa_GetErrorText(use.error()));
    return;
  }
  for (PaHostApiIndex i = 0; i < Pa_GetHostApiCount(); ++i) {
    const PaHostApiInfo* const api = Pa_GetHostApiInfo(i);
    if (api != nullptr && (with_jack || api->type != paJACK)) add_devices_of(*api, i, found);
  }
}

}  // namespace

PatientCall::Outcome run_portaudio(std::chrono::milliseconds limit, std::function<void()> work) {
  silence_alsa();
  silence_jack();
  const SilentStandardError silence;
  return portaudio_calls().run(limit, std::move(work));
}

void find_portaudio_devices(bool with_jack, FoundDevices& found) {
  const auto answer = std::make_shared<FoundDevices>();
  switch (run_portaudio(kAnswersWithin, [=] { ask_library(with_jack, *answer); })) {
    case PatientCall::Outcome::done:
      break;
    case PatientCall::Outcome::hangs:
      found.notes.emplace_back("portaudio: a sound system does not answer");
      return;
    case PatientCall::Outcome::refused:
      found.notes.emplace_back(std::string("portaudio: ") + kPortAudioHangs);
      return;
  }
  for (FoundDevice& device : answer->devices) found.devices.push_back(std::move(device));
  for (std::string& note : answer->notes) found.notes.push_back(std::move(note));
}

}  // namespace knotwave::io

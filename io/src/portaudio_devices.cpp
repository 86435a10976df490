// SPDX-License-Identifier: MIT
#include <dlfcn.h>

#include "library_silence.h"
#include "portaudio_library.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::seconds kAnswersWithin{5};

AudioDeviceInfo described(const PaDeviceInfo& device, const PaHostApiInfo& api, bool is_default) {
  AudioDeviceInfo info;
  info.api = portaudio_api_name(api);
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
    found.notes.push_back(portaudio_api_name(api) + ": no device with outputs");
  }
}

void ask_library(bool with_jack, FoundDevices& found) {
  const PortAudioUse use("Knotwave-list");
  if (!use.error().empty()) {
    found.notes.push_back(use.error());
    return;
  }
  for (PaHostApiIndex i = 0; i < Pa_GetHostApiCount(); ++i) {
    const PaHostApiInfo* const api = Pa_GetHostApiInfo(i);
    if (api != nullptr && (with_jack || api->type != paJACK)) add_devices_of(*api, i, found);
  }
}

/// ALSA as PortAudio brings it in; we do not link it.
template <class Function>
Function* alsa(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// Where ALSA's configuration has neither of the two PCMs that PortAudio (19.6) keeps for the end
/// of its search, an assertion of its ends the program. Empty: all is well.
std::string alsa_fault() {
  struct Tree;
  auto* const update = alsa<int(Tree**)>("snd_config_update_ref");
  auto* const search = alsa<int(Tree*, const char*, Tree**)>("snd_config_search");
  auto* const give_back = alsa<void(Tree*)>("snd_config_unref");
  if (update == nullptr || search == nullptr || give_back == nullptr) return {};
  Tree* top = nullptr;
  Tree* found = nullptr;
  const bool is_read = update(&top) >= 0 && top != nullptr;
  const bool is_usable =
      is_read && (search(top, "pcm.default", &found) >= 0 || search(top, "pcm.dmix", &found) >= 0);
  if (is_read) give_back(top);
  if (is_usable) return {};
  return std::string("alsa: its configuration ") +
         (is_read ? "names no PCM 'default'" : "cannot be read") +
         ": install libasound2-data, or mend ~/.asoundrc or what ALSA_CONFIG_PATH names";
}

// PortAudio keeps the pointer.
void set_jack_name(const std::string& name) {
  static auto* const kept = new std::string;
  using Setter = PaError (*)(const char*);
  auto* const found = dlsym(RTLD_DEFAULT, "PaJack_SetClientName");  // some PortAudios have no JACK
  if (found == nullptr) return;
  *kept = name;
  reinterpret_cast<Setter>(found)(kept->c_str());
}

}  // namespace

PortAudioUse::PortAudioUse(const std::string& client_name) : ticket_(JackTicket::take()) {
  if (!ticket_) {
    error_ = "portaudio: the JACK server has gone";
    return;
  }
  error_ = alsa_fault();
  if (!error_.empty()) return;
  set_jack_name(client_name);
  const PaError fault = Pa_Initialize();
  is_initialised_ = fault == paNoError;
  if (!is_initialised_) error_ = std::string("portaudio: ") + Pa_GetErrorText(fault);
  const bool uses_jack = is_initialised_ && Pa_HostApiTypeIdToHostApiIndex(paJACK) >= 0;
  if (!uses_jack) ticket_.reset();
  silence_alsa();  // it may have been loaded only now
}

PortAudioUse::~PortAudioUse() {
  if (is_initialised_) Pa_Terminate();
}

std::string portaudio_api_name(const PaHostApiInfo& api) {
  return api.type == paJACK ? kPortAudioJack : lower_case(api.name);
}

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

// SPDX-License-Identifier: MIT
// PortAudio from its start to its end, in silence, and what it finds.
#pragma once
#include <string>

#include <portaudio.h>

#include "audio_backend.h"
#include "jack_session.h"
#include "patient_call.h"

namespace knotwave::io {

/// PortAudio is initialised while one lives; PortAudio counts them. Made and destroyed inside
/// portaudio_calls() only, as both may hang. Where a JACK server runs PortAudio is a client of it,
/// whatever device is played.
class PortAudioUse {
 public:
  /// `client_name`: JACK knows us by it.
  explicit PortAudioUse(const std::string& client_name);
  ~PortAudioUse();
  PortAudioUse(const PortAudioUse&) = delete;
  PortAudioUse& operator=(const PortAudioUse&) = delete;
  /// With whose it is in front; empty where all is well.
  const std::string& error() const noexcept { return error_; }

 private:
  std::unique_ptr<JackTicket> ticket_;
  bool is_initialised_ = false;
  std::string error_;
};

std::string portaudio_api_name(const PaHostApiInfo& api);

/// portaudio_calls().run() with standard error silent meanwhile. [control]
PatientCall::Outcome run_portaudio(std::chrono::milliseconds limit, std::function<void()> work);

/// What a user is told where an earlier call of PortAudio hangs.
inline constexpr const char* kPortAudioHangs =
    "PortAudio hangs since its device vanished: start the program anew";

}  // namespace knotwave::io

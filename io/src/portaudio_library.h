// SPDX-License-Identifier: MIT
// PortAudio from its start to its end, in silence, and what it finds.
#pragma once
#include <string>

#include <portaudio.h>

#include "audio_backend.h"
#include "patient_call.h"

namespace knotwave::io {

/// PortAudio is initialised while one lives; PortAudio counts them. Made and destroyed inside
/// portaudio_calls() only, as both may hang.
class PortAudioUse {
 public:
  PortAudioUse() noexcept : error_(Pa_Initialize()) {}
  ~PortAudioUse() {
    if (error_ == paNoError) Pa_Terminate();
  }
  PortAudioUse(const PortAudioUse&) = delete;
  PortAudioUse& operator=(const PortAudioUse&) = delete;
  PaError error() const noexcept { return error_; }

 private:
  PaError error_;
};

/// portaudio_calls().run() with standard error silent meanwhile. [control]
PatientCall::Outcome run_portaudio(std::chrono::milliseconds limit, std::function<void()> work);

/// What a user is told where an earlier call of PortAudio hangs.
inline constexpr const char* kPortAudioHangs =
    "PortAudio hangs since its device vanished: start the program anew";

}  // namespace knotwave::io

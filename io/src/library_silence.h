// SPDX-License-Identifier: MIT
// Keeps what sound libraries print off the terminal. [control]
#pragma once

namespace knotwave::io {

/// ALSA's own messages, from now on.
void silence_alsa() noexcept;
/// The same for JACK.
void silence_jack() noexcept;

/// Standard error of the whole program goes nowhere while it lives: for what plug-ins of ALSA and
/// PortAudio itself write there. Several may live at once.
class SilentStandardError {
 public:
  SilentStandardError() noexcept;
  ~SilentStandardError();
  SilentStandardError(const SilentStandardError&) = delete;
  SilentStandardError& operator=(const SilentStandardError&) = delete;
};

}  // namespace knotwave::io

// SPDX-License-Identifier: MIT
// Tries to open a sound device beside everything else: a server that hangs takes its time.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "knotwave/io/audio_device.h"

namespace knotwave::synth {

class StreamOpener {
 public:
  using Opened = Result<std::unique_ptr<io::AudioStream>>;
  StreamOpener() = default;
  StreamOpener(const StreamOpener&) = delete;
  StreamOpener& operator=(const StreamOpener&) = delete;
  /// Does not wait for a try that is under way: what it opens then is closed at once.
  ~StreamOpener();

  /// Begins a try, unless one is under way or no thread is to be had. `client` must outlive what is
  /// opened.
  void begin(const io::AudioConfig& config, io::AudioClient& client);
  /// What became of a try, once.
  std::optional<Opened> take();
  /// Some try, also one that nobody waits for, is under way: a thread that will not be joined.
  /// [any]
  static bool is_any_under_way() noexcept;

 private:
  struct Try;
  std::shared_ptr<Try> try_;
};

}  // namespace knotwave::synth

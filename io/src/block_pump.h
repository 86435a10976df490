// SPDX-License-Identifier: MIT
// What every way of sound has in common: a device's block becomes calls of the client, measured,
// and none of them after close().
#pragma once
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/io/audio_device.h"

#include "load_meter.h"

namespace knotwave::io {

class BlockPump {
 public:
  /// [control]
  BlockPump(AudioClient& client, double rate_hz, int channels);

  struct Request {
    std::int64_t frame = 0, time_ns = 0;
    std::span<float* const> outputs;  ///< [channels]
    int frames = 0;                   ///< more than kMaxAudioBlock becomes several blocks
    std::span<base::MidiEvent> midi;  ///< in order; their times are made relative to each block
    bool has_deadline = true;         ///< false: faster than real time, no load is counted
  };
  /// One block of the device. Silence while closed. [audio]
  void run(const Request& request) KNOTWAVE_RT;

  /// Lets process() be called. [control]
  void open() noexcept { is_open_.store(true); }
  /// No process() once it returns; waits for one that runs. [control]
  void close() noexcept;

  std::int64_t blocks() const noexcept { return blocks_.load(std::memory_order_relaxed); }
  LoadMeter::Figures load() const noexcept { return meter_.figures(); }

 private:
  void call_client(const Request& request) KNOTWAVE_RT;

  AudioClient& client_;
  double rate_hz_;
  std::vector<float*> outputs_;
  std::atomic<bool> is_open_{false}, is_inside_{false};
  std::atomic<std::int64_t> blocks_{0};
  LoadMeter meter_;
};

}  // namespace knotwave::io
